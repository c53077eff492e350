// SPDX-License-Identifier: Apache-2.0
#include "libraryPaths.h"

#include "tools/mesh/meshText.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

namespace fs = std::filesystem;

fs::path getFolder(std::string const &path) {
    fs::path const folder = fs::path(path).parent_path();
    return folder.empty() ? fs::path(".") : folder;
}

/// Whether \p name is an absolute path, here or in Windows.
bool isAbsolute(std::string_view name) {
    bool const hasDrive =
        name.size() > 1 && name[1] == ':' && std::isalpha(static_cast<unsigned char>(name[0]));
    return hasDrive || fs::path(name).is_absolute();
}

/// \p name, of a file in \p from or a path from there, as a path from \p to.
std::string move(std::string_view name, fs::path const &from, fs::path const &to) {
    if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
        return '"' + move(name.substr(1, name.size() - 2), from, to) + '"';
    }
    if (isAbsolute(name)) {
        return std::string(name);
    }
    std::error_code error;
    fs::path const path = fs::proximate(from / fs::path(name), to, error);
    return error ? std::string(name) : path.generic_string();
}

/// Whether \p word ends in .mtl, or in that and a quotation mark.
bool endsWithExtension(std::string_view word) {
    constexpr std::string_view kExtension = ".mtl";
    if (!word.empty() && word.back() == '"') {
        word.remove_suffix(1);
    }
    return word.size() >= kExtension.size() &&
           std::equal(kExtension.begin(), kExtension.end(), word.end() - kExtension.size(),
                      [](char expected, char c) {
                          return expected == char(std::tolower(static_cast<unsigned char>(c)));
                      });
}

bool isFile(fs::path const &folder, std::string const &name) {
    std::error_code error;
    return fs::is_regular_file(folder / fs::path(name), error);
}

/// \brief The names of files in \p folder that words name: each goes on until it is that of a file, or to
/// a word that ends in .mtl, so that names may have spaces.  Behind the last such word each word is a
/// name.
std::vector<std::string> joinNames(std::vector<std::string_view> const &words,
                                   fs::path const &folder) {
    auto const behindLast = std::find_if(words.rbegin(), words.rend(), endsWithExtension).base();
    std::vector<std::string> names;
    std::string name;
    for (auto word = words.begin(); word != words.end(); ++word) {
        name += (name.empty() ? "" : " ") + std::string(*word);
        if (word >= behindLast || endsWithExtension(*word) || isFile(folder, name)) {
            names.push_back(std::move(name));
            name.clear();
        }
    }
    return names;
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
        if (isFile(from, library)) {
            library = move(library, from, to);
            continue;
        }
        std::string moved;
        for (std::string const &name : joinNames(SplitWords(library), from)) {
            moved += (moved.empty() ? "" : " ") + move(name, from, to);
        }
        library = moved;
    }
    return libraries;
}

} // namespace OpenSubdivHex::Tools
