// SPDX-License-Identifier: Apache-2.0
#include "tagText.h"

#include "tools/mesh/ruleNames.h"

#include <charconv>

namespace OpenSubdivHex::Tools {

namespace {

/// With as many digits as it takes to read the same float again.
std::string print(float value) {
    char digits[32];
    return {digits, std::to_chars(std::begin(digits), std::end(digits), value).ptr};
}

std::string line(std::string const &name, std::string const &counts, std::string const &arguments) {
    return "t " + name + " " + counts + " " + arguments + "\n";
}

} // namespace

std::string FormatTags(Mesh const &mesh, OpenSubdiv::Sdc::Options options) {
    MeshTags const &tags = mesh.tags;
    auto const boundary = options.GetVtxBoundaryInterpolation();
    auto const fvarInterpolation = options.GetFVarLinearInterpolation();
    auto const creasingMethod = options.GetCreasingMethod();

    std::string text = "# " + std::to_string(tags.GetNumCreases()) + " creases, " +
                       std::to_string(tags.GetNumCorners()) + " corners, " +
                       std::to_string(tags.GetNumHoles()) + " holes\n# boundary " +
                       kBoundaryNames[boundary] + ", creases " +
                       kCreasingMethodNames[creasingMethod] + ", face-varying " +
                       kFVarInterpolationNames[fvarInterpolation] + "\n";
    for (FVarChannel const &channel : mesh.channels) {
        text += "# channel " + GetName(channel.kind) + ": " +
                std::to_string(channel.GetNumValues()) + " values of " +
                std::to_string(channel.width) + " numbers\n";
    }
    // The numbers of the tag are RenderMan's.
    constexpr char const *kBoundaryNumbers[] = {"0", "2", "1"};
    text += line("interpolateboundary", "1/0/0", kBoundaryNumbers[boundary]);
    text += line("facevaryinginterpolateboundary", "1/0/0", std::to_string(fvarInterpolation));
    text += line("creasemethod", "0/0/1",
                 creasingMethod == MeshTags::Options::CREASE_CHAIKIN ? "chaikin" : "normal");
    for (std::size_t i = 0; i < tags.creaseSharpness.size(); ++i) {
        text += line("crease", "2/1/0",
                     std::to_string(tags.creaseVertices[2 * i]) + " " +
                         std::to_string(tags.creaseVertices[2 * i + 1]) + " " +
                         print(tags.creaseSharpness[i]));
    }
    for (std::size_t i = 0; i < tags.cornerSharpness.size(); ++i) {
        text += line("corner", "1/1/0",
                     std::to_string(tags.cornerVertices[i]) + " " + print(tags.cornerSharpness[i]));
    }
    for (int face : tags.holes) {
        text += line("hole", "1/0/0", std::to_string(face));
    }
    return text;
}

} // namespace OpenSubdivHex::Tools
