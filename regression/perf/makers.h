// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_MAKERS_H
#define OPENSUBDIVHEX_REGRESSION_PERF_MAKERS_H

#include "suite.h"

#include "far_ext/rules/mask.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace OpenSubdivHex::Regression {

namespace Far = OpenSubdiv::Far;

/// Throws std::runtime_error that names \p what, unless \p condition.
void Require(bool condition, std::string const &what);

/// @name What several benchmarks need.  Far's refine by Catmull-Clark
/// @{
std::unique_ptr<FarExt::TopologyRefiner>
MakeBase(BenchMesh const &mesh, FarExt::FaceMask faceMask = FarExt::FaceMask::Average);
std::unique_ptr<Far::TopologyRefiner> MakeFarBase(BenchMesh const &mesh);

/// Refined to the level of the mesh, the last one with face-vertices alone.
std::unique_ptr<FarExt::TopologyRefiner>
MakeRefined(BenchMesh const &mesh, FarExt::FaceMask faceMask = FarExt::FaceMask::Average);
std::unique_ptr<Far::TopologyRefiner> MakeFarRefined(BenchMesh const &mesh);
/// MakeRefined() with full topology, for limits.
std::unique_ptr<FarExt::TopologyRefiner> MakeFullyRefined(BenchMesh const &mesh);

using Table = std::unique_ptr<Far::StencilTable const>;

/// Tables of the last level alone, in terms of the control vertices, with offsets.
Table MakeTable(FarExt::TopologyRefiner const &refiner);
Table MakeFarTable(Far::TopologyRefiner const &refiner);

/// All arrays of a table, in bytes.
double GetNumBytes(Far::StencilTable const &table);
/// @}

/// @name Contestants
/// @{
Contestant MakeTopologyContestant(BenchMesh const &mesh, bool isFull, int numThreads);
Contestant MakeFarTopologyContestant(BenchMesh const &mesh, bool isFull);
Contestant MakeTableContestant(std::shared_ptr<FarExt::TopologyRefiner> const &refiner,
                               int numThreads);
Contestant MakeFarTableContestant(std::shared_ptr<Far::TopologyRefiner> const &refiner);
/// @}

} // namespace OpenSubdivHex::Regression

#endif
