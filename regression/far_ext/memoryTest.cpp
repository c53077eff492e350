// SPDX-License-Identifier: Apache-2.0
//
// The state of a refiner whose memory does not suffice.
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"
#include "regression/shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <new>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>

namespace OpenSubdivHex::Regression::memoryTest {

using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// Lets the process have some more memory than it has, for as long as it lives.
class MemoryLimit {
public:
    explicit MemoryLimit(rlim_t numMoreBytes) {
        getrlimit(RLIMIT_AS, &_old);
        rlimit limit = _old;
        limit.rlim_cur = std::min(limit.rlim_cur, GetAddressSpace() + numMoreBytes);
        setrlimit(RLIMIT_AS, &limit);
    }
    ~MemoryLimit() { setrlimit(RLIMIT_AS, &_old); }
    MemoryLimit(MemoryLimit const &) = delete;
    MemoryLimit &operator=(MemoryLimit const &) = delete;

    /// In bytes.
    static rlim_t GetAddressSpace() {
        rlim_t numPages = 0;
        std::ifstream("/proc/self/statm") >> numPages;
        return numPages * rlim_t(sysconf(_SC_PAGESIZE));
    }

private:
    rlimit _old{};
};

bool hasEqualFaces(TopologyLevel const &a, TopologyLevel const &b) {
    bool isEqual = a.GetNumFaces() == b.GetNumFaces();
    for (int face = 0; isEqual && face < a.GetNumFaces(); ++face) {
        auto const ofA = a.GetFaceVertices(face);
        auto const ofB = b.GetFaceVertices(face);
        isEqual = std::equal(ofA.begin(), ofA.end(), ofB.begin(), ofB.end());
    }
    return isEqual;
}

} // namespace

TEST(Memory, BaseIsLeftWhenItDoesNotSuffice) {
    if (MemoryLimit::GetAddressSpace() > rlim_t(1) << 40) {
        GTEST_SKIP() << "a sanitizer has taken the address space";
    }
    Shape const shape = GetShape("cube");
    auto const create = [&] {
        return FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get());
    };
    constexpr int kSmallLevel = 6;
    constexpr int kLargeLevel = 11; // more than 600 MB
    TopologyRefiner::CoplanarOptions coplanarOptions(kLargeLevel);
    coplanarOptions.angleTolerance = 180;
    auto const expected = create();
    ASSERT_TRUE(expected->RefineUniform(kSmallLevel)); // has the threads started as well
    for (bool isCoplanar : {false, true}) {
        auto const refiner = create();
        {
            MemoryLimit const limit(rlim_t(64) << 20);
            if (isCoplanar) {
                EXPECT_THROW(refiner->RefineCoplanar(shape.positions.data(), coplanarOptions),
                             std::bad_alloc);
            } else {
                EXPECT_THROW(refiner->RefineUniform(kLargeLevel), std::bad_alloc);
            }
        }
        EXPECT_EQ(refiner->GetNumLevels(), 1);
        TopologyLevel const &base = refiner->GetLevel(0);
        EXPECT_EQ(base.GetFaceChildFaces(0).size(), 0);
        EXPECT_EQ(base.GetVertexChildVertex(0), Far::INDEX_INVALID);
        ASSERT_TRUE(refiner->RefineUniform(kSmallLevel));
        EXPECT_TRUE(refiner->GetLevel(kSmallLevel).Validate());
        EXPECT_TRUE(hasEqualFaces(refiner->GetLevel(kSmallLevel), expected->GetLevel(kSmallLevel)));
    }
}

} // namespace OpenSubdivHex::Regression::memoryTest

#endif
