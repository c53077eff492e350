// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_TEST_FOLDER_H
#define OPENSUBDIVHEX_TOOLS_TEST_FOLDER_H

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#ifdef __unix__
#include <sys/wait.h>
#endif

namespace OpenSubdivHex::Tools {

/// \brief A test with a folder of its own, made for it and removed after it.
class TestFolder : public ::testing::Test {
protected:
    TestFolder() {
        ::testing::TestInfo const &info = *::testing::UnitTest::GetInstance()->current_test_info();
        std::string name =
            std::string("OpenSubdivHex.") + info.test_suite_name() + "." + info.name();
        std::replace(name.begin(), name.end(), '/', '.'); // of tests with parameters
        // Other users and other builds run the same tests.
        std::random_device random;
        do {
            _folder = std::filesystem::path(::testing::TempDir()) /
                      (name + "." + std::to_string(random()));
        } while (!std::filesystem::create_directories(_folder));
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

    /// Runs \p program with \p arguments, as a shell reads them, and what it prints in the files
    /// stdout and stderr.  Gives its exit status, -1 if it was killed.
    int runProgram(std::string const &program, std::string const &arguments,
                   std::string const &before = "") const {
        std::string const command = before + "\"" + program + "\" " + arguments + " >\"" +
                                    getPath("stdout") + "\" 2>\"" + getPath("stderr") + "\"";
        int const status = std::system(command.c_str());
#ifdef __unix__
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
#else
        return status;
#endif
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

} // namespace OpenSubdivHex::Tools

#endif
