// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"

#include "far_ext/executor.h"
#include "tools/stream/patchNumbering.h"

#include <array>
#include <cmath>
#include <map>
#include <mutex>

namespace OpenSubdivHex::Regression {

using BfrExt::CellForest;
using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;
using BfrExt::PatchStream;
using Tools::PatchNumbering;

namespace {

/// The output of a stream, by the face and the coordinates of a place: numbers of the point, of derivatives
/// and of values.
template <typename REAL>
using StreamedPlaces = std::map<std::array<REAL, 3>, std::vector<REAL>>;

template <typename REAL>
class StreamRun {
public:
    StreamRun(MeshSurfaces<REAL> const &mesh, PatchStream<REAL> const &stream)
        : _mesh(mesh), _stream(stream), _numbering(PatchNumbering::Create(stream)) {}

    StreamedPlaces<REAL> Run(std::vector<typename PatchStream<REAL>::Values> const &values) {
        bool const isToRun = hasAllSurfaces();
        FarExt::CallStatus status;
        bool const isRun = _stream.Run(
            _mesh.points.data(), _mesh.pointSize, values, 0, _mesh.factory->GetNumFaces(),
            [&](typename PatchStream<REAL>::Patch const &patch) {
                std::lock_guard<std::mutex> const lock(_mutex);
                take(patch, values);
                return true;
            },
            &status);
        if (isRun != isToRun || bool(_numbering) != isToRun) {
            Fail("a stream ", isRun ? "runs" : "does not run: ", status.GetErrorMessage());
        }
        if (!isRun && !_places.empty()) {
            Fail("a stream that is refused makes patches");
        }
        if (isRun && std::int64_t(_numOwned.size()) != _numbering->GetNumPoints()) {
            Fail(_numOwned.size(), " points of ", _numbering->GetNumPoints(), " belong to a patch");
        }
        return std::move(_places);
    }

private:
    bool hasAllSurfaces() const {
        FarExt::SurfaceFaces const &faces = _mesh.factory->GetFaces();
        for (int face = 0; face < faces.GetNumFaces(); ++face) {
            if (!_mesh.Has(face) && !faces.IsHole(face)) {
                return false;
            }
        }
        return true;
    }

    void take(typename PatchStream<REAL>::Patch const &patch,
              std::vector<typename PatchStream<REAL>::Values> const &values) {
        int const count = patch.tessellation.GetNumCoords();
        std::vector<REAL> coords(2 * std::size_t(count));
        patch.tessellation.GetCoords(coords.data());
        std::vector<PatchNumbering::Number> numbers(coords.size() / 2);
        _numbering->GetPoints(patch.face, patch.tessellation, numbers.data());
        for (int i = 0; i < count; ++i) {
            std::vector<REAL> place;
            auto const append = [&](REAL const *from, int size) {
                place.insert(place.end(), from + i * size, from + (i + 1) * size);
            };
            append(patch.points, patch.pointSize);
            std::vector<REAL> const point = place;
            if (patch.du) {
                append(patch.du, patch.pointSize);
                append(patch.dv, patch.pointSize);
            }
            for (std::size_t k = 0; k < values.size(); ++k) {
                append(patch.values[k], values[k].desc.size);
            }
            std::array<REAL, 3> const key = {REAL(patch.face), coords[2 * std::size_t(i)],
                                             coords[2 * std::size_t(i) + 1]};
            if (_places.emplace(key, place).first->second != place) {
                Fail("two sections of face ", patch.face, " have other bits at place ", i);
            }
            PatchNumbering::Number const number = numbers[std::size_t(i)];
            if (_mesh.IsJoined(patch.face) &&
                _points.emplace(number, point).first->second != point) {
                Fail("point ", number, " has other bits in face ", patch.face, ", place ", i);
            }
        }
        std::vector<PatchNumbering::Run> runs;
        _numbering->GetRuns(patch.face, patch.tessellation, runs);
        for (PatchNumbering::Run const &run : runs) {
            for (int i = 0; run.isOwn && i < run.count; ++i) {
                PatchNumbering::Number const number = run.point + std::int64_t(run.step) * i;
                if (++_numOwned[number] > 1) {
                    Fail("point ", number, " belongs to two patches");
                }
            }
        }
    }

    MeshSurfaces<REAL> const &_mesh;
    PatchStream<REAL> const &_stream;
    std::unique_ptr<PatchNumbering> const _numbering;
    std::mutex _mutex;
    StreamedPlaces<REAL> _places;
    std::map<PatchNumbering::Number, std::vector<REAL>> _points;
    std::map<PatchNumbering::Number, int> _numOwned;
};

/// A stream with some memory, run by some threads.
template <typename REAL, typename SOURCE>
StreamedPlaces<REAL> runStream(MeshSurfaces<REAL> const &mesh, SOURCE const &source,
                               std::vector<typename PatchStream<REAL>::Values> const &values,
                               bool hasDerivatives, Dice &dice) {
    typename PatchStream<REAL>::Options options;
    options.SetDerivatives(hasDerivatives);
    options.SetTessellationOptions(
        LevelTessellation::Options().SetFacetSize(dice.IsOneOf(2) ? 3 : 0));
    if (dice.IsOneOf(2)) {
        options.SetMaxMemory(std::size_t(1) << dice.Roll(24));
    }
    BfrExt::SurfaceFactoryCache cache(std::size_t(1) << (dice.IsOneOf(2) ? 30 : dice.Roll(20)));
    auto const factory = BfrExt::SurfaceFactory::Create(
        mesh.factory->GetMesh(), BfrExt::SurfaceFactory::Options().SetExternalCache(&cache));
    FarExt::ExecutorScope const scope(nullptr, 1 + dice.Roll(3));
    PatchStream<REAL> const stream(*factory, source, options);
    return StreamRun<REAL>(mesh, stream).Run(values);
}

} // namespace

template <typename REAL, typename SOURCE>
void CheckStreams(MeshSurfaces<REAL> const &mesh, SOURCE const &source, Dice &dice) {
    std::vector<typename PatchStream<REAL>::Values> values;
    if (dice.IsOneOf(2)) {
        values.push_back({mesh.points.data(), mesh.pointSize});
    }
    bool const hasDerivatives = dice.IsOneOf(2);
    auto const places = runStream(mesh, source, values, hasDerivatives, dice);
    if (runStream(mesh, source, values, hasDerivatives, dice) != places) {
        Fail("streams differ by memory or threads");
    }
    constexpr int kNumPlaces = 100; // about so many are looked at
    for (auto const &[key, place] : places) {
        if (dice.Roll(int(places.size())) > kNumPlaces) {
            continue;
        }
        int const face = int(key[0]);
        Eigen::RowVectorXd const expected = mesh.Evaluate(face, &key[1]).row(0);
        for (int k = 0; k < mesh.pointSize; ++k) {
            if (!(std::abs(double(place[std::size_t(k)]) - expected[k]) <= mesh.GetTolerance())) {
                Fail("a stream has ", place[std::size_t(k)], " in face ", face, " at ", key[1],
                     ", ", key[2], ", not ", expected[k]);
            }
        }
    }
}

template void CheckStreams(MeshSurfaces<float> const &, CellForest const &, Dice &);
template void CheckStreams(MeshSurfaces<double> const &, CellForest const &, Dice &);
template void CheckStreams(MeshSurfaces<float> const &, PatchLevels const &, Dice &);
template void CheckStreams(MeshSurfaces<double> const &, PatchLevels const &, Dice &);

} // namespace OpenSubdivHex::Regression
