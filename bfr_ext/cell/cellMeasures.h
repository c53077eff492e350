// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_MEASURES_H

#include "flatness.h"
#include "slopeBounds.h"
#include "vector3.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// A box along the axes, which has no point at first.
struct Box {
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    bool HasPoints() const { return least[0] <= largest[0]; }
    void Add(double const *point) {
        for (std::size_t k = 0; k < 3; ++k) {
            least[k] = std::min(least[k], point[k]);
            largest[k] = std::max(largest[k], point[k]);
        }
    }

    Vector3 least = {kInfinity, kInfinity, kInfinity};
    Vector3 largest = {-kInfinity, -kInfinity, -kInfinity};
};

/// \brief What is known of a cell wherever it is seen from, as far as a view has asked for it.
struct CellMeasures {
    Box box;                 ///< of its points
    double longestSide = -1; ///< between corners; -1: not found
    double thickness = -1;   ///< as Flatness estimates it; -1: not found
    int firstChild = 0;      ///< in the same face; 0: none were asked for
    int facing = -1;         ///< in the same face; -1: not found
};

/// \brief Where a cell faces: (Du x Dv) at its points.
struct CellFacing {
    int numSteps = 0;    ///< how many steps on all cells have bounds of their normals, at least
    Vector3 corner = {}; ///< one of the surface's points at corners
    Vector3 area = {};   ///< twice that of the polygon of these, along its normal
    // Of the cell as a whole, from here on, once it is asked for.
    bool hasNormals = false;
    SlopeBounds::Normals normals = {};
    Vector3 center = {}; ///< of the points
    double radius = 0;   ///< of the points around it
    double depth = 0;    ///< of the points below it, along the middle normal
};

/// \brief The same of the cells of a base face that views have asked for: first that of the face, and
/// children of one cell one behind the other.
struct FaceMeasures {
    void Clear() {
        cells.clear();
        facings.clear();
    }
    /// Memory, in bytes.
    std::size_t GetMemory() const {
        return cells.capacity() * sizeof(CellMeasures) + facings.capacity() * sizeof(CellFacing);
    }

    std::vector<CellMeasures> cells;
    std::vector<CellFacing> facings;
};

/// Those of all base faces of a mesh.  Several threads may work at different faces.
struct MeshMeasures {
    explicit MeshMeasures(int numFaces) : faces(std::size_t(numFaces)) {}

    std::vector<FaceMeasures> faces;
    std::atomic<std::size_t> memory{0}; ///< that they take, in bytes
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
