// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_SUITE_H
#define OPENSUBDIVHEX_REGRESSION_PERF_SUITE_H

#include "results.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

class GlContext;

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
        std::string title = "Results of the benchmarks";
        std::vector<Row> const *rows = &GetRows(); ///< that are to be measured
    };

    explicit Suite(Options options);

    /// A quad, a triangle and a hexagonal mesh, each at two sizes.
    std::vector<BenchMesh> const &GetMeshes() const { return _meshes; }
    /// Triangles, of which any number meet at a vertex; and "spot", where its file is there.
    std::vector<BenchMesh> const &GetIrregularMeshes() const { return _irregularMeshes; }
    /// Meshes that are large or small themselves, of quads and of triangles.
    std::vector<BenchMesh> const &GetBaseMeshes() const { return _baseMeshes; }
    /// One mesh at several levels.
    std::vector<BenchMesh> const &GetGrowthMeshes() const { return _growthMeshes; }

    /// One whose last level is a frame of a device.
    BenchMesh const &GetFrameMesh() const { return _frameMesh; }
    /// The mesh one level further: all its levels together have more than 2^31 bytes at length 3.
    BenchMesh GetHugeMesh() const;

    /// Adds a benchmark whose contestants \p makeContest makes when it is run.
    void AddContest(Setting const &setting, std::function<Contest()> const &makeContest);

    /// Adds a benchmark whose \p measure makes a figure of \p row and the same of the peer.
    void AddMeasurement(Setting const &setting, std::string const &row,
                        std::function<std::pair<double, double>()> const &measure);

    /// \brief Runs all benchmarks, those on a warm heap last, and calls \p afterEach behind each of them.
    /// \return  false if one of them failed, which the log names
    bool Run(std::function<void()> const &afterEach);

    Results const &GetResults() const { return _results; }

private:
    struct Benchmark {
        std::string name;
        Memory memory;
        int numTurns;
        std::function<void(benchmark::State &)> run;
    };
    void add(Setting const &setting, int numTurns, std::function<void(benchmark::State &)> run);
    void run(Memory memory, std::function<void()> const &afterEach);
    void nameFrameMesh();

    Options _options;
    std::vector<Row> _rows; ///< those of the options, with the mesh of frames in their work
    std::vector<BenchMesh> _meshes;
    std::vector<BenchMesh> _irregularMeshes;
    std::vector<BenchMesh> _baseMeshes;
    std::vector<BenchMesh> _growthMeshes;
    BenchMesh _frameMesh;
    std::vector<Benchmark> _benchmarks;
    Results _results;
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
void AddMaskBenchmarks(Suite &suite);
void AddLimitBenchmarks(Suite &suite);
void AddPatchBenchmarks(Suite &suite);
void AddSurfaceBenchmarks(Suite &suite);
void AddViewBenchmarks(Suite &suite);
void AddDrawingBenchmarks(Suite &suite);
void AddGrowthBenchmarks(Suite &suite);
void AddBusyBenchmarks(Suite &suite);
/// Adds the benchmarks of GetDeviceRows(), in a context of OpenGL that lives as long as the suite.
void AddDeviceBenchmarks(Suite &suite, GlContext const &context);
/// The others of these, which need a device of CUDA: its name; empty where there is none, with \p reason.
std::string GetCudaDevice(std::string &reason);
void AddCudaBenchmarks(Suite &suite);
/// Adds a benchmark of \p row, milliseconds: the median of some frames, which \p makeFrame makes.
void AddFrameBenchmark(Suite &suite, std::string const &row,
                       std::function<std::function<void()>(BenchMesh const &)> const &makeFrame);
/// @}

} // namespace OpenSubdivHex::Regression

#endif
