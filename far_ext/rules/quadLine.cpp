// SPDX-License-Identifier: Apache-2.0
#include "quadLine.h"

#include "quadPath.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kNumLinePaths = kQuadPathBase * kQuadPathBase; // of levels with masks beside lines
// Kinds of flags beside lines; 0 is of no line.  At a line there are as many as quads there, away from one four.
constexpr int countKindsAt(int maxQuads) {
    int result = 1;
    for (int numQuads = LineFlag::kMinQuads; numQuads <= maxQuads; ++numQuads) {
        result += numQuads;
    }
    return result;
}
constexpr int kNumAt = countKindsAt(LineFlag::kMaxQuads);
constexpr int kNumKindsAway = LineFlag::kNumKinds - LineFlag::kDown;
constexpr int kNumAway = 1 + (LineFlag::kMaxQuads - LineFlag::kMinQuads + 1) * kNumKindsAway;

// One more than these are flags.
struct LinePath {
    int lines[2]; // kinds by LineRole
    int digits;

    int GetLine(LineRole role) const { return lines[int(role)]; }
};

int getLine(LineFlag flag) {
    if (flag.GetRole() == LineRole::Away) {
        return 1 + (flag.numQuads - LineFlag::kMinQuads) * kNumKindsAway + flag.kind -
               LineFlag::kDown;
    }
    return countKindsAt(flag.numQuads - 1) + flag.kind;
}

QuadLineFlag makeLineFlag(LinePath const &path) {
    int const lines = path.GetLine(LineRole::Away) * kNumAt + path.GetLine(LineRole::At);
    return QuadLineFlag(1 + kNumLinePaths * lines + path.digits);
}
static_assert(1 + kNumLinePaths * kNumAway * kNumAt <= 1 << 16);

LinePath getLinePath(QuadLineFlag flag) {
    int const lines = (flag - 1) / kNumLinePaths;
    return {{lines / kNumAt, lines % kNumAt}, (flag - 1) % kNumLinePaths};
}

namespace quadLineTable {

struct Row {
    int numQuads;
    char flag;
    char const *path;
    int ofVertex;
    int parts[kHexagon];
};
constexpr int kNone = MaskTable::kNone;
constexpr Row kRows[] = {
#include "quadLineRows.inl"
};

} // namespace quadLineTable

std::size_t getPlaceBesideLine(int numSteps, LineRole role, int line, int digits) {
    int const ofRole = role == LineRole::Away ? line : kNumAway + line;
    int const number = (numSteps * (kNumAway + kNumAt) + ofRole) * kNumLinePaths + digits;
    return std::size_t(number);
}

MaskTable const &getRowsBesideLines() {
    static MaskTable const kRows = [] {
        constexpr char kFlags[] = "abcdvtVT"; // as LineFlag::Kind has them
        MaskTable rows(getPlaceBesideLine(kNumLineSteps, LineRole::Away, 0, 0));
        for (quadLineTable::Row const &row : quadLineTable::kRows) {
            LineFlag const flag = {row.numQuads,
                                   LineFlag::Kind(std::strchr(kFlags, row.flag) - kFlags)};
            rows.Add(getPlaceBesideLine(int(std::strlen(row.path)), flag.GetRole(), getLine(flag),
                                        ReadQuadPath(row.path)),
                     row.ofVertex, row.parts);
        }
        return rows;
    }();
    return kRows;
}

QuadLineFlag appendToLineFlag(QuadLineFlag flag, int numSteps, int digit) {
    if (flag == 0 || numSteps + 1 >= kNumLineSteps) {
        return 0;
    }
    LinePath path = getLinePath(flag);
    path.digits = path.digits * kQuadPathBase + digit;
    return makeLineFlag(path);
}

// Infinite sharpness stays.
LineSharpness sharpnessAfterStep(LineSharpness sharpness) {
    auto const afterStep = [](float of) {
        return OpenSubdiv::Sdc::Crease::IsInfinite(of) ? of : std::max(0.0f, of - 1);
    };
    return {afterStep(sharpness.line), afterStep(sharpness.cross)};
}

} // namespace

QuadLineFlag AddLineFlag(QuadLineFlag flag, LineFlag ofLine) {
    LinePath path = flag == 0 ? LinePath{{0, 0}, 0} : getLinePath(flag);
    path.lines[int(ofLine.GetRole())] = getLine(ofLine);
    return makeLineFlag(path);
}

QuadLineFlags AppendToQuadLineFlags(QuadLineFlags const &flags, int numSteps, int outDigit,
                                    int inDigit) {
    QuadLineFlags result = {appendToLineFlag(flags.out, numSteps, outDigit),
                            appendToLineFlag(flags.in, numSteps, inDigit),
                            {},
                            {}};
    if (result.HasAny()) {
        for (LineRole const role : kLineRoles) {
            result.outLines[int(role)] = sharpnessAfterStep(flags.outLines[int(role)]);
            result.inLines[int(role)] = sharpnessAfterStep(flags.inLines[int(role)]);
        }
    }
    return result;
}

QuadLineRow FindQuadLineRow(int numSteps, QuadLineFlags const &flags, LineRole role) {
    constexpr QuadLineRow kNoRow = {kNoMaskRow, false, 0};
    float const share =
        std::min(flags.outLines[int(role)].GetShare(), flags.inLines[int(role)].GetShare());
    if (flags.out == 0 || flags.in == 0 || numSteps >= kNumLineSteps || share == 0) {
        return kNoRow;
    }
    LinePath const paths[2] = {getLinePath(flags.out), getLinePath(flags.in)};
    std::pair<int, int> const out = {paths[0].GetLine(role), paths[0].digits};
    std::pair<int, int> const in = {paths[1].GetLine(role), paths[1].digits};
    if (out.first == 0 || in.first == 0) {
        return kNoRow;
    }
    bool const isBackwards = in < out;
    auto const [line, digits] = isBackwards ? in : out;
    MaskTable const &rows = getRowsBesideLines();
    std::size_t place = getPlaceBesideLine(numSteps, role, line, digits);
    if (role == LineRole::Away && !rows.Has(place)) {
        // Beside other vertices flags at the edge of the line have the rows of two quads.
        int const kind = (line - 1) % kNumKindsAway;
        bool const isBehind = kind >= LineFlag::kDownBehind - LineFlag::kDown;
        place = isBehind ? place : getPlaceBesideLine(numSteps, role, 1 + kind, digits);
    }
    if (!rows.Has(place)) {
        return kNoRow;
    }
    // The E-face of an edge of the line, and what F-faces are made of it.
    bool isAlong = false;
    for (int numQuads = LineFlag::kMinQuads; numQuads <= LineFlag::kMaxQuads; ++numQuads) {
        isAlong =
            isAlong || (role == LineRole::At && line == getLine({numQuads, LineFlag::kAtLine}));
    }
    int const behindFirst = numSteps == kNumLineSteps - 1 ? digits % kQuadPathBase : 0;
    bool const isOfHalf = isAlong && digits > 0 && behindFirst == 0;
    return {rows.Find(place, isBackwards), isOfHalf, double(share)};
}

} // namespace OpenSubdivHex::FarExt::internal
