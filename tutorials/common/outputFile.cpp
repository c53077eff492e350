// SPDX-License-Identifier: Apache-2.0
#include "outputFile.h"

#include "fileError.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace OpenSubdivHex::Tutorials {

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
        // "x": never writes over a file that happens to have the name.
        for (int i = 0; i == 0 || (!_file && errno == EEXIST); ++i) {
            _temporaryPath = _targetPath + ".part" + std::to_string(i);
            _file = std::fopen(_temporaryPath.c_str(), "wbx");
        }
    }
    if (!_file) {
        throw FileError(path, std::string("cannot be written: ") + std::strerror(errno));
    }
    std::setvbuf(_file, nullptr, _IONBF, 0);
}

OutputFile::~OutputFile() {
    if (_file) {
        std::fclose(_file);
        if (!_temporaryPath.empty()) {
            std::remove(_temporaryPath.c_str());
        }
    }
}

void OutputFile::Write(std::string_view content) {
    errno = 0;
    if (std::fwrite(content.data(), 1, content.size(), _file) != content.size()) {
        refuse();
    }
}

void OutputFile::Commit() {
    std::FILE *const file = _file;
    _file = nullptr;
    bool const isClosed = std::fclose(file) == 0;
    if (!_temporaryPath.empty()) {
        std::error_code error(errno, std::generic_category());
        if (isClosed) {
            std::filesystem::rename(_temporaryPath, _targetPath, error);
        }
        if (error) {
            std::remove(_temporaryPath.c_str());
            throw FileError(_path, "cannot be written: " + error.message());
        }
    } else if (!isClosed) {
        refuse();
    }
}

void OutputFile::refuse() const {
    throw FileError(_path, std::string("cannot be written: ") + std::strerror(errno));
}

} // namespace OpenSubdivHex::Tutorials
