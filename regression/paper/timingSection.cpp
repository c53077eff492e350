// SPDX-License-Identifier: Apache-2.0
//
// Running time of the schemes, in turns on the same machine.
#include "meshes.h"
#include "plot.h"
#include "schemes.h"
#include "sections.h"

#include "far_ext/executor.h"
#include "far_ext/primvarRefiner.h"
#include "far_ext/topologyRefinerFactory.h"
#include "regression/shapes/meshOperations.h"
#include "regression/shapes/shapeDescriptor.h"
#include "tools/mesh/point.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

double median(std::vector<double> values) {
    auto const middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// \brief One way to refine a shape, ready to be timed.
class Runner {
public:
    Runner(std::string runnerName, int runnerColor, Shape const &shape,
           HexSchemeOptions const &scheme, bool isGeneral)
        : name(std::move(runnerName)), color(runnerColor), _isGeneral(isGeneral) {
        _refiner = FarExt::TopologyRefinerFactory::Create(ShapeDescriptor(shape).Get(),
                                                          Sdc::Options(), {scheme});
        for (int vertex = 0; vertex < shape.GetNumVertices(); ++vertex) {
            double const *const p = &shape.positions[3 * vertex];
            _base.push_back({float(p[0]), float(p[1]), float(p[2])});
            _restPositions.insert(_restPositions.end(), {float(p[0]), float(p[1]), float(p[2])});
        }
    }

    /// Seconds for topology and for positions of levels 1 ... level.
    std::pair<double, double> Run(int level) {
        using Clock = std::chrono::steady_clock;
        auto const start = Clock::now();
        bool isRefined = false;
        if (_isGeneral) {
            FarExt::TopologyRefiner::CoplanarOptions options(level);
            options.angleTolerance = 0;
            isRefined = _refiner->RefineCoplanar(_restPositions.data(), options);
        } else {
            isRefined = _refiner->RefineUniform(level);
        }
        auto const middle = Clock::now();
        if (!isRefined) {
            throw std::runtime_error(name + " cannot be timed");
        }
        FarExt::PrimvarRefiner const primvarRefiner(*_refiner);
        _positions.resize(std::size_t(level) + 1);
        _positions[0] = _base;
        for (int i = 1; i <= level; ++i) {
            _positions[i].resize(_refiner->GetLevel(i).GetNumVertices());
            primvarRefiner.Interpolate(i, _positions[i - 1], _positions[i]);
        }
        std::chrono::duration<double> const topology = middle - start;
        std::chrono::duration<double> const positions = Clock::now() - middle;
        return {topology.count(), positions.count()};
    }

    FarExt::TopologyLevel const &GetLevel(int level) const { return _refiner->GetLevel(level); }

    std::string name;
    int color;

private:
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    bool _isGeneral;
    std::vector<Tools::Point> _base;
    std::vector<float> _restPositions;
    std::vector<std::vector<Tools::Point>> _positions;
};

struct Times {
    double topology, positions; ///< medians, seconds
    double total;
    int numFaces, numVertices;
};

} // namespace

void AddTimingSection(Page *page, Settings const &settings) {
    page->BeginSection("timing", "Running time");
    FarExt::ExecutorScope const oneThread(nullptr, 1); // since not all steps can use several
    Shape solid = MakeDodecahedron();
    Deform(solid); // so that no two normals agree exactly
    HexSchemeOptions const hexagonal = MakeHexagonal(FaceMask::Average);
    std::vector<Runner> runners;
    runners.emplace_back("hexagonal, its own step", 0, solid, hexagonal, false);
    runners.emplace_back("hexagonal, general builder", 3, solid, hexagonal, true);
    runners.emplace_back("Doo-Sabin, general builder", 1, solid, MakeDooSabin(FaceMask::Average),
                         false);
    runners.emplace_back("tri-hex, general builder", 2, solid, MakeTriHex(), false);
    enum { kOwn, kGeneral, kDooSabin, kTriHex };

    std::vector<std::vector<Times>> times(runners.size()); // by level - 1
    for (int level = 1; level <= settings.timingLevel; ++level) {
        std::vector<std::vector<double>> topology(runners.size()), positions(runners.size()),
            total(runners.size());
        for (int round = -1; round < settings.numRounds; ++round) {
            for (std::size_t i = 0; i < runners.size(); ++i) {
                auto const [first, second] = runners[i].Run(level);
                if (round >= 0) { // the first round warms up
                    topology[i].push_back(first);
                    positions[i].push_back(second);
                    total[i].push_back(first + second);
                }
            }
        }
        for (std::size_t i = 0; i < runners.size(); ++i) {
            FarExt::TopologyLevel const &last = runners[i].GetLevel(level);
            times[i].push_back({median(topology[i]), median(positions[i]), median(total[i]),
                                last.GetNumFaces(), last.GetNumVertices()});
        }
        if (times[kOwn].back().numFaces != times[kGeneral].back().numFaces) {
            throw std::runtime_error("the general builder made other faces");
        }
    }

    page->AddParagraph(
        "Topology and positions of all levels up to the one given, medians of " +
        std::to_string(settings.numRounds) +
        " rounds in which all take turns, on one thread.  The scheme of the paper has a step of "
        "its own in this library, by closed formulas; Doo-Sabin and tri-hex are made by a general "
        "builder of polygons.  So that schemes are compared and not programs, the hexagonal "
        "scheme is also timed through the general builder (<code>RefineCoplanar</code> with "
        "tolerance 0 on a mesh without equal normals), which refines rest positions and compares "
        "normals on top.");
    Plot plot{"Time to a level", "level", "milliseconds", true, {}};
    Plot perFace{"Time per face of the last level", "level", "nanoseconds", true, {}};
    Table table{{"up to level " + std::to_string(settings.timingLevel), "faces", "vertices",
                 "topology, ms", "positions, ms", "both, ms", "ns per face", "ns per vertex"},
                {},
                "Medians of this run, on this machine; ratios are what counts."};
    for (std::size_t i = 0; i < runners.size(); ++i) {
        Series series{runners[i].name, {}, runners[i].color};
        Series faces = series;
        for (std::size_t level = 0; level < times[i].size(); ++level) {
            series.points.emplace_back(double(level + 1), 1e3 * times[i][level].total);
            faces.points.emplace_back(double(level + 1),
                                      1e9 * times[i][level].total / times[i][level].numFaces);
        }
        plot.series.push_back(series);
        perFace.series.push_back(faces);
        Times const last = times[i].back();
        table.rows.push_back(
            {runners[i].name, FormatCount(last.numFaces), FormatCount(last.numVertices),
             FormatNumber(1e3 * last.topology, 2), FormatNumber(1e3 * last.positions, 2),
             FormatNumber(1e3 * last.total, 2), FormatNumber(1e9 * last.total / last.numFaces, 0),
             FormatNumber(1e9 * last.total / last.numVertices, 0)});
    }
    page->AddFigure({DrawPlot(plot), DrawPlot(perFace)}, 2,
                    "Running time of the three schemes on a dodecahedron.");
    page->AddTable(table);

    auto const getRatio = [&](int i, double Times::*time) {
        return times[kDooSabin].back().*time / (times[i].back().*time);
    };
    double const own = getRatio(kOwn, &Times::total);
    double const general = getRatio(kGeneral, &Times::total);
    double const positions = getRatio(kOwn, &Times::positions);
    std::string const level = std::to_string(settings.timingLevel);
    page->AddClaim(
        "It decreases the running time compared with Doo-Sabin",
        Judge(own > 1.05 && general > 1.05, own > 1.05),
        "To level " + level + " Doo-Sabin takes " + FormatNumber(own, 2) +
            " times as long as the hexagonal step of its own, and " + FormatNumber(general, 2) +
            " times as long as the hexagonal scheme through the same general builder.  Positions "
            "alone: " +
            FormatNumber(positions, 2) +
            " times.  The gain comes from closed formulas, which Doo-Sabin could have as well.");
    Times const last = times[kOwn].back();
    page->AddClaim("It is fast enough for an interactive environment", Judge(last.total < 0.1),
                   "Topology and positions of " + FormatCount(last.numVertices) +
                       " vertices, all " + level + " levels: " + FormatNumber(1e3 * last.total, 1) +
                       " ms; the topology is made once, positions alone take " +
                       FormatNumber(1e3 * last.positions, 1) + " ms.");
}

} // namespace OpenSubdivHex::Regression
