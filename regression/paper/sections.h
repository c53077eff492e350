// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_SECTIONS_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_SECTIONS_H

#include "page.h"
#include "settings.h"

namespace OpenSubdivHex::Regression {

/// \brief The sections of the page.  Each computes what it shows, and adds the claims of the paper
/// that its numbers decide.
/// @{
void AddSolidSection(Page *page, Settings const &settings);      ///< figure 5
void AddMeshSection(Page *page, Settings const &settings);       ///< figure 6
void AddFactorSection(Page *page, Settings const &settings);     ///< figure 7
void AddCountSection(Page *page, Settings const &settings);      ///< faces and vertices
void AddEigenvalueSection(Page *page, Settings const &settings); ///< section 6
void AddSmoothnessSection(Page *page, Settings const &settings); ///< normals and curvature
void AddTipSection(Page *page, Settings const &settings);        ///< at irregular vertices
void AddEvennessSection(Page *page, Settings const &settings);   ///< of curvature
void AddModelSection(Page *page, Settings const &settings);      ///< whole models
void AddMaskSection(Page *page, Settings const &settings);       ///< reflection lines
void AddTimingSection(Page *page, Settings const &settings);     ///< running time
void AddCoplanarSection(Page *page, Settings const &settings);   ///< stage 3
/// @}

} // namespace OpenSubdivHex::Regression

#endif
