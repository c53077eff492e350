// SPDX-License-Identifier: Apache-2.0
//
// Output files appear whole or not at all, where the path leads, and leave nothing beside them.
#include "outputFile.h"
#include "fileError.h"
#include "testFolder.h"

#ifdef __unix__
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace {

bool refusesUnnamedFiles = false;
bool isKilledBeforeRename = false;

} // namespace

#ifdef O_TMPFILE
// In place of the system's: disks that know no files without a name, and a kill at the worst time.
extern "C" int open(char const *path, int flags, ...) {
    if (refusesUnnamedFiles && (flags & O_TMPFILE) == O_TMPFILE) {
        errno = EOPNOTSUPP;
        return -1;
    }
    std::va_list arguments;
    va_start(arguments, flags);
    mode_t const mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
    va_end(arguments);
    return openat(AT_FDCWD, path, flags, mode);
}

extern "C" int rename(char const *from, char const *to) noexcept {
    if (isKilledBeforeRename) {
        std::raise(SIGKILL);
    }
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}
#endif

namespace OpenSubdivHex::Tools::outputFileTest {

namespace {

using Names = std::vector<std::string>;

void write(std::string const &path, std::string const &content) {
    OutputFile file(path);
    file.Write(content);
    file.Commit();
}

void expectRefused(std::string const &path, std::string const &cause) {
    try {
        write(path, "new");
        ADD_FAILURE() << path << " was written";
    } catch (FileError const &error) {
        EXPECT_EQ(std::string(error.what()).rfind(path + ": ", 0), 0u) << error.what();
        EXPECT_NE(std::string(error.what()).find(cause), std::string::npos) << error.what();
    }
}

} // namespace

/// The parameter says whether the disk knows files without a name.
class Output : public TestFolder, public ::testing::WithParamInterface<bool> {
protected:
    Output() { refusesUnnamedFiles = !GetParam(); }
    ~Output() override { refusesUnnamedFiles = false; }
};

#ifdef O_TMPFILE
INSTANTIATE_TEST_SUITE_P(, Output, testing::Bool(), [](auto const &test) {
    return std::string(test.param ? "Unnamed" : "Named");
});
#else
INSTANTIATE_TEST_SUITE_P(Named, Output, testing::Values(false));
#endif

TEST_P(Output, ReplacesTheTargetOfLinks) {
    std::string const target = makeFile("target", "old");
    std::filesystem::create_symlink("target", getPath("link"));
    std::filesystem::create_symlink(getPath("link"), getPath("chain"));
    write(getPath("chain"), "new");
    EXPECT_EQ(getContent(target), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(getPath("chain")));
    EXPECT_TRUE(std::filesystem::is_symlink(getPath("link")));
    EXPECT_EQ(listFiles(), (Names{"chain", "link", "target"}));
}

TEST_P(Output, MakesTheTargetOfDanglingLinks) {
    std::filesystem::create_directory(getPath("folder"));
    std::filesystem::create_symlink("folder/target", getPath("link"));
    write(getPath("link"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(getPath("link")));
    EXPECT_EQ(getContent(getPath("folder/target")), "new");

    std::filesystem::create_symlink("missing/target", getPath("nowhere"));
    expectRefused(getPath("nowhere"), "No such file");
    EXPECT_EQ(listFiles(), (Names{"folder", "link", "nowhere"}));
}

TEST_P(Output, RefusesLinksInALoop) {
    std::filesystem::create_symlink("b", getPath("a"));
    std::filesystem::create_symlink("a", getPath("b"));
    expectRefused(getPath("a"), "links");
    expectRefused(getPath("a/file"), "links");
    EXPECT_EQ(listFiles(), (Names{"a", "b"}));
}

TEST_P(Output, AbandonedLeavesNothing) {
    std::string const path = makeFile("a", "old");
    {
        OutputFile file(path);
        file.Write("half");
        EXPECT_EQ(getContent(path), "old");
    }
    EXPECT_EQ(getContent(path), "old");
    EXPECT_EQ(listFiles(), Names{"a"});
}

TEST_P(Output, TakesNamesOfAnyLength) {
    for (std::size_t size : {250u, 255u}) {
        std::string const name(size, 'n');
        write(getPath(name), "first");
        write(getPath(name), "second");
        EXPECT_EQ(getContent(getPath(name)), "second");
        EXPECT_EQ(listFiles(), Names{name});
        std::filesystem::remove(getPath(name));
    }
    expectRefused(getPath(std::string(256, 'n')), "name too long");
}

TEST_P(Output, OfTwoAtOnceTheLastIsKept) {
    std::string const path = makeFile("a", "old");
    OutputFile first(path);
    OutputFile second(path);
    first.Write("first");
    second.Write("second");
    first.Commit();
    EXPECT_EQ(getContent(path), "first");
    second.Commit();
    EXPECT_EQ(getContent(path), "second");
    EXPECT_EQ(listFiles(), Names{"a"});
}

#ifdef __unix__

TEST_P(Output, KilledLeavesNothingForLong) {
    std::string const path = makeFile("a", "old");
    auto const writeAndDie = [&] {
        OutputFile file(path);
        file.Write("half");
        std::raise(SIGKILL);
    };
    EXPECT_EXIT(writeAndDie(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EQ(getContent(path), "old");
    EXPECT_EQ(listFiles().size(), GetParam() ? 1u : 2u);
    write(path, "new");
    EXPECT_EQ(getContent(path), "new");
    EXPECT_EQ(listFiles(), Names{"a"});
}

TEST_P(Output, KilledBeforeItReplacesLeavesNothingForLong) {
    std::string const path = makeFile("a", "old");
    auto const writeAndDie = [&] {
        isKilledBeforeRename = true;
        write(path, "half");
    };
    EXPECT_EXIT(writeAndDie(), testing::KilledBySignal(SIGKILL), "");
    EXPECT_EQ(getContent(path), "old");
    EXPECT_EQ(listFiles().size(), 2u);
    write(path, "new");
    EXPECT_EQ(getContent(path), "new");
    EXPECT_EQ(listFiles(), Names{"a"});
}

TEST_P(Output, KeepsModeAndOwner) {
    // As other files that a program makes, not as temporary ones.
    write(getPath("a"), "first");
    makeFile("usual", "");
    auto const getMode = [this](std::string const &name) {
        struct stat status {};
        EXPECT_EQ(stat(getPath(name).c_str(), &status), 0);
        return status.st_mode & 07777;
    };
    EXPECT_EQ(getMode("a"), getMode("usual"));

    std::filesystem::create_symlink("a", getPath("link"));
    for (mode_t mode : {0600, 0664, 0755, 02750}) {
        ASSERT_EQ(chmod(getPath("a").c_str(), mode), 0);
        write(getPath("a"), "second");
        EXPECT_EQ(getMode("a"), mode);
        write(getPath("link"), "third");
        EXPECT_EQ(getMode("a"), mode);
    }
    if (geteuid() == 0) {
        constexpr unsigned kOther = 12345;
        ASSERT_EQ(chown(getPath("a").c_str(), kOther, kOther + 1), 0);
        write(getPath("a"), "fourth");
        struct stat status {};
        EXPECT_EQ(stat(getPath("a").c_str(), &status), 0);
        EXPECT_EQ(status.st_uid, kOther);
        EXPECT_EQ(status.st_gid, kOther + 1);
    }
}

TEST_P(Output, RefusesFilesThatMayNotBeWritten) {
    std::string const path = makeFile("a", "old");
    ASSERT_EQ(chmod(path.c_str(), 0444), 0);
    ASSERT_EQ(chmod(getPath("").c_str(), 0777), 0);
    auto const writeAsUser = [&] {
        // Root may write every file.
        if (geteuid() == 0 && seteuid(12345) != 0) {
            std::exit(2);
        }
        try {
            write(path, "new");
        } catch (FileError const &error) {
            std::fprintf(stderr, "%s", error.what());
            std::exit(1);
        }
        std::exit(0);
    };
    EXPECT_EXIT(writeAsUser(), testing::ExitedWithCode(1), "Permission denied");
    EXPECT_EQ(getContent(path), "old");
    EXPECT_EQ(listFiles(), Names{"a"});
}

TEST_P(Output, FailedLeavesNothing) {
    std::string const path = makeFile("a", "old");
    expectRefused(getPath("missing/a"), "No such file");
    expectRefused(path + "/a", "Not a directory");
    std::filesystem::create_directory(getPath("folder"));
    expectRefused(getPath("folder"), "is a folder");
    // A full disk: the system lets the process write no more than 4 KiB to a file.
    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    rlimit limit = old;
    limit.rlim_cur = 4096;
    setrlimit(RLIMIT_FSIZE, &limit);
    auto *const oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    EXPECT_THROW(write(path, std::string(5000, 'x')), FileError);
    std::signal(SIGXFSZ, oldHandler);
    setrlimit(RLIMIT_FSIZE, &old);
    if (std::filesystem::exists("/dev/full")) {
        OutputFile file("/dev/full");
        EXPECT_THROW(file.Write("x"), FileError);
    }
    EXPECT_EQ(listFiles(), (Names{"a", "folder"}));
    EXPECT_EQ(getContent(path), "old");
}

#endif

TEST_F(TestFolder, IsSameOutputSeesThroughSpellings) {
    std::filesystem::create_directory(getPath("folder"));
    std::filesystem::create_symlink("folder", getPath("linkToFolder"));
    std::filesystem::create_symlink("folder/a", getPath("linkToFile"));
    std::string const path = getPath("folder/a");
    Names const spellings = {path, getPath("folder/../folder/./a"), getPath("linkToFolder/a"),
                             getPath("linkToFile"), std::filesystem::relative(path).string()};
    for (bool const exists : {false, true}) {
        if (exists) {
            makeFile("folder/a", "");
        }
        for (std::string const &spelling : spellings) {
            EXPECT_TRUE(IsSameOutput(path, spelling)) << spelling << exists;
            EXPECT_TRUE(IsSameOutput(spelling, path)) << spelling << exists;
            EXPECT_FALSE(IsSameOutput(spelling, getPath("a"))) << spelling << exists;
            EXPECT_FALSE(IsSameOutput(spelling, getPath("folder/b"))) << spelling << exists;
        }
    }
    EXPECT_FALSE(IsSameOutput("/dev/null", "/dev/null"));
}

TEST(FileErrorText, IsOneLine) {
    EXPECT_STREQ(FileError("a\nb\r\x1b[1m\x7f", "is\tbad").what(),
                 "a\\nb\\x0d\\x1b[1m\\x7f: is\\x09bad");
    EXPECT_STREQ(FileError("\u00e9\\n", "\u20ac").what(), "\u00e9\\n: \u20ac");
}

} // namespace OpenSubdivHex::Tools::outputFileTest
