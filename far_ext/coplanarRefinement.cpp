// SPDX-License-Identifier: Apache-2.0
#include "fvarLevel.h"
#include "parallel.h"
#include "polygonRefinement.h"
#include "primvarRefiner.h"
#include "sizeChecker.h"

#include <cmath>

namespace OpenSubdivHex::FarExt {

using Far::Index;
using Sdc::Crease;

namespace {

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

Vector operator-(Vector const &a, Vector const &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(Vector const &a, Vector const &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Vector const &a) { return std::hypot(a.x, a.y, a.z); }
Vector cross(Vector const &a, Vector const &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The direction of the vector area of a face, 1 long; zero when that is nothing but rounding errors.
Vector faceNormal(TopologyLevel const &level, Index face, std::vector<Vector> const &positions) {
    constexpr double kRounding = 1e-12;
    Far::ConstIndexArray const verts = level.GetFaceVertices(face);
    Vector const &origin = positions[verts[0]];
    Vector normal;
    double size = 0;
    for (int i = 1; i + 1 < verts.size(); ++i) {
        Vector const side0 = positions[verts[i]] - origin;
        Vector const side1 = positions[verts[i + 1]] - origin;
        normal.AddWithWeight(cross(side0, side1), 1);
        size += dot(side0, side0) + dot(side1, side1);
    }
    double const area = length(normal);
    return area > kRounding * size ? Vector{normal.x / area, normal.y / area, normal.z / area}
                                   : Vector();
}

bool isParallel(Vector const &normal0, Vector const &normal1, double angleTolerance) {
    constexpr double kDegrees = 180 / 3.14159265358979323846;
    double const angle = std::atan2(length(cross(normal0, normal1)), dot(normal0, normal1));
    return length(normal0) > 0 && length(normal1) > 0 && angle * kDegrees <= angleTolerance;
}

// Whether a feature wants the hexagon of an interior edge.
bool hasFeature(TopologyLevel const &level, Index edge) {
    auto const faces = level.GetEdgeFaces(edge);
    auto const verts = level.GetEdgeVertices(edge);
    auto const isFeatureFace = [&](Index face) {
        return level.IsFaceHalf(face) || Crease::IsSharp(level.GetFaceDiagonalSharpness(face));
    };
    auto const isFeatureVertex = [&](Index vert) {
        return level.IsVertexNonManifold(vert) || Crease::IsSharp(level.GetVertexSharpness(vert));
    };
    bool isSeam = false;
    for (int channel = 0; channel < level.GetNumFVarChannels(); ++channel) {
        isSeam |= !level.DoesEdgeFVarTopologyMatch(edge, channel) ||
                  level.IsFaceFVarSplit(faces[0], channel) ||
                  level.IsFaceFVarSplit(faces[1], channel);
    }
    return isSeam || Crease::IsSharp(level.GetEdgeSharpness(edge)) || isFeatureFace(faces[0]) ||
           isFeatureFace(faces[1]) || isFeatureVertex(verts[0]) || isFeatureVertex(verts[1]);
}

std::vector<unsigned char> findFlatEdges(TopologyLevel const &level,
                                         std::vector<Vector> const &positions,
                                         double angleTolerance) {
    std::vector<Vector> normals(level.GetNumFaces());
    internal::ParallelFor(level.GetNumFaces(),
                          [&](Index face) { normals[face] = faceNormal(level, face, positions); });
    std::vector<unsigned char> result(level.GetNumEdges());
    internal::ParallelFor(level.GetNumEdges(), [&](Index edge) {
        if (!level.IsEdgeBoundary(edge) && !hasFeature(level, edge)) {
            auto const faces = level.GetEdgeFaces(edge);
            result[edge] = isParallel(normals[faces[0]], normals[faces[1]], angleTolerance);
        }
    });
    return result;
}

Status checkArguments(bool hasPositions, double angleTolerance, SchemeOptions schemeOptions) {
    auto const failure = [](StatusCode code, std::string message) {
        return Status(code, ComponentType::None, Far::INDEX_INVALID, std::move(message));
    };
    if (!schemeOptions.IsHexagonal()) {
        return failure(StatusCode::Unsupported,
                       "refinement by coplanar faces is for the hexagonal scheme alone");
    }
    if (!hasPositions) {
        return failure(StatusCode::InvalidArgument, "the rest positions are null");
    }
    if (!(0 <= angleTolerance && angleTolerance <= 180)) {
        return failure(StatusCode::InvalidArgument, "the angle tolerance " +
                                                        std::to_string(angleTolerance) +
                                                        " is not between 0 and 180 degrees");
    }
    return Status();
}

// The least sizes that the child of a level of the least \p parent sizes has, whichever edges are
// flat: those make no fewer edges and faces than others, but V-vertices may all be missing.  Where
// gaps stay open, all edges but those of the F-faces may become boundaries, which make the fewest
// edges later.
internal::LevelSizes getLeastChildSizes(internal::LevelSizes const &parent, bool closeGaps,
                                        std::int64_t numDigons) {
    internal::LevelSizes sizes = internal::GetChildSizes(parent);
    sizes.vertices = parent.corners;
    // But for digons, where two quads share an edge.
    sizes.edges -= numDigons;
    sizes.corners -= 2 * numDigons;
    if (!closeGaps) {
        std::int64_t const interiorEdges = parent.corners - parent.sharpBoundariesB;
        sizes.freeBoundaries =
            sizes.edges - interiorEdges - sizes.sharpBoundariesA - sizes.sharpBoundariesB;
        sizes.corners = sizes.edges + interiorEdges;
    }
    return sizes;
}

Status checkLeastSizes(internal::LevelTopology const &base, bool closeGaps, int refinementLevel) {
    // A vertex with two faces makes a digon in one level, or in none: most edges are missing then
    // when all do in the first.
    std::int64_t numDigons = 0;
    for (Index vert = 0; vert < base.numVertices; ++vert) {
        internal::ForEachFan(base, vert, [&](internal::VertexFan const &fan) {
            numDigons += fan.isClosed && fan.end - fan.begin == 2 ? 1 : 0;
        });
    }
    internal::LevelSizes sizes = internal::GetSizes(base);
    internal::SizeChecker checker(sizes, " or more");
    Status status;
    for (int level = 1; level <= refinementLevel && status.IsOk(); ++level) {
        sizes = getLeastChildSizes(sizes, closeGaps, level == 1 ? numDigons : 0);
        status = checker.Add(sizes);
    }
    return status;
}

template <typename REAL>
Status importPositions(REAL const *restPositions, Index numVertices, std::vector<Vector> &result) {
    result.resize(numVertices);
    for (Index vert = 0; vert < numVertices; ++vert) {
        REAL const *position = restPositions + 3 * std::size_t(vert);
        result[vert] = {double(position[0]), double(position[1]), double(position[2])};
        if (!std::isfinite(length(result[vert]))) {
            return Status(StatusCode::InvalidArgument, ComponentType::Vertex, vert,
                          "the rest position of vertex " + std::to_string(vert) +
                              " is not finite, or too far away");
        }
    }
    return Status();
}

} // namespace

template <typename REAL>
bool TopologyRefiner::refineCoplanar(REAL const *restPositions, CoplanarOptions const &options,
                                     Status *status) {
    std::vector<Vector> positions;
    Status result = checkLevel(options.refinementLevel);
    if (result.IsOk()) {
        result = checkArguments(restPositions, options.angleTolerance, _schemeOptions);
    }
    if (result.IsOk()) {
        result = importPositions(restPositions, GetLevel(0).GetNumVertices(), positions);
    }
    if (result.IsOk()) {
        result = checkSizes(options.refinementLevel, [&](int level) {
            return checkLeastSizes(GetLevel(0).GetTopology(), options.closeGaps, level);
        });
    }
    if (!result.IsOk()) {
        return internal::Report(result, status);
    }
    result = replaceLevels([&] {
        std::vector<internal::SizeChecker> checkers = makeSizeCheckers();
        for (int level = 1; level <= options.refinementLevel; ++level) {
            internal::PolygonRules rules;
            rules.flatEdges = findFlatEdges(GetLevel(level - 1), positions, options.angleTolerance);
            rules.closeGaps = options.closeGaps;
            bool const isLast = level == options.refinementLevel;
            Status levelStatus = refineToPolygons(level, !isLast || options.fullTopologyInLastLevel,
                                                  rules, checkers);
            if (!levelStatus.IsOk()) {
                return levelStatus;
            }
            setNumLevels(level + 1);
            if (!isLast) {
                std::vector<Vector> refined(GetLevel(level).GetNumVertices());
                PrimvarRefinerReal<double>(*this).Interpolate(level, positions, refined);
                positions.swap(refined);
            }
        }
        _isUniform = false;
        return Status();
    });
    return internal::Report(result, status);
}

bool TopologyRefiner::RefineCoplanar(float const *restPositions, CoplanarOptions options,
                                     Status *status) {
    return refineCoplanar(restPositions, options, status);
}

bool TopologyRefiner::RefineCoplanar(double const *restPositions, CoplanarOptions options,
                                     Status *status) {
    return refineCoplanar(restPositions, options, status);
}

} // namespace OpenSubdivHex::FarExt
