// SPDX-License-Identifier: Apache-2.0
#include "lineRow.h"

#include <cstddef>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kNumLineFaces = 5;
constexpr int kNone = MaskTable::kNone;

struct TruncatedRow {
    int numSteps;
    LineFace face;
    int place; // of those on the right of the face
    int ofVertex;
    int parts[kHexagon];
};
constexpr LineFace kOnLine = LineFace::OnLine;
constexpr LineFace kHalf = LineFace::Half;
constexpr LineFace kBehind = LineFace::Behind;
constexpr LineFace kBeyond = LineFace::Beyond;
constexpr TruncatedRow kTruncatedTable[] = {
#include "lineRows.inl"
};

// A face and its mirror image have the same rows.  The place that one on the right is in the image.
int getMirrored(LineFace face, int place) {
    return face == kHalf ? 5 - place : (kHexagon + 1 - place) % kHexagon;
}

std::size_t getPlaceOfLine(int numSteps, LineFace face, int place) {
    int const number = (numSteps * kNumLineFaces + int(face)) * kHexagon + place;
    return std::size_t(number);
}

MaskTable const &getTruncatedRows() {
    static MaskTable const kRows = [] {
        MaskTable rows(getPlaceOfLine(kNumLineSteps, LineFace::OnLine, 0));
        for (TruncatedRow const &row : kTruncatedTable) {
            rows.Add(getPlaceOfLine(row.numSteps, row.face, row.place), row.ofVertex, row.parts);
        }
        return rows;
    }();
    return kRows;
}

} // namespace

MaskRow FindLineRow(int numSteps, LineFace face, int place) {
    MaskTable const &rows = getTruncatedRows();
    std::size_t const atRight = getPlaceOfLine(numSteps, face, place);
    bool const isBackwards = !rows.Has(atRight);
    return rows.Find(isBackwards ? getPlaceOfLine(numSteps, face, getMirrored(face, place))
                                 : atRight,
                     isBackwards);
}

} // namespace OpenSubdivHex::FarExt::internal
