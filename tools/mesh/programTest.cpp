// SPDX-License-Identifier: Apache-2.0
//
// What programs print of exceptions, and their exit codes.
#include "program.h"

#include <gtest/gtest.h>

#include <system_error>

namespace OpenSubdivHex::Tools {

namespace {

template <typename WORK>
void expectFailure(WORK work, std::string const &line) {
    CLI::App app("", "program");
    char const *const arguments[] = {"program"};
    testing::internal::CaptureStderr();
    EXPECT_EQ(RunProgram(app, 1, arguments, work), kFailure);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "program: " + line + "\n");
}

} // namespace

TEST(Program, CatchesEverything) {
    expectFailure([] { throw FileError("a", "is bad"); }, "a: is bad");
    expectFailure([] { throw std::bad_alloc(); }, "not enough memory");
    expectFailure([] { throw std::length_error("two\nlines"); }, "two\\nlines");
    expectFailure(
        [] { throw std::system_error(std::make_error_code(std::errc::permission_denied)); },
        "Permission denied");
    expectFailure([] { throw 1; }, "an error that says nothing of itself");
}

TEST(Program, TellsBadUsage) {
    CLI::App app("", "program");
    int number = 0;
    app.add_option("--number", number);
    auto const work = [&] {
        if (number < 0) {
            throw CLI::ValidationError("--number", "is\nnegative");
        }
    };
    auto const run = [&](char const *argument) {
        char const *const arguments[] = {"program", argument};
        testing::internal::CaptureStderr();
        return RunProgram(app, 2, arguments, work);
    };
    EXPECT_EQ(run("--number=2"), kSuccess);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(run("--number=-1"), kBadUsage);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "--number: is\\nnegative\nRun program with --help for more information.\n");
    EXPECT_EQ(run("--number=x\ny"), kBadUsage);
    std::string const text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("x\\ny"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

} // namespace OpenSubdivHex::Tools
