// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_QUAD_LINE_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_QUAD_LINE_REFERENCE_H

#include "lineReference.h"

#include <vector>

namespace OpenSubdivHex::Regression {

/// Fills linesOut and linesIn of a mesh that no step has made: of the quads beside smooth lines.
void BeginQuadLines(TaggedMesh &mesh);

/// The rules of a corner by the paths of its edges from lines, which it has from the way of its quad beside these: one of
/// each line, in the order in which they are mixed in.
std::vector<LineRule> FindQuadLineRules(LinePaths const &out, LinePaths const &in);

} // namespace OpenSubdivHex::Regression

#endif
