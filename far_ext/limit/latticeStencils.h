// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_STENCILS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_STENCILS_H

#include "latticeFaces.h"

#include "far_ext/vtr/parallel.h"

#include <bitset>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The limit stencils of the vertices that LatticeFaces make.
///
/// Their weights are the same in all faces of a set: what differs is the order of the sources, since
/// stencils are sorted.  Neither the steps between nor their stencils are needed for them.
template <typename REAL>
class LatticeStencils {
public:
    using Index = Far::Index;

    /// \param faces  are referred to, and have their masks
    LatticeStencils(LatticeFaces const &faces, bool hasDerivatives);

    /// Writes the sizes of the stencils that there are to those of a table, by vertex.
    void CountSizes(int *sizes) const;
    /// Writes the stencils, that of a vertex to getPlace(vert), with as many entries as counted.
    template <typename GET_PLACE>
    void Fill(GET_PLACE getPlace) const {
        for (OfSet const &of : _sets) {
            ParallelForRange(
                Index(of.set->faces.size()), [] { return SortedFace(); },
                [&](SortedFace &sorted, Index begin, Index end) {
                    for (Index face = begin; face < end; ++face) {
                        sort(of, face, sorted);
                        forEachOutput(*of.set, face, [&](Index vert, int output) {
                            write(of, output, sorted, getPlace(vert));
                        });
                    }
                },
                kRange);
        }
        for (Index const vert : _faces.GetVertices()) {
            writeVertex(vert, getPlace(vert));
        }
    }

private:
    static constexpr int kMaxPlaces = LatticePatch::kMaxPlaces;
    static constexpr Index kRange = 64; ///< of faces, which take some microseconds each

    /// The places on which an output depends.
    using Places = std::bitset<kMaxPlaces>;
    /// The weights of an output by place.
    struct Weights {
        REAL points[kMaxPlaces];
        REAL du[kMaxPlaces];
        REAL dv[kMaxPlaces];
    };
    struct OfSet {
        LatticeFaces::Set const *set;
        std::vector<Weights> weights; ///< by output
        std::vector<int> supports;    ///< by output, its number among placesOfSupports
        std::vector<Places> placesOfSupports;
    };
    /// A face, of which the places of each support are in the order of their vertices.
    struct SortedFace {
        struct Entries {
            int size;
            int places[kMaxPlaces];
            Index verts[kMaxPlaces];
        };
        std::vector<Entries> ofSupports;
    };

    void addOutput(std::vector<LimitWeights> const &weights, OfSet &of) const;
    bool isUsed(double weight, double du, double dv) const {
        return weight != 0 || (_hasDerivatives && (du != 0 || dv != 0));
    }
    /// Calls function(vert, output) for the vertices that a face makes.
    template <typename FUNCTION>
    static void forEachOutput(LatticeFaces::Set const &set, Index face, FUNCTION function) {
        Index const *const outputs =
            set.outputs.data() + std::size_t(face) * std::size_t(set.numOutputs);
        // In the place of a vertex that another face makes.
        int const inside = set.numOutputs - set.patch.GetFaceSize();
        for (int i = 0; i < set.numOutputs; ++i) {
            if (i == inside || outputs[i] != outputs[inside]) {
                function(outputs[i], i);
            }
        }
    }
    static void sort(OfSet const &of, Index face, SortedFace &sorted);
    void write(OfSet const &of, int output, SortedFace const &sorted,
               LimitStencilPlace<REAL> const &place) const;
    int countVertexSize(LimitRow const &row) const;
    void writeVertex(Index vert, LimitStencilPlace<REAL> const &place) const;

    LatticeFaces const &_faces;
    bool const _hasDerivatives;
    std::vector<OfSet> _sets;
};

extern template class LatticeStencils<float>;
extern template class LatticeStencils<double>;

} // namespace OpenSubdivHex::FarExt::internal

#endif
