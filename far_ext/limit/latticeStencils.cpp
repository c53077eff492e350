// SPDX-License-Identifier: Apache-2.0
#include "latticeStencils.h"

#include <algorithm>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;

template <typename REAL>
LatticeStencils<REAL>::LatticeStencils(LatticeFaces const &faces, bool hasDerivatives)
    : _faces(faces), _hasDerivatives(hasDerivatives) {
    for (LatticeFaces::Set const &set : faces.GetSets()) {
        OfSet &of = _sets.emplace_back(OfSet{&set, {}, {}, {}});
        for (LatticeFaces::Orbit const &orbit : set.orbits) {
            LatticeFaces::ForEachRow(set.patch, orbit, [&](std::vector<LimitWeights> const &row) {
                addOutput(row, of);
            });
        }
    }
}

template <typename REAL>
void LatticeStencils<REAL>::addOutput(std::vector<LimitWeights> const &weights, OfSet &of) const {
    Weights &result = of.weights.emplace_back();
    Places places;
    for (std::size_t place = 0; place < weights.size(); ++place) {
        auto const [weight, du, dv] = weights[place];
        places[place] = isUsed(weight, du, dv);
        result.points[place] = REAL(weight);
        result.du[place] = REAL(du);
        result.dv[place] = REAL(dv);
    }
    std::vector<Places> &all = of.placesOfSupports;
    auto const found = std::find(all.begin(), all.end(), places);
    of.supports.push_back(int(found - all.begin()));
    if (found == all.end()) {
        all.push_back(places);
    }
}

template <typename REAL>
void LatticeStencils<REAL>::CountSizes(int *sizes) const {
    for (OfSet const &of : _sets) {
        std::vector<int> sizesOfOutputs;
        for (int const support : of.supports) {
            sizesOfOutputs.push_back(int(of.placesOfSupports[std::size_t(support)].count()));
        }
        ParallelForRange(
            Index(of.set->faces.size()), [] { return Nothing(); },
            [&](Nothing, Index begin, Index end) {
                for (Index face = begin; face < end; ++face) {
                    forEachOutput(*of.set, face, [&](Index vert, int output) {
                        sizes[vert] = sizesOfOutputs[std::size_t(output)];
                    });
                }
            },
            kRange);
    }
    for (Index const vert : _faces.GetVertices()) {
        Index sources[kMaxPlaces];
        sizes[vert] = countVertexSize(_faces.GetRow(vert, sources));
    }
}

template <typename REAL>
void LatticeStencils<REAL>::sort(OfSet const &of, Index face, SortedFace &sorted) {
    int const numPlaces = of.set->patch.GetNumPlaces();
    Index const *const sources =
        of.set->sources.data() + std::size_t(face) * std::size_t(numPlaces);
    // All are different; some loops of fixed length take less time than std::sort.
    int order[kMaxPlaces];
    for (int place = 0; place < numPlaces; ++place) {
        int rank = 0;
        for (int other = 0; other < numPlaces; ++other) {
            rank += sources[other] < sources[place];
        }
        order[rank] = place;
    }
    sorted.ofSupports.resize(of.placesOfSupports.size());
    for (std::size_t i = 0; i < of.placesOfSupports.size(); ++i) {
        Places const &places = of.placesOfSupports[i];
        auto &entries = sorted.ofSupports[i];
        entries.size = 0;
        for (int k = 0; k < numPlaces; ++k) {
            entries.places[entries.size] = order[k];
            entries.verts[entries.size] = sources[order[k]];
            entries.size += places[std::size_t(order[k])];
        }
    }
}

template <typename REAL>
void LatticeStencils<REAL>::write(OfSet const &of, int output, SortedFace const &sorted,
                                  LimitStencilPlace<REAL> const &place) const {
    Weights const &weights = of.weights[std::size_t(output)];
    auto const &entries = sorted.ofSupports[std::size_t(of.supports[std::size_t(output)])];
    std::copy_n(entries.verts, entries.size, place.indices);
    for (int k = 0; k < entries.size; ++k) {
        place.weights[k] = weights.points[entries.places[k]];
    }
    for (int k = 0; k < entries.size && _hasDerivatives; ++k) {
        place.duWeights[k] = weights.du[entries.places[k]];
        place.dvWeights[k] = weights.dv[entries.places[k]];
    }
}

template <typename REAL>
int LatticeStencils<REAL>::countVertexSize(LimitRow const &row) const {
    int size = 0;
    for (int i = 0; i < row.size; ++i) {
        size += isUsed(row.weights[i], row.du[i], row.dv[i]);
    }
    return size;
}

template <typename REAL>
void LatticeStencils<REAL>::writeVertex(Index vert, LimitStencilPlace<REAL> const &place) const {
    Index sources[kMaxPlaces];
    LimitRow const row = _faces.GetRow(vert, sources);
    int order[kMaxPlaces];
    int size = 0;
    for (int i = 0; i < row.size; ++i) {
        order[size] = i;
        size += isUsed(row.weights[i], row.du[i], row.dv[i]);
    }
    std::sort(order, order + size, [&](int a, int b) { return sources[a] < sources[b]; });
    for (int k = 0; k < size; ++k) {
        int const i = order[k];
        place.indices[k] = row.sources[i];
        place.weights[k] = REAL(row.weights[i]);
        if (_hasDerivatives) {
            place.duWeights[k] = REAL(row.du[i]);
            place.dvWeights[k] = REAL(row.dv[i]);
        }
    }
}

template class LatticeStencils<float>;
template class LatticeStencils<double>;

} // namespace OpenSubdivHex::FarExt::internal
