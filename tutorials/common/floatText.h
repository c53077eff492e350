// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_FLOAT_TEXT_H
#define OPENSUBDIVHEX_TUTORIALS_FLOAT_TEXT_H

namespace OpenSubdivHex::Tutorials {

/// Most characters that PrintFloat writes, some of them perhaps behind the text.
constexpr int kMaxFloatText = 16;

/// \brief Prints what std::to_chars(out, out + kMaxFloatText, value) does, the shortest text that
/// reads as \p value again, faster where coordinates mostly lie: at 0.001 to 100,000.
///
/// \return  the end of the text; up to kMaxFloatText characters from \p out are overwritten
char *PrintFloat(char *out, float value);

} // namespace OpenSubdivHex::Tutorials

#endif
