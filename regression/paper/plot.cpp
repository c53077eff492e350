// SPDX-License-Identifier: Apache-2.0
#include "plot.h"

#include "page.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Regression {

namespace {

struct Range {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();

    void Add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

std::string number(double value) { return FormatNumber(value, 1); }

std::string element(std::string const &name, std::string const &attributes) {
    return "<" + name + " " + attributes + "/>";
}

std::string text(double x, double y, std::string const &content, std::string const &attributes) {
    return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" + content +
           "</text>";
}

std::string color(int index) { return "var(--c" + std::to_string(index % 8) + ")"; }

/// As few digits as show the value.
std::string formatTick(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, value >= 1000 ? "%.0f" : "%.4g", value);
    return digits;
}

/// Round numbers, at most about six, from low to high.
std::vector<double> findTicks(Range range, bool isLogarithmic) {
    std::vector<double> ticks;
    if (isLogarithmic) {
        double const decades = std::log10(range.high / range.low);
        for (int exponent = int(std::floor(std::log10(range.low)));
             exponent <= int(std::ceil(std::log10(range.high))); ++exponent) {
            std::vector<double> digits{1};
            if (decades < 1.6) {
                digits = {1, 2, 5};
            } else if (decades < 3) {
                digits = {1, 3};
            }
            for (double digit : digits) {
                ticks.push_back(digit * std::pow(10, exponent));
            }
        }
    } else {
        double const raw = (range.high - range.low) / 5;
        double const unit = std::pow(10, std::floor(std::log10(raw)));
        double const step = unit * (raw > 5 * unit ? 10 : raw > 2 * unit ? 5 : raw > unit ? 2 : 1);
        for (double tick = std::ceil(range.low / step) * step; tick <= range.high + step / 100;
             tick += step) {
            ticks.push_back(std::abs(tick) < step / 100 ? 0 : tick);
        }
    }
    ticks.erase(std::remove_if(ticks.begin(), ticks.end(),
                               [&](double tick) {
                                   return tick < range.low * (1 - 1e-9) ||
                                          tick > range.high * (1 + 1e-9);
                               }),
                ticks.end());
    return ticks;
}

} // namespace

std::string DrawPlot(Plot const &plot) {
    constexpr double kLeft = 52, kRight = 14, kTop = 34, kLegendTop = 12, kLegendLine = 15;
    Range xRange, yRange;
    for (Series const &series : plot.series) {
        for (auto const &[x, y] : series.points) {
            xRange.Add(x);
            yRange.Add(y);
        }
    }
    // Round up and down, so that lines keep off the frame.
    if (plot.isLogarithmic) {
        yRange = {yRange.low / 1.15, yRange.high * 1.15};
    } else {
        double const margin = 0.06 * std::max(yRange.high - yRange.low, 1e-9);
        yRange = {yRange.low - margin, yRange.high + margin};
    }
    if (!(xRange.high > xRange.low)) {
        xRange.high = xRange.low + 1;
    }

    constexpr int kLegendColumns = 2;
    int const numLegendLines = (int(plot.series.size()) + kLegendColumns - 1) / kLegendColumns;
    double const bottom = plot.height - 40;
    double const height = plot.height + kLegendTop + kLegendLine * numLegendLines;
    auto const mapX = [&](double x) {
        return kLeft +
               (plot.width - kLeft - kRight) * (x - xRange.low) / (xRange.high - xRange.low);
    };
    auto const mapY = [&](double y) {
        double const part = plot.isLogarithmic
                                ? std::log(y / yRange.low) / std::log(yRange.high / yRange.low)
                                : (y - yRange.low) / (yRange.high - yRange.low);
        return bottom - (bottom - kTop) * part;
    };

    std::string svg = "<svg viewBox=\"0 0 " + std::to_string(plot.width) + " " + number(height) +
                      "\" role=\"img\" aria-label=\"" + plot.title + "\">";
    svg += text(kLeft, 20, plot.title, "class=\"title\"");
    for (double tick : findTicks(yRange, plot.isLogarithmic)) {
        double const y = mapY(tick);
        svg += element("path", "class=\"axis\" d=\"M" + number(kLeft) + " " + number(y) + "H" +
                                   number(plot.width - kRight) + "\"");
        svg += text(kLeft - 6, y + 4, formatTick(tick), "class=\"soft\" text-anchor=\"end\"");
    }
    for (double tick : findTicks(xRange, false)) {
        svg += text(mapX(tick), bottom + 16, formatTick(tick),
                    "class=\"soft\" text-anchor=\"middle\"");
    }
    svg += text((kLeft + plot.width - kRight) / 2, bottom + 32, plot.xLabel,
                "class=\"soft\" text-anchor=\"middle\"");
    double const middle = (kTop + bottom) / 2;
    svg += text(13, middle, plot.yLabel,
                "class=\"soft\" text-anchor=\"middle\" transform=\"rotate(-90 13 " +
                    number(middle) + ")\"");

    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        Series const &series = plot.series[i];
        std::string path;
        std::string marks;
        for (auto const &[x, y] : series.points) {
            path += (path.empty() ? "M" : "L") + number(mapX(x)) + " " + number(mapY(y));
            marks += element("circle", "cx=\"" + number(mapX(x)) + "\" cy=\"" + number(mapY(y)) +
                                           "\" r=\"2.4\" fill=\"" + color(series.color) + "\"");
        }
        std::string const stroke = "fill=\"none\" stroke=\"" + color(series.color) +
                                   "\" stroke-width=\"1.8\"" +
                                   (series.isDashed ? " stroke-dasharray=\"5 3\"" : "");
        svg += element("path", "d=\"" + path + "\" " + stroke) + marks;
        double const x = kLeft + double(i % kLegendColumns) * (plot.width - kLeft) / kLegendColumns;
        double const y = plot.height + kLegendTop + kLegendLine * double(i / kLegendColumns);
        svg += element("path", "d=\"M" + number(x) + " " + number(y) + "h20\" " + stroke);
        svg += text(x + 26, y + 4, series.name, "");
    }
    return svg + "</svg>";
}

std::string DrawPlanarMesh(PolygonMesh const &parent, PolygonMesh const &mesh) {
    Range xRange, yRange;
    for (Eigen::Vector3d const &position : parent.positions) {
        xRange.Add(position.x());
        yRange.Add(position.y());
    }
    constexpr double kWidth = 440, kMargin = 8;
    double const scale = (kWidth - 2 * kMargin) / (xRange.high - xRange.low);
    double const height = scale * (yRange.high - yRange.low) + 2 * kMargin;
    auto const makePath = [&](PolygonMesh const &faces, int face) {
        std::string path;
        for (int i = 0; i < faces.GetFaceSize(face); ++i) {
            Eigen::Vector3d const position = faces.positions[faces.GetFaceVertex(face, i)];
            path += (i == 0 ? "M" : "L") + number(kMargin + scale * (position.x() - xRange.low)) +
                    " " + number(height - kMargin - scale * (position.y() - yRange.low));
        }
        return path + "Z";
    };
    std::string svg =
        "<svg viewBox=\"0 0 440 " + number(height) + "\" role=\"img\" aria-label=\"planar mesh\">";
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        svg += element("path", "d=\"" + makePath(mesh, face) +
                                   "\" fill=\"var(--c1)\" fill-opacity=\".16\" "
                                   "stroke=\"var(--c1)\" stroke-width=\"1.3\"");
    }
    for (int face = 0; face < parent.GetNumFaces(); ++face) {
        svg += element("path", "d=\"" + makePath(parent, face) +
                                   "\" fill=\"none\" stroke=\"var(--c0)\" stroke-width=\"2.2\"");
    }
    return svg + "</svg>";
}

} // namespace OpenSubdivHex::Regression
