// SPDX-License-Identifier: Apache-2.0
#include "quadPath.h"

#include "far_ext/rules/mask.h"

#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using OpenSubdiv::Sdc::Crease;

constexpr int kHexagon = 6;
constexpr int kDigit = 4; // digits
constexpr int kNumPaths = kDigit * kDigit * kDigit;
// Of vertices, by number of faces.
constexpr int kFourFaces = 0;
constexpr int kOtherFaces = 4;
constexpr int kNumLineFlags = int(LineFlag::Top); // behind these, of four faces
constexpr int kNumVertices = kOtherFaces + kNumLineFlags + 1;
constexpr int kNumEndings = kDigit * kDigit;

// One more than these are flags: a path, of as many digits as there were steps, and a vertex; or, in the constant
// levels, two digits, of a vertex or of a quad.
struct Path {
    int vertex;
    int digits;
};

int getKind(int numFaces) {
    return numFaces == 4   ? kFourFaces
           : numFaces == 3 ? 1
           : numFaces == 5 ? 2
           : numFaces == 6 ? 3
                           : kOtherFaces;
}

Path getPath(QuadFlag flag) { return {(flag - 1) / kNumPaths, (flag - 1) % kNumPaths}; }

int getVertex(LineFlag flag) { return kOtherFaces + int(flag); }

bool isInFirstRow(QuadFlag flag) { return flag != 0 && getPath(flag).vertex > kOtherFaces; }
// In the first row, at a vertex on the line.
bool isOnLine(QuadFlag flag) {
    return isInFirstRow(flag) && getPath(flag).vertex <= getVertex(LineFlag::Up);
}
// In the first row, at the vertices that are not on the line, which are smooth.
bool isAboveLine(QuadFlag flag) { return isInFirstRow(flag) && !isOnLine(flag); }

// The same path, regardless of a line.
QuadFlag leaveLine(QuadFlag flag) {
    return isInFirstRow(flag) ? QuadFlag(1 + kNumPaths * kFourFaces + getPath(flag).digits) : flag;
}

// The path of one digit alone.
constexpr int repeat(int digit, int count) {
    int result = 0;
    for (int i = 0; i < count; ++i) {
        result = result * kDigit + digit;
    }
    return result;
}

constexpr double kParts = 4096;
constexpr int kNone = -1;

struct TableRow {
    int numFaces;        // of the vertex
    char const *path;    // behind a star the last two digits
    int ofVertex;        // of the corner's F-vertex in V'
    int parts[kHexagon]; // none of quads, which have the mask of all of them
};
constexpr TableRow kTable[] = {
#include "quadRows.inl"
};

struct LineTableRow {
    int size;
    char const *path; // behind the LineFlag
    int ofVertex;
    int ofNeighbor;
    int parts[kHexagon];
};
constexpr LineTableRow kLineTable[] = {
#include "quadLineRows.inl"
};

int getDigits(char const *path) {
    int digits = 0;
    for (; *path != 0; ++path) {
        digits = digits * kDigit + (*path - '0');
    }
    return digits;
}

double getWeight(int part) { return part == kNone ? -1 : part / kParts; }

// The rows of a number of steps, by place.
class Rows {
public:
    Rows() {
        for (auto &places : _places) {
            places.fill(kNone);
        }
        for (TableRow const &row : kTable) {
            char const *const star = std::strchr(row.path, '*');
            char const *const path = star ? star + 1 : row.path;
            int const numSteps = star ? kNumStepsToConstantMasks : int(std::strlen(path));
            int const first =
                star ? (row.path[0] == '3' ? kNumEndings : 0) : kNumPaths * getKind(row.numFaces);
            add(numSteps, first + getDigits(path), kHexagon, row.ofVertex, kNone, row.parts);
        }
        for (LineTableRow const &row : kLineTable) {
            int const first = kNumPaths * getVertex(LineFlag(row.path[0] - '0'));
            char const *const path = row.path + 1;
            add(int(std::strlen(path)), first + getDigits(path), row.size, row.ofVertex,
                row.ofNeighbor, row.parts);
        }
    }

    struct Row {
        double weights[kHexagon];
        bool hasMask;
        int size;
        double ofVertex;
        double ofNeighbor;
        int position; // in the tables
    };
    // Null where there is none.
    Row const *Find(int numSteps, int place) const {
        int const index = _places[std::size_t(numSteps)][std::size_t(place)];
        return index == kNone ? nullptr : &_rows[std::size_t(index)];
    }

private:
    void add(int numSteps, int place, int size, int ofVertex, int ofNeighbor,
             int const (&parts)[kHexagon]) {
        _places[std::size_t(numSteps)][std::size_t(place)] = int(_rows.size());
        Row &made = _rows.emplace_back();
        std::transform(parts, parts + kHexagon, made.weights,
                       [](int part) { return part / kParts; });
        made.hasMask = std::any_of(parts, parts + kHexagon, [](int part) { return part > 0; });
        made.size = size;
        made.ofVertex = getWeight(ofVertex);
        made.ofNeighbor = getWeight(ofNeighbor);
        made.position = int(_rows.size()) - 1;
    }

    static constexpr std::size_t kNumPlaces = std::size_t{kNumVertices} * kNumPaths;
    std::array<std::array<int, kNumPlaces>, kNumStepsToConstantMasks + 1> _places;
    std::vector<Row> _rows;
};

Rows const &getRows() {
    static Rows const kRows;
    return kRows;
}

QuadRow makeRow(Rows::Row const *row, bool isBackwards, float share) {
    return row ? QuadRow{row->hasMask ? &row->weights : nullptr,
                         row->size,
                         isBackwards,
                         row->ofVertex,
                         row->ofNeighbor,
                         share,
                         row->position}
               : QuadRow();
}

QuadFlag append(QuadFlag flag, int numSteps, int digit) {
    if (flag == 0) {
        return 0;
    }
    auto const [vertex, digits] = getPath(flag);
    if (numSteps + 1 < kNumStepsToConstantMasks) {
        return QuadFlag(1 + kNumPaths * vertex + digits * kDigit + digit);
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

} // namespace

QuadFlag MakeQuadFlag(int numFaces) { return QuadFlag(1 + kNumPaths * getKind(numFaces)); }

QuadFlag MakeLineQuadFlag(LineFlag flag) { return QuadFlag(1 + kNumPaths * getVertex(flag)); }

// Beside the first row of a line, at a vertex that is not on it, nothing is sharp.
SharpQuadFlag QuadFlags::GetOut() const {
    return {out, !isInFirstRow(out) && isAboveLine(in) ? 0 : sharpness};
}
SharpQuadFlag QuadFlags::GetIn() const {
    return {in, !isInFirstRow(in) && isAboveLine(out) ? 0 : sharpness};
}

QuadFlags JoinQuadFlags(SharpQuadFlag out, SharpQuadFlag in) {
    return {out.flag, in.flag, std::max(out.sharpness, in.sharpness)};
}

QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit) {
    bool const isInfinite = Crease::IsInfinite(flags.sharpness);
    QuadFlags result = {append(flags.out, numSteps, outDigit), append(flags.in, numSteps, inDigit),
                        isInfinite ? flags.sharpness : std::max(0.0f, flags.sharpness - 1)};
    if (numSteps + 1 != kNumStepsOfLineMasks) {
        return result;
    }
    if (isAboveLine(result.out) || isAboveLine(result.in)) {
        result.sharpness = 0;
    } else if (isInfinite) {
        return {};
    }
    return {leaveLine(result.out), leaveLine(result.in), result.sharpness};
}

QuadRow FindQuadRow(int numSteps, QuadFlags flags) {
    if (flags.out == 0 || flags.in == 0 || numSteps == 0) {
        return {};
    }
    bool const isAbove = isAboveLine(flags.out) || isAboveLine(flags.in);
    float const share = isAbove ? 1 : std::max(0.0f, 1 - flags.sharpness);
    auto const [vertex, pathOut] = getPath(leaveLine(flags.out));
    int const pathIn = getPath(leaveLine(flags.in)).digits;
    int const path = std::min(pathOut, pathIn);
    auto const find = [&, isBackwards = pathIn < pathOut](int steps, int place) {
        return makeRow(getRows().Find(steps, place), isBackwards, share);
    };
    if (numSteps >= kNumStepsToConstantMasks) {
        bool const isSame = pathOut / kNumEndings == pathIn / kNumEndings;
        return isSame ? find(kNumStepsToConstantMasks, path) : QuadRow();
    }
    // Beside other vertices, and beside their neighbors, the rows of four quads are not for these.
    bool const isBeside =
        path == repeat(3, numSteps) || path == repeat(3, numSteps - 1) * kDigit + 1;
    if (vertex == kOtherFaces && isBeside) {
        return {};
    }
    QuadRow const ofVertex = find(numSteps, kNumPaths * vertex + path);
    return ofVertex.position >= 0 ? ofVertex : find(numSteps, path);
}

QuadRow FindLineQuadRow(int numSteps, QuadFlags flags) {
    if (!isInFirstRow(flags.out) || !isInFirstRow(flags.in)) {
        return {};
    }
    QuadFlag const lesser = std::min(flags.out, flags.in);
    auto const [vertex, path] = getPath(lesser);
    return makeRow(getRows().Find(numSteps, kNumPaths * vertex + path), flags.in < flags.out,
                   std::min(1.0f, flags.sharpness));
}

bool IsOnQuadLine(QuadFlags flags) { return isOnLine(flags.out) && isOnLine(flags.in); }

} // namespace OpenSubdivHex::FarExt::internal
