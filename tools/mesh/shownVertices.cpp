// SPDX-License-Identifier: Apache-2.0
#include "shownVertices.h"

#include "far_ext/indexing.h"

#include <algorithm>

namespace OpenSubdivHex::Tools {

namespace {

/// Vertices of faces, marked one by one.
class Marks {
public:
    explicit Marks(int numVertices) : _isMarked(std::size_t(numVertices)) {}

    void Add(int vertex) { _isMarked[std::size_t(vertex)] = true; }

    /// Returns the marked vertices, in ascending order.
    std::vector<int> Find() const {
        std::vector<int> vertices;
        for (std::size_t vertex = 0; vertex < _isMarked.size(); ++vertex) {
            if (_isMarked[vertex]) {
                vertices.push_back(int(vertex));
            }
        }
        return vertices;
    }

private:
    std::vector<bool> _isMarked;
};

/// \p find(areHolesShown), with holes where there is nothing else.
template <typename FIND>
std::vector<int> findShown(FIND find) {
    std::vector<int> vertices = find(false);
    return vertices.empty() ? find(true) : vertices;
}

} // namespace

std::vector<int> FindShownVertices(FarExt::TopologyLevel const &level) {
    return findShown([&level](bool areHolesShown) {
        Marks marks(level.GetNumVertices());
        for (int face = 0; face < level.GetNumFaces(); ++face) {
            auto const vertices = level.GetFaceVertices(face);
            bool const isShown[] = {areHolesShown || !level.IsFaceHole(face, 0),
                                    areHolesShown || !level.IsFaceHole(face, 1)};
            if (isShown[0] && isShown[1]) {
                std::for_each(vertices.begin(), vertices.end(), [&](int v) { marks.Add(v); });
            } else if (isShown[0] || isShown[1]) {
                int const half = isShown[0] ? 0 : 1;
                int const end = level.GetFaceDiagonalEnd(face);
                for (int i = 0; i < FarExt::GetHalfSize(half, vertices.size(), end); ++i) {
                    marks.Add(vertices[FarExt::GetPlaceInHalves(half, i, end)]);
                }
            }
        }
        return marks.Find();
    });
}

std::vector<int> FindShownVertices(Mesh const &mesh) {
    std::vector<bool> isHole(mesh.faceSizes.size());
    for (int const face : mesh.tags.holes) {
        isHole[std::size_t(face)] = true;
    }
    return findShown([&](bool areHolesShown) {
        Marks marks(mesh.GetNumVertices());
        int const *vertices = mesh.faceVertices.data();
        for (std::size_t face = 0; face < isHole.size(); ++face) {
            int const *const end = vertices + mesh.faceSizes[face];
            if (areHolesShown || !isHole[face]) {
                std::for_each(vertices, end, [&](int v) { marks.Add(v); });
            }
            vertices = end;
        }
        return marks.Find();
    });
}

} // namespace OpenSubdivHex::Tools
