// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/stencilTable.h>

#include <limits>

namespace OpenSubdivHex::FarExt {

/// \brief The types of stencil table by the precision of the weights.
template <typename REAL>
struct StencilTableTypes {
    using Table = Far::StencilTableReal<REAL>;
};
template <>
struct StencilTableTypes<float> {
    using Table = Far::StencilTable; ///< what the Osd evaluators take
};

/// \brief What the stencils interpolate, spelled as in Far::StencilTableFactory.
enum StencilMode { INTERPOLATE_VERTEX, INTERPOLATE_VARYING, INTERPOLATE_FACE_VARYING };

/// \brief Makes Far stencil tables of hexagonal refinements, for any Osd evaluator.
template <typename REAL>
class StencilTableFactoryReal {
public:
    using Table = typename StencilTableTypes<REAL>::Table;

    /// \brief The fields of Far::StencilTableFactory::Options, with their meaning.
    ///
    /// Stencils come level by level, in vertex order: the control vertices (when asked for), then
    /// levels 1 ... L or level L alone, where L = min(maxLevel, refiner.GetMaxLevel()).
    ///
    /// | generateControlVerts | one stencil of weight 1 for each control vertex comes first      |
    /// | generateIntermediateLevels | levels 1 ... L, else L alone                               |
    /// | factorizeIntermediateLevels | indices are control vertices; else stencils of level i    |
    /// |                      | index the vertices of level i - 1, from 0                        |
    ///
    /// Unlike Far, which has generateOffsets, offsets are always made: evaluators need them.
    /// Without factorization and without intermediate levels the table holds level L in terms of
    /// level L - 1 (Far does not support that combination).
    struct Options {
        StencilMode interpolationMode = INTERPOLATE_VERTEX;
        bool generateControlVerts = false;
        bool generateIntermediateLevels = true;
        bool factorizeIntermediateLevels = true;
        int maxLevel = std::numeric_limits<int>::max(); ///< 0 or more; not cut to any bit width
        int fvarChannel =
            0; ///< for INTERPOLATE_FACE_VARYING, whose vertices are face-varying values
    };

    /// \brief Makes the table.
    ///
    /// The table has its exact size: no spare capacity, as many weights as indices, offsets filled.
    /// The indices of a stencil ascend; weights are non-negative and sum to 1.
    ///
    /// \return  null on failure: InvalidArgument (negative maxLevel, channel out of range) or
    ///          TooLarge (more than 2^31 - 1 stencils or weights up to the level that the status
    ///          names).
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner, Options options,
                                               Status *status = nullptr);
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner,
                                               Status *status = nullptr) {
        return Create(refiner, Options(), status);
    }
};

using StencilTableFactory = StencilTableFactoryReal<float>;

extern template class StencilTableFactoryReal<float>;
extern template class StencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

#endif
