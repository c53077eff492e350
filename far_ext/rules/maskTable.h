// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_RULES_MASK_TABLE_H
#define OPENSUBDIVHEX_FAR_EXT_RULES_MASK_TABLE_H

#include "far_ext/rules/mask.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The masks of a corner by its place, as a table has them.
struct MaskRow {
    /// As many weights as the corner's face, or half of a face, has vertices, from the corner on forward around the face,
    /// or backward; null where the table has none.
    double const *mask;
    bool isBackwards;
    /// The weight of the corner's F-vertex in V' of its vertex; negative where the table has none.
    double vertexWeight;
    int position; ///< of the row in the table; negative where there is none
};
inline constexpr MaskRow kNoMaskRow = {nullptr, false, -1, -1};

/// \brief Rows of 4096ths, by place: a number that the user of the table gives them.
class MaskTable {
public:
    static constexpr int kNone = -1;

    explicit MaskTable(std::size_t numPlaces) : _places(numPlaces, kNone) {}

    /// Adds a row; \p ofVertex and \p parts are kNone and zeros where it has none.
    void Add(std::size_t place, int ofVertex, int const (&parts)[kHexagon]) {
        constexpr double kParts = 4096;
        _places[place] = int(_rows.size());
        Row &row = _rows.emplace_back();
        std::transform(parts, parts + kHexagon, row.weights,
                       [](int part) { return part / kParts; });
        row.hasMask = std::any_of(parts, parts + kHexagon, [](int part) { return part > 0; });
        row.ofVertex = ofVertex == kNone ? kNone : ofVertex / kParts;
    }
    bool Has(std::size_t place) const { return _places[place] != kNone; }
    MaskRow Find(std::size_t place, bool isBackwards) const {
        int const position = _places[place];
        if (position == kNone) {
            return kNoMaskRow;
        }
        Row const &row = _rows[std::size_t(position)];
        return {row.hasMask ? row.weights : nullptr, isBackwards, row.ofVertex, position};
    }

private:
    struct Row {
        double weights[kHexagon];
        bool hasMask;
        double ofVertex;
    };
    std::vector<int> _places; // positions in _rows
    std::vector<Row> _rows;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
