// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_HEX_SCHEME_OPTIONS_H
#define OPENSUBDIVHEX_FAR_EXT_HEX_SCHEME_OPTIONS_H

#include "mask.h"

namespace OpenSubdivHex::FarExt {

/// \brief The subdivision scheme: which new vertices there are, and how faces join them.
///
/// | scheme      | vertices                  | faces                                              |
/// |-------------|---------------------------|----------------------------------------------------|
/// | Hexagonal   | V' and one per corner     | F-face, a hexagon per edge                         |
/// | DooSabin    | one per corner            | F-face, a quad per edge, a k-gon per vertex        |
/// | TriHex      | one per corner's edge     | F-face (turned half a step), a 2k-gon per vertex   |
///
/// Hexagonal is the vertex-to-vertex scheme of Ghaleb and Abd El-Latif (2005); the others are those
/// that it is compared with: Doo and Sabin (1978), and the corner cutting of Claes, Beets and Van
/// Reeth (2002).  The others drop the faces of border edges and vertices, whatever the boundary
/// option says, and know neither creases nor face-varying data.
enum class SchemeType {
    Hexagonal, ///< hexagonal vertex-to-vertex
    DooSabin,  ///< Doo-Sabin
    TriHex     ///< tri-hex corner cutting
};

/// \brief What distinguishes one refinement from another.
struct HexSchemeOptions {
    FaceMask faceMask = FaceMask::Average;         ///< of Hexagonal and DooSabin
    SchemeType schemeType = SchemeType::Hexagonal; ///< of all levels, but see triHexFirst
    /// Makes level 1 with a TriHex step, whatever the scheme.  All vertices in the interior have
    /// three faces then.
    bool triHexFirst = false;

    /// Whether all levels are made by hexagonal steps.
    bool IsHexagonal() const { return schemeType == SchemeType::Hexagonal && !triHexFirst; }
    /// The scheme that makes level \p level, 1 or more.
    SchemeType GetSchemeOfLevel(int level) const {
        return triHexFirst && level == 1 ? SchemeType::TriHex : schemeType;
    }
};

} // namespace OpenSubdivHex::FarExt

#endif
