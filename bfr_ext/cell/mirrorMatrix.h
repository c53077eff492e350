// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_MIRROR_MATRIX_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_MIRROR_MATRIX_H

#include "placeKernel.h"
#include "symmetries.h"

#include <array>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The stencils of the places of a base face that symmetries map onto itself: with two of these
/// they take a fourth of the products that a PlaceMatrix takes.
///
/// A symmetry exchanges points, and it exchanges places.  The sums of the points that it exchanges are
/// *even* under it and make the even part of what the places have; the differences are *odd* and make
/// the odd part.  So with n symmetries there are 2^n *parities*, bit i of which says whether something is
/// odd under symmetry i.  Each has a matrix of its own, with a column for each sum of points and a
/// row for each *slot*, which is all places that are images of one another.  The parts of a slot, each
/// added or subtracted, are what its places have.
///
/// Places whose stencils are no images of each other, though they are, have slots of their own.
template <typename REAL>
class MirrorMatrix {
public:
    static constexpr std::size_t kMaxImages = Symmetries::kMaxImages;
    static constexpr std::size_t kMaxPoints = 64;

    /// \brief Points that are images of one another, and the columns of their sums, each of a parity.
    ///
    /// With two points it is their sum and their difference; with four those of the first two and of
    /// the last two, first the sums and then the differences of these.
    struct Orbit {
        int size; ///< 1, 2 or 4
        std::array<int, kMaxImages> points;
        std::array<int, kMaxImages> columns;
    };
    /// What makes the parts of one parity.
    struct Part {
        PlaceMatrix<REAL> matrix; ///< by slot, as a PlaceMatrix has places
        std::size_t firstColumn;  ///< in the sums of points
    };
    /// The place that an image of a slot is.
    struct Target {
        int slot; ///< in its block, and kMaxWidth of PlaceMatrix for each image before it
        int place;
    };
    /// \brief Those of a block of the matrices.
    ///
    /// They may be written one behind the other with a number too much, and then those of the next
    /// block: it stands where one is written afterwards.
    struct Targets {
        std::vector<Target> followed; ///< ascending by place
        std::vector<Target> others;
    };

    /// \param symmetries  of a type with kMaxPoints points at most
    /// \param places      of these, from place \p first on stencils are given; the number of a place in
    ///                    results is that beyond the first
    /// \param stencils    by place, from the first on
    /// \param parity      of the stencils: bits say under which symmetries what they make turns its sign
    MirrorMatrix(Symmetries const &symmetries, std::vector<BasePoint> const &places,
                 std::size_t first, std::vector<std::vector<double>> const &stencils,
                 std::size_t parity);

    std::size_t GetNumPoints() const { return _numPoints; }
    std::vector<Orbit> const &GetOrbits() const { return _orbits; }
    /// By parity; all have the same slots.
    std::vector<Part> const &GetParts() const { return _parts; }
    Targets const &GetTargets(std::size_t block) const { return _targets[block]; }

private:
    void findTargets(std::vector<int> const &ofPlaces, std::size_t numSlots, std::size_t numImages);
    void findOrbits(Symmetries const &symmetries);
    std::vector<double> findParts(std::vector<double> const &stencil) const;

    std::size_t _numPoints;
    std::vector<Orbit> _orbits;
    std::vector<std::size_t> _firstColumns; // by parity; then their end
    std::vector<Part> _parts;
    std::vector<Targets> _targets;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
