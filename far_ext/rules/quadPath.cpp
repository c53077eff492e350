// SPDX-License-Identifier: Apache-2.0
#include "quadPath.h"

#include "far_ext/rules/mask.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kDigit = 4; // digits
constexpr int kNumPaths = kDigit * kDigit * kDigit;
// Kinds of vertices, by number of faces.
constexpr int kFourFaces = 0;
constexpr int kOtherFaces = 4;
constexpr int kNumVertices = kOtherFaces + 1;
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
constexpr double kParts = 4096;
constexpr TableRow kTable[] = {
#include "quadRows.inl"
};

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
            int digits = 0;
            for (char const *digit = path; *digit != 0; ++digit) {
                digits = digits * kDigit + (*digit - '0');
            }
            int const numSteps = star ? kNumStepsToConstantMasks : int(std::strlen(path));
            int const first =
                star ? (row.path[0] == '3' ? kNumEndings : 0) : kNumPaths * getKind(row.numFaces);
            int const place = first + digits;
            _places[std::size_t(numSteps)][std::size_t(place)] = int(_rows.size());
            Row &made = _rows.emplace_back();
            std::transform(row.parts, row.parts + kHexagon, made.weights,
                           [](int part) { return part / kParts; });
            made.hasMask =
                std::any_of(row.parts, row.parts + kHexagon, [](int part) { return part > 0; });
            made.ofVertex = row.ofVertex / kParts;
            made.position = int(_rows.size()) - 1;
        }
    }

    struct Row {
        double weights[kHexagon];
        bool hasMask;
        double ofVertex;
        int position; // in the table
    };
    // Null where there is none.
    Row const *Find(int numSteps, int place) const {
        int const index = _places[std::size_t(numSteps)][std::size_t(place)];
        return index == kNone ? nullptr : &_rows[std::size_t(index)];
    }

private:
    static constexpr int kNone = -1;

    static constexpr std::size_t kNumPlaces = std::size_t{kNumVertices} * kNumPaths;
    std::array<std::array<int, kNumPlaces>, kNumStepsToConstantMasks + 1> _places;
    std::vector<Row> _rows;
};

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

QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit) {
    return {append(flags.out, numSteps, outDigit), append(flags.in, numSteps, inDigit),
            std::max(0.0f, flags.sharpness - 1)};
}

QuadRow FindQuadRow(int numSteps, QuadFlags flags) {
    static Rows const kRows;
    static constexpr QuadRow kNone = {nullptr, false, -1, -1};
    if (flags.out == 0 || flags.in == 0 || numSteps == 0) {
        return kNone;
    }
    auto const [vertex, pathOut] = getPath(flags.out);
    int const pathIn = getPath(flags.in).digits;
    int const path = std::min(pathOut, pathIn);
    bool const isBackwards = pathIn < pathOut;
    auto const make = [isBackwards](Rows::Row const *row) {
        return row ? QuadRow{row->hasMask ? &row->weights : nullptr, isBackwards, row->ofVertex,
                             row->position}
                   : kNone;
    };
    if (numSteps >= kNumStepsToConstantMasks) {
        bool const isSame = pathOut / kNumEndings == pathIn / kNumEndings;
        return isSame ? make(kRows.Find(kNumStepsToConstantMasks, path)) : kNone;
    }
    // Beside other vertices, and beside their neighbors, the rows of four quads are not for these.
    bool const isBeside =
        path == repeat(3, numSteps) || path == repeat(3, numSteps - 1) * kDigit + 1;
    if (vertex == kOtherFaces && isBeside) {
        return kNone;
    }
    Rows::Row const *const ofVertex = kRows.Find(numSteps, kNumPaths * vertex + path);
    return make(ofVertex ? ofVertex : kRows.Find(numSteps, path));
}

} // namespace OpenSubdivHex::FarExt::internal
