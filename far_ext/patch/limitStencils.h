// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_LIMIT_STENCILS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_LIMIT_STENCILS_H

#include "far_ext/limit/limitRows.h"

#include <functional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Sums of vertices of a level as sums of control vertices: what patch points are made of.
///
/// Each is a point with two derivatives, as a LimitRow is.
class LimitStencils {
public:
    using Index = Far::Index;

    /// Ascending indices of control vertices, or values, each with three weights: for the point, du and dv.
    struct Stencil {
        int size;
        Index const *indices;
        double const *weights[3];
    };

    /// A row whose arrays it keeps.
    struct KeptRow {
        void Clear();
        /// Adds to the weights of a source, which may come more than once.
        void Add(Index source, double weight, double du, double dv);
        /// Adds a row behind what is there.
        void Append(LimitRow const &row);
        /// The row of sources \p begin to \p end - 1.
        LimitRow Get(int begin, int end) const;
        LimitRow Get() const { return Get(0, int(sources.size())); }

        std::vector<Index> sources;
        std::vector<double> weights[3];
    };

    /// \brief Makes those of \p numRows rows, in parallel.
    ///
    /// \param channel  face-varying channel, whose values are the vertices, or -1
    /// \param level    whose vertices the rows have
    /// \param getRow   called as getRow(number, kept) by several threads, once for each row: the row of that
    ///                 number, which is valid until \p kept is used again
    /// \return         TooLarge where a size of the stencils of the level is
    CallStatus Form(Hierarchy const &hierarchy, int channel, HexSchemeOptions const &schemeOptions,
                    int level, Index numRows,
                    std::function<LimitRow(Index, KeptRow &)> const &getRow);

    Stencil Get(Index row) const;

private:
    static constexpr Index kRange = 64;

    // The stencils of a range of rows.
    struct Range {
        std::vector<int> firsts; // and the end
        std::vector<Index> indices;
        std::vector<double> weights[3];
    };

    std::vector<Range> _ranges;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
