// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_MULTIPLIER_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_MULTIPLIER_H

#include "symbolicTable.h"

namespace OpenSubdivHex::FarExt::internal {

/// \brief Where the stencils of the rows of one refinement are.  That of a row begins at entry
/// offsets[row] of weights and indices; one that the table does not have, at entry ~offsets[row] of
/// spareWeights.
template <typename REAL>
struct StencilPlaces {
    using Index = Far::Index;

    REAL *GetWeights(Index row) const {
        Index const offset = offsets[row];
        return offset < 0 ? spareWeights + ~offset : weights + offset;
    }

    Index const *offsets;
    REAL *weights;
    Index *indices;
    Index const *indexOfSource; // null: sources are indices
    REAL *spareWeights;
};

/// \brief Memory for stencils of a refinement's rows that no table has.
template <typename REAL>
struct SpareStencils {
    using Index = Far::Index;

    /// Takes memory for all rows, which have these supports, and says where they are to be.
    StencilPlaces<REAL> Place(std::vector<Support> const &supports);
    REAL const *GetWeights(Index row) const { return weights.data() + ~offsets[row]; }

    Buffer<Index> offsets;
    Buffer<REAL> weights;
};

/// \brief Multiplies the rows of a refinement by the stencils of its parent's vertices, which gives
/// those of the vertices that it makes.
///
/// Sums are formed in double, in an order that the topology fixes, and rounded once, so that the
/// weights of a stencil sum to 1 as well as REAL can.
template <typename REAL>
class StencilMultiplier {
public:
    using Index = Far::Index;

    /// \param pStencils  of the parent's vertices; null where these are sources themselves
    StencilMultiplier(RefinementRows const &rows, RowSupports const &pSupports,
                      RowSupports const &supports, StencilPlaces<REAL> const *pStencils,
                      StencilPlaces<REAL> const &stencils)
        : _rows(rows), _pSupports(pSupports), _supports(supports), _pStencils(pStencils),
          _stencils(stencils) {}

    /// \p numSources is more than any source of a stencil.
    void Fill(Index numSources) const;

private:
    // The data of one thread.  The arrays written most are buffers, which share no cache lines with
    // those of another thread: benchmark table/hexagon/small/warm with 2 threads is 1.1 times as fast.
    struct Scratch {
        explicit Scratch(Index numSources) : position(numSources), sumOfSource(numSources) {}

        PagedArray<int> position;          // of each source in the support of the face
        PagedArray<double> sumOfSource;    // all 0 between two V-vertices
        Buffer<Index> sources;             // of a V-vertex, see RowSupports
        std::vector<double> sums;          // one dense stencil
        Buffer<REAL> block;                // of dense stencils
        std::vector<REAL const *> parents; // dense stencils of a face's vertices over its support
        std::vector<REAL *> rows;          // those of its F-vertices
    };

    void fillFace(Index face, Scratch &scratch) const;
    void fillSourceFace(Index face, Scratch &scratch) const;
    void loadParents(Index face, Scratch &scratch) const;
    void multiply(Index face, Scratch &scratch) const;
    void prefetchFaceRows(Index vVertex) const;
    void storeIndices(Index row, Support sources) const;
    void fillVVertex(Index vVertex, Scratch &scratch) const;

    REAL const *parentWeights(Index vert) const {
        static constexpr REAL kOne[] = {REAL(1)};
        return _pStencils ? _pStencils->GetWeights(vert) : kOne;
    }

    RefinementRows const &_rows;
    RowSupports const &_pSupports;
    RowSupports const &_supports;
    StencilPlaces<REAL> const *_pStencils;
    StencilPlaces<REAL> const _stencils;
};

/// \brief Makes the stencils of a table's levels, each of those of the level before.
///
/// \param place  place(level) takes memory for the rows of a level, which it may drop when it is asked for
///               that of the next but one
template <typename REAL, typename PLACE>
void FillStencils(SymbolicTable const &symbolic, PLACE place) {
    StencilPlan const &plan = symbolic.GetPlan();
    StencilPlaces<REAL> pPlaces{};
    for (int level = plan.firstBuilt; level <= plan.lastLevel; ++level) {
        StencilPlaces<REAL> const places = place(level);
        StencilMultiplier<REAL>(symbolic.GetRows(level), symbolic.GetParentSupports(level),
                                symbolic.GetSupports(level),
                                plan.HasParentStencils(level) ? &pPlaces : nullptr, places)
            .Fill(symbolic.GetNumSources(level));
        pPlaces = places;
    }
}

extern template struct SpareStencils<float>;
extern template struct SpareStencils<double>;
extern template class StencilMultiplier<float>;
extern template class StencilMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
