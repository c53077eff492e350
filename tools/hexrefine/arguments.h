// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_ARGUMENTS_H
#define OPENSUBDIVHEX_TOOLS_ARGUMENTS_H

#include "adaptive.h"
#include "evaluation.h"

#include "far_ext/topologyRefiner.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace OpenSubdivHex::Tools {

inline constexpr char kLikePaper[] = "paper";
inline constexpr char kLikeRenderer[] = "renderer";

/// The arguments of the command line, checked.
struct Arguments {
    std::string input;
    int level = 1;
    std::string output;
    std::string like = kLikePaper;
    std::optional<std::string> mask;
    std::string scheme = "hex";
    std::optional<std::string> firstStep;
    bool isCoplanar = false;
    double tolerance = FarExt::TopologyRefiner::CoplanarOptions(0).angleTolerance;
    bool hasOpenGaps = false;
    std::optional<std::string> boundary;
    std::optional<double> creaseAngle;
    std::optional<std::string> fvarInterpolation;
    std::string evaluator = kRefinement;
    std::optional<int> numThreads;
    std::optional<std::string> simd;
    std::string png;
    std::string pngColors;
    std::string stats;
    bool isLimit = false;
    bool isSeparate = false;
    AdaptiveArguments adaptive;
    bool printsTags = false;
    bool isQuiet = false;

    /// Whether what is not said is as renderers want it, else as the paper has it.
    bool IsLikeRenderer() const { return like == kLikeRenderer; }
};

/// Adds all options, and checks of what does not go together: they are what \p arguments have when \p app
/// has parsed the command line.
void AddOptions(CLI::App &app, Arguments *arguments);

} // namespace OpenSubdivHex::Tools

#endif
