// SPDX-License-Identifier: Apache-2.0
//
// Surfaces refined for a camera against the same of one level everywhere that is as close to the limit:
// what a picture takes, with its points and facets.  The first of a mesh finds all about its cells; further
// ones have that.
#include "makers.h"
#include "suite.h"

#include "bfr_ext/patchStream.h"
#include "bfr_ext/view.h"
#include "far_ext/topologyRefinerFactory.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace OpenSubdivHex::Regression {
namespace {

/// Looks at a mesh from the front and above, so that it fills the picture.
BfrExt::Camera lookAt(std::vector<float> const &positions) {
    BfrExt::Camera camera;
    double radius = 0;
    double center[3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
        float low = positions[k];
        float high = low;
        for (std::size_t i = k; i < positions.size(); i += 3) {
            low = std::min(low, positions[i]);
            high = std::max(high, positions[i]);
        }
        center[k] = (double(low) + double(high)) / 2;
        radius = std::hypot(radius, (double(high) - double(low)) / 2);
    }
    constexpr double kRadii = 2; // from the centre to the eye
    double const towards[3] = {0, 0.447, 0.894};
    for (std::size_t k = 0; k < 3; ++k) {
        camera.target[k] = center[k];
        camera.eye[k] = center[k] + kRadii * radius * towards[k];
    }
    return camera;
}

/// A mesh, and what a view of it needs.
struct Workspace {
    explicit Workspace(BenchMesh const &mesh)
        : refiner(MakeSmooth(mesh)),
          positions(mesh.shape->positions.begin(), mesh.shape->positions.end()),
          camera(lookAt(positions)) {
        Require(refiner != nullptr, "no refiner");
        factory = BfrExt::SurfaceFactory::Create(*refiner);
        Require(factory != nullptr, "no factory");
        view = BfrExt::View(camera, BfrExt::View::Options().SetFlatness(kPixels));
        BfrExt::CellForest const forest = view.MakeForest(*factory, positions.data(), 3);
        for (int face = 0; face < forest.GetNumFaces(); ++face) {
            level = std::max(level, forest.GetTree(face).GetMaxLevel());
        }
    }

    static std::unique_ptr<FarExt::TopologyRefiner> MakeSmooth(BenchMesh const &mesh) {
        FarExt::HexSchemeOptions scheme;
        scheme.faceMask = FarExt::FaceMask::Smooth;
        return FarExt::TopologyRefinerFactory::Create(*MakeFarBase(mesh), {scheme});
    }

    /// Hands the triangles with their points to a sink that looks at one number of each patch.
    double Stream(BfrExt::PatchStream<float> const &stream) const {
        return take([&](auto const &sink) { return stream.Run(positions.data(), 3, sink); });
    }
    /// Those of some faces.
    double Stream(BfrExt::PatchStream<float> const &stream, std::vector<int> const &faces) const {
        return take(
            [&](auto const &sink) { return stream.Run(positions.data(), 3, {}, faces, sink); });
    }

    static constexpr double kPixels = 0.5;

    std::unique_ptr<FarExt::TopologyRefiner> refiner;
    std::unique_ptr<BfrExt::SurfaceFactory> factory;
    std::vector<float> positions;
    BfrExt::Camera camera;
    BfrExt::View view = BfrExt::View(BfrExt::Camera());
    int level = 0; ///< of the finest cells

private:
    template <typename RUN>
    static double take(RUN const &run) {
        std::atomic<bool> isFinite(true);
        bool const isDone = run([&](auto const &patch) {
            if (!std::isfinite(patch.points[0])) {
                isFinite = false;
            }
            return true;
        });
        Require(isDone && isFinite, "no stream");
        return 1;
    }
};

/// \param work  gives what it is per
template <typename WORK>
Contestant makeContestant(std::string const &name, WORK work) {
    auto const count = std::make_shared<double>(0);
    Contestant contestant;
    contestant.name = name;
    contestant.work = [=] { *count = work(); };
    contestant.validate = [=] { return *count; };
    return contestant;
}

constexpr double kShift = 0.01; // of the eye, over its distance

Contest makeContest(BenchMesh const &mesh) {
    auto const workspace = std::make_shared<Workspace>(mesh);
    auto const uniform = std::make_shared<BfrExt::PatchStream<float>>(
        *workspace->factory, BfrExt::PatchLevels(workspace->level));
    auto const bounds = std::make_shared<BfrExt::ViewBounds>(*workspace->factory);
    workspace->view.MakeForest(*bounds, workspace->positions.data(), 3);
    Contest contest;
    contest.contestants.push_back(makeContestant("BfrExt::View, points", [=] {
        BfrExt::CellForest const forest =
            workspace->view.MakeForest(*workspace->factory, workspace->positions.data(), 3);
        return workspace->Stream(BfrExt::PatchStream<float>(*workspace->factory, forest));
    }));
    contest.contestants.push_back(
        makeContestant("BfrExt::PatchStream", [=] { return workspace->Stream(*uniform); }));
    // Cameras go around, so that none finds what is known for it.
    auto const numViews = std::make_shared<int>(0);
    auto const makeNextForest = [=] {
        BfrExt::Camera camera = workspace->camera;
        camera.eye[0] += kShift * double(++*numViews) * (camera.eye[2] - camera.target[2]);
        BfrExt::View const view(camera, workspace->view.GetOptions());
        return view.MakeForest(*bounds, workspace->positions.data(), 3);
    };
    contest.contestants.push_back(makeContestant("BfrExt::ViewBounds, points", [=] {
        BfrExt::CellForest const forest = makeNextForest();
        return workspace->Stream(BfrExt::PatchStream<float>(*workspace->factory, forest));
    }));
    auto const last = std::make_shared<BfrExt::CellForest>(makeNextForest());
    contest.contestants.push_back(makeContestant("BfrExt::ViewBounds, points that change", [=] {
        BfrExt::CellForest forest = makeNextForest();
        double const result =
            workspace->Stream(BfrExt::PatchStream<float>(*workspace->factory, forest),
                              forest.FindChangedFaces(*last));
        *last = std::move(forest);
        return result;
    }));
    contest.pairings = {{"view", 0, {1}}, {"view-bounds", 2, {1}}, {"view-next", 3, {1}}};
    return contest;
}

/// A bipyramid, with \p n differently sharp edges at one tip.
BenchMesh makePole(int n) {
    Shape shape = MakeBipyramid(n);
    int const tip = shape.GetNumVertices() - 1;
    for (int i = 0; i < n; ++i) {
        shape.creaseVertexPairs.insert(shape.creaseVertexPairs.end(), {i, tip});
        shape.creaseSharpness.push_back(0.5F + 3 * float(i) / float(n));
    }
    return {std::make_shared<Shape const>(std::move(shape)), "pole", "small", 0};
}

/// All types are made again.
Contest makePoleContest() {
    Contest contest;
    for (int const n : {64, 16}) {
        auto const workspace = std::make_shared<Workspace>(makePole(n));
        contest.contestants.push_back(
            makeContestant("BfrExt::View, " + std::to_string(n) + " edges", [=] {
                auto const factory = BfrExt::SurfaceFactory::Create(*workspace->refiner);
                BfrExt::CellForest const forest =
                    workspace->view.MakeForest(*factory, workspace->positions.data(), 3);
                workspace->Stream(BfrExt::PatchStream<float>(*factory, forest));
                return factory->GetNumFaces();
            }));
    }
    contest.pairings = {{"view-pole", 0, {1}}};
    return contest;
}

} // namespace

void AddViewBenchmarks(Suite &suite) {
    auto const add = [&](BenchMesh const &mesh, Memory memory) {
        suite.AddContest({"surfaces for a camera", "picture", mesh, memory},
                         [=] { return makeContest(mesh); });
    };
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        add(mesh, Memory::Default);
        add(mesh, Memory::Warm);
    }
    for (BenchMesh const &mesh : suite.GetIrregularMeshes()) {
        add(mesh, Memory::Default);
    }
    suite.AddContest({"surfaces at a vertex of many edges", "face", makePole(64), Memory::Default},
                     makePoleContest);
}

} // namespace OpenSubdivHex::Regression
