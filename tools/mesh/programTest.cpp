// SPDX-License-Identifier: Apache-2.0
//
// Messages of programs for exceptions, and their exit codes.
#include "program.h"

#include <gtest/gtest.h>

#include <system_error>

namespace OpenSubdivHex::Tools::programTest {

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
              "program: --number: is\\nnegative\nRun program with --help for more information.\n");
    EXPECT_EQ(run("--number=x\ny"), kBadUsage);
    std::string const text = testing::internal::GetCapturedStderr();
    EXPECT_NE(text.find("x\\ny"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text;
}

TEST(Program, TellsThatHelpCannotBeWritten) {
    CLI::App app("", "program");
    char const *const arguments[] = {"program", "--help"};
    // As to a full disk.
    std::streambuf *const output = std::cout.rdbuf(nullptr);
    testing::internal::CaptureStderr();
    int const status = RunProgram(app, 2, arguments, [] {});
    std::cout.rdbuf(output);
    EXPECT_EQ(status, kFailure);
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "program: standard output: cannot be written\n");
}

TEST(Program, RangesHaveFloatsAlone) {
    auto const check = [](CLI::Validator const &range, std::string const &word) {
        std::string const failure = range(word);
        EXPECT_TRUE(failure.empty() || failure.find(word) != std::string::npos) << failure;
        return failure;
    };
    CLI::Validator const closed = MakeRange(0, 1e6);
    EXPECT_EQ(check(closed, "0"), "");
    EXPECT_EQ(check(closed, "1e6"), "");
    EXPECT_NE(check(closed, "-1e-9"), "");
    EXPECT_NE(check(closed, "1000000.1"), "");
    EXPECT_EQ(check(closed, "nan"), "'nan' is not a finite number");
    EXPECT_EQ(check(closed, "inf"), "'inf' is not a finite number");
    EXPECT_EQ(check(closed, "1e300"), "'1e300' is out of the range of floats");

    CLI::Validator const open = MakeOpenRange(0, 180, "an angle");
    EXPECT_EQ(check(open, "1e-30"), "");
    EXPECT_EQ(check(open, "179.9999"), "");
    EXPECT_EQ(check(open, "0"), "'0' is not an angle");
    EXPECT_EQ(check(open, "180"), "'180' is not an angle");
    EXPECT_EQ(check(open, "-nan"), "'-nan' is not a finite number");
    EXPECT_EQ(check(open, "179.999999"), "'179.999999' is 180 as a float, not an angle");
    EXPECT_EQ(check(open, "1e-300"), "'1e-300' is 0 as a float, not an angle");
    EXPECT_EQ(check(open, "1e300"), "'1e300' is out of the range of floats");

    EXPECT_EQ(check(MakePositive(), "3e38"), "");
    EXPECT_EQ(check(MakePositive(), "x"), "'x' is not a finite number");
    EXPECT_EQ(check(MakePositive(), "-1"), "'-1' is not a number above 0");
    EXPECT_EQ(check(MakePositive(), "1e-300"), "'1e-300' is 0 as a float, not a number above 0");
}

TEST(Program, NumbersAreOneArgument) {
    std::vector<float> numbers;
    std::string input;
    auto const run = [&](std::vector<char const *> arguments) {
        numbers = {7};
        input.clear();
        CLI::App app("", "program");
        app.add_option("INPUT", input)->required();
        AddNumbers(app, "--numbers", &numbers, 2, 3, "");
        app.add_flag("--flag");
        arguments.insert(arguments.begin(), "program");
        testing::internal::CaptureStderr();
        int const status = RunProgram(app, int(arguments.size()), arguments.data(), [] {});
        std::string const error = testing::internal::GetCapturedStderr();
        return std::to_string(status) + error.substr(0, error.find('\n'));
    };
    EXPECT_EQ(run({"--numbers", "1,-2.5", "a", "--flag"}), "0");
    EXPECT_EQ(numbers, (std::vector<float>{1, -2.5f}));
    EXPECT_EQ(input, "a");
    EXPECT_EQ(run({"--numbers=-1,2,3", "4", "--flag"}), "0");
    EXPECT_EQ(numbers, (std::vector<float>{-1, 2, 3}));
    EXPECT_EQ(input, "4");
    EXPECT_EQ(run({"a"}), "0");
    EXPECT_EQ(numbers, std::vector<float>{7});
    EXPECT_EQ(run({"a", "--numbers", "1"}), "2program: --numbers: '1' has 1 numbers, not 2 to 3");
    EXPECT_EQ(run({"a", "--numbers", "1,2,3,4"}),
              "2program: --numbers: '1,2,3,4' has 4 numbers, not 2 to 3");
    EXPECT_EQ(run({"a", "--numbers", "1,x"}), "2program: --numbers: 'x' is not a finite number");
    EXPECT_EQ(run({"a", "--numbers", "1,"}), "2program: --numbers: '' is not a finite number");
}

} // namespace OpenSubdivHex::Tools::programTest
