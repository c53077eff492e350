// SPDX-License-Identifier: Apache-2.0
#include "evaluation.h"

#include "far_ext/primvarRefiner.h"
#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/refinementEvaluator.h"

#include <opensubdiv/osd/cpuEvaluator.h>
#ifdef HEXREFINE_HAS_OPENMP
#include <opensubdiv/osd/ompEvaluator.h>
#endif

#include <cmath>

namespace OpenSubdivHex::Tools {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;

/// Numbers that the primvar refiner adds up.
template <int WIDTH>
struct Value {
    float numbers[WIDTH];

    void Clear() {
        for (float &number : numbers) {
            number = 0;
        }
    }
    void AddWithWeight(Value const &value, float weight) {
        for (int i = 0; i < WIDTH; ++i) {
            numbers[i] += weight * value.numbers[i];
        }
    }
};

template <int WIDTH>
void evaluateLevels(FarExt::TopologyRefiner const &refiner, Primvar const &primvar,
                    std::vector<float> *array) {
    static_assert(sizeof(Value<WIDTH>) == WIDTH * sizeof(float), "read as an array of floats");
    FarExt::PrimvarRefiner const primvarRefiner(refiner);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        FarExt::TopologyLevel const &topology = refiner.GetLevel(level);
        bool const isFaceVarying = primvar.mode == FarExt::INTERPOLATE_FACE_VARYING;
        int const numValues = isFaceVarying ? topology.GetNumFVarValues(primvar.fvarChannel)
                                            : topology.GetNumVertices();
        std::vector<float> values(WIDTH * std::size_t(numValues));
        auto const *const source = reinterpret_cast<Value<WIDTH> const *>(array->data());
        auto *const destination = reinterpret_cast<Value<WIDTH> *>(values.data());
        if (isFaceVarying) {
            primvarRefiner.InterpolateFaceVarying(level, source, destination, primvar.fvarChannel);
        } else if (primvar.mode == FarExt::INTERPOLATE_VARYING) {
            primvarRefiner.InterpolateVarying(level, source, destination);
        } else {
            primvarRefiner.Interpolate(level, source, destination);
        }
        *array = std::move(values);
    }
}

bool evaluateRefinement(FarExt::TopologyRefiner const &refiner, Primvar const &primvar,
                        FarExt::CallStatus *status) {
    OsdExt::RefinementEvaluator::Options options;
    options.interpolationMode = primvar.mode;
    options.fvarChannel = primvar.fvarChannel;
    auto const evaluator = OsdExt::RefinementEvaluator::Create(refiner, options, status);
    if (!evaluator) {
        return false;
    }
    int const level = evaluator->GetMaxLevel();
    int const width = primvar.width;
    Osd::BufferDescriptor const desc(0, width, width);
    for (std::vector<float> *array : primvar.arrays) {
        std::vector<float> values(std::size_t(width) *
                                  std::size_t(evaluator->GetNumElements(level)));
        if (!evaluator->Evaluate(array->data(), desc, values.data(), desc, level, status)) {
            return false;
        }
        *array = std::move(values);
    }
    return true;
}

void setNormalized(double const (&vector)[3], float *result) {
    double const length = std::hypot(vector[0], vector[1], vector[2]);
    for (int k = 0; k < 3; ++k) {
        result[k] = float(length > 0 ? vector[k] / length : vector[k]);
    }
}

/// Points of the limit surface, and derivatives there: three floats for each side of a vertex.
struct LimitArrays {
    explicit LimitArrays(int numSides)
        : points(3 * std::size_t(numSides)), du(points.size()), dv(points.size()) {}

    /// 1 long; 0 where there is no tangent plane.
    std::vector<float> GetNormals() const {
        std::vector<float> normals(du.size());
        for (std::size_t i = 0; i < normals.size(); i += 3) {
            double normal[3]; // products of floats need not be floats
            for (std::size_t k = 0; k < 3; ++k) {
                std::size_t const a = i + (k + 1) % 3;
                std::size_t const b = i + (k + 2) % 3;
                normal[k] = double(du[a]) * double(dv[b]) - double(du[b]) * double(dv[a]);
            }
            setNormalized(normal, normals.data() + i);
        }
        return normals;
    }

    std::vector<float> points;
    std::vector<float> du;
    std::vector<float> dv;
};

} // namespace

bool NeedsStencils(std::string const &evaluator) {
    return evaluator == kStencil || evaluator == kStencilCpu || evaluator == kStencilOmp;
}

bool EvaluateLevels(FarExt::TopologyRefiner const &refiner, std::string const &evaluator,
                    Primvar const &primvar, FarExt::CallStatus *status) {
    if (evaluator == kRefinement) {
        return evaluateRefinement(refiner, primvar, status);
    }
    for (std::vector<float> *array : primvar.arrays) {
        if (primvar.width == 1) {
            evaluateLevels<1>(refiner, primvar, array);
        } else if (primvar.width == 2) {
            evaluateLevels<2>(refiner, primvar, array);
        } else {
            evaluateLevels<3>(refiner, primvar, array);
        }
    }
    return true;
}

std::unique_ptr<Far::StencilTable const> CreateStencils(FarExt::TopologyRefiner const &refiner,
                                                        Primvar const &primvar,
                                                        FarExt::CallStatus *status) {
    FarExt::StencilTableFactory::Options options;
    options.generateIntermediateLevels = false;
    options.interpolationMode = primvar.mode;
    options.fvarChannel = primvar.fvarChannel;
    return FarExt::StencilTableFactory::Create(refiner, options, status);
}

bool EvaluateStencils(Far::StencilTable const &table, std::string const &evaluator,
                      Primvar const &primvar) {
    int const width = primvar.width;
    Osd::BufferDescriptor const desc(0, width, width);
    auto evaluate = [&](auto const &evaluateRange) {
        for (std::vector<float> *array : primvar.arrays) {
            std::vector<float> values(std::size_t(width) * std::size_t(table.GetNumStencils()));
            if (!evaluateRange(array->data(), desc, values.data(), desc, table.GetSizes().data(),
                               table.GetOffsets().data(), table.GetControlIndices().data(),
                               table.GetWeights().data(), 0, table.GetNumStencils())) {
                return false;
            }
            *array = std::move(values);
        }
        return true;
    };
    if (evaluator == kStencil) {
        return evaluate(
            [](auto... args) { return OsdExt::ParallelEvaluator::EvalStencils(args...); });
    }
#ifdef HEXREFINE_HAS_OPENMP
    if (evaluator == kStencilOmp) {
        return evaluate([](auto... args) { return Osd::OmpEvaluator::EvalStencils(args...); });
    }
#endif
    return evaluate([](auto... args) { return Osd::CpuEvaluator::EvalStencils(args...); });
}

std::unique_ptr<Far::LimitStencilTable const>
CreateLimitStencils(FarExt::TopologyRefiner const &refiner, bool fromLevel0,
                    FarExt::CallStatus *status) {
    FarExt::LimitStencilTableFactory::Options options;
    options.level = refiner.GetMaxLevel();
    options.generateFurtherSides = true;
    options.factorizeIntermediateLevels = fromLevel0;
    return FarExt::LimitStencilTableFactory::Create(refiner, options, status);
}

bool EvaluateLimit(Far::LimitStencilTable const &table, FarExt::LimitSides const &sides,
                   std::string const &evaluator, std::vector<float> *positions,
                   std::vector<float> *normals) {
    LimitArrays limit(table.GetNumStencils());
    Osd::BufferDescriptor const desc(0, 3, 3);
    auto evaluate = [&](auto const &evaluateRange) {
        return evaluateRange(positions->data(), desc, limit.points.data(), desc, limit.du.data(),
                             desc, limit.dv.data(), desc, table.GetSizes().data(),
                             table.GetOffsets().data(), table.GetControlIndices().data(),
                             table.GetWeights().data(), table.GetDuWeights().data(),
                             table.GetDvWeights().data(), 0, table.GetNumStencils());
    };
    bool isDone = false;
    if (evaluator == kStencilCpu) {
        isDone = evaluate([](auto... args) { return Osd::CpuEvaluator::EvalStencils(args...); });
#ifdef HEXREFINE_HAS_OPENMP
    } else if (evaluator == kStencilOmp) {
        isDone = evaluate([](auto... args) { return Osd::OmpEvaluator::EvalStencils(args...); });
#endif
    } else {
        isDone =
            evaluate([](auto... args) { return OsdExt::ParallelEvaluator::EvalStencils(args...); });
    }
    if (!isDone) {
        return false;
    }
    *normals = limit.GetNormals();
    // The points of further sides are those of their vertices.
    limit.points.resize(3 * std::size_t(sides.GetNumVertices()));
    *positions = std::move(limit.points);
    return true;
}

bool EvaluateLimit(FarExt::TopologyRefiner const &refiner, std::string const &evaluator,
                   std::vector<float> *positions, std::vector<float> *normals,
                   FarExt::CallStatus *status) {
    int const level = refiner.GetMaxLevel();
    LimitArrays limit(refiner.GetLevel(level).GetNumVertices());
    if (evaluator == kRefinement) {
        auto const refinement = OsdExt::RefinementEvaluator::Create(refiner, status);
        Osd::BufferDescriptor const desc(0, 3, 3);
        if (!refinement || !refinement->EvaluateLimit(positions->data(), desc, limit.points.data(),
                                                      desc, limit.du.data(), desc, limit.dv.data(),
                                                      desc, level, status)) {
            return false;
        }
    } else {
        Primvar const primvar{FarExt::INTERPOLATE_VERTEX, 0, 3, {positions}};
        evaluateLevels<3>(refiner, primvar, positions);
        auto const *const source = reinterpret_cast<Value<3> const *>(positions->data());
        auto *const points = reinterpret_cast<Value<3> *>(limit.points.data());
        auto *const du = reinterpret_cast<Value<3> *>(limit.du.data());
        auto *const dv = reinterpret_cast<Value<3> *>(limit.dv.data());
        if (!FarExt::PrimvarRefiner(refiner).Limit(source, points, du, dv, status)) {
            return false;
        }
    }
    *normals = limit.GetNormals();
    *positions = std::move(limit.points);
    return true;
}

void Normalize(std::vector<float> *vectors) {
    for (std::size_t i = 0; i + 2 < vectors->size(); i += 3) {
        float *const vector = vectors->data() + i;
        double const numbers[3] = {vector[0], vector[1], vector[2]};
        setNormalized(numbers, vector);
    }
}

} // namespace OpenSubdivHex::Tools
