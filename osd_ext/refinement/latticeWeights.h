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

/// @name Joined orbits, of all sources
/// @{
/// \brief Those that are left: in triangles the first joined one, which has an axis, stands for orbit 5.
///
/// With x(k, i) for source i of orbit k, and the LatticeFaces::Set::outerWeights a and b, sources become
///   triangles  x(5, i + 1) + x(6, i + 2) in orbit 5, and in orbit 2
///              x(2, i) + a (x(7, i) + x(8, i)) + a / 2 (x(6, i + 1) - x(5, i) + x(5, i + 2) - x(6, i)),
///   quads      x(4, i) + a x(6, i) + b x(7, i + 1) and x(5, i) + a x(7, i) + b x(6, i - 1),
///   hexagons   x(2, i) + a (x(5, i) + x(6, i)).
SourceOrbits GetJoinedSourceOrbits(FarExt::internal::LatticePatch const &patch);
/// An orbit with weights for these.
FarExt::internal::LatticeFaces::Orbit
JoinSources(FarExt::internal::LatticePatch const &patch,
            FarExt::internal::LatticeFaces::Orbit const &orbit);
/// @}

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
