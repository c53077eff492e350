// SPDX-License-Identifier: Apache-2.0
#include "triangleIndices.h"

namespace OpenSubdivHex::OsdExt {

namespace {

using Far::ConstIndexArray;
using Far::Index;

class Triangulator {
public:
    Triangulator(FarExt::TopologyLevel const &level, TriangleOptions options)
        : _level(level), _options(options) {}

    TriangleIndices Run() {
        reserve();
        for (Index face = 0; face < _level.GetNumFaces(); ++face) {
            if (_options.drawHoles || !_level.IsFaceHole(face)) {
                addFace(face);
            }
        }
        return std::move(_result);
    }

private:
    bool hasChannel() const { return _options.fvarChannel >= 0; }

    void reserve() {
        std::size_t const numTriangles =
            std::size_t(_level.GetNumFaceVertices()) - 2 * std::size_t(_level.GetNumFaces());
        _result.vertices.reserve(3 * numTriangles);
        _result.fvarValues.reserve(hasChannel() ? 3 * numTriangles : 0);
        _result.faces.reserve(numTriangles);
        _result.baseFaces.reserve(numTriangles);
    }

    void addFace(Index face) {
        int const channel = _options.fvarChannel;
        _face = face;
        _baseFace = _level.GetFaceBaseFace(face);
        bool const isSeam = hasChannel() && _level.IsFaceFVarSplit(face, channel);
        if (!isSeam && _level.GetFaceDiagonalSharpness(face) <= 0) {
            _corners.clear();
            for (int i = 0; i < _level.GetFaceVertices(face).size(); ++i) {
                _corners.push_back(i);
            }
            addPolygon(hasChannel() ? _level.GetFaceFVarValues(face, channel) : ConstIndexArray());
            return;
        }
        for (int half = 0; half < 2; ++half) {
            _corners.assign(std::begin(FarExt::kHexagonHalves[half]),
                            std::end(FarExt::kHexagonHalves[half]));
            if (!hasChannel()) {
                addPolygon(ConstIndexArray());
            } else if (isSeam) {
                addPolygon(_level.GetFaceFVarValues(face, channel, half));
            } else {
                ConstIndexArray const values = _level.GetFaceFVarValues(face, channel);
                Index halfValues[4];
                for (int i = 0; i < 4; ++i) {
                    halfValues[i] = values[_corners[i]];
                }
                addPolygon(ConstIndexArray(halfValues, 4));
            }
        }
    }

    // Triangulates the polygon of the face's _corners, from both ends towards the middle in turn;
    // values[i] belongs to _corners[i].
    void addPolygon(ConstIndexArray values) {
        int low = 0;
        int high = int(_corners.size()) - 1;
        while (high - low >= 2) {
            addTriangle(values, low, low + 1, high);
            ++low;
            if (high - low >= 2) {
                addTriangle(values, low, high - 1, high);
                --high;
            }
        }
    }

    void addTriangle(ConstIndexArray values, int i, int j, int k) {
        ConstIndexArray const verts = _level.GetFaceVertices(_face);
        for (int corner : {i, j, k}) {
            _result.vertices.push_back(_options.vertexOffset + verts[_corners[corner]]);
            if (hasChannel()) {
                _result.fvarValues.push_back(values[corner]);
            }
        }
        _result.faces.push_back(_face);
        _result.baseFaces.push_back(_baseFace);
    }

    FarExt::TopologyLevel const &_level;
    TriangleOptions const _options;
    TriangleIndices _result;
    Index _face = 0;
    Index _baseFace = 0;
    std::vector<int> _corners;
};

} // namespace

TriangleIndices CreateTriangleIndices(FarExt::TopologyLevel const &level, TriangleOptions options) {
    return Triangulator(level, options).Run();
}

} // namespace OpenSubdivHex::OsdExt
