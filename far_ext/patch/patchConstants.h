// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CONSTANTS_H
#define OPENSUBDIVHEX_FAR_EXT_PATCH_PATCH_CONSTANTS_H

#include "far_ext/rules/mask.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Numbers that make patches come closer to the limit surface than its derivatives at their corners
/// alone do.  Each depends on what lies around in the topology, its *site*.
enum class PatchQuantity : std::uint8_t {
    Length, ///< of the derivative of a curve at its end, in terms of the limit's
    Blend,  ///< how much more than the limit's the derivative across a curve has in the middle
    /// How much of the derivatives at a vertex are differences to its neighbours along edges, and along
    /// diagonals.
    EdgeShare,
    DiagonalShare
};

/// \brief Key of a constant.
struct PatchSite {
    /// The line from the middle of a side to the centre of a face with kites is a spoke.
    enum Kind : std::uint8_t { kEdge, kDiagonal, kLongBoundary, kSharpEdge, kVertex, kSpoke };
    /// At a vertex: of the surface level with so many faces (kBase + 6: six or more), or made so many steps
    /// before the level (2: or more), or sharp.
    static constexpr std::uint8_t kBase = 10;
    static constexpr std::uint8_t kSharp = 50;
    static constexpr int kMaxFaces = 6;
    static constexpr int kMaxAge = 2;
    static constexpr int kMaxSteps = 3;
    static constexpr int kMaxFaceSize = 8;
    static constexpr int kMaxSurfaceFaceSize = 6;
    /// The ends of a spoke.
    static constexpr std::uint8_t kMiddle = 60;
    static constexpr std::uint8_t kCenter = 61;

    PatchQuantity quantity = PatchQuantity::Length;
    std::uint8_t steps = 0; ///< behind the surface level; kMaxSteps: or more
    Kind kind = kEdge;
    std::uint8_t vert = 0;
    std::uint8_t otherVert = 0; ///< at the other end
    /// Sizes of the faces of an edge, or of that of a spoke; 0 where it has one or none.
    std::uint8_t smallFace = 0;
    std::uint8_t largeFace = 0;
    /// Whether a face of the vertex, and of the other one, is no hexagon.
    bool isBesideOther = false;
    bool isOtherBesideOther = false;
    /// The size of the face of the surface level in which it lies, the least of several; 6: six or more; 0 at
    /// that level.
    std::uint8_t surfaceFace = 0;

    std::uint64_t GetKey() const;
};

/// \brief All constants of a mask: for FaceMask::Smooth those of the first levels that
/// `./dev masks` finds, from the errors of some meshes of quads and truncated ones; else a
/// rule of a few numbers.
class PatchConstants {
public:
    explicit PatchConstants(FaceMask mask);

    double Get(PatchSite const &site) const {
        if (_sites) {
            _sites->push_back(site);
        }
        auto const found = _values.find(site.GetKey());
        return found != _values.end() ? found->second : GetDefault(site);
    }
    /// Replaces that of a site.
    void Set(PatchSite const &site, double value) {
        _values[site.GetKey()] = value;
        _hasShares = _hasShares || site.kind == PatchSite::kVertex;
    }

    /// Has Get() add to \p sites whatever it is asked for, by one thread.
    void Record(std::vector<PatchSite> *sites) { _sites = sites; }

    /// Default of sites without their own constant.
    static double GetDefault(PatchSite const &site);
    /// Whether any vertex has shares.
    bool HasShares() const { return _hasShares; }

private:
    std::unordered_map<std::uint64_t, double> _values;
    bool _hasShares = false;
    std::vector<PatchSite> *_sites = nullptr;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
