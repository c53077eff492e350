// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_OBJ_TAGS_H
#define OPENSUBDIVHEX_TOOLS_OBJ_TAGS_H

#include "mesh.h"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Tools::internal {

/// \brief Reads the tag lines of OpenSubdiv's own shape files: `t NAME I/F/S`, then I ints, F
/// floats and S strings.
///
/// | name                           | arguments                                                   |
/// |--------------------------------|-------------------------------------------------------------|
/// | crease                         | pairs of vertices; one sharpness, or one for each pair      |
/// | corner                         | vertices; one sharpness, or one for each vertex             |
/// | hole                           | faces                                                       |
/// | interpolateboundary            | 0 none, 1 edge and corner, 2 edge only                      |
/// | facevaryinginterpolateboundary | Sdc::Options::FVarLinearInterpolation, 0 to 5               |
/// | facevaryingpropagatecorners    | 1: FVAR_LINEAR_CORNERS_PLUS1 becomes .._PLUS2; else 0       |
/// | creasemethod                   | normal or chaikin                                           |
/// | smoothtriangles                | whatever: it is about Catmull-Clark alone, and left out     |
///
/// Vertices and faces are counted from 0, and no sharpness is negative.  As in OpenSubdiv, of several
/// lines about the same thing the last holds.  All functions throw FileError, with the line, for what
/// is not in this table.
class ObjTagReader {
public:
    explicit ObjTagReader(std::string const &path) : _path(path) {}

    /// Reads a line, given without its `t`.
    void Read(int line, std::string_view text);

    /// Checks the indices against the faces of \p mesh and gives it the tags.
    void Finish(Mesh *mesh) const;

private:
    struct Tag {
        int line = 0;
        std::string_view name;
        std::vector<int> ints;
        std::vector<float> floats;
        std::vector<std::string_view> strings;
    };
    struct Sharpness {
        int line;
        float value;
    };
    using Edge = std::pair<int, int>;

    [[noreturn]] void refuse(int line, std::string const &cause) const;
    Tag parse(int line, std::string_view text) const;
    int onlyInt(Tag const &tag, int maxValue) const;
    Sharpness sharpness(Tag const &tag, std::size_t i) const;
    void checkSharpness(Tag const &tag) const;
    void readCreases(Tag const &tag);
    void readCorners(Tag const &tag);
    void readHoles(Tag const &tag);
    void readBoundary(Tag const &tag);
    void readCreasingMethod(Tag const &tag);
    void checkEdges(Mesh const &mesh) const;

    std::string const &_path;
    std::map<Edge, Sharpness> _creases; ///< by vertices, the lower first
    std::map<int, Sharpness> _corners;
    std::map<int, int> _holes; ///< lines by face
    bool _propagatesCorners = false;
    bool _hasSmoothTriangles = false;
    MeshTags _rules; ///< of which the optional members
};

} // namespace OpenSubdivHex::Tools::internal

#endif
