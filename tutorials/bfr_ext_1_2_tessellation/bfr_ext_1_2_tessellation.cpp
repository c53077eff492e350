// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     Tessellation: each face as fine as it needs to be, and no gaps between them.
//
//     A Bfr::Tessellation is OpenSubdiv's own: it has a rate for each edge of a face, which is the number of
//     its segments, and one or two for the inside.  A LevelTessellation has levels of refinement in place of
//     rates: its facets are the cells of the scheme.  Surfaces take both.  Whoever gives an edge the same
//     rate, or the same level, in both of its faces gets the same points there, to the bit.  So the facets
//     of all faces, made one by one and in any order, are a closed mesh.
//
#include "bfr_ext/surfaceFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"

#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <utility>
#include <vector>

using namespace OpenSubdivHex;

namespace Bfr = OpenSubdiv::Bfr;

namespace {

// Joins the triangles of all faces where points are the same.
class Welder {
public:
    // The triangles of a face, as Bfr::Tessellation and LevelTessellation give them.
    template <class TESSELLATION>
    void Add(BfrExt::Surface<float> const &surface, std::vector<float> const &positions,
             TESSELLATION const &tessellation) {
        std::vector<float> controlPoints(3 * std::size_t(surface.GetNumControlPoints()));
        surface.GatherControlPoints(positions.data(), 3, controlPoints.data(), 3);
        std::vector<std::array<float, 3>> points(std::size_t(tessellation.GetNumCoords()));
        surface.Evaluate(tessellation, controlPoints.data(), 3, points[0].data(), 3);
        std::vector<int> facets(3 * std::size_t(tessellation.GetNumFacets()));
        tessellation.GetFacets(facets.data());
        std::printf("    %d points, %d triangles\n", tessellation.GetNumCoords(),
                    tessellation.GetNumFacets());

        _numFacets += tessellation.GetNumFacets();
        for (int &index : facets) {
            std::array<float, 3> const &point = points[std::size_t(index)];
            index = _numbers.emplace(point, int(_numbers.size())).first->second;
        }
        for (std::size_t i = 0; i < facets.size(); i += 3) {
            for (std::size_t k = 0; k < 3; ++k) {
                _sides.insert({facets[i + k], facets[i + (k + 1) % 3]});
            }
        }
    }

    // Whether every side of a triangle has another that runs the other way.
    bool IsClosed() const {
        bool isClosed = int(_sides.size()) == 3 * _numFacets;
        for (auto const &[start, end] : _sides) {
            isClosed = isClosed && _sides.count({end, start}) == 1;
        }
        std::printf("%d points, %d triangles, %s\n", int(_numbers.size()), _numFacets,
                    isClosed ? "closed" : "with gaps");
        return isClosed;
    }

private:
    std::map<std::array<float, 3>, int> _numbers;
    std::set<std::pair<int, int>> _sides;
    int _numFacets = 0;
};

// By edge of a face, the larger one of the numbers that its faces have.
std::vector<int> findEdgeNumbers(FarExt::TopologyLevel const &base, int face,
                                 int const faceNumbers[]) {
    std::vector<int> numbers;
    for (int const edge : base.GetFaceEdges(face)) {
        int number = 0;
        for (int const edgeFace : base.GetEdgeFaces(edge)) {
            number = std::max(number, faceNumbers[edgeFace]);
        }
        numbers.push_back(number);
    }
    return numbers;
}

} // namespace

int main() {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    if (!refiner) {
        return 1;
    }
    auto const factory = BfrExt::SurfaceFactory::Create(*refiner);
    if (!factory) {
        return 1;
    }
    FarExt::TopologyLevel const &base = refiner->GetLevel(0);

    // Numbers for each face, by whatever tells how fine it is to be.  An edge has that of the finer of
    // its faces.
    int const faceRates[] = {1, 2, 3, 5, 8, 13};
    int const faceLevels[] = {0, 1, 2, 3, 4, 5};
    Welder ofRates;
    Welder ofLevels;
    BfrExt::Surface<float> surface;
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        if (!factory->InitVertexSurface(face, &surface)) {
            return 1;
        }
        // Coordinates are those of Bfr's parameterization of the face, and so are derivatives.
        std::vector<int> rates = findEdgeNumbers(base, face, faceRates);
        rates.push_back(faceRates[face]);
        std::printf("face %d, rate %d:\n", face, faceRates[face]);
        ofRates.Add(
            surface, cube.positions,
            Bfr::Tessellation(surface.GetParameterization(), int(rates.size()), rates.data()));

        std::vector<int> levels = findEdgeNumbers(base, face, faceLevels);
        levels.push_back(faceLevels[face]);
        std::printf("face %d, level %d:\n", face, faceLevels[face]);
        ofLevels.Add(surface, cube.positions,
                     BfrExt::LevelTessellation(surface.GetParameterization(), int(levels.size()),
                                               levels.data()));
    }
    bool const areRatesClosed = ofRates.IsClosed();
    return ofLevels.IsClosed() && areRatesClosed ? 0 : 1;
}
