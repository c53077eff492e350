// SPDX-License-Identifier: Apache-2.0
#include "limitMultiplier.h"

#include <algorithm>
#include <cstring>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// Begins a round in which no entry has a value.
template <typename ENTRY>
void beginRound(std::vector<ENTRY> &entries, unsigned &round) {
    if (++round == 0) {
        entries.assign(entries.size(), ENTRY());
        ++round;
    }
}

// Whole vectors of sums, so that loops over them have no rest.
constexpr int kVector = 8;

int roundUp(int size) { return (size + kVector - 1) / kVector * kVector; }

// sums[s][i] += the sum of factors[s][k] rows[k][i], in the order of k.
template <int NUM_SUMS, int NUM_ROWS, typename REAL>
void addProducts(REAL const (&factors)[NUM_SUMS][NUM_ROWS], REAL const *const (&rows)[NUM_ROWS],
                 int size, REAL *const (&sums)[NUM_SUMS]) {
    // Clang warns where it cannot make vectors of the loop.
#if defined(_OPENMP) && !defined(__clang__)
#pragma omp simd
#endif
    for (int i = 0; i < size; ++i) {
        for (int s = 0; s < NUM_SUMS; ++s) {
            REAL sum = sums[s][i];
            for (int k = 0; k < NUM_ROWS; ++k) {
                sum += factors[s][k] * rows[k][i];
            }
            sums[s][i] = sum;
        }
    }
}

} // namespace

template <typename REAL>
void LimitMultiplier<REAL>::Clear() {
    _firstTerms.clear();
    _numTerms = 0;
    _sources.clear();
    beginRound(_numberOfSource, _round);
}

template <typename REAL>
void LimitMultiplier<REAL>::AddRow(LimitRow const &row, Index firstSource) {
    auto const rowBit = RowBits(1u << _firstTerms.size());
    _firstTerms.push_back(_numTerms);
    auto const numTerms = std::size_t(_numTerms) + std::size_t(row.size);
    if (_terms.size() < numTerms) {
        _terms.resize(2 * numTerms);
    }
    Term *term = _terms.data() + _numTerms;
    for (int i = 0; i < row.size; ++i) {
        bool const isUsed = _hasDerivatives ? !row.IsNothing(i) : row.weights[i] != 0;
        if (!isUsed) {
            continue;
        }
        Index const source = firstSource + row.sources[i];
        Entry &number = _numberOfSource[std::size_t(source)];
        if (number.round != _round) {
            number = {_round, int(_sources.size())};
            _sources.push_back({source, 0});
        }
        _sources[std::size_t(number.value)].rows |= rowBit;
        *term++ = {number.value, {REAL(row.weights[i]), REAL(row.du[i]), REAL(row.dv[i])}};
    }
    _numTerms = int(term - _terms.data());
}

template <typename REAL>
auto LimitMultiplier<REAL>::ShareRows() const -> SharedRows {
    SharedRows rows;
    rows._firstTerms = _firstTerms;
    rows._terms.assign(_terms.begin(), _terms.begin() + _numTerms);
    rows._sources = _sources;
    return rows;
}

template <typename REAL>
void LimitMultiplier<REAL>::SetRows(SharedRows const &rows, Index const *sources, Index firstSource,
                                    bool isAll) {
    _firstTerms = rows._firstTerms;
    _numTerms = int(rows._terms.size());
    if (_terms.size() < rows._terms.size()) {
        _terms.resize(rows._terms.size());
    }
    std::copy(rows._terms.begin(), rows._terms.end(), _terms.begin());
    _sources = rows._sources;
    for (Source &source : _sources) {
        source.index = firstSource + sources[source.index];
    }
    if (!isAll) {
        beginRound(_numberOfSource, _round);
        for (std::size_t i = 0; i < _sources.size(); ++i) {
            _numberOfSource[std::size_t(_sources[i].index)] = {_round, int(i)};
        }
    }
}

template <typename REAL>
auto LimitMultiplier<REAL>::getList(Source const &source) const -> List {
    if (_stencils.IsEmpty()) {
        return {&source.index, 1, source.rows};
    }
    SourceStencils::Stencil const stencil = _stencils.Get(source.index);
    return {stencil.indices, stencil.size, source.rows};
}

template <typename REAL>
auto LimitMultiplier<REAL>::FindColumns() -> Columns {
    findLists();
    makeUnion();
    auto const numColumns = int(_columns.size());
    for (int i = 0; i < numColumns; ++i) {
        _columnOfIndex[std::size_t(_columns[std::size_t(i)])].value = i;
    }
    _rowsOfColumns.assign(_columns.size(), 0);
    for (List const &list : _lists) {
        for (int i = 0; i < list.size; ++i) {
            int const column = _columnOfIndex[std::size_t(list.indices[i])].value;
            _rowsOfColumns[std::size_t(column)] |= list.rows;
        }
    }
    return {_columns.data(), _rowsOfColumns.data(), numColumns};
}

// Those of all sources; one that is among the last ones is not added again.
template <typename REAL>
void LimitMultiplier<REAL>::findLists() {
    constexpr int kNumCompared = 16;
    _lists.clear();
    for (Source const &source : _sources) {
        List const list = getList(source);
        auto const isSame = [&](List const &known) {
            return known.size == list.size && known.indices[0] == list.indices[0] &&
                   std::memcmp(known.indices, list.indices,
                               std::size_t(list.size) * sizeof(Index)) == 0;
        };
        auto const end = _stencils.IsEmpty()
                             ? _lists.rbegin()
                             : _lists.rbegin() + std::min<std::ptrdiff_t>(
                                                     kNumCompared, std::ptrdiff_t(_lists.size()));
        auto const known = std::find_if(_lists.rbegin(), end, isSame);
        if (known != end) {
            known->rows |= list.rows;
        } else {
            _lists.push_back(list);
        }
    }
}

template <typename REAL>
void LimitMultiplier<REAL>::makeUnion() {
    List const largest = *std::max_element(
        _lists.begin(), _lists.end(), [](List const &a, List const &b) { return a.size < b.size; });
    beginRound(_columnOfIndex, _columnRound);
    _added.clear();
    for (int i = 0; i < largest.size; ++i) {
        _columnOfIndex[std::size_t(largest.indices[i])].round = _columnRound;
    }
    for (List const &list : _lists) {
        for (int i = 0; i < list.size; ++i) {
            Entry &column = _columnOfIndex[std::size_t(list.indices[i])];
            if (column.round != _columnRound) {
                column.round = _columnRound;
                _added.push_back(list.indices[i]);
            }
        }
    }
    std::sort(_added.begin(), _added.end());
    _columns.resize(std::size_t(largest.size) + _added.size());
    std::merge(largest.indices, largest.indices + largest.size, _added.begin(), _added.end(),
               _columns.begin());
}

// The difference of each source to the first one, by column.
template <typename REAL>
void LimitMultiplier<REAL>::makeDense(Columns const &columns) {
    auto const numColumns = std::size_t(columns.size);
    auto const getWeights = [&](Source const &source) {
        return _stencils.Get(source.index).weights;
    };
    auto const getColumn = [&](Index index) {
        return std::size_t(_columnOfIndex[std::size_t(index)].value);
    };
    _reference.assign(numColumns, 0.0);
    List const first = getList(_sources.front());
    for (int k = 0; k < first.size; ++k) {
        _reference[getColumn(first.indices[k])] = getWeights(_sources.front())[k];
    }
    _negative.resize(numColumns);
    std::transform(_reference.begin(), _reference.end(), _negative.begin(),
                   [](double weight) { return REAL(-weight); });
    auto const stride = std::size_t(roundUp(columns.size));
    _dense.resize(_sources.size() * stride);
    REAL *dense = _dense.data();
    for (Source const &source : _sources) {
        List const list = getList(source);
        double const *const weights = getWeights(source);
        if (list.size == columns.size) {
            for (std::size_t k = 0; k < numColumns; ++k) {
                dense[k] = REAL(weights[k] - _reference[k]);
            }
        } else {
            std::copy(_negative.begin(), _negative.end(), dense);
            for (int k = 0; k < list.size; ++k) {
                std::size_t const column = getColumn(list.indices[k]);
                dense[column] = REAL(weights[k] - _reference[column]);
            }
        }
        dense += stride;
    }
}

// Of the vertices themselves: a term has one column.
template <typename REAL>
void LimitMultiplier<REAL>::scatterTerms(int row, int numColumns) {
    std::fill(_sums.begin(), _sums.end(), REAL(0));
    for (Term const *term = getTerms(row); term != getTerms(row + 1); ++term) {
        Index const index = _sources[std::size_t(term->source)].index;
        REAL *const sums = _sums.data() + _columnOfIndex[std::size_t(index)].value;
        for (int sum = 0; sum < kNumSums; ++sum) {
            sums[sum * std::ptrdiff_t(roundUp(numColumns))] += term->factors[sum];
        }
    }
}

// Some terms at a time: sums are read and written less often.
template <typename REAL>
template <int NUM_SUMS>
void LimitMultiplier<REAL>::sumTerms(int row, int numColumns) {
    constexpr int kTerms = 4;
    int const stride = roundUp(numColumns);
    std::transform(_reference.begin(), _reference.end(), _sums.begin(),
                   [](double weight) { return REAL(weight); });
    std::fill(_sums.begin() + stride, _sums.end(), REAL(0));
    REAL *const sums[] = {_sums.data(), _sums.data() + stride, _sums.data() + 2 * stride};
    REAL *summed[NUM_SUMS];
    std::copy_n(sums, NUM_SUMS, summed);
    Term const *const end = getTerms(row + 1);
    for (Term const *term = getTerms(row); term < end; term += kTerms) {
        REAL const *differences[kTerms];
        REAL factors[NUM_SUMS][kTerms];
        for (int i = 0; i < kTerms; ++i) {
            // Nothing of the first one again, where there are no more.
            bool const isTerm = term + i < end;
            Term const &taken = term[isTerm ? i : 0];
            differences[i] = _dense.data() + taken.source * std::ptrdiff_t(stride);
            for (int sum = 0; sum < NUM_SUMS; ++sum) {
                factors[sum][i] = isTerm ? taken.factors[sum] : 0;
            }
        }
        addProducts(factors, differences, stride, summed);
    }
}

template <typename REAL>
void LimitMultiplier<REAL>::write(int row, Columns const &columns, Place const &place) const {
    REAL const *const weights = _sums.data();
    REAL const *const du = weights + roundUp(columns.size);
    REAL const *const dv = du + roundUp(columns.size);
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
void LimitMultiplier<REAL>::Fill(Columns const &columns, Place const *places) {
    for (int i = 0; i < columns.size; ++i) {
        _columnOfIndex[std::size_t(columns.indices[i])].value = i;
    }
    _sums.resize(kNumSums * std::size_t(roundUp(columns.size)));
    if (!_stencils.IsEmpty()) {
        makeDense(columns);
    }
    for (int row = 0; row < GetNumRows(); ++row) {
        if (_stencils.IsEmpty()) {
            scatterTerms(row, columns.size);
        } else if (_hasDerivatives) {
            sumTerms<kNumSums>(row, columns.size);
        } else {
            sumTerms<1>(row, columns.size);
        }
        write(row, columns, places[row]);
    }
}

template class LimitMultiplier<float>;
template class LimitMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal
