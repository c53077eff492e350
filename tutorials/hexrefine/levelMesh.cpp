// SPDX-License-Identifier: Apache-2.0
#include "levelMesh.h"

#include "far_ext/indexing.h"

#include <iterator>

namespace OpenSubdivHex::Tutorials {

namespace {

namespace Far = OpenSubdiv::Far;

class FaceCopier {
public:
    // sides is null where no channel has their values.
    FaceCopier(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides, Mesh *mesh)
        : _level(level), _sides(sides), _mesh(*mesh) {}

    void Run() {
        _mesh.faceSizes.clear();
        _mesh.faceSizes.reserve(_level.GetNumFaces());
        clear(&_mesh.faceVertices);
        for (FVarChannel &channel : _mesh.channels) {
            clear(&channel.faceValues);
        }
        for (int face = 0; face < _level.GetNumFaces(); ++face) {
            if (!_level.IsFaceHole(face)) {
                addFace(face);
            }
        }
    }

private:
    void clear(std::vector<int> *corners) const {
        corners->clear();
        corners->reserve(_level.GetNumFaceVertices());
    }

    void addFace(int face) {
        bool isSplit =
            _sides && OpenSubdiv::Sdc::Crease::IsInfinite(_level.GetFaceDiagonalSharpness(face));
        for (int channel = 0; channel < numChannels(); ++channel) {
            isSplit = isSplit || _level.IsFaceFVarSplit(face, channel);
        }
        if (isSplit) {
            addHalf(face, 0);
            addHalf(face, 1);
            return;
        }
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        _mesh.faceSizes.push_back(vertices.size());
        append(vertices, &_mesh.faceVertices);
        for (int channel = 0; channel < numChannels(); ++channel) {
            append(_level.GetFaceFVarValues(face, channel), &_mesh.channels[channel].faceValues);
        }
        for (int corner = 0; corner < vertices.size(); ++corner) {
            appendSide(face, corner, 0);
        }
    }

    void appendSide(int face, int corner, int half) {
        if (_sides) {
            _mesh.channels.back().faceValues.push_back(
                _sides->FindSide(_level, face, corner, half));
        }
    }

    void addHalf(int face, int half) {
        auto const &corners = FarExt::kHexagonHalves[half];
        _mesh.faceSizes.push_back(int(std::size(corners)));
        appendCorners(_level.GetFaceVertices(face), corners, &_mesh.faceVertices);
        for (int channel = 0; channel < numChannels(); ++channel) {
            std::vector<int> &values = _mesh.channels[channel].faceValues;
            if (_level.IsFaceFVarSplit(face, channel)) {
                append(_level.GetFaceFVarValues(face, channel, half), &values);
            } else {
                appendCorners(_level.GetFaceFVarValues(face, channel), corners, &values);
            }
        }
        for (int corner : corners) {
            appendSide(face, corner, half);
        }
    }

    static void append(Far::ConstIndexArray from, std::vector<int> *to) {
        to->insert(to->end(), from.begin(), from.end());
    }

    template <std::size_t SIZE>
    static void appendCorners(Far::ConstIndexArray from, int const (&corners)[SIZE],
                              std::vector<int> *to) {
        for (int corner : corners) {
            to->push_back(from[corner]);
        }
    }

    // Those of the level.
    int numChannels() const { return int(_mesh.channels.size()) - (_sides ? 1 : 0); }

    FarExt::TopologyLevel const &_level;
    FarExt::LimitSides const *_sides;
    Mesh &_mesh;
};

} // namespace

void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh) {
    FaceCopier(level, nullptr, mesh).Run();
}

void CopyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, Mesh *mesh) {
    FaceCopier(level, &sides, mesh).Run();
}

} // namespace OpenSubdivHex::Tutorials
