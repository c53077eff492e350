// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PLAIN_FACE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PLAIN_FACE_H

#include "cellType.h"
#include "faceWalk.h"
#include "growingPatch.h"
#include "ringCell.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief Describes the patch of a plain base face in a few bytes: the size of the face, the numbers of
/// faces at its vertices and at their neighbours, in the order of the patch, and where these faces are
/// not all of one size, their sizes.
///
/// A face is *plain* where no feature is near and its patch is a disc, no vertices of which are the
/// same: so the key tells all of the patch.
using PlainFaceKey = std::string;

/// \brief All plain base faces of a key.  Their CellType is made when it is first asked for: a face whose
/// surface is made but not evaluated needs none.
class PlainFaceType {
public:
    using Run = GrowingPatch::Run;

    /// \param numVerts   all of whose faces are in the patch
    /// \param runs, end  GrowingPatch::GetRuns() of the patch of the key
    PlainFaceType(PlainFaceTypes &types, PlainFaceKey const &key, int numVerts, Run const *runs,
                  Run const *end);
    ~PlainFaceType();
    PlainFaceType(PlainFaceType const &) = delete;
    PlainFaceType &operator=(PlainFaceType const &) = delete;

    std::size_t const hash; ///< of the key

    bool HasKey(PlainFaceKey const &key) const { return std::string_view(_key) == key; }
    /// Without what is made on demand.
    std::size_t GetHeapSize() const { return _key.capacity() + _runs.capacity() * sizeof(Run); }
    int GetNumPoints() const { return _numPoints; }
    /// The points behind the vertices whose faces are all there.
    std::pmr::vector<Run> const &GetRuns() const { return _runs; }
    /// The type that evaluates the points, made on demand.
    CellType const &Get() const {
        CellType const *const type = _type.load(std::memory_order_acquire);
        return type ? *type : make();
    }
    bool IsInLattice() const { return _isInLattice; }
    /// Rings, which evaluate tessellations of faces that are not in a lattice.  They take a fraction of the time and
    /// memory of types.
    FaceRings const &GetRings() const {
        FaceRings const *const rings = _rings.load(std::memory_order_acquire);
        return rings ? *rings : makeRings();
    }
    /// \brief As CellType::GetBorderItem() of an edge or, behind these, of a vertex that the rings have in a
    /// lattice, without the CellType of the face.
    CellType::BorderItem const &GetLatticeItem(int const *turns, std::size_t item) const;

private:
    CellType const &make() const;
    FaceRings const &makeRings() const;
    void makeCell(FarExt::internal::CellPatch &cell) const;
    CellType::BorderItem makeLatticeItem(FarExt::internal::CellPatch const &cell,
                                         PatchCorners const &corners, int const *turns,
                                         std::size_t item) const;

    PlainFaceTypes &_types;
    std::pmr::string const _key;
    int const _numVerts;
    std::pmr::vector<Run> const _runs;
    int const _numPoints;
    bool const _isInLattice;
    mutable std::atomic<FaceRings const *> _rings{nullptr};
    mutable std::atomic<CellType const *> _type{nullptr};
};

/// The types of plain base faces that have been met with some rules.  Any number of threads may use them.
class PlainFaceTypes {
public:
    PlainFaceTypes(CellTypes &types, RingCells &ringCells) : _types(types), _ringCells(ringCells) {}

    /// Null where there is none.
    PlainFaceType const *Find(PlainFaceKey const &key) const {
        return _entries.Find(std::hash<PlainFaceKey>()(key),
                             [&](PlainFaceType const &type) { return type.HasKey(key); });
    }
    PlainFaceType const &Add(PlainFaceKey const &key, int numVerts, GrowingPatch const &patch);
    /// How many have no CellType yet.
    std::size_t GetNumUnmade() const { return _numUnmade; }

private:
    friend class PlainFaceType;

    struct Destroy {
        void operator()(PlainFaceType const *type) const { type->~PlainFaceType(); }
    };

    CellTypes &_types;
    RingCells &_ringCells;
    // Of the entries, with keys and runs: benchmark making surfaces, irregular, is 1.2 times as fast.  Locked by the mutex.
    std::pmr::monotonic_buffer_resource _memory;
    std::mutex _mutex;
    EntryTable<PlainFaceType, Destroy> _entries;
    std::atomic<std::size_t> _numUnmade{0};
};

/// \brief Gathers the control points of plain base faces.  One thread uses it at a time.
class PlainFaceGatherer {
public:
    using Index = Far::Index;

    /// \brief Finds the type of a face among some, and adds it where there is none.
    ///
    /// \param walk    of the surface level of a mesh, or of the values of a channel; another one may follow
    /// \param points  the control points, and behind these the turns of FindBaseCellTurns(): a vector, or what has
    ///                resize() and data() as that
    /// \return        null where the face is not plain, or may not be; then the points are of no use
    template <typename POINTS>
    PlainFaceType const *Find(PlainFaceTypes &types, FaceWalk const &walk, Index face,
                              POINTS &points) {
        PlainFaceType const *const type = findType(types, walk, face);
        if (!type) {
            return nullptr;
        }
        points.resize(std::size_t(type->GetNumPoints()) + 2 * std::size_t(_faceSize));
        return writeFace(walk.GetLevel(), face, *type, points.data()) ? type : nullptr;
    }

private:
    // A vertex all of whose faces are in the patch, these beginning at a place of their own.
    struct Vertex {
        Index GetPlace(int face) const {
            Index const place = begin + face;
            return place < fan.end ? place : place - fan.GetNumFaces();
        }

        Index vert;
        Index begin;
        FaceWalk::Fan fan;
    };

    PlainFaceType const *findType(PlainFaceTypes &types, FaceWalk const &walk, Index face);
    bool writeFace(FarExt::internal::Level const &level, Index face, PlainFaceType const &type,
                   Index *points);
    bool findVertices(FarExt::internal::Level const &level, Index face);
    bool addSizes(FarExt::internal::Level const &level);
    bool writePoints(PlainFaceType const &type, Index *points);
    void writeTurns(FarExt::internal::Level const &level, Index face, Index *turns) const;

    static constexpr std::size_t kNumStamps = 4096;

    FaceWalk::Arrays const *_arrays = nullptr; // of the level
    int _faceSize = 0;
    int _numVerts = 0;
    Vertex _verts[GrowingPatch::kMaxInner] = {};
    PlainFaceKey _key;
    GrowingPatch _patch;
    // By the last digits of points: the number of the search in which there was one.
    std::uint16_t _stamps[kNumStamps] = {};
    std::uint16_t _search = 0;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
