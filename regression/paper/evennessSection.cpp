// SPDX-License-Identifier: Apache-2.0
//
// How even curvature is on the control meshes that people have.
#include "picture.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "regression/analysis/besideLines.h"
#include "regression/analysis/evenness.h"
#include "regression/analysis/ripple.h"
#include "regression/analysis/spectrum.h"

#include <algorithm>
#include <variant>

namespace OpenSubdivHex::Regression {

namespace {

namespace Sdc = OpenSubdiv::Sdc;

/// Level of the measures, at most.  On quads finer levels are more uneven, by up to a half, since there are
/// ever finer ripples around quads and irregular vertices.
constexpr int kMeasuredLevel = 5;

struct Contestant {
    std::string name;
    AnyScheme scheme;
};

std::string measure(double (*unevenness)(PolygonMesh const &), Shape const &shape,
                    AnyScheme const &scheme, int level) {
    return FormatNumber(unevenness(RefineSurface(shape, scheme, level).back().mesh), 3);
}

std::string measureRipple(Tiling tiling, int valence, AnyScheme const &scheme, int level) {
    // Two rings where the mesh is fine enough for the inner one.
    int const numRings = level == kMeasuredLevel ? 2 : 1;
    std::string result;
    for (Quadratic quadratic : {Quadratic::Elliptic, Quadratic::Hyperbolic}) {
        std::vector<double> const rings =
            MeasureRipple(tiling, valence, scheme, quadratic, numRings, level);
        result += "; " + FormatNumber(*std::max_element(rings.begin(), rings.end()), 2);
    }
    return result;
}

std::string findGrowth(AnyScheme const &scheme, int valence) {
    auto const *const options = std::get_if<HexSchemeOptions>(&scheme);
    LocalSubdivision const subdivision =
        options ? MakeLocalSubdivision(*options, CenterKind::Vertex, valence)
                : MakeLocalSubdivision(std::get<Sdc::SchemeType>(scheme), valence);
    return FormatNumber(ComputeSpectrum(subdivision).GetCurvatureGrowth(), 4);
}

void addValences(Page *page, int level) {
    struct Column {
        char const *name;
        Tiling tiling;
        AnyScheme scheme;
    };
    std::vector<Column> const columns{
        {"Smooth, hexagons", Tiling::Hexagons, MakeHexagonal(FaceMask::Smooth)},
        {"Smooth, quads", Tiling::Quads, MakeHexagonal(FaceMask::Smooth)},
        {"Catmull-Clark, quads", Tiling::Quads, Sdc::SCHEME_CATMARK},
        {"Smooth, truncate first, triangles", Tiling::Triangles,
         MakeTruncateFirst(FaceMask::Smooth)},
        {"Loop, triangles", Tiling::Triangles, Sdc::SCHEME_LOOP}};
    Table table{
        {"faces at the vertex"},
        {},
        "Growth of curvature per level at a vertex in a mesh that is regular elsewhere, and "
        "ripple around it, level " +
            std::to_string(level) +
            ": of control points on an elliptic paraboloid the deviation of mean curvature "
            "from its mean over a ring, and on a hyperbolic one that of Gaussian curvature, "
            "as a part of that mean.  Rings end at one control edge from the vertex, and "
            "at a half; the larger of both is shown."};
    for (Column const &column : columns) {
        table.header.emplace_back(column.name);
    }
    for (int valence : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 16, 64}) {
        table.rows.push_back({std::to_string(valence)});
        for (Column const &column : columns) {
            table.rows.back().push_back(
                findGrowth(column.scheme, valence) +
                measureRipple(column.tiling, valence, column.scheme, level));
        }
    }
    page->AddTable(table);
}

std::string formatNumbers(std::vector<double> const &values) {
    std::string result;
    for (double value : values) {
        result += (result.empty() ? "" : "; ") + FormatNumber(value, 2);
    }
    return result;
}

/// Curvature beside borders: along tubes of quads, and around border vertices of triangles.
void addLines(Page *page) {
    constexpr int kNumAround = 12;
    constexpr int kNumRows = 8;
    constexpr int kNumQuarters = 8;
    Table tubes{{"height of a row, in widths of a quad", "Smooth", "Catmull-Clark"},
                {},
                "Open tubes of 12 x 8 quads, level " + std::to_string(kMeasuredLevel) +
                    ": mean curvature over that of a cylinder, by quarter rows from the border on. "
                    " 1 is exact."};
    for (double rowHeight : {1.0, 0.5}) {
        tubes.rows.push_back({FormatNumber(rowHeight, 1)});
        for (AnyScheme const &scheme :
             {AnyScheme(MakeHexagonal(FaceMask::Smooth)), AnyScheme(Sdc::SCHEME_CATMARK)}) {
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
            auto const levels = RefineSurface(MakeTube(kNumAround, kNumRows, rowHeight), scheme,
                                              kMeasuredLevel, MeshCenter(), options);
            tubes.rows.back().push_back(formatNumbers(MeasureTube(
                levels.back().mesh, GetTubeRowHeight(kNumAround, rowHeight), kNumQuarters)));
        }
    }
    page->AddTable(tubes);

    constexpr int kNumRings = 3;
    Table disks{{"triangles at the border vertex", "Smooth, truncate first", "Loop"},
                {},
                "Half disks of triangles around a border vertex, with control points on x&sup2; "
                "and the border along "
                "x, level " +
                    std::to_string(kMeasuredLevel) +
                    ": deviation of mean curvature from its mean over a ring, as a "
                    "part of that mean, in three rings, each half as far out as the one before."};
    for (int numFaces : {2, 3, 4, 5, 6, 8}) {
        disks.rows.push_back({std::to_string(numFaces)});
        for (AnyScheme const &scheme :
             {AnyScheme(MakeTruncateFirst(FaceMask::Smooth)), AnyScheme(Sdc::SCHEME_LOOP)}) {
            disks.rows.back().push_back(formatNumbers(
                MeasureHalfDisk(Tiling::Triangles, numFaces, scheme, kNumRings, kMeasuredLevel)));
        }
    }
    page->AddTable(disks);
}

} // namespace

void AddEvennessSection(Page *page, Settings const &settings) {
    page->BeginSection("evenness", "Evenness on ordinary control meshes");
    page->AddParagraph(
        "A mesh of quads has four faces at every vertex and one of triangles six, so "
        "that what a scheme does at irregular vertices shows everywhere.");
    AnyScheme const cosine = MakeHexagonal(FaceMask::Cosine);
    AnyScheme const smooth = MakeHexagonal(FaceMask::Smooth);
    AnyScheme const triHexFirst = MakeTriHexFirst(FaceMask::Smooth);
    AnyScheme const truncateFirst = MakeTruncateFirst(FaceMask::Smooth);
    int const level = std::min(kMeasuredLevel, settings.smoothnessLevel);
    Table table{
        {"control mesh", "Cosine", "Smooth", "Smooth, tri-hex first", "Smooth, truncate first",
         "Catmull-Clark", "Loop"},
        {},
        "Deviation of the mean curvature from its mean, as a part of that mean (root of the "
        "mean square by area), level " +
            std::to_string(level) + ".  On tori within parallels, where it should be the same."};
    auto const addRow = [&](std::string const &name, Shape const &shape, bool isTriangles,
                            double (*unevenness)(PolygonMesh const &)) {
        std::vector<std::string> row{name};
        for (AnyScheme const &scheme :
             {cosine, smooth, triHexFirst, truncateFirst, AnyScheme(Sdc::SCHEME_CATMARK)}) {
            row.push_back(measure(unevenness, shape, scheme, level));
        }
        row.push_back(isTriangles ? measure(unevenness, shape, Sdc::SCHEME_LOOP, level) : "");
        table.rows.push_back(row);
    };
    addRow("torus of 14 x 8 quads", MakeTorus(14, 8, TorusFaces::Quads), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 14); });
    addRow("torus of 20 x 10 quads", MakeTorus(20, 10, TorusFaces::Quads), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 20); });
    addRow("torus of 9 x 6 quads", MakeTorus(9, 6, TorusFaces::Quads), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 9); });
    addRow("torus of 30 x 6 quads, long ones", MakeTorus(30, 6, TorusFaces::Quads), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 30); });
    addRow("torus of 7 x 12 quads, long ones", MakeTorus(7, 12, TorusFaces::Quads), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 7); });
    addRow("torus of triangles", MakeTorus(14, 8, TorusFaces::Triangles), true,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 14); });
    for (Shape const &shape : MakeTrianglePlatonics()) {
        addRow(shape.name, shape, true, MeasureSphereUnevenness);
    }
    Shape const hull = MakeSphereHull(60, 200);
    addRow("hull of 60 points on a sphere", hull, true, MeasureSphereUnevenness);
    for (Shape const &shape : MakeTrianglePlatonics()) {
        addRow(shape.name + " as a sphere of quads", MakeSphereOfQuads(shape), false,
               MeasureSphereUnevenness);
    }
    addRow("the same hull as a sphere of quads", MakeSphereOfQuads(hull), false,
           MeasureSphereUnevenness);
    page->AddTable(table);
    addValences(page, level);
    addLines(page);

    PictureOptions options;
    options.view = {20, 40, 1.4f};
    options.look = Tools::SurfaceLook::Zebra;
    std::vector<std::string> pictures;
    auto const addPictures = [&](char const *faces, Shape const &shape,
                                 std::vector<Contestant> const &contestants) {
        for (Contestant const &contestant : contestants) {
            auto const levels = RefineSurface(shape, contestant.scheme, settings.maskLevel - 1);
            pictures.push_back(
                Captioned(DrawMesh(levels.back().mesh, levels[0].mesh, options, settings),
                          std::string(faces) + ", " + contestant.name));
        }
    };
    addPictures("quads", MakeTorus(14, 8, TorusFaces::Quads),
                {{"Cosine", cosine}, {"Smooth", smooth}, {"Catmull-Clark", Sdc::SCHEME_CATMARK}});
    std::vector<Contestant> const ofTriangles = {
        {"Smooth", smooth}, {"Smooth, truncate first", truncateFirst}, {"Loop", Sdc::SCHEME_LOOP}};
    addPictures("triangles", MakeTorus(14, 8, TorusFaces::Triangles), ofTriangles);
    addPictures("icosahedron", MakeIcosahedron(), ofTriangles);
    page->AddFigure(pictures, 3,
                    "Reflection lines of tori of 14 x 8 quads, and of triangles, and of an "
                    "icosahedron, level " +
                        std::to_string(settings.maskLevel - 1) + ".");
}

} // namespace OpenSubdivHex::Regression
