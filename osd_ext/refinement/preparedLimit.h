// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_LIMIT_H
#define OPENSUBDIVHEX_OSD_EXT_REFINEMENT_PREPARED_LIMIT_H

#include "latticeLimit.h"
#include "limitKernel.h"
#include "limitRowWeights.h"

#include "far_ext/limit/limitOrigins.h"

#include <cstdint>
#include <vector>

namespace OpenSubdivHex::OsdExt::internal {

/// TooLarge where the places of vertices, as in RegularFaceGroup, do not fit into 32 bits in a level.
FarExt::CallStatus CheckLimitPlaces(int level, std::int64_t numVertices);

/// \brief The limit of a level prepared for evaluation.
///
/// Vertices in lattice faces are made from level 0.  Else most are F-vertices of regular faces of a level
/// before: their limit is made from the values of the level of their face, so that a frame needs no
/// values of the last level for them.  Nearly all
/// else are vertices of F-faces, of the level or of one before.  What is kept for them is the faces.
/// The others are stencils of vertices of the last level, whose weights are those of their type: so what
/// a frame reads is mostly indices.
class PreparedLimit {
public:
    /// Elements of all vertices of the level: points, and behind them du and dv or nothing.
    using Outputs = std::vector<Elements<float>>;

    /// Prepares side 0 of each vertex of the level of \p rows, a level of \p mesh.
    /// \return  as LimitRows, or CheckLimitPlaces() of a level
    FarExt::CallStatus Prepare(FarExt::internal::MeshLevels const &mesh,
                               FarExt::HexSchemeOptions const &schemeOptions,
                               FarExt::internal::LimitRows &rows);

    /// \brief Writes the outputs of those vertices whose limit follows from \p level, and of others that
    /// are in faces of the level: later levels must come behind.
    ///
    /// \param values        of \p level
    /// \param isReadBehind  whether one float may be read behind the last of them
    void Evaluate(int level, Elements<float const> values, bool isReadBehind, int length,
                  Outputs const &outputs) const;
    /// \brief Writes the outputs of vertices that follow from level 0 and none between, behind those that
    /// Evaluate() writes.
    ///
    /// \param values  of level 0, of which one float may be read behind the last
    void EvaluateLattice(Elements<float const> values, int length, Outputs const &outputs) const;

    /// Whether the limit of any vertex follows from a level.
    bool IsNeeded(int level) const {
        LevelLimit const &ofLevel = _levels[std::size_t(level)];
        return !ofLevel.sets.empty() || !ofLevel.vertexGroups.empty() ||
               (level == 0 && !_lattice.IsEmpty());
    }
    /// The last level that is needed.
    int GetLastLevel() const;

private:
    /// Faces of a level that have a mask in common.
    struct FaceSet {
        std::vector<RegularFaceGroup> groups;
        Far::Index firstVertex; ///< that of corner 0
        RegularLimitWeights<Scalar> weights;
    };
    struct LevelLimit {
        FarExt::internal::Level const *level;
        std::vector<FaceSet> sets;
        std::vector<VertexGroup> vertexGroups;
        FarExt::internal::Buffer<std::uint32_t> places; ///< of the sources of these
    };

    static void prepareFaces(FarExt::internal::RegularFaces::OfLevel const &faces,
                             LevelLimit &result);
    void prepareVertices(FarExt::internal::LimitOrigins const &origins, LevelLimit &result);
    void evaluateFaces(LevelLimit const &ofLevel, LimitTask const &common) const;

    static LimitTask makeTask(Elements<float const> values, bool isReadBehind, int length,
                              Outputs const &outputs);

    LatticeLimit _lattice;
    std::vector<LevelLimit> _levels;
    LimitRowWeights _weights; // of vertices
};

} // namespace OpenSubdivHex::OsdExt::internal

#endif
