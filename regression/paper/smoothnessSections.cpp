// SPDX-License-Identifier: Apache-2.0
//
// How smooth refined meshes are: normals, curvature and reflection lines.
#include "meshes.h"
#include "picture.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "regression/analysis/smoothness.h"
#include "regression/analysis/spectrum.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace {

namespace Sdc = OpenSubdiv::Sdc;

struct Contestant {
    std::string name;
    AnyScheme scheme;
    int color;
    bool isDashed = false;
    bool isPictured = false;
};

} // namespace

void AddSmoothnessSection(Page *page, Settings const &settings) {
    page->BeginSection("smoothness", "Smoothness, level by level");
    page->AddParagraph(
        "Of the largest angle between the normals of neighbouring faces, a surface with bounded "
        "curvature loses half with every step of factor four.  The curvature across an edge, that "
        "angle by the distance of the faces' centroids, settles for such a surface and grows for "
        "others.");
    std::vector<Contestant> const contestants{
        {"hexagonal, Average", MakeHexagonal(FaceMask::Average), 0},
        {"hexagonal, Cosine", MakeHexagonal(FaceMask::Cosine), 1},
        {"hexagonal, Smooth", MakeHexagonal(FaceMask::Smooth), 2},
        {"Smooth, tri-hex first", MakeTriHexFirst(FaceMask::Smooth), 3},
        {"Doo-Sabin, Average", MakeDooSabin(FaceMask::Average), 0, true},
        {"Doo-Sabin, Cosine", MakeDooSabin(FaceMask::Cosine), 1, true},
        {"tri-hex (factor three)", MakeTriHex(), 4, true},
        {"Catmull-Clark", Sdc::SCHEME_CATMARK, 5, true}};
    enum { kHexagonalAverage = 0, kHexagonalCosine = 1, kDooSabinAverage = 4, kDooSabinCosine = 5 };
    std::vector<std::pair<std::string, Shape>> const shapes{
        {"Honeycomb torus, all regular", GetShape("hexTorus")},
        {"Dodecahedron", MakeDodecahedron()}};
    // For each shape: where Average and Cosine have smaller angles than Doo-Sabin's.
    int numSmaller = 0, numSmallerLast = 0, numCompared = 0, numComparedLast = 0;
    std::string lastAngles;
    std::vector<std::string> parts;
    Table table{{"last step", "angle × (torus)", "curvature × (torus)", "angle × (dodecahedron)",
                 "curvature × (dodecahedron)"},
                {},
                "What the last step multiplied the largest angle and the largest curvature by."};
    for (Contestant const &contestant : contestants) {
        table.rows.push_back({contestant.name});
    }
    for (auto const &[name, shape] : shapes) {
        Plot angles{name + ": angle between normals", "level", "largest angle, degrees", true, {}};
        Plot curvatures{name + ": curvature", "level", "largest curvature", true, {}};
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            Contestant const &contestant = contestants[i];
            Series angle{contestant.name, {}, contestant.color, contestant.isDashed};
            Series curvature = angle;
            auto const levels = RefineSurface(shape, contestant.scheme, settings.smoothnessLevel);
            for (std::size_t level = 1; level < levels.size(); ++level) {
                Smoothness const smoothness = MeasureSmoothness(levels[level].mesh);
                angle.points.emplace_back(double(level),
                                          smoothness.maxNormalAngle * 180 / std::acos(-1.0));
                curvature.points.emplace_back(double(level), smoothness.maxCurvature);
            }
            for (Series const *series : {&angle, &curvature}) {
                std::size_t const last = series->points.size() - 1;
                table.rows[i].push_back(
                    FormatNumber(series->points[last].second / series->points[last - 1].second, 3));
            }
            angles.series.push_back(angle);
            curvatures.series.push_back(curvature);
        }
        for (auto const &[own, peer] : {std::pair(kHexagonalAverage, kDooSabinAverage),
                                        std::pair(kHexagonalCosine, kDooSabinCosine)}) {
            auto const &ownPoints = angles.series[own].points;
            auto const &peerPoints = angles.series[peer].points;
            for (std::size_t i = 0; i < ownPoints.size(); ++i) {
                numSmaller += ownPoints[i].second < peerPoints[i].second ? 1 : 0;
                ++numCompared;
            }
            numSmallerLast += ownPoints.back().second < peerPoints.back().second ? 1 : 0;
            ++numComparedLast;
            lastAngles += (lastAngles.empty() ? "" : ", ") +
                          FormatNumber(ownPoints.back().second, 2) + "° against " +
                          FormatNumber(peerPoints.back().second, 2) + "°";
        }
        parts.push_back(DrawPlot(angles));
        parts.push_back(DrawPlot(curvatures));
    }
    page->AddFigure(
        parts, 2,
        "Smoothness by scheme and mask.  Tri-hex takes smaller steps, of factor three.  Average "
        "loses less than half of the angle with every step, and its curvature grows.");
    page->AddTable(table);
    page->AddClaim(
        "It increases the smoothness of the surfaces compared with Doo-Sabin",
        Judge(numSmaller == numCompared, numSmallerLast == numComparedLast),
        "Largest angle between neighbouring normals at level " +
            std::to_string(settings.smoothnessLevel) +
            ", torus and then dodecahedron, each with Average and with Cosine on both sides: " +
            lastAngles + ".  Over all levels it is the smaller one in " +
            std::to_string(numSmaller) + " of " + std::to_string(numCompared) +
            " comparisons.  With the paper's own mask it falls by less than half with every step, "
            "so that Doo-Sabin with the mask Cosine overtakes it.");
}

void AddTipSection(Page *page, Settings const &settings) {
    page->BeginSection("tips", "Curvature at irregular vertices");
    page->AddParagraph("The largest principal curvature, of quadrics fitted to the mesh, at the "
                       "faces around a vertex where n triangles of a control mesh meet, between a "
                       "bowl and a saddle.  All schemes have the same control mesh.  A line that "
                       "goes on rising is a surface without bounded curvature there.");
    std::vector<Contestant> const contestants{
        {"hexagonal, Average", MakeHexagonal(FaceMask::Average), 0},
        {"hexagonal, Smooth", MakeHexagonal(FaceMask::Smooth), 2, false, true},
        {"Cosine, tri-hex first", MakeTriHexFirst(FaceMask::Cosine), 1},
        {"Smooth, tri-hex first", MakeTriHexFirst(FaceMask::Smooth), 3, false, true},
        {"Doo-Sabin, Cosine", MakeDooSabin(FaceMask::Cosine), 1, true},
        {"Catmull-Clark", Sdc::SCHEME_CATMARK, 5, true, true},
        {"Loop", Sdc::SCHEME_LOOP, 6, true}};
    std::vector<int> const orders{3, 5, 6, 8, 12};
    std::vector<std::string> parts;
    std::string growing[2]; // with Catmull-Clark, with Loop
    Table table{
        {"last step"},
        {},
        "What the last step multiplied the curvature by, and in brackets μ/λ², which it tends to, "
        "where the analysis gives it."};
    for (Contestant const &contestant : contestants) {
        table.rows.push_back({contestant.name});
    }
    for (int n : orders) {
        table.header.push_back("n = " + std::to_string(n));
        Plot plot{std::to_string(n) + " triangles at the vertex", "level", "curvature", true, {}};
        for (std::size_t i = 0; i < contestants.size(); ++i) {
            Contestant const &contestant = contestants[i];
            Series series{contestant.name, {}, contestant.color, contestant.isDashed};
            auto const levels = RefineSurface(MakeSaddleBipyramid(n), contestant.scheme,
                                              settings.curvatureLevel, {CenterKind::Vertex, n + 1});
            for (std::size_t level = 1; level < levels.size(); ++level) {
                series.points.emplace_back(
                    double(level), MeasureCurvature(levels[level].mesh, levels[level].center));
            }
            std::size_t const last = series.points.size() - 1;
            double const growth = series.points[last].second / series.points[last - 1].second;
            std::string cell = FormatNumber(growth, 2);
            if (auto const *type = std::get_if<Sdc::SchemeType>(&contestant.scheme);
                type && growth > 1.05) {
                std::string &text = growing[*type == Sdc::SCHEME_LOOP ? 1 : 0];
                text += (text.empty() ? "at n = " : ", ") + std::to_string(n);
            }
            if (auto const *options = std::get_if<HexSchemeOptions>(&contestant.scheme)) {
                cell += " (" +
                        FormatNumber(
                            ComputeSpectrum(MakeLocalSubdivision(*options, CenterKind::Vertex, n))
                                .GetCurvatureGrowth(),
                            2) +
                        ")";
            }
            table.rows[i].push_back(cell);
            plot.series.push_back(series);
        }
        parts.push_back(DrawPlot(plot));
    }

    // Many more steps than a mesh can have, with the matrix of the neighbourhood.
    constexpr int kNumSteps = 16;
    Plot traced{"Many steps of the local matrix, 12 triangles", "step", "curvature", true, {}};
    std::vector<double> bounded, dooSabin;
    for (Contestant const &contestant : contestants) {
        if (auto const *options = std::get_if<HexSchemeOptions>(&contestant.scheme)) {
            std::vector<double> const curvatures =
                TraceCurvature(MakeLocalSubdivision(*options, CenterKind::Vertex, 12), kNumSteps);
            Series series{contestant.name, {}, contestant.color, contestant.isDashed};
            for (std::size_t step = 0; step < curvatures.size(); ++step) {
                series.points.emplace_back(double(step), curvatures[step]);
            }
            traced.series.push_back(series);
            if (options->firstStep == FirstStep::TriHex && options->faceMask == FaceMask::Smooth) {
                bounded = curvatures;
            } else if (options->schemeType == SchemeType::DooSabin) {
                dooSabin = curvatures;
            }
        }
    }
    parts.push_back(DrawPlot(traced));
    page->AddFigure(
        parts, 2,
        "Curvature at an irregular vertex by level.  The last plot goes on with the local matrix, "
        "from a bowl and saddle over the characteristic map.");
    page->AddTable(table);
    auto const getStep = [&](std::vector<double> const &curvatures, int step) {
        return curvatures[step] - curvatures[step - 1];
    };
    auto const getDecay = [&](std::vector<double> const &curvatures) {
        return getStep(curvatures, kNumSteps) / getStep(curvatures, kNumSteps - 1);
    };
    double const decay = getDecay(bounded);
    double const limit = bounded[kNumSteps] + getStep(bounded, kNumSteps) * decay / (1 - decay);
    page->AddParagraph(
        "<b>One tri-hex step first</b> makes every vertex 3-valent.  The eigenvalues are then "
        "1/2, 1/2 and the next 1/4 around all faces, so curvature is bounded everywhere with "
        "Cosine and Smooth.  That bound is reached slowly: at a vertex of 12 triangles, which "
        "becomes a face of 24 sides, the second eigenvalue of the saddle is nearly 1/4 too.  From "
        "the bowl and saddle above, curvature is " +
        FormatNumber(bounded[kNumSteps] / bounded[0], 2) + " times the first after " +
        std::to_string(kNumSteps) + " steps, each step adds " + FormatNumber(decay, 3) +
        " of what the one before added, and the limit is " + FormatNumber(limit / bounded[0], 1) +
        " times.  Doo-Sabin with the mask Cosine has the same eigenvalues, but 1/4 is there twice "
        "with one eigenvector: each step adds " +
        FormatNumber(getDecay(dooSabin), 3) +
        " of what the one "
        "before added, and that has no limit.");
    page->AddParagraph("In the last step measured, curvature still grew by more than 5&#8239;% "
                       "with Catmull-Clark " +
                       (growing[0].empty() ? "nowhere" : growing[0]) + ", with Loop " +
                       (growing[1].empty() ? "nowhere" : growing[1]) + ".");

    PictureOptions options;
    options.view = {0, 68, 1.9f};
    options.look = Tools::SurfaceLook::Zebra;
    std::vector<std::string> pictures;
    Shape const tip = MakeSaddleBipyramid(orders.back());
    for (Contestant const &contestant : contestants) {
        if (contestant.isPictured) {
            auto const levels = RefineSurface(tip, contestant.scheme, settings.maskLevel);
            PolygonMesh const &mesh = levels.back().mesh;
            pictures.push_back(
                Captioned(DrawMesh(mesh, levels[0].mesh, options, settings),
                          contestant.name + "; largest curvature of the whole mesh " +
                              FormatNumber(MeasureSmoothness(mesh).maxCurvature, 1)));
        }
    }
    page->AddFigure(pictures, 3,
                    "Reflection lines where " + std::to_string(orders.back()) +
                        " triangles meet, level " + std::to_string(settings.maskLevel) +
                        ".  Bounded curvature at the vertex is not fairness around it: the "
                        "tri-hex step cuts every corner of the triangles, and its ripples stay.");
}

void AddMaskSection(Page *page, Settings const &settings) {
    page->BeginSection("masks", "Why Smooth differs from Average");
    Shape const ring = LoadTutorialMesh("ring");
    struct Entry {
        char const *name;
        HexSchemeOptions scheme;
    };
    std::vector<Entry> const entries{{"Average", MakeHexagonal(FaceMask::Average)},
                                     {"Cosine", MakeHexagonal(FaceMask::Cosine)},
                                     {"Smooth", MakeHexagonal(FaceMask::Smooth)}};
    PictureOptions options;
    options.aspect = 1.2;
    std::vector<std::string> shaded, lines, close;
    for (Entry const &entry : entries) {
        auto const levels = RefineSurface(ring, entry.scheme, settings.maskLevel);
        PolygonMesh const &mesh = levels.back().mesh;
        options.view = {20, 35, 1.12f};
        options.look = Tools::SurfaceLook::Smooth;
        shaded.push_back(Captioned(DrawMesh(mesh, levels[0].mesh, options, settings), entry.name));
        options.look = Tools::SurfaceLook::Zebra;
        lines.push_back(DrawMesh(mesh, levels[0].mesh, options, settings));
        options.view.zoom = 3;
        close.push_back(
            Captioned(DrawMesh(mesh, levels[0].mesh, options, settings), "three times as near"));
    }
    shaded.insert(shaded.end(), lines.begin(), lines.end());
    shaded.insert(shaded.end(), close.begin(), close.end());
    page->AddFigure(
        shaded, 3,
        "A ring at level " + std::to_string(settings.maskLevel) +
            ", and its reflection lines.  Reflection lines are one order rougher than the "
            "surface: kinks mean that curvature jumps, frays that it is unbounded.");
}

} // namespace OpenSubdivHex::Regression
