// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_SEARCH_PATCH_CONSTANTS_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_SEARCH_PATCH_CONSTANTS_H

namespace OpenSubdivHex::Regression {

/// \brief Finds the constants of Gregory patches (far_ext/patch/patchConstants.inl) again and prints them.
///
/// \param steps      behind the surface level: 0 to 2, since later ones have the defaults
/// \param maxRounds  of the search; it ends before where a round gains little
void SearchPatchConstants(int steps, int maxRounds);

} // namespace OpenSubdivHex::Regression

#endif
