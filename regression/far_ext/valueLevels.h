// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_VALUE_LEVELS_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_VALUE_LEVELS_H

#include "far_ext/primvarRefiner.h"
#include "regression/reference/reference.h"
#include "regression/shapes/shapes.h"

namespace OpenSubdivHex::Regression {

/// \brief A row of values with the interface that Far's primvar refiner asks for.
template <typename REAL>
struct ValueRow {
    void Clear() { value.setZero(); }
    void AddWithWeight(ValueRow const &other, REAL weight) { value += weight * other.value; }
    Eigen::Array<REAL, 1, Eigen::Dynamic> value;
};

/// The kinds of values that the library interpolates.
enum class ValueKind { Vertex, Varying, FaceVarying };

/// \brief Values of all levels of \p refiner from those of the base, computed by its
/// PrimvarRefiner.
template <typename REAL = double>
std::vector<ReferenceValues>
InterpolateLevels(FarExt::TopologyRefiner const &refiner, ReferenceValues const &base,
                  ValueKind kind = ValueKind::Vertex, int channel = 0) {
    FarExt::PrimvarRefinerReal<REAL> const primvarRefiner(refiner);
    // Not zero, so that an element that is never cleared shows.
    ValueRow<REAL> const unset{Eigen::Array<REAL, 1, Eigen::Dynamic>::Constant(base.cols(), 17)};
    std::vector<ReferenceValues> result{base};
    std::vector<ValueRow<REAL>> src(base.rows(), unset);
    for (Eigen::Index i = 0; i < base.rows(); ++i) {
        src[i].value = base.row(i).template cast<REAL>().array();
    }
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        FarExt::TopologyLevel const &topology = refiner.GetLevel(level);
        std::vector<ValueRow<REAL>> dst(kind == ValueKind::FaceVarying
                                            ? topology.GetNumFVarValues(channel)
                                            : topology.GetNumVertices(),
                                        unset);
        switch (kind) {
        case ValueKind::Vertex:
            primvarRefiner.Interpolate(level, src, dst);
            break;
        case ValueKind::Varying:
            primvarRefiner.InterpolateVarying(level, src, dst);
            break;
        case ValueKind::FaceVarying:
            primvarRefiner.InterpolateFaceVarying(level, src, dst, channel);
            break;
        }
        result.emplace_back(dst.size(), base.cols());
        for (std::size_t i = 0; i < dst.size(); ++i) {
            result.back().row(i) = dst[i].value.template cast<double>().matrix();
        }
        src = std::move(dst);
    }
    return result;
}

/// The values of a channel, a row each.
inline ReferenceValues GetValues(FVarChannel const &channel) {
    return Eigen::Map<ReferenceValues const>(
        channel.values.data(), Eigen::Index(channel.values.size()) / channel.width, channel.width);
}

} // namespace OpenSubdivHex::Regression

#endif
