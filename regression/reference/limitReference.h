// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_LIMIT_REFERENCE_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_LIMIT_REFERENCE_H

#include "taggedReference.h"

#include <map>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief Where vertices go when hexagonal steps are repeated without end.
///
/// The neighbourhood of a vertex is cut out of the mesh and refined, and the new neighbourhood of the
/// vertex is cut out again, each time as large as before.  Sooner or later it equals an earlier
/// one.  Then the steps between are one matrix, which is applied to the vertex until it stays.
///
/// The mesh must have no free boundary near the vertex, whose limit they have none.
class LimitReference {
public:
    /// \param mask      the rule for new points
    /// \param numRings  faces that are cut out: those at the vertex, those at their vertices, and so on;
    ///                  3 are enough, as more give the same
    explicit LimitReference(ReferenceMask mask, int numRings = 3)
        : _mask(mask), _numRings(numRings) {}

    /// The limit of a vertex, from the values of all vertices of the mesh, a row each.
    Eigen::RowVectorXd Find(TaggedMesh const &mesh, ReferenceValues const &values, int vertex);

private:
    /// All that there is to know of what was cut out, but for the values.
    using Signature = std::vector<int>;
    struct Piece {
        TaggedMesh mesh;
        Signature signature;
        bool comesIn = false; ///< which edge of the first face says what comes first in the next
        std::vector<int> sources; ///< vertices of the mesh that it was cut out of
    };
    /// A step from one piece to the next: the next piece's values, in terms of its own.
    struct Step {
        Signature next;
        Eigen::MatrixXd matrix;
    };

    Piece cutOut(TaggedMesh const &mesh, int vertex, TaggedMesh::Side start, bool comesIn) const;
    Signature addSteps(Piece piece);
    Eigen::RowVectorXd const &findRow(Signature const &signature);
    Eigen::RowVectorXd findRowOfCycle(Signature const &signature) const;

    ReferenceMask const _mask;
    int const _numRings;
    std::map<Signature, Step> _steps;
    std::map<Signature, Eigen::RowVectorXd> _rows; ///< of the limit, in terms of the piece's values
};

} // namespace OpenSubdivHex::Regression

#endif
