// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_RING_MASKS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_RING_MASKS_H

#include "cellType.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The masks of the first two steps around vertices of the base mesh.
///
/// Few differ from each other, and are kept.  Any number of threads may use them.
class RingMasks {
public:
    /// The points that a mask makes, of VertexRings or, behind these, of InnerRings.
    enum class Of {
        FirstVertex,
        FirstFace,
        FirstNeighbor,
        SecondVertex,
        SecondFVertex,
        SecondFace,
        SecondHexagon
    };
    /// Weights in both precisions.
    struct Weights {
        explicit Weights(std::vector<double> weights)
            : doubles(std::move(weights)), floats(doubles.begin(), doubles.end()) {}
        double const *Get(double /*precision*/) const { return doubles.data(); }
        float const *Get(float /*precision*/) const { return floats.data(); }
        std::size_t GetSize() const { return doubles.size(); }
        std::size_t GetHeapSize() const { return GetHeapSizes(doubles, floats); }

        std::vector<double> doubles;
        std::vector<float> floats;
    };

    RingMasks(CellRules const &rules, MemoryCount &memory) : _rules(rules), _masks(memory) {}

    CellRules const &GetRules() const { return _rules; }
    /// \brief Whether rings have a second step, whose masks depend on how many faces the ends of edges have.  Behind it
    /// cells depend on one vertex of the base mesh at most.
    ///
    /// Else masks depend on no neighbours, and cells are of few types behind the first step.
    bool HaveSecondStep() const {
        return _rules.hexSchemeOptions.faceMask == FarExt::FaceMask::Smooth &&
               _rules.interpolation == FarExt::Interpolation::Vertex;
    }
    /// The MASK that make() made when it was first called with a key, which tells what it depends on.
    template <typename MASK, typename MAKE>
    MASK const &Find(Of of, std::vector<int> const &key, MAKE const &make) {
        return _masks.Get<MASK>(int(of), key.data(), key.data() + key.size(), make);
    }

private:
    CellRules const _rules;
    PatternTable _masks;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
