// SPDX-License-Identifier: Apache-2.0
#include "sizeChecker.h"

#include <limits>

namespace OpenSubdivHex::FarExt::internal {

namespace {

constexpr std::int64_t kMaxCount = std::numeric_limits<Far::Index>::max();

struct Count {
    char const *name;
    std::int64_t value;
};

Status tooLarge(int level, Count const &count, std::string const &where) {
    return Status(StatusCode::TooLarge, ComponentType::Level, level,
                  "level " + std::to_string(level) + " would have " + std::to_string(count.value) +
                      " " + count.name + where +
                      ", more than the 2147483647 that 32-bit indices reach");
}

} // namespace

Status SizeChecker::Add(LevelSizes const &sizes) {
    ++_level;
    _total.vertices += sizes.vertices;
    _total.edges += sizes.edges;
    _total.faces += sizes.faces;
    _total.corners += sizes.corners;
    // The edge-vertices are the longest array.
    for (Count const &count : {Count{"vertices", sizes.vertices}, Count{"edges", sizes.edges},
                               Count{"faces", sizes.faces}, Count{"face-vertices", sizes.corners},
                               Count{"edge-vertices", 2 * sizes.edges}}) {
        if (count.value > kMaxCount) {
            return tooLarge(_level, count, _place);
        }
    }
    for (Count const &count :
         {Count{"vertices", _total.vertices}, Count{"edges", _total.edges},
          Count{"faces", _total.faces}, Count{"face-vertices", _total.corners}}) {
        if (count.value > kMaxCount) {
            return tooLarge(_level, count, _place + " together with the levels before");
        }
    }
    return Status();
}

} // namespace OpenSubdivHex::FarExt::internal
