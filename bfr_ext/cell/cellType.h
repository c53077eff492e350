// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_CELL_TYPE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_CELL_TYPE_H

#include "halfCell.h"
#include "packedCell.h"
#include "patternTable.h"
#include "stepMatrix.h"

#include "far_ext/limit/cellPatch.h"
#include "far_ext/patch/cellPatchPoints.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

class CellTypes;
class PlainFaceTypes;
class RingCells;
struct RingItem;

/// The inputs of a cell's surface besides its patch.
struct CellRules {
    Sdc::Options sdcOptions;
    FarExt::HexSchemeOptions hexSchemeOptions; ///< those of the steps to the limit
    FarExt::Interpolation interpolation = FarExt::Interpolation::Vertex;
};

/// Sources of stencils.
enum class StencilOf {
    Points, ///< of a type
    Step    ///< what the step of the type makes, by row of CellType::GetStep()
};

/// \brief All cells whose patches look alike: what the surface in them is in terms of the vertices of
/// the patch, its *points*.
///
/// The cells that a step makes of such a cell are of the same types each; and since patches repeat
/// themselves some steps on, a few types are all that a base face leads to, however deep.  What is
/// asked for is computed once.  Any number of threads may ask.
class CellType {
public:
    /// A cell that a step makes.
    struct Child {
        std::size_t GetHeapSize() const { return step.GetHeapSize(); }

        CellType const *type;
        ChildStep step; ///< its points in terms of the parent's
    };

    /// \param packed  the cell of PackCell(), with anything behind it
    CellType(CellTypes &types, FarExt::internal::CellPatch const &cell, std::string packed,
             CellRules const &rules);

    /// A number that no other type has, nor has had: addresses come again.
    std::uint64_t GetNumber() const { return _number; }
    /// As it is packed.
    std::string const &GetPackedCell() const { return _packedCell; }
    /// The cell, whose vertices are the sources of their patch; made at each call.
    FarExt::internal::CellPatch MakeCell() const { return UnpackCell(_packedCell); }
    FarExt::internal::CellKind GetKind() const { return _kind; }
    /// Whether it has sectors: it is of a base face, or of the F-face that comes of it.
    bool IsWhole() const { return _kind == FarExt::internal::CellKind::Whole || IsHalfPolygon(); }
    bool IsHalfPolygon() const { return _kind == FarExt::internal::CellKind::HalfPolygon; }
    /// The shape of a whole cell; of size 0 of others.
    FaceShape GetShape() const {
        return IsWhole() ? FaceShape(GetNumCorners(), IsHalfPolygon()) : FaceShape();
    }
    bool IsLongEdge() const { return _kind == FarExt::internal::CellKind::LongEdge; }
    int GetNumCorners() const { return _numCorners; }
    int GetNumPoints() const { return _numPoints; }

    /// \brief Whether the patch is a piece of a regular lattice of triangles, quads or hexagons, without
    /// a feature.
    ///
    /// There are few such types, which most faces and edges of many meshes are of.
    bool IsInLattice() const { return _isInLattice; }
    /// Whether the patch has a sharp or semi-sharp edge or vertex, or a boundary that is not free.
    bool IsSharp() const { return _isSharp; }
    /// How many faces of a size meet at a vertex of a lattice; 0 where there is none.
    static constexpr int GetLatticeValence(int faceSize) {
        return faceSize == 3 ? 6 : faceSize == 4 ? 4 : faceSize == 6 ? 3 : 0;
    }
    /// Whether the surface has bounded curvature where the lattice is regular.
    bool HasBoundedCurvature() const {
        return _rules.hexSchemeOptions.faceMask != FarExt::FaceMask::Average &&
               _rules.interpolation == FarExt::Interpolation::Vertex;
    }

    /// Whether it is continuous there.
    bool HasContinuousCurvature() const {
        return _rules.hexSchemeOptions.faceMask == FarExt::FaceMask::Smooth &&
               _rules.interpolation == FarExt::Interpolation::Vertex;
    }

    /// Children are in the order of RefineCell().
    std::vector<Child> const &GetChildren() const {
        std::call_once(_onceChildren, [&] { makeChildren(nullptr); });
        return _children;
    }
    /// Makes the children, if they are not made, of what RefineCell() makes of the cell.
    void MakeChildren(FarExt::internal::CellRefinement const &refinement) const {
        std::call_once(_onceChildren, [&] { makeChildren(&refinement); });
    }
    /// The points that the children have, in terms of those of the type.
    StepMatrix const &GetStep() const {
        GetChildren();
        return _step;
    }
    /// Whether all children are of this type, too: so is every cell of a regular lattice.
    bool IsRegular() const;

    /// Whether the surface is known at the corners.
    bool HasCorners() const { return !GetCornerPoints().empty(); }
    /// The surface there, by corner, as sums of points.
    std::vector<std::vector<double>> const &GetCornerPoints() const;

    /// Derivatives by two coordinates: those of HalfCell or, in a whole cell, of the sector FaceShape::GetSectorOfCorner().
    struct Derivatives {
        std::size_t GetHeapSize() const { return GetHeapSizes(rows[0], rows[1]); }

        std::vector<double> rows[2];
    };
    /// \brief The derivatives of the surface at a corner of a cell.
    ///
    /// \param of           what they are sums of
    /// \param areParents  whether they are those of the cell that has made this one, which differ where steps make
    ///                    derivatives grow or shrink
    Derivatives const &GetDerivatives(int corner, StencilOf of = StencilOf::Points,
                                      bool areParents = false) const;

    /// \brief An edge or a vertex of a base face, with which of the face's points its points are.
    struct BorderItem {
        std::size_t GetHeapSize() const { return internal::GetHeapSize(points); }

        CellType const *type;
        std::vector<int> points;
        bool isReversed;       ///< whether the edge runs against the face
        RingItem const *rings; ///< of its type; null where that has none
    };
    /// \brief Returns an item that a base face shares with its neighbours: an edge, or behind the edges a vertex.
    ///
    /// No lock is taken for what was asked for before.
    ///
    /// \param turns  those of FindBaseCellTurns()
    BorderItem const &GetBorderItem(int const *turns, std::size_t item) const;
    /// Finds an item in a table, which gets all items that make() gives with a type, if it has not this one.
    template <typename MAKE>
    static BorderItem const &FindBorderItem(PatternTable &table, int const *turns, std::size_t item,
                                            MAKE const &make) {
        auto const get = [&](std::size_t i, auto const &makeItem) -> BorderItem const & {
            int const key[2] = {int(i), turns[i]};
            return table.Get<BorderItem>(PatternTable::GetKind<double>(PatternOf::BorderItem), key,
                                         key + 2, makeItem);
        };
        return get(item, [&] {
            std::vector<BorderItem> const items = make();
            for (std::size_t i = 0; i < items.size(); ++i) {
                if (i != item && items[i].type) {
                    get(i, [&] { return items[i]; });
                }
            }
            return items[item];
        });
    }
    /// \brief The points of the Gregory patches of a cell, as FarExt::internal::FindCellPatchPoints() has them;
    /// not numbers where it has no limit at a corner.
    std::vector<double> FindPatchPoints(FarExt::internal::PatchAges const &ages) const;
    /// The matrices of this type, made on demand.
    PatternTable &GetPatterns() const { return _patterns; }
    /// Counts what its types take.
    MemoryCount &GetMemory() const;

private:
    void makeChildren(FarExt::internal::CellRefinement const *known) const;
    void findDifferences(int corner, int numSteps, std::vector<double> (&result)[2]) const;
    Derivatives findEarlierDerivatives(int corner) const;
    std::optional<FarExt::internal::LimitMask::Tangents> findTangents(int corner) const;

    CellTypes &_types;
    std::uint64_t const _number;
    std::string const _packedCell;
    FarExt::internal::CellKind const _kind;
    int const _numCorners;
    int const _numPoints;
    bool const _isInLattice;
    bool const _isSharp;
    CellRules const _rules;
    mutable std::once_flag _onceChildren;
    mutable std::vector<Child> _children;
    mutable StepMatrix _step;
    mutable std::once_flag _oncePoints;
    mutable std::vector<std::vector<double>> _points;
    mutable PatternTable _patterns;
};

/// \brief The types that have been met, all of which stay until these go.  Any number of threads may use it; types that are
/// there are found without a lock, and none is held while something is made.
class CellTypes {
public:
    /// With a count of their own.
    CellTypes() : CellTypes(std::make_shared<MemoryCount::Total>(0)) {}
    /// \param memory  of which what they take is a part
    explicit CellTypes(std::shared_ptr<MemoryCount::Total> memory);
    ~CellTypes();

    /// The type of a cell, which belongs to these types.
    CellType const &Find(FarExt::internal::CellPatch const &cell, CellRules const &rules);
    /// The types of plain base faces with some rules.
    PlainFaceTypes &GetPlainFaces(CellRules const &rules);
    /// Products of the first step of plain faces with some rules.
    RingCells &GetRingCells(CellRules const &rules);
    /// Calls use(finder) with a finder of masks that no other thread uses, and which knows masks of other cells.
    void UseMaskFinder(CellRules const &rules,
                       std::function<void(FarExt::internal::LimitMaskFinder &)> const &use);
    /// As FindCornerLimits(), with what other cells found.
    std::vector<FarExt::internal::CornerLimit> FindLimits(FarExt::internal::CellPatch const &cell,
                                                          CellRules const &rules);
    /// The number of types.  Types of plain base faces count even while nobody has asked for more of them.
    std::size_t GetSize() const;
    /// The memory of all this, without the masks of FindLimits().
    MemoryCount &GetMemory() { return _memory; }

private:
    using Key = std::string;
    struct Entry {
        std::size_t const hash;
        CellType const type;
    };
    struct OfRules;

    static void addRules(CellRules const &rules, Key &key);
    OfRules &getRules(CellRules const &rules);

    MemoryCount _memory;
    EntryTable<Entry> _types;
    std::atomic<std::size_t> _numTypes{0};
    mutable std::mutex _mutex;
    std::unordered_map<Key, std::unique_ptr<OfRules>> _rules;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
