// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PAPER_PLOT_H
#define OPENSUBDIVHEX_REGRESSION_PAPER_PLOT_H

#include "regression/analysis/surfaceLevels.h"

#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A line of a plot.
struct Series {
    std::string name; ///< of the legend
    std::vector<std::pair<double, double>> points;
    int color = 0; ///< 0 ... 7
    bool isDashed = false;
};

/// \brief A plot of some lines.
struct Plot {
    std::string title;
    std::string xLabel;
    std::string yLabel;
    bool isLogarithmic = false; ///< the y axis
    std::vector<Series> series;
    int width = 440; ///< of the drawing, in its own units
    int height = 300;
};

/// An inline SVG element.
std::string DrawPlot(Plot const &plot);

/// The faces of \p mesh, seen along the z axis, over the edges of \p parent; an inline SVG element.
std::string DrawPlanarMesh(PolygonMesh const &parent, PolygonMesh const &mesh);

} // namespace OpenSubdivHex::Regression

#endif
