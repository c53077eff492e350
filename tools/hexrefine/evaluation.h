// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_EVALUATION_H
#define OPENSUBDIVHEX_TOOLS_EVALUATION_H

#include "far_ext/stencilTableFactory.h"

#include <opensubdiv/far/stencilTable.h>

#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief Values of level 0: arrays of \p width floats for each vertex, or each value of a
/// face-varying channel, that are interpolated alike.
struct Primvar {
    FarExt::StencilMode mode = FarExt::INTERPOLATE_VERTEX;
    int fvarChannel = 0; ///< of INTERPOLATE_FACE_VARYING
    int width = 3;
    std::vector<std::vector<float> *> arrays{};
};

/// \brief The values of --evaluator.
/// @{
inline constexpr char kRefinement[] = "refinement";  ///< OsdExt::RefinementEvaluator
inline constexpr char kStencil[] = "stencil";        ///< OsdExt::ParallelEvaluator
inline constexpr char kStencilCpu[] = "stencil-cpu"; ///< Osd::CpuEvaluator
inline constexpr char kStencilOmp[] = "stencil-omp"; ///< Osd::OmpEvaluator
inline constexpr char kPrimvar[] = "primvar";        ///< FarExt::PrimvarRefiner
/// @}

/// Whether \p evaluator takes a stencil table.
bool NeedsStencils(std::string const &evaluator);

/// \brief Replaces \p primvar's values by those of the refiner's last level, without a table.
/// \param evaluator  refinement, or primvar for a width of 1 to 3
/// \return           false with a status, as from RefinementEvaluator
bool EvaluateLevels(FarExt::TopologyRefiner const &refiner, std::string const &evaluator,
                    Primvar const &primvar, FarExt::CallStatus *status);

/// The table that holds the last level of \p primvar alone; null with a status, as from
/// StencilTableFactory.
std::unique_ptr<OpenSubdiv::Far::StencilTable const>
CreateStencils(FarExt::TopologyRefiner const &refiner, Primvar const &primvar,
               FarExt::CallStatus *status);

/// \brief Replaces \p primvar's values by those that \p table, from CreateStencils, makes of them.
/// \param evaluator  one that takes a table
/// \return           false if it refuses
bool EvaluateStencils(OpenSubdiv::Far::StencilTable const &table, std::string const &evaluator,
                      Primvar const &primvar);

/// The limit points of the refiner's last level, which has full topology, and the derivatives on
/// each of its LimitSides; null with a status, as from LimitStencilTableFactory.
/// \param fromLevel0  whether in terms of the vertices of level 0, or of those of the last level
std::unique_ptr<OpenSubdiv::Far::LimitStencilTable const>
CreateLimitStencils(FarExt::TopologyRefiner const &refiner, bool fromLevel0,
                    FarExt::CallStatus *status);

/// \brief Replaces \p positions by the limit points of \p table, from CreateLimitStencils, in terms
/// of whose vertices they are, and \p normals by a normal for each side, 1 long; 0 where there is no
/// tangent plane.
/// \param evaluator  stencil-cpu, stencil-omp or, for all others, OsdExt::ParallelEvaluator
/// \return           false if it refuses
bool EvaluateLimit(OpenSubdiv::Far::LimitStencilTable const &table, FarExt::LimitSides const &sides,
                   std::string const &evaluator, std::vector<float> *positions,
                   std::vector<float> *normals);

/// \brief Evaluates limits without a table, for a level whose vertices have one side each.
/// \param evaluator  refinement or primvar
/// \return           false with a status, as from RefinementEvaluator or PrimvarRefiner
bool EvaluateLimit(FarExt::TopologyRefiner const &refiner, std::string const &evaluator,
                   std::vector<float> *positions, std::vector<float> *normals,
                   FarExt::CallStatus *status);

/// Makes vectors of three floats 1 long; those without a direction stay 0.
void Normalize(std::vector<float> *vectors);

} // namespace OpenSubdivHex::Tools

#endif
