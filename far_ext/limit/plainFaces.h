// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_FACES_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_PLAIN_FACES_H

#include "limitRows.h"
#include "rowSteps.h"

#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The faces of a level around which there is no feature, by types of neighbourhoods, and the limit at
/// all vertices of a later level that lie in them, as sums of vertices of their own level.
///
/// Faces of a type have the same rows, whatever the mesh is further out.  One step behind level 0 there are
/// few types, mostly: faces have irregular vertices, but none of those beside these.
class OPENSUBDIVHEX_API PlainFaces {
public:
    using Index = Far::Index;

    struct Type {
        int numSources;
        int numOutputs;
        std::vector<PatchWeights> rows; ///< by output
        Index sample;                   ///< the number of its first face
    };
    struct Face {
        int type;
        std::size_t firstSource; ///< in GetSources()
        std::size_t firstOutput; ///< in GetOutputs()
    };

    /// \brief Finds the faces of a level some steps before the last one, and the vertices that they make.
    ///
    /// \param mesh    is referred to
    /// \param level   the last one, for which CheckLimitLevel() is well
    /// \param isMade  a mark for each vertex of the level that is made otherwise; empty where none is
    PlainFaces(MeshLevels const &mesh, int level, std::vector<unsigned char> isMade);

    /// \brief Finds the rows of all types, and in \p rows, which are of the last level, those of the other
    /// vertices.
    CallStatus FindRows(HexSchemeOptions const &schemeOptions, LimitRows &rows);

    /// The level of the faces.
    int GetLevel() const { return _level; }
    std::vector<Type> const &GetTypes() const { return _types; }
    std::vector<Face> const &GetFaces() const { return _faces; }
    Index const *GetSources(Face const &face) const { return _sources.data() + face.firstSource; }
    /// \brief The vertices that a face makes, by output; INDEX_INVALID for one that is made by a face
    /// before, or otherwise.
    Index const *GetOutputs(Face const &face) const { return _outputs.data() + face.firstOutput; }
    /// The other vertices of the last level, ascending.
    std::vector<Index> const &GetOthers() const { return _others; }

private:
    struct Candidates;

    void findFaces();
    bool makesAny(Index face, std::vector<Index> &outputs) const;
    void keepSharedTypes(std::vector<Candidates> const &ofRanges);
    void listOutputs(Index face, std::vector<Index> &outputs) const;
    void setOutputs();
    void claimOutputs();

    MeshLevels const &_mesh;
    int const _last;
    int const _level;
    std::vector<unsigned char> _isMade;
    std::vector<Type> _types;
    std::vector<Face> _faces;
    std::vector<Index> _indices; // of the faces in their level
    std::vector<Index> _sources;
    Buffer<Index> _outputs;
    std::vector<std::vector<Index>> _samples; // by type, what its sample makes
    std::vector<Index> _others;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
