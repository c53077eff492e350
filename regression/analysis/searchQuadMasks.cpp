// SPDX-License-Identifier: Apache-2.0
//
// Searches for the weights of FaceMask::Smooth at the first levels of quads, and shows them beside
// those that the library has.  Takes some minutes.
#include "quadMaskSearch.h"

#include <cstdio>
#include <cstdlib>

using namespace OpenSubdivHex::Regression;

namespace {

void print(char const *title, QuadWeights const &weights, QuadJudge &judge) {
    double const norm = judge.Measure(weights).norm();
    std::printf("%s, %.5f\n   256ths:", title, norm);
    for (double weight : weights) {
        std::printf(" %.2f", 256 * weight);
    }
    std::printf("\n  ");
    for (QuadJudge::Entry const &entry : judge.GetEntries()) {
        std::printf(" %s: %.4f ", entry.name.c_str(), entry.unevenness);
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    if (argc > 2) {
        std::fprintf(stderr, "usage: searchQuadMasks [level]\n");
        return 2;
    }
    int const level = argc > 1 ? int(std::strtol(argv[1], nullptr, 10)) : 5;
    constexpr int kMaxSteps = 30;
    QuadJudge judge(level);
    QuadWeights const plain = GetPlainQuadWeights();
    print("where the search begins", plain, judge);
    QuadWeights const found = SearchQuadWeights(plain, kMaxSteps, judge);
    print("found", found, judge);
    print("rounded", RoundQuadWeights(found, kMaxSteps, judge), judge);
    print("in the library", GetShippedQuadWeights(), judge);
    return 0;
}
