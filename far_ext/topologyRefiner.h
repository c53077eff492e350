// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_H

#include "mask.h"
#include "topologyLevel.h"

#include <opensubdiv/sdc/options.h>

#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief What distinguishes one hexagonal scheme from another.
struct SchemeOptions {
    FaceMask faceMask = FaceMask::Average;
};

/// \brief The topology of a mesh and of its hexagonal refinements, level by level.
///
/// Made by TopologyRefinerFactory, which copies what it needs: nothing refers to the base refiner
/// or descriptor afterwards.  All queries are const and safe to call from several threads.
class TopologyRefiner {
public:
    /// Takes the base level.  Use TopologyRefinerFactory, which validates it.
    TopologyRefiner(std::unique_ptr<internal::LevelTopology> baseLevel, Sdc::Options sdcOptions,
                    SchemeOptions schemeOptions);
    ~TopologyRefiner();

    TopologyRefiner(TopologyRefiner const &) = delete;
    TopologyRefiner &operator=(TopologyRefiner const &) = delete;

    SchemeOptions GetHexSchemeOptions() const { return _schemeOptions; }
    /// The boundary and crease options of the base mesh.
    Sdc::Options GetSchemeOptions() const { return _sdcOptions; }

    int GetNumLevels() const { return int(_levels.size()); }
    int GetMaxLevel() const { return GetNumLevels() - 1; }
    bool IsUniform() const { return true; }

    /// Whether the base has faces tagged as holes.
    bool HasHoles() const { return !_topologies[0]->faceHoles.empty(); }

    /// @name Face-varying channels, as in Far::TopologyRefiner
    /// @{
    int GetNumFVarChannels() const { return GetLevel(0).GetNumFVarChannels(); }
    Sdc::Options::FVarLinearInterpolation GetFVarLinearInterpolation(int channel = 0) const;
    /// Sum over all levels.
    int GetNumFVarValuesTotal(int channel = 0) const;
    /// @}

    /// Sums over all levels.
    int GetNumVerticesTotal() const;
    int GetNumEdgesTotal() const;
    int GetNumFacesTotal() const;
    int GetNumFaceVerticesTotal() const;

    TopologyLevel const &GetLevel(int level) const { return _levels[level]; }

    /// \brief Options of RefineUniform, as Far::TopologyRefiner::UniformOptions.
    struct UniformOptions {
        UniformOptions(int level) : refinementLevel(level) {}

        int refinementLevel;                  ///< number of refinement steps, 0 or more
        bool fullTopologyInLastLevel = false; ///< false: the last level has face-vertices alone
    };

    /// \brief Refines all faces \p options.refinementLevel times, replacing earlier refinements.
    ///
    /// \return  false with StatusCode::InvalidArgument for a negative level, and with
    ///          StatusCode::TooLarge, which names the level and the count, when a size or the sum
    ///          of a size over the levels exceeds 2^31 - 1.  No memory is taken then and the
    ///          levels are as before.
    bool RefineUniform(UniformOptions options, Status *status = nullptr);

    /// The options of the last successful RefineUniform.
    UniformOptions GetUniformOptions() const { return _uniformOptions; }

    /// Removes all levels but the base; their memory is kept for the next refinement.
    void Unrefine();

private:
    void setNumLevels(int numLevels);
    int total(int (TopologyLevel::*count)() const) const;

    Sdc::Options _sdcOptions;
    SchemeOptions _schemeOptions;
    UniformOptions _uniformOptions{0};
    /// Arrays of all levels ever made (the memory is reused), the first _levels.size() in use.
    std::vector<std::unique_ptr<internal::LevelTopology>> _topologies;
    std::vector<TopologyLevel> _levels;
};

} // namespace OpenSubdivHex::FarExt

#endif
