// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_WEIGHTS_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_WEIGHTS_H

#include "far_ext/limit/latticeFaces.h"

#include <map>
#include <optional>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// The orbits of sources that have weights, by their numbers; of a pair that of the first.
struct SourceOrbits {
    std::vector<int> axes;
    std::vector<int> pairs;
};

SourceOrbits GetAllSourceOrbits(FarExt::internal::LatticePatch const &patch);
/// The orbits of a compact patch, if the faces use no others.
std::optional<SourceOrbits> FindCompactSourceOrbits(FarExt::internal::LatticeFaces::Set const &set);

/// How many orbits of a set are pairs, which come first.
int CountPairs(FarExt::internal::LatticeFaces::Set const &set);
/// \brief The faces of a set by their *halves*: pairs of orbits whose mirror images all belong to other faces.
std::map<std::vector<int>, std::vector<Far::Index>>
GroupByHalves(FarExt::internal::LatticeFaces::Set const &set);

/// Whether the vertices of an orbit depend on no other sources.
bool DependsOnThese(SourceOrbits const &sources, FarExt::internal::LatticePatch const &patch,
                    FarExt::internal::LatticeFaces::Orbit const &orbit);

/// An orbit as the first of a pair: of one on an axis, du and dv instead of derivatives along it and across.
FarExt::internal::LatticeFaces::Orbit MakePair(FarExt::internal::LatticeFaces::Orbit const &orbit);

/// \brief Appends the weights of an orbit, in terms of the waves of the sources around the face.
///
/// They are in the order in which the kernels read them: those of the waves that are alike at all corners
/// but for the sign, frequency 0 and, where the face has an even number of sides, half of that; then those
/// of the others, which have a cosine and a sine; last LatticeFaces::Orbit::derivatives.
void AddOrbitWeights(SourceOrbits const &sources, FarExt::internal::LatticePatch const &patch,
                     FarExt::internal::LatticeFaces::Orbit const &orbit,
                     std::vector<float> &weights);

} // namespace OpenSubdivHex::OsdExt::internal

#endif
