// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/stencilTable.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief The types of stencil table by the precision of the weights.
template <typename REAL>
struct StencilTableTypes {
    /// Far's table with weights of type REAL.
    using Table = Far::StencilTableReal<REAL>;
};
/// \brief In single precision.
template <>
struct StencilTableTypes<float> {
    /// The type that Osd's evaluators take.
    using Table = Far::StencilTable;
};

/// \brief The kind of data that stencils interpolate, spelled as in Far::StencilTableFactory.
enum StencilMode : int {
    INTERPOLATE_VERTEX,      ///< vertex data, with the masks of the scheme
    INTERPOLATE_VARYING,     ///< varying data, linearly
    INTERPOLATE_FACE_VARYING ///< the values of a face-varying channel
};

/// \brief Stencils, weights and bytes of a stencil table: see StencilTableFactoryReal::GetSize.
struct StencilTableSize {
    std::int64_t numStencils = 0; ///< rows of the table
    std::int64_t numWeights = 0;  ///< of all stencils
    std::int64_t numBytes = 0;    ///< of the table's arrays
};

/// \brief Makes Far stencil tables of hexagonal refinements, for any Osd evaluator.
///
/// \code
///     FarExt::StencilTableFactory::Options options;
///     options.generateIntermediateLevels = false; // the last level only
///     auto table = FarExt::StencilTableFactory::Create(*refiner, options);
/// \endcode
///
/// Several threads may call it at once, also for the same refiner.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API StencilTableFactoryReal {
public:
    /// Far::StencilTable, or Far::StencilTableReal<double>.
    using Table = typename StencilTableTypes<REAL>::Table;

    /// \brief The fields of Far::StencilTableFactory::Options, with their meaning.
    ///
    /// Stencils come level by level, in vertex order: the control vertices (when asked for), then
    /// levels 1 ... L or level L alone, where L = min(maxLevel, refiner.GetMaxLevel()).
    ///
    /// Unlike Far, which has generateOffsets, offsets are always made: evaluators need them.
    /// Without factorization and without intermediate levels the table holds level L in terms of
    /// level L - 1 (Far does not support that combination).
    struct Options {
        StencilMode interpolationMode = INTERPOLATE_VERTEX; ///< what the stencils are of
        /// Whether one stencil of weight 1 for each control vertex comes first.
        bool generateControlVerts = false;
        bool generateIntermediateLevels = true; ///< levels 1 ... L, else L alone
        /// Whether indices are control vertices; else stencils of level i index the vertices of
        /// level i - 1, from 0.
        bool factorizeIntermediateLevels = true;
        int maxLevel = (std::numeric_limits<int>::max)(); ///< 0 or more; not cut to any bit width
        int fvarChannel =
            0; ///< for INTERPOLATE_FACE_VARYING, whose vertices are face-varying values
    };

    /// \brief Makes the table.
    ///
    /// The table has its exact size: no spare capacity, as many weights as indices, offsets filled.
    /// The indices of a stencil ascend; weights are non-negative and sum to 1.  All new points of a
    /// face have the same indices, so that some weights at borders and creases are 0.
    ///
    /// On a sharp border line that two meshes share, with the same sharpness at its vertices, the
    /// weights of the same control vertices are the same, bit for bit.  The values are so up to the
    /// order of the sum alone, which is that of the indices; PrimvarRefiner and
    /// OsdExt::RefinementEvaluator give the same values, bit for bit.
    ///
    /// \return  null on failure: InvalidArgument (negative maxLevel, mode or channel out of range) or
    ///          TooLarge (more than 2^31 - 1 stencils or weights up to the level that the status
    ///          names).
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner, Options options,
                                               CallStatus *status = nullptr);
    /// Overload with default options.
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner,
                                               CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// \brief Counts what a table will have, before memory is taken for it.
    ///
    /// It is the first of the two passes of Create(), which finds the indices that faces share: about a
    /// quarter of the time, in about a seventh of the table's memory.
    ///
    /// \return  zeros on failure, with the status of Create()
    static StencilTableSize GetSize(TopologyRefiner const &refiner, Options options,
                                    CallStatus *status = nullptr);

    /// @name Tables of a part of the mesh
    /// @{

    /// \brief Makes the table of the refined faces, and halves of hexagons, that lie in some base
    /// faces: those whose TopologyLevel::GetFaceBaseFace() is one of \p baseFaces.
    ///
    /// For each level in the table it has the vertices of these faces, or their values, in ascending order:
    /// GetVerticesOfFaces() says which; the stencils are, bit for bit, those that Create() makes for
    /// them, and index the control vertices of the whole mesh.  A hexagon that lies half in the
    /// selection has the four vertices of that half (kHexagonHalves).  What selections that share no
    /// base face have is disjoint but for the vertices along their borders; all base faces have all
    /// faces.  Time and memory are proportional to the selection and the faces around it.
    ///
    /// \param baseFaces  in any order, repeated or not; none gives a table without stencils
    /// \return  null on failure: as Create(); InvalidArgument, which names the face, for one out of
    ///          range; Unsupported without factorizeIntermediateLevels.
    static std::unique_ptr<Table const> CreateOfFaces(TopologyRefiner const &refiner,
                                                      Far::ConstIndexArray baseFaces,
                                                      Options options,
                                                      CallStatus *status = nullptr);

    /// \brief The vertices, or values of options.fvarChannel, that CreateOfFaces() makes stencils
    /// for at \p level (0: with generateControlVerts), in the order of the stencils: ascending.
    ///
    /// \return  empty on failure: InvalidArgument as CreateOfFaces(), or for a level that the
    ///          refiner does not have.
    static std::vector<Far::Index> GetVerticesOfFaces(TopologyRefiner const &refiner,
                                                      Far::ConstIndexArray baseFaces,
                                                      Options options, int level,
                                                      CallStatus *status = nullptr);
    /// @}
};

/// In single precision, for the Osd evaluators.
using StencilTableFactory = StencilTableFactoryReal<float>;

extern template class StencilTableFactoryReal<float>;
extern template class StencilTableFactoryReal<double>;

namespace internal {

/// InvalidArgument for a mode that is none, and for face-varying data of a channel that the mesh has not.
OPENSUBDIVHEX_API CallStatus CheckStencilMode(TopologyRefiner const &refiner, StencilMode mode,
                                              int fvarChannel);
/// By which masks data are interpolated, with a mode for which CheckStencilMode() is well.
OPENSUBDIVHEX_API Interpolation GetModeInterpolation(TopologyRefiner const &refiner,
                                                     StencilMode mode, int fvarChannel);

} // namespace internal

} // namespace OpenSubdivHex::FarExt

#endif
