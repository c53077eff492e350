// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_EVALUATION_H
#define OPENSUBDIVHEX_TUTORIALS_EVALUATION_H

#include "far_ext/topologyRefiner.h"

#include <opensubdiv/far/stencilTable.h>

#include <string>
#include <vector>

namespace OpenSubdivHex::Tutorials {

/// Values of level 0, \p width floats each, that go with the vertices or with a face-varying
/// channel.
struct Primvar {
    int width = 3;
    int fvarChannel = -1; ///< -1: of the vertices
    std::vector<float> *values = nullptr;
};

/// \brief Replaces \p primvar's values by those of the refiner's last level, level by level.
/// Its width is 2 or 3.
void EvaluateLevels(FarExt::TopologyRefiner const &refiner, Primvar const &primvar);

/// The table that holds the last level of \p primvar alone; null with a status, as from
/// StencilTableFactory.
std::unique_ptr<OpenSubdiv::Far::StencilTable const>
CreateStencils(FarExt::TopologyRefiner const &refiner, Primvar const &primvar,
               FarExt::Status *status);

/// \brief Replaces \p primvar's values by those that \p table, from CreateStencils, makes of them.
/// \param evaluator  stencil-cpu or stencil-omp
void EvaluateStencils(OpenSubdiv::Far::StencilTable const &table, std::string const &evaluator,
                      Primvar const &primvar);

/// Makes vectors of three floats 1 long; those without a direction stay 0.
void Normalize(std::vector<float> *vectors);

} // namespace OpenSubdivHex::Tutorials

#endif
