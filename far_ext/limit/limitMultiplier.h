// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H

#include "limitRows.h"

#include "far_ext/stencil/levelStencils.h"
#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/pagedArray.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Rows that a LimitMultiplier has at most.
inline constexpr int kMaxLimitRows = 64;

/// \brief Multiplies limit rows by the stencils of their sources, some rows at a time that are near
/// one another: these have most sources in common, and sources have indices in common.
///
/// Tables are made in two passes, the first of which finds the indices of all rows.  Each thread has
/// a multiplier.  Sums are formed in an order that the rows fix, of the differences to the stencil of
/// one vertex: at deep levels these are small, and weights of derivatives as exact as REAL is.
template <typename REAL>
class LimitMultiplier {
public:
    using Index = Far::Index;
    using RowBits = std::uint64_t; ///< a bit for each row

    static_assert(8 * sizeof(RowBits) >= kMaxLimitRows);

    /// \brief The indices of some rows, ascending, and which rows have each.
    struct Columns {
        Index const *indices;
        RowBits const *rows;
        int size;
    };

    /// \param stencils        of the sources; null where these are the indices
    /// \param numIndices      more than any index
    /// \param hasDerivatives  whether those are wanted
    LimitMultiplier(LevelStencils const *stencils, Index numIndices, bool hasDerivatives)
        : _stencils(stencils), _hasDerivatives(hasDerivatives), _columnOfIndex(numIndices) {}

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
    /// \brief Has those rows alone, source number i being \p firstSource + \p sources[i].
    ///
    /// \param rows  are referred to until the next Clear() or SetRows()
    void SetRows(SharedRows const &rows, Index const *sources, Index firstSource);
    int GetNumRows() const { return int(getRows().size()); }

    /// Valid until the next call.
    Columns FindColumns();

    /// \brief Writes the stencils of all rows, whose \p columns are those that FindColumns() gave: an
    /// entry for each of them that a row has.  A row without a place is not wanted.
    void Fill(Columns const &columns, LimitStencilPlace<REAL> const *places);

private:
    // The column of an index, and its rows in the round that is set.
    struct Entry {
        unsigned round = 0;
        int column = 0;
        RowBits rows = 0;
    };
    // A source of a row, and its part in the sums.
    static constexpr int kNumSums = 3; // of points, du and dv
    struct Term {
        int source;
        REAL factors[kNumSums];
    };
    // The terms of a row.
    struct RowTerms {
        int begin;
        int end;
    };
    struct Source {
        Index index;
        RowBits rows;
    };
    // Support that sources share, and the rows that have any of these sources.
    struct List {
        Support support;
        RowBits rows;
        int firstPosition;
    };

    std::vector<RowTerms> const &getRows() const;
    LevelStencils::Stencil const &getStencil(int source) const {
        return _stencils->Get(_sources[std::size_t(source)].index);
    }
    void findSourceColumns();
    void findLists();
    void makeUnion();
    void numberColumns(Index const *columns, int numColumns);
    void findDifferences(Columns const &columns);
    void scatterTerms(Term const *begin, Term const *end, int numColumns);
    template <int NUM_SUMS>
    void sumTerms(Term const *begin, Term const *end, int numColumns, REAL *const *sums) const;
    void write(int row, Columns const &columns, LimitStencilPlace<REAL> const &place) const;

    LevelStencils const *const _stencils;
    bool const _hasDerivatives;

    SharedRows const *_shared = nullptr; // the rows, if there are any of them
    std::vector<RowTerms> _rows;         // else these
    std::vector<Term> _terms;            // of these in turn, and room for more
    std::vector<Source> _sources;
    IndexMap _numberOfSource; // among the sources of the rows

    std::vector<List> _lists;
    std::vector<int> _listOfSource;
    std::vector<Index> _columns;
    std::vector<Index> _added; // to the largest list
    std::vector<RowBits> _rowsOfColumns;
    PagedArray<Entry> _columnOfIndex;
    unsigned _columnRound = 0;

    std::vector<int> _positions;    // of the indices of lists among the columns, list by list
    std::vector<double> _reference; // weights of the first source by column
    std::vector<REAL> _negative;    // the differences of nothing to it
    std::vector<REAL> _differences; // of all sources to it, one after the other
    std::vector<REAL> _sums;        // of a row by column: points, then derivatives
};

template <typename REAL>
class LimitMultiplier<REAL>::SharedRows {
    friend class LimitMultiplier;

    std::vector<RowTerms> _rows;
    std::vector<Term> _terms;
    std::vector<Source> _sources;
};

template <typename REAL>
auto LimitMultiplier<REAL>::getRows() const -> std::vector<RowTerms> const & {
    return _shared ? _shared->_rows : _rows;
}

extern template class LimitMultiplier<float>;
extern template class LimitMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
