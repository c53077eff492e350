// SPDX-License-Identifier: Apache-2.0
#include "libraryPaths.h"

#include "tools/mesh/meshText.h"

#include <filesystem>

namespace OpenSubdivHex::Tools {

namespace {

namespace fs = std::filesystem;

fs::path getFolder(std::string const &path) {
    fs::path const folder = fs::path(path).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// \p name, of a file in \p from or a path from there, as a path from \p to.
std::string move(std::string_view name, fs::path const &from, fs::path const &to) {
    if (fs::path(name).is_absolute()) {
        return std::string(name);
    }
    std::error_code error;
    fs::path const path = fs::proximate(from / fs::path(name), to, error);
    return error ? std::string(name) : path.generic_string();
}

} // namespace

std::vector<std::string> MoveLibraries(std::vector<std::string> libraries, std::string const &input,
                                       std::string const &output) {
    fs::path const from = getFolder(input);
    fs::path const to = getFolder(output);
    std::error_code error;
    if (fs::equivalent(from, to, error)) {
        return libraries;
    }
    for (std::string &library : libraries) {
        if (fs::exists(from / fs::path(library), error)) {
            library = move(library, from, to);
            continue;
        }
        std::string moved;
        for (std::string_view word : SplitWords(library)) {
            moved += (moved.empty() ? "" : " ") + move(word, from, to);
        }
        library = moved;
    }
    return libraries;
}

} // namespace OpenSubdivHex::Tools
