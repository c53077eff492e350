// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_COPLANAR_EDGES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_COPLANAR_EDGES_H

#include "hierarchy.h"

#include "far_ext/hexSchemeOptions.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Finds the edges between faces of the same normal, level by level: TopologyRefiner::
/// RefineCoplanar says which count.
class CoplanarEdges {
public:
    /// Refers to \p hierarchy.
    CoplanarEdges(Hierarchy const &hierarchy, HexSchemeOptions schemeOptions, double angleTolerance)
        : _hierarchy(hierarchy), _schemeOptions(schemeOptions), _angleTolerance(angleTolerance) {}

    /// Takes x, y, z of the vertices of level 0.  Returns what is wrong with these or with the
    /// options, or Ok.
    template <typename REAL>
    CallStatus Begin(REAL const *restPositions);
    /// Goes on to the next level, which is there by now.
    void Refine();

    /// By edge of the level: whether it is flat.
    std::vector<unsigned char> FindFlat() const;

private:
    struct Vector {
        void Clear() { *this = Vector(); }
        void AddWithWeight(Vector const &other, double weight) {
            x += weight * other.x;
            y += weight * other.y;
            z += weight * other.z;
        }

        double x = 0;
        double y = 0;
        double z = 0;
    };

    friend Vector operator-(Vector const &a, Vector const &b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    static double dot(Vector const &a, Vector const &b);
    static double length(Vector const &a);
    static Vector cross(Vector const &a, Vector const &b);

    Level const &level() const { return _hierarchy.mesh.levels[_depth]; }
    Vector faceNormal(Far::Index face) const;
    bool isParallel(Vector const &normal0, Vector const &normal1) const;
    bool hasFeature(Far::Index edge) const;

    Hierarchy const &_hierarchy;
    HexSchemeOptions const _schemeOptions;
    double const _angleTolerance; ///< in degrees
    std::size_t _depth = 0;
    std::vector<Vector> _positions;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
