// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"
#include "oracle.h"

#include "far_ext/patchTableFactory.h"
#include "far_ext/stencilTableFactory.h"

#include <opensubdiv/bfr/parameterization.h>

#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::PatchMap;
using FarExt::PatchTableFactory;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

constexpr int kNumCorners = 4;

/// Fails unless patches are refused for a reason.
void checkPatchRefusal(TopologyRefiner const &refiner, int depth,
                       FarExt::CallStatus const &status) {
    TopologyLevel const &level = refiner.GetLevel(depth);
    bool isReason = true; // that all faces are holes
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        isReason = isReason && level.IsFaceHole(face);
    }
    for (int vert = 0; vert < level.GetNumVertices(); ++vert) {
        isReason = isReason || IsOnFreeBoundary(refiner, level, vert);
    }
    FarExt::LimitStencilTableFactory::Options options;
    options.level = depth;
    options.generateFaceCenters = true;
    isReason = isReason || !FarExt::LimitStencilTableFactory::Create(refiner, options);
    if (!isReason || status.GetCode() != FarExt::StatusCode::Unsupported) {
        Fail("no patches of level ", depth, ": ", status.GetErrorMessage());
    }
}

/// The points that stencils make.
ReferenceValues applyStencils(Far::StencilTableReal<double> const &table,
                              ReferenceValues const &base) {
    ReferenceValues points = ReferenceValues::Zero(table.GetNumStencils(), base.cols());
    for (int i = 0; i < table.GetNumStencils(); ++i) {
        double sum = 0;
        int const offset = table.GetOffsets()[std::size_t(i)];
        for (int k = offset; k < offset + table.GetSizes()[std::size_t(i)]; ++k) {
            int const index = table.GetControlIndices()[std::size_t(k)];
            if (index < 0 || index >= base.rows()) {
                Fail("point ", i, " of patches has the source ", index);
            }
            double const weight = table.GetWeights()[std::size_t(k)];
            points.row(i) += weight * base.row(index);
            sum += weight;
        }
        if (!(std::abs(sum - 1) < 1e-9)) {
            Fail("point ", i, " of patches has weights that sum to ", sum);
        }
    }
    return points;
}

/// Twice the area of a patch in its face.
double getArea(std::array<double, 8> const &coords) {
    double area = 0;
    for (std::size_t i = 0; i < kNumCorners; ++i) {
        std::size_t const next = (i + 1) % kNumCorners;
        area += coords[2 * i] * coords[2 * next + 1] - coords[2 * next] * coords[2 * i + 1];
    }
    return area;
}

/// Twice the area of a face in its plane: a right-angled triangle, or a regular polygon with sides 1 long.
double getFaceArea(int size) {
    return size == 3 ? 1 : size / (2 * std::tan(std::acos(-1.0) / size));
}

/// Some place inside of a face, away from the lines between sub-faces.
std::array<double, 2> rollPlace(int size, Dice &dice) {
    auto const roll = [&] { return 0.02 + 0.01 * dice.Roll(97); };
    std::array<double, 2> uv = {roll(), roll()};
    if (size == 3) {
        uv[1] *= 1 - uv[0];
    }
    if (size > 4) {
        OpenSubdiv::Bfr::Parameterization(OpenSubdiv::Sdc::SCHEME_CATMARK, size)
            .ConvertNormalizedSubFaceToCoord(dice.Roll(size), std::array<double, 2>(uv).data(),
                                             uv.data());
    }
    return uv;
}

/// Faces are covered by their patches, and places are found in these.
void checkPlaces(PatchMap const &map, TopologyLevel const &level, Dice &dice) {
    FarExt::SurfaceFaces const faces(level.GetLevel());
    std::vector<double> areas(std::size_t(faces.GetNumFaces()), 0);
    for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
        double const area = getArea(map.GetCoords(patch));
        if (!(area > 0)) {
            Fail("patch ", patch, " has the area ", area);
        }
        areas[std::size_t(map.GetFace(patch))] += area;
    }
    for (int face = 0; face < faces.GetNumFaces(); ++face) {
        int const size = faces.GetShape(face).size;
        double const area = areas[std::size_t(face)];
        if (!(std::abs(area - getFaceArea(size)) < 1e-9 * size * size) && area != 0) {
            Fail("the patches of face ", face, " have the area ", area);
        }
        auto const [u, v] = rollPlace(size, dice);
        PatchMap::Place const place = map.FindPlace(face, u, v);
        if ((place.patch < 0) != (area == 0)) {
            Fail("face ", face, " has the patch ", place.patch, " at ", u, ", ", v);
        }
        if (place.patch < 0) {
            continue;
        }
        double found[2];
        map.GetFacePlace(place, &found[0], &found[1]);
        constexpr double kAllowed = 1e-6; // of s and t, which steep sides magnify
        bool const isInside = place.s >= -kAllowed && place.s <= 1 + kAllowed &&
                              place.t >= -kAllowed && place.t <= 1 + kAllowed;
        if (map.GetFace(place.patch) != face || !isInside ||
            !(std::hypot(found[0] - u, found[1] - v) < kAllowed)) {
            Fail("the place ", u, ", ", v, " of face ", face, " is found in patch ", place.patch,
                 " of face ", map.GetFace(place.patch), " at ", place.s, ", ", place.t,
                 ", which is ", found[0], ", ", found[1]);
        }
    }
}

/// \brief Corners that are vertices, or centres of faces, are those of the limit surface, or of the channel.
///
/// \param vertices  of all patches
void checkCorners(OracleLevels const &levels, OracleLevels::Values const &values,
                  Far::PatchTable const &table, PatchMap const &map, Far::ConstIndexArray vertices,
                  Far::StencilTableReal<double> const *stencils) {
    if (!stencils) {
        Fail("patches have no points of double precision");
    }
    ReferenceValues const points = applyStencils(*stencils, values.levels[0]);
    MeshSurfaces<double> const mesh(levels, values);
    int const numControl = int(values.levels[0].rows());
    int const numPoints = vertices.size() / map.GetNumPatches();
    for (int patch = 0; patch < map.GetNumPatches(); ++patch) {
        if (!mesh.Has(map.GetFace(patch))) {
            continue;
        }
        bool const isKite = table.GetPatchParam(PatchMap::GetHandle(patch)).NonQuadRoot();
        // Kites of half a face meet where no vertex is.
        bool const isOfHalf =
            isKite && mesh.factory->GetFaces().GetShape(map.GetFace(patch)).isHalf;
        for (int i = 0; i < (isOfHalf ? 1 : kNumCorners); i += isKite ? 2 : 1) {
            double uv[2];
            map.GetFacePlace({patch, i == 1 || i == 2 ? 1.0 : 0.0, i >= 2 ? 1.0 : 0.0}, &uv[0],
                             &uv[1]);
            Eigen::RowVectorXd const expected = mesh.Evaluate(map.GetFace(patch), uv).row(0);
            Eigen::RowVectorXd const actual =
                points.row(vertices[numPoints * patch + numPoints / kNumCorners * i] - numControl);
            if (!(GetDifference(actual, expected) <= mesh.GetTolerance())) {
                Fail("corner ", i, " of patch ", patch, " in face ", map.GetFace(patch), " at ",
                     uv[0], ", ", uv[1], " is ", actual, ", not ", expected);
            }
        }
    }
}

} // namespace

void CheckPatches(OracleLevels const &levels, Dice &dice) {
    TopologyRefiner const &refiner = levels.refiner;
    int const surfaceLevel = refiner.GetHexSchemeOptions().GetSurfaceLevel();
    int const last = refiner.GetMaxLevel();
    if (last <= surfaceLevel || !refiner.GetLevel(last).HasFullTopology()) {
        return;
    }
    int const depth = surfaceLevel + dice.Roll(last - surfaceLevel);
    PatchTableFactory::Options options(depth);
    options.SetPatchPrecision<double>();
    options.generateFVarTables = true;
    options.generateFVarLegacyLinearPatches = false;
    options.SetFVarPatchPrecision<double>();
    FarExt::CallStatus status;
    auto const table = PatchTableFactory::Create(refiner, options, &status);
    if (!table) {
        checkPatchRefusal(refiner, depth, status);
        return;
    }
    PatchMap const map(refiner, options, &status);
    if (map.GetNumPatches() != table->GetNumPatchesTotal()) {
        Fail("there are ", map.GetNumPatches(), " places of ", table->GetNumPatchesTotal(),
             " patches");
    }
    checkPlaces(map, refiner.GetLevel(surfaceLevel), dice);
    checkCorners(levels, levels.values[0], *table, map, table->GetPatchArrayVertices(0),
                 table->GetLocalPointStencilTable<double>());
    checkCorners(levels, levels.values[1], *table, map, table->GetVaryingVertices(),
                 table->GetLocalPointVaryingStencilTable<double>());
    for (int channel = 0; channel < table->GetNumFVarChannels(); ++channel) {
        if (table->GetFVarPatchDescriptor(channel).GetType() == Far::PatchDescriptor::QUADS) {
            continue; // whose points have single precision
        }
        checkCorners(levels, levels.values[std::size_t(channel) + 2], *table, map,
                     table->GetFVarValues(channel),
                     table->GetLocalPointFaceVaryingStencilTable<double>(channel));
    }
}

} // namespace OpenSubdivHex::Regression
