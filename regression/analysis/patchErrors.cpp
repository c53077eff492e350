// SPDX-License-Identifier: Apache-2.0
//
// Prints how far the patches of some meshes are from the limit surface: distances in millionths of the diagonal
// of the box, and angles between normals in degrees, as root mean squares and at most.
#include "patchSamples.h"

#include "regression/shapes/torus.h"

#include <algorithm>

#include <cmath>
#include <cstdio>

using namespace OpenSubdivHex;
using namespace OpenSubdivHex::Regression;

namespace {

// With a tolerance, patches are of the surface level to level.
void printErrors(char const *name, Shape const &shape, int level,
                 FarExt::FirstStep firstStep = FarExt::FirstStep::Same, double tolerance = 0) {
    PatchSamples const samples(shape, level, firstStep, tolerance);
    auto const &stencils = *samples.GetTable().GetLocalPointStencilTable<double>();
    std::vector<PatchSamples::Error> const errors = samples.Measure(samples.MakePoints(
        stencils.GetSizes(), stencils.GetControlIndices(), stencils.GetWeights()));
    double sums[2] = {0, 0};
    double largest[2] = {0, 0};
    for (PatchSamples::Error const &error : errors) {
        constexpr double kDegree = 3.14159265358979323846 / 180;
        double const numbers[2] = {1e6 * std::abs(error.distance), error.GetAngle() / kDegree};
        for (int k = 0; k < 2; ++k) {
            sums[k] += numbers[k] * numbers[k];
            largest[k] = std::max(largest[k], numbers[k]);
        }
    }
    auto const number = double(errors.size());
    std::printf(
        "%-20s level %d%s: %6d patches, distance %.2f (at most %.0f), normals %.3f (at most "
        "%.1f)\n",
        name, level, tolerance > 0 ? " and before" : "", samples.GetTable().GetNumPatchesTotal(),
        std::sqrt(sums[0] / number), largest[0], std::sqrt(sums[1] / number), largest[1]);
    std::fflush(stdout);
}

} // namespace

int main() {
    Shape const torus = MakeTorus(14, 8, TorusFaces::Quads, 1, 0.4);
    for (int level = 1; level <= 3; ++level) {
        printErrors("torus of quads", torus, level);
    }
    for (int level = 0; level <= 3; ++level) {
        printErrors("suzanne", GetShape("suzanne"), level);
    }
    printErrors("suzanne, 1e-4", GetShape("suzanne"), 3, FarExt::FirstStep::Same, 1e-4);
    Shape spot = GetShape("spot");
    printErrors("spot, with seams", spot, 1, FarExt::FirstStep::Truncate);
    spot.fvarChannels.clear();
    for (int level = 1; level <= 2; ++level) {
        printErrors("spot, truncated", spot, level, FarExt::FirstStep::Truncate);
    }
    return 0;
}
