// SPDX-License-Identifier: Apache-2.0
#include "lineRow.h"

#include "far_ext/rules/mask.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kNumLineFaces = 5;
constexpr int kNone = -1;

struct LineTableRow {
    int numSteps;
    LineFace face;
    int place; // of those on the right of the face
    int ofVertex;
    int parts[kHexagon];
};
constexpr double kLineParts = 4096;
constexpr LineFace kOnLine = LineFace::OnLine;
constexpr LineFace kHalf = LineFace::Half;
constexpr LineFace kBehind = LineFace::Behind;
constexpr LineFace kBeyond = LineFace::Beyond;
constexpr LineTableRow kLineTable[] = {
#include "lineRows.inl"
};

// A face and its mirror image have the same rows.  The place that one on the right is in the image.
int getMirrored(LineFace face, int place) {
    return face == kHalf ? 5 - place : (kHexagon + 1 - place) % kHexagon;
}

// The rows by number of steps, face and place.
class LineRows {
public:
    LineRows() {
        for (LineTableRow const &row : kLineTable) {
            for (bool const isBackwards : {false, true}) {
                int const place = isBackwards ? getMirrored(row.face, row.place) : row.place;
                Row &made =
                    _rows[std::size_t(row.numSteps)][std::size_t(row.face)][std::size_t(place)];
                std::transform(row.parts, row.parts + kHexagon, made.weights,
                               [](int part) { return part / kLineParts; });
                made.hasMask =
                    std::any_of(row.parts, row.parts + kHexagon, [](int part) { return part > 0; });
                made.isBackwards = isBackwards;
                made.ofVertex = row.ofVertex == kNone ? kNone : row.ofVertex / kLineParts;
            }
        }
    }

    struct Row {
        double weights[kHexagon] = {};
        bool hasMask = false;
        bool isBackwards = false;
        double ofVertex = kNone;
    };
    Row const &Get(int numSteps, LineFace face, int place) const {
        return _rows[std::size_t(numSteps)][std::size_t(face)][std::size_t(place)];
    }

private:
    std::array<std::array<std::array<Row, kHexagon>, kNumLineFaces>, kNumLineSteps> _rows;
};

} // namespace

LineRow FindLineRow(int numSteps, LineFace face, int place) {
    static LineRows const kRows;
    LineRows::Row const &row = kRows.Get(numSteps, face, place);
    return {row.hasMask ? row.weights : nullptr, row.isBackwards, row.ofVertex};
}

} // namespace OpenSubdivHex::FarExt::internal
