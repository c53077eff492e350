// SPDX-License-Identifier: Apache-2.0
#include "expectations.h"

#include "regression/reference/largestValue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace OpenSubdivHex::Regression {

using FarExt::FaceKind;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

/// All tables of a mode when the mesh is small, else one in float and one in double.
void expectTables(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                  FarExt::StencilMode mode, int seed) {
    for (int flags = 0; flags < 8; ++flags) {
        if (levels[0].rows() < 60 ? flags % 2 == seed % 2 : flags == 6) {
            ASSERT_NO_FATAL_FAILURE(ExpectTable<double>(refiner, levels, mode, 0, flags));
            ASSERT_NO_FATAL_FAILURE(ExpectTable<float>(refiner, levels, mode, 0, flags));
        }
    }
}

/// The numbers of the children of one level.
class NumberingCheck {
public:
    NumberingCheck(TopologyLevel const &parent, TopologyLevel const &child)
        : _parent(parent), _child(child) {}

    void Run() {
        ASSERT_NO_FATAL_FAILURE(expectVertices());
        ASSERT_NO_FATAL_FAILURE(expectFFaces());
        ASSERT_NO_FATAL_FAILURE(expectEFaces());
        ASSERT_NO_FATAL_FAILURE(expectVFaces());
        if (_child.HasFullTopology()) {
            ASSERT_NO_FATAL_FAILURE(expectEdges());
        }
    }

private:
    int fVertex(int corner) const { return _numVVertices + corner; }
    /// The corner where side \p side of an edge starts, or ends.
    int sideCorner(int edge, int side, bool atEnd) const {
        int const face = _parent.GetEdgeFaces(edge)[side];
        int const place = _parent.GetEdgeFaceLocalIndices(edge)[side] + (atEnd ? 1 : 0);
        return _parent.GetFaceFirstCorner(face) + place % _parent.GetFaceVertices(face).size();
    }

    void expectVertices() {
        for (int v = 0; v < _parent.GetNumVertices(); ++v) {
            int const child = _parent.GetVertexChildVertex(v);
            if (child != Far::INDEX_INVALID) {
                ASSERT_EQ(child, _numVVertices++);
            }
        }
        ASSERT_EQ(_child.GetNumVertices(), _numVVertices + _parent.GetNumFaceVertices());
    }

    void expectFFaces() {
        for (int f = 0; f < _parent.GetNumFaces(); ++f) {
            ASSERT_EQ(_parent.GetFaceChildFaces(f).size(), 1);
            ASSERT_EQ(_parent.GetFaceChildFaces(f)[0], f);
            ASSERT_EQ(_child.GetFaceKind(f), FaceKind::Face);
            ASSERT_EQ(_child.GetFaceParentFace(f), f);
            auto const vertices = _parent.GetFaceChildVertices(f);
            ASSERT_EQ(vertices.size(), _parent.GetFaceVertices(f).size());
            for (int i = 0; i < vertices.size(); ++i) {
                ASSERT_EQ(vertices[i], fVertex(_parent.GetFaceFirstCorner(f) + i));
            }
        }
        _numFaces = _parent.GetNumFaces();
    }

    void expectEFaces() {
        for (int e = 0; e < _parent.GetNumEdges(); ++e) {
            int const child = _parent.GetEdgeChildFace(e);
            if (child != Far::INDEX_INVALID) {
                ASSERT_EQ(child, _numFaces++);
                ASSERT_EQ(_child.GetFaceKind(child), FaceKind::Edge);
                ASSERT_EQ(_child.GetFaceParentEdge(child), e);
                ASSERT_EQ(_child.GetFaceParentVertex(child), Far::INDEX_INVALID);
                ASSERT_EQ(_child.GetFaceParentFace(child), _parent.GetEdgeFaces(e)[0]);
            }
        }
    }

    void expectVFaces() {
        int previous = 0;
        for (int f = _numFaces; f < _child.GetNumFaces(); ++f) {
            ASSERT_EQ(_child.GetFaceKind(f), FaceKind::Vertex);
            int const vertex = _child.GetFaceParentVertex(f);
            ASSERT_GE(vertex, previous);
            previous = vertex;
            ASSERT_EQ(_child.GetFaceParentEdge(f), Far::INDEX_INVALID);
            auto const vertices = _child.GetFaceVertices(f);
            int const place = _parent.GetVertexFaces(vertex).FindIndex(_child.GetFaceParentFace(f));
            ASSERT_GE(place, 0);
            ASSERT_EQ(vertices[vertices.size() - 1],
                      fVertex(_parent.GetVertexCorner(vertex, place)));
        }
    }

    /// Edges of F-faces, spokes, and edges of edges.
    void expectEdges() {
        int numEdges = _parent.GetNumFaceVertices();
        for (int f = 0; f < _parent.GetNumFaces(); ++f) {
            auto const edges = _parent.GetFaceChildEdges(f);
            for (int i = 0; i < edges.size(); ++i) {
                ASSERT_EQ(edges[i], _parent.GetFaceFirstCorner(f) + i);
            }
        }
        for (int f = 0; f < _parent.GetNumFaces(); ++f) {
            auto const vertices = _parent.GetFaceVertices(f);
            for (int i = 0; i < vertices.size(); ++i) {
                int const vVertex = _parent.GetVertexChildVertex(vertices[i]);
                int const edge =
                    vVertex < 0 ? -1 : _child.FindEdge(vVertex, _parent.GetFaceChildVertices(f)[i]);
                if (edge >= 0) {
                    ASSERT_EQ(edge, numEdges++);
                }
            }
        }
        for (int e = 0; e < _parent.GetNumEdges(); ++e) {
            auto const children = _parent.GetEdgeChildEdges(e);
            if (_parent.IsEdgeBoundary(e)) {
                if (!children.empty()) {
                    ASSERT_EQ(children[0], numEdges++);
                }
                continue;
            }
            for (bool atEnd : {false, true}) {
                // In tri-hex the F-vertices of both faces belong to the edge.
                bool const isTriHex = _parent.GetEdgeChildFace(e) == Far::INDEX_INVALID;
                int const edge = _child.FindEdge(fVertex(sideCorner(e, 0, atEnd && !isTriHex)),
                                                 fVertex(sideCorner(e, 1, !atEnd && !isTriHex)));
                // Less where two quads share it.
                if (edge >= numEdges) {
                    ASSERT_EQ(edge, numEdges++);
                }
            }
        }
        ASSERT_EQ(_child.GetNumEdges(), numEdges);
        for (int e = 0; e < numEdges; ++e) {
            auto const vertices = _child.GetEdgeVertices(e);
            auto const faces = _child.GetEdgeFaces(e);
            bool const isSpoke = std::min(vertices[0], vertices[1]) < _numVVertices;
            ASSERT_TRUE(isSpoke || faces.size() == 1 || faces[0] < faces[1]) << "edge " << e;
        }
    }

    TopologyLevel const &_parent;
    TopologyLevel const &_child;
    int _numVVertices = 0;
    int _numFaces = 0;
};

} // namespace

void ExpectNumbering(TopologyRefiner const &refiner) {
    FarExt::PrimvarRefiner const primvarRefiner(refiner);
    std::vector<int> baseFaces(refiner.GetLevel(0).GetNumFaces());
    std::iota(baseFaces.begin(), baseFaces.end(), 0);
    for (int level = 1; level <= refiner.GetMaxLevel(); ++level) {
        SCOPED_TRACE(testing::Message() << "level " << level);
        TopologyLevel const &child = refiner.GetLevel(level);
        ASSERT_NO_FATAL_FAILURE(NumberingCheck(refiner.GetLevel(level - 1), child).Run());
        std::vector<int> childBaseFaces(child.GetNumFaces());
        primvarRefiner.InterpolateFaceUniform(level, baseFaces, childBaseFaces);
        for (int f = 0; f < child.GetNumFaces(); ++f) {
            ASSERT_EQ(childBaseFaces[f], child.GetFaceBaseFace(f));
        }
        baseFaces = std::move(childBaseFaces);
    }
}

void ExpectValid(TopologyRefiner const &refiner) {
    for (int level = 0; level <= refiner.GetMaxLevel(); ++level) {
        FarExt::CallStatus status;
        ASSERT_TRUE(refiner.GetLevel(level).Validate(&status))
            << "level " << level << ": " << status.GetErrorMessage();
    }
}

void ExpectLevelsEqual(std::vector<ReferenceValues> const &actual,
                       std::vector<ReferenceValues> const &expected, double tolerance) {
    ASSERT_EQ(actual.size(), expected.size());
    double const allowed = tolerance * std::max(1.0, GetSize(expected[0]));
    for (std::size_t level = 0; level < expected.size(); ++level) {
        ASSERT_EQ(actual[level].rows(), expected[level].rows());
        for (Eigen::Index i = 0; i < expected[level].rows(); ++i) {
            if (!std::isnan(expected[level](i, 0))) {
                ASSERT_LE(GetLargestValue(actual[level].row(i) - expected[level].row(i)), allowed)
                    << "level " << level << ", row " << i;
            }
        }
    }
}

template <typename REAL>
void ExpectTable(TopologyRefiner const &refiner, std::vector<ReferenceValues> const &levels,
                 FarExt::StencilMode mode, int channel, int flags) {
    using Factory = FarExt::StencilTableFactoryReal<REAL>;
    typename Factory::Options options;
    options.interpolationMode = mode;
    options.fvarChannel = channel;
    options.generateControlVerts = (flags & 1) != 0;
    options.generateIntermediateLevels = (flags & 2) != 0;
    options.factorizeIntermediateLevels = (flags & 4) != 0;
    SCOPED_TRACE(testing::Message() << "mode " << mode << ", flags " << flags);
    FarExt::CallStatus status;
    auto const table = Factory::Create(refiner, options, &status);
    ASSERT_TRUE(table) << status.GetErrorMessage();
    double const allowed = kRowTolerance<REAL> * std::max(1.0, GetSize(levels[0]));
    int stencil = 0;
    int const last = int(levels.size()) - 1;
    for (int level = options.generateControlVerts ? 0 : 1; level <= last; ++level) {
        if (level > 0 && level < last && !options.generateIntermediateLevels) {
            continue;
        }
        bool const fromBase = level == 0 || options.factorizeIntermediateLevels;
        ReferenceValues const &sources = levels[fromBase ? 0 : level - 1];
        for (Eigen::Index row = 0; row < levels[level].rows(); ++row, ++stencil) {
            ASSERT_LT(stencil, table->GetNumStencils());
            Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(sources.cols());
            int const offset = table->GetOffsets()[stencil];
            for (int k = 0; k < table->GetSizes()[stencil]; ++k) {
                int const index = table->GetControlIndices()[offset + k];
                ASSERT_LT(index, sources.rows());
                sum += double(table->GetWeights()[offset + k]) * sources.row(index);
            }
            if (!std::isnan(levels[level](row, 0))) {
                ASSERT_LE(GetLargestValue(sum - levels[level].row(row)), allowed)
                    << "level " << level << ", row " << row;
            }
        }
    }
    ASSERT_EQ(stencil, table->GetNumStencils());
}

template void ExpectTable<float>(TopologyRefiner const &, std::vector<ReferenceValues> const &,
                                 FarExt::StencilMode, int, int);
template void ExpectTable<double>(TopologyRefiner const &, std::vector<ReferenceValues> const &,
                                  FarExt::StencilMode, int, int);

void ExpectVertexValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                             ReferenceMask mask, ReferenceValues const &base) {
    auto const expected = match.InterpolateAll(mask, base);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels(refiner, base), expected, kRowTolerance<double>));
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels<float>(refiner, base), expected, kRowTolerance<float>));
    expectTables(refiner, expected, FarExt::INTERPOLATE_VERTEX, int(mask));
}

void ExpectVaryingValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceValues const &base) {
    auto const expected = match.InterpolateVaryingAll(base);
    ASSERT_NO_FATAL_FAILURE(ExpectLevelsEqual(InterpolateLevels(refiner, base, ValueKind::Varying),
                                              expected, kRowTolerance<double>));
    expectTables(refiner, expected, FarExt::INTERPOLATE_VARYING, 1);
}

void ExpectMeshEqual(Shape const &shape, int numLevels, Sdc::Options options,
                     FarExt::HexSchemeOptions const &schemeOptions) {
    auto const topology =
        CreateRefiner(shape, ReferenceMask::Average, numLevels, options, schemeOptions);
    TaggedMatch const match(shape, *topology);
    ASSERT_EQ(match.GetError(), "");
    ASSERT_NO_FATAL_FAILURE(ExpectValid(*topology));
    if (schemeOptions.firstStep != FarExt::FirstStep::Truncate) {
        ASSERT_NO_FATAL_FAILURE(ExpectNumbering(*topology));
    }
    ReferenceValues const positions = GetPositions(shape);
    for (ReferenceMask const mask : kMasks) {
        SCOPED_TRACE(ToString(mask));
        auto const refiner = CreateRefiner(shape, mask, numLevels, options, schemeOptions);
        ASSERT_NO_FATAL_FAILURE(ExpectVertexValuesEqual(*refiner, match, mask, positions));
    }
    ASSERT_NO_FATAL_FAILURE(ExpectVaryingValuesEqual(*topology, match, positions));
}

void ExpectChannelValuesEqual(TopologyRefiner const &refiner, TaggedMatch const &match,
                              ReferenceMask mask, ReferenceValues const &base, int channel) {
    bool const isLinear =
        refiner.GetFVarLinearInterpolation(channel) == Sdc::Options::FVAR_LINEAR_ALL;
    auto const expected =
        isLinear ? match.InterpolateVaryingAll(base) : match.InterpolateAll(mask, base);
    ASSERT_NO_FATAL_FAILURE(
        ExpectLevelsEqual(InterpolateLevels(refiner, base, ValueKind::FaceVarying, channel),
                          expected, kRowTolerance<double>));
    ASSERT_NO_FATAL_FAILURE(ExpectTable<double>(refiner, expected, FarExt::INTERPOLATE_FACE_VARYING,
                                                channel, 6 + channel % 2));
    ExpectTable<float>(refiner, expected, FarExt::INTERPOLATE_FACE_VARYING, channel, 4);
}

} // namespace OpenSubdivHex::Regression
