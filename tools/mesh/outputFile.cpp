// SPDX-License-Identifier: Apache-2.0
#include "outputFile.h"

#include "fileError.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>

#if defined(__unix__) || defined(__APPLE__)
#define HAS_POSIX_FILES
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace OpenSubdivHex::Tools {

namespace {

namespace fs = std::filesystem;

/// Returns the path behind all links, there or not; still a link when there are too many.
std::string followLinks(std::string const &path) {
    constexpr int kMaxLinks = 40; // as Linux has it
    fs::path result = path;
    std::error_code error;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(result, error); ++i) {
        fs::path const target = fs::read_symlink(result, error);
        result = result.parent_path() / target;
    }
    return result.string();
}

/// Whether a path leads to a device, a pipe or the like, or to a folder.
bool isSpecial(std::string const &path) {
    std::error_code error;
    return fs::exists(path, error) && !fs::is_regular_file(path, error);
}

/// Whether the user may write a file that is there; else errno tells why.
bool isWritable(std::string const &path) {
    std::FILE *const file = std::fopen(path.c_str(), "r+b");
    return file && std::fclose(file) == 0;
}

#ifdef HAS_POSIX_FILES
/// Gives \p file the owner and mode of the file \p path, if that is there, as far as the user may
/// and the disk knows them.
void copyAttributes(std::string const &path, std::FILE *file) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0) {
        return;
    }
    // Who may not give files away can still give them to a group of theirs.
    bool const hasOwner = fchown(fileno(file), status.st_uid, status.st_gid) == 0;
    bool const hasGroup = hasOwner || fchown(fileno(file), uid_t(-1), status.st_gid) == 0;
    mode_t const kept = hasOwner ? 07777 : hasGroup ? 0777 : 0707;
    static_cast<void>(fchmod(fileno(file), status.st_mode & kept));
}

int duplicate(std::FILE *file) { return dup(fileno(file)); }

void closeHandle(int handle) {
    if (handle >= 0) {
        close(handle);
    }
}

bool isNameOf(int file, std::string const &path) {
    struct stat ofFile {};
    struct stat ofPath {};
    return fstat(file, &ofFile) == 0 && lstat(path.c_str(), &ofPath) == 0 &&
           ofFile.st_dev == ofPath.st_dev && ofFile.st_ino == ofPath.st_ino;
}

/// Removes a temporary file that nobody writes any more: writers lock theirs.
bool removeStale(std::string const &path) {
    int const file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    bool const isRemoved = file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0 &&
                           isNameOf(file, path) && std::remove(path.c_str()) == 0;
    closeHandle(file);
    return isRemoved;
}

/// Locks a file for as long as it is open.  False if it was removed in the meantime.
bool lockNamed(std::FILE *file, std::string const &path) {
    flock(fileno(file), LOCK_EX);
    return isNameOf(fileno(file), path);
}
#else
void copyAttributes(std::string const &, std::FILE *) {}
int duplicate(std::FILE *) { return -1; }
void closeHandle(int) {}
bool removeStale(std::string const &) { return false; }
bool lockNamed(std::FILE *, std::string const &) { return true; }
#endif

#ifdef O_TMPFILE
constexpr char kOpenFiles[] = "/proc/self/fd/";

/// A file that has no name yet, on the disk of \p path; null where the system has no such files.
std::FILE *openUnnamed(std::string const &path) {
    std::error_code error;
    fs::path const folder = fs::absolute(path, error).parent_path();
    int const file = fs::is_directory(kOpenFiles, error)
                         ? open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666)
                         : -1;
    if (file >= 0) {
        flock(file, LOCK_EX);
    }
    return file < 0 ? nullptr : fdopen(file, "w+b");
}

/// Whether the file got the name, which nobody may have; else errno tells why.
bool nameFile(int file, std::string const &path) {
    std::string const openFile = kOpenFiles + std::to_string(file);
    return linkat(AT_FDCWD, openFile.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}
#else
std::FILE *openUnnamed(std::string const &) { return nullptr; }
bool nameFile(int, std::string const &) { return false; }
#endif

/// Calls take(path) for names beside \p path, and gives the first one that it takes.  It fails
/// with errno EEXIST where another process writes the same target; other errors end it, and errno
/// tells which.  The names are short, since that of the target may be as long as names can be.
template <typename TAKE>
std::string takeTemporaryPath(std::string const &path, TAKE take) {
    fs::path const target = path;
    for (int i = 0;;) {
        std::size_t const hash =
            std::hash<std::string>()(std::to_string(i) + target.filename().string());
        std::string const name = ".OpenSubdivHex-" + std::to_string(hash) + ".part";
        std::string const temporaryPath = (target.parent_path() / name).string();
        if (take(temporaryPath)) {
            return temporaryPath;
        }
        if (errno != EEXIST) {
            return "";
        }
        i += removeStale(temporaryPath) ? 0 : 1;
    }
}

} // namespace

OutputFile::OutputFile(std::string const &path) : _path(path), _targetPath(followLinks(path)) {
    std::error_code error;
    if (fs::is_directory(_targetPath, error)) {
        throw FileError(path, "is a folder");
    }
    _isSpecial = isSpecial(_targetPath);
    if (fs::is_symlink(_targetPath, error)) {
        errno = ELOOP;
    } else if (_isSpecial) {
        _file = std::fopen(path.c_str(), "wb");
    } else if (!fs::exists(_targetPath, error) || isWritable(_targetPath)) {
        _file = openUnnamed(_targetPath);
        _isUnnamed = _file != nullptr;
        if (!_file) {
            _temporaryPath = takeTemporaryPath(
                _targetPath, [this](std::string const &name) { return openNamed(name); });
        }
    }
    if (!_file) {
        refuse();
    }
    std::setvbuf(_file, nullptr, _IONBF, 0);
}

OutputFile::~OutputFile() {
    if (_file) {
        std::fclose(_file);
    }
    if (!_temporaryPath.empty()) {
        std::remove(_temporaryPath.c_str());
    }
    closeHandle(_handle);
}

bool OutputFile::openNamed(std::string const &path) {
    _file = std::fopen(path.c_str(), "wbx"); // "x": fails where there is a file
    if (_file && !lockNamed(_file, path)) {
        std::fclose(_file);
        _file = nullptr;
        errno = EEXIST;
    }
    return _file != nullptr;
}

void OutputFile::Write(std::string_view content) {
    errno = 0;
    if (std::fwrite(content.data(), 1, content.size(), _file) != content.size()) {
        refuse();
    }
}

// Gives the file the name of its target, or else one to rename it from.
void OutputFile::nameUnnamed() {
    bool isNamed = nameFile(_handle, _targetPath);
    if (!isNamed && errno == EEXIST) {
        _temporaryPath = takeTemporaryPath(
            _targetPath, [this](std::string const &name) { return nameFile(_handle, name); });
        isNamed = !_temporaryPath.empty();
    }
    if (!isNamed) {
        refuse();
    }
}

void OutputFile::Commit() {
    if (!_isSpecial) {
        copyAttributes(_targetPath, _file);
        _handle = duplicate(_file);
    }
    std::FILE *const file = _file;
    _file = nullptr;
    if (std::fclose(file) != 0) {
        refuse();
    }
    if (_isUnnamed) {
        nameUnnamed();
    }
    if (!_temporaryPath.empty()) {
        std::error_code error;
        fs::rename(_temporaryPath, _targetPath, error);
        if (error) {
            throw FileError(_path, "cannot be written: " + error.message());
        }
        _temporaryPath.clear();
    }
}

void OutputFile::refuse() const {
    throw FileError(_path, std::string("cannot be written: ") + std::strerror(errno));
}

std::FILE *OpenScratchFile(std::string const &path) {
    std::FILE *file = openUnnamed(followLinks(path));
    if (!file) {
        file = std::tmpfile();
    }
    if (!file) {
        throw FileError(path, std::string("cannot be prepared: ") + std::strerror(errno));
    }
    return file;
}

bool IsSameOutput(std::string const &path, std::string const &otherPath) {
    std::error_code error;
    fs::path const target = fs::absolute(followLinks(path), error);
    fs::path const otherTarget = fs::absolute(followLinks(otherPath), error);
    bool const isSameName = target.filename() == otherTarget.filename() &&
                            fs::equivalent(target.parent_path(), otherTarget.parent_path(), error);
    return !isSpecial(target.string()) &&
           (isSameName || fs::equivalent(target, otherTarget, error));
}

} // namespace OpenSubdivHex::Tools
