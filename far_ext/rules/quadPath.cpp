// SPDX-License-Identifier: Apache-2.0
#include "quadPath.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kDigit = 4; // digits
constexpr int kNumPaths = kDigit * kDigit * kDigit;
// Kinds of vertices, by number of faces.
constexpr int kFourFaces = 0;
constexpr int kOtherFaces = 4;
constexpr int kNoVertex = 5; // of flags beside a line alone
constexpr int kNumVertices = kNoVertex + 1;
constexpr int kNumEndings = kDigit * kDigit;
// Kinds of flags beside lines; 0 is of no line.  At a line there are as many as quads there; away from one four, but for one
// quad, which has none behind.
constexpr int kNumAt = 1 + LineFlag::kMaxQuads * (LineFlag::kMaxQuads + 1) / 2;
constexpr int kNumKindsAway = LineFlag::kNumKinds - LineFlag::kDown;
constexpr int kFirstOfTwoAway = 1 + 2;
constexpr int kNumAway = kFirstOfTwoAway + (LineFlag::kMaxQuads - 1) * kNumKindsAway;

// One more than these are flags: a path, of as many digits as there were steps, a vertex and lines; or, in the constant
// levels, two digits, of a vertex or of a quad.
struct Path {
    int lines[2]; // kinds by LineRole
    int vertex;
    int digits;

    int GetLine(LineRole role) const { return lines[int(role)]; }
};

int getKind(int numFaces) {
    return numFaces == 4   ? kFourFaces
           : numFaces == 3 ? 1
           : numFaces == 5 ? 2
           : numFaces == 6 ? 3
                           : kOtherFaces;
}

int getLine(LineFlag flag) {
    if (flag.GetRole() == LineRole::Away) {
        int const kind = flag.kind - LineFlag::kDown;
        return flag.numQuads == 1 ? 1 + kind
                                  : kFirstOfTwoAway + (flag.numQuads - 2) * kNumKindsAway + kind;
    }
    return 1 + flag.numQuads * (flag.numQuads - 1) / 2 + flag.kind;
}

QuadFlag makeFlag(Path path) {
    int const lines = path.GetLine(LineRole::Away) * kNumAt + path.GetLine(LineRole::At);
    return QuadFlag(1 + kNumPaths * (lines * kNumVertices + path.vertex) + path.digits);
}
static_assert(1 + kNumPaths * kNumAway * kNumAt * kNumVertices <= 1 << 16);

Path getPath(QuadFlag flag) {
    int const kinds = (flag - 1) / kNumPaths;
    int const lines = kinds / kNumVertices;
    return {{lines / kNumAt, lines % kNumAt}, kinds % kNumVertices, (flag - 1) % kNumPaths};
}

int readDigits(char const *path) {
    int digits = 0;
    for (char const *digit = path; *digit != 0; ++digit) {
        digits = digits * kDigit + (*digit - '0');
    }
    return digits;
}

// The path of one digit alone.
constexpr int repeat(int digit, int count) {
    int result = 0;
    for (int i = 0; i < count; ++i) {
        result = result * kDigit + digit;
    }
    return result;
}

struct TableRow {
    int numFaces;        // of the vertex
    char const *path;    // behind a star the last two digits
    int ofVertex;        // of the corner's F-vertex in V'
    int parts[kHexagon]; // none of quads, which have the mask of all of them
};
constexpr TableRow kTable[] = {
#include "quadRows.inl"
};

std::size_t getPlace(int numSteps, int vertex, int digits) {
    return std::size_t((numSteps * kNumVertices + vertex) * kNumPaths + digits);
}

// The rows, those of constant levels by their endings.
MaskTable const &getRows() {
    static MaskTable const kRows = [] {
        MaskTable rows(getPlace(kNumStepsToConstantMasks + 1, 0, 0));
        for (TableRow const &row : kTable) {
            char const *const star = std::strchr(row.path, '*');
            std::size_t const place =
                star ? getPlace(kNumStepsToConstantMasks, 0,
                                (row.path[0] == '3' ? kNumEndings : 0) + readDigits(star + 1))
                     : getPlace(int(std::strlen(row.path)), getKind(row.numFaces),
                                readDigits(row.path));
            rows.Add(place, row.ofVertex, row.parts);
        }
        return rows;
    }();
    return kRows;
}

struct LineTableRow {
    int numQuads;
    char flag;
    char const *path;
    int ofVertex;
    int parts[kHexagon];
};
constexpr int kNone = MaskTable::kNone;
constexpr LineTableRow kLineTable[] = {
#include "quadLineRows.inl"
};

std::size_t getPlaceBesideLine(int numSteps, LineRole role, int line, int digits) {
    int const ofRole = role == LineRole::Away ? line : kNumAway + line;
    return std::size_t((numSteps * (kNumAway + kNumAt) + ofRole) * kNumPaths + digits);
}

MaskTable const &getRowsBesideLines() {
    static MaskTable const kRows = [] {
        constexpr char kFlags[] = "abcdvtVT"; // as LineFlag::Kind has them
        MaskTable rows(getPlaceBesideLine(kNumLineSteps, LineRole::Away, 0, 0));
        for (LineTableRow const &row : kLineTable) {
            LineFlag const flag = {row.numQuads,
                                   LineFlag::Kind(std::strchr(kFlags, row.flag) - kFlags)};
            rows.Add(getPlaceBesideLine(int(std::strlen(row.path)), flag.GetRole(), getLine(flag),
                                        readDigits(row.path)),
                     row.ofVertex, row.parts);
        }
        return rows;
    }();
    return kRows;
}

QuadFlag append(QuadFlag flag, int numSteps, int digit) {
    if (flag == 0) {
        return 0;
    }
    Path path = getPath(flag);
    if (numSteps + 1 >= kNumLineSteps) {
        path.lines[0] = path.lines[1] = 0;
        if (path.vertex == kNoVertex) {
            return 0;
        }
    }
    int const vertex = path.vertex;
    int const digits = path.digits;
    if (numSteps + 1 < kNumStepsToConstantMasks) {
        path.digits = digits * kDigit + digit;
        return makeFlag(path);
    }
    // The first digit of three, or of the ending, has to be what is before it.
    int const ending = digits % kNumEndings;
    bool const isAtVertex = numSteps < kNumStepsToConstantMasks
                                ? digits / kDigit == repeat(3, 2) && vertex == kFourFaces
                                : digits >= kNumEndings && ending / kDigit == 3;
    bool const isAtQuad = numSteps < kNumStepsToConstantMasks
                              ? digits / kDigit == 0
                              : digits < kNumEndings && ending / kDigit == 0;
    if (!isAtVertex && !isAtQuad) {
        return 0;
    }
    return QuadFlag(1 + (isAtVertex ? kNumEndings : 0) + ending % kDigit * kDigit + digit);
}

// Infinite sharpness stays.
LineSharpness sharpnessAfterStep(LineSharpness sharpness) {
    auto const afterStep = [](float of) {
        return OpenSubdiv::Sdc::Crease::IsInfinite(of) ? of : std::max(0.0f, of - 1);
    };
    return {afterStep(sharpness.line), afterStep(sharpness.cross)};
}

} // namespace

QuadFlag MakeQuadFlag(int numFaces) { return makeFlag({{0, 0}, getKind(numFaces), 0}); }

QuadFlag AddLineFlag(QuadFlag flag, LineFlag ofLine) {
    Path path = flag == 0 ? Path{{0, 0}, kNoVertex, 0} : getPath(flag);
    path.lines[int(ofLine.GetRole())] = getLine(ofLine);
    return makeFlag(path);
}

bool QuadFlags::HasLine() const {
    auto const isBesideLine = [](QuadFlag flag) { return flag > kNumPaths * kNumVertices; };
    return isBesideLine(out) || isBesideLine(in);
}

QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit) {
    QuadFlags result = {append(flags.out, numSteps, outDigit),
                        append(flags.in, numSteps, inDigit),
                        std::max(0.0f, flags.sharpness - 1),
                        {},
                        {}};
    if (result.HasLine()) {
        for (LineRole const role : kLineRoles) {
            result.outLines[int(role)] = sharpnessAfterStep(flags.outLines[int(role)]);
            result.inLines[int(role)] = sharpnessAfterStep(flags.inLines[int(role)]);
        }
    }
    return result;
}

MaskRow FindQuadRow(int numSteps, QuadFlags flags) {
    if (flags.out == 0 || flags.in == 0 || numSteps == 0) {
        return kNoMaskRow;
    }
    Path const out = getPath(flags.out);
    Path const in = getPath(flags.in);
    int const vertex = out.vertex;
    if (vertex == kNoVertex || in.vertex == kNoVertex) {
        return kNoMaskRow;
    }
    int const path = std::min(out.digits, in.digits);
    bool const isBackwards = in.digits < out.digits;
    MaskTable const &rows = getRows();
    if (numSteps >= kNumStepsToConstantMasks) {
        bool const isSame = out.digits / kNumEndings == in.digits / kNumEndings;
        return isSame ? rows.Find(getPlace(kNumStepsToConstantMasks, 0, path), isBackwards)
                      : kNoMaskRow;
    }
    // Beside other vertices, and beside their neighbors, the rows of four quads are not for these.
    bool const isBeside =
        path == repeat(3, numSteps) || path == repeat(3, numSteps - 1) * kDigit + 1;
    if (vertex == kOtherFaces && isBeside) {
        return kNoMaskRow;
    }
    std::size_t const ofVertex = getPlace(numSteps, vertex, path);
    return rows.Find(rows.Has(ofVertex) ? ofVertex : getPlace(numSteps, kFourFaces, path),
                     isBackwards);
}

QuadLineRow FindQuadLineRow(int numSteps, QuadFlags flags, LineRole role) {
    constexpr QuadLineRow kNoRow = {kNoMaskRow, false, 0};
    float const share =
        std::min(flags.outLines[int(role)].GetShare(), flags.inLines[int(role)].GetShare());
    if (flags.out == 0 || flags.in == 0 || numSteps >= kNumLineSteps || share == 0) {
        return kNoRow;
    }
    Path const paths[2] = {getPath(flags.out), getPath(flags.in)};
    std::pair<int, int> const out = {paths[0].GetLine(role), paths[0].digits};
    std::pair<int, int> const in = {paths[1].GetLine(role), paths[1].digits};
    if (out.first == 0 || in.first == 0) {
        return kNoRow;
    }
    bool const isBackwards = in < out;
    auto const [line, digits] = isBackwards ? in : out;
    MaskTable const &rows = getRowsBesideLines();
    // Away from one quad flags are at a regular line, too.
    bool const isBesideOne = role == LineRole::Away && line < kFirstOfTwoAway;
    std::size_t place = getPlaceBesideLine(numSteps, role, line, digits);
    if (role == LineRole::Away && !rows.Has(place)) {
        int const kind = (line - 1) % 2;
        bool const isBehind = !isBesideOne && (line - kFirstOfTwoAway) % kNumKindsAway > 1;
        if (isBesideOne) {
            LineFlag const atLine = {2, LineFlag::Kind(LineFlag::kAtLine + kind)};
            place = getPlaceBesideLine(numSteps, LineRole::At, getLine(atLine), digits);
        } else if (!isBehind) {
            place = getPlaceBesideLine(numSteps, role, kFirstOfTwoAway + kind, digits);
        }
    }
    if (!rows.Has(place)) {
        return kNoRow;
    }
    // The E-face of an edge of the line, and what F-faces are made of it.
    bool isAlong = isBesideOne && line == getLine({1, LineFlag::kDown});
    for (int numQuads = 1; numQuads <= LineFlag::kMaxQuads && role == LineRole::At; ++numQuads) {
        isAlong = isAlong || line == getLine({numQuads, LineFlag::kAtLine});
    }
    int const behindFirst = numSteps == kNumLineSteps - 1 ? digits % kDigit : 0;
    bool const isOfHalf = isAlong && digits > 0 && behindFirst == 0;
    return {rows.Find(place, isBackwards), isOfHalf, double(share)};
}

} // namespace OpenSubdivHex::FarExt::internal
