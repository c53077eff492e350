// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_SURFACE_H
#define OPENSUBDIVHEX_BFR_EXT_SURFACE_H

#include "levelTessellation.h"

#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/types.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;

namespace BfrExt {

namespace internal {
class BaseType;
template <typename TYPE>
struct KeptFace;
template <typename REAL>
class FacePatches;

/// A pointer that threads may set at once, to the same.
template <typename T>
class SharedPointer {
public:
    SharedPointer() = default;
    SharedPointer(SharedPointer const &other) noexcept : _pointer(other.Get()) {}
    SharedPointer &operator=(SharedPointer const &other) noexcept {
        Set(other.Get());
        return *this;
    }

    T *Get() const { return _pointer.load(std::memory_order_acquire); }
    void Set(T *pointer) { _pointer.store(pointer, std::memory_order_release); }

private:
    std::atomic<T *> _pointer{nullptr};
};
} // namespace internal

/// \brief The limit surface of a base face, as Bfr::Surface: a function of u and v.
///
/// \code
///     BfrExt::Surface<float> surface;
///     if (factory->InitVertexSurface(face, &surface)) {
///         std::vector<float> points(3 * surface.GetNumPatchPoints());
///         surface.PreparePatchPoints(positions, 3, points.data(), 3); // once a frame
///         surface.Evaluate(uv, points.data(), 3, p, du, dv);
///     }
/// \endcode
///
/// The surface depends on the *control points* of the face: the vertices of its level (or values of a face-varying channel)
/// in the faces at its vertices and at their neighbours.  Every point is a weighted sum of control points, with weights
/// that are not negative: the hull of the control points contains the surface.
///
/// The surface is no spline.  There are two ways to evaluate it:
///  - **Evaluate() at (u, v), from patch points.** The surface is approximated by bicubic Gregory patches, one for each cell of
///    level 3, or of SurfaceFactory::Options::SetApproxLevelSmooth().  Patches have the limit points and tangent planes at
///    the corners of cells.  Neighbours, in other faces, too, have equal points and tangent planes along their common edge,
///    except for rounding.  With FaceMask::Smooth at level 3, points lie 2e-6 of a model's size from the surface (rms), and
///    normals deviate by 0.1 to 0.2 degrees; each further level divides these by 8 and 3.  Derivatives are OpenSubdiv's of a
///    Gregory patch: as if its points inside of corners, which (u, v) blends, were fixed.  Near extraordinary base
///    vertices, where cells do not shrink by 1/2, points are shifted along the surface by up to a hundredth of a face.
///  - **Tessellations and stencils** are exact at vertices of any level (FarExt::TopologyLevel::GetFaceSurfaceCoords()), as
///    limit stencil tables are.  Elsewhere the cells around (u, v) are refined until the surface between the corners of a
///    cell is bilinear: 16 levels, with an error below a billionth of the face's size, or 40 where the surface is less
///    smooth, with at most a millionth.  A stencil takes tens of microseconds.
///
/// **First derivatives.** Du and Dv span the tangent plane, and Du x Dv points to the side from which the face is
/// counter-clockwise.
///  - With FaceMask::Smooth and FaceMask::Cosine they are the derivatives by u and v, from the side of the cell around
///    (u, v).  Across edges of the face, and lines from its centre to its corners, the plane is continuous, but u and v bend.
///  - Exceptions are extraordinary base vertices and, with FaceMask::Average, all (u, v): the plane exists, derivatives do
///    not, because cells do not shrink by 1/2 from level to level.  The length is then that between the vertices of the level
///    in which (u, v) becomes a vertex; with FaceMask::Average it means nothing elsewhere.  Differences of points over
///    those of u and v do not converge: with FaceMask::Average they shrink by 0.88 in each level at a base vertex of three
///    faces (where cells shrink by 0.44).  Only their directions converge, to those of Du and Dv.
///  - Varying data have kinks along edges of all levels: there derivatives are differences some levels on, or those of
///    patches, which are bilinear between their corners.
///
/// **Second derivatives**, by u twice, by u and v, and by v twice, are from the same side.  Vertex data, and
/// face-varying data that are refined like these, have them with FaceMask::Smooth: exact at vertices, elsewhere within 0.5 %
/// on average.
///  - There are none at extraordinary base vertices, towards which they may grow, at the centres of faces that are no
///    hexagons, and on borders and creases.
///  - With FaceMask::Cosine they are bounded and have no limit; with FaceMask::Average they are unbounded; varying data have
///    kinks.
///  - In all these cases the result is the change of first derivatives over a cell of level 10.
///
/// A surface is invalid until SurfaceFactory initializes it, and after it was moved from; copies share what the cache has.
/// Several threads may call const functions at once.  A surface may outlive the factory and the cache.  An invalid surface
/// writes nothing.  Other arguments are not checked; std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API Surface {
public:
    /// A vertex of the base mesh, or a face-varying value.
    using Index = Far::Index;

    /// \brief The size of the points in an array, and the distance from one to the next, in numbers.
    struct PointDescriptor {
        /// None.
        PointDescriptor() = default;
        /// Points of \p n numbers, without gaps.
        PointDescriptor(int n) : size(n), stride(n) {}
        /// Points of \p n numbers, \p m from one to the next.
        PointDescriptor(int n, int m) : size(n), stride(m) {}

        int size = 0;   ///< numbers of a point
        int stride = 0; ///< from the begin of a point to that of the next
    };

    /// Whether SurfaceFactory initialized it.
    bool IsValid() const { return _owner != nullptr; }
    /// Makes it invalid.
    void Clear();

    /// The parameterization of the face.
    Parameterization GetParameterization() const { return _parameterization; }
    /// Vertices of the face.
    int GetFaceSize() const { return _parameterization.GetFaceSize(); }
    /// The shape of the face.
    FarExt::FaceShape GetFaceShape() const { return _parameterization.GetFaceShape(); }

    /// @name Control points
    /// @{

    /// Control points of the face.
    int GetNumControlPoints() const { return IsValid() ? _numControlPoints : 0; }
    /// Writes the indices of control points in the mesh: the vertices of the face first, in its order.  No vertex
    /// comes twice, even if the face has it twice.  A face-varying value may come several times: once for each fan of faces
    /// around its vertex, because each fan is refined apart.
    /// \return  GetNumControlPoints()
    int GetControlPointIndices(Index meshPointIndices[]) const;
    /// Copies the control points from those of the mesh, of either precision.
    template <typename REAL_MESH>
    void GatherControlPoints(REAL_MESH const meshPoints[], PointDescriptor const &meshPointDesc,
                             REAL controlPoints[], PointDescriptor const &controlPointDesc) const {
        Index const *const points = getPoints();
        Index const *const end = points + GetNumControlPoints();
        auto const gather = [&](auto const &copy) {
            REAL *to = controlPoints;
            for (Index const *point = points; point != end; ++point) {
                copy(meshPoints + std::ptrdiff_t(*point) * meshPointDesc.stride, to);
                to += controlPointDesc.stride;
            }
        };
        if (meshPointDesc.size == 3) { // by far the most
            gather([](REAL_MESH const *from, REAL *to) {
                // All three are read before one is written: so a compiler may copy them at once.
                REAL_MESH const numbers[3] = {from[0], from[1], from[2]};
                to[0] = REAL(numbers[0]);
                to[1] = REAL(numbers[1]);
                to[2] = REAL(numbers[2]);
            });
        } else {
            gather([&](REAL_MESH const *from, REAL *to) {
                std::transform(from, from + meshPointDesc.size, to,
                               [](REAL_MESH number) { return REAL(number); });
            });
        }
    }
    /// Writes the box of the control points, in which the surface lies.
    void BoundControlPoints(REAL const controlPoints[], PointDescriptor const &controlPointDesc,
                            REAL minExtent[], REAL maxExtent[]) const;
    /// Overload that takes the points of the mesh.
    void BoundControlPointsFromMesh(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                                    REAL minExtent[], REAL maxExtent[]) const;

    /// @}

    /// @name Patch points
    /// The points that Evaluate() at (u, v) takes, of which patches are weighted sums: the control points and, but for faces in
    /// regular lattices of quads, triangles or hexagons, 150 to 280 points of the first or second level behind them (of a face of
    /// n vertices about n * n).  Types of faces share the weights.  Make the points once for those of a mesh; they serve any
    /// number of evaluations of this surface.
    /// @{

    /// Control points, and those of a later level where the face needs them.
    int GetNumPatchPoints() const;
    /// Copies the control points from those of the mesh, of either precision, and computes the others.
    template <typename REAL_MESH>
    void PreparePatchPoints(REAL_MESH const meshPoints[], PointDescriptor const &meshPointDesc,
                            REAL patchPoints[], PointDescriptor const &patchPointDesc) const {
        GatherControlPoints(meshPoints, meshPointDesc, patchPoints, patchPointDesc);
        ComputePatchPoints(patchPoints, patchPointDesc);
    }
    /// Computes the others behind the control points, which are there.
    void ComputePatchPoints(REAL patchPoints[], PointDescriptor const &patchPointDesc) const;
    /// @}

    /// @name Evaluation
    /// (u, v) outside the face is moved to its boundary, towards the centre; outside of a sub-face, to the boundary of the
    /// sub-face that Bfr finds.  If u or v is not a number, points, derivatives and some weights are not numbers.
    /// @{

    /// Writes the point at \p uv: pointDesc.size numbers.
    ///
    /// \param patchPoints  those of PreparePatchPoints(), of as many numbers
    void Evaluate(REAL const uv[2], REAL const patchPoints[], PointDescriptor const &pointDesc,
                  REAL p[]) const;
    /// Overload with first derivatives.
    void Evaluate(REAL const uv[2], REAL const patchPoints[], PointDescriptor const &pointDesc,
                  REAL p[], REAL du[], REAL dv[]) const;
    /// Overload with first and second derivatives.
    void Evaluate(REAL const uv[2], REAL const patchPoints[], PointDescriptor const &pointDesc,
                  REAL p[], REAL du[], REAL dv[], REAL duu[], REAL duv[], REAL dvv[]) const;

    /// \brief Writes the points at all places of a tessellation, of a face of this size, from one to the
    /// next by the stride of \p resultDesc; nothing where it is of another size, or invalid.
    ///
    /// Two faces that share an edge get the same points there, to the bit, if the edge has the same
    /// level, or Polyline, in both and their control points come from the same mesh: so facets of
    /// neighbours can be joined by comparing points.  Levels and polylines give a place the same point.
    /// This holds for any threads, orders, trees and levels of the inside.  Exceptions: non-manifold edges and vertices;
    /// face-varying values on the two sides of a seam; last bits on edges and at vertices of the faces around a
    /// non-manifold vertex with a closed fan among others.
    ///
    /// The weights are found when a type of faces or of cells is first evaluated so, and kept in the cache.
    void Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL p[],
                  PointDescriptor const &resultDesc) const;
    /// Overload with first derivatives.
    void Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                  PointDescriptor const &resultDesc) const;
    /// Overload with first and second derivatives.  Second derivatives take about ten microseconds a point.
    void Evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[], REAL duu[],
                  REAL duv[], REAL dvv[], PointDescriptor const &resultDesc) const;

    /// \brief Writes the points at all places of a tessellation of Bfr, with rates: any number of segments on each
    /// edge, evenly spaced.
    ///
    /// Rates, options, coordinates and facets are Bfr's.  Derivatives are by the u and v that its coordinates are:
    /// these are GetParameterization()'s, but for a triangle in sub-faces.
    ///
    /// \param tessellation  made for a face of this size, as of GetParameterization(); a triangle may have
    ///                      the sub-faces of Catmull-Clark, too.  Nothing is written where it is of another size,
    ///                      or invalid.
    ///
    /// Two faces that share an edge get the same points there, to the bit, if the edge has the same rate in both,
    /// with the same exceptions.  Equal parameters on an edge have the same point, whatever rates, levels and polylines have
    /// them: 1/3 and 2/6, 1/4 and the first point of level 2.
    ///
    /// Weights are found when a type of faces is first evaluated with its inner rates, or with a rate of an edge: about ten
    /// microseconds a point.  The cache keeps them: twenty to fifty for a point inside, twice as many more for its
    /// derivatives.  Weights of more than 4,096 points inside, and of rates above 1,024 on an edge, are found each time.
    void Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL p[],
                  PointDescriptor const &resultDesc) const;
    /// Overload with first derivatives.
    void Evaluate(OpenSubdiv::Bfr::Tessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL p[], REAL du[], REAL dv[],
                  PointDescriptor const &resultDesc) const;

    /// Writes the weights of the control points that make the point at \p uv.
    /// \return  GetNumControlPoints()
    int EvaluateStencil(REAL const uv[2], REAL weights[]) const;
    /// Overload with weights of first derivatives.
    int EvaluateStencil(REAL const uv[2], REAL weights[], REAL duWeights[], REAL dvWeights[]) const;
    /// Overload with weights of first and second derivatives.
    int EvaluateStencil(REAL const uv[2], REAL weights[], REAL duWeights[], REAL dvWeights[],
                        REAL duuWeights[], REAL duvWeights[], REAL dvvWeights[]) const;
    /// Writes the weighted sum of control points.
    void ApplyStencil(REAL const stencil[], REAL const controlPoints[],
                      PointDescriptor const &controlPointDesc, REAL result[]) const;
    /// Overload that takes the points of the mesh.
    void ApplyStencilFromMesh(REAL const stencil[], REAL const meshPoints[],
                              PointDescriptor const &meshPointDesc, REAL result[]) const;
    /// @}

    /// The type and the points of the face, for the classes of this library; the surface must be valid.
    internal::KeptFace<internal::BaseType> const &GetFace() const;

private:
    friend class SurfaceFactory;

    Index const *getPoints() const;
    internal::FacePatches<REAL> const &findPatches() const;
    void evaluate(REAL const uv[2], int numDerivatives, REAL const patchPoints[],
                  PointDescriptor const &pointDesc, REAL *const results[6]) const;
    void evaluate(LevelTessellation const &tessellation, REAL const controlPoints[],
                  PointDescriptor const &pointDesc, REAL *const results[6],
                  PointDescriptor const &resultDesc) const;
    int evaluateStencil(REAL const uv[2], int numDerivatives, REAL *const weights[6]) const;

    // What evaluation at (u, v) reads comes first.
    mutable internal::SharedPointer<internal::FacePatches<REAL> const> _patches; // found on demand
    int _patchLevel = 0;
    int _numControlPoints = 0; // the face's, without a look at it
    Parameterization _parameterization;
    std::shared_ptr<void const> _owner; // of what the face refers to; null of an invalid surface
    internal::KeptFace<internal::BaseType> const *_keptFace = nullptr; // the owner's; null: its own
    std::vector<std::byte> _ownFace;
};

extern template class Surface<float>;
extern template class Surface<double>;

} // namespace BfrExt
} // namespace OpenSubdivHex

#endif
