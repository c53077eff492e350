// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FAR_EXT_TAGGED_MATCH_H
#define OPENSUBDIVHEX_REGRESSION_FAR_EXT_TAGGED_MATCH_H

#include "far_ext/topologyRefiner.h"
#include "regression/reference/taggedReference.h"
#include "regression/shapes/shapes.h"

#include <map>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A shape with its tags, or one of its face-varying channels, refined by the reference, and
/// which of the library's components its components are.
///
/// The matching follows what faces were made from and the documented order of their vertices; that
/// it is one to one shows that both have the same topology.
class TaggedMatch {
public:
    /// Matches the levels of \p refiner, all with full topology; \p channel is negative for the
    /// mesh itself.  Failures are reported by GetError().
    ///
    /// In a coplanar refinement the edges that make quads are read off the library's levels;
    /// \p closeGaps is its option.
    TaggedMatch(Shape const &shape, FarExt::TopologyRefiner const &refiner, int channel = -1,
                bool closeGaps = true);

    /// Empty when every component has its partner, and the same tags.
    std::string const &GetError() const { return _error; }

    int GetMaxLevel() const { return int(_levels.size()) - 1; }
    TaggedMesh const &GetMesh(int level) const { return _levels[level]; }
    /// The library's face that a face is, or is half of, and which half; -1 for all of it.
    int GetLibraryFace(int level, int face) const { return _places[level][face].face; }
    /// By corner of a face, that of the library's face.
    std::vector<int> const &GetLibraryCorners(int level, int face) const {
        return _places[level][face].corners;
    }
    int GetLibraryHalf(int level, int face) const {
        Place const &place = _places[level][face];
        bool const isWhole = int(place.corners.size()) ==
                             _refiner.GetLevel(level).GetFaceVertices(place.face).size();
        return isWhole ? -1 : GetHalf(place);
    }
    /// The library's number of an edge of a level's mesh; negative for a diagonal, which has none.
    int GetLibraryEdge(int level, TaggedMesh::Edge const &edge) const;

    /// Values of all levels from those of the base, rows in the library's order.
    std::vector<ReferenceValues> InterpolateAll(ReferenceMask mask,
                                                ReferenceValues const &base) const;
    std::vector<ReferenceValues> InterpolateVaryingAll(ReferenceValues const &base) const;

private:
    /// The face of the library that a face is, or is half of, and its corners there.
    struct Place {
        int face = -1;
        std::vector<int> corners;
    };

    /// The half, for a place that is half a face.
    static int GetHalf(Place const &place) { return place.corners[0] == 0 ? 0 : 1; }

    /// The library's V-faces, by their vertices from the F-vertex with the lowest index on; -1 for a
    /// V-vertex.
    using VFaces = std::map<std::vector<int>, int>;

    void makeBase(Shape const &shape);
    ReferenceStep makeStep(int level) const;
    VFaces findVFaces(int level) const;
    Place placeOfVFace(TaggedMesh::Face const &face, VFaces const &vFaces, int level) const;
    Place placeOfHalfVFace(std::vector<int> const &vertices, int level) const;
    Place placeOf(TaggedMesh::FaceOrigin const &origin, FarExt::TopologyLevel const &pLevel,
                  int level) const;
    bool matchFaces(int level);
    bool matchVertices(int level);
    bool matchEdges(int level);
    bool fail(int level, std::string const &cause);
    template <typename STEP>
    std::vector<ReferenceValues> interpolate(ReferenceValues const &base, STEP const &step) const;

    FarExt::TopologyRefiner const &_refiner;
    int _channel;
    bool _closeGaps;
    std::vector<TaggedMesh> _levels;
    ReferenceCuts _cuts; ///< of a truncation
    std::vector<std::vector<Place>> _places;
    std::vector<std::vector<int>> _vertices; ///< the library's, of the mesh or of the values
    std::vector<int> _valuesOfVertices;      ///< of a channel at level 0
    std::string _error;
};

} // namespace OpenSubdivHex::Regression

#endif
