// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H

#include "limitRows.h"

#include <opensubdiv/far/stencilTable.h>

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Rows that a LimitMultiplier has at most.
inline constexpr int kMaxLimitRows = 8;

/// \brief The stencils of sources: those of the levels before one, level by level from the control
/// vertices on, then those of the vertices of the level.  Either table may be null.
class SourceStencils {
public:
    using Table = Far::StencilTableReal<double>;

    struct Stencil {
        Far::Index const *indices;
        double const *weights;
        int size;
    };

    SourceStencils(Table const *before, Table const *last)
        : _tables{getArrays(before), getArrays(last)},
          _numBefore(before ? before->GetNumStencils() : 0), _isEmpty(!before && !last) {}

    bool IsEmpty() const { return _isEmpty; }
    Far::Index GetNumBefore() const { return _numBefore; }
    Stencil Get(Far::Index source) const {
        bool const isBefore = source < _numBefore;
        Arrays const &table = _tables[isBefore ? 0 : 1];
        Far::Index const row = isBefore ? source : source - _numBefore;
        Far::Index const offset = table.offsets[row];
        return {table.indices + offset, table.weights + offset, table.sizes[row]};
    }

private:
    struct Arrays {
        int const *sizes;
        Far::Index const *offsets;
        Far::Index const *indices;
        double const *weights;
    };
    static Arrays getArrays(Table const *table) {
        return table ? Arrays{table->GetSizes().data(), table->GetOffsets().data(),
                              table->GetControlIndices().data(), table->GetWeights().data()}
                     : Arrays{};
    }

    Arrays _tables[2];
    Far::Index _numBefore;
    bool _isEmpty;
};

/// \brief Multiplies limit rows by the stencils of their sources, some rows at a time that are near
/// one another: these have most sources in common, and sources mostly have the same indices.
/// Without stencils, sources are the indices.
///
/// Tables are made in two passes, the first of which finds the indices of all rows.  Each thread has
/// a multiplier.  Sums are formed in an order that the rows fix, of the differences to the stencil of
/// one vertex: at deep levels these are small, and weights of derivatives as exact as REAL is.
template <typename REAL>
class LimitMultiplier {
public:
    using Index = Far::Index;
    using RowBits = unsigned char; ///< a bit for each row

    static_assert(8 * sizeof(RowBits) >= kMaxLimitRows);

    /// \brief The indices of some rows, ascending, and which rows have each.
    struct Columns {
        Index const *indices;
        RowBits const *rows;
        int size;
    };

    /// \param stencils        of the sources
    /// \param numSources      more than any source
    /// \param numIndices      more than any index
    /// \param hasDerivatives  whether those are wanted
    LimitMultiplier(SourceStencils const &stencils, Index numSources, Index numIndices,
                    bool hasDerivatives)
        : _stencils(stencils), _hasDerivatives(hasDerivatives),
          _numberOfSource(std::size_t(numSources)), _columnOfIndex(std::size_t(numIndices)) {}

    /// \brief Rows that are added again and again, each time with other sources.
    class SharedRows;

    /// Forgets all rows.
    void Clear();
    /// Adds a row, of which nothing is referred to afterwards; kMaxLimitRows at most.
    ///
    /// \param firstSource  that of vertex 0 of the level whose vertices the row has
    void AddRow(LimitRow const &row, Index firstSource);
    /// All rows; their sources are numbers.
    SharedRows ShareRows() const;
    /// Forgets all rows and adds those, source number i being \p firstSource + \p sources[i].
    ///
    /// \param isAll  whether no other will be added, until Clear()
    void SetRows(SharedRows const &rows, Index const *sources, Index firstSource, bool isAll);
    int GetNumRows() const { return int(_firstTerms.size()); }

    /// Valid until the next call.
    Columns FindColumns();

    /// Where the stencil of a row is to be written, an entry of each array for each of its columns.
    struct Place {
        Index *indices;
        REAL *weights;
        REAL *duWeights; ///< these two are null without derivatives
        REAL *dvWeights;
    };
    /// Writes the stencils of all rows, whose \p columns are those that FindColumns() gave.
    void Fill(Columns const &columns, Place const *places);

private:
    // What has a value in the round that is set.
    struct Entry {
        unsigned round = 0;
        int value = 0;
    };
    // A source of a row, and its part in the sums.
    static constexpr int kNumSums = 3; // of points, du and dv
    struct Term {
        int source;
        REAL factors[kNumSums];
    };
    struct Source {
        Index index;
        RowBits rows;
    };
    // The indices of a source's stencil, ascending.
    struct List {
        Index const *indices;
        int size;
        RowBits rows;
    };

    Term const *getTerms(int row) const {
        return _terms.data() + (row < GetNumRows() ? _firstTerms[std::size_t(row)] : _numTerms);
    }
    List getList(Source const &source) const;
    void findLists();
    void makeUnion();
    void makeDense(Columns const &columns);
    void scatterTerms(int row, int numColumns);
    template <int NUM_SUMS>
    void sumTerms(int row, int numColumns);
    void write(int row, Columns const &columns, Place const &place) const;

    SourceStencils const _stencils;
    bool const _hasDerivatives;

    std::vector<int> _firstTerms; // by row
    std::vector<Term> _terms;     // of all rows in turn, and room for more
    int _numTerms = 0;
    std::vector<Source> _sources;
    std::vector<Entry> _numberOfSource; // among the sources of the rows
    unsigned _round = 0;

    std::vector<List> _lists;
    std::vector<Index> _columns;
    std::vector<Index> _added; // to the largest list
    std::vector<RowBits> _rowsOfColumns;
    std::vector<Entry> _columnOfIndex;
    unsigned _columnRound = 0;

    std::vector<double> _reference; // weights of the first source by column
    std::vector<REAL> _negative;    // the differences of nothing to it
    std::vector<REAL> _dense;       // differences of all sources to it, one after the other
    std::vector<REAL> _sums;        // of a row by column: points, then derivatives
};

template <typename REAL>
class LimitMultiplier<REAL>::SharedRows {
    friend class LimitMultiplier;

    std::vector<int> _firstTerms;
    std::vector<Term> _terms;
    std::vector<Source> _sources;
};

extern template class LimitMultiplier<float>;
extern template class LimitMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
