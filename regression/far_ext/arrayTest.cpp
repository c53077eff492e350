// SPDX-License-Identifier: Apache-2.0
//
// The memory of levels: buffers, and arrays placed in one; and sets of indices.
#include "far_ext/vtr/indexSet.h"
#include "far_ext/vtr/pagedArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <numeric>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace OpenSubdivHex::Regression::arrayTest {

using FarExt::internal::Buffer;
using FarExt::internal::kCacheLine;
using FarExt::internal::PlaceArrays;
using FarExt::internal::ResizeLarge;

TEST(Buffer, KeepsItsMemoryUntilItNeedsMore) {
    Buffer<int> buffer;
    EXPECT_TRUE(buffer.empty());
    buffer.Resize(100);
    int const *const memory = buffer.data();
    buffer.Resize(10);
    EXPECT_EQ(buffer.size(), 10u);
    buffer.Resize(100);
    EXPECT_EQ(buffer.data(), memory);
}

// One that grew without being written is a vector like any other.
TEST(ResizeLarge, MakesAVectorOfExactSize) {
    for (std::size_t size : {std::size_t(0), std::size_t(1), std::size_t(1000000)}) {
        std::vector<int> array;
        ResizeLarge(array, size);
        ASSERT_EQ(array.size(), size);
        EXPECT_EQ(array.capacity(), size);
        EXPECT_EQ(std::size_t(array.end() - array.begin()), size);
        std::iota(array.begin(), array.end(), 0);
        std::vector<int> const copy = array;
        ASSERT_EQ(copy.size(), size);
        array.push_back(-1);
        ASSERT_EQ(array.size(), size + 1);
        EXPECT_TRUE(std::equal(copy.begin(), copy.end(), array.begin()));
        EXPECT_EQ(array.back(), -1);
    }
}

TEST(Buffer, IsAlignedToCacheLines) {
    std::vector<Buffer<char>> buffers(20);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        buffers[i].Resize((std::size_t(1) << i) + i);
        EXPECT_EQ(
            reinterpret_cast<std::uintptr_t>(buffers[i].data()) % FarExt::internal::kCacheLine, 0u);
    }
}

#ifdef __GLIBC__
TEST(Buffer, NewOneFitsWhereAnotherWas) {
    constexpr std::size_t kSize = std::size_t(4) << 20;
    auto const getHeapSize = [] { return mallinfo2().arena + mallinfo2().hblkhd; };
    // glibc takes arrays of this size from the heap once a larger one was freed.
    Buffer<char>().Resize(4 * kSize);
    auto first = std::make_unique<Buffer<char>>();
    first->Resize(kSize);
    std::vector<char> const behind(kSize / 4 * 3);
    std::vector<char> const before(1000); // if there is a gap
    std::size_t const heapSize = getHeapSize();
    first.reset();
    Buffer<char> second;
    second.Resize(kSize);
    EXPECT_EQ(getHeapSize(), heapSize);
}
#endif

TEST(Buffer, PlacedDoesNotGrowIntoOthersMemory) {
    int memory[4] = {1, 2, 3, 4};
    Buffer<int> buffer;
    buffer.Resize(7);
    buffer.Place(memory, 2);
    EXPECT_EQ(buffer.data(), memory);
    EXPECT_EQ(buffer.size(), 2u);
    buffer.Resize(0);
    EXPECT_TRUE(buffer.empty());
    buffer.Resize(2);
    EXPECT_NE(buffer.data(), memory);
}

TEST(PlaceArrays, LeavesEveryArrayItsOwnAlignedPlace) {
    Buffer<std::byte> memory;
    Buffer<int> ints;
    Buffer<std::uint16_t> shorts;
    Buffer<int> none;
    Buffer<int> last;
    // Larger, smaller, and with huge pages.
    for (std::size_t size : {std::size_t(33), std::size_t(5), std::size_t(1) << 20}) {
        PlaceArrays(memory, [&](auto place) {
            place(ints, size);
            place(shorts, size + 1);
            place(none, 0);
            place(last, 3);
        });
        ASSERT_EQ(ints.size(), size);
        ASSERT_EQ(shorts.size(), size + 1);
        EXPECT_TRUE(none.empty());
        ASSERT_EQ(last.size(), 3u);
        auto const begin = [](auto const &array) {
            return reinterpret_cast<std::uintptr_t>(array.data());
        };
        auto const end = [&](auto const &array) {
            return begin(array) + array.size() * sizeof(array[0]);
        };
        EXPECT_EQ(begin(ints), begin(memory));
        EXPECT_LE(end(ints), begin(shorts));
        EXPECT_LE(end(shorts), begin(last));
        EXPECT_LE(end(last), end(memory));
        for (std::uintptr_t place : {begin(ints), begin(shorts), begin(last)}) {
            EXPECT_EQ(place % kCacheLine, 0u);
        }
    }
}

TEST(IndexSet, SortsAndNumbersIndicesOfAnyDensity) {
    for (int const end : {1, 64, 512, 513, 100000}) {
        for (int const step : {1, 7, 63, 64, 511, 3000}) {
            SCOPED_TRACE(testing::Message() << "every " << step << " below " << end);
            std::vector<int> expected;
            for (int index = end - 1; index >= 0; index -= step) {
                expected.insert(expected.begin(), index);
            }
            std::vector<int> indices(expected.rbegin(), expected.rend());
            indices.insert(indices.end(), expected.begin(), expected.end());
            FarExt::internal::SortUnique(indices, end);
            ASSERT_EQ(indices, expected);
            FarExt::internal::IndexNumbering const numberOf(indices, end);
            for (std::size_t i = 0; i < indices.size(); ++i) {
                ASSERT_EQ(numberOf(indices[i]), int(i));
            }
        }
    }
    std::vector<int> none;
    FarExt::internal::SortUnique(none, 1000);
    EXPECT_TRUE(none.empty());
}

// A short range is an array; of a long one there are pages, which are used again where there are many.
TEST(PagedArray, HasWhatWasWrittenSinceItBegan) {
    for (Far::Index const end : {1, 1000, 1 << 20, (1 << 20) + 1, 2000000000}) {
        SCOPED_TRACE(end);
        FarExt::internal::PagedArray<int> array(end);
        EXPECT_EQ(array[end - 1], 0);
        for (int round = 0; round < 50; ++round) {
            std::vector<Far::Index> indices;
            for (std::int64_t i = 0; i < 40; ++i) {
                indices.push_back(Far::Index(i * (round + 1) * 1234577 % end));
            }
            std::sort(indices.begin(), indices.end());
            indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
            int const count = int(indices.size());
            array.Begin();
            array.ForEach(indices.data(), count, [&](int &element, int k) { element = round + k; });
            for (int k = count - 1; k >= 0; --k) {
                ASSERT_EQ(array[indices[std::size_t(k)]], round + k);
            }
        }
        array.Clear();
        EXPECT_EQ(array[end / 2], 0);
        EXPECT_EQ(array[end - 1], 0);
    }
}

} // namespace OpenSubdivHex::Regression::arrayTest
