// SPDX-License-Identifier: Apache-2.0
#include "outputFile.h"

#include "fileError.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#ifdef __linux__
#include <fcntl.h>
#include <unistd.h>
#endif

namespace OpenSubdivHex::Tutorials {

namespace {

#ifdef O_TMPFILE
constexpr char kOpenFiles[] = "/proc/self/fd/";

/// A file that has no name yet, on the disk of \p path; null where the system has no such files.
std::FILE *openUnnamed(std::string const &path) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::path const folder = fs::absolute(path, error).parent_path();
    int const file = fs::is_directory(kOpenFiles, error)
                         ? open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666)
                         : -1;
    return file < 0 ? nullptr : fdopen(file, "wb");
}

/// Whether the file got the name, which nobody may have; else errno tells why.
bool nameFile(std::FILE *file, std::string const &path) {
    std::string const openFile = kOpenFiles + std::to_string(fileno(file));
    return linkat(AT_FDCWD, openFile.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}
#else
std::FILE *openUnnamed(std::string const &) { return nullptr; }
bool nameFile(std::FILE *, std::string const &) { return false; }
#endif

/// Calls take(path) for names beside \p path, and gives the first one that it takes.  It fails
/// with errno EEXIST where the name is somebody else's, which is never written over; other errors
/// end it, and errno tells which.
template <typename TAKE>
std::string takeTemporaryPath(std::string const &path, TAKE take) {
    for (int i = 0;; ++i) {
        std::string const temporaryPath = path + ".part" + std::to_string(i);
        if (take(temporaryPath)) {
            return temporaryPath;
        }
        if (errno != EEXIST) {
            return "";
        }
    }
}

} // namespace

OutputFile::OutputFile(std::string const &path) : _path(path), _targetPath(path) {
    namespace fs = std::filesystem;
    std::error_code error;
    if (fs::is_directory(path, error)) {
        throw FileError(path, "is a folder");
    }
    bool const isSpecial = fs::exists(path, error) && !fs::is_regular_file(path, error);
    if (isSpecial) {
        _file = std::fopen(path.c_str(), "wb");
    } else {
        if (fs::is_symlink(path, error)) {
            _targetPath = fs::weakly_canonical(path).string();
        }
        _file = openUnnamed(_targetPath);
        _isUnnamed = _file != nullptr;
        if (!_file) {
            _temporaryPath = takeTemporaryPath(_targetPath, [this](std::string const &name) {
                _file = std::fopen(name.c_str(), "wbx"); // "x": fails where there is a file
                return _file != nullptr;
            });
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
}

void OutputFile::Write(std::string_view content) {
    errno = 0;
    if (std::fwrite(content.data(), 1, content.size(), _file) != content.size()) {
        refuse();
    }
}

void OutputFile::Commit() {
    if (_isUnnamed) {
        _temporaryPath = takeTemporaryPath(
            _targetPath, [this](std::string const &name) { return nameFile(_file, name); });
        if (_temporaryPath.empty()) {
            refuse();
        }
    }
    std::FILE *const file = _file;
    _file = nullptr;
    if (std::fclose(file) != 0) {
        refuse();
    }
    if (!_temporaryPath.empty()) {
        std::error_code error;
        std::filesystem::rename(_temporaryPath, _targetPath, error);
        if (error) {
            throw FileError(_path, "cannot be written: " + error.message());
        }
        _temporaryPath.clear();
    }
}

void OutputFile::refuse() const {
    throw FileError(_path, std::string("cannot be written: ") + std::strerror(errno));
}

} // namespace OpenSubdivHex::Tutorials
