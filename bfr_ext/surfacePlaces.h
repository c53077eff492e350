// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_SURFACE_PLACES_H
#define OPENSUBDIVHEX_BFR_EXT_SURFACE_PLACES_H

#include "surfaceFactory.h"

#include "far_ext/stencilTableFactory.h"

#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt {

/// \brief Evaluates many points (face, u, v) of a mesh at once, in any order: hair roots, ray hits, samples of textures or
/// light, frame after frame.
///
/// \code
///     auto roots = BfrExt::SurfacePlaces<float>::Create(*factory, numRoots, faces, uvs);
///     roots->Evaluate(positions, 3, points, du, dv, 3); // each frame
/// \endcode
///
/// Results are those of Surface::Evaluate().  Patch points of a face are made once for all of its points, and then freed.
/// Threads share the faces (FarExt::SetExecutor()); results have the same bits for any number of threads.
///
/// Nothing is changed after construction: several threads may use it.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API SurfacePlaces {
public:
    /// A face.
    using Index = Far::Index;
    /// The size and distance of points.
    using PointDescriptor = typename Surface<REAL>::PointDescriptor;

    /// \brief The kind of data.
    struct Options {
        FarExt::StencilMode interpolationMode =
            FarExt::INTERPOLATE_VERTEX; ///< how points are refined
        int fvarChannel = 0;            ///< of face-varying points
    };

    /// \brief Finds the surfaces of the points.
    ///
    /// \param factory    which need not live on
    /// \param numPlaces  how many there are, 0 or more
    /// \param faces      by place, a base face of the factory
    /// \param uvs        by place, u and v in that face, which are finite
    /// \param options    what points are evaluated
    /// \param status     names a face without a surface, or a place that is not finite; no point is evaluated then
    /// \return           null on failure
    static std::unique_ptr<SurfacePlaces> Create(SurfaceFactory const &factory, int numPlaces,
                                                 Index const faces[], REAL const uvs[],
                                                 Options options,
                                                 FarExt::CallStatus *status = nullptr);
    /// Overload for vertex points.
    static std::unique_ptr<SurfacePlaces> Create(SurfaceFactory const &factory, int numPlaces,
                                                 Index const faces[], REAL const uvs[],
                                                 FarExt::CallStatus *status = nullptr) {
        return Create(factory, numPlaces, faces, uvs, Options(), status);
    }

    /// Number of points.
    int GetNumPlaces() const { return int(_numbers.size()); }

    /// \brief Writes the points, in the order of Create().
    ///
    /// \param meshPoints     of factory.GetLevel(): of its vertices, or values of the channel
    /// \param meshPointDesc  the size of a point, and the distance from one to the next
    /// \param p              points, of as many numbers
    /// \param resultDesc     the distance from one point to the next
    void Evaluate(REAL const meshPoints[], PointDescriptor const &meshPointDesc, REAL p[],
                  PointDescriptor const &resultDesc) const {
        Evaluate(meshPoints, meshPointDesc, p, nullptr, nullptr, resultDesc);
    }
    /// Overload with first derivatives.
    void Evaluate(REAL const meshPoints[], PointDescriptor const &meshPointDesc, REAL p[],
                  REAL du[], REAL dv[], PointDescriptor const &resultDesc) const;

private:
    SurfacePlaces() = default;

    std::vector<Surface<REAL>> _surfaces; // of the faces that have places
    std::vector<Index> _firstPlaces;      // of each, and the end
    std::vector<Index> _numbers;          // of the places, as they were given, by face
    std::vector<REAL> _uvs;               // of these
};

extern template class SurfacePlaces<float>;
extern template class SurfacePlaces<double>;

} // namespace OpenSubdivHex::BfrExt

#endif
