// SPDX-License-Identifier: Apache-2.0
//
// The bandwidth of memcpy, bytes read and bytes written, on arrays beyond all caches.
#include "makers.h"
#include "suite.h"

#include "far_ext/executor.h"

#include <cstring>

namespace OpenSubdivHex::Regression {
namespace {

Contestant makeCopy(std::size_t numBytes, int numThreads) {
    struct Arrays {
        std::vector<char> src;
        std::vector<char> dst;
    };
    auto const arrays = std::make_shared<Arrays>();
    arrays->src.assign(numBytes, 1);
    arrays->dst.assign(numBytes, 0);
    Contestant contestant;
    contestant.name = "memcpy";
    contestant.numThreads = numThreads;
    contestant.movedBytes = 2 * double(numBytes);
    contestant.work = [=] {
        FarExt::ParallelFor(numThreads, [&](int part) {
            std::size_t const begin = numBytes / std::size_t(numThreads) * std::size_t(part);
            std::memcpy(arrays->dst.data() + begin, arrays->src.data() + begin,
                        numBytes / std::size_t(numThreads));
        });
    };
    contestant.validate = [=] {
        Require(arrays->dst.back() == 1 && arrays->dst.front() == 1, "not copied");
        return double(numBytes);
    };
    return contestant;
}

} // namespace

void AddCopyBenchmarks(Suite &suite) {
    BenchMesh mesh = suite.GetMeshes().front();
    mesh.name = "array";
    mesh.size = "256 MiB";
    suite.AddContest({"copy", "byte", mesh, Memory::Resident}, [] {
        std::size_t const numBytes = std::size_t(256) << 20;
        return Contest{{makeCopy(numBytes, 1), makeCopy(numBytes, 2)}, {}};
    });
}

} // namespace OpenSubdivHex::Regression
