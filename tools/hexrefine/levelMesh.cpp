// SPDX-License-Identifier: Apache-2.0
#include "levelMesh.h"

#include "far_ext/executor.h"
#include "far_ext/indexing.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace OpenSubdivHex::Tools {

namespace {

namespace Far = OpenSubdiv::Far;

constexpr std::size_t kNumHalfCorners = std::size(FarExt::kHexagonHalves[0]);

/// Faces that a thread copies at a time.
constexpr int kRangeSize = 4096;

class FaceCopier {
public:
    // sides is null where no channel has their values.
    FaceCopier(FarExt::TopologyLevel const &level, FarExt::LimitSides const *sides, Mesh *mesh)
        : _level(level), _sides(sides), _mesh(*mesh),
          _hasFaceData(!mesh->faceLabels.empty() || !mesh->faceProperties.empty()) {}

    void Run() {
        int const numRanges = (_level.GetNumFaces() + kRangeSize - 1) / kRangeSize;
        std::vector<Place> places(std::size_t(numRanges) + 1); // where ranges begin
        FarExt::ParallelFor(numRanges,
                            [&](int range) { places[std::size_t(range) + 1] = countFaces(range); });
        std::partial_sum(places.begin(), places.end(), places.begin());
        _mesh.faceSizes.resize(places.back().face);
        _mesh.faceVertices.resize(places.back().corner);
        _mesh.baseFaces.resize(_hasFaceData ? places.back().face : 0);
        for (FVarChannel &channel : _mesh.channels) {
            channel.faceValues.resize(places.back().corner);
        }
        FarExt::ParallelFor(numRanges,
                            [&](int range) { copyFaces(range, places[std::size_t(range)]); });
    }

private:
    // A face of the mesh, and its first corner.
    struct Place {
        Place operator+(Place const &other) const {
            return {face + other.face, corner + other.corner};
        }

        std::size_t face = 0;
        std::size_t corner = 0;
    };

    template <typename FUNCTION>
    void forEachFace(int range, FUNCTION function) const {
        int const begin = range * kRangeSize;
        int const end = begin + std::min(kRangeSize, _level.GetNumFaces() - begin);
        for (int face = begin; face < end; ++face) {
            if (!_level.IsFaceHole(face)) {
                function(face);
            }
        }
    }

    bool isSplit(int face) const {
        bool result =
            _sides && OpenSubdiv::Sdc::Crease::IsInfinite(_level.GetFaceDiagonalSharpness(face));
        for (int channel = 0; channel < numChannels(); ++channel) {
            result = result || _level.IsFaceFVarSplit(face, channel);
        }
        return result;
    }

    Place countFaces(int range) const {
        Place size;
        forEachFace(range, [&](int face) {
            std::size_t const numCorners = std::size_t(_level.GetFaceVertices(face).size());
            size = size + (isSplit(face) ? Place{2, 2 * kNumHalfCorners} : Place{1, numCorners});
        });
        return size;
    }

    void copyFaces(int range, Place place) {
        forEachFace(range, [&](int face) {
            if (isSplit(face)) {
                copyHalf(face, 0, &place);
                copyHalf(face, 1, &place);
            } else {
                copyFace(face, &place);
            }
        });
    }

    void copyFace(int face, Place *place) {
        Far::ConstIndexArray const vertices = _level.GetFaceVertices(face);
        copy(vertices, *place, &_mesh.faceVertices);
        for (int channel = 0; channel < numChannels(); ++channel) {
            copy(_level.GetFaceFVarValues(face, channel), *place,
                 &_mesh.channels[channel].faceValues);
        }
        for (int corner = 0; corner < vertices.size() && _sides; ++corner) {
            copySide(face, corner, 0, place->corner + std::size_t(corner));
        }
        copyBaseFace(face, *place);
        _mesh.faceSizes[place->face++] = vertices.size();
        place->corner += std::size_t(vertices.size());
    }

    void copyHalf(int face, int half, Place *place) {
        auto const &corners = FarExt::kHexagonHalves[half];
        copyCorners(_level.GetFaceVertices(face), corners, *place, &_mesh.faceVertices);
        for (int channel = 0; channel < numChannels(); ++channel) {
            std::vector<int> &values = _mesh.channels[channel].faceValues;
            if (_level.IsFaceFVarSplit(face, channel)) {
                copy(_level.GetFaceFVarValues(face, channel, half), *place, &values);
            } else {
                copyCorners(_level.GetFaceFVarValues(face, channel), corners, *place, &values);
            }
        }
        for (std::size_t i = 0; i < kNumHalfCorners && _sides; ++i) {
            copySide(face, corners[i], half, place->corner + i);
        }
        copyBaseFace(face, *place);
        _mesh.faceSizes[place->face++] = int(kNumHalfCorners);
        place->corner += kNumHalfCorners;
    }

    void copyBaseFace(int face, Place const &place) {
        if (_hasFaceData) {
            _mesh.baseFaces[place.face] = _level.GetFaceBaseFace(face);
        }
    }

    void copySide(int face, int corner, int half, std::size_t to) {
        _mesh.channels.back().faceValues[to] = _sides->FindSide(_level, face, corner, half);
    }

    static void copy(Far::ConstIndexArray from, Place const &place, std::vector<int> *to) {
        std::copy(from.begin(), from.end(), to->data() + place.corner);
    }

    static void copyCorners(Far::ConstIndexArray from, int const (&corners)[kNumHalfCorners],
                            Place const &place, std::vector<int> *to) {
        for (std::size_t i = 0; i < kNumHalfCorners; ++i) {
            (*to)[place.corner + i] = from[corners[i]];
        }
    }

    // Those of the level.
    int numChannels() const { return int(_mesh.channels.size()) - (_sides ? 1 : 0); }

    FarExt::TopologyLevel const &_level;
    FarExt::LimitSides const *_sides;
    Mesh &_mesh;
    bool const _hasFaceData;
};

} // namespace

void CopyFaces(FarExt::TopologyLevel const &level, Mesh *mesh) {
    FaceCopier(level, nullptr, mesh).Run();
}

void CopyFaces(FarExt::TopologyLevel const &level, FarExt::LimitSides const &sides, Mesh *mesh) {
    FaceCopier(level, &sides, mesh).Run();
}

} // namespace OpenSubdivHex::Tools
