// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_MESH_SURFACES_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_MESH_SURFACES_H

#include "oracle.h"

#include "bfr_ext/cellForest.h"
#include "bfr_ext/patchStream.h"
#include "bfr_ext/surfaceFactory.h"

#include <memory>
#include <vector>

namespace OpenSubdivHex::Regression {

/// Makes the surface of a face, for one of the values of a case.
/// \return  whether it has one; \p status says why not
template <typename REAL>
bool InitSurface(BfrExt::SurfaceFactory const &factory, int face,
                 OracleLevels::Values const &values, BfrExt::Surface<REAL> *surface,
                 FarExt::CallStatus *status) {
    switch (values.mode) {
    case FarExt::INTERPOLATE_VERTEX:
        return factory.InitVertexSurface(face, surface, status);
    case FarExt::INTERPOLATE_VARYING:
        return factory.InitVaryingSurface(face, surface, status);
    default:
        return factory.InitFaceVaryingSurface(face, surface, values.channel, status);
    }
}

/// The surfaces of all base faces, for one of the values of a case, with their control points.
template <typename REAL>
struct MeshSurfaces {
    MeshSurfaces(OracleLevels const &levels, OracleLevels::Values const &values);

    bool Has(int face) const { return surfaces[std::size_t(face)].IsValid(); }
    /// Whether all that its neighbours share with a face is the same to the bit.  Around non-manifold
    /// vertices last bits may differ.
    bool IsJoined(int face) const;
    /// The control points of the face.
    REAL const *GetControlPoints(int face) const { return controlPoints[std::size_t(face)].data(); }
    /// Three rows: the point at \p uv, du and dv.
    ReferenceValues Evaluate(int face, REAL const uv[2]) const;
    /// The difference by which equal points may differ.
    double GetTolerance() const;

    OracleCase const &oracleCase;
    OracleLevels::Values const &values;
    int pointSize; ///< numbers
    std::unique_ptr<BfrExt::SurfaceFactory> factory;
    std::vector<REAL> points; ///< of the surface level
    std::vector<BfrExt::Surface<REAL>> surfaces;
    std::vector<std::vector<REAL>> controlPoints; ///< by face
};

/// \brief Tessellations of a forest: facets without gaps, and points that are the same as at single places,
/// on edges to the bit for all faces that have them.
template <typename REAL>
void CheckForest(MeshSurfaces<REAL> const &mesh, BfrExt::CellForest const &forest, Dice &dice);

/// \brief Tessellations of Bfr, with rates: points that are the same as at single places, on edges to the bit for both
/// faces.
template <typename REAL>
void CheckRates(MeshSurfaces<REAL> const &mesh, Dice &dice);

/// \brief Surfaces at (u, v), by patches of levels 2 to 5: exact at corners of cells, with derivatives that are those of
/// their points, the same from both faces beside an edge, and the same bits among SurfacePlaces.
template <typename REAL>
void CheckPlaces(MeshSurfaces<REAL> const &mesh, Dice &dice);

/// Streams of PatchLevels or of a CellForest: the same bits for any memory and threads, as numbered.
template <typename REAL, typename SOURCE>
void CheckStreams(MeshSurfaces<REAL> const &mesh, SOURCE const &source, Dice &dice);

/// \brief Forests for random cameras: as close to the surface as was asked for, nothing left coarse that is
/// seen, and the same as with bounds that were kept.
void CheckViews(MeshSurfaces<double> const &mesh, Dice &dice);

} // namespace OpenSubdivHex::Regression

#endif
