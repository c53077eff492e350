// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_NUMBER_TYPE_H
#define OPENSUBDIVHEX_TOOLS_NUMBER_TYPE_H

#include <cstddef>
#include <string_view>

namespace OpenSubdivHex::Tools {

/// The types that numbers have in PLY files.
enum class NumberType { Char, UChar, Short, UShort, Int, UInt, Float, Double };

/// Whether \p word is the name of a type, "uchar" or "uint8", which \p type then is.
bool FindNumberType(std::string_view word, NumberType *type);

/// The name as PLY has it from the beginning: "uchar".
char const *GetName(NumberType type);

/// Bytes of a number.
std::size_t GetSize(NumberType type);

inline bool IsInteger(NumberType type) {
    return type != NumberType::Float && type != NumberType::Double;
}

/// The range of an integer type.
/// @{
double GetMin(NumberType type);
double GetMax(NumberType type);
/// @}

/// The number of an integer type that is nearest to \p value, halves being rounded away from 0;
/// of other types \p value itself.
double RoundTo(NumberType type, double value);

} // namespace OpenSubdivHex::Tools

#endif
