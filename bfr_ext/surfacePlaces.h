// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_SURFACE_PLACES_H
#define OPENSUBDIVHEX_BFR_EXT_SURFACE_PLACES_H

#include "surfaceFactory.h"

#include "far_ext/stencilTableFactory.h"

#include <memory>
#include <vector>

namespace OpenSubdivHex::BfrExt {

/// \brief Places of any faces of a mesh, in any order, that are evaluated together: ray hits, samples of a texture
/// or of light, or roots of hair, which follow an animation.
///
/// Each point is that of Surface::Evaluate() at a (u, v) of a face.  Patch points of a face are made once for all of
/// its places, whatever the order, and given up behind it: memory is that of the places, and of the surfaces that
/// they lie on.  Threads share the faces (FarExt::SetExecutor()); results have the same bits for any number of these.
///
/// Nothing is changed after construction: several threads may use it.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API SurfacePlaces {
public:
    /// A face.
    using Index = Far::Index;
    /// The size and distance of points.
    using PointDescriptor = typename Surface<REAL>::PointDescriptor;

    /// \brief What the points are.
    struct Options {
        FarExt::StencilMode interpolationMode =
            FarExt::INTERPOLATE_VERTEX; ///< how points are refined
        int fvarChannel = 0;            ///< of face-varying points
    };

    /// \brief Finds the surfaces of places.
    ///
    /// \param factory    which need not live on
    /// \param numPlaces  how many there are, 0 or more
    /// \param faces      by place, a face of factory.GetLevel()
    /// \param uvs        by place, u and v in that face
    /// \param options    what points are evaluated
    /// \param status     of a face without a surface, as SurfaceFactory has it: none of the places is evaluated then
    /// \return           null on failure
    static std::unique_ptr<SurfacePlaces> Create(SurfaceFactory const &factory, int numPlaces,
                                                 Index const faces[], REAL const uvs[],
                                                 Options options,
                                                 FarExt::CallStatus *status = nullptr);
    /// The same of vertex points.
    static std::unique_ptr<SurfacePlaces> Create(SurfaceFactory const &factory, int numPlaces,
                                                 Index const faces[], REAL const uvs[],
                                                 FarExt::CallStatus *status = nullptr) {
        return Create(factory, numPlaces, faces, uvs, Options(), status);
    }

    /// How many places there are.
    int GetNumPlaces() const { return int(_places.size()); }

    /// \brief Writes the points at all places, in the order in which these were given.
    ///
    /// \param meshPoints     of factory.GetLevel(): of its vertices, or values of the channel
    /// \param meshPointDesc  the size of a point, and the distance from one to the next
    /// \param p              points, of as many numbers
    /// \param resultDesc     the distance from one point to the next
    void Evaluate(REAL const meshPoints[], PointDescriptor const &meshPointDesc, REAL p[],
                  PointDescriptor const &resultDesc) const;
    /// The same with first derivatives.
    void Evaluate(REAL const meshPoints[], PointDescriptor const &meshPointDesc, REAL p[],
                  REAL du[], REAL dv[], PointDescriptor const &resultDesc) const;

private:
    struct Place {
        Index number; // as it was given
        REAL uv[2];
    };

    SurfacePlaces() = default;
    template <typename FUNCTION>
    void forEachPlace(REAL const *meshPoints, PointDescriptor const &meshPointDesc,
                      FUNCTION const &function) const;

    std::vector<Surface<REAL>> _surfaces; // of the faces that have places
    std::vector<Index> _firstPlaces;      // of each, and the end
    std::vector<Place> _places;           // by face
};

extern template class SurfacePlaces<float>;
extern template class SurfacePlaces<double>;

} // namespace OpenSubdivHex::BfrExt

#endif
