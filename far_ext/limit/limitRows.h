// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_ROWS_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_ROWS_H

#include "limitMask.h"
#include "plainNeighborhood.h"

#include "far_ext/status.h"
#include "far_ext/vtr/hierarchy.h"

#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// The options of the steps from any level on to its limit, none of which is a first step.
OPENSUBDIVHEX_API HexSchemeOptions GetStepsToLimit(HexSchemeOptions schemeOptions);

/// \brief Whether a level has limit points, or why not: InvalidArgument where it is none of the
/// hierarchy or has not its full topology, Unsupported where it is not refined by hexagonal steps.
OPENSUBDIVHEX_API CallStatus CheckLimitLevel(Hierarchy const &hierarchy,
                                             HexSchemeOptions const &schemeOptions, int level);

/// Faces of a vertex, and vertices of a face, up to which there are limits: of what lies around, each
/// depends on all of them.
inline constexpr int kMaxFacesAtLimit = 1024;

/// \brief A point of the limit surface and its derivatives, as sums of vertices of a level.
struct LimitRow {
    /// Whether source \p i has no part in any of the sums.
    bool IsNothing(int i) const { return weights[i] == 0 && du[i] == 0 && dv[i] == 0; }
    /// Calls function(i) for the others: values that are no numbers are none when multiplied by 0, either.
    template <typename FUNCTION>
    void ForEachPart(FUNCTION const &function) const {
        for (int i = 0; i < size; ++i) {
            if (!IsNothing(i)) {
                function(i);
            }
        }
    }

    int size;
    Far::Index const *sources; ///< a vertex may come twice
    double const *weights;
    double const *du;
    double const *dv;
};

/// Where a limit stencil is to be written, an entry of each array for each of its control vertices.
template <typename REAL>
struct LimitStencilPlace {
    Far::Index *indices;
    REAL *weights;
    REAL *duWeights; ///< these two are null without derivatives
    REAL *dvWeights;
};

/// \brief The limit at the vertices of a level as a matrix: the one place that joins limit masks to
/// vertices.  Tables are made, primvars refined and frames evaluated through it.
///
/// Vertices of the same type, whose neighbourhoods look alike, share a mask, which is found once for
/// each thread that meets it.  Most vertices are regular: nothing is kept of them.
class OPENSUBDIVHEX_API LimitRows {
public:
    using Index = Far::Index;

    /// Rows of a level that passes CheckLimitLevel(); refers to the level.
    LimitRows(Level const &level, Sdc::Options sdcOptions, HexSchemeOptions const &schemeOptions);
    ~LimitRows();

    /// Has masks found by a finder with the same options, which remembers those of other levels.  Find() is for the calling
    /// thread alone then.
    void SetMaskFinder(LimitMaskFinder &finder) { _maskFinder = &finder; }

    /// Finds all masks, in parallel, or says for which vertex there is none: of those where
    /// kMaxFacesAtLimit is exceeded before anything else is done.
    CallStatus Find();
    /// Finds the rows of \p verts only, which ascend, in addition to rows that are found already.
    CallStatus Find(std::vector<Index> const &verts);

    Level const &GetLevel() const { return _level; }

    /// \brief The row of a vertex, on a side of it, numbered as by LimitSides.  Valid until
    /// \p regularSources is used again.
    LimitRow GetRow(Index vert, int side,
                    Index regularSources[PlainNeighborhoodGatherer::kNumRegular]) const;

private:
    /// A vertex that is not regular, or one of its fans where it comes apart.
    struct Entry {
        Index vert;
        std::shared_ptr<LimitMask const> mask;
        int firstSource; ///< in the sources of the range
        int firstSide;   ///< in its sides
        int numSides;
    };
    /// The vertices of a range of the level that are not regular.
    struct Range {
        /// The row of the first fan of a vertex; \p vert is in the range.
        std::vector<Entry>::const_iterator FindEntry(Index vert) const;

        std::vector<Entry> entries; ///< ascending
        std::vector<Index> sources;
        std::vector<int> sides; ///< of masks, by side of the vertex
        Index firstRegular = Far::INDEX_INVALID;
        CallStatus status;
    };
    class Finder;

    // The length of ranges: finding the masks of a vertex may take milliseconds.
    static constexpr Index kRange = 64;

    Level const &_level;
    Sdc::Options const _sdcOptions;
    HexSchemeOptions const _schemeOptions;
    LimitMaskFinder *_maskFinder = nullptr; ///< null: one for each thread
    std::vector<Range> _ranges;             ///< none before the first call of Find()
    std::shared_ptr<LimitMask const> _regularMask;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
