// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_JOB_H
#define OPENSUBDIVHEX_TOOLS_JOB_H

#include "adaptive.h"
#include "arguments.h"
#include "evaluation.h"
#include "progress.h"
#include "statistics.h"

#include "tools/mesh/mesh.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief A run of hexrefine, from one mesh file to another: steps, which are called once
/// each, in this order.
///
/// Each throws FileError.  Warnings go to the standard error stream.
class Job {
public:
    /// \param arguments  they must live as long
    /// \param progress   the steps, and nothing else, tell it of their phases
    Job(Arguments const &arguments, Progress &progress);

    /// Reads the file.
    void Read();
    /// Finds the rules, removes what will not be written, and checks the mesh as level 0.
    void Validate();
    /// Makes the topology of the levels: up to the last one, or with --adaptive to the surface level.
    void Refine();
    /// Computes the values of that level, or of its limit, and the cells of --adaptive.
    void Evaluate();
    /// Writes the picture, where one is asked for.
    void Draw();
    /// Writes the mesh, where it is asked for.
    void Write();

    /// Statistics of the steps so far.
    Statistics const &GetStatistics() const { return _statistics; }
    /// The text of --tags, from Validate() on; empty without --tags.
    std::string const &GetTagText() const { return _tagText; }
    /// Likely faults of the mesh, or of the arguments for it, from Validate() on.
    std::vector<std::string> const &GetHints() const { return _hints; }

private:
    /// Does some work of a phase, and adds the time that it takes.
    template <typename WORK>
    void measure(char const *phase, double *milliseconds, WORK &&work);
    bool isAdaptive() const;
    int getLastLevel() const;
    void requireDone(bool isDone, FarExt::CallStatus const &status) const;
    void warn(std::string const &message) const;

    OpenSubdiv::Sdc::Options chooseOptions() const;
    void removeWhatIsNotWritten();
    void removeNormals();
    void createRefiner(OpenSubdiv::Sdc::Options sdcOptions);
    void requireFaces() const;
    void refineTopology();
    void evaluateLevel();
    void evaluatePrimvar(Primvar const &primvar);
    void evaluateLimit();
    void refineCells();
    void drawCells() const;
    void copyFaces();

    Arguments const &_arguments;
    Progress &_progress;
    Statistics _statistics;
    std::string _tagText;
    std::vector<std::string> _hints;
    Mesh _mesh;                // of level 0, then of the last level
    std::vector<int> _regions; // of the picture, by face of level 0
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::optional<AdaptiveRefinement> _cells;
    std::optional<FarExt::LimitSides> _sides; // with --limit
    std::vector<float> _normals;              // of these
};

} // namespace OpenSubdivHex::Tools

#endif
