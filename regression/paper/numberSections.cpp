// SPDX-License-Identifier: Apache-2.0
//
// Counts and numbers: faces and vertices by level, matrices and eigenvalues.
#include "meshes.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/analysis/position.h"
#include "regression/analysis/smoothness.h"
#include "regression/analysis/spectrum.h"
#include "regression/shapes/shapeDescriptor.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

struct Counts {
    long long vertices, edges, faces;

    bool operator==(Counts const &other) const {
        return vertices == other.vertices && edges == other.edges && faces == other.faces;
    }
};

Counts count(PolygonMesh const &mesh) {
    return {mesh.GetNumVertices(), mesh.numEdges, mesh.GetNumFaces()};
}

/// Returns the counts that a step makes of a closed mesh.
Counts predict(SchemeType scheme, Counts parent) {
    auto const [v, e, f] = parent;
    switch (scheme) {
    case SchemeType::Hexagonal:
        return {v + 2 * e, 4 * e, f + e};
    case SchemeType::DooSabin:
        return {2 * e, 4 * e, f + e + v};
    case SchemeType::TriHex:
        return {2 * e, 3 * e, f + v};
    }
    return {};
}

std::string formatEigenvalues(std::vector<double> const &values) {
    std::string text;
    for (double value : values) {
        text += (text.empty() ? "" : ", ") + FormatNumber(value, 4);
    }
    return text;
}

/// The eigenvalues of the matrix that a face makes its new points with, descending.
std::vector<double> computeFaceEigenvalues(LocalSubdivision const &face) {
    Eigen::MatrixXd const block = face.matrix.topLeftCorner(face.order, face.order);
    Eigen::VectorXd const values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(block).eigenvalues();
    std::vector<double> descending(values.data(), values.data() + values.size());
    std::sort(descending.rbegin(), descending.rend());
    return descending;
}

bool areNear(std::vector<double> const &a, std::vector<double> const &b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return std::abs(x - y) < 1e-12; });
}

/// The first row of a face's matrix in units of 1/denominator.
std::string formatRow(LocalSubdivision const &face, int denominator) {
    std::string text;
    for (int j = 0; j < face.order; ++j) {
        text += FormatNumber(denominator * face.matrix(0, j), 0) + " ";
    }
    return text + "/ " + std::to_string(denominator);
}

template <typename REAL>
std::vector<PositionReal<REAL>> refinePositions(FarExt::TopologyRefiner const &refiner,
                                                Shape const &shape) {
    FarExt::PrimvarRefinerReal<REAL> const primvarRefiner(refiner);
    std::vector<PositionReal<REAL>> positions;
    for (int vertex = 0; vertex < shape.GetNumVertices(); ++vertex) {
        // Both precisions get equal values, so that only the arithmetic differs.
        Eigen::Map<Eigen::Vector3d const> const position(&shape.positions[3 * vertex]);
        positions.push_back({position.cast<float>().cast<REAL>()});
    }
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        std::vector<PositionReal<REAL>> refined(refiner.GetLevel(level).GetNumVertices());
        primvarRefiner.Interpolate(level, positions, refined);
        positions = std::move(refined);
    }
    return positions;
}

/// The largest difference between single and double precision, as a part of the shape's radius.
double measureRounding(Shape const &shape, int level) {
    auto const refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get());
    refiner->RefineUniform(level);
    auto const single = refinePositions<float>(*refiner, shape);
    auto const precise = refinePositions<double>(*refiner, shape);
    double largest = 0, radius = 0;
    for (std::size_t i = 0; i < single.size(); ++i) {
        largest = std::max(largest, (single[i].value.cast<double>() - precise[i].value).norm());
    }
    for (int i = 0; i < shape.GetNumVertices(); ++i) {
        double const *const p = &shape.positions[3 * i];
        radius = std::max(radius, std::hypot(p[0], p[1], p[2]));
    }
    return largest / radius;
}

/// The characteristic map of a neighbourhood and of its child, which is the same but smaller.
std::string drawCharacteristicMap(LocalSubdivision const &center) {
    Eigen::VectorXcd const map = ComputeCharacteristicMap(center);
    return DrawPlanarMesh(MakePlanarMesh(center, map), MakePlanarMesh(center, center.matrix * map));
}

/// Limit masks of vertices among hexagons.
Table makeLimitTable() {
    Table table{
        {"vertex", "mask", "itself", "each neighbour", "each next to it", "each opposite"},
        {},
        "Limit masks: the weights of a vertex and of the other vertices of its hexagons for the "
        "point of the surface that it tends to.  Each of the other vertices that count has less "
        "than 0.0004."};
    for (int order : {3, 4}) {
        for (auto const &[name, mask] :
             {std::pair("Average", FaceMask::Average), std::pair("Cosine", FaceMask::Cosine),
              std::pair("Smooth", FaceMask::Smooth)}) {
            LocalSubdivision const center =
                MakeLocalSubdivision(MakeHexagonal(mask), CenterKind::Vertex, order);
            Eigen::VectorXd const weights = ComputeLimitMask(center);
            std::vector<std::string> row{std::to_string(order) + " faces", name};
            for (int place = 0; place < 4; ++place) { // along the first hexagon, from the center
                row.push_back(FormatNumber(weights(center.faces[0][place]), 5));
            }
            table.rows.push_back(row);
        }
    }
    return table;
}

} // namespace

void AddCountSection(Page *page, Settings const &settings) {
    page->BeginSection("counts", "Faces and vertices");
    Shape const solid = MakeDodecahedron();
    struct Entry {
        std::string name;
        std::string formula;
        HexSchemeOptions scheme;
        int color;
        std::vector<Counts> counts;
    };
    std::vector<Entry> entries{
        {"hexagonal", "V + 2E, 4E, F + E", MakeHexagonal(FaceMask::Average), 0, {}},
        {"Doo-Sabin", "2E, 4E, F + E + V", MakeDooSabin(FaceMask::Average), 1, {}},
        {"tri-hex", "2E, 3E, F + V", MakeTriHex(), 2, {}}};
    Table table{{"level"}, {}, ""};
    bool isAsForetold = true;
    for (Entry &entry : entries) {
        table.header.push_back(entry.name + ": V, E, F");
        table.caption += (table.caption.empty() ? "" : "; ") + entry.name + " " + entry.formula;
        for (SurfaceLevel const &level : RefineSurface(solid, entry.scheme, settings.solidLevel)) {
            entry.counts.push_back(count(level.mesh));
        }
    }
    table.caption =
        "The dodecahedron.  A tick: as the formula makes it of the level before: " + table.caption +
        ".";
    Plot plot{"Faces of the dodecahedron", "level", "faces", true, {}};
    for (int level = 0; level <= settings.solidLevel; ++level) {
        std::vector<std::string> row{std::to_string(level)};
        for (Entry const &entry : entries) {
            Counts const counts = entry.counts[level];
            bool const isRight =
                level == 0 || counts == predict(entry.scheme.schemeType, entry.counts[level - 1]);
            isAsForetold = isAsForetold && isRight;
            std::string const mark = level == 0 ? ""
                                     : isRight  ? " <span class=\"ok\">✓</span>"
                                                : " <span class=\"off\">✗</span>";
            row.push_back(FormatCount(counts.vertices) + ", " + FormatCount(counts.edges) + ", " +
                          FormatCount(counts.faces) + mark);
        }
        table.rows.push_back(row);
    }
    for (Entry const &entry : entries) {
        Series series{entry.name, {}, entry.color};
        for (std::size_t level = 0; level < entry.counts.size(); ++level) {
            series.points.emplace_back(double(level), double(entry.counts[level].faces));
        }
        plot.series.push_back(series);
    }
    auto const getLast = [&](int scheme) { return entries[scheme].counts.back(); };
    auto const getGrowth = [&](int scheme) {
        std::vector<Counts> const &counts = entries[scheme].counts;
        return double(counts.back().faces) / double(counts[counts.size() - 2].faces);
    };
    Plot ratio{"Faces of Doo-Sabin by faces of the hexagonal scheme", "level", "ratio", false, {}};
    ratio.series.push_back({"Doo-Sabin : hexagonal", {}, 1});
    for (std::size_t level = 0; level < entries[0].counts.size(); ++level) {
        ratio.series[0].points.emplace_back(double(level),
                                            double(entries[1].counts[level].faces) /
                                                double(entries[0].counts[level].faces));
    }
    page->AddTable(table);
    page->AddFigure(
        {DrawPlot(plot), DrawPlot(ratio)}, 2,
        "Hexagonal and Doo-Sabin have the same number of edges; Doo-Sabin has half as many faces "
        "again in the long run.");
    double const share = double(getLast(0).faces) / double(getLast(1).faces);
    std::string const level = std::to_string(settings.solidLevel);
    page->AddClaim(
        "It makes fewer faces than Doo-Sabin at every level", Judge(isAsForetold && share < 1),
        "At level " + level + " of the dodecahedron " + FormatCount(getLast(0).faces) +
            " against " + FormatCount(getLast(1).faces) + ", " +
            FormatNumber(100 * (1 - share), 1) + "&#8239;% fewer; in the limit a third.  It has " +
            FormatCount(getLast(0).vertices) + " vertices against " +
            FormatCount(getLast(1).vertices) + ".");
    page->AddClaim(
        "It manages the exponential growth of the number of faces",
        Judge(getGrowth(0) < 0.9 * getGrowth(1), share < 0.9),
        "The constant is smaller, the growth is not: the last step multiplied the faces by " +
            FormatNumber(getGrowth(0), 3) + ", with Doo-Sabin by " + FormatNumber(getGrowth(1), 3) +
            " and with tri-hex by " + FormatNumber(getGrowth(2), 3) + ".");
}

void AddEigenvalueSection(Page *page, Settings const &settings) {
    page->BeginSection("eigenvalues", "Matrices and eigenvalues");
    auto const makeFace = [](HexSchemeOptions const &scheme, int n) {
        return MakeLocalSubdivision(scheme, CenterKind::Face, n);
    };
    page->AddParagraph(
        "The matrices are read off the stencil tables of the refiner, around a vertex or a face "
        "with everything else regular.  Section 6 of the paper looks at the points that a face "
        "makes of its own vertices.");
    Table faces{{"face", "mask", "first row", "eigenvalues"}, {}, ""};
    struct Mask {
        char const *name;
        FaceMask mask;
        int denominators[2];
    };
    for (auto const &[name, mask, denominators] :
         {Mask{"Average (the paper's)", FaceMask::Average, {16, 24}},
          Mask{"Cosine", FaceMask::Cosine, {16, 24}}, Mask{"Smooth", FaceMask::Smooth, {16, 16}}}) {
        for (int n : {4, 6}) {
            LocalSubdivision const face = makeFace(MakeHexagonal(mask), n);
            faces.rows.push_back({std::to_string(n) + " sides", name,
                                  formatRow(face, denominators[n == 4 ? 0 : 1]),
                                  formatEigenvalues(computeFaceEigenvalues(face))});
        }
    }
    faces.caption =
        "The matrices of a quad and a hexagon, M<sub>4</sub> and M<sub>6</sub> of the paper's "
        "section 6.1 with the mask Average.";
    page->AddTable(faces);
    LocalSubdivision const quad = makeFace(MakeHexagonal(FaceMask::Average), 4);
    LocalSubdivision const hexagon = makeFace(MakeHexagonal(FaceMask::Average), 6);
    page->AddClaim(
        "M<sub>4</sub> has the eigenvalues 1, 1/2, 1/2, 1/4 and M<sub>6</sub> has 1, 5/8, 5/8, "
        "3/8, 3/8, 1/4",
        Judge(areNear(computeFaceEigenvalues(quad), {1, 0.5, 0.5, 0.25}) &&
              areNear(computeFaceEigenvalues(hexagon), {1, 0.625, 0.625, 0.375, 0.375, 0.25})),
        "To 12 digits, from the refiner's own tables: " +
            formatEigenvalues(computeFaceEigenvalues(quad)) + " and " +
            formatEigenvalues(computeFaceEigenvalues(hexagon)) + ".");

    bool areOrdered = true;
    for (int n = 3; n <= 12; ++n) {
        std::vector<double> const values =
            computeFaceEigenvalues(makeFace(MakeHexagonal(FaceMask::Average), n));
        bool const hasPair = std::abs(values[1] - values[2]) < 1e-12;
        bool const isAbove = n == 3 || values[2] > values[3] + 1e-6;
        bool const hasNextPair = n < 5 || std::abs(values[3] - values[4]) < 1e-12;
        areOrdered =
            areOrdered && std::abs(values[0] - 1) < 1e-12 && hasPair && isAbove && hasNextPair;
    }
    page->AddClaim(
        "The largest eigenvalue is 1, the second and third are equal and above the others, "
        "the fourth and fifth are equal",
        Judge(areOrdered),
        "For faces with 3 to 12 sides; triangles and quads have no fifth.  It says little of "
        "curvature, which depends on the whole neighbourhood.");

    // Sub-dominant eigenvalues and the growth of curvature by valence.
    struct Line {
        std::string name;
        HexSchemeOptions scheme;
        CenterKind kind;
        int color;
        bool isDashed;
    };
    std::vector<Line> const lines{
        {"Average, vertex", MakeHexagonal(FaceMask::Average), CenterKind::Vertex, 0, false},
        {"Average, face", MakeHexagonal(FaceMask::Average), CenterKind::Face, 0, true},
        {"Cosine, vertex", MakeHexagonal(FaceMask::Cosine), CenterKind::Vertex, 1, false},
        {"Cosine, face", MakeHexagonal(FaceMask::Cosine), CenterKind::Face, 1, true},
        {"Smooth, vertex", MakeHexagonal(FaceMask::Smooth), CenterKind::Vertex, 2, false},
        {"Smooth, face", MakeHexagonal(FaceMask::Smooth), CenterKind::Face, 2, true},
        {"Smooth, tri-hex first", MakeTriHexFirst(FaceMask::Smooth), CenterKind::Vertex, 3, false},
        {"tri-hex, face", MakeTriHex(), CenterKind::Face, 4, true}};
    Plot subdominant{
        "Sub-dominant eigenvalue λ", "faces at the vertex, sides of the face", "λ", false, {}};
    Plot growth{"Factor of curvature per step, μ/λ²",
                "faces at the vertex, sides of the face",
                "factor",
                false,
                {}};
    Table table{{"center", "k, n = 3", "4", "5", "6", "8", "12"},
                {},
                "What curvature at the center is multiplied by with every step, μ/λ² (above 1: "
                "unbounded), and the eigenvalues: the sub-dominant one, λ, and the next, μ.  With "
                "tri-hex they are equal at triangles: no tangent plane there."};
    bool areTangentPlanes = true;
    double paperGrowth = 0, triHexFirstGrowth = 0, smoothVertexGrowth = 0;
    for (Line const &line : lines) {
        Series subdominants{line.name, {}, line.color, line.isDashed};
        Series growths = subdominants;
        std::vector<std::string> row{line.name};
        for (int n = 3; n <= 12; ++n) {
            LocalSubdivision const center = MakeLocalSubdivision(line.scheme, line.kind, n);
            Spectrum const spectrum = ComputeSpectrum(center);
            subdominants.points.emplace_back(n, spectrum.subdominant);
            growths.points.emplace_back(n, spectrum.GetCurvatureGrowth());
            if (n == 3 || n == 4 || n == 5 || n == 6 || n == 8 || n == 12) {
                row.push_back("<b>" + FormatNumber(spectrum.GetCurvatureGrowth(), 2) + "</b><br>" +
                              FormatNumber(spectrum.subdominant, 3) + ", " +
                              FormatNumber(spectrum.next, 3));
            }
            if (line.scheme.schemeType == SchemeType::Hexagonal) {
                areTangentPlanes = areTangentPlanes && spectrum.HasTangentPlane() &&
                                   IsRegular(center, ComputeCharacteristicMap(center));
            }
            bool const isRegular = line.kind == CenterKind::Vertex && n == 3;
            if (line.scheme.firstStep == FirstStep::TriHex) {
                triHexFirstGrowth = std::max(triHexFirstGrowth, spectrum.GetCurvatureGrowth());
            } else if (isRegular && line.scheme.faceMask == FaceMask::Average) {
                paperGrowth = spectrum.GetCurvatureGrowth();
            } else if (line.kind == CenterKind::Vertex &&
                       line.scheme.faceMask == FaceMask::Smooth) {
                smoothVertexGrowth = std::max(smoothVertexGrowth, spectrum.GetCurvatureGrowth());
            }
        }
        subdominant.series.push_back(subdominants);
        growth.series.push_back(growths);
        table.rows.push_back(row);
    }
    page->AddFigure(
        {DrawPlot(subdominant), DrawPlot(growth)}, 2,
        "All eigenvalues around vertices (V-vertices) and faces of the hexagonal scheme, valences "
        "3 to 12.  After one tri-hex step every irregularity is a face of an otherwise 3-valent "
        "mesh, and the factor is 1 everywhere.");
    page->AddTable(table);
    HexSchemeOptions const smooth = MakeHexagonal(FaceMask::Smooth);
    page->AddFigure(
        {Captioned(drawCharacteristicMap(MakeLocalSubdivision(smooth, CenterKind::Vertex, 5)),
                   "vertex with 5 faces"),
         Captioned(drawCharacteristicMap(MakeLocalSubdivision(smooth, CenterKind::Face, 5)),
                   "face with 5 sides"),
         Captioned(drawCharacteristicMap(MakeLocalSubdivision(MakeTriHexFirst(FaceMask::Smooth),
                                                              CenterKind::Vertex, 5)),
                   "the vertex after a tri-hex step: 10 sides")},
        3,
        "Characteristic maps with the mask Smooth (brown), and what one step makes of them "
        "(blue): the same map, smaller by λ, around a vertex turned by half a step.");
    page->AddTable(makeLimitTable());
    page->AddClaim(
        "The eigenvalues show that the scheme is C<sup>1</sup>", Judge(areTangentPlanes),
        "The paper looks at the matrix of one face.  Around every vertex and face of valence 3 to "
        "12, for all three masks, the whole neighbourhood has 1 &gt; λ = λ &gt; μ, and no "
        "characteristic map folds.");
    page->AddClaim(
        "It optimizes the continuity of the surface",
        Judge(paperGrowth <= 1 + 1e-6, triHexFirstGrowth <= 1 + 1e-6),
        "With the paper's mask curvature grows without bound: at a regular vertex by " +
            FormatNumber(paperGrowth, 3) +
            " with every step.  With Cosine or Smooth it is bounded at regular vertices and at "
            "all faces, with Smooth at vertices with up to seven faces, too, and grows by up to " +
            FormatNumber(smoothVertexGrowth, 2) +
            " at those with up to 12; with a tri-hex step first the factor is " +
            FormatNumber(triHexFirstGrowth, 2) + " everywhere.");

    int const level = settings.solidLevel;
    double const rounding = measureRounding(MakeDodecahedron(), level);
    double leastWeight = 1;
    for (int n = 3; n <= 12; ++n) {
        leastWeight =
            std::min(leastWeight, makeFace(MakeHexagonal(FaceMask::Average), n).matrix.minCoeff());
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", rounding);
    page->AddClaim(
        "It is numerically stable", Judge(leastWeight >= 0 && rounding < 1e-5),
        "All weights are at least 0 and sum to 1, so no point leaves the hull of the control "
        "points.  After " +
            std::to_string(level) + " levels in single precision the largest error is " + text +
            " of the radius.");
}

} // namespace OpenSubdivHex::Regression
