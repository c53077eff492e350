// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_LOCAL_SUBDIVISION_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_LOCAL_SUBDIVISION_H

#include "meshCenter.h"

#include "far_ext/hexSchemeOptions.h"
#include "far_ext/topologyRefiner.h"

#include <opensubdiv/sdc/types.h>

#include <Eigen/Core>

#include <functional>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief One refinement step around a vertex or a face, with everything else regular, as a matrix.
///
/// The neighbourhood is the smallest that has all vertices of the faces that touch the center, and
/// of which the children depend on nothing outside.  Its vertices and those of its child have the
/// same numbers, by their places around the center: of a center vertex the number is 0, those of a
/// center face are 0 ... order - 1, counter-clockwise.
struct LocalSubdivision {
    CenterKind centerKind = CenterKind::Vertex;
    int order = 0; ///< faces at the center vertex, or sides of the center face: the symmetry
    /// Row i: the weights of the vertices for child i.
    Eigen::MatrixXd matrix;
    /// The vertex where each comes to when the neighbourhood is turned a step (2 pi / order)
    /// counter-clockwise.
    std::vector<int> rotation;
    /// Steps by which a child stands further counter-clockwise than the vertex of its number: whole
    /// and half ones.
    double turn = 0;
    /// The faces that lie in the neighbourhood with all their vertices, those at the center first.
    /// The faces at a center vertex begin with it; a center face is the first.
    std::vector<std::vector<int>> faces;

    int GetNumVertices() const { return int(rotation.size()); }
};

/// \brief Runs the refiner on a closed mesh that has a vertex with \p order faces, or a face with
/// \p order sides, and reads the matrix off the stencil table of one of its later steps, when the
/// neighbourhood has become regular.
///
/// The schemes may turn a vertex into a face: Doo-Sabin into one of \p order sides, tri-hex, also
/// as a first step, of twice as many.  The result says what it has become.
///
/// \param order  3 or more
/// \throws std::runtime_error  if the neighbourhood is not the same at both levels
LocalSubdivision MakeLocalSubdivision(FarExt::HexSchemeOptions const &schemeOptions,
                                      CenterKind baseKind, int order);

/// The row of a child vertex: vertices of its parent level, each with its weight.
using ChildRow = std::vector<std::pair<int, double>>;

/// \brief Overload for a mesh that is refined already, around \p center of level \p depth, with rows of the
/// caller's.
///
/// \param getRow  called with vertices of the next level, which has full topology
LocalSubdivision MakeLocalSubdivision(FarExt::TopologyRefiner const &refiner, int depth,
                                      MeshCenter center,
                                      std::function<ChildRow(int)> const &getRow);

/// \brief Overload for one of OpenSubdiv's schemes, Catmull-Clark or Loop, around a vertex, by Far's
/// primvar refiner.
///
/// \param order  3 or more
LocalSubdivision MakeLocalSubdivision(OpenSubdiv::Sdc::SchemeType scheme, int order);

} // namespace OpenSubdivHex::Regression

#endif
