// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_VIEW_H
#define OPENSUBDIVHEX_BFR_EXT_VIEW_H

#include "camera.h"
#include "cellForest.h"
#include "surfaceFactory.h"
#include "viewBounds.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt {

namespace internal {

struct ViewData;

/// Points of either precision, of which three numbers are read.
struct PointArray {
    PointArray(float const *points, std::ptrdiff_t strideOfPoints)
        : floats(points), stride(strideOfPoints) {}
    PointArray(double const *points, std::ptrdiff_t strideOfPoints)
        : doubles(points), stride(strideOfPoints) {}

    std::array<double, 3> operator[](std::ptrdiff_t point) const {
        if (floats) {
            float const *const p = floats + point * stride;
            return {double(p[0]), double(p[1]), double(p[2])};
        }
        double const *const p = doubles + point * stride;
        return {p[0], p[1], p[2]};
    }

    float const *floats = nullptr;
    double const *doubles = nullptr;
    std::ptrdiff_t stride;
};

} // namespace internal

/// The visibility of a cell in a view.
enum class CellVisibility : unsigned char {
    Visible,    ///< visible, or perhaps so
    Outside,    ///< all of it is outside of the picture
    BackFacing, ///< all of it faces away
};

/// \brief Refines base faces only as far as a camera sees: makes trees of cells.
///
/// \code
///     BfrExt::Camera camera;
///     camera.eye[2] = 5;
///     BfrExt::View const view(camera, BfrExt::View::Options().SetFlatness(0.5)); // half a pixel
///     BfrExt::CellForest const forest = view.MakeForest(*factory, positions, 3);
/// \endcode
///
/// **Flatness.**  A cell is refined until its facets are closer to the surface than some pixels.  This distance is
/// estimated: it is the range of heights over the plane of the cell's corners, of the surface at the corners of cells one
/// or two steps on, and some more for the surface between these.  Where nothing sharp is near, every other level is
/// expected to have a quarter of the distance.  In pixels it is as large as anywhere in a ball around the cell: at the
/// least depth, and furthest from the axis.
/// Sharp edges and boundaries, whose curve may bend in the plane of a cell, get points of their own.
///
/// Facets are what LevelTessellation makes of triangles or quads: hexagons are within the same distance when they are
/// cut along the diagonal of their half cells, from corner 0 to 3, as a fan from corner 0 does.  A surface without a
/// boundary or sharp edge may turn back in its own plane, as all around a leaf without thickness.  Heights do not tell
/// there how far the outline is from the sides of cells: SetEdgeLength() refines it.
///
/// **Lengths.**  A cell can be refined, too, until its sides are shorter than some pixels.
///
/// **Culling** leaves unseen cells coarse: meshes stay closed.  A face is outside of the picture if all its control points
/// are on the outer side of one plane through a side of the picture, or behind the eye: their hull contains the surface.
/// A cell of later levels is outside if a ball around it is, and faces away if (Du x Dv) . (eye - p) < 0 for all its
/// points p.  Both are estimated: the ball holds the corners of the cells one or two steps on, with a margin of a third or
/// a half of its radius, and normals are taken to spread 3.25 times as far as those at corners of the polygons there.  A cell
/// whose normals spread there by more than 45 degrees does not count as facing away.  Folds that are narrower than these
/// polygons, as beside a corner of a half turn, may be missed.  A part of a sharp edge or boundary is outside as a face is,
/// by the control points of its curve.  Whole faces and sharp edges never count as facing away.
///
/// **Animation.**  Given the tree of the last frame, a cell that is refined there stays refined until the
/// error is below a fraction of the pixels that are allowed, so that nothing flickers; and so do sharp edges and
/// boundaries.  A ViewBounds keeps from frame to frame how flat cells are, most of the work, which does not depend
/// on the camera.
///
/// Nothing is changed after construction: several threads may use it.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API View {
public:
    /// A face of the base mesh.
    using Index = Far::Index;

    /// \brief How fine cells become, and which are left coarse.
    class Options {
    public:
        /// Flat to half a pixel, all faces, up to level 8.
        Options()
            : _flatness(0.5), _edgeLength(0), _maxLevel(8), _isCulling(false), _hysteresis(0.5) {}

        /// Sets how many pixels facets may be from the surface; 0: any number.
        Options &SetFlatness(double pixels) {
            _flatness = pixels;
            return *this;
        }
        /// The number that was set.
        double GetFlatness() const { return _flatness; }
        /// Sets how many pixels long sides of cells may be; 0: any number.
        Options &SetEdgeLength(double pixels) {
            _edgeLength = pixels;
            return *this;
        }
        /// The number that was set.
        double GetEdgeLength() const { return _edgeLength; }
        /// Sets the last level that is made, 0 ... CellTree::kLastLevel.
        Options &SetMaxLevel(int level) {
            _maxLevel = level;
            return *this;
        }
        /// The level that was set.
        int GetMaxLevel() const { return _maxLevel; }
        /// Sets whether what is not seen is left coarse.
        Options &SetCulling(bool isCulling) {
            _isCulling = isCulling;
            return *this;
        }
        /// Whether it is.
        bool IsCulling() const { return _isCulling; }
        /// Sets the fraction of both numbers of pixels above which cells, and sharp edges and boundaries,
        /// stay refined, 0 ... 1.
        Options &SetHysteresis(double fraction) {
            _hysteresis = fraction;
            return *this;
        }
        /// The fraction that was set.
        double GetHysteresis() const { return _hysteresis; }

    private:
        double _flatness;
        double _edgeLength;
        int _maxLevel;
        bool _isCulling;
        double _hysteresis;
    };

    /// \brief The view of a camera.
    ///
    /// The view is invalid, and refines nothing (trees have one cell, polylines one segment), if
    ///  - eye and target are equal, or \c up is zero, also where squares are beyond double precision,
    ///  - a number is not finite, or an angle, resolution or option is out of range,
    ///  - both numbers of pixels are 0.
    ///
    /// \param camera   the camera
    /// \param options  how fine cells become
    explicit View(Camera const &camera, Options options = Options());
    /// Moving copies.
    View(View const &) = default;
    /// \copydoc View(View const &)
    View &operator=(View const &) = default;
    ~View() = default;

    /// Whether the arguments were as they have to be.
    bool IsValid() const;
    /// The camera, with what is up in its picture.
    Camera const &GetCamera() const;
    /// The options.
    Options const &GetOptions() const;

    /// \brief Counts of the cells of a mesh that are not refined, and what is seen of all.
    struct Counts {
        std::vector<long> cellsByLevel; ///< those that are not refined
        long outside = 0;               ///< of these
        long backFacing = 0;            ///< of these
        /// By face with a surface, the visibility of each cell of its tree; none of others.
        std::vector<std::vector<CellVisibility>> visibilities;
    };
    /// \brief Makes the trees of all faces that have a surface, and the polylines of all edges, in
    /// parallel.
    ///
    /// Polylines of sharp edges and boundaries are as close to the curve as facets are to the surface, and the same from
    /// both sides.
    ///
    /// \param factory     of the mesh, whose refiner the forest refers to
    /// \param meshPoints  the positions of its vertices
    /// \param pointDesc   how they lie; the first 3 numbers of each are read
    /// \param previous    the forest of the last frame, of the same mesh, or null.  Ignored are its trees if they are more or
    ///                    fewer than faces, its edges if they are more or fewer than edges, and a tree of another face
    ///                    size
    /// \param counts      null, or gets what was found
    /// \param status      InvalidArgument for an invalid view; else the reason of SurfaceFactory::FaceHasLimitSurface() for the
    ///                    first face without a surface that is no hole.  Such faces are not refined, and a PatchStream
    ///                    refuses them; all others are as without a failure.  An error callback is not called
    template <typename REAL>
    CellForest MakeForest(SurfaceFactory const &factory, REAL const meshPoints[],
                          typename Surface<REAL>::PointDescriptor const &pointDesc,
                          CellForest const *previous = nullptr, Counts *counts = nullptr,
                          FarExt::CallStatus *status = nullptr) const {
        return makeForest(factory, nullptr, {meshPoints, pointDesc.stride}, previous, counts,
                          status);
    }
    /// \brief Overload that uses, and keeps for the next view, how flat cells are.
    ///
    /// \param bounds  of the mesh
    template <typename REAL>
    CellForest MakeForest(ViewBounds &bounds, REAL const meshPoints[],
                          typename Surface<REAL>::PointDescriptor const &pointDesc,
                          CellForest const *previous = nullptr, Counts *counts = nullptr,
                          FarExt::CallStatus *status = nullptr) const {
        return makeForest(bounds.GetFactory(), &bounds, {meshPoints, pointDesc.stride}, previous,
                          counts, status);
    }

private:
    CellForest makeForest(SurfaceFactory const &factory, ViewBounds *bounds,
                          internal::PointArray const &meshPoints, CellForest const *previous,
                          Counts *counts, FarExt::CallStatus *status) const;

    std::shared_ptr<internal::ViewData const> _data; // never null: copied where it is moved
};

} // namespace OpenSubdivHex::BfrExt

#endif
