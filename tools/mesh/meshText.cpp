// SPDX-License-Identifier: Apache-2.0
#include "meshText.h"

#include "fileError.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace OpenSubdivHex::Tools {

std::string ReadFile(std::string const &path) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) {
        throw FileError(path, "is a folder");
    }
    std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path.c_str(), "rb"),
                                                          &std::fclose);
    if (!file) {
        throw FileError(path, std::string("cannot be opened: ") + std::strerror(errno));
    }
    std::string content;
    constexpr std::size_t kChunk = std::size_t(1) << 20;
    std::size_t got = 0;
    do {
        std::size_t const size = content.size();
        content.resize(size + kChunk);
        got = std::fread(content.data() + size, 1, kChunk, file.get());
        content.resize(size + got);
    } while (got > 0);
    if (std::ferror(file.get())) {
        throw FileError(path, std::string("cannot be read: ") + std::strerror(errno));
    }
    return content;
}

void NormalizeText(std::string const &path, std::string *text) {
    if (text->find('\0') != std::string::npos) {
        throw FileError(path, "is not text: it holds a zero byte");
    }
    text->erase(0, text->size() - SkipByteOrderMark(*text).size());
    std::size_t out = 0;
    for (std::size_t in = 0; in < text->size(); ++in) {
        char c = (*text)[in];
        if (c == '\r') {
            c = '\n';
            if (in + 1 < text->size() && (*text)[in + 1] == '\n') {
                ++in;
            }
        }
        (*text)[out++] = c == '\v' || c == '\f' ? ' ' : c;
    }
    text->resize(out);
    if (!text->empty() && text->back() != '\n') {
        text->push_back('\n');
    }
}

void BlankComments(std::string *text) {
    bool isComment = false;
    for (char &c : *text) {
        isComment = c != '\n' && (isComment || c == '#');
        if (isComment) {
            c = ' ';
        }
    }
}

std::string_view SkipByteOrderMark(std::string_view text) {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.substr(text.substr(0, kMark.size()) == kMark ? kMark.size() : 0);
}

std::string_view TakeLine(std::string_view *text, char end) {
    std::size_t const size = text->find(end);
    std::string_view const line = text->substr(0, size);
    text->remove_prefix(size == std::string_view::npos ? text->size() : size + 1);
    return line;
}

std::string_view TakeWord(std::string_view *text) {
    constexpr char kSpace[] = " \t\n\r";
    text->remove_prefix(std::min(text->find_first_not_of(kSpace), text->size()));
    std::string_view const word = text->substr(0, text->find_first_of(kSpace));
    text->remove_prefix(word.size());
    return word;
}

std::vector<std::string_view> SplitWords(std::string_view text) {
    std::vector<std::string_view> words;
    for (std::string_view word = TakeWord(&text); !word.empty(); word = TakeWord(&text)) {
        words.push_back(word);
    }
    return words;
}

namespace {

/// Like std::from_chars, of the whole word.
template <typename T>
std::errc parseWord(std::string_view word, T *value) {
    char const *const end = word.data() + word.size();
    std::from_chars_result const result = std::from_chars(word.data(), end, *value);
    return result.ptr == end ? result.ec : std::errc::invalid_argument;
}

// std::from_chars takes none.
std::string_view dropPlus(std::string_view word) {
    return word.substr(!word.empty() && word.front() == '+' ? 1 : 0);
}

} // namespace

bool ParseInt(std::string_view word, int *value) { return parseWord(word, value) == std::errc(); }

bool ParseFiniteFloat(std::string_view word, float *value) {
    word = dropPlus(word);
    std::errc error = parseWord(word, value);
    if (error == std::errc::result_out_of_range) {
        // Too large, or so small that it is 0.
        double number = 0;
        error = parseWord(word, &number);
        *value = float(number);
    }
    return error == std::errc() && std::isfinite(*value);
}

std::string NameFloatFailure(std::string_view word) {
    float value = 0;
    bool const isOutOfRange = parseWord(dropPlus(word), &value) == std::errc::result_out_of_range;
    return isOutOfRange ? "out of the range of floats" : "not a finite number";
}

} // namespace OpenSubdivHex::Tools
