// SPDX-License-Identifier: Apache-2.0
//
// The figures of the paper: its solid, its meshes, its factors; and stage 3.
#include "meshes.h"
#include "picture.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "far_ext/topologyRefinerFactory.h"
#include "regression/analysis/smoothness.h"
#include "regression/shapes/featureShapes.h"
#include "regression/shapes/shapeDescriptor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

/// How large the faces are, as parts of the solid's own size.
struct FaceSizes {
    double largest = 0; ///< diameter
    double mean = 0;
};

FaceSizes measureFaces(PolygonMesh const &mesh, double unit) {
    FaceSizes sizes;
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        double diameter = 0;
        for (int i = 0; i < mesh.GetFaceSize(face); ++i) {
            for (int j = 0; j < i; ++j) {
                diameter = std::max(diameter, (mesh.positions[mesh.GetFaceVertex(face, i)] -
                                               mesh.positions[mesh.GetFaceVertex(face, j)])
                                                  .norm());
            }
        }
        sizes.largest = std::max(sizes.largest, diameter / unit);
        sizes.mean += diameter / unit / mesh.GetNumFaces();
    }
    return sizes;
}

std::string describeMesh(PolygonMesh const &mesh) {
    return FormatCount(mesh.GetNumFaces()) + " faces, " + FormatCount(mesh.GetNumVertices()) +
           " vertices";
}

std::string percent(double part) { return FormatNumber(100 * part, 2) + "&#8239;%"; }

/// The shape whose vertices and faces are those of \p mesh.
Shape makeShape(std::string name, PolygonMesh const &mesh) {
    Shape shape;
    shape.name = std::move(name);
    for (Eigen::Vector3d const &position : mesh.positions) {
        shape.positions.insert(shape.positions.end(), {position.x(), position.y(), position.z()});
    }
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        shape.faceSizes.push_back(mesh.GetFaceSize(face));
    }
    shape.faceVertices = mesh.faceVertices;
    return shape;
}

std::vector<SurfaceLevel> refineCoplanar(Shape const &shape, int level, bool closeGaps) {
    FarExt::CallStatus status;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(
        ShapeDescriptor(shape).Get(), Sdc::Options(), {MakeHexagonal(FaceMask::Average)}, &status);
    FarExt::TopologyRefiner::CoplanarOptions options(level);
    options.closeGaps = closeGaps;
    options.fullTopologyInLastLevel = true;
    if (!refiner || !refiner->RefineCoplanar(shape.positions.data(), options, &status)) {
        throw std::runtime_error(shape.name + ": " + status.GetErrorMessage());
    }
    return MakeSurfaceLevels(*refiner, shape);
}

int countOpenEdges(PolygonMesh const &mesh) { return mesh.numEdges - int(mesh.edgeFaces.size()); }

int computeEulerCharacteristic(PolygonMesh const &mesh) {
    return mesh.GetNumVertices() - mesh.numEdges + mesh.GetNumFaces();
}

} // namespace

void AddSolidSection(Page *page, Settings const &settings) {
    page->BeginSection("solid", "A pentagonal solid");
    Shape const solid = MakeDodecahedron();
    FaceMask const mask = FaceMask::Average;
    auto const dooSabin = RefineSurface(solid, MakeDooSabin(mask), settings.solidLevel);
    auto const hexagonal = RefineSurface(solid, MakeHexagonal(mask), settings.solidLevel);

    PictureOptions options;
    options.view = {24, 22, 0.94f};
    options.isTinted = true;
    std::vector<std::string> parts;
    for (int level = 0; level <= settings.solidLevel; ++level) {
        options.hasWireframe = level <= 4;
        for (auto const *levels : {&dooSabin, &hexagonal}) {
            PolygonMesh const &mesh = (*levels)[level].mesh;
            parts.push_back(
                Captioned(DrawMesh(mesh, hexagonal[0].mesh, options, settings),
                          (levels == &dooSabin ? "Doo-Sabin, level " : "hexagonal, level ") +
                              std::to_string(level) + ": " + describeMesh(mesh)));
        }
    }
    page->AddParagraph(
        "The paper's figure 5 refines a solid of pentagons with Doo-Sabin and with its own "
        "scheme.  Here it is a dodecahedron, both schemes with the paper's mask, each polygon lit "
        "by one normal.  Polygons that are no hexagons are blue.");
    page->AddFigure(parts, 4,
                    "Figure 5 of the paper: levels 0 to " + std::to_string(settings.solidLevel) +
                        " of a dodecahedron.  The same edges, but Doo-Sabin has a face more for "
                        "every vertex.");

    PolygonMesh const &a = dooSabin.back().mesh;
    PolygonMesh const &b = hexagonal.back().mesh;
    FaceSizes const coarseA = measureFaces(a, 1);
    FaceSizes const coarseB = measureFaces(b, 1);
    double const angleA = 180 / std::acos(-1.0) * MeasureSmoothness(a).maxNormalAngle;
    double const angleB = 180 / std::acos(-1.0) * MeasureSmoothness(b).maxNormalAngle;
    std::string const where =
        "At level " + std::to_string(settings.solidLevel) + " of the dodecahedron ";
    page->AddTable(
        {{"level " + std::to_string(settings.solidLevel), "faces", "largest face, diameter",
          "mean diameter", "largest by mean", "largest angle between normals"},
         {{"Doo-Sabin", FormatCount(a.GetNumFaces()), FormatNumber(coarseA.largest, 4),
           FormatNumber(coarseA.mean, 4), FormatNumber(coarseA.largest / coarseA.mean, 2),
           FormatNumber(angleA, 2) + "°"},
          {"hexagonal", FormatCount(b.GetNumFaces()), FormatNumber(coarseB.largest, 4),
           FormatNumber(coarseB.mean, 4), FormatNumber(coarseB.largest / coarseB.mean, 2),
           FormatNumber(angleB, 2) + "°"}},
         "How coarse the two are.  The solid has radius about 1."});
    page->AddClaim(
        "It prevents the coarse area that Doo-Sabin shows at level 5 (figure 5)",
        Judge(coarseB.largest < coarseA.largest && angleB < angleA,
              coarseB.largest / coarseB.mean < coarseA.largest / coarseA.mean),
        where + "the largest face has a diameter of " + FormatNumber(coarseB.largest, 4) +
            " against " + FormatNumber(coarseA.largest, 4) +
            ", and the largest angle between neighbouring normals is " + FormatNumber(angleB, 2) +
            "° against " + FormatNumber(angleA, 2) + "°.  The largest face is " +
            FormatNumber(coarseB.largest / coarseB.mean, 2) + " times the mean, against " +
            FormatNumber(coarseA.largest / coarseA.mean, 2) + ".");
}

void AddMeshSection(Page *page, Settings const &settings) {
    page->BeginSection("meshes", "Arbitrary control meshes");
    struct Entry {
        std::string name;
        Shape shape;
        Tools::View view;
    };
    std::vector<Entry> entries{{"lantern", LoadTutorialMesh("lantern"), {30, 15, 1}},
                               {"ring", LoadTutorialMesh("ring"), {20, 35, 1}},
                               {"two holes", GetShape("genus2"), {35, 55, 1}},
                               {"open patch", GetShape("mixedPatch"), {20, 50, 1}}};
    constexpr int kLevel = 2;
    std::vector<std::string> controls, refined;
    bool areManifold = true;
    int numFaces = 0, numHexagons = 0;
    for (Entry const &entry : entries) {
        auto const levels = RefineSurface(entry.shape, MakeHexagonal(FaceMask::Average), kLevel);
        PolygonMesh const &mesh = levels.back().mesh;
        PictureOptions options;
        options.view = entry.view;
        options.hasWireframe = true;
        options.isTinted = true;
        controls.push_back(Captioned(DrawMesh(levels[0].mesh, levels[0].mesh, options, settings),
                                     entry.name + ", control mesh"));
        refined.push_back(Captioned(DrawMesh(mesh, levels[0].mesh, options, settings),
                                    "level 2: " + describeMesh(mesh)));
        numFaces += mesh.GetNumFaces();
        for (int face = 0; face < mesh.GetNumFaces(); ++face) {
            numHexagons += mesh.GetFaceSize(face) == 6 ? 1 : 0;
        }
        areManifold = areManifold && computeEulerCharacteristic(mesh) ==
                                         computeEulerCharacteristic(levels[0].mesh);
    }
    controls.insert(controls.end(), refined.begin(), refined.end());
    page->AddFigure(
        controls, int(entries.size()),
        "Figure 6 of the paper: arbitrary control meshes and their second level, with the paper's "
        "mask and its rule for boundaries.  Polygons that are no hexagons are blue.");
    page->AddClaim(
        "It takes arbitrary surface meshes", Judge(areManifold),
        "Closed and open meshes of any polygons, of any genus: the Euler characteristic of all "
        "four stays.  The tests refine non-manifold and degenerate ones too.  What differs: all "
        "faces of an edge must run it in "
        "a consistent direction.");
    page->AddClaim(
        "It generates a hexagonal scheme without turning a triangle mesh into hexagons first",
        Judge(2 * numHexagons > numFaces),
        "Every edge makes a hexagon: at level 2 of these four meshes " +
            percent(double(numHexagons) / numFaces) +
            " of the faces are hexagons, and the others are the copies of faces of the control "
            "mesh and quads of the border, of which there are never more of the former.");
}

void AddFactorSection(Page *page, Settings const &) {
    page->BeginSection("factors", "Factor three, factor four");
    Shape const tiling = MakeTiling(Tiling::Hexagons, 4, 4);
    PolygonMesh const parent = RefineSurface(tiling, MakeHexagonal(FaceMask::Cosine), 0)[0].mesh;
    PolygonMesh const three = RefineSurface(tiling, MakeTriHex(), 1)[1].mesh;
    PolygonMesh const four = RefineSurface(tiling, MakeHexagonal(FaceMask::Cosine), 1)[1].mesh;
    page->AddFigure(
        {Captioned(DrawPlanarMesh(parent, three), "factor three: tri-hex corner cutting"),
         Captioned(DrawPlanarMesh(parent, four), "factor four: this scheme")},
        2,
        "Figure 7 of the paper: one step of a regular mesh (brown) by the corner cutting of Claes "
        "and others, which turns the lattice by 30 degrees and drops the border, and by the "
        "hexagonal vertex-to-vertex scheme, which keeps the old vertices.  Cosine mask.");

    Shape const torus = GetShape("hexTorus");
    auto const getFaces = [&](HexSchemeOptions const &scheme) {
        return double(RefineSurface(torus, scheme, 1)[1].mesh.GetNumFaces()) / torus.GetNumFaces();
    };
    double const factorThree = getFaces(MakeTriHex());
    double const factorFour = getFaces(MakeHexagonal(FaceMask::Average));
    page->AddClaim("Hexagonal meshes multiply by three (Claes and others) or by four (this scheme)",
                   Judge(factorThree == 3 && factorFour == 4),
                   "On a closed honeycomb a tri-hex step multiplies the faces by " +
                       FormatNumber(factorThree, 3) + ", a hexagonal step by " +
                       FormatNumber(factorFour, 3) + ".");
}

void AddCoplanarSection(Page *page, Settings const &settings) {
    page->BeginSection("stage3", "Stage 3: equal normals");
    page->AddParagraph("Stage 3 of the paper makes a hexagon of an edge only if its two faces "
                       "differ in normal, and otherwise a quad from the four new points alone.  "
                       "Taken literally that leaves gaps around the old vertices; with one "
                       "polygon for each run of flat edges at a vertex the mesh is closed again. "
                       "<code>TopologyRefiner::RefineCoplanar</code> does both.");
    Shape const box =
        makeShape("box", RefineSurface(MakePrism(4), OpenSubdiv::Sdc::SCHEME_BILINEAR, 1)[1].mesh);
    int const level = std::min(3, settings.solidLevel);
    auto const closed = refineCoplanar(box, level, true);
    auto const open = refineCoplanar(box, level, false);
    auto const uniform = RefineSurface(box, MakeHexagonal(FaceMask::Average), level);

    PictureOptions options;
    options.view = {30, 25, 1};
    options.hasWireframe = true;
    options.isTinted = true;
    std::vector<std::string> parts;
    for (auto const &[name, levels] :
         {std::pair("every edge a hexagon", &uniform), std::pair("stage 3, literal", &open),
          std::pair("stage 3, closed", &closed)}) {
        int const shown = std::min(2, level);
        PolygonMesh const &mesh = (*levels)[shown].mesh;
        parts.push_back(Captioned(DrawMesh(mesh, (*levels)[0].mesh, options, settings),
                                  std::string(name) + ", level " + std::to_string(shown) + ": " +
                                      std::to_string(countOpenEdges(mesh)) + " open edges"));
    }
    page->AddFigure(parts, 3,
                    "A box with 2 x 2 faces on each side.  Within a side all normals agree; there "
                    "stage 3 makes what Doo-Sabin makes.");
    Table table{{"level", "V, E, F every edge a hexagon", "V, E, F stage 3, closed",
                 "Euler characteristic", "open edges, literal"},
                {},
                "Counts of the box."};
    bool isClosed = true;
    auto const describe = [](PolygonMesh const &mesh) {
        return FormatCount(mesh.GetNumVertices()) + ", " + FormatCount(mesh.numEdges) + ", " +
               FormatCount(mesh.GetNumFaces());
    };
    for (int i = 0; i <= level; ++i) {
        PolygonMesh const &mesh = closed[i].mesh;
        int const characteristic = computeEulerCharacteristic(mesh);
        isClosed = isClosed && countOpenEdges(mesh) == 0 && characteristic == 2;
        table.rows.push_back({std::to_string(i), describe(uniform[i].mesh), describe(mesh),
                              std::to_string(characteristic),
                              FormatCount(countOpenEdges(open[i].mesh))});
    }
    page->AddTable(table);
    int const numOpen = countOpenEdges(open[1].mesh);
    page->AddClaim(
        "Stage 3: an edge between faces of equal normals makes a quad of the four new points",
        Judge(numOpen == 0, isClosed),
        "Taken literally this leaves gaps: " + std::to_string(numOpen) +
            " open edges after one step of a box with 2 x 2 faces a side.  With polygons that "
            "close them the mesh is watertight at every level measured.");
}

} // namespace OpenSubdivHex::Regression
