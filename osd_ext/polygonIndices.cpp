// SPDX-License-Identifier: Apache-2.0
#include "polygonIndices.h"

#include "drawing/vertexSeparator.h"

#include "far_ext/baseFaceMap.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/buffer.h"
#include "far_ext/vtr/hierarchy.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <limits>
#include <numeric>
#include <string>

namespace OpenSubdivHex::OsdExt {

namespace {

using Far::ConstIndexArray;
using Far::Index;
using FarExt::BaseFaceMap;
using FarExt::CallStatus;
using FarExt::StatusCode;
using FarExt::TopologyLevel;
using FarExt::internal::FVarLevel;
using FarExt::internal::ParallelForRange;
using FarExt::internal::ParallelSums;

// The parts in which a face is drawn: bits for its halves, or all of it.
enum Parts : unsigned char { kBothHalves = 3, kWhole = 4 };

// A polygon, its first corner.
struct PolygonPlace {
    PolygonPlace &operator+=(PolygonPlace const &other) {
        polygon += other.polygon;
        corner += other.corner;
        return *this;
    }

    std::size_t polygon = 0;
    std::size_t corner = 0;
};

class Cutter {
public:
    Cutter(TopologyLevel const &level, DrawOptions const &options)
        : _level(level), _options(options), _map(level), _mesh(level.GetLevel()) {}

    PolygonIndices Run() {
        decideCuts();
        auto const places =
            ParallelSums<PolygonPlace>(_level.GetNumFaces(), [&](Index begin, Index end) {
                PolygonPlace sum;
                forEachRun(begin, end, [&](DrawnRun const &run) { sum += getSize(run); });
                return sum;
            });
        resize(places.back());
        ParallelForRange(_level.GetNumFaces(), [&](Index begin, Index end) {
            PolygonPlace place = places[std::size_t(begin / FarExt::internal::kParallelRange)];
            forEachRun(begin, end, [&](DrawnRun const &run) {
                writePolygons(run, place);
                writeCorners(run, place);
                place += getSize(run);
            });
        });
        return std::move(_result);
    }

private:
    // Which parts of the split faces are drawn.
    void decideCuts() {
        _parts.resize(_map.GetSplitFaces().size());
        ParallelForRange(Index(_parts.size()), [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                BaseFaceMap::SplitFace const &split = _map.GetSplitFaces()[std::size_t(i)];
                unsigned const holes = _options.drawHoles ? 0 : _mesh.GetHoles(split.face);
                unsigned const drawn = kBothHalves & ~holes;
                bool const isWhole = drawn == kBothHalves && !isCut(split);
                _parts[std::size_t(i)] = Parts(isWhole ? unsigned(kWhole) : drawn);
            }
        });
    }

    bool isCut(BaseFaceMap::SplitFace const &split) const {
        if (_options.cutBaseFaces || _options.generateBaseCoords ||
            getLabel(split.baseFaces[0]) != getLabel(split.baseFaces[1])) {
            return true;
        }
        float const sharpness = _mesh.GetDiagonalSharpness(split.face);
        if (Sdc::Crease::IsInfinite(sharpness)
                ? _options.cutCreases != CreaseCuts::NoCreases || _options.sides
                : _options.cutCreases == CreaseCuts::All && Sdc::Crease::IsSharp(sharpness)) {
            return true;
        }
        for (int channel : _options.fvarChannels) {
            if (_level.IsFaceFVarSplit(split.face, channel)) {
                return true;
            }
        }
        return false;
    }

    int getLabel(Index baseFace) const {
        return _options.labels.empty() ? 0 : _options.labels[baseFace];
    }

    // Whole faces that follow one another; or, where half is not negative, that half of one face.
    struct DrawnRun {
        Index begin;
        Index end;
        int half;
    };

    PolygonPlace getSize(DrawnRun const &run) const {
        if (run.half >= 0) {
            return {1, std::size_t(getNumCorners(run.begin, run.half))};
        }
        return {std::size_t(run.end - run.begin),
                std::size_t(_mesh.faceFirstCorner[run.end] - _mesh.faceFirstCorner[run.begin])};
    }

    // Calls function(run) for what is drawn of faces [begin, end).
    template <typename FUNCTION>
    void forEachRun(Index begin, Index end, FUNCTION function) const {
        auto const &splitFaces = _map.GetSplitFaces();
        auto split = std::lower_bound(
            splitFaces.begin(), splitFaces.end(), begin,
            [](BaseFaceMap::SplitFace const &other, Index face) { return other.face < face; });
        bool const hasHoles = !_options.drawHoles && !_mesh.faceHoles.empty();
        Index next = begin; // the first face that no run has
        auto const addParts = [&](Index face, unsigned parts) {
            if (parts == kWhole) {
                return;
            }
            if (next < face) {
                function(DrawnRun{next, face, -1});
            }
            for (int half = 0; half < 2; ++half) {
                if ((parts >> half & 1u) != 0) {
                    function(DrawnRun{face, face + 1, half});
                }
            }
            next = face + 1;
        };
        for (Index face = begin; face < end;) {
            if (split != splitFaces.end() && split->face == face) {
                addParts(face++, _parts[std::size_t(split - splitFaces.begin())]);
                ++split;
            } else if (hasHoles) {
                // V-faces count to their first base face, and are holes when all of theirs are: so a
                // hexagon beside one may be half a hole in one base face, too.
                unsigned const holes = _mesh.GetHoles(face);
                addParts(face++, holes != 0 ? kBothHalves & ~holes : unsigned(kWhole));
            } else {
                face = split != splitFaces.end() ? std::min(split->face, end) : end;
            }
        }
        if (next < end) {
            function(DrawnRun{next, end, -1});
        }
    }

    void resize(PolygonPlace const &size) {
        auto const resizeIf = [](bool isWanted, auto &array, std::size_t count) {
            if (isWanted && count > 0) {
                FarExt::internal::ResizeLarge(array, count);
            }
        };
        resizeIf(true, _result.sizes, size.polygon);
        resizeIf(true, _result.vertices, size.corner);
        _result.fvarValues.resize(_options.fvarChannels.size());
        for (std::vector<int> &values : _result.fvarValues) {
            resizeIf(true, values, size.corner);
        }
        resizeIf(_options.sides, _result.sides, size.corner);
        resizeIf(_options.generateBaseCoords, _result.baseCoords, 2 * size.corner);
        resizeIf(true, _result.faces, size.polygon);
        resizeIf(true, _result.baseFaces, size.polygon);
        resizeIf(!_options.labels.empty(), _result.labels, size.polygon);
    }

    void writePolygons(DrawnRun const &run, PolygonPlace const &place) {
        int const half = std::max(run.half, 0);
        std::size_t polygon = place.polygon;
        for (Index face = run.begin; face < run.end; ++face, ++polygon) {
            Index const baseFace = _map.GetBaseFace(face, half);
            _result.sizes[polygon] = getNumCorners(face, run.half);
            _result.faces[polygon] = face;
            _result.baseFaces[polygon] = baseFace;
            if (!_options.labels.empty()) {
                _result.labels[polygon] = _options.labels[baseFace];
            }
        }
    }

    void writeCorners(DrawnRun const &run, PolygonPlace const &place) {
        int *const vertices = _result.vertices.data() + place.corner;
        if (!_options.splitVertices) {
            Index const first = _mesh.faceFirstCorner[run.begin];
            copyPart({_mesh.faceVerts.data() + first, _mesh.faceFirstCorner[run.end] - first},
                     run.half, _mesh.GetDiagonalEnd(run.begin), vertices);
            addOffset(vertices, getSize(run).corner);
        }
        if (_options.sides || !_options.fvarChannels.empty() || _options.generateBaseCoords) {
            std::size_t corner = place.corner;
            for (Index face = run.begin; face < run.end; ++face) {
                int const size = getNumCorners(face, run.half);
                writeFurther(face, run.half, size, corner);
                corner += std::size_t(size);
            }
        }
        if (_options.splitVertices) {
            std::copy_n(_result.sides.data() + place.corner, getSize(run).corner, vertices);
            addOffset(vertices, getSize(run).corner);
        }
    }

    void addOffset(int *vertices, std::size_t count) const {
        for (std::size_t i = 0; i < count && _options.vertexOffset != 0; ++i) {
            vertices[i] += _options.vertexOffset;
        }
    }

    // Attributes of corners besides vertices.
    void writeFurther(Index face, int half, int size, std::size_t corner) {
        for (int i = 0; i < size && _options.sides; ++i) {
            int const local =
                half < 0 ? i : FarExt::GetPlaceInHalves(half, i, _mesh.GetDiagonalEnd(face));
            _result.sides[corner + std::size_t(i)] =
                _options.sides->FindSide(_level, face, local, std::max(half, 0));
        }
        for (std::size_t i = 0; i < _options.fvarChannels.size(); ++i) {
            copyValues(face, half, _options.fvarChannels[i], _result.fvarValues[i].data() + corner);
        }
        if (_options.generateBaseCoords) {
            _level.GetFaceBaseCoords(face, std::max(half, 0),
                                     _result.baseCoords.data() + 2 * corner);
        }
    }

    // The corners of a face, or of a half of it.
    int getNumCorners(Index face, int half) const {
        int const size = _mesh.GetFaceSize(face);
        return half < 0 ? size : FarExt::GetHalfSize(half, size, _mesh.GetDiagonalEnd(face));
    }

    static void copyAll(ConstIndexArray from, int *to) { std::copy(from.begin(), from.end(), to); }
    // Copies all, or those of a half, of what the corners of a face have.
    static void copyPart(ConstIndexArray from, int half, int diagonalEnd, int *to) {
        if (half < 0) {
            copyAll(from, to);
            return;
        }
        for (int i = 0; i < FarExt::GetHalfSize(half, from.size(), diagonalEnd); ++i) {
            *to++ = from[FarExt::GetPlaceInHalves(half, i, diagonalEnd)];
        }
    }

    // Seams cross split faces alone.
    void copyValues(Index face, int half, int channel, int *to) const {
        if (half < 0 && _level.GetDepth() > 0) {
            FVarLevel const &values = _level.GetHierarchy()
                                          .channels[std::size_t(channel)]
                                          .levels[std::size_t(_level.GetDepth())];
            copyAll(values.values->GetFaceVertices(values.valueFaces[face]), to);
        } else if (half >= 0 && _level.IsFaceFVarSplit(face, channel)) {
            copyAll(_level.GetFaceFVarValues(face, channel, half), to);
        } else {
            copyPart(_level.GetFaceFVarValues(face, channel), half, _mesh.GetDiagonalEnd(face), to);
        }
    }

    TopologyLevel const &_level;
    DrawOptions const &_options;
    BaseFaceMap const _map;
    FarExt::internal::Level const &_mesh;
    std::vector<Parts> _parts; // by split face
    PolygonIndices _result;
};

// Vertices of the level, or sides.
Index getNumVertices(TopologyLevel const &level, DrawOptions const &options) {
    return options.splitVertices ? options.sides->GetNumSides() : level.GetNumVertices();
}

CallStatus checkOptions(TopologyLevel const &level, DrawOptions const &options) {
    auto const fail = [](std::string message) {
        return FarExt::internal::Failure(StatusCode::InvalidArgument, std::move(message));
    };
    for (int channel : options.fvarChannels) {
        CallStatus result = FarExt::internal::CheckChannel(channel, level.GetNumFVarChannels());
        if (!result.IsOk()) {
            return result;
        }
    }
    Index const numBaseFaces = level.GetHierarchy().mesh.levels[0].numFaces;
    if (!options.labels.empty() && options.labels.size() != numBaseFaces) {
        return fail("labels are one for each of the " + std::to_string(numBaseFaces) +
                    " base faces, but " + std::to_string(options.labels.size()) + " were given");
    }
    if (!FarExt::internal::IsInEnum(int(options.cutCreases), CreaseCuts::All)) {
        return fail("there is no CreaseCuts " + std::to_string(int(options.cutCreases)));
    }
    if (options.vertexOffset < 0) {
        return fail("the vertex offset is " + std::to_string(options.vertexOffset) +
                    ", and vertices would be negative");
    }
    if (options.sides && !level.HasFullTopology()) {
        return fail("level " + std::to_string(level.GetDepth()) +
                    " has no full topology, and so no sides: see "
                    "UniformOptions::fullTopologyInLastLevel");
    }
    if (options.sides && options.sides->GetNumVertices() != level.GetNumVertices()) {
        return fail("the sides are those of " + std::to_string(options.sides->GetNumVertices()) +
                    " vertices; the level has " + std::to_string(level.GetNumVertices()));
    }
    if (options.sides && !options.sides->IsOf(level)) {
        return fail("the sides are those of another level than level " +
                    std::to_string(level.GetDepth()) + ", whose creases split vertices elsewhere");
    }
    if (options.splitVertices && !options.sides) {
        return fail("vertices are split by sides, and none are given");
    }
    std::int64_t const last =
        std::int64_t(options.vertexOffset) + getNumVertices(level, options) - 1;
    if (last > std::numeric_limits<Index>::max()) {
        return FarExt::internal::Failure(
            StatusCode::TooLarge, "with its offset the last vertex would be " +
                                      std::to_string(last) + ", more than 32-bit indices reach");
    }
    for (int depth = 1; depth <= level.GetDepth() && options.generateBaseCoords; ++depth) {
        if (!level.GetHierarchy().mesh.levels[std::size_t(depth)].isHexagonal) {
            return CallStatus(
                StatusCode::Unsupported, FarExt::ComponentType::Level, depth,
                "level " + std::to_string(depth) +
                    " was not made by a hexagonal step: its faces have no places in base "
                    "faces");
        }
    }
    return CallStatus();
}

} // namespace

PolygonIndices CreatePolygonIndices(TopologyLevel const &level, DrawOptions const &options,
                                    CallStatus *status) {
    if (!FarExt::internal::Report(checkOptions(level, options), status)) {
        return {};
    }
    PolygonIndices result = Cutter(level, options).Run();
    if (options.separateVertices) {
        Index const numVertices = getNumVertices(level, options);
        internal::VertexSeparator separator(numVertices, options.vertexOffset, result);
        if (!FarExt::internal::Report(separator.Run(), status)) {
            return {};
        }
    }
    return result;
}

} // namespace OpenSubdivHex::OsdExt
