// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_MESH_TEXT_H
#define OPENSUBDIVHEX_TOOLS_MESH_TEXT_H

#include <string>
#include <string_view>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The whole file as it is.  Throws FileError.
std::string ReadFile(std::string const &path);

/// \brief Makes every line of a text file end in '\n' and drops a byte order mark.  Form feeds and
/// vertical tabs, which readers see differently, become spaces.
/// Throws FileError when it holds a zero byte: it is no text then.
void NormalizeText(std::string const &path, std::string *text);

/// Overwrites comments, from # to the end of the line, with spaces.
void BlankComments(std::string *text);

/// \p text without the byte order mark of UTF-8 that it may begin with.
std::string_view SkipByteOrderMark(std::string_view text);

/// Takes the first line off \p text, without its \p end.
std::string_view TakeLine(std::string_view *text, char end = '\n');

/// Takes the first word off \p text; empty when only spaces, tabs and line ends are left.
std::string_view TakeWord(std::string_view *text);

std::vector<std::string_view> SplitWords(std::string_view text);

/// Whether the whole of \p word is an int (which it then gives).
bool ParseInt(std::string_view word, int *value);

/// Whether the whole of \p word is a number that a float can hold, neither NaN nor infinite (which
/// it then gives, correctly rounded).
bool ParseFiniteFloat(std::string_view word, float *value);

/// Says why ParseFiniteFloat() refuses a word: "not a finite number", or one "out of the range of
/// floats".
std::string NameFloatFailure(std::string_view word);

} // namespace OpenSubdivHex::Tools

#endif
