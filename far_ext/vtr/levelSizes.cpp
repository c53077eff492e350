// SPDX-License-Identifier: Apache-2.0
#include "levelSizes.h"

#include "vertexFan.h"

#include <limits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<Far::Index>::max();

struct Count {
    char const *name;
    std::int64_t value;
};

CallStatus tooLarge(int level, Count const &count, std::string const &where) {
    return CallStatus(StatusCode::TooLarge, ComponentType::Level, level,
                      "level " + std::to_string(level) + " would have " +
                          std::to_string(count.value) + " " + count.name + where +
                          ", more than the 2147483647 that 32-bit indices reach");
}

} // namespace

LevelSizes GetSizes(Level const &level) {
    return {level.numVertices,        level.numEdges,          level.numFaces,
            level.numCorners,         level.numFreeBoundaries, level.numSharpBoundariesA,
            level.numSharpBoundariesB};
}

// With A, B and free boundary edges: V' = V + C, E' = 2C + A + free, F' = F + E - B,
// C' = C + 6 (E - A - B - free) + 4 (A + free), A' = 2B, B' = A + B.  On a closed mesh C = 2E, so
// that E' = 4E, V' = V + 2E and C' = 4C: see INDEXING.md.
LevelSizes GetHexagonalSizes(LevelSizes const &p) {
    std::int64_t const boundaryEFaces = p.freeBoundaries + p.sharpBoundariesA;
    std::int64_t const interiorEdges = p.edges - boundaryEFaces - p.sharpBoundariesB;
    return {p.vertices + p.corners,
            2 * p.corners + boundaryEFaces,
            p.faces + p.edges - p.sharpBoundariesB,
            p.corners + HexIndexing::kNumEFaceCorners * interiorEdges +
                HexIndexing::kNumBoundaryEFaceCorners * boundaryEFaces,
            p.freeBoundaries,
            2 * p.sharpBoundariesB,
            p.sharpBoundariesA + p.sharpBoundariesB};
}

ExpectedSizes::ExpectedSizes(Level const &level)
    : sizes(GetSizes(level)), interiorEdges(level.numEdges - level.GetNumBoundaries()) {}

void ExpectedSizes::CountFans(Level const &level) {
    for (Far::Index vert = 0; vert < level.numVertices; ++vert) {
        ForEachFan(level, vert, [&](VertexFan const &fan) {
            std::int64_t const size = fan.GetSize();
            closedVertices += fan.isClosed ? 1 : 0;
            closedCorners += fan.isClosed ? size : 0;
            digons += fan.isClosed && size == 2 ? 1 : 0;
        });
    }
}

void ExpectedSizes::Refine(StepType step) {
    LevelSizes const p = sizes;
    std::int64_t const pInteriorEdges = interiorEdges;
    sizes = {};
    switch (step) {
    case StepType::Hexagonal:
        sizes = GetHexagonalSizes(p);
        interiorEdges =
            sizes.edges - sizes.freeBoundaries - sizes.sharpBoundariesA - sizes.sharpBoundariesB;
        closedVertices = closedCorners = digons = 0; // not asked for again
        break;
    case StepType::DooSabin: {
        // A quad per interior edge, a V-face per closed vertex but for digons, where two quads
        // share an edge.  The F-vertices of V-faces are closed, with four faces each, those of
        // digons with three.
        std::int64_t const vFaces = closedVertices - digons;
        std::int64_t const vFaceCorners = closedCorners - 2 * digons;
        sizes.vertices = p.corners;
        sizes.edges = p.corners + 2 * pInteriorEdges - digons;
        sizes.faces = p.faces + pInteriorEdges + vFaces;
        sizes.corners = p.corners + 4 * pInteriorEdges + vFaceCorners;
        interiorEdges = 2 * pInteriorEdges + vFaceCorners + digons;
        closedVertices = vFaceCorners + 2 * digons;
        closedCorners = 4 * vFaceCorners + 6 * digons;
        digons = 0;
        break;
    }
    case StepType::TriHex:
    case StepType::Truncate:
        // A polygon per vertex, and a vertex for each side of an edge (TriHex) or for each end
        // (Truncate): as many.
        sizes.vertices = p.corners;
        sizes.edges = p.corners + p.edges;
        sizes.faces = p.faces + closedVertices;
        sizes.corners = 3 * p.corners;
        interiorEdges = sizes.edges;
        closedVertices = sizes.vertices;
        closedCorners = sizes.corners;
        digons = 0;
        break;
    }
}

// Flat edges make no fewer edges and faces than others, but V-vertices may all be missing.  Where
// gaps stay open, all edges but those of the F-faces may become boundaries, which make the fewest
// edges later.  A vertex with two faces makes a digon, where two quads share an edge, in one level
// or in none: most edges are missing when all do in the first.
void ExpectedSizes::RefineToLeast(bool closeGaps) {
    LevelSizes const p = sizes;
    sizes = GetHexagonalSizes(p);
    sizes.vertices = p.corners;
    sizes.edges -= digons;
    sizes.corners -= 2 * digons;
    digons = 0;
    if (!closeGaps) {
        std::int64_t const sideEdges = p.corners - p.sharpBoundariesB;
        sizes.freeBoundaries =
            sizes.edges - sideEdges - sizes.sharpBoundariesA - sizes.sharpBoundariesB;
        sizes.corners = sizes.edges + sideEdges;
    }
}

CallStatus SizeChecker::Add(LevelSizes const &sizes) {
    ++_level;
    _total.vertices += sizes.vertices;
    _total.edges += sizes.edges;
    _total.faces += sizes.faces;
    _total.corners += sizes.corners;
    // The edge-vertices are the longest array.
    for (Count const &count : {Count{"vertices", sizes.vertices}, Count{"edges", sizes.edges},
                               Count{"faces", sizes.faces}, Count{"face-vertices", sizes.corners},
                               Count{"edge-vertices", 2 * sizes.edges}}) {
        if (count.value > kMaxCount) {
            return tooLarge(_level, count, _place);
        }
    }
    for (Count const &count :
         {Count{"vertices", _total.vertices}, Count{"edges", _total.edges},
          Count{"faces", _total.faces}, Count{"face-vertices", _total.corners}}) {
        if (count.value > kMaxCount) {
            return tooLarge(_level, count, _place + " together with the levels before");
        }
    }
    return CallStatus();
}

} // namespace OpenSubdivHex::FarExt::internal
