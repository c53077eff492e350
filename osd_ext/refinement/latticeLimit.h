// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_LIMIT_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_LATTICE_LIMIT_H

#include "latticeWeights.h"
#include "limitKernel.h"

#include "far_ext/limit/latticeFaces.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// \brief The limit in the lattice faces of level 0 prepared for evaluation.
///
/// A face is evaluated by its symmetries: its sources are taken apart into waves around it, which the
/// weights of a vertex multiply by a number each, and with one row of weights all vertices of an orbit
/// are made, six of triangles, eight of quads and twelve of hexagons; or half as many on the border, where
/// the others belong to the faces beyond.
class LatticeLimit {
public:
    void Prepare(FarExt::internal::LatticeFaces const &faces);
    bool IsEmpty() const { return _sets.empty(); }
    /// Whether a vertex of level 0 is made.
    bool IsMade(Far::Index vert) const {
        return std::binary_search(_madeCorners.begin(), _madeCorners.end(), vert);
    }

    /// Writes the outputs of the vertices in all faces, from the values of level 0.
    void Evaluate(LimitTask const &common) const;

private:
    struct Set {
        int faceSize;
        bool isCompact;
        int numPairs;
        int numHalves;
        int numAxes;
        Far::Index numGroups;
        FarExt::internal::Buffer<std::uint32_t> places;
        FarExt::internal::Buffer<Far::Index> verts;
        std::vector<unsigned char> areConsecutive;
        std::vector<Far::Index> ahead;
        std::vector<Far::Index> firstAhead;
        int numGroupsAhead;
        std::vector<float> weights;
    };

    /// Which sources of a face are summed up.
    struct UsedOrbits {
        bool areCompact;
        SourceOrbits orbits;
    };
    /// The vertices at the corners of faces, one by one; invalid where other faces make them.
    using Corners = std::vector<Far::Index>;

    static UsedOrbits findSources(FarExt::internal::LatticeFaces::Set const &of);
    /// Finds which corners are made, and keeps them; none where this takes more time than sums do.
    Corners makeCorners(FarExt::internal::LatticeFaces const &faces,
                        FarExt::internal::LatticeFaces::Set const &of, UsedOrbits const &sources);
    /// @name The parts of a set, of some faces
    /// @{
    static void setSources(FarExt::internal::LatticeFaces::Set const &of, UsedOrbits const &sources,
                           std::vector<Far::Index> const &faces, Set &set);
    /// \param halves  the pairs of which these faces make one half
    static void setOutputs(FarExt::internal::LatticeFaces::Set const &of, UsedOrbits const &sources,
                           Corners const &corners, std::vector<Far::Index> const &faces,
                           std::vector<int> const &halves, Set &set);
    /// Behind these: what memory is asked for ahead.
    static void setAhead(Set &set);
    /// @}

    std::vector<Set> _sets;
    std::vector<Far::Index> _madeCorners;
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif
