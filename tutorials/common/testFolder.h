// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_TEST_FOLDER_H
#define OPENSUBDIVHEX_TUTORIALS_TEST_FOLDER_H

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tutorials {

/// \brief A test with a folder of its own, empty before it and removed after it.
class TestFolder : public ::testing::Test {
protected:
    TestFolder() {
        ::testing::TestInfo const &info = *::testing::UnitTest::GetInstance()->current_test_info();
        _folder = std::filesystem::path(::testing::TempDir()) /
                  (std::string("OpenSubdivHex.") + info.test_suite_name() + "." + info.name());
        std::filesystem::remove_all(_folder);
        std::filesystem::create_directories(_folder);
    }
    ~TestFolder() override { std::filesystem::remove_all(_folder); }

    std::string getPath(std::string const &name) const { return (_folder / name).string(); }

    /// Writes a file and gives its path.
    std::string makeFile(std::string const &name, std::string const &content) const {
        std::ofstream(getPath(name), std::ios::binary) << content;
        return getPath(name);
    }

    static std::string getContent(std::string const &path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    }

    /// The names in the folder, sorted.
    std::vector<std::string> listFiles() const {
        std::vector<std::string> names;
        for (auto const &entry : std::filesystem::directory_iterator(_folder)) {
            names.push_back(entry.path().filename().string());
        }
        std::sort(names.begin(), names.end());
        return names;
    }

private:
    std::filesystem::path _folder;
};

} // namespace OpenSubdivHex::Tutorials

#endif
