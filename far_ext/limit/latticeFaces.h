// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_FACES_H
#define OPENSUBDIVHEX_FAR_EXT_LIMIT_LATTICE_FACES_H

#include "latticePatch.h"
#include "limitRows.h"
#include "rowSteps.h"

#include <array>
#include <optional>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The faces of level 0 around which the mesh is a regular lattice of triangles, of quads or of
/// hexagons, and the limit at all vertices of a level that lie in them, as sums of vertices of level 0.
///
/// So no level between has to be refined for them; and the vertices in a face, which are many, depend
/// on the same 27 to 42.  RegularFaces have the other end: hexagons among hexagons, as deep levels are.
class OPENSUBDIVHEX_API LatticeFaces {
public:
    using Index = Far::Index;

    /// \brief Vertices in a face that its symmetries exchange: one for each corner on an axis, or two.
    struct Orbit {
        bool isPair;
        /// The point of the first vertex and two derivatives, by place of the patch: of a pair du and
        /// dv, of the vertices of an axis those along it and across.  Those of the next vertices are
        /// turned by the places, those of the mirror images of a pair are mirrored.
        std::vector<LimitWeights> weights;
        /// du, and dv, of the mirror images, or of the vertices of an axis, in terms of these
        /// derivatives.
        double derivatives[2][2];
    };

    /// \brief The faces of one size, and what they have in common.
    struct Set {
        LatticePatch patch;
        std::vector<Index> faces;
        Buffer<Index> sources; ///< by face, all places of the patch

        std::vector<Orbit> orbits; ///< pairs first
        int numOutputs = 0;        ///< of a face: all vertices of its orbits in turn
        /// \brief By face, the vertices.
        ///
        /// Two neighbouring faces own half of the vertices between them each: in each face, those that are no mirror
        /// images.  A face without a neighbour there owns all.  Slots owned by the neighbouring face hold a duplicate
        /// index, the first vertex of the last orbit, which lies inside: so each vertex is written once or to equal
        /// values.
        Buffer<Index> outputs;
        /// The duplicate index in slots that the neighbouring face owns.
        Index GetStandIn(std::size_t face) const {
            return outputs[(face + 1) * std::size_t(numOutputs) - std::size_t(patch.GetFaceSize())];
        }

        // The rows of vertices of level 0, by place around the edge that is the vertex's first.
        LimitMask vertexMask;
        std::vector<int> vertexPlaces;
        /// These rows as an orbit, if it has an axis.
        std::optional<Orbit> corners;
    };

    /// A corner of a face at which a vertex of level 0 begins, with the first of its edges.
    struct VertexPlace {
        Set const *set;   ///< null where there is no such face
        std::size_t face; ///< in the set
        int corner;
    };

    /// Calls function(weights) for the rows of the vertices of an orbit in turn: all places of the patch.
    template <typename FUNCTION>
    static void ForEachRow(LatticePatch const &patch, Orbit const &orbit, FUNCTION function) {
        for (bool const isMirrored : {false, true}) {
            for (int turns = 0; turns < patch.GetFaceSize() && (orbit.isPair || !isMirrored);
                 ++turns) {
                function(getRow(patch, orbit, isMirrored, turns));
            }
        }
    }

    /// Finds the faces, and the vertices of \p level in them.  \p mesh is referred to; where any step
    /// up to the level is not hexagonal there are none.
    LatticeFaces(MeshLevels const &mesh, int level);

    /// \brief Finds the orbits and their weights, and which vertices they make.
    ///
    /// Where the weights do not have the symmetries of the face there are none.
    /// \param rows  of the level; they are found for what is needed here
    CallStatus FindMasks(HexSchemeOptions const &schemeOptions, LimitRows &rows);

    std::vector<Set> const &GetSets() const { return _sets; }
    /// Vertices of level 0 whose rows follow from the lattice, ascending.
    std::vector<Index> const &GetVertices() const { return _verts; }
    VertexPlace FindPlace(Index vert) const;
    /// The row of one of these, in terms of level 0.  Valid until \p sources is used again.
    LimitRow GetRow(Index vert, Index sources[LatticePatch::kMaxPlaces]) const;
    /// A mark for each vertex of the level, whether it is among those or the outputs; empty where none
    /// is.
    std::vector<unsigned char> const &GetMarks() const { return _marks; }

private:
    struct Sample;
    static std::vector<LimitWeights> getRow(LatticePatch const &patch, Orbit const &orbit,
                                            bool isMirrored, int turns);
    void findFaces(int faceSize);
    static void getSources(VertexPlace const &of, Index *sources);
    void setVertexMask(HexSchemeOptions const &schemeOptions, LimitRows const &rows, Index vert,
                       Set &set) const;
    static bool setOrbits(Sample &sample, Set &set);
    void setOutputs(Sample const &sample, Set &set);
    void setVertices();

    MeshLevels const &_mesh;
    int const _level;
    std::vector<Set> _sets;
    std::vector<Index> _verts;
    std::vector<unsigned char> _marks;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
