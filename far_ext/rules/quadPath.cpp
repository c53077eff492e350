// SPDX-License-Identifier: Apache-2.0
#include "quadPath.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr int kNumPaths = kQuadPathBase * kQuadPathBase * kQuadPathBase;
// Kinds of vertices, by number of faces.
constexpr int kFourFaces = 0;
constexpr int kOtherFaces = 4;
constexpr int kNumVertices = kOtherFaces + 1;
constexpr int kNumEndings = kQuadPathBase * kQuadPathBase;
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
        result = result * kQuadPathBase + digit;
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
    int const number = (numSteps * kNumVertices + vertex) * kNumPaths + digits;
    return std::size_t(number);
}

// The rows, those of constant levels by their endings.
MaskTable const &getRows() {
    static MaskTable const kRows = [] {
        MaskTable rows(getPlace(kNumStepsToConstantMasks + 1, 0, 0));
        for (TableRow const &row : kTable) {
            char const *const star = std::strchr(row.path, '*');
            std::size_t const place =
                star ? getPlace(kNumStepsToConstantMasks, 0,
                                (row.path[0] == '3' ? kNumEndings : 0) + ReadQuadPath(star + 1))
                     : getPlace(int(std::strlen(row.path)), getKind(row.numFaces),
                                ReadQuadPath(row.path));
            rows.Add(place, row.ofVertex, row.parts);
        }
        return rows;
    }();
    return kRows;
}

QuadFlag append(QuadFlag flag, int numSteps, int digit) {
    if (flag == 0) {
        return 0;
    }
    auto const [vertex, digits] = getPath(flag);
    if (numSteps + 1 < kNumStepsToConstantMasks) {
        return QuadFlag(1 + kNumPaths * vertex + digits * kQuadPathBase + digit);
    }
    // The first digit of three, or of the ending, has to be what is before it.
    int const ending = digits % kNumEndings;
    bool const isAtVertex = numSteps < kNumStepsToConstantMasks
                                ? digits / kQuadPathBase == repeat(3, 2) && vertex == kFourFaces
                                : digits >= kNumEndings && ending / kQuadPathBase == 3;
    bool const isAtQuad = numSteps < kNumStepsToConstantMasks
                              ? digits / kQuadPathBase == 0
                              : digits < kNumEndings && ending / kQuadPathBase == 0;
    if (!isAtVertex && !isAtQuad) {
        return 0;
    }
    return QuadFlag(1 + (isAtVertex ? kNumEndings : 0) + ending % kQuadPathBase * kQuadPathBase +
                    digit);
}

} // namespace

int ReadQuadPath(char const *path) {
    int number = 0;
    for (char const *digit = path; *digit != 0; ++digit) {
        number = number * kQuadPathBase + (*digit - '0');
    }
    return number;
}

QuadFlag MakeQuadFlag(int numFaces) { return QuadFlag(1 + kNumPaths * getKind(numFaces)); }

QuadFlags AppendToQuadFlags(QuadFlags flags, int numSteps, int outDigit, int inDigit) {
    return {append(flags.out, numSteps, outDigit), append(flags.in, numSteps, inDigit),
            std::max(0.0f, flags.sharpness - 1)};
}

MaskRow FindQuadRow(int numSteps, QuadFlags flags) {
    if (flags.out == 0 || flags.in == 0 || numSteps == 0) {
        return kNoMaskRow;
    }
    auto const [vertex, pathOut] = getPath(flags.out);
    int const pathIn = getPath(flags.in).digits;
    int const path = std::min(pathOut, pathIn);
    bool const isBackwards = pathIn < pathOut;
    MaskTable const &rows = getRows();
    if (numSteps >= kNumStepsToConstantMasks) {
        bool const isSame = pathOut / kNumEndings == pathIn / kNumEndings;
        return isSame ? rows.Find(getPlace(kNumStepsToConstantMasks, 0, path), isBackwards)
                      : kNoMaskRow;
    }
    // Beside other vertices, and beside their neighbors, the rows of four quads are not for these.
    bool const isBeside =
        path == repeat(3, numSteps) || path == repeat(3, numSteps - 1) * kQuadPathBase + 1;
    if (vertex == kOtherFaces && isBeside) {
        return kNoMaskRow;
    }
    std::size_t const ofVertex = getPlace(numSteps, vertex, path);
    return rows.Find(rows.Has(ofVertex) ? ofVertex : getPlace(numSteps, kFourFaces, path),
                     isBackwards);
}

} // namespace OpenSubdivHex::FarExt::internal
