// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_SUITE_H
#define OPENSUBDIVHEX_REGRESSION_PERF_SUITE_H

#include "contest.h"
#include "rows.h"

#include "regression/shapes/shapes.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A base mesh and the level that it is refined to.
struct BenchMesh {
    std::shared_ptr<Shape const> shape;
    std::string name; ///< quad, triangle or hexagon
    std::string size; ///< small or large; levels 1 ... 6: growth
    int level;
};

/// \brief Where the memory that the work takes comes from, the same for own and peer.
enum class Memory {
    Default,  ///< malloc as it is: large arrays get fresh pages each time
    Warm,     ///< a heap that keeps what was freed, see KeepFreedMemory()
    Resident, ///< the work takes none: its sources and results were touched before
};
std::string GetName(Memory memory);

/// \brief What is measured together.
struct Setting {
    std::string work; ///< of the contestants, as printed
    std::string item; ///< that their costs are per
    BenchMesh mesh;
    Memory memory;
};

/// \brief Costs measured in turns.
struct ContestResult {
    Setting setting;
    std::vector<Cost> costs;
};

/// \brief A figure of a row.
struct Figure {
    Row const *row;
    Setting setting;
    double value;
    double peerValue; ///< the same of the peer, where the figure is no ratio of both; else 0
};

/// Compares contestants, by their place among those of the contest.
struct Pairing {
    std::string row;
    std::size_t own;
    std::vector<std::size_t> peers; ///< the fastest of them counts
};

/// \brief Contestants, and the rows that their costs make figures of.
struct Contest {
    std::vector<Contestant> contestants;
    std::vector<Pairing> pairings = {};
};

/// \brief All benchmarks, with the results so far.
class Suite {
public:
    struct Options {
        bool isQuick = false; ///< tiny sizes and one turn, to see that everything runs
        int numTurns = 7;     ///< of large sizes; small ones have three times as many
        std::string filter;   ///< regular expression that names of benchmarks must contain
    };

    explicit Suite(Options options);

    /// A quad, a triangle and a hexagonal mesh, each at two sizes.
    std::vector<BenchMesh> const &GetMeshes() const { return _meshes; }
    /// Meshes that are large or small themselves, of quads and of triangles.
    std::vector<BenchMesh> const &GetBaseMeshes() const { return _baseMeshes; }
    /// One mesh at several levels.
    std::vector<BenchMesh> const &GetGrowthMeshes() const { return _growthMeshes; }

    /// Adds a benchmark whose contestants \p makeContest makes when it is run.
    void AddContest(Setting const &setting, std::function<Contest()> const &makeContest);

    /// Adds a benchmark whose \p measure makes a figure of \p row and the same of the peer.
    void AddMeasurement(Setting const &setting, std::string const &row,
                        std::function<std::pair<double, double>()> const &measure);

    /// \brief Runs all benchmarks, those on a warm heap last.
    /// \return  false if one of them failed, which the log names
    bool Run();

    std::vector<ContestResult> const &GetResults() const { return _results; }
    std::vector<Figure> const &GetFigures() const { return _figures; }

private:
    struct Benchmark {
        std::string name;
        Memory memory;
        int numTurns;
        std::function<void(benchmark::State &)> run;
    };
    void add(Setting const &setting, int numTurns, std::function<void(benchmark::State &)> run);
    void run(Memory memory);

    Options _options;
    std::vector<BenchMesh> _meshes;
    std::vector<BenchMesh> _baseMeshes;
    std::vector<BenchMesh> _growthMeshes;
    std::vector<Benchmark> _benchmarks;
    std::vector<ContestResult> _results;
    std::vector<Figure> _figures;
    bool _isComplete = true;
};

/// @name The benchmarks, added to a suite
/// @{
void AddTablePeakBenchmarks(Suite &suite);
void AddCopyBenchmarks(Suite &suite);
void AddPhaseBenchmarks(Suite &suite);
void AddTopologyBenchmarks(Suite &suite);
void AddPositionBenchmarks(Suite &suite);
void AddStencilTableBenchmarks(Suite &suite);
void AddEvaluationBenchmarks(Suite &suite);
void AddTableFreeBenchmarks(Suite &suite);
void AddLimitBenchmarks(Suite &suite);
void AddGrowthBenchmarks(Suite &suite);
void AddBusyBenchmarks(Suite &suite);
/// @}

} // namespace OpenSubdivHex::Regression

#endif
