// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_RULES_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_RULES_H

#include "level.h"

#include "far_ext/hexSchemeOptions.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// Faces around an F-vertex inside the mesh; on a border there are fewer.
inline constexpr int kFVertexFaces = 3;

/// \brief How the F-vertices of a face are made of its vertices: a row of weights for each corner.
///
/// Faces with equal rows share a rule.  The rows of a *circulant* rule are one mask, turned; those of a *dense*
/// rule are any.
class FaceRule {
public:
    FaceRule(int size, double const *weights, std::size_t const *rows)
        : _size(size), _weights(weights), _rows(rows) {}

    int GetSize() const { return _size; }
    bool IsCirculant() const { return !_rows; }
    /// The weights of the vertices of the face, in their order, for the F-vertex of \p corner.
    double const *GetRow(int corner) const {
        // A mask stands twice in a row, so that every rotation of it is contiguous.
        return _weights + (_rows ? _rows[corner] : std::size_t(_size - corner));
    }

private:
    int _size;
    double const *_weights;   // of a circulant rule, from corner 0 on
    std::size_t const *_rows; // of a dense rule: where each row begins in the weights of all rules
};

/// \brief How a V-vertex is made: V' = the sum of weights[i] sources[i], i < numSources, and that of the F-vertices
/// around it, each with GetFaceWeight().
///
/// The last source is its parent.  Neighbors come first, so that it does not matter for the sum which of
/// them is left and right.
struct VertexRule {
    double
        faceWeight; ///< of the F-vertex in each face; in each but for faceWeights, where these are
    int numSources;
    Far::Index sources[3];
    double weights[3];
    /// Where faces differ, their weights, as Level::vertFaces has the faces; else null.  All are 0 or none.
    double const *faceWeights;

    /// The weight of the F-vertex in face \p i around the vertex.
    double GetFaceWeight(int i) const { return faceWeights ? faceWeights[i] : faceWeight; }
    bool HasFaces() const { return faceWeight > 0; }
};

/// \brief The rules of one refinement, as data: with which weights the faces and vertices of a level make
/// F-vertices and V-vertices.  RefinementRows adds the components that are made.
///
/// Tags of the level and the options of the scheme are turned into weights here, and nowhere else.  Faces
/// have the circulant rule of their size or a dense one, in runs.  Vertices have the rule of one source of their
/// number of faces but for those of GetRuledVertices(), and for those with weights by face.
class OPENSUBDIVHEX_API RefinementRules {
public:
    using Index = Far::Index;

    /// Faces that follow one another, up to the begin of the next run, all with one dense rule or with none.
    struct FaceRun {
        Index begin;
        int rule; ///< the number of the dense rule, or kCirculant
    };
    /// A vertex with a rule of its own.
    struct RuledVertex {
        Index vert;
        VertexRule rule;
    };

    /// Makes the rules of the refinement of \p parent, to which they refer.
    RefinementRules(Level const &parent, HexSchemeOptions schemeOptions,
                    Interpolation interpolation);

    Interpolation GetInterpolation() const { return _interpolation; }
    /// Whether \p schemeOptions make the same rules of the level.
    bool AreThoseOf(HexSchemeOptions schemeOptions) const {
        return schemeOptions.faceMask == _faceMask &&
               schemeOptions.GetStepOfLevel(_level.depth + 1) == _step;
    }

    /// @name Faces
    /// @{
    FaceRule GetFaceRule(Index face) const {
        int const rule = FindRun(face)->rule;
        return rule == kCirculant ? GetCirculantRule(_level.GetFaceSize(face)) : GetDenseRule(rule);
    }
    static constexpr int kCirculant = -1;
    /// The run that a face is in.  Behind the last one stands another, which begins at the number of faces.
    FaceRun const *FindRun(Index face) const {
        FaceRun const *run = _faceRuns.data();
        if (!_runOfBlock.empty()) {
            for (run += _runOfBlock[std::size_t(face / kBlock)]; run[1].begin <= face; ++run) {
            }
        }
        return run;
    }
    /// Calls function(face, rule) for the faces with dense rules, from \p begin to \p end - 1.
    template <typename FUNCTION>
    void ForEachDenseFace(Index begin, Index end, FUNCTION function) const {
        if (begin == end) {
            return;
        }
        for (FaceRun const *run = FindRun(begin); run->begin < end; ++run) {
            Index const behind = run->rule == kCirculant ? begin : std::min(end, run[1].begin);
            for (Index face = std::max(begin, run->begin); face < behind; ++face) {
                function(face, run->rule);
            }
        }
    }
    /// The rule of faces of a size that the level has.
    FaceRule GetCirculantRule(int size) const {
        return {size, _weights.data() + _circulants[std::size_t(size)], nullptr};
    }
    int GetNumDenseRules() const { return int(_denseRules.size()); }
    FaceRule GetDenseRule(int rule) const {
        auto const [size, firstRow] = _denseRules[std::size_t(rule)];
        return {size, _weights.data(), _rows.data() + firstRow};
    }
    /// @}

    /// @name Vertices
    /// @{
    VertexRule GetVertexRule(Index vert) const {
        if (RuledVertex const *const ruled = findRuled(vert)) {
            return ruled->rule;
        }
        int const weights = GetVertexWeights(vert);
        return weights == kPlain ? plainRule(vert, _level.GetNumVertexFaces(vert))
                                 : weightedRule(vert, weights);
    }
    /// @name Vertices with weights by face
    /// Weights of vertices without a rule of their own: the weight of the vertex, then the weights of the F-vertices
    /// around it.  Vertices with equal weights share them.
    /// @{
    /// In place of the position of plain vertices, whatever their number of faces: there are the weights of those with
    /// three.
    static constexpr int kPlain = 0;
    /// The position of those of a vertex in GetAllVertexWeights(), or kPlain.
    int GetVertexWeights(Index vert) const {
        return vert < GetEndOfVertexWeights() ? _weightsOfVerts[std::size_t(vert)] : kPlain;
    }
    std::vector<double> const &GetAllVertexWeights() const { return _vertexWeights; }
    /// Behind the last vertex that is not plain.
    Index GetEndOfVertexWeights() const { return Index(_weightsOfVerts.size()); }
    /// GetVertexWeights() of each vertex before GetEndOfVertexWeights().
    int const *GetWeightsOfVertices() const { return _weightsOfVerts.data(); }
    /// @}
    /// The rule of vertices with \p numFaces faces that have none of their own.
    VertexVertexMask GetPlainVertexMask(int numFaces) const {
        return numFaces < kNumKept ? _plainVertexMasks[numFaces]
                                   : ComputeVertexVertexMask(_interpolation, numFaces);
    }
    /// Ascending.
    std::vector<RuledVertex> const &GetRuledVertices() const { return _ruledVertices; }
    /// @}

private:
    static constexpr int kNumKept = 8;
    static constexpr Index kBlock = 16; // of faces
    struct DenseRule {
        int size;
        std::size_t firstRow;
    };
    class DenseRuleMaker;

    VertexRule plainRule(Index vert, int numFaces) const {
        VertexVertexMask const mask = GetPlainVertexMask(numFaces);
        return {mask.faceWeight, 1, {vert}, {mask.vertexWeight}, nullptr};
    }
    VertexRule weightedRule(Index vert, int position) const {
        double const *const weights = _vertexWeights.data() + position;
        return {weights[1], 1, {vert}, {weights[0]}, weights + 1};
    }
    RuledVertex const *findRuled(Index vert) const {
        if (_ruledVertices.empty() || vert > _ruledVertices.back().vert) {
            return nullptr;
        }
        auto const found = std::lower_bound(
            _ruledVertices.begin(), _ruledVertices.end(), vert,
            [](RuledVertex const &ruled, Index index) { return ruled.vert < index; });
        return found->vert == vert ? &*found : nullptr;
    }
    void makeCirculantRules();
    void endFaceRuns();
    void makeVertexWeights();
    void makeRuledVertices(bool hasIrregular);

    Level const &_level;
    FaceMask _faceMask;
    StepType _step;
    Interpolation _interpolation;
    VertexVertexMask _plainVertexMasks[kNumKept]; ///< by number of faces
    std::vector<RuledVertex> _ruledVertices;
    std::vector<int> _weightsOfVerts;   ///< by vertex, up to the last that is not plain
    std::vector<double> _vertexWeights; ///< each set once

    std::vector<double> _weights;         ///< of all rows
    std::vector<std::size_t> _circulants; ///< by face size, position in _weights
    std::vector<DenseRule> _denseRules;
    std::vector<std::size_t> _rows; ///< of dense rules, positions in _weights
    std::vector<FaceRun> _faceRuns;
    std::vector<Index> _runOfBlock; ///< of the first face of each; empty where there is one run
};

/// \brief The rules of the refinement of \p parent, which keeps them: they are made once for all who use them,
/// by the options of the first.  Several threads may call it at once.
OPENSUBDIVHEX_API std::shared_ptr<RefinementRules const>
GetRules(Level const &parent, HexSchemeOptions schemeOptions, Interpolation interpolation);

} // namespace OpenSubdivHex::FarExt::internal

#endif
