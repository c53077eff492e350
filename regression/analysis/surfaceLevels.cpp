// SPDX-License-Identifier: Apache-2.0
#include "surfaceLevels.h"

#include "maskedStep.h"
#include "position.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "far_ext/vtr/hierarchy.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <cmath>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

using Position = PositionReal<double>;

template <class LEVEL>
PolygonMesh makeMesh(LEVEL const &level, std::vector<Position> const &positions) {
    PolygonMesh mesh;
    for (Position const &position : positions) {
        mesh.positions.push_back(position.value);
    }
    mesh.faceFirst.push_back(0);
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        for (int vertex : level.GetFaceVertices(face)) {
            mesh.faceVertices.push_back(vertex);
        }
        mesh.faceFirst.push_back(int(mesh.faceVertices.size()));
    }
    mesh.numEdges = level.GetNumEdges();
    for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
        auto const faces = level.GetEdgeFaces(edge);
        if (faces.size() == 2) {
            mesh.edgeFaces.push_back({faces[0], faces[1]});
        }
    }
    mesh.vertexFirst.push_back(0);
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        for (int face : level.GetVertexFaces(vertex)) {
            mesh.vertexFaces.push_back(face);
        }
        mesh.vertexFirst.push_back(int(mesh.vertexFaces.size()));
    }
    return mesh;
}

template <class PRIMVAR_REFINER, class REFINER>
std::vector<SurfaceLevel> makeLevels(REFINER const &refiner, Shape const &shape,
                                     MeshCenter center) {
    PRIMVAR_REFINER const primvarRefiner(refiner);
    std::vector<Position> positions;
    for (int vertex = 0; vertex < shape.GetNumVertices(); ++vertex) {
        positions.push_back({Eigen::Map<Eigen::Vector3d const>(&shape.positions[3 * vertex])});
    }
    std::vector<SurfaceLevel> levels;
    levels.push_back({makeMesh(refiner.GetLevel(0), positions), center});
    for (int depth = 1; depth <= refiner.GetMaxLevel(); ++depth) {
        auto const &level = refiner.GetLevel(depth);
        std::vector<Position> refined(level.GetNumVertices());
        primvarRefiner.Interpolate(depth, positions, refined);
        positions = std::move(refined);
        if (center.index >= 0) {
            center = FindChild(center, refiner.GetLevel(depth - 1), level);
        }
        levels.push_back({makeMesh(level, positions), center});
    }
    return levels;
}

std::unique_ptr<FarExt::TopologyRefiner> createRefined(Shape const &shape,
                                                       FarExt::HexSchemeOptions const &options,
                                                       int maxLevel, Sdc::Options sdcOptions) {
    FarExt::CallStatus status;
    auto refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(), sdcOptions,
                                                          {options}, &status);
    FarExt::TopologyRefiner::UniformOptions uniformOptions(maxLevel);
    uniformOptions.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineUniform(uniformOptions, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return refiner;
}

std::vector<SurfaceLevel> refine(Shape const &shape, FarExt::HexSchemeOptions const &options,
                                 int maxLevel, MeshCenter center, Sdc::Options sdcOptions) {
    return MakeSurfaceLevels(*createRefined(shape, options, maxLevel, sdcOptions), shape, center);
}

/// Refines by FaceMask::Smooth in levels that another mask made, and which know nothing irregular.
class OneMaskRefiner {
public:
    explicit OneMaskRefiner(FarExt::TopologyRefiner const &refiner)
        : _levels(refiner.GetHierarchy().mesh) {}

    void Interpolate(int depth, std::vector<Position> const &src,
                     std::vector<Position> &dst) const {
        auto const &parent = _levels.levels[std::size_t(depth) - 1];
        FarExt::internal::RefinementRules const mask(parent, {FarExt::FaceMask::Smooth},
                                                     FarExt::Interpolation::Vertex);
        InterpolateMasked(
            _levels.refinements[std::size_t(depth) - 1], mask,
            [&](int face, int i) { return mask.GetFaceRule(face).GetRow(i); }, src, dst);
    }

private:
    FarExt::internal::MeshLevels const &_levels;
};

std::vector<SurfaceLevel> refine(Shape const &shape, Sdc::SchemeType scheme, int maxLevel,
                                 MeshCenter center, Sdc::Options sdcOptions) {
    if (scheme == Sdc::SCHEME_LOOP && center.kind == CenterKind::Face) {
        throw std::runtime_error(shape.name + ": a face makes no vertex");
    }
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    ShapeDescriptor const descriptor(shape);
    std::unique_ptr<Far::TopologyRefiner> const refiner(
        Factory::Create(descriptor.Get(), Factory::Options(scheme, sdcOptions)));
    if (!refiner) {
        throw std::runtime_error(shape.name + ": refused by Far");
    }
    Far::TopologyRefiner::UniformOptions uniformOptions(maxLevel);
    uniformOptions.fullTopologyInLastLevel = true;
    refiner->RefineUniform(uniformOptions);
    return makeLevels<Far::PrimvarRefinerReal<double>>(*refiner, shape, center);
}

} // namespace

std::vector<SurfaceLevel> RefineSurface(Shape const &shape, AnyScheme const &scheme, int maxLevel,
                                        MeshCenter center, Sdc::Options sdcOptions) {
    return std::visit(
        [&](auto const &one) { return refine(shape, one, maxLevel, center, sdcOptions); }, scheme);
}

std::vector<SurfaceLevel> RefineWithOneMask(Shape const &shape, int maxLevel,
                                            Sdc::Options sdcOptions) {
    auto const refiner = createRefined(shape, {FarExt::FaceMask::Cosine}, maxLevel, sdcOptions);
    return makeLevels<OneMaskRefiner>(*refiner, shape, MeshCenter());
}

std::vector<SurfaceLevel> MakeSurfaceLevels(FarExt::TopologyRefiner const &refiner,
                                            Shape const &shape, MeshCenter center) {
    return makeLevels<FarExt::PrimvarRefinerReal<double>>(refiner, shape, center);
}

Shape MakeSaddleBipyramid(int n) {
    Shape shape = MakeBipyramid(n);
    double const kTwoPi = 2 * std::acos(-1.0);
    for (int i = 0; i < n; ++i) {
        // Turned a little, so that no edge lies in a plane of symmetry.
        shape.positions[3 * i + 2] = 0.5 * std::cos(2 * kTwoPi * i / n + 0.3);
    }
    shape.positions[3 * (n + 1) + 2] = 0.35;
    return shape;
}

} // namespace OpenSubdivHex::Regression
