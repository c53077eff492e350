// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_WALK_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_LATTICE_WALK_H

#include "cellType.h"

#include "far_ext/limit/plainNeighborhood.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Gathers the control points of base faces in a regular lattice: on a fixed way from face to face,
/// across edges, without a search.
///
/// PlainCellGatherer finds the same for any face without features.
class LatticeWalk {
public:
    using Index = Far::Index;
    /// Control points, at most.
    static constexpr int kMaxPoints = 42;

    /// Whether a type is that of base faces in a lattice, no vertices of which are the same.
    static bool HasWalk(CellType const &type);
    /// Of faces of that type.
    explicit LatticeWalk(CellType const &type);

    int GetNumPoints() const { return int(_points.size()); }

    /// \brief Gathers the control points of a face.
    ///
    /// \param level    level 0 of a mesh, or of the values of a channel
    /// \param marks    those of MarkFeatures()
    /// \param points   GetNumPoints() vertices
    /// \param turns    those of FindBaseCellTurns()
    /// \return         false where it is not of the type; then the results are of no use
    bool Gather(FarExt::internal::Level const &level,
                std::vector<FarExt::internal::VertexMark> const &marks, Index face, Index *points,
                int *turns) const;

private:
    static constexpr int kMaxFaces = 37;

    // From a face that has been found across the edge from one of its corners, to a corner of the next.
    struct Step {
        std::uint8_t face;
        std::uint8_t corner;
        std::uint8_t nextCorner;
    };
    struct Point {
        std::uint8_t face;
        std::uint8_t corner;
    };

    int addCorners(int a, int b) const { return a + b < _faceSize ? a + b : a + b - _faceSize; }
    bool isOfType(FarExt::internal::Level const &level,
                  std::vector<FarExt::internal::VertexMark> const &marks,
                  Index const *points) const;

    int _faceSize;
    int _valence;
    std::vector<Step> _steps;
    std::vector<Point> _points;
    std::vector<std::uint8_t> _inner; // points all of whose faces are there
};

/// \brief The walks of a factory, for the types of faces in a lattice that it has met.  Any number of
/// threads may use it.
class LatticeWalks {
public:
    struct Entry {
        CellType const *type;
        LatticeWalk walk;
    };

    /// The entry for faces of a size; null where there is none yet.
    Entry const *Find(int faceSize, FarExt::Interpolation interpolation) const {
        return faceSize < kEndOfSizes
                   ? _found[faceSize][std::size_t(interpolation)].load(std::memory_order_acquire)
                   : nullptr;
    }
    /// Adds that of a type, where it has a walk.
    void Add(CellType const &type, FarExt::Interpolation interpolation);

private:
    static constexpr int kEndOfSizes = 7;

    std::atomic<Entry const *> _found[kEndOfSizes][2] = {};
    std::mutex _mutex;
    std::vector<std::unique_ptr<Entry const>> _entries;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
