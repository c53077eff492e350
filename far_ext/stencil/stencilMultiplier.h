// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_MULTIPLIER_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_STENCIL_MULTIPLIER_H

#include "stencilSupports.h"

#include "far_ext/vtr/parallel.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

// As many weights as the smallest vector registers hold; loops go by whole ones.
inline constexpr int kVector = 4;

// Calls function(begin) for vectors that together are 0 ... size; the last may overlap the one
// before.  A size of less than a vector is not for it.
template <typename FUNCTION>
void ForEachVector(int size, FUNCTION function) {
    int const last = size - kVector;
    for (int begin = 0; begin < last; begin += kVector) {
        function(begin);
    }
    function(last);
}

// As std::copy_n, faster for some ten elements.
template <typename T>
void CopyShort(T const *src, int size, T *dst) {
    if (size < kVector) {
        std::copy_n(src, size, dst);
        return;
    }
    ForEachVector(size, [=](int begin) { std::copy_n(src + begin, kVector, dst + begin); });
}

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
    void StoreIndices(Index row, Support sources) const {
        Index const offset = offsets[row];
        if (offset < 0) {
            return;
        }
        if (!indexOfSource) {
            CopyShort(sources.begin(), sources.size(), indices + offset);
            return;
        }
        std::transform(sources.begin(), sources.end(), indices + offset,
                       [this](Index source) { return indexOfSource[source]; });
    }

    Index const *offsets;
    REAL *weights;
    Index *indices;
    Index const *indexOfSource; // null: sources are indices
    REAL *spareWeights;
};

// The F-vertices of a plain face: rows of the face's circulant mask times its vertices' rows.
template <int SIZE, typename REAL>
void MultiplyPlain(double const *mask, REAL const *const *parents, int width, REAL *const *rows) {
    double weights[SIZE];
    std::copy_n(mask, SIZE, weights);
    ForEachVector(width, [&](int begin) {
#ifdef _OPENMP
#pragma omp simd
#endif
        for (int k = begin; k < begin + kVector; ++k) {
            double values[SIZE];
            for (int j = 0; j < SIZE; ++j) {
                values[j] = double(parents[j][k]);
            }
            for (int i = 0; i < SIZE; ++i) {
                double sum = weights[0] * values[i];
                for (int j = 1; j < SIZE; ++j) {
                    sum += weights[j] * values[(i + j) % SIZE];
                }
                rows[i][k] = REAL(sum);
            }
        }
    });
}

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
    void Fill(Index numSources) const {
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

private:
    // What one thread works on.  What it writes most is in buffers, which share no cache lines with
    // those of another: benchmark table/hexagon/small/warm with 2 threads is 1.1 times as fast.
    struct Scratch {
        explicit Scratch(Index numSources) : position(numSources), sumOfSource(numSources) {}

        std::vector<int> position;         // of each source in the support of the face
        std::vector<double> sumOfSource;   // all 0 between two V-vertices
        Buffer<Index> sources;             // of a V-vertex, see RowSupports
        std::vector<double> mask;          // of a corner, see RefinementMask
        std::vector<double> sums;          // one dense stencil
        Buffer<REAL> block;                // of dense stencils
        std::vector<REAL const *> parents; // dense stencils of a face's vertices over its support
        std::vector<REAL *> rows;          // those of its F-vertices
    };

    void fillFace(Index face, Scratch &scratch) const;
    void fillSourceFace(Index face, Scratch &scratch) const;
    void loadParents(Index face, Scratch &scratch) const;
    void multiply(Index face, Scratch &scratch) const;
    // Benchmark table/quad/large/warm: 1.2 times as fast with it.
    void prefetchFaceRows(Index vVertex) const {
        constexpr std::size_t kBytes = 96; // of most rows and their sources
        _rows.ForEachVertexFace(_rows.GetVVertexParent(vVertex), [this](Index face, Index row) {
            Prefetch(_stencils.GetWeights(row), kBytes);
            Prefetch(_supports.OfFaces()[face].begin(), kBytes);
        });
    }
    static constexpr Index kAhead = 8;
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

// The vertices are sources themselves: the mask is the stencil.
template <typename REAL>
void StencilMultiplier<REAL>::fillSourceFace(Index face, Scratch &scratch) const {
    Index const *const verts = _rows.GetFaceVertices(face);
    int const size = _rows.GetFaceSize(face);
    int const width = _supports.OfFaces()[face].size();
    for (int i = 0; i < size; ++i) {
        double const *mask = _rows.GetFaceVertexWeights(face, i, scratch.mask);
        scratch.sums.assign(width, 0.0);
        for (int j = 0; j < size; ++j) {
            scratch.sums[scratch.position[_pSupports.OfVertices()[verts[j]][0]]] += mask[j];
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
    int const *const position = scratch.position.data();
    REAL *dense = scratch.block.data();
    for (int j = 0; j < size; ++j, dense += width) {
        Support const pSupport = _pSupports.OfVertices()[verts[j]];
        REAL const *const weights = _pStencils->GetWeights(verts[j]);
        if (pSupport == support) {
            scratch.parents[j] = weights;
            continue;
        }
        std::fill_n(dense, width, REAL(0));
        for (int k = 0; k < pSupport.size(); ++k) {
            dense[position[pSupport[k]]] = weights[k];
        }
        scratch.parents[j] = dense;
    }
}

// The face mask times the stencils of the face's vertices.
template <typename REAL>
void StencilMultiplier<REAL>::multiply(Index face, Scratch &scratch) const {
    int const size = _rows.GetFaceSize(face);
    int const width = _supports.OfFaces()[face].size();
    REAL const *const *const parents = scratch.parents.data();
    REAL *const *const rows = scratch.rows.data();
    if (width >= kVector && _rows.IsFacePlain(face)) {
        double const *const mask = _rows.GetPlainFaceWeights(size);
        switch (size) {
        case 3:
            return MultiplyPlain<3>(mask, parents, width, rows);
        case 4:
            return MultiplyPlain<4>(mask, parents, width, rows);
        case 5:
            return MultiplyPlain<5>(mask, parents, width, rows);
        case 6:
            return MultiplyPlain<6>(mask, parents, width, rows);
        }
    }
    scratch.sums.resize(width);
    double *const sums = scratch.sums.data();
    for (int i = 0; i < size; ++i) {
        double const *mask = _rows.GetFaceVertexWeights(face, i, scratch.mask);
        std::transform(parents[0], parents[0] + width, sums,
                       [weight = mask[0]](REAL value) { return weight * double(value); });
        for (int j = 1; j < size; ++j) {
            for (int k = 0; k < width; ++k) {
                sums[k] += mask[j] * double(parents[j][k]);
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
        _stencils.StoreIndices(firstRow + i, support);
    }
    for (int k = 0; k < support.size(); ++k) {
        scratch.position[support[k]] = k;
    }
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
    double *const sumOfSource = scratch.sumOfSource.data();
    Index const pVert = _rows.GetVVertexParent(vVertex);
    RefinementMask::VertexMask const mask = _rows.GetVertexMask(pVert);
    auto const add = [=](double weight, REAL const *weights, Support sources) {
        for (int k = 0; k < sources.size(); ++k) {
            sumOfSource[sources[k]] += weight * double(weights[k]);
        }
    };
    for (int i = 0; i < mask.numSources; ++i) {
        Index const source = mask.sources[i];
        add(mask.weights[i], parentWeights(source), _pSupports.OfVertices()[source]);
    }
    if (mask.faceWeight > 0) {
        _rows.ForEachVertexFace(pVert, [&](Index face, Index row) {
            add(mask.faceWeight, _stencils.GetWeights(row), _supports.OfFaces()[face]);
        });
    }
    Support const support = _supports.OfVVertex(vVertex, scratch.sources);
    REAL *const weights = _stencils.GetWeights(vVertex);
    for (int k = 0; k < support.size(); ++k) {
        double &sum = sumOfSource[support[k]];
        weights[k] = REAL(sum);
        sum = 0;
    }
    _stencils.StoreIndices(vVertex, support);
}

} // namespace OpenSubdivHex::FarExt::internal

#endif
