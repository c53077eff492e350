// SPDX-License-Identifier: Apache-2.0
//
// Searches for the weights of FaceMask::Smooth at the first levels of quads, and shows them beside
// those that the library has.  Takes some minutes.
#include "maskSearch.h"

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace OpenSubdivHex::Regression;

namespace {

void print(char const *title, MaskWeights const &weights, MaskJudge &judge) {
    double const norm = judge.Measure(weights).norm();
    std::printf("%s, %.5f\n   256ths:", title, norm);
    for (double weight : weights) {
        std::printf(" %.2f", 256 * weight);
    }
    std::printf("\n  ");
    for (MaskJudge::Entry const &entry : judge.GetEntries()) {
        std::printf(" %s: %.4f ", entry.name.c_str(), entry.unevenness);
    }
    std::printf("\n");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    using OpenSubdivHex::FarExt::FacesAround;
    SearchedMasks searched = {4, FacesAround::Quads};
    if (argc > 2) {
        searched.numFaces = int(std::strtol(argv[1], nullptr, 10));
        std::string const around = argv[2];
        searched.facesAround = around == "quads"       ? FacesAround::Quads
                               : around == "triangles" ? FacesAround::Triangles
                                                       : FacesAround::Others;
    }
    int const level = argc > 3 ? int(std::strtol(argv[3], nullptr, 10)) : 5;
    if (argc == 2 || argc > 4 || searched.numFaces < 4 ||
        (searched.facesAround == FacesAround::Quads) > (searched.numFaces == 4)) {
        std::fprintf(stderr, "usage: searchMasks [FACES quads|triangles|others [LEVEL]]\n");
        return 2;
    }
    constexpr int kMaxSteps = 30;
    MaskJudge judge(searched, level);
    MaskWeights const shipped = GetShippedWeights(searched);
    print("in the library", shipped, judge);
    MaskWeights const plain = GetPlainWeights(searched);
    print("where the search begins", plain, judge);
    MaskWeights const found = SearchWeights(plain, kMaxSteps, judge);
    print("found", found, judge);
    print("rounded", RoundWeights(found, kMaxSteps, judge), judge);
    return 0;
}
