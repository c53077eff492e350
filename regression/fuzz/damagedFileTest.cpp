// SPDX-License-Identifier: Apache-2.0
//
// The input of the readers' fuzzer: files that are read, and files that are refused.
#include "damagedFile.h"

#include "tools/mesh/fileError.h"
#include "tools/mesh/meshContent.h"
#include "tools/mesh/meshReader.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>
#include <vector>

namespace OpenSubdivHex::Regression::damagedFileTest {

TEST(DamagedFile, BytesMakeFilesOfAllKinds) {
    struct Count {
        int numRead = 0;
        int numWithTags = 0;
        int numWithChannels = 0;
        int numWithProperties = 0;
        std::set<std::string> refusals; ///< messages
    };
    std::map<std::string, Count> counts; // by name of the file
    for (unsigned seed = 0; seed < 2000; ++seed) {
        std::mt19937 random(seed);
        std::vector<std::uint8_t> bytes(120);
        for (std::uint8_t &byte : bytes) {
            byte = std::uint8_t(random() >> 8);
        }
        DamagedFile const file = MakeDamagedFile(bytes.data(), bytes.size());
        Count &count = counts[file.name];
        try {
            Tools::Mesh const mesh = Tools::internal::ParseMesh(file.name, file.content);
            ++count.numRead;
            count.numWithTags += !mesh.tags.creaseVertices.empty();
            count.numWithChannels += !mesh.channels.empty();
            bool const hasProperties =
                !mesh.vertexProperties.empty() || !mesh.faceProperties.empty();
            count.numWithProperties += hasProperties;
        } catch (Tools::FileError const &error) {
            count.refusals.insert(error.what());
        }
    }
    ASSERT_EQ(counts.size(), 3u);
    for (auto const &[name, count] : counts) {
        SCOPED_TRACE(name);
        EXPECT_GT(count.numRead, 100);
        EXPECT_GT(count.numWithProperties, 50);
        EXPECT_GT(count.refusals.size(), 80u);
    }
    EXPECT_GT(counts["a.obj"].numWithTags, 30);
    EXPECT_GT(counts["a.obj"].numWithChannels, 50);
}

} // namespace OpenSubdivHex::Regression::damagedFileTest
