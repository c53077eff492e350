// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H
#define OPENSUBDIVHEX_BFR_EXT_PARAMETERIZATION_H

#include "far_ext/export.h"

#include <opensubdiv/bfr/parameterization.h>

namespace OpenSubdivHex::BfrExt {

/// \brief The parameter plane of a base face, with the names of Bfr::Parameterization.
///
/// There the face is a regular polygon with sides 1 long, counter-clockwise, whose edge 0 runs from
/// (0, 0) to (1, 0): of a quad the unit square.  So it is in one piece, whatever its size, and there
/// are no sub-faces.  These are the coordinates of FarExt::TopologyLevel::GetFaceSurfaceCoords(), which
/// says where the vertices of all levels lie.
class OPENSUBDIVHEX_API Parameterization {
public:
    /// An invalid one.
    Parameterization() = default;
    /// That of a face of \p faceSize vertices; invalid for fewer than 3.
    explicit Parameterization(int faceSize) : _faceSize(faceSize < 3 ? 0 : faceSize) {}

    /// Whether it is that of a face.
    bool IsValid() const { return _faceSize > 0; }
    /// Vertices of the face; 0 of an invalid one.
    int GetFaceSize() const { return _faceSize; }
    /// Never: see above.
    static bool HasSubFaces() { return false; }

    /// Writes u and v of vertex 0 ... GetFaceSize() - 1.
    template <typename REAL>
    void GetVertexCoord(int vertex, REAL uv[2]) const {
        GetEdgeCoord(vertex, REAL(0), uv);
    }
    /// Writes u and v of the point of edge 0 ... GetFaceSize() - 1 at \p t, which is 0 at vertex
    /// \p edge and 1 at the next.
    template <typename REAL>
    void GetEdgeCoord(int edge, REAL t, REAL uv[2]) const {
        double coords[2];
        findCoords(edge, 1 - double(t), double(t), coords);
        uv[0] = REAL(coords[0]);
        uv[1] = REAL(coords[1]);
    }
    /// Writes u and v of the centre.
    template <typename REAL>
    void GetCenterCoord(REAL uv[2]) const {
        double coords[2];
        findCoords(0, 0, 0, coords);
        uv[0] = REAL(coords[0]);
        uv[1] = REAL(coords[1]);
    }

    /// @name Bfr's parameterizations of the same face
    /// @{

    /// \brief That of which Bfr::Tessellations are made for Surface::Evaluate(): of a quad the unit square, of a
    /// triangle the right-angled one of Loop, and of others the sub-faces of Catmull-Clark.
    ///
    /// Invalid for an invalid one, and for more vertices than Bfr allows.
    OpenSubdiv::Bfr::Parameterization GetBfr() const;

    /// \brief Writes where (u, v) of Bfr lies in the parameter plane: the same in quads, and in triangles a linear
    /// map of it.  A sub-face is mapped bilinearly to the kite of its corner, the centre of the face, and the
    /// middles of two edges between them.
    ///
    /// Sub-faces are found as Bfr::Parameterization finds them; (u, v) outside of the face are mapped by the same
    /// functions.  Nothing but NaN is written where u or v is not finite, or \p bfr is invalid.
    ///
    /// \param bfr          of any face
    /// \param bfrUv        two numbers
    /// \param uv           two numbers, may be \p bfrUv
    /// \param derivatives  four numbers, or null: those of u and v by Bfr's u, then by its v.  With them
    ///                     derivatives d of a surface are, by Bfr's u, d[0] du + d[1] dv, and by its
    ///                     v, d[2] du + d[3] dv
    template <typename REAL>
    static void ConvertFromBfr(OpenSubdiv::Bfr::Parameterization const &bfr, REAL const bfrUv[2],
                               REAL uv[2], REAL derivatives[4] = nullptr) {
        double const from[2] = {double(bfrUv[0]), double(bfrUv[1])};
        double to[6];
        convertFromBfr(bfr, from, to);
        uv[0] = REAL(to[0]);
        uv[1] = REAL(to[1]);
        for (int i = 0; derivatives && i < 4; ++i) {
            derivatives[i] = REAL(to[2 + i]);
        }
    }
    /// @}

private:
    static void convertFromBfr(OpenSubdiv::Bfr::Parameterization const &bfr, double const bfrUv[2],
                               double result[6]);
    void findCoords(int edge, double start, double end, double uv[2]) const;

    int _faceSize = 0;
};

} // namespace OpenSubdivHex::BfrExt

#endif
