// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_REFERENCE_TAGGED_RULES_H
#define OPENSUBDIVHEX_REGRESSION_REFERENCE_TAGGED_RULES_H

#include "taggedReference.h"

#include <utility>
#include <vector>

namespace OpenSubdivHex::Regression::TaggedRules {

using Point = Eigen::RowVectorXd;
using Edge = TaggedMesh::Edge;
using Face = TaggedMesh::Face;
using Side = TaggedMesh::Side;

inline bool isInfinite(float sharpness) { return sharpness >= kInfiniteSharpness; }

/// The two ends of an edge, the smaller first.
std::pair<int, int> pairOf(int v, int w);
/// The sides of a face before and behind one of it.
Side previousSide(TaggedMesh const &mesh, Side side);
Side nextSide(TaggedMesh const &mesh, Side side);

/// Sides of a new mesh, gathered edge by edge; fills Face::edges and Vertex::corners.
void connect(TaggedMesh &mesh);

/// A sharp edge as seen from one of its ends.
struct SharpEdge {
    int edge;
    int neighbor;
    bool isLong;
    float sharpness;
};

/// The sharp edges that end in a vertex: of an edge with two sides only one leaves the vertex.
std::vector<SharpEdge> sharpEdges(TaggedMesh const &mesh, int vertex);
/// The lines that end in a vertex: the boundaries that the faces of one base edge got are one, but
/// for the vertices in the middle of a line, which a sheet has for itself.
std::vector<SharpEdge> linesOf(TaggedMesh const &mesh, int vertex,
                               std::vector<SharpEdge> const &edges);

float decremented(float sharpness);
/// The sharpness of a sharp edge after one step, at the vertex where it ends.
float childSharpness(TaggedMesh const &mesh, int vertex, float sharpness);

/// A vertex's share of a rule, and the lines of the rule.
struct RuleShare {
    double weight;
    TaggedRule rule;
    std::vector<SharpEdge> lines;
};
/// One or two, which sum to 1.
std::vector<RuleShare> ruleShares(TaggedMesh const &mesh, int vertex);

/// Faces of a vertex that follow one another counter-clockwise.
struct Fan {
    std::vector<Side> corners;
    bool isClosed;
};
std::vector<Fan> findFans(TaggedMesh const &mesh, int vertex);

} // namespace OpenSubdivHex::Regression::TaggedRules

namespace OpenSubdivHex::Regression {

/// Refine() and Interpolate() of a truncation.
TaggedMesh Truncate(TaggedMesh const &mesh, ReferenceCuts const &cuts);
ReferenceValues InterpolateTruncation(TaggedMesh const &mesh, TaggedMesh const &child,
                                      bool isVarying, ReferenceValues const &values);

} // namespace OpenSubdivHex::Regression

#endif
