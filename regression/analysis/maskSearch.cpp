// SPDX-License-Identifier: Apache-2.0
#include "maskSearch.h"

#include "evenness.h"
#include "leastSquares.h"
#include "maskedStep.h"
#include "position.h"
#include "ripple.h"

#include "far_ext/rules/mask.h"
#include "far_ext/rules/quadPath.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using FarExt::FaceMask;
using FarExt::FacesAround;
using FarExt::HexSchemeOptions;
using FarExt::IrregularVertexMask;
using FarExt::internal::IrregularCorner;
using FarExt::internal::Level;
using FarExt::internal::RefinementRules;
using Position = PositionReal<double>;

constexpr int kHexagon = 6;
constexpr double kParts = 256;
constexpr int kNumSearchedLevels = FarExt::kNumStepsToConstantMasks - 1;
constexpr int kNumFacesOfQuads = 4; // around a regular vertex

/// Weights of one of the first levels, from 1 on.
struct LevelWeights {
    double atVertex[kHexagon];
    double atNeighbor[kHexagon];
    double besideQuad[FarExt::QuadMask::kNumRows][kHexagon];
};

LevelWeights getWeights(SearchedMasks const &searched, int level, FarExt::QuadMask const &quad) {
    IrregularVertexMask const vertex =
        FarExt::ComputeIrregularVertexMask(searched.numFaces, level, searched.facesAround);
    LevelWeights result;
    std::copy_n(vertex.atVertex, kHexagon, result.atVertex);
    std::copy_n(vertex.atNeighbor, kHexagon, result.atNeighbor);
    for (int i = 0; i < FarExt::QuadMask::kNumRows; ++i) {
        FarExt::ComputeFaceVertexMask(FaceMask::Smooth, FarExt::Interpolation::Vertex, kHexagon,
                                      result.besideQuad[i]);
        if (i < quad.numRows) {
            std::copy_n(quad.beside[i], kHexagon, result.besideQuad[i]);
        }
    }
    return result;
}

/// Calls function(weights, size, free, isSymmetric) for the masks of a level that are searched for: the
/// places of the free weights, or of one of each two in a symmetric mask.
template <typename FUNCTION>
void forEachMask(SearchedMasks const &searched, int level, LevelWeights &weights,
                 FUNCTION const &function) {
    using Places = std::vector<int>;
    bool const isFirst = level == 1;
    bool const isSecond = level == 2;
    if (!searched.AreOfQuads()) {
        if (isFirst || isSecond) {
            function(weights.atVertex, kHexagon, Places{1, 2}, true);
            bool const areTriangles = searched.facesAround == FacesAround::Triangles;
            function(weights.atNeighbor, kHexagon,
                     areTriangles ? Places{1, 4, 5} : Places{1, 2, 3, 4, 5}, false);
        }
        return;
    }
    Places const atVertex = isSecond ? Places{1, 3} : Places{1, 2};
    function(weights.atVertex, kHexagon, atVertex, true);
    Places const besideQuad = isSecond ? Places{1, 3, 4, 5} : Places{1, 3, 4};
    function(weights.besideQuad[0], kHexagon, besideQuad, false);
    if (!isFirst) { // at a neighbor all corners are beside a quad, too, after the first step
        Places const atNeighbor = isSecond ? Places{1, 2, 4, 5} : Places{1, 4, 5};
        function(weights.atNeighbor, kHexagon, atNeighbor, false);
    }
    if (isSecond) {
        function(weights.besideQuad[1], kHexagon, Places{1, 2, 4, 5}, false);
    }
}

using SearchedLevels = std::array<LevelWeights, kNumSearchedLevels>;

MaskWeights gather(SearchedMasks const &searched, SearchedLevels levels) {
    std::vector<double> values;
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        forEachMask(searched, level, levels[std::size_t(level) - 1],
                    [&](double const *mask, int, std::vector<int> const &places, bool) {
                        for (int place : places) {
                            values.push_back(mask[place]);
                        }
                    });
    }
    return Eigen::Map<MaskWeights const>(values.data(), Eigen::Index(values.size()));
}

SearchedLevels getShippedLevels(SearchedMasks const &searched) {
    SearchedLevels levels;
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        levels[std::size_t(level) - 1] =
            getWeights(searched, level, FarExt::ComputeQuadMask(level));
    }
    return levels;
}

SearchedLevels spread(SearchedMasks const &searched, MaskWeights const &weights) {
    SearchedLevels levels = getShippedLevels(searched);
    double const *next = weights.data();
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        forEachMask(searched, level, levels[std::size_t(level) - 1],
                    [&](double *mask, int size, std::vector<int> const &places, bool isSymmetric) {
                        std::fill_n(mask, size, 0.0);
                        for (int place : places) {
                            mask[place] = *next++;
                            if (isSymmetric) {
                                mask[size - place] = mask[place];
                            }
                        }
                        mask[0] = 1 - std::accumulate(mask + 1, mask + size, 0.0);
                    });
    }
    return levels;
}

/// The mask of an irregular corner, from the corner on, and whether it goes backwards; null of one that
/// is not searched for.
struct CornerWeights {
    double const *weights;
    bool isBackwards;
};
CornerWeights findMask(SearchedMasks const &searched, LevelWeights const &weights,
                       IrregularCorner const &irregular) {
    if (!IrregularCorner::IsAtQuad(irregular.kind) &&
        (irregular.numFaces != searched.numFaces ||
         irregular.facesAround != searched.facesAround)) {
        return {nullptr, false};
    }
    switch (irregular.kind) {
    case IrregularCorner::kAtVertex:
        return {weights.atVertex, false};
    case IrregularCorner::kBehindVertex:
        return {weights.atNeighbor, false};
    case IrregularCorner::kBeforeVertex:
        return {weights.atNeighbor, true};
    case IrregularCorner::kAlongQuad:
        return {weights.besideQuad[0], false};
    case IrregularCorner::kBehindQuad:
        return {weights.besideQuad[0], true};
    case IrregularCorner::kOneBehindQuad:
        return {weights.besideQuad[1], false};
    case IrregularCorner::kOneBeforeQuad:
        return {weights.besideQuad[1], true};
    default:
        return {nullptr, false};
    }
}

/// Whether a path tells the mask of a corner.
bool hasQuadMask(Level const &level, int corner) {
    auto const quad = FarExt::internal::FindCornerTags(level.quadCorners, corner, corner + 1);
    return !quad.empty() &&
           FarExt::internal::FindQuadRow(level.numHexagonalSteps, quad.front().flags).mask;
}

/// Faces of a plane around a vertex, lifted by very little to a quadratic form, or to x y.
Shape makeLifted(Tiling tiling, int valence, double xx, double xy, double yy) {
    constexpr int kNumRings = 3;
    constexpr double kHeight = 1e-3; // so that slopes do not matter
    Shape shape = MakeVertexDisk(tiling, valence, kNumRings);
    for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
        double const x = shape.positions[i];
        double const y = shape.positions[i + 1];
        shape.positions[i + 2] = kHeight * (xx * x * x + xy * x * y + yy * y * y);
    }
    return shape;
}

} // namespace

/// A control mesh of quads, refined once; its points follow the weights.
class MaskJudge::Surface {
public:
    Surface(SearchedMasks const &searched, std::string name, Shape const &shape, int level,
            Curvature curvature, double weight)
        : _searched(searched), _name(std::move(name)), _curvature(curvature), _weight(weight) {
        HexSchemeOptions const options{FaceMask::Smooth};
        _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                          getBoundaryOptions(), {options});
        FarExt::TopologyRefiner::UniformOptions uniformOptions(level);
        uniformOptions.fullTopologyInLastLevel = true;
        if (!_refiner || !_refiner->RefineUniform(uniformOptions)) {
            throw std::runtime_error(_name + " cannot be refined");
        }
        _mesh = MakeSurfaceLevels(*_refiner, shape).back().mesh;
        for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
            _base.push_back({Eigen::Map<Eigen::Vector3d const>(&shape.positions[i])});
        }
        for (int depth = 0; depth < level; ++depth) {
            _masks.emplace_back(getLevels().levels[std::size_t(depth)], options,
                                FarExt::Interpolation::Vertex);
        }
    }

    void LookAtSector(int numU) { _chosen = {FindTorusSector(_mesh, numU)}; }
    void LookAtRow(int numU, int numV, int row) {
        _chosen = {FindTorusStrip(_mesh, numU, 1.0 / numV, 1.0 / numV, row)};
    }
    void LookAtAll() {
        _chosen.resize(1);
        _chosen[0].vertices.resize(_mesh.positions.size());
        std::iota(_chosen[0].vertices.begin(), _chosen[0].vertices.end(), 0);
        _chosen[0].groups.assign(_mesh.positions.size(), 0);
    }
    /// In rings, each half as far out as the one before.
    void LookAtCenter() {
        constexpr int kLastRing = 3;
        _chosen.resize(1);
        for (int vertex = 0; vertex < _mesh.GetNumVertices(); ++vertex) {
            double const distance = _mesh.positions[vertex].head<2>().norm();
            if (distance < 1) {
                int ring = 0;
                while (ring < kLastRing && distance <= std::ldexp(0.5, -ring)) {
                    ++ring;
                }
                _chosen[0].vertices.push_back(vertex);
                _chosen[0].groups.push_back(ring);
            }
        }
    }
    /// As MeasureRipple(): at the two outer ones of these rings, each for itself.
    void LookAtRings() {
        constexpr int kNumRings = 2;
        _chosen.resize(kNumRings);
        for (int ring = 0; ring < kNumRings; ++ring) {
            _chosen[ring].vertices = FindRing(_mesh, ring);
            _chosen[ring].groups.assign(_chosen[ring].vertices.size(), 0);
        }
    }

    Eigen::VectorXd Measure(MaskWeights const &weights) {
        refine(weights);
        Eigen::VectorXd result;
        _entries.clear();
        for (VertexGroups const &chosen : _chosen) {
            Eigen::VectorXd const deviations =
                MeasureDeviations(_mesh, chosen.vertices, chosen.groups, _curvature);
            Eigen::Index const first = result.size();
            result.conservativeResize(first + deviations.size());
            result.tail(deviations.size()) = _weight * deviations;
            std::string const ring =
                _chosen.size() > 1 ? ", ring " + std::to_string(_entries.size()) : "";
            _entries.push_back({_name + ring, deviations.norm()});
        }
        return result;
    }

    std::vector<Entry> const &GetEntries() const { return _entries; }

private:
    static OpenSubdiv::Sdc::Options getBoundaryOptions() {
        OpenSubdiv::Sdc::Options options;
        options.SetVtxBoundaryInterpolation(OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
        return options;
    }
    FarExt::internal::MeshLevels const &getLevels() const { return _refiner->GetHierarchy().mesh; }

    void refine(MaskWeights const &weights) {
        std::vector<Position> points = _base;
        SearchedLevels const levels = spread(_searched, weights);
        for (std::size_t depth = 0; depth < _masks.size(); ++depth) {
            Level const &parent = getLevels().levels[depth];
            LevelWeights const *const ofLevel =
                depth > 0 && depth <= levels.size() ? &levels[depth - 1] : nullptr;
            double turned[kHexagon];
            auto const getWeights = [&](int face, int i) -> double const * {
                int const corner = parent.faceFirstCorner[std::size_t(face)] + i;
                int const size = parent.GetFaceSize(face);
                auto const irregular =
                    FarExt::internal::FindCornerTags(parent.irregularCorners, corner, corner + 1);
                CornerWeights mask = {nullptr, false};
                if (ofLevel && !irregular.empty() && irregular[0].weight == 1 &&
                    !hasQuadMask(parent, corner)) {
                    mask = findMask(_searched, *ofLevel, irregular[0]);
                }
                if (!mask.weights) {
                    return _masks[depth].GetFaceRule(face).GetRow(i);
                }
                for (int j = 0; j < size; ++j) {
                    turned[(i + (mask.isBackwards ? size - j : j)) % size] = mask.weights[j];
                }
                return turned;
            };
            std::vector<Position> refined(std::size_t(getLevels().levels[depth + 1].numVertices));
            InterpolateMasked(getLevels().refinements[depth], _masks[depth], getWeights, points,
                              refined);
            points = std::move(refined);
        }
        std::transform(points.begin(), points.end(), _mesh.positions.begin(),
                       [](Position const &point) { return point.value; });
    }

    SearchedMasks _searched;
    std::string _name;
    Curvature _curvature;
    double _weight;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::vector<RefinementRules> _masks; // by parent
    std::vector<Position> _base;
    PolygonMesh _mesh;
    std::vector<VertexGroups> _chosen;
    std::vector<Entry> _entries; // by what is chosen
};

MaskJudge::MaskJudge(SearchedMasks const &searched, int level) : _searched(searched) {
    if (searched.AreOfQuads()) {
        addQuads(level);
    } else {
        addVertex(level);
    }
}

auto MaskJudge::add(std::string const &name, Shape const &shape, int level, Curvature curvature,
                    double weight) -> Surface & {
    _surfaces.push_back(
        std::make_unique<Surface>(_searched, name, shape, level, curvature, weight));
    return *_surfaces.back();
}

// A bowl and a saddle, as ripple is measured.
void MaskJudge::addRipple(Tiling tiling, int level, double ofBowl, double ofSaddle) {
    char const *const names[] = {" in triangles", " in quads", " in hexagons"};
    std::string const around = " at " + std::to_string(_searched.numFaces) + names[int(tiling)];
    auto const addQuadratic = [&](char const *name, double yy, Curvature curvature, double weight) {
        add(name + around, makeLifted(tiling, _searched.numFaces, 1, 0, yy), level, curvature,
            weight)
            .LookAtRings();
    };
    addQuadratic("bowl", 1, Curvature::Mean, ofBowl);
    addQuadratic("saddle", -1, Curvature::Gaussian, ofSaddle);
}

void MaskJudge::addQuads(int level) {
    constexpr double kOfBorder = 0.4;
    constexpr double kOfPlane = 0.2;
    constexpr double kOfIrregular = 0.1;
    std::array<std::pair<int, int>, 3> const sizes = {{{14, 8}, {20, 10}, {9, 6}}};
    for (auto const &[numU, numV] : sizes) {
        std::string const size = std::to_string(numU) + " x " + std::to_string(numV);
        add("torus " + size, MakeTorus(numU, numV, TorusFaces::Quads), level, Curvature::Mean, 1)
            .LookAtSector(numU);
        for (int row : {0, 1}) {
            add("row " + std::to_string(row) + " of " + size,
                MakeOpenTorus(numU, numV, TorusFaces::Quads), level, Curvature::Mean, kOfBorder)
                .LookAtRow(numU, numV, row);
        }
    }
    for (int valence : {4, 3, 5}) {
        double const weight = valence == kNumFacesOfQuads ? kOfPlane : kOfIrregular;
        std::string const around = " at " + std::to_string(valence);
        auto const addLifted = [&](char const *name, double xx, double xy, double yy,
                                   Curvature curvature) {
            add(name + around, makeLifted(Tiling::Quads, valence, xx, xy, yy), level, curvature,
                weight)
                .LookAtCenter();
        };
        addLifted("bowl", 1, 0, 1, Curvature::Mean);
        addLifted("saddle", 1, 0, -1, Curvature::Gaussian);
        if (valence == kNumFacesOfQuads) {
            addLifted("saddle 2xy", 0, 2, 0, Curvature::Gaussian);
        }
    }
}

// Mean curvature matters more than Gaussian curvature, which is larger by nature.
void MaskJudge::addVertex(int level) {
    int const numFaces = _searched.numFaces;
    if (_searched.facesAround == FacesAround::Triangles) {
        constexpr double kOfSaddle = 0.5;
        addRipple(Tiling::Triangles, level, 1, kOfSaddle);
        if (numFaces == 5) {
            add("icosahedron", MakeIcosahedron(), level, Curvature::Mean, 1).LookAtAll();
        } else if (numFaces == 6) {
            constexpr int kNumU = 14;
            add("torus", MakeTorus(kNumU, 8, TorusFaces::Triangles), level, Curvature::Mean, 1)
                .LookAtSector(kNumU);
        }
        return;
    }
    constexpr double kOfBowl = 4;
    constexpr double kOfHexagons = 1.5;
    addRipple(Tiling::Hexagons, level, kOfHexagons * kOfBowl, kOfHexagons);
    if (numFaces != kNumFacesOfQuads) {
        addRipple(Tiling::Quads, level, kOfBowl, 1);
    } else {
        Shape const octahedron = MakeTrianglePlatonics()[1];
        add(octahedron.name, octahedron, level, Curvature::Mean, kOfBowl).LookAtAll();
    }
}

MaskJudge::~MaskJudge() = default;

Eigen::VectorXd MaskJudge::Measure(MaskWeights const &weights) {
    constexpr double kOfNegative = 1.5;
    std::vector<double> values;
    for (auto const &surface : _surfaces) {
        Eigen::VectorXd const deviations = surface->Measure(weights);
        values.insert(values.end(), deviations.begin(), deviations.end());
    }
    SearchedLevels levels = spread(_searched, weights);
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        forEachMask(_searched, level, levels[std::size_t(level) - 1],
                    [&](double const *mask, int size, std::vector<int> const &, bool) {
                        std::transform(
                            mask, mask + size, std::back_inserter(values),
                            [](double weight) { return kOfNegative * std::min(0.0, weight); });
                    });
    }
    return Eigen::Map<Eigen::VectorXd const>(values.data(), Eigen::Index(values.size()));
}

std::vector<MaskJudge::Entry> MaskJudge::GetEntries() const {
    std::vector<Entry> entries;
    for (auto const &surface : _surfaces) {
        entries.insert(entries.end(), surface->GetEntries().begin(), surface->GetEntries().end());
    }
    return entries;
}

MaskWeights GetShippedWeights(SearchedMasks const &searched) {
    return gather(searched, getShippedLevels(searched));
}

MaskWeights GetPlainWeights(SearchedMasks const &searched) {
    SearchedLevels levels;
    int const later = FarExt::kNumStepsToConstantMasks;
    levels.fill(getWeights(searched, later, FarExt::ComputeQuadMask(later)));
    return gather(searched, levels);
}

void PrintMasks(SearchedMasks const &searched, MaskWeights const &weights) {
    SearchedLevels levels = spread(searched, weights);
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        forEachMask(searched, level, levels[std::size_t(level) - 1],
                    [&](double const *mask, int size, std::vector<int> const &, bool) {
                        std::printf("level %d: {", level);
                        for (int i = 0; i < size; ++i) {
                            std::printf("%s%.0f", i > 0 ? ", " : "", kParts * mask[i]);
                        }
                        std::printf("}\n");
                    });
    }
}

MaskWeights SearchWeights(MaskWeights const &weights, int maxSteps, MaskJudge &judge,
                          int firstFree) {
    MaskWeights const found = FindLeastSquares(
        weights, maxSteps, [&judge](MaskWeights const &tried) { return judge.Measure(tried); },
        firstFree);
    judge.Measure(found);
    return found;
}

MaskWeights RoundWeights(MaskWeights weights, int maxSteps, MaskJudge &judge) {
    SearchedMasks const &searched = judge.GetSearched();
    SearchedLevels levels = spread(searched, weights);
    Eigen::Index next = 0;
    for (int level = 1; level <= kNumSearchedLevels; ++level) {
        Eigen::Index const first = next;
        forEachMask(searched, level, levels[std::size_t(level) - 1],
                    [&](double const *, int, std::vector<int> const &places, bool) {
                        next += Eigen::Index(places.size());
                    });
        auto ofLevel = weights.segment(first, next - first);
        ofLevel = (kParts * ofLevel).array().round() / kParts;
        if (next < weights.size()) {
            weights = SearchWeights(weights, maxSteps, judge, int(next));
        }
    }
    return weights;
}

} // namespace OpenSubdivHex::Regression
