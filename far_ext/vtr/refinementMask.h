// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_MASK_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_REFINEMENT_MASK_H

#include "level.h"

#include "far_ext/hexSchemeOptions.h"

#include <array>
#include <utility>
#include <vector>

namespace OpenSubdivHex::FarExt::internal {

/// \brief The masks of one refinement: with which weights the vertices of a parent level make an
/// F-vertex or a V-vertex.  RefinementRows adds the components that are made.
class OPENSUBDIVHEX_API RefinementMask {
public:
    using Index = Far::Index;

    /// The mask of a V-vertex: V' = the sum of weights[i] sources[i], i < numSources, and faceWeight
    /// times the sum of the F-vertices around it.  The last source is its parent: neighbors come
    /// first, so that it does not matter for the sum which of them is left and right.
    struct VertexMask {
        double faceWeight;
        int numSources;
        Index sources[3];
        double weights[3];
    };

    /// Makes the masks of the refinement of \p parent, to which it refers.
    RefinementMask(Level const &parent, HexSchemeOptions schemeOptions,
                   Interpolation interpolation);

    /// Weights of the vertices of \p face, in their order, for the F-vertex of its corner number
    /// \p corner.  The result is valid until \p scratch is used again.
    double const *GetFaceVertexWeights(Index face, int corner, std::vector<double> &scratch) const;

    VertexMask GetVertexMask(Index vert) const {
        SharpVertex const *sharp = _hasSharpVertices ? _level.FindSharpVertex(vert) : nullptr;
        VertexMask const mask = sharp ? sharpMask(*sharp) : plainMask(vert);
        IrregularVertex const *irregular =
            _hasIrregular ? _level.FindIrregularVertex(vert) : nullptr;
        return irregular ? irregularMask(*irregular, mask) : mask;
    }

    Interpolation GetInterpolation() const { return _interpolation; }

    /// @name The plain majority and the rest
    /// All faces of a size have the same weights, and all vertices with as many faces the same mask
    /// of one source, but for those that a feature gives others.
    /// @{

    /// The weights of corner 0 of a plain face; those of corner i lie i places further around.
    double const *GetPlainFaceWeights(int faceSize) const { return smoothWeights(faceSize, 0); }
    VertexVertexMask GetPlainVertexMask(int numFaces) const {
        return numFaces < kNumKept ? _plainVertexMasks[numFaces]
                                   : ComputeVertexVertexMask(_interpolation, numFaces);
    }
    bool IsFacePlain(Index face) const {
        return !IsIrregular(face) && !(_hasSharpFaces && isSharp(face));
    }
    /// All vertices that are not plain, and perhaps some that are; ascending.
    std::vector<Index> FindFeatureVertices() const;
    /// The same but for those that have the mask of an irregular vertex and nothing else.
    std::vector<Index> FindWeightedVertices() const;
    /// Faces whose corners may all have weights of their own, since something is sharp there;
    /// ascending.  Besides these only the irregular corners have.
    std::vector<Index> FindSharpFaces() const;
    /// Faces with irregular corners, ascending, each with its type.
    struct IrregularFace {
        Index face;
        int type;
    };
    std::vector<IrregularFace> const &GetIrregularFaces() const { return _irregularFaces; }
    bool IsIrregular(Index face) const { return _hasIrregular && getType(face) != kPlainType; }
    /// What the faces of a type have in common where nothing is sharp: the weights of all corners, a
    /// row for each.
    struct IrregularFaceWeights {
        double weights[HexIndexing::kNumEFaceCorners][HexIndexing::kNumEFaceCorners];
        bool
            areIrregular[HexIndexing::kNumEFaceCorners]; ///< the corners; others have plain weights
    };
    std::vector<IrregularFaceWeights> const &GetIrregularTypes() const { return _irregularWeights; }
    /// Those of a face, or null where it is not irregular or something is sharp.
    IrregularFaceWeights const *FindIrregularWeights(Index face) const {
        bool const isSmooth = IsIrregular(face) && !(_hasSharpFaces && isSharp(face));
        return isSmooth ? &_irregularWeights[std::size_t(getType(face))] : nullptr;
    }
    /// Ascending.
    OpenSubdiv::Vtr::ConstArray<IrregularVertex> GetIrregularVertices() const {
        std::size_t const size = _hasIrregular ? _level.irregularVerts.size() : 0;
        return {_level.irregularVerts.data(), int(size)};
    }
    /// The masks of irregular vertices without anything sharp, by their number of faces, ascending, and
    /// by what was around them, which has no bearing on V' itself.
    using MasksByFacesAround = std::array<IrregularVertexMask, kNumFacesAround>;
    using IrregularMasks = std::vector<std::pair<Index, MasksByFacesAround>>;
    IrregularMasks const &GetIrregularMasks() const { return _irregularMasks; }
    /// The irregular corners from \p begin to \p end - 1.
    OpenSubdiv::Vtr::ConstArray<IrregularCorner> GetIrregularCorners(Index begin, Index end) const {
        return _hasIrregular ? _level.GetIrregularCorners(begin, end)
                             : OpenSubdiv::Vtr::ConstArray<IrregularCorner>();
    }
    /// @}

private:
    double const *smoothWeights(int faceSize, int corner) const {
        // The mask stands twice in a row, so that every rotation of it is contiguous.
        return _faceMasks[faceSize].data() + faceSize - corner;
    }

    VertexMask plainMask(Index vert) const {
        VertexVertexMask const mask = GetPlainVertexMask(_level.GetNumVertexFaces(vert));
        return {mask.faceWeight, 1, {vert}, {mask.vertexWeight}};
    }
    static VertexMask sharpMask(SharpVertex const &sharp);
    VertexMask irregularMask(IrregularVertex const &irregular, VertexMask mask) const;
    bool isSharp(Index face) const;
    double const *sharpWeights(Index face, int corner, std::vector<double> &scratch) const;
    void addSharpWeights(Index face, int corner, std::vector<double> &weights) const;
    struct CornerMask {
        double const *weights;
        bool isBackwards;
    };
    CornerMask findCornerMask(IrregularCorner const &irregular) const;
    void addIrregularWeights(IrregularCorner const &irregular, int corner, double *weights) const;

    static constexpr int kHexagonSize = HexIndexing::kNumEFaceCorners;
    static constexpr int kQuadSize = 4;
    static constexpr int kPlainType = -1;
    struct IrregularCornersOfFace;
    void findIrregularMasks();
    void findIrregularTypes();
    template <typename IS_WANTED>
    std::vector<Index> findVertices(IS_WANTED isWanted) const;
    void addIrregularType(IrregularCornersOfFace const &corners);
    int getType(Index face) const { return _irregularTypes[std::size_t(face)]; }
    IrregularMasks::const_iterator findMask(Index numFaces) const;
    IrregularVertexMask const &getIrregularMask(Index numFaces, FacesAround facesAround) const {
        return findMask(numFaces)->second[std::size_t(facesAround)];
    }

    Level const &_level;
    FaceMask _faceMask;
    bool _hasSharpFaces;
    bool _hasSharpVertices;
    bool _hasIrregular;
    Interpolation _interpolation;
    static constexpr int kNumKept = 8;
    VertexVertexMask _plainVertexMasks[kNumKept]; ///< by number of faces
    std::vector<std::vector<double>> _faceMasks;  ///< by face size

    IrregularMasks _irregularMasks; ///< by number of faces
    QuadMask _quadMask;
    std::vector<int> _irregularTypes; ///< by face; empty without irregular ones
    std::vector<IrregularFace> _irregularFaces;
    std::vector<IrregularFaceWeights> _irregularWeights; ///< by type

    // One row of weights per corner of a half face and of a hexagon with a sharp diagonal.
    double _halfFaceWeights[HexIndexing::kNumBoundaryEFaceCorners]
                           [HexIndexing::kNumBoundaryEFaceCorners];
    double _diagonalWeights[HexIndexing::kNumEFaceCorners][HexIndexing::kNumEFaceCorners];
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
