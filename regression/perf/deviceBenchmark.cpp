// SPDX-License-Identifier: Apache-2.0
//
// OpenGL: all levels by compute shaders without a table, against Osd's evaluator with the fastest
// table; and what lies before the first frame: nanoseconds per vertex of all levels.
#include "makers.h"
#include "regression/gl/glContext.h"

#include "far_ext/stencilTableFactory.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/glEvaluation.h"
#include "osd_ext/glRefinementEvaluator.h"

#include <opensubdiv/osd/glVertexBuffer.h>

#include <cmath>
#include <cstddef>
#include <memory>

namespace OpenSubdivHex::Regression {
namespace {

constexpr int kLength = 3;
Osd::BufferDescriptor const kPacked(0, kLength, kLength);

using GlTable = std::shared_ptr<Osd::GLStencilTableSSBO>;
using RefinerPointer = std::shared_ptr<FarExt::TopologyRefiner const>;

/// Waits for what OpenGL does.
void finish() { reinterpret_cast<void (*)()>(eglGetProcAddress("glFinish"))(); }

Table makeTable(FarExt::TopologyRefiner const &refiner) {
    return FarExt::StencilTableFactory::Create(refiner, {});
}

GlTable makeGlTable(FarExt::TopologyRefiner const &refiner) {
    Table const table = makeTable(refiner);
    GlTable result = OsdExt::CreateGLStencilTable<Osd::GLStencilTableSSBO>(*table);
    finish();
    return result;
}

/// Control values and all levels, on the device.
struct DeviceValues {
    explicit DeviceValues(FarExt::TopologyRefiner const &refiner) {
        int const numControl = refiner.GetLevel(0).GetNumVertices();
        for (int i = 0; i < numControl * kLength; ++i) {
            control.push_back(float(i % 1000) / 1000);
        }
        numVertices = refiner.GetNumVerticesTotal() - numControl;
        src.reset(Osd::GLVertexBuffer::Create(kLength, numControl));
        src->UpdateData(control.data(), 0, numControl);
        dst.reset(Osd::GLVertexBuffer::Create(kLength, numVertices));
    }

    std::vector<float> control;
    int numVertices;
    std::unique_ptr<Osd::GLVertexBuffer> src;
    std::unique_ptr<Osd::GLVertexBuffer> dst;
};

/// Checks the values on the device, and gives their number.
double validate(GlContext const &context, DeviceValues &values,
                FarExt::TopologyRefiner const &refiner, std::string const &name) {
    Table const table = makeTable(refiner);
    std::vector<float> expected(std::size_t(values.numVertices) * kLength);
    OsdExt::CpuEvaluator::EvalStencils(values.control.data(), kPacked, expected.data(), kPacked,
                                       table->GetSizes().data(), table->GetOffsets().data(),
                                       table->GetControlIndices().data(),
                                       table->GetWeights().data(), 0, table->GetNumStencils());
    std::vector<float> const found = context.Read(values.dst->BindVBO(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
        Require(std::abs(found[i] - expected[i]) < 1e-5f, name + ": wrong results");
    }
    return double(values.numVertices);
}

Contest makeFrames(BenchMesh const &mesh, GlContext const &context) {
    RefinerPointer const refiner = MakeRefined(mesh);
    auto const values = std::make_shared<DeviceValues>(*refiner);
    auto const add = [&](std::string const &name, double movedBytes,
                         std::function<bool()> const &evaluate) {
        Contestant contestant;
        contestant.name = name;
        contestant.movedBytes = movedBytes;
        contestant.work = [=] {
            Require(evaluate(), name + ": not evaluated");
            finish();
        };
        contestant.validate = [=, &context] { return validate(context, *values, *refiner, name); };
        return contestant;
    };
    std::shared_ptr<OsdExt::GLRefinementEvaluator> const own =
        OsdExt::GLRefinementEvaluator::Create(*refiner);
    Require(own != nullptr, "no evaluator of OpenGL");
    GlTable const table = makeGlTable(*refiner);
    std::shared_ptr<Osd::GLComputeEvaluator> const osd(Osd::GLComputeEvaluator::Create(
        kPacked, kPacked, Osd::BufferDescriptor(), Osd::BufferDescriptor()));
    double const bytes = double(values->numVertices) * kLength * sizeof(float);
    Contest contest;
    contest.contestants = {
        add("OsdExt::GLRefinementEvaluator", 1.25 * bytes + double(own->GetNumDeviceBytes()),
            [=] {
                return own->EvaluateAllLevels(values->src.get(), kPacked, values->dst.get(),
                                              kPacked);
            }),
        add("Osd::GLComputeEvaluator", bytes + GetNumBytes(*makeTable(*refiner)), [=] {
            return OsdExt::EvalStencilsInRanges(*osd, values->src.get(), kPacked, values->dst.get(),
                                                kPacked, *table);
        })};
    contest.pairings = {{"gl-levels", 0, {1}}};
    return contest;
}

// The last level, and its limit with derivatives; frames keep the refiner, which the first one needs.
Contest makeLimits(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeFullyRefined(mesh);
    std::shared_ptr<OsdExt::GLRefinementEvaluator> const own =
        OsdExt::GLRefinementEvaluator::Create(*refiner);
    Require(own != nullptr, "no evaluator of OpenGL");
    auto const values = std::make_shared<DeviceValues>(*refiner);
    int const numVertices = own->GetNumElements(refiner->GetMaxLevel());
    std::shared_ptr<Osd::GLVertexBuffer> const du(
        Osd::GLVertexBuffer::Create(kLength, numVertices));
    std::shared_ptr<Osd::GLVertexBuffer> const dv(
        Osd::GLVertexBuffer::Create(kLength, numVertices));
    auto const add = [&](std::string const &name,
                         std::function<bool(FarExt::CallStatus *)> const &evaluate) {
        Contestant contestant;
        contestant.name = name;
        contestant.work = [=] {
            FarExt::CallStatus status;
            bool const isDone = evaluate(&status);
            Require(isDone, name + ": " + status.GetErrorMessage());
            finish();
        };
        contestant.validate = [=] { return double(numVertices); };
        return contestant;
    };
    Contest contest;
    contest.contestants = {add("EvaluateLimit",
                               [=](FarExt::CallStatus *status) {
                                   return own->EvaluateLimit(values->src.get(), kPacked,
                                                             values->dst.get(), kPacked, du.get(),
                                                             kPacked, dv.get(), kPacked,
                                                             refiner->GetMaxLevel(), status);
                               }),
                           add("Evaluate", [=](FarExt::CallStatus *status) {
                               return own->Evaluate(values->src.get(), kPacked, values->dst.get(),
                                                    kPacked, refiner->GetMaxLevel(), status);
                           })};
    contest.pairings = {{"gl-limit", 0, {1}}};
    return contest;
}

/// The work of a host before the first frame; \p make gives an object that is kept until release.
template <typename MAKE>
Contestant makePreparation(std::string const &name, RefinerPointer const &refiner, MAKE make) {
    auto const made = std::make_shared<decltype(make())>();
    Contestant contestant;
    contestant.name = name;
    contestant.work = [=] {
        *made = make();
        finish();
    };
    contestant.validate = [=] {
        Require(*made != nullptr, name + ": nothing was made");
        return double(refiner->GetNumVerticesTotal() - refiner->GetLevel(0).GetNumVertices());
    };
    contestant.release = [=] { made->reset(); };
    return contestant;
}

Contest makePreparations(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeRefined(mesh);
    Contest contest;
    contest.contestants = {
        makePreparation("OsdExt::GLRefinementEvaluator", refiner,
                        [=] { return OsdExt::GLRefinementEvaluator::Create(*refiner); }),
        makePreparation("stencil table", refiner, [=] { return makeGlTable(*refiner); })};
    contest.pairings = {{"gl-preparation", 0, {1}}};
    return contest;
}

// New control values, and the last level of them.
std::function<void()> makeFrame(BenchMesh const &mesh) {
    RefinerPointer const refiner = MakeRefined(mesh);
    FarExt::CallStatus status;
    std::shared_ptr<OsdExt::GLRefinementEvaluator> const own =
        OsdExt::GLRefinementEvaluator::Create(*refiner, &status);
    Require(own != nullptr, status.GetErrorMessage());
    int const level = refiner->GetMaxLevel();
    int const numControl = refiner->GetLevel(0).GetNumVertices();
    std::vector<float> const control(std::size_t(numControl) * kLength, 0.5f);
    std::shared_ptr<Osd::GLVertexBuffer> const src(
        Osd::GLVertexBuffer::Create(kLength, numControl));
    std::shared_ptr<Osd::GLVertexBuffer> const dst(
        Osd::GLVertexBuffer::Create(kLength, own->GetNumElements(level)));
    return [=] {
        FarExt::CallStatus frameStatus;
        src->UpdateData(control.data(), 0, numControl);
        Require(own->Evaluate(src.get(), kPacked, dst.get(), kPacked, level, &frameStatus),
                frameStatus.GetErrorMessage());
        finish();
    };
}

} // namespace

void AddDeviceBenchmarks(Suite &suite, GlContext const &context) {
    for (BenchMesh const &mesh : suite.GetMeshes()) {
        suite.AddContest({"OpenGL, all levels, length 3", "vertex", mesh, Memory::Resident},
                         [=, &context] { return makeFrames(mesh, context); });
        suite.AddContest(
            {"OpenGL, limit with derivatives, length 3", "vertex", mesh, Memory::Resident},
            [=] { return makeLimits(mesh); });
        suite.AddContest({"OpenGL, preparation", "vertex", mesh, Memory::Default},
                         [=] { return makePreparations(mesh); });
    }
    AddFrameBenchmark(suite, "gl-frame", makeFrame);
}

} // namespace OpenSubdivHex::Regression
