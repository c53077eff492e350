// SPDX-License-Identifier: Apache-2.0
#include "osd_ext/patchEvaluator.h"

#include "osd_ext/simd/quad.h"

#include <opensubdiv/osd/cpuEvaluator.h>

#include <algorithm>
#include <cstddef>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The types that evaluators and the functions below share.
struct PatchTypes {
    using Output = PatchEvaluatorBase::PatchOutput;
    using Task = PatchEvaluatorBase::PatchTask;
};

namespace {

using PatchOutput = PatchTypes::Output;
using PatchTask = PatchTypes::Task;

using OpenSubdiv::Far::PatchDescriptor;

// The points of patches that are evaluated side by side: of one component, by point and place.
struct Points {
    float values[20][kQuad];

    Quad operator[](int i) const {
        Quad quad;
        std::memcpy(&quad, values[i], sizeof(quad));
        return quad;
    }
};

// Up to four places of patches of one type.
struct Places {
    int numPlaces = 0;
    int numbers[kQuad];        // of the places
    int const *indices[kQuad]; // of the points of their patches
    unsigned boundaries[kQuad];
    float s[kQuad];
    float t[kQuad];
    float scales[kQuad]; // of derivatives
};

enum class PatchType { Regular, Gregory, Bilinear };
constexpr int kNumTypes = 3;

constexpr int getNumPoints(PatchType type) {
    return type == PatchType::Regular ? 16 : type == PatchType::Gregory ? 20 : 4;
}

Quad load(float const *values) { return LoadFloats<kQuad>(values); }

// Sums are formed from both ends, so that they are the same when all is reversed.
OPENSUBDIVHEX_INLINE Quad sum(Quad const w[4], Quad const &a, Quad const &b, Quad const &c,
                              Quad const &d) {
    return (w[0] * a + w[3] * d) + (w[1] * b + w[2] * c);
}
OPENSUBDIVHEX_INLINE Quad sum(Quad const w[4], Quad const p[4]) {
    return sum(w, p[0], p[1], p[2], p[3]);
}

// A basis of four functions, with first and second derivatives.
struct Basis {
    Quad weights[3][4];
};

OPENSUBDIVHEX_INLINE Basis makeBezier(Quad const &s) {
    Quad const one = Spread(1);
    Quad const oneMinusS = one + Spread(-1) * s;
    Quad const three = Spread(3);
    Quad const six = Spread(6);
    Quad const minus = Spread(-1);
    Basis basis;
    basis.weights[0][0] = oneMinusS * (oneMinusS * oneMinusS);
    basis.weights[0][1] = three * (oneMinusS * oneMinusS) * s;
    basis.weights[0][2] = three * (s * s) * oneMinusS;
    basis.weights[0][3] = s * (s * s);
    basis.weights[1][0] = minus * three * (oneMinusS * oneMinusS);
    basis.weights[1][1] = three * (oneMinusS * oneMinusS) + minus * six * (s * oneMinusS);
    basis.weights[1][2] = six * (s * oneMinusS) + minus * three * (s * s);
    basis.weights[1][3] = three * (s * s);
    basis.weights[2][0] = six * oneMinusS;
    basis.weights[2][1] = six * (s + Spread(-2) * oneMinusS);
    basis.weights[2][2] = six * (oneMinusS + Spread(-2) * s);
    basis.weights[2][3] = six * s;
    return basis;
}

OPENSUBDIVHEX_INLINE Basis makeBSpline(Quad const &s) {
    Quad const oneMinusS = Spread(1) + Spread(-1) * s;
    Quad const sixth = Spread(1.0f / 6);
    auto const cube = [&](Quad const &x) { return sixth * (x * (x * x)); };
    auto const inner = [&](Quad const &x) {
        return sixth * (Spread(4) + (x * x) * (Spread(3) * x + Spread(-6)));
    };
    auto const derivative = [](Quad const &x) { return x * (Spread(1.5f) * x + Spread(-2)); };
    Basis basis;
    basis.weights[0][0] = cube(oneMinusS);
    basis.weights[0][1] = inner(s);
    basis.weights[0][2] = inner(oneMinusS);
    basis.weights[0][3] = cube(s);
    basis.weights[1][0] = Spread(-0.5f) * (oneMinusS * oneMinusS);
    basis.weights[1][1] = derivative(s);
    basis.weights[1][2] = Spread(-1) * derivative(oneMinusS);
    basis.weights[1][3] = Spread(0.5f) * (s * s);
    basis.weights[2][0] = oneMinusS;
    basis.weights[2][1] = Spread(3) * s + Spread(-2);
    basis.weights[2][2] = Spread(3) * oneMinusS + Spread(-2);
    basis.weights[2][3] = s;
    return basis;
}

// Shares of the two inner points at each corner of a Gregory patch.
struct GregoryShares {
    Quad first[4];
    Quad second[4];
};

GregoryShares makeGregoryShares(Places const &places) {
    float shares[4][kQuad];
    for (int i = 0; i < kQuad; ++i) {
        float const s = places.s[i];
        float const t = places.t[i];
        float const oneMinusS = 1 - s;
        float const oneMinusT = 1 - t;
        auto const share = [](float a, float b) { return a + b <= 0 ? a : a / (a + b); };
        shares[0][i] = share(s, t);
        shares[1][i] = share(t, oneMinusS);
        shares[2][i] = share(oneMinusS, oneMinusT);
        shares[3][i] = share(oneMinusT, s);
    }
    GregoryShares result;
    for (int corner = 0; corner < 4; ++corner) {
        result.first[corner] = load(shares[corner]);
        result.second[corner] = Spread(1) + Spread(-1) * result.first[corner];
    }
    return result;
}

// The points of a regular patch that lie beyond its boundaries continue it.
template <typename AT>
void extendBoundaries(unsigned boundaries, AT const &at) {
    auto const extend = [&](int outer, int step, int first, int stride) {
        for (int i = 0; i < 4; ++i) {
            int const point = first + i * stride;
            at(point) = 2 * at(point + step) - at(point + outer);
        }
    };
    if (boundaries & 1) {
        extend(8, 4, 0, 1);
    }
    if (boundaries & 2) {
        extend(-2, -1, 3, 4);
    }
    if (boundaries & 4) {
        extend(-8, -4, 12, 1);
    }
    if (boundaries & 8) {
        extend(2, 1, 0, 4);
    }
}

template <PatchType TYPE>
void gather(PatchTask const &task, Places const &places, int component, Points &points) {
    constexpr int kNumPoints = getNumPoints(TYPE);
    std::ptrdiff_t const stride = task.srcDesc.stride;
    float const *const src = task.src + task.srcDesc.offset + component;
    auto const isSame = [&](int i) { return places.indices[i] == places.indices[0]; };
    if (isSame(1) && isSame(2) && isSame(3)) {
        float values[kNumPoints];
        for (int k = 0; k < kNumPoints; ++k) {
            values[k] = src[places.indices[0][k] * stride];
        }
        if (TYPE == PatchType::Regular && places.boundaries[0] != 0) {
            extendBoundaries(places.boundaries[0], [&](int k) -> float & { return values[k]; });
        }
        for (int k = 0; k < kNumPoints; ++k) {
            StoreFloats<kQuad>(points.values[k], Spread(values[k]));
        }
        return;
    }
    for (int i = 0; i < kQuad; ++i) {
        for (int k = 0; k < kNumPoints; ++k) {
            points.values[k][i] = src[places.indices[i][k] * stride];
        }
        if (TYPE == PatchType::Regular && places.boundaries[i] != 0) {
            extendBoundaries(places.boundaries[i],
                             [&](int k) -> float & { return points.values[k][i]; });
        }
    }
}

// The points of a bicubic patch row by row.
template <PatchType TYPE>
OPENSUBDIVHEX_INLINE void arrange(Points const &points, GregoryShares const &shares,
                                  Quad grid[4][4]) {
    if constexpr (TYPE == PatchType::Regular) {
        for (int i = 0; i < 16; ++i) {
            grid[i / 4][i % 4] = points[i];
        }
    } else {
        constexpr int kBorder[4][4] = {
            {0, 1, 7, 5}, {2, -1, -1, 6}, {16, -1, -1, 12}, {15, 17, 11, 10}};
        for (int row = 0; row < 4; ++row) {
            for (int column = 0; column < 4; ++column) {
                if (kBorder[row][column] >= 0) {
                    grid[row][column] = points[kBorder[row][column]];
                }
            }
        }
        auto const blend = [&](int corner) {
            return shares.first[corner] * points[5 * corner + 3] +
                   shares.second[corner] * points[5 * corner + 4];
        };
        grid[1][1] = blend(0);
        grid[1][2] = blend(1);
        grid[2][2] = blend(2);
        grid[2][1] = blend(3);
    }
}

// Writes one component of an output.
void write(PatchOutput const &output, Places const &places, int component, Quad const &values) {
    if (!output.dst) {
        return;
    }
    float *const dst = output.dst + output.desc.offset + component;
    for (int i = 0; i < places.numPlaces; ++i) {
        dst[std::ptrdiff_t(places.numbers[i]) * output.desc.stride] = values[i];
    }
}

template <PatchType TYPE, int NUM_DERIVATIVES>
void evaluate(PatchTask const &task, Places &places) {
    // The places that are not there are as the last.
    for (int i = places.numPlaces; i < kQuad; ++i) {
        int const last = places.numPlaces - 1;
        places.indices[i] = places.indices[last];
        places.boundaries[i] = places.boundaries[last];
        places.s[i] = places.s[last];
        places.t[i] = places.t[last];
        places.scales[i] = places.scales[last];
    }
    Quad const s = load(places.s);
    Quad const t = load(places.t);
    Quad const scale = load(places.scales);
    PatchOutput const *const outputs = task.outputs;
    Points points;
    if constexpr (TYPE == PatchType::Bilinear) {
        Quad const oneMinusS = Spread(1) + Spread(-1) * s;
        Quad const oneMinusT = Spread(1) + Spread(-1) * t;
        for (int component = 0; component < task.srcDesc.length; ++component) {
            gather<TYPE>(task, places, component, points);
            Quad const low = oneMinusS * points[0] + s * points[1];
            Quad const high = oneMinusS * points[3] + s * points[2];
            write(outputs[0], places, component, oneMinusT * low + t * high);
            if constexpr (NUM_DERIVATIVES > 0) {
                Quad const minus = Spread(-1);
                Quad const ofLow = points[1] + minus * points[0];
                Quad const ofHigh = points[2] + minus * points[3];
                write(outputs[1], places, component, scale * (oneMinusT * ofLow + t * ofHigh));
                write(outputs[2], places, component, scale * (high + minus * low));
                if constexpr (NUM_DERIVATIVES > 1) {
                    write(outputs[3], places, component, Spread(0));
                    write(outputs[4], places, component, scale * scale * (ofHigh + minus * ofLow));
                    write(outputs[5], places, component, Spread(0));
                }
            }
        }
        return;
    } else {
        Basis const bs = TYPE == PatchType::Regular ? makeBSpline(s) : makeBezier(s);
        Basis const bt = TYPE == PatchType::Regular ? makeBSpline(t) : makeBezier(t);
        GregoryShares shares;
        if constexpr (TYPE == PatchType::Gregory) {
            shares = makeGregoryShares(places);
        }
        for (int component = 0; component < task.srcDesc.length; ++component) {
            gather<TYPE>(task, places, component, points);
            Quad grid[4][4];
            arrange<TYPE>(points, shares, grid);
            Quad rows[NUM_DERIVATIVES + 1][4]; // by derivative by s
            for (int order = 0; order <= NUM_DERIVATIVES; ++order) {
                for (int row = 0; row < 4; ++row) {
                    rows[order][row] = sum(bs.weights[order], grid[row]);
                }
            }
            write(outputs[0], places, component, sum(bt.weights[0], rows[0]));
            if constexpr (NUM_DERIVATIVES > 0) {
                write(outputs[1], places, component, scale * sum(bt.weights[0], rows[1]));
                write(outputs[2], places, component, scale * sum(bt.weights[1], rows[0]));
            }
            if constexpr (NUM_DERIVATIVES > 1) {
                Quad const square = scale * scale;
                write(outputs[3], places, component, square * sum(bt.weights[0], rows[2]));
                write(outputs[4], places, component, square * sum(bt.weights[1], rows[1]));
                write(outputs[5], places, component, square * sum(bt.weights[2], rows[0]));
            }
        }
    }
}

template <PatchType TYPE>
void evaluate(PatchTask const &task, int numDerivatives, Places &places) {
    if (places.numPlaces == 0) {
        return;
    }
    if (numDerivatives == 0) {
        evaluate<TYPE, 0>(task, places);
    } else if (numDerivatives == 1) {
        evaluate<TYPE, 1>(task, places);
    } else {
        evaluate<TYPE, 2>(task, places);
    }
    places.numPlaces = 0;
}

void evaluate(PatchTask const &task, PatchType type, int numDerivatives, Places &places) {
    switch (type) {
    case PatchType::Regular:
        return evaluate<PatchType::Regular>(task, numDerivatives, places);
    case PatchType::Gregory:
        return evaluate<PatchType::Gregory>(task, numDerivatives, places);
    case PatchType::Bilinear:
        return evaluate<PatchType::Bilinear>(task, numDerivatives, places);
    }
}

// A place of a patch of another type.
void evaluateByOsd(PatchTask const &task, int place) {
    float *dst[6];
    Osd::BufferDescriptor descs[6];
    for (int i = 0; i < 6; ++i) {
        PatchOutput const &output = task.outputs[i];
        descs[i] = output.desc;
        dst[i] = output.dst ? output.dst + std::ptrdiff_t(place) * output.desc.stride : nullptr;
    }
    Osd::CpuEvaluator::EvalPatches(task.src, task.srcDesc, dst[0], descs[0], dst[1], descs[1],
                                   dst[2], descs[2], dst[3], descs[3], dst[4], descs[4], dst[5],
                                   descs[5], 1, task.coords + place, task.arrays, task.indices,
                                   task.params);
}

} // namespace

} // namespace OpenSubdivHex::OsdExt::internal

namespace OpenSubdivHex::OsdExt {

bool PatchEvaluatorBase::checkPatchTask(PatchTask const &task, int numCoords) {
    auto const isWell = [&](Osd::BufferDescriptor const &desc) {
        return desc.length == task.srcDesc.length && desc.length >= 1 &&
               desc.stride >= desc.length && desc.offset >= 0;
    };
    if (!isWell(task.srcDesc)) {
        return false;
    }
    for (PatchOutput const &output : task.outputs) {
        if (output.dst && !isWell(output.desc)) {
            return false;
        }
    }
    return numCoords <= 0 ||
           (task.src && task.coords && task.arrays && task.indices && task.params);
}

void PatchEvaluatorBase::evaluatePatches(PatchTask const &task, int begin, int end) {
    using namespace internal;
    auto const isWanted = [&](int first, int last) {
        return std::any_of(task.outputs + first, task.outputs + last,
                           [](PatchOutput const &output) { return output.dst != nullptr; });
    };
    int const numDerivatives = isWanted(3, 6) ? 2 : isWanted(1, 3) ? 1 : 0;
    Places ofTypes[kNumTypes];
    for (int place = begin; place < end; ++place) {
        Osd::PatchCoord const &coord = task.coords[place];
        Osd::PatchArray const &array = task.arrays[coord.handle.arrayIndex];
        Osd::PatchParam const &param = task.params[coord.handle.patchIndex];
        PatchType type = PatchType::Regular;
        switch (param.IsRegular() ? array.GetPatchTypeRegular() : array.GetPatchTypeIrregular()) {
        case PatchDescriptor::REGULAR:
            break;
        case PatchDescriptor::GREGORY_BASIS:
            type = PatchType::Gregory;
            break;
        case PatchDescriptor::QUADS:
            type = PatchType::Bilinear;
            break;
        default:
            evaluateByOsd(task, place);
            continue;
        }
        Places &places = ofTypes[int(type)];
        int const i = places.numPlaces++;
        float st[2] = {coord.s, coord.t};
        param.Normalize(st[0], st[1]);
        places.numbers[i] = place;
        places.indices[i] = task.indices + array.GetIndexBase() +
                            std::ptrdiff_t(array.GetStride()) *
                                (coord.handle.patchIndex - array.GetPrimitiveIdBase());
        places.boundaries[i] = unsigned(param.GetBoundary());
        places.s[i] = st[0];
        places.t[i] = st[1];
        places.scales[i] = float(1 << param.GetDepth());
        if (places.numPlaces == kQuad) {
            evaluate(task, type, numDerivatives, places);
        }
    }
    for (int type = 0; type < kNumTypes; ++type) {
        evaluate(task, PatchType(type), numDerivatives, ofTypes[type]);
    }
}

} // namespace OpenSubdivHex::OsdExt
