// SPDX-License-Identifier: Apache-2.0
#include "localSubdivision.h"

#include "far_ext/stencilTableFactory.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace OpenSubdivHex::Regression {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

/// Rings of faces that are looked at around the center.
constexpr int kNumRings = 5;

template <class LEVEL>
int getOrder(LEVEL const &level, MeshCenter center) {
    return center.kind == CenterKind::Vertex ? level.GetVertexFaces(center.index).size()
                                             : level.GetFaceVertices(center.index).size();
}

/// \brief The vertices and faces around a center in an order that depends on their incidence alone:
/// ring by ring, counter-clockwise, from a face (or corner) at the center that comes first.
struct Walk {
    std::vector<int> vertices;
    std::unordered_map<int, int> numbers; ///< the place of each in vertices
    std::vector<std::vector<int>> faces;  ///< by the numbers of their vertices

    /// Two neighbourhoods with the same faces are the same.
    template <class LEVEL>
    Walk(LEVEL const &level, MeshCenter center, int first) {
        struct Step {
            int face;
            int corner; // where to begin in it
            int ring;
        };
        std::deque<Step> steps;
        std::unordered_set<int> seen;
        if (center.kind == CenterKind::Vertex) {
            Far::ConstIndexArray const around = level.GetVertexFaces(center.index);
            for (int i = 0; i < around.size(); ++i) {
                int const k = (first + i) % around.size();
                steps.push_back({around[k], level.GetVertexFaceLocalIndices(center.index)[k], 1});
                seen.insert(around[k]);
            }
        } else {
            steps.push_back({center.index, first, 0});
            seen.insert(center.index);
        }
        for (; !steps.empty(); steps.pop_front()) {
            Step const step = steps.front();
            Far::ConstIndexArray const faceVertices = level.GetFaceVertices(step.face);
            int const size = faceVertices.size();
            std::vector<int> face;
            for (int i = 0; i < size; ++i) {
                int const corner = (step.corner + i) % size;
                int const number = int(vertices.size());
                auto const [found, isNew] = numbers.insert({faceVertices[corner], number});
                if (isNew) {
                    vertices.push_back(faceVertices[corner]);
                }
                face.push_back(found->second);

                int const edge = level.GetFaceEdges(step.face)[corner];
                Far::ConstIndexArray const sides = level.GetEdgeFaces(edge);
                int const side = sides[0] == step.face ? 1 : 0;
                if (step.ring < kNumRings && seen.insert(sides[side]).second) {
                    steps.push_back(
                        {sides[side], level.GetEdgeFaceLocalIndices(edge)[side], step.ring + 1});
                }
            }
            faces.push_back(std::move(face));
        }
    }
};

/// A vertex as a combination of others, with the interface that primvar refiners ask for.
struct Row {
    using Weights = ChildRow;
    void Clear() { weights.clear(); }
    void AddWithWeight(Row const &other, double weight) {
        for (auto const &[vertex, part] : other.weights) {
            auto const found =
                std::find_if(weights.begin(), weights.end(),
                             [v = vertex](auto const &one) { return one.first == v; });
            if (found == weights.end()) {
                weights.emplace_back(vertex, weight * part);
            } else {
                found->second += weight * part;
            }
        }
    }
    Weights weights;
};

/// Whether a face of the walk touches the center.
bool touchesCenter(std::vector<int> const &face, CenterKind kind, int order) {
    int const numCenterVertices = kind == CenterKind::Vertex ? 1 : order;
    return std::any_of(face.begin(), face.end(),
                       [&](int vertex) { return vertex < numCenterVertices; });
}

/// Steps by which the first place at the child of a center is further around than at the center.
double findTurn(FarExt::SchemeType scheme, FarExt::TopologyLevel const &level, MeshCenter center,
                FarExt::TopologyLevel const &cLevel, MeshCenter child) {
    if (center.kind == CenterKind::Face) {
        // In tri-hex the F-vertex of a corner belongs to the edge that begins there.
        return scheme == FarExt::SchemeType::TriHex ? 0.5 : 0;
    }
    // The faces at a V-vertex are those of the edges; edge i comes half a step before face i.
    int const first = cLevel.GetVertexFaces(child.index)[0];
    int const edge = level.GetVertexEdges(center.index).FindIndex(cLevel.GetFaceParentEdge(first));
    return edge - 0.5;
}

/// \brief Makes the matrix of a center and its child in the next level.
///
/// \param getWeights  by vertex of \p cLevel: vertices of \p level and their weights, as pairs
template <class LEVEL, typename GET_WEIGHTS>
LocalSubdivision makeLocalSubdivision(LEVEL const &level, MeshCenter center, LEVEL const &cLevel,
                                      MeshCenter child, double turn,
                                      GET_WEIGHTS const &getWeights) {
    LocalSubdivision result;
    result.centerKind = center.kind;
    result.order = getOrder(level, center);
    result.turn = turn;

    Walk const walk(level, center, 0);
    Walk const turned(level, center, 1);
    Walk const cWalk(cLevel, child, 0);
    if (cWalk.faces != walk.faces || turned.faces != walk.faces) {
        throw std::runtime_error("the neighbourhood changes from level to level");
    }

    // The neighbourhood, from those at the center on: all vertices that a child depends on.
    std::vector<int> places(walk.vertices.size(), -1); // in the neighbourhood, by number
    std::vector<int> chosen;
    auto const choose = [&](int number) {
        if (places[number] < 0) {
            places[number] = int(chosen.size());
            chosen.push_back(number);
        }
    };
    for (std::vector<int> const &face : walk.faces) {
        if (touchesCenter(face, center.kind, result.order)) {
            std::for_each(face.begin(), face.end(), choose);
        }
    }
    for (std::size_t numDone = 0; numDone < chosen.size();) { // which grows
        int const number = chosen[numDone++];
        for (auto const &[vertex, weight] : getWeights(cWalk.vertices[number])) {
            auto const found = walk.numbers.find(vertex);
            if (found == walk.numbers.end()) {
                throw std::runtime_error("the neighbourhood is too large");
            }
            choose(found->second);
        }
    }

    int const size = int(chosen.size());
    result.matrix = Eigen::MatrixXd::Zero(size, size);
    for (int i = 0; i < size; ++i) {
        for (auto const &[vertex, weight] : getWeights(cWalk.vertices[chosen[i]])) {
            result.matrix(i, places[walk.numbers.at(vertex)]) = weight;
        }
        result.rotation.push_back(places[walk.numbers.at(turned.vertices[chosen[i]])]);
    }
    for (std::vector<int> const &face : walk.faces) {
        std::vector<int> local;
        for (int number : face) {
            if (places[number] >= 0) {
                local.push_back(places[number]);
            }
        }
        if (local.size() == face.size()) {
            result.faces.push_back(std::move(local));
        }
    }
    return result;
}

} // namespace

LocalSubdivision MakeLocalSubdivision(FarExt::HexSchemeOptions const &schemeOptions,
                                      CenterKind baseKind, int order) {
    // Both have other irregularities, at a distance that grows by 2, or by sqrt(3) in tri-hex.
    // Masks do not change any more behind four hexagonal steps.
    int const pDepth = schemeOptions.schemeType == FarExt::SchemeType::TriHex ? 6
                       : schemeOptions.firstStep == FarExt::FirstStep::Same   ? 4
                                                                              : 5;
    Shape const shape = baseKind == CenterKind::Vertex ? MakeBipyramid(order) : MakePrism(order);
    auto const refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                                Sdc::Options(), {schemeOptions});
    FarExt::TopologyRefiner::UniformOptions uniformOptions(pDepth + 1);
    uniformOptions.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(uniformOptions)) {
        throw std::runtime_error("a base mesh cannot be refined");
    }

    // The apex of a bipyramid is its last vertex, the polygon of a prism its last face.
    MeshCenter center{baseKind, baseKind == CenterKind::Vertex ? shape.GetNumVertices() - 1
                                                               : shape.GetNumFaces() - 1};
    for (int depth = 0; depth < pDepth; ++depth) {
        center = FindChild(center, refiner->GetLevel(depth), refiner->GetLevel(depth + 1));
    }
    FarExt::StencilTableFactoryReal<double>::Options tableOptions;
    tableOptions.generateIntermediateLevels = false;
    tableOptions.factorizeIntermediateLevels = false;
    auto const table = FarExt::StencilTableFactoryReal<double>::Create(*refiner, tableOptions);
    auto const getWeights = [&](int cVertex) {
        auto const stencil = table->GetStencil(cVertex);
        Row::Weights weights;
        for (int i = 0; i < stencil.GetSize(); ++i) {
            weights.emplace_back(stencil.GetVertexIndices()[i], stencil.GetWeights()[i]);
        }
        return weights;
    };
    return MakeLocalSubdivision(*refiner, pDepth, center, getWeights);
}

LocalSubdivision MakeLocalSubdivision(FarExt::TopologyRefiner const &refiner, int depth,
                                      MeshCenter center,
                                      std::function<ChildRow(int)> const &getRow) {
    FarExt::TopologyLevel const &level = refiner.GetLevel(depth);
    FarExt::TopologyLevel const &cLevel = refiner.GetLevel(depth + 1);
    MeshCenter const child = FindChild(center, level, cLevel);
    double const turn =
        findTurn(refiner.GetHexSchemeOptions().schemeType, level, center, cLevel, child);
    return makeLocalSubdivision(level, center, cLevel, child, turn, getRow);
}

LocalSubdivision MakeLocalSubdivision(Sdc::SchemeType scheme, int order) {
    constexpr int kParentDepth = 4; // other irregularities are far away by then
    Shape const shape = MakeBipyramid(order);
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    ShapeDescriptor const descriptor(shape);
    std::unique_ptr<Far::TopologyRefiner> const refiner(
        Factory::Create(descriptor.Get(), Factory::Options(scheme, Sdc::Options())));
    if (!refiner) {
        throw std::runtime_error("a base mesh cannot be refined");
    }
    Far::TopologyRefiner::UniformOptions uniformOptions(kParentDepth + 1);
    uniformOptions.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniformOptions);

    MeshCenter center{CenterKind::Vertex, shape.GetNumVertices() - 1};
    for (int depth = 0; depth < kParentDepth; ++depth) {
        center = FindChild(center, refiner->GetLevel(depth), refiner->GetLevel(depth + 1));
    }
    Far::TopologyLevel const &level = refiner->GetLevel(kParentDepth);
    Far::TopologyLevel const &cLevel = refiner->GetLevel(kParentDepth + 1);
    MeshCenter const child = FindChild(center, level, cLevel);

    // A step's rows: each vertex of the level is itself, with a weight of 1.
    std::vector<Row> rows(level.GetNumVertices());
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        rows[vertex].weights = {{vertex, 1.0}};
    }
    std::vector<Row> cRows(cLevel.GetNumVertices());
    Far::PrimvarRefinerReal<double>(*refiner).Interpolate(kParentDepth + 1, rows, cRows);
    // Face i at the center's child lies in that of the center which its parent is.
    int const turn =
        level.GetVertexFaces(center.index)
            .FindIndex(cLevel.GetFaceParentFace(cLevel.GetVertexFaces(child.index)[0]));
    return makeLocalSubdivision(
        level, center, cLevel, child, turn,
        [&](int cVertex) -> Row::Weights const & { return cRows[cVertex].weights; });
}

} // namespace OpenSubdivHex::Regression
