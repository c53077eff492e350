// SPDX-License-Identifier: Apache-2.0
#include "stencilMultiplier.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

namespace {

// As many weights as the smallest vector registers hold; loops go by whole ones.
constexpr int kVector = 4;

// Calls function(begin) for vectors that together are 0 ... size; the last may overlap the one
// before.  A size of less than a vector is not for it.
template <typename FUNCTION>
void forEachVector(int size, FUNCTION function) {
    int const last = size - kVector;
    for (int begin = 0; begin < last; begin += kVector) {
        function(begin);
    }
    function(last);
}

// As std::copy_n, faster for some ten elements.
template <typename T>
void copyShort(T const *src, int size, T *dst) {
    if (size < kVector) {
        std::copy_n(src, size, dst);
        return;
    }
    forEachVector(size, [=](int begin) { std::copy_n(src + begin, kVector, dst + begin); });
}

constexpr Index kAhead = 8; // V-vertices

// The weights of a circulant rule: all rows are the first, turned.
template <int SIZE>
struct CirculantWeights {
    explicit CirculantWeights(FaceRule const &rule) { std::copy_n(rule.GetRow(0), SIZE, weights); }
    double operator()(int, int j) const { return weights[j]; }

    double weights[SIZE];
};

// The weights of a dense rule.
template <int SIZE>
struct DenseWeights {
    explicit DenseWeights(FaceRule const &rule) {
        for (int i = 0; i < SIZE; ++i) {
            rows[i] = rule.GetRow(i);
        }
    }
    double operator()(int i, int j) const { return rows[i][(i + j) % SIZE]; }

    double const *rows[SIZE];
};

// The F-vertices of a face: its rows of weights times the rows of its vertices.  The weight of the
// vertex j places behind that of corner i is weights(i, j).
template <int SIZE, class WEIGHTS, typename REAL>
void multiplyFace(WEIGHTS const &weights, REAL const *const *parents, int width,
                  REAL *const *rows) {
    forEachVector(width, [&](int begin) {
    // Clang warns where it cannot make vectors of the loop, which is short.
#if defined(_OPENMP) && !defined(__clang__)
#pragma omp simd
#endif
        for (int k = begin; k < begin + kVector; ++k) {
            double values[SIZE];
            for (int j = 0; j < SIZE; ++j) {
                values[j] = double(parents[j][k]);
            }
            for (int i = 0; i < SIZE; ++i) {
                double sum = weights(i, 0) * values[i];
                for (int j = 1; j < SIZE; ++j) {
                    sum += weights(i, j) * values[(i + j) % SIZE];
                }
                rows[i][k] = REAL(sum);
            }
        }
    });
}

} // namespace

template <typename REAL>
StencilPlaces<REAL> SpareStencils<REAL>::Place(std::vector<Support> const &supports) {
    offsets.Resize(supports.size());
    Index numWeights = 0;
    for (std::size_t row = 0; row < supports.size(); ++row) {
        offsets[row] = ~numWeights;
        numWeights += supports[row].size();
    }
    weights.Resize(std::size_t(numWeights));
    return {offsets.data(), nullptr, nullptr, nullptr, weights.data()};
}

template <typename REAL>
void StencilMultiplier<REAL>::Fill(Index numSources) const {
    auto const makeScratch = [numSources] { return Scratch(numSources); };
    constexpr Index kRange = RowSupports::kRange;
    ParallelForRange(
        _rows.GetNumFaces(), makeScratch,
        [this](Scratch &scratch, Index begin, Index end) {
            for (Index face = begin; face < end; ++face) {
                fillFace(face, scratch);
            }
        },
        kRange);
    // V-vertices average F-vertices.
    ParallelForRange(
        _rows.GetNumVVertices(), makeScratch,
        [this](Scratch &scratch, Index begin, Index end) {
            for (Index vVertex = begin; vVertex < end; ++vVertex) {
                if (vVertex + kAhead < end) {
                    prefetchFaceRows(vVertex + kAhead);
                }
                fillVVertex(vVertex, scratch);
            }
        },
        kRange);
}

// Benchmark table/quad/large/warm: 1.2 times as fast with it.
template <typename REAL>
void StencilMultiplier<REAL>::prefetchFaceRows(Index vVertex) const {
    constexpr std::size_t kBytes = 96; // of most rows and their sources
    _rows.ForEachVertexFace(_rows.GetVVertexParent(vVertex), [this](Index face, Index row) {
        Prefetch(_stencils.GetWeights(row), kBytes);
        Prefetch(_supports.OfFaces()[face].begin(), kBytes);
    });
}

template <typename REAL>
void StencilMultiplier<REAL>::storeIndices(Index row, Support sources) const {
    Index const offset = _stencils.offsets[row];
    if (offset < 0) {
        return;
    }
    if (!_stencils.indexOfSource) {
        copyShort(sources.begin(), sources.size(), _stencils.indices + offset);
        return;
    }
    std::transform(sources.begin(), sources.end(), _stencils.indices + offset,
                   [this](Index source) { return _stencils.indexOfSource[source]; });
}

// The vertices are sources themselves: the mask is the stencil.
template <typename REAL>
void StencilMultiplier<REAL>::fillSourceFace(Index face, Scratch &scratch) const {
    Index const *const verts = _rows.GetFaceVertices(face);
    FaceRule const rule = _rows.GetFaceRule(face);
    int const size = rule.GetSize();
    int const width = _supports.OfFaces()[face].size();
    for (int i = 0; i < size; ++i) {
        double const *const row = rule.GetRow(i);
        scratch.sums.assign(width, 0.0);
        for (int j = 0; j < size; ++j) {
            scratch.sums[scratch.position[_pSupports.OfVertices()[verts[j]][0]]] += row[j];
        }
        std::transform(scratch.sums.begin(), scratch.sums.end(), scratch.rows[i],
                       [](double weight) { return REAL(weight); });
    }
}

// Finds the stencils of a face's vertices over its support, or makes them.
template <typename REAL>
void StencilMultiplier<REAL>::loadParents(Index face, Scratch &scratch) const {
    Index const *const verts = _rows.GetFaceVertices(face);
    int const size = _rows.GetFaceSize(face);
    Support const support = _supports.OfFaces()[face];
    int const width = support.size();
    scratch.parents.resize(size);
    scratch.block.Resize(std::size_t(size) * width);
    REAL *dense = scratch.block.data();
    for (int j = 0; j < size; ++j, dense += width) {
        Support const pSupport = _pSupports.OfVertices()[verts[j]];
        REAL const *const weights = _pStencils->GetWeights(verts[j]);
        if (pSupport == support) {
            scratch.parents[j] = weights;
            continue;
        }
        std::fill_n(dense, width, REAL(0));
        scratch.position.ForEach(
            pSupport.begin(), pSupport.size(),
            [dense, weights](int position, int k) { dense[position] = weights[k]; });
        scratch.parents[j] = dense;
    }
}

// The face mask times the stencils of the face's vertices.
template <typename REAL>
void StencilMultiplier<REAL>::multiply(Index face, Scratch &scratch) const {
    FaceRule const rule = _rows.GetFaceRule(face);
    int const size = rule.GetSize();
    int const width = _supports.OfFaces()[face].size();
    REAL const *const *const parents = scratch.parents.data();
    REAL *const *const rows = scratch.rows.data();
    if (width >= kVector && rule.IsCirculant()) {
        switch (size) {
        case 3:
            return multiplyFace<3>(CirculantWeights<3>(rule), parents, width, rows);
        case 4:
            return multiplyFace<4>(CirculantWeights<4>(rule), parents, width, rows);
        case 5:
            return multiplyFace<5>(CirculantWeights<5>(rule), parents, width, rows);
        case kHexagon:
            return multiplyFace<kHexagon>(CirculantWeights<kHexagon>(rule), parents, width, rows);
        }
    }
    if (width >= kVector && size == kHexagon) {
        return multiplyFace<kHexagon>(DenseWeights<kHexagon>(rule), parents, width, rows);
    }
    scratch.sums.resize(width);
    double *const sums = scratch.sums.data();
    for (int i = 0; i < size; ++i) {
        double const *const row = rule.GetRow(i);
        std::transform(parents[0], parents[0] + width, sums,
                       [weight = row[0]](REAL value) { return weight * double(value); });
        for (int j = 1; j < size; ++j) {
            for (int k = 0; k < width; ++k) {
                sums[k] += row[j] * double(parents[j][k]);
            }
        }
        std::transform(sums, sums + width, rows[i], [](double weight) { return REAL(weight); });
    }
}

// The stencils of a face's F-vertices are the face mask times the stencils of its vertices.
template <typename REAL>
void StencilMultiplier<REAL>::fillFace(Index face, Scratch &scratch) const {
    Support const support = _supports.OfFaces()[face];
    Index const firstRow = _rows.GetFaceFirstRow(face);
    int const size = _rows.GetFaceSize(face);
    scratch.rows.resize(size);
    for (int i = 0; i < size; ++i) {
        scratch.rows[i] = _stencils.GetWeights(firstRow + i);
        storeIndices(firstRow + i, support);
    }
    scratch.position.Begin();
    scratch.position.ForEach(support.begin(), support.size(),
                             [](int &position, int k) { position = k; });
    if (_pStencils) {
        loadParents(face, scratch);
        multiply(face, scratch);
    } else {
        fillSourceFace(face, scratch);
    }
}

// The stencil of a V-vertex is a sum of those of the parent's vertices and of F-vertices.
template <typename REAL>
void StencilMultiplier<REAL>::fillVVertex(Index vVertex, Scratch &scratch) const {
    PagedArray<double> &sumOfSource = scratch.sumOfSource;
    sumOfSource.Begin();
    Index const pVert = _rows.GetVVertexParent(vVertex);
    VertexRule const rule = _rows.GetVertexRule(pVert);
    auto const add = [&](double weight, REAL const *weights, Support sources) {
        sumOfSource.ForEach(sources.begin(), sources.size(),
                            [=](double &sum, int k) { sum += weight * double(weights[k]); });
    };
    _rows.ForEachSource(vVertex, rule, [&](Index source, double weight) {
        add(weight, parentWeights(source), _pSupports.OfVertices()[source]);
    });
    _rows.ForEachFaceSource(pVert, rule, [&](Index face, Index row, double weight) {
        add(weight, _stencils.GetWeights(row), _supports.OfFaces()[face]);
    });
    Support const support = _supports.OfVVertex(vVertex, scratch.sources);
    REAL *const weights = _stencils.GetWeights(vVertex);
    sumOfSource.ForEach(support.begin(), support.size(), [weights](double &sum, int k) {
        weights[k] = REAL(sum);
        sum = 0;
    });
    storeIndices(vVertex, support);
}

template struct SpareStencils<float>;
template struct SpareStencils<double>;
template class StencilMultiplier<float>;
template class StencilMultiplier<double>;

} // namespace OpenSubdivHex::FarExt::internal
