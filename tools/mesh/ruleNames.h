// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_RULE_NAMES_H
#define OPENSUBDIVHEX_TOOLS_RULE_NAMES_H

#include <map>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// The names of the values of FaceMask, SchemeType and FirstStep, in the order of the values.
inline std::vector<std::string> const kMaskNames = {"average", "cosine", "smooth"};
inline std::vector<std::string> const kSchemeNames = {"hexagonal", "doo-sabin", "tri-hex"};
inline std::vector<std::string> const kFirstStepNames = {"none", "tri-hex", "truncate"};

/// The names of the values of Sdc::Options::VtxBoundaryInterpolation, FVarLinearInterpolation and
/// CreasingMethod, in the order of the values.
inline std::vector<std::string> const kBoundaryNames = {"none", "edge-only", "edge-and-corner"};
inline std::vector<std::string> const kFVarInterpolationNames = {
    "none", "corners-only", "corners-plus1", "corners-plus2", "boundaries", "all"};
inline std::vector<std::string> const kCreasingMethodNames = {"uniform", "chaikin"};

/// The value whose name is \p name, one of \p names.
template <typename ENUM>
ENUM FindRule(std::vector<std::string> const &names, std::string const &name) {
    std::size_t value = 0;
    while (names[value] != name) {
        ++value;
    }
    return ENUM(value);
}

/// All values by their names, for CLI::Transformer.
template <typename ENUM>
std::map<std::string, ENUM> MapRules(std::vector<std::string> const &names) {
    std::map<std::string, ENUM> rules;
    for (std::string const &name : names) {
        rules[name] = FindRule<ENUM>(names, name);
    }
    return rules;
}

} // namespace OpenSubdivHex::Tools

#endif
