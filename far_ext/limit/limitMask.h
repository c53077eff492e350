// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LIMIT_MASK_H

#include "far_ext/vtr/refinementRules.h"
#include "limitPatch.h"

#include <memory>
#include <unordered_map>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Weights of a patch's or a face's vertices for a point of the limit surface, and for the
/// first derivatives there, on each side of the point.  LimitStencilTableFactory says what they are
/// derivatives by.
struct LimitMask {
    struct Tangents {
        std::vector<double> du;
        std::vector<double> dv;
    };
    std::vector<double> weights;
    std::vector<Tangents> sides;
};

/// \brief Finds limit masks of vertices.
///
/// A semi-sharp crease becomes smooth after so many steps as its sharpness says, and two steps
/// after a feature has left the patch all faces there are hexagons or halves of hexagons: then
/// patches repeat themselves after one step or, where A and B edges alternate, a few.  The steps of
/// such a cycle, multiplied, have the eigenvalue 1, whose left eigenvector is the mask of the
/// point, and the next largest eigenvalues, whose left eigenvectors span the masks of the tangents.
///  Steps before are multiplied to that.
///
/// All masks found are kept, so that a patch that looks like one before costs its signature alone.
class LimitMaskFinder {
public:
    LimitMaskFinder(Sdc::Options sdcOptions, HexSchemeOptions const &schemeOptions)
        : _sdcOptions(sdcOptions), _schemeOptions(schemeOptions) {}

    /// Patches of large, irregular base meshes may all be different: when there are more masks than
    /// this, those found so far are forgotten.
    static constexpr std::size_t kMaxMasks = 4096;

    using MaskPointer = std::shared_ptr<LimitMask const>;

    /// \brief Null where the patches do not repeat themselves within kMaxSteps steps, or a step that
    /// repeats itself has no eigenvectors that iteration finds.
    MaskPointer Find(LimitPatch const &patch);

    Sdc::Options GetSdcOptions() const { return _sdcOptions; }
    HexSchemeOptions const &GetSchemeOptions() const { return _schemeOptions; }
    FaceMask GetFaceMask() const { return _schemeOptions.faceMask; }

    /// A patch, and the step that leads to the next.
    struct Node {
        LimitPatch patch;
        PatchRefinement step;
    };

private:
    bool addCycle(std::vector<Node> nodes);
    MaskPointer addStepsBefore(std::vector<Node> const &nodes, MaskPointer mask);

    // Sharpness that is not infinite ends in ten steps, other irregularities in two.
    static constexpr int kMaxSteps = 64;

    Sdc::Options const _sdcOptions;
    HexSchemeOptions const _schemeOptions;
    struct Hash {
        std::size_t operator()(std::vector<int> const &signature) const;
    };
    std::unordered_map<std::vector<int>, MaskPointer, Hash> _masks; ///< by signature
};

/// \brief Finds limit masks of the centres of faces: in closed form, but for faces with sector
/// corners and semi-sharp diagonals, which take steps before.
class FaceLimitMaskFinder {
public:
    FaceLimitMaskFinder(Level const &level, Sdc::Options sdcOptions,
                        HexSchemeOptions const &schemeOptions)
        : _level(level), _sdcOptions(sdcOptions), _schemeOptions(schemeOptions),
          _rules(GetRules(level, schemeOptions, Interpolation::Vertex)) {}

    /// A face with an infinitely sharp diagonal has two sides, half 0 and half 1; other faces have
    /// one.
    LimitMask Find(Far::Index face) const;

    /// Whether a face has the mask of all with its size.
    bool IsPlain(Far::Index face) const {
        return _rules->GetFaceRule(face).IsCirculant() && !hasFlags(face);
    }

private:
    // Whether its F-face may have other masks, as a hexagon may that is made of quads, and any face beside a line.
    bool hasFlags(Far::Index face) const {
        Far::Index const first = _level.faceFirstCorner[face];
        Far::Index const end = _level.faceFirstCorner[face + 1];
        return isBesideLine(face) || (end - first == HexIndexing::kNumEFaceCorners &&
                                      !FindCornerTags(_level.quadCorners, first, end).empty());
    }
    bool isBesideLine(Far::Index face) const {
        Far::Index const first = _level.faceFirstCorner[face];
        Far::Index const end = _level.faceFirstCorner[face + 1];
        return _schemeOptions.faceMask == FaceMask::Smooth &&
               (!FindCornerTags(_level.quadLineCorners, first, end).empty() ||
                !FindCornerTags(_level.lineRowCorners, first, end).empty());
    }
    LimitMask findAfterStep(Far::Index face) const;
    LimitMask stepBack(LimitMask mask, Far::Index face) const;
    std::vector<double> stepBack(std::vector<double> const &cWeights, Far::Index face) const;

    Level const &_level;
    Sdc::Options const _sdcOptions;
    HexSchemeOptions const _schemeOptions;
    std::shared_ptr<RefinementRules const> const _rules;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
