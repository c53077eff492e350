// SPDX-License-Identifier: Apache-2.0
#include "limitMultiplier.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// Begins a round in which no entry has a value.
template <typename ENTRY>
void beginRound(PagedArray<ENTRY> &entries, unsigned &round) {
    entries.Begin();
    if (++round == 0) {
        entries.Clear();
        ++round;
    }
}

// As many sums as are formed at once, in registers.
constexpr int kSumWidth = 8;

int getStride(int numColumns) { return std::max(numColumns, kSumWidth); }

} // namespace

template <typename REAL>
void LimitMultiplier<REAL>::Clear() {
    _shared = nullptr;
    _rows.clear();
    _sources.clear();
    _numberOfSource.Clear();
}

template <typename REAL>
void LimitMultiplier<REAL>::AddRow(LimitRow const &row, Index firstSource) {
    auto const rowBit = RowBits(1) << GetNumRows();
    int const begin = _rows.empty() ? 0 : _rows.back().end;
    std::size_t const numTerms = std::size_t(begin) + std::size_t(row.size);
    if (_terms.size() < numTerms) {
        _terms.resize(2 * numTerms);
    }
    Term *term = _terms.data() + begin;
    for (int i = 0; i < row.size; ++i) {
        bool const isUsed = _hasDerivatives ? !row.IsNothing(i) : row.weights[i] != 0;
        if (!isUsed) {
            continue;
        }
        Index const source = firstSource + row.sources[i];
        Index const number = _numberOfSource.FindOrSet(source, Index(_sources.size()));
        if (number == Index(_sources.size())) {
            _sources.push_back({source, 0});
        }
        _sources[std::size_t(number)].rows |= rowBit;
        *term++ = {number, {REAL(row.weights[i]), REAL(row.du[i]), REAL(row.dv[i])}};
    }
    _rows.push_back({begin, int(term - _terms.data())});
}

template <typename REAL>
auto LimitMultiplier<REAL>::ShareRows() const -> SharedRows {
    SharedRows rows;
    rows._rows = _rows;
    rows._terms.assign(_terms.begin(), _terms.begin() + (_rows.empty() ? 0 : _rows.back().end));
    rows._sources = _sources;
    return rows;
}

template <typename REAL>
void LimitMultiplier<REAL>::SetRows(SharedRows const &rows, Index const *sources,
                                    Index firstSource) {
    _shared = &rows;
    _sources = rows._sources;
    for (Source &source : _sources) {
        source.index = firstSource + sources[source.index];
    }
}

template <typename REAL>
auto LimitMultiplier<REAL>::FindColumns() -> Columns {
    if (!_stencils) {
        findSourceColumns();
        return {_columns.data(), _rowsOfColumns.data(), int(_columns.size())};
    }
    findLists();
    makeUnion();
    return {_columns.data(), _rowsOfColumns.data(), int(_columns.size())};
}

template <typename REAL>
void LimitMultiplier<REAL>::findSourceColumns() {
    _columns.clear();
    for (Source const &source : _sources) {
        _columns.push_back(source.index);
    }
    std::sort(_columns.begin(), _columns.end());
    numberColumns(_columns.data(), int(_columns.size()));
    _rowsOfColumns.resize(_columns.size());
    for (Source const &source : _sources) {
        int const column = _columnOfIndex[source.index].column;
        _rowsOfColumns[std::size_t(column)] = source.rows;
    }
}

template <typename REAL>
void LimitMultiplier<REAL>::numberColumns(Index const *columns, int numColumns) {
    _columnOfIndex.Begin();
    _columnOfIndex.ForEach(columns, numColumns, [](Entry &entry, int i) { entry.column = i; });
}

// The lists of all sources; one that is among the last ones is not added again.
template <typename REAL>
void LimitMultiplier<REAL>::findLists() {
    constexpr int kNumCompared = 16;
    _lists.clear();
    _listOfSource.resize(_sources.size());
    for (int source = 0; source < int(_sources.size()); ++source) {
        Support const support = getStencil(source).support;
        auto list = int(_lists.size()) - 1;
        int const end = std::max(list - kNumCompared, -1);
        while (list > end && !(_lists[std::size_t(list)].support == support)) {
            --list;
        }
        if (list == end) {
            list = int(_lists.size());
            _lists.push_back({support, 0, 0});
        }
        _lists[std::size_t(list)].rows |= _sources[std::size_t(source)].rows;
        _listOfSource[std::size_t(source)] = list;
    }
}

template <typename REAL>
void LimitMultiplier<REAL>::makeUnion() {
    Support const largest =
        std::max_element(_lists.begin(), _lists.end(), [](List const &a, List const &b) {
            return a.support.size() < b.support.size();
        })->support;
    beginRound(_columnOfIndex, _columnRound);
    _added.clear();
    for (Index const index : largest) {
        Entry &entry = _columnOfIndex[index];
        entry.round = _columnRound;
        entry.rows = 0;
    }
    for (List const &list : _lists) {
        for (Index const index : list.support) {
            Entry &entry = _columnOfIndex[index];
            if (entry.round != _columnRound) {
                entry.round = _columnRound;
                entry.rows = 0;
                _added.push_back(index);
            }
            entry.rows |= list.rows;
        }
    }
    std::sort(_added.begin(), _added.end());
    _columns.resize(std::size_t(largest.size()) + _added.size());
    std::merge(largest.begin(), largest.end(), _added.begin(), _added.end(), _columns.begin());
    _rowsOfColumns.resize(_columns.size());
    std::transform(_columns.begin(), _columns.end(), _rowsOfColumns.begin(),
                   [this](Index index) { return _columnOfIndex[index].rows; });
}

// The difference of each source to the first one, by column.
template <typename REAL>
void LimitMultiplier<REAL>::findDifferences(Columns const &columns) {
    findLists();
    _positions.clear();
    for (List &list : _lists) {
        list.firstPosition = int(_positions.size());
        _columnOfIndex.ForEach(
            list.support.begin(), list.support.size(),
            [this](Entry const &entry, int) { _positions.push_back(entry.column); });
    }
    auto const getPositions = [this](int source) {
        List const &list = _lists[std::size_t(_listOfSource[std::size_t(source)])];
        return _positions.data() + list.firstPosition;
    };
    auto const stride = std::size_t(getStride(columns.size));
    _reference.assign(stride, 0.0);
    LevelStencils::Stencil const &first = getStencil(0);
    for (int k = 0; k < first.support.size(); ++k) {
        _reference[std::size_t(getPositions(0)[k])] = first.weights[k];
    }
    _negative.resize(stride);
    std::transform(_reference.begin(), _reference.end(), _negative.begin(),
                   [](double weight) { return REAL(-weight); });
    _differences.resize(_sources.size() * stride);
    REAL *differences = _differences.data();
    double const *const reference = _reference.data();
    for (int source = 0; source < int(_sources.size()); ++source, differences += stride) {
        LevelStencils::Stencil const &stencil = getStencil(source);
        int const size = stencil.support.size();
        if (size == int(stride)) {
            for (int k = 0; k < size; ++k) {
                differences[k] = REAL(stencil.weights[k] - reference[k]);
            }
            continue;
        }
        std::copy(_negative.begin(), _negative.end(), differences);
        int const *const positions = getPositions(source);
        for (int k = 0; k < size; ++k) {
            differences[positions[k]] = REAL(stencil.weights[k] - reference[positions[k]]);
        }
    }
}

// For the vertices themselves: a term has one column.
template <typename REAL>
void LimitMultiplier<REAL>::scatterTerms(Term const *begin, Term const *end, int numColumns) {
    std::fill(_sums.begin(), _sums.end(), REAL(0));
    for (Term const *term = begin; term != end; ++term) {
        Index const index = _sources[std::size_t(term->source)].index;
        REAL *const sums = _sums.data() + _columnOfIndex[index].column;
        for (int sum = 0; sum < kNumSums; ++sum) {
            sums[sum * std::ptrdiff_t(getStride(numColumns))] += term->factors[sum];
        }
    }
}

// Some columns at a time, of which the last may be among those before, too.
template <typename REAL>
template <int NUM_SUMS>
void LimitMultiplier<REAL>::sumTerms(Term const *begin, Term const *end, int numColumns,
                                     REAL *const *sums) const {
    std::ptrdiff_t const stride = getStride(numColumns);
    std::ptrdiff_t const last = stride - kSumWidth;
    for (std::ptrdiff_t column = 0;; column = std::min(column + kSumWidth, last)) {
        REAL results[NUM_SUMS][kSumWidth] = {};
        for (int k = 0; k < kSumWidth; ++k) {
            results[0][k] = REAL(_reference[std::size_t(column + k)]);
        }
        for (Term const *term = begin; term != end; ++term) {
            REAL const *const differences = _differences.data() + term->source * stride + column;
            for (int sum = 0; sum < NUM_SUMS; ++sum) {
                for (int k = 0; k < kSumWidth; ++k) {
                    results[sum][k] += term->factors[sum] * differences[k];
                }
            }
        }
        for (int sum = 0; sum < NUM_SUMS; ++sum) {
            std::copy_n(results[sum], kSumWidth, sums[sum] + column);
        }
        if (column == last) {
            return;
        }
    }
}

// The columns that a row has.
template <typename REAL>
void LimitMultiplier<REAL>::write(int row, Columns const &columns,
                                  LimitStencilPlace<REAL> const &place) const {
    REAL const *const weights = _sums.data();
    REAL const *const du = weights + getStride(columns.size);
    REAL const *const dv = du + getStride(columns.size);
    int entry = 0;
    for (int column = 0; column < columns.size; ++column) {
        if (!(columns.rows[column] >> row & 1)) {
            continue;
        }
        place.indices[entry] = columns.indices[column];
        place.weights[entry] = weights[column];
        if (_hasDerivatives) {
            place.duWeights[entry] = du[column];
            place.dvWeights[entry] = dv[column];
        }
        ++entry;
    }
}

template <typename REAL>
void LimitMultiplier<REAL>::Fill(Columns const &columns, LimitStencilPlace<REAL> const *places) {
    numberColumns(columns.indices, columns.size);
    int const stride = getStride(columns.size);
    _sums.resize(kNumSums * std::size_t(stride));
    if (_stencils) {
        findDifferences(columns);
    }
    RowBits ofAll =
        columns.size >= kSumWidth ? ~RowBits(0) : RowBits(0); // rows that are summed up in place
    for (int i = 0; i < columns.size; ++i) {
        ofAll &= columns.rows[i];
    }
    std::vector<Term> const &ofRows = _shared ? _shared->_terms : _terms;
    for (int row = 0; row < GetNumRows(); ++row) {
        RowTerms const terms = getRows()[std::size_t(row)];
        Term const *const begin = ofRows.data() + terms.begin;
        Term const *const end = ofRows.data() + terms.end;
        LimitStencilPlace<REAL> const &place = places[row];
        if (!place.indices) {
            continue;
        }
        if (!_stencils) {
            scatterTerms(begin, end, columns.size);
            write(row, columns, place);
            continue;
        }
        bool const isInPlace = (ofAll >> row & 1) != 0;
        REAL *const inPlace[] = {place.weights, place.duWeights, place.dvWeights};
        REAL *const apart[] = {_sums.data(), _sums.data() + stride, _sums.data() + 2 * stride};
        REAL *const *const sums = isInPlace ? inPlace : apart;
        if (_hasDerivatives) {
            sumTerms<kNumSums>(begin, end, columns.size, sums);
        } else {
            sumTerms<1>(begin, end, columns.size, sums);
        }
        if (isInPlace) {
            std::copy_n(columns.indices, columns.size, place.indices);
        } else {
            write(row, columns, place);
        }
    }
}

template class LimitMultiplier<float>;
template class LimitMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal
