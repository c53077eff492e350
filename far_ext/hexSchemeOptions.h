// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_HEX_SCHEME_OPTIONS_H
#define OPENSUBDIVHEX_FAR_EXT_HEX_SCHEME_OPTIONS_H

#include "export.h"

namespace OpenSubdivHex::FarExt {

/// \brief The circulant mask that makes a face's new points (F-vertices) from its vertices.
///
/// With theta_j = 2 pi j / n, the weight of the vertex j places around a face of n sides is
///
/// | mask    | w_0                      | w_j                                                   |
/// |---------|--------------------------|-------------------------------------------------------|
/// | Average | 1/2 + 1/(4n)             | 1/(4n), plus 1/8 for the two neighbours               |
/// | Cosine  | (n + 5)/(4n)             | (3 + 2 cos theta_j)/(4n)                              |
/// | Smooth  | 1/8 + 15/(8n), if n >= 5 | (7/8 + 3/4 cos theta_j + 1/4 cos 2 theta_j)/n, n >= 5 |
///
/// Average is (vertex + its two edge midpoints + centroid)/4, the paper's stage 1 (Ghaleb and
/// Abd El-Latif 2005, section 3).  Cosine is Doo and Sabin's of 1978.  Smooth has eigenvalues
/// 1, 1/2, 1/2, 1/4, 1/4, 1/8 ...; for n < 5 it is Cosine.
///
/// Smooth has masks of its own besides where hexagons meet what is not of the hexagonal lattice, and
/// in quads of the first levels.
enum class FaceMask {
    Average, ///< the paper's: tangent planes, unbounded curvature
    Cosine,  ///< Doo and Sabin's: bounded curvature at vertices with three faces
    Smooth   ///< this project's: bounded curvature at nearly all vertices; for renderers
};

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

/// \brief A step of another kind that makes level 1, whatever the scheme of the levels behind it.
///
/// Both make vertices with three faces each, so that all irregularities are faces, where Cosine and
/// Smooth have bounded curvature.
///
/// - TriHex is one step of the scheme of that name, and refuses what that refuses.
/// - Truncate cuts the corners off: a face of n sides becomes one of 2n, a vertex the polygon of the
///   points beside it on its edges.  Of triangles it makes hexagons.  It takes what the hexagonal
///   scheme takes: boundaries, creases, corners and face-varying data.  INDEXING.md has its numbering.
enum class FirstStep {
    Same,    ///< level 1 is made as the levels behind it
    TriHex,  ///< a step of SchemeType::TriHex
    Truncate ///< for meshes of triangles
};

/// \brief How a level was made of the one before it: by a step of the scheme of that name, or by
/// FirstStep::Truncate.
enum class StepType {
    Hexagonal, ///< of SchemeType::Hexagonal
    DooSabin,  ///< of SchemeType::DooSabin
    TriHex,    ///< of SchemeType::TriHex
    Truncate   ///< FirstStep::Truncate
};

/// \brief Chooses scheme, face mask and first step of a refinement.
///
/// The defaults are the paper's.  Renderers want FaceMask::Smooth and, for meshes of triangles,
/// FirstStep::Truncate:
///
/// \code
///     FarExt::TopologyRefinerFactory::Options options;
///     options.hexSchemeOptions.faceMask = FarExt::FaceMask::Smooth;
///     auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options);
/// \endcode
struct HexSchemeOptions {
    FaceMask faceMask = FaceMask::Average;         ///< of Hexagonal and DooSabin
    SchemeType schemeType = SchemeType::Hexagonal; ///< of all levels, but see firstStep
    FirstStep firstStep = FirstStep::Same;         ///< of level 1

    /// Whether all levels are made by hexagonal steps.
    bool IsHexagonal() const {
        return schemeType == SchemeType::Hexagonal && firstStep == FirstStep::Same;
    }
    /// \brief The *surface level*, at which hexagonal steps begin: 0, or 1 behind a first step.
    ///
    /// It is the first that has limits, and its faces are those of BfrExt::SurfaceFactory.  Of no
    /// meaning where schemeType is not Hexagonal.
    int GetSurfaceLevel() const { return firstStep == FirstStep::Same ? 0 : 1; }
    /// The step that makes level \p level, 1 or more.
    StepType GetStepOfLevel(int level) const {
        if (level == 1 && firstStep != FirstStep::Same) {
            return firstStep == FirstStep::TriHex ? StepType::TriHex : StepType::Truncate;
        }
        switch (schemeType) {
        case SchemeType::Hexagonal:
            break;
        case SchemeType::DooSabin:
            return StepType::DooSabin;
        case SchemeType::TriHex:
            return StepType::TriHex;
        }
        return StepType::Hexagonal;
    }
};

} // namespace OpenSubdivHex::FarExt

#endif
