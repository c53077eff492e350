// SPDX-License-Identifier: Apache-2.0
//
// How even curvature is on the control meshes that people have.
#include "picture.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "regression/analysis/evenness.h"

#include <algorithm>

namespace OpenSubdivHex::Regression {

namespace {

namespace Sdc = OpenSubdiv::Sdc;

/// Level of the measures, at most: how uneven a surface is changes little from here on.
constexpr int kMeasuredLevel = 5;

struct Contestant {
    std::string name;
    AnyScheme scheme;
};

std::string measure(double (*unevenness)(PolygonMesh const &), Shape const &shape,
                    AnyScheme const &scheme, int level) {
    return FormatNumber(unevenness(RefineSurface(shape, scheme, level).back().mesh), 3);
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
    addRow("torus of 14 x 8 quads", MakeTorus(14, 8, false), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 14); });
    addRow("torus of 20 x 10 quads", MakeTorus(20, 10, false), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 20); });
    addRow("torus of 9 x 6 quads", MakeTorus(9, 6, false), false,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 9); });
    addRow("torus of triangles", MakeTorus(14, 8, true), true,
           [](PolygonMesh const &mesh) { return MeasureTorusUnevenness(mesh, 14); });
    for (Shape const &shape : MakeTrianglePlatonics()) {
        addRow(shape.name, shape, true, MeasureSphereUnevenness);
    }
    addRow("hull of 60 points on a sphere", MakeSphereHull(60, 200), true, MeasureSphereUnevenness);
    page->AddTable(table);

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
    addPictures("quads", MakeTorus(14, 8, false),
                {{"Cosine", cosine}, {"Smooth", smooth}, {"Catmull-Clark", Sdc::SCHEME_CATMARK}});
    std::vector<Contestant> const ofTriangles = {
        {"Smooth", smooth}, {"Smooth, truncate first", truncateFirst}, {"Loop", Sdc::SCHEME_LOOP}};
    addPictures("triangles", MakeTorus(14, 8, true), ofTriangles);
    addPictures("icosahedron", MakeIcosahedron(), ofTriangles);
    page->AddFigure(pictures, 3,
                    "Reflection lines of tori of 14 x 8 quads, and of triangles, and of an "
                    "icosahedron, level " +
                        std::to_string(settings.maskLevel - 1) + ".");
}

} // namespace OpenSubdivHex::Regression
