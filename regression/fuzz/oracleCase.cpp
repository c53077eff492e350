// SPDX-License-Identifier: Apache-2.0
#include "oracleCase.h"

#include "byteSource.h"

#include "far_ext/topologyRefinerFactory.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/shapeDescriptor.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace OpenSubdivHex::Regression {

using FarExt::FirstStep;
using FarExt::SchemeType;

namespace {

using Faces = std::vector<std::vector<int>>;

constexpr int kMaxCorners = 44;
constexpr int kMaxLatticeCorners = 150;
constexpr float kSharpnesses[] = {10, 1, 2, 0.5f, 0.25f, 1.5f, 2.75f, 0.125f};

/// Draws a mesh: a base of some kind, then some operations on it.
class MeshMaker {
public:
    explicit MeshMaker(ByteSource &bytes) : _bytes(bytes) {}

    Faces Make() {
        int maxCorners = kMaxCorners;
        switch (_bytes.Choose(8)) {
        case 0:
            makeGrid();
            break;
        case 1:
            makePrism();
            break;
        case 2:
            makeFan();
            break;
        case 3:
            makeBipyramid();
            break;
        case 4:
            makeBook();
            break;
        case 5:
            addVertices(3 + _bytes.Choose(6));
            addFace(_numVertices);
            break;
        case 6:
            makeLattice();
            maxCorners = kMaxLatticeCorners;
            break;
        default:
            makeSoup();
            break;
        }
        for (int i = _bytes.Choose(6); i > 0; --i) {
            change();
        }
        while (countCorners() > maxCorners) {
            _faces.pop_back();
        }
        if (_faces.empty()) {
            _faces = {{0, 1, 2}};
            _numVertices = std::max(_numVertices, 3);
        }
        return _faces;
    }
    int GetNumVertices() const { return _numVertices; }

private:
    int addVertices(int count) {
        _numVertices += count;
        return _numVertices - count;
    }
    int countCorners() const {
        int count = 0;
        for (std::vector<int> const &face : _faces) {
            count += int(face.size());
        }
        return count;
    }

    void makeGrid() {
        int const width = 1 + _bytes.Choose(3);
        int const height = 1 + _bytes.Choose(3);
        int const split = _bytes.GetByte();
        addVertices((width + 1) * (height + 1));
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                int const a = y * (width + 1) + x;
                int const b = a + width + 1;
                if ((split >> (_faces.size() % 8) & 1) != 0) {
                    _faces.push_back({a, a + 1, b + 1});
                    _faces.push_back({a, b + 1, b});
                } else {
                    _faces.push_back({a, a + 1, b + 1, b});
                }
            }
        }
    }
    void makePrism() {
        int const n = 3 + _bytes.Choose(6);
        addVertices(2 * n);
        std::vector<int> bottom;
        std::vector<int> top;
        for (int i = 0; i < n; ++i) {
            int const next = (i + 1) % n;
            bottom.insert(bottom.begin(), i);
            top.push_back(n + i);
            _faces.push_back({i, next, n + next, n + i});
        }
        _faces.push_back(bottom);
        _faces.push_back(top);
    }
    void makeBipyramid() {
        int const n = 2 + _bytes.Choose(5);
        addVertices(n + 2);
        for (int i = 0; i < n; ++i) {
            int const next = (i + 1) % n;
            _faces.push_back({i, next, n});
            _faces.push_back({next, i, n + 1});
        }
    }
    /// A torus of quads, triangles or hexagons, large enough for faces that are in a regular lattice.
    void makeLattice() {
        int const width = 3 + _bytes.Choose(4);
        int const height = 3 + _bytes.Choose(3);
        int const faceSize = std::array{4, 3, 6}[std::size_t(_bytes.Choose(3))];
        int const numColumns = faceSize == 6 ? 2 * width : width;
        int const numRows = faceSize == 6 ? height / 2 * 2 : height;
        addVertices(numColumns * numRows);
        auto const vertex = [&](int x, int y) { return y % numRows * numColumns + x % numColumns; };
        for (int y = 0; y < numRows; ++y) {
            for (int i = 0; i < width; ++i) {
                int const x = faceSize == 6 ? 2 * i + y % 2 : i; // of hexagons laid as bricks
                int const a = vertex(x, y);
                int const b = vertex(x + 1, y);
                int const c = vertex(x + 1, y + 1);
                int const d = vertex(x, y + 1);
                if (faceSize == 4) {
                    _faces.push_back({a, b, c, d});
                } else if (faceSize == 3) {
                    _faces.push_back({a, b, c});
                    _faces.push_back({a, c, d});
                } else {
                    _faces.push_back({a, b, vertex(x + 2, y), vertex(x + 2, y + 1), c, d});
                }
            }
        }
    }
    /// Faces of many sizes around vertex 0, in a closed fan or an open one.
    void makeFan() {
        int const n = 2 + _bytes.Choose(6);
        bool const isClosed = n > 2 && _bytes.Choose(2) != 0;
        addVertices(1);
        int const first = addVertices(isClosed ? n : n + 1);
        for (int i = 0; i < n; ++i) {
            std::vector<int> face = {0, first + i};
            int const numMore = _bytes.Choose(3);
            for (int k = 0; k < numMore; ++k) {
                face.push_back(addVertices(1));
            }
            face.push_back(first + (i + 1) % (isClosed ? n : n + 1));
            _faces.push_back(face);
        }
    }
    /// Faces on one edge, in turn this way and that.
    void makeBook() {
        int const n = 2 + _bytes.Choose(4);
        addVertices(2);
        for (int i = 0; i < n; ++i) {
            std::vector<int> face = {i % 2, 1 - i % 2};
            for (int k = 1 + _bytes.Choose(2); k > 0; --k) {
                face.push_back(addVertices(1));
            }
            _faces.push_back(face);
        }
    }
    void makeSoup() {
        addVertices(3 + _bytes.Choose(6));
        for (int i = 1 + _bytes.Choose(7); i > 0; --i) {
            addFace(3 + _bytes.Choose(_bytes.Choose(3) == 0 ? 6 : 2));
        }
    }

    /// A face of \p size vertices, no two the same while there are so many.
    void addFace(int size) {
        std::vector<int> rest(_numVertices);
        std::iota(rest.begin(), rest.end(), 0);
        std::vector<int> face;
        for (int i = 0; i < std::min(size, _numVertices); ++i) {
            int const k = _bytes.Choose(int(rest.size()));
            face.push_back(rest[k]);
            rest.erase(rest.begin() + k);
        }
        if (face.size() >= 3) {
            _faces.push_back(face);
        }
    }
    /// A face on an edge of another, with new vertices.
    void attachFace() {
        std::vector<int> const face = _faces[_bytes.Choose(int(_faces.size()))];
        int const i = _bytes.Choose(int(face.size()));
        std::vector<int> attached = {face[(i + 1) % face.size()], face[i]};
        for (int k = 1 + _bytes.Choose(6); k > 0; --k) {
            attached.push_back(addVertices(1));
        }
        _faces.push_back(attached);
    }
    void mergeVertices(int from, int to, bool mayRepeat) {
        Faces merged = _faces;
        for (std::vector<int> &face : merged) {
            std::replace(face.begin(), face.end(), from, to);
            if (!mayRepeat && std::count(face.begin(), face.end(), to) > 1) {
                return;
            }
        }
        _faces = merged;
    }

    void change() {
        if (_faces.empty()) {
            return;
        }
        auto const face = _faces.begin() + _bytes.Choose(int(_faces.size()));
        switch (_bytes.Choose(8)) {
        case 0:
        case 1:
            attachFace();
            break;
        case 2:
        case 3: {
            int const from = _bytes.Choose(_numVertices);
            mergeVertices(from, _bytes.Choose(_numVertices), _bytes.IsOneOf(16));
            break;
        }
        case 4:
            _faces.erase(face);
            break;
        case 5:
            addFace(3 + _bytes.Choose(3));
            break;
        case 6:
            if (_bytes.Choose(4) == 0) {
                std::reverse(face->begin(), face->end());
            } else {
                std::rotate(face->begin(), face->begin() + 1, face->end());
            }
            break;
        case 7:
            _faces.emplace_back(face->rbegin(), face->rend());
            break;
        }
    }

    ByteSource &_bytes;
    Faces _faces;
    int _numVertices = 0;
};

/// Between -2 and 2, in steps that floats add up exactly.
double makeCoordinate(int seed, int i, bool isCoarse) {
    unsigned bits = unsigned(seed) * 2654435761u + unsigned(i) * 2246822519u;
    bits ^= bits >> 15;
    bits *= 2246822519u;
    bits ^= bits >> 13;
    return isCoarse ? double(bits % 3) - 1 : (double(bits % 257) - 128) / 64;
}

void addTags(ByteSource &bytes, Shape &shape) {
    std::set<std::pair<int, int>> edges;
    int first = 0;
    for (int size : shape.faceSizes) {
        for (int i = 0; i < size; ++i) {
            edges.insert(std::minmax(shape.faceVertices[first + i],
                                     shape.faceVertices[first + (i + 1) % size]));
        }
        first += size;
    }
    auto const sharpness = [&] { return kSharpnesses[bytes.Choose(8)]; };
    for (int i = bytes.Choose(2) == 0 ? 0 : bytes.Choose(8); i > 0 && !edges.empty(); --i) {
        auto const edge = std::next(edges.begin(), bytes.Choose(int(edges.size())));
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {edge->first, edge->second});
        shape.creaseSharpness.push_back(sharpness());
        edges.erase(edge);
    }
    std::set<int> corners;
    for (int i = bytes.Choose(3) == 2 ? bytes.Choose(4) : 0; i > 0; --i) {
        corners.insert(bytes.Choose(shape.GetNumVertices()));
    }
    for (int v : corners) {
        shape.cornerVertices.push_back(v);
        shape.cornerSharpness.push_back(sharpness());
    }
    std::set<int> holes;
    for (int i = bytes.Choose(4) == 3 ? 1 + bytes.Choose(2) : 0; i > 0; --i) {
        holes.insert(bytes.Choose(shape.GetNumFaces()));
    }
    shape.holeFaces.assign(holes.begin(), holes.end());
}

FVarChannel makeChannel(ByteSource &bytes, Shape const &shape) {
    FVarChannel channel;
    int const kind = bytes.Choose(4);
    int numValues = 0;
    for (int f = 0, c = 0; f < shape.GetNumFaces(); ++f) {
        for (int i = 0; i < shape.faceSizes[f]; ++i, ++c) {
            int const vertex = shape.faceVertices[c];
            int value = vertex;
            if (kind == 1) {
                value = c;
            } else if (kind == 2) {
                value = 3 * vertex + bytes.Choose(3);
            } else if (kind == 3) {
                value = bytes.Choose(5) == 4 ? bytes.Choose(shape.GetNumVertices()) : vertex;
            }
            channel.valueIndices.push_back(value);
            numValues = std::max(numValues, value + 1);
        }
    }
    int const seed = 17 + kind;
    for (int i = 0; i < 2 * numValues; ++i) {
        channel.values.push_back(makeCoordinate(seed, i, false));
    }
    return channel;
}

void setFaces(Shape &shape, Faces const &faces) {
    shape.faceSizes.clear();
    shape.faceVertices.clear();
    for (std::vector<int> const &face : faces) {
        shape.faceSizes.push_back(int(face.size()));
        shape.faceVertices.insert(shape.faceVertices.end(), face.begin(), face.end());
    }
}

} // namespace

OracleCase MakeOracleCase(std::uint8_t const *data, std::size_t size) {
    ByteSource bytes(data, size);
    OracleCase result;
    result.checks = unsigned(bytes.GetByte());
    result.checks += 256 * unsigned(bytes.GetByte());
    result.sdcOptions.SetVtxBoundaryInterpolation(kBoundaries[bytes.Choose(3)]);
    result.sdcOptions.SetCreasingMethod(bytes.Choose(3) == 2 ? Sdc::Options::CREASE_CHAIKIN
                                                             : Sdc::Options::CREASE_UNIFORM);
    result.sdcOptions.SetFVarLinearInterpolation(
        Sdc::Options::FVarLinearInterpolation(bytes.Choose(6)));
    result.mask = ReferenceMask(bytes.Choose(3));
    int const scheme = bytes.Choose(16);
    result.schemeType = scheme == 15   ? SchemeType::DooSabin
                        : scheme == 14 ? SchemeType::TriHex
                                       : SchemeType::Hexagonal;
    result.firstStep = scheme == 13                  ? FirstStep::TriHex
                       : scheme == 9 || scheme == 10 ? FirstStep::Truncate
                                                     : FirstStep::Same;
    result.isCoplanar = scheme == 11 || scheme == 12;
    result.angleTolerance = scheme == 11 ? 0.1 : 50; // of no two coarse faces
    result.closeGaps = scheme == 11 || bytes.Choose(2) == 0;
    int const level = bytes.Choose(32);
    result.level = level == 31 ? 3 : level > 24 ? 2 : level == 24 ? 0 : 1;

    Shape &shape = result.shape;
    shape.name = "fuzz";
    shape.leftHanded = bytes.IsOneOf(8);
    MeshMaker maker(bytes);
    setFaces(shape, maker.Make());
    int const seed = bytes.GetByte();
    bool const isCoarse = result.isCoplanar && bytes.Choose(4) != 0;
    for (int i = 0; i < 3 * maker.GetNumVertices(); ++i) {
        shape.positions.push_back(makeCoordinate(seed, i, isCoarse));
    }
    // Other schemes refuse tags and channels; that they do is worth some cases alone.
    bool const takesTags =
        result.schemeType == SchemeType::Hexagonal && result.firstStep != FirstStep::TriHex;
    if (takesTags || bytes.IsOneOf(8)) {
        addTags(bytes, shape);
        for (int i = std::max(0, bytes.Choose(5) - 2); i > 0; --i) {
            shape.fvarChannels.push_back(makeChannel(bytes, shape));
        }
    }
    return result;
}

namespace {

template <typename T>
std::string list(std::vector<T> const &values) {
    std::ostringstream text;
    char const *separator = "";
    text.precision(17);
    for (T const &value : values) {
        text << separator << value;
        separator = ", ";
    }
    return "{" + text.str() + "}";
}

char const *toString(bool value) { return value ? "true" : "false"; }

} // namespace

double OracleCase::GetTolerance(double rounding) const {
    bool const isChaikin = sdcOptions.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN;
    return isChaikin ? std::max(1e-6, rounding) : rounding;
}

std::string Print(OracleCase const &oracleCase) {
    static char const *const kBoundaryNames[] = {"NONE", "EDGE_ONLY", "EDGE_AND_CORNER"};
    static char const *const kLinearNames[] = {"NONE",          "CORNERS_ONLY", "CORNERS_PLUS1",
                                               "CORNERS_PLUS2", "BOUNDARIES",   "ALL"};
    static char const *const kMaskNames[] = {"Average", "Cosine", "Smooth"};
    static char const *const kFirstStepNames[] = {"Same", "TriHex", "Truncate"};
    static char const *const kSchemeNames[] = {"Hexagonal", "DooSabin", "TriHex"};
    Shape const &shape = oracleCase.shape;
    Sdc::Options const &options = oracleCase.sdcOptions;
    std::ostringstream text;
    auto const line = [&](std::string const &name, std::string const &value) {
        text << "    oracleCase." << name << " = " << value << ";\n";
    };
    auto const call = [&](std::string const &name, std::string const &value) {
        text << "    oracleCase.sdcOptions." << name << "(Sdc::Options::" << value << ");\n";
    };
    text << "    OracleCase oracleCase;\n";
    line("shape.positions", list(shape.positions));
    line("shape.faceSizes", list(shape.faceSizes));
    line("shape.faceVertices", list(shape.faceVertices));
    if (!shape.creaseSharpness.empty()) {
        line("shape.creaseVertexPairs", list(shape.creaseVertexPairs));
        line("shape.creaseSharpness", list(shape.creaseSharpness));
    }
    if (!shape.cornerVertices.empty()) {
        line("shape.cornerVertices", list(shape.cornerVertices));
        line("shape.cornerSharpness", list(shape.cornerSharpness));
    }
    if (!shape.holeFaces.empty()) {
        line("shape.holeFaces", list(shape.holeFaces));
    }
    if (shape.leftHanded) {
        line("shape.leftHanded", "true");
    }
    for (FVarChannel const &channel : shape.fvarChannels) {
        text << "    oracleCase.shape.fvarChannels.push_back({" << channel.width << ", "
             << list(channel.values) << ", " << list(channel.valueIndices) << "});\n";
    }
    call("SetVtxBoundaryInterpolation",
         std::string("VTX_BOUNDARY_") + kBoundaryNames[options.GetVtxBoundaryInterpolation()]);
    if (options.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN) {
        call("SetCreasingMethod", "CREASE_CHAIKIN");
    }
    if (!shape.fvarChannels.empty()) {
        call("SetFVarLinearInterpolation",
             std::string("FVAR_LINEAR_") + kLinearNames[options.GetFVarLinearInterpolation()]);
    }
    line("mask", std::string("ReferenceMask::") + kMaskNames[int(oracleCase.mask)]);
    line("schemeType",
         std::string("FarExt::SchemeType::") + kSchemeNames[int(oracleCase.schemeType)]);
    line("firstStep",
         std::string("FarExt::FirstStep::") + kFirstStepNames[int(oracleCase.firstStep)]);
    line("level", std::to_string(oracleCase.level));
    if (oracleCase.isCoplanar) {
        line("isCoplanar", "true");
        line("angleTolerance", std::to_string(oracleCase.angleTolerance));
        line("closeGaps", toString(oracleCase.closeGaps));
    }
    line("checks", std::to_string(oracleCase.checks));
    return text.str() + "    CheckOracleCase(oracleCase);\n";
}

namespace {

/// A copy with a change, if that fails too.
class Shrinker {
public:
    Shrinker(OracleCase start, std::function<bool(OracleCase const &)> const &fails)
        : _best(std::move(start)), _fails(fails) {}

    OracleCase const &GetBest() const { return _best; }

    template <typename CHANGE>
    bool Try(CHANGE const &change) {
        OracleCase candidate = _best;
        change(candidate);
        if (_fails(candidate)) {
            _best = std::move(candidate);
            return true;
        }
        return false;
    }

private:
    OracleCase _best;
    std::function<bool(OracleCase const &)> const &_fails;
};

template <typename T>
void eraseRange(std::vector<T> &values, int first, int count) {
    values.erase(values.begin() + first, values.begin() + first + count);
}

void removeCorner(Shape &shape, int face, int place) {
    int const first = std::accumulate(shape.faceSizes.begin(), shape.faceSizes.begin() + face, 0);
    eraseRange(shape.faceVertices, first + place, 1);
    for (FVarChannel &channel : shape.fvarChannels) {
        eraseRange(channel.valueIndices, first + place, 1);
    }
    --shape.faceSizes[face];
}

/// Creases that are no edges any more.
void removeStrayCreases(Shape &shape) {
    for (int i = int(shape.creaseSharpness.size()) - 1; i >= 0; --i) {
        auto const crease =
            std::minmax(shape.creaseVertexPairs[2 * i], shape.creaseVertexPairs[2 * i + 1]);
        bool isEdge = false;
        int first = 0;
        for (int size : shape.faceSizes) {
            for (int k = 0; k < size; ++k) {
                isEdge |= crease == std::minmax(shape.faceVertices[first + k],
                                                shape.faceVertices[first + (k + 1) % size]);
            }
            first += size;
        }
        if (!isEdge) {
            eraseRange(shape.creaseVertexPairs, 2 * i, 2);
            eraseRange(shape.creaseSharpness, i, 1);
        }
    }
}

void removeFace(Shape &shape, int face) {
    while (shape.faceSizes[face] > 0) {
        removeCorner(shape, face, 0);
    }
    eraseRange(shape.faceSizes, face, 1);
    auto &holes = shape.holeFaces;
    holes.erase(std::remove(holes.begin(), holes.end(), face), holes.end());
    for (int &hole : holes) {
        hole -= hole > face ? 1 : 0;
    }
    removeStrayCreases(shape);
}

/// A vertex without faces and tags.
void removeVertex(Shape &shape, int vertex) {
    eraseRange(shape.positions, 3 * vertex, 3);
    for (auto *indices : {&shape.faceVertices, &shape.creaseVertexPairs, &shape.cornerVertices}) {
        for (int &v : *indices) {
            v -= v > vertex ? 1 : 0;
        }
    }
}

bool shrinkOnce(Shrinker &shrinker) {
    bool isSmaller = false;
    auto const size = [&](auto const &count) { return int(count(shrinker.GetBest().shape)); };
    for (int f = size([](Shape const &s) { return s.faceSizes.size(); }) - 1; f >= 0; --f) {
        if (shrinker.GetBest().shape.GetNumFaces() > 1) {
            isSmaller |= shrinker.Try([f](OracleCase &c) { removeFace(c.shape, f); });
        }
    }
    for (int i = size([](Shape const &s) { return s.fvarChannels.size(); }) - 1; i >= 0; --i) {
        isSmaller |= shrinker.Try([i](OracleCase &c) { eraseRange(c.shape.fvarChannels, i, 1); });
    }
    for (int i = size([](Shape const &s) { return s.creaseSharpness.size(); }) - 1; i >= 0; --i) {
        isSmaller |= shrinker.Try([i](OracleCase &c) {
            eraseRange(c.shape.creaseVertexPairs, 2 * i, 2);
            eraseRange(c.shape.creaseSharpness, i, 1);
        });
    }
    for (int i = size([](Shape const &s) { return s.cornerVertices.size(); }) - 1; i >= 0; --i) {
        isSmaller |= shrinker.Try([i](OracleCase &c) {
            eraseRange(c.shape.cornerVertices, i, 1);
            eraseRange(c.shape.cornerSharpness, i, 1);
        });
    }
    for (int i = size([](Shape const &s) { return s.holeFaces.size(); }) - 1; i >= 0; --i) {
        isSmaller |= shrinker.Try([i](OracleCase &c) { eraseRange(c.shape.holeFaces, i, 1); });
    }
    for (int f = 0; f < shrinker.GetBest().shape.GetNumFaces(); ++f) {
        for (int i = shrinker.GetBest().shape.faceSizes[f] - 1; i >= 0; --i) {
            if (shrinker.GetBest().shape.faceSizes[f] > 3) {
                isSmaller |= shrinker.Try([f, i](OracleCase &c) {
                    removeCorner(c.shape, f, i);
                    removeStrayCreases(c.shape);
                });
            }
        }
    }
    for (int v = shrinker.GetBest().shape.GetNumVertices() - 1; v >= 0; --v) {
        Shape const &shape = shrinker.GetBest().shape;
        auto const has = [v](std::vector<int> const &vertices) {
            return std::count(vertices.begin(), vertices.end(), v) > 0;
        };
        if (!has(shape.faceVertices) && !has(shape.cornerVertices)) {
            isSmaller |= shrinker.Try([v](OracleCase &c) { removeVertex(c.shape, v); });
        }
    }
    if (shrinker.GetBest().level > 0) {
        isSmaller |= shrinker.Try([](OracleCase &c) { --c.level; });
    }
    if (shrinker.GetBest().shape.leftHanded) {
        isSmaller |= shrinker.Try([](OracleCase &c) { c.shape.leftHanded = false; });
    }
    if (shrinker.GetBest().sdcOptions.GetCreasingMethod() != Sdc::Options::CREASE_UNIFORM) {
        isSmaller |= shrinker.Try(
            [](OracleCase &c) { c.sdcOptions.SetCreasingMethod(Sdc::Options::CREASE_UNIFORM); });
    }
    if (shrinker.GetBest().isCoplanar) {
        isSmaller |= shrinker.Try([](OracleCase &c) { c.isCoplanar = false; });
    }
    if (shrinker.GetBest().mask != ReferenceMask::Average) {
        isSmaller |= shrinker.Try([](OracleCase &c) { c.mask = ReferenceMask::Average; });
    }
    return isSmaller;
}

} // namespace

OracleCase Shrink(OracleCase oracleCase, std::function<bool(OracleCase const &)> const &fails) {
    Shrinker shrinker(std::move(oracleCase), fails);
    while (shrinkOnce(shrinker)) {
    }
    return shrinker.GetBest();
}

std::unique_ptr<FarExt::TopologyRefiner> CreateRefiner(OracleCase const &oracleCase,
                                                       FarExt::CallStatus *status) {
    FarExt::TopologyRefinerFactory::Options options;
    options.hexSchemeOptions.faceMask = ToFaceMask(oracleCase.mask);
    options.hexSchemeOptions.schemeType = oracleCase.schemeType;
    options.hexSchemeOptions.firstStep = oracleCase.firstStep;
    auto refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(oracleCase.shape).Get(),
                                                          oracleCase.sdcOptions, options, status);
    bool isRefined = false;
    if (refiner && oracleCase.isCoplanar) {
        FarExt::TopologyRefiner::CoplanarOptions coplanar(oracleCase.level);
        coplanar.angleTolerance = oracleCase.angleTolerance;
        coplanar.closeGaps = oracleCase.closeGaps;
        coplanar.fullTopologyInLastLevel = true;
        isRefined = refiner->RefineCoplanar(oracleCase.shape.positions.data(), coplanar, status);
    } else if (refiner) {
        FarExt::TopologyRefiner::UniformOptions uniform(oracleCase.level);
        uniform.fullTopologyInLastLevel = true;
        isRefined = refiner->RefineUniform(uniform, status);
    }
    return isRefined ? std::move(refiner) : nullptr;
}

} // namespace OpenSubdivHex::Regression
