// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_SETTINGS_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_SETTINGS_H

namespace OpenSubdivHex::Regression {

/// \brief How much work goes into the page.  Levels are numbers of refinement steps.
struct Settings {
    int pictureWidth = 360; ///< pixels, of one picture of a row
    int numSamples = 24;    ///< per pixel
    int solidLevel = 5;     ///< of the pentagonal solid and the counts; the paper's is 5
    int maskLevel = 6;      ///< of the pictures that compare masks
    int smoothnessLevel = 6;
    int curvatureLevel = 7;
    int timingLevel = 7;
    int numRounds = 15; ///< of each timing, of which the median counts
};

} // namespace OpenSubdivHex::Regression

#endif
