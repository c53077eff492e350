// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MULTIPLIER_H

#include "limitRows.h"

#include <opensubdiv/far/stencilTable.h>

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Rows that a LimitMultiplier has at most.
inline constexpr int kMaxLimitRows = 8;

/// \brief Multiplies limit rows by the stencils of their level, some rows at a time that are near
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

    /// \param stencils        of the vertices of the level, or null
    /// \param numVertices     of the level
    /// \param numIndices      more than any index
    /// \param hasDerivatives  whether those are wanted
    LimitMultiplier(Far::StencilTableReal<double> const *stencils, Index numVertices,
                    Index numIndices, bool hasDerivatives)
        : _stencils(stencils), _hasDerivatives(hasDerivatives),
          _numberOfVertex(std::size_t(numVertices)), _columnOfIndex(std::size_t(numIndices)) {}

    /// Forgets all rows.
    void Clear();
    /// Adds a row, of which nothing is referred to afterwards; kMaxLimitRows at most.
    void AddRow(LimitRow const &row);
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
        Index vert;
        RowBits rows;
    };
    // The indices of a source's stencil, ascending.
    struct List {
        Index const *indices;
        int size;
        RowBits rows;
    };

    Term const *getTerms(int row) const {
        return _terms.data() +
               (row < GetNumRows() ? std::size_t(_firstTerms[std::size_t(row)]) : _terms.size());
    }
    List getList(Source const &source) const;
    void findLists();
    void makeUnion();
    void makeDense(Columns const &columns);
    void scatterTerms(int row, int numColumns);
    template <int NUM_SUMS>
    void sumTerms(int row, int numColumns);
    void write(int row, Columns const &columns, Place const &place) const;

    Far::StencilTableReal<double> const *const _stencils;
    bool const _hasDerivatives;

    std::vector<int> _firstTerms; // by row
    std::vector<Term> _terms;     // of all rows in turn
    std::vector<Source> _sources;
    std::vector<Entry> _numberOfVertex; // among the sources
    unsigned _round = 0;

    std::vector<List> _lists;
    std::vector<Index> _columns;
    std::vector<Index> _added; // to the largest list
    std::vector<RowBits> _rowsOfColumns;
    std::vector<Entry> _columnOfIndex;
    unsigned _columnRound = 0;

    std::vector<double> _reference; // weights of the first source by column
    std::vector<REAL> _dense;       // differences of all sources to it, one after the other
    std::vector<REAL> _sums;        // of a row by column: points, then derivatives
};

extern template class LimitMultiplier<float>;
extern template class LimitMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
