// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_RESULTS_H
#define OPENSUBDIVHEX_REGRESSION_PERF_RESULTS_H

#include "contest.h"
#include "rows.h"

#include "regression/shapes/shapes.h"

#include <memory>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief A base mesh and the level that it is refined to.
struct BenchMesh {
    std::shared_ptr<Shape const> shape;
    std::string name; ///< quad, triangle, hexagon; of surfaces irregular and spot, too
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

/// \brief The conditions that measurements share.
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

/// \brief Measurements, and the figures that follow from them.
struct Results {
    std::string title;
    /// The rows that were to be measured.
    std::vector<Row> const *rows;
    /// An explanation of the sizes and the memory that the results name.
    std::string conditions;
    std::vector<ContestResult> contests = {};
    std::vector<Figure> figures = {};

    /// Adds costs, and the figures of the rows that \p pairings name.
    void Add(Setting const &setting, std::vector<Cost> costs, std::vector<Pairing> const &pairings);
};

} // namespace OpenSubdivHex::Regression

#endif
