// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_STENCIL_TABLE_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/stencilTable.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief The types of stencil table by the precision of the weights.
template <typename REAL>
struct StencilTableTypes {
    /// Far's table with weights of type REAL.
    using Table = Far::StencilTableReal<REAL>;
};
/// \brief In single precision.
template <>
struct StencilTableTypes<float> {
    /// The type that Osd's evaluators take.
    using Table = Far::StencilTable;
};

/// \brief The kind of data that stencils interpolate, spelled as in Far::StencilTableFactory.
enum StencilMode : int {
    INTERPOLATE_VERTEX,      ///< vertex data, with the masks of the scheme
    INTERPOLATE_VARYING,     ///< varying data, linearly
    INTERPOLATE_FACE_VARYING ///< the values of a face-varying channel
};

/// \brief Stencils, weights and bytes of a stencil table: see StencilTableFactoryReal::GetSize.
struct StencilTableSize {
    std::int64_t numStencils = 0; ///< rows of the table
    std::int64_t numWeights = 0;  ///< of all stencils
    std::int64_t numBytes = 0;    ///< of the table's arrays
};

/// \brief Makes Far stencil tables of hexagonal refinements, for any Osd evaluator.
///
/// \code
///     FarExt::StencilTableFactory::Options options;
///     options.generateIntermediateLevels = false; // the last level only
///     auto table = FarExt::StencilTableFactory::Create(*refiner, options);
/// \endcode
///
/// Several threads may call it at once, also for the same refiner.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API StencilTableFactoryReal {
public:
    /// Far::StencilTable, or Far::StencilTableReal<double>.
    using Table = typename StencilTableTypes<REAL>::Table;

    /// \brief The fields of Far::StencilTableFactory::Options, with their meaning.
    ///
    /// Stencils come level by level, in vertex order: the control vertices (when asked for), then
    /// levels 1 ... L or level L alone, where L = min(maxLevel, refiner.GetMaxLevel()).
    ///
    /// Unlike Far, which has generateOffsets, offsets are always made: evaluators need them.
    /// Without factorization and without intermediate levels the table holds level L in terms of
    /// level L - 1 (Far does not support that combination).
    struct Options {
        StencilMode interpolationMode = INTERPOLATE_VERTEX; ///< the kind of data
        /// Whether one stencil of weight 1 for each control vertex comes first.
        bool generateControlVerts = false;
        bool generateIntermediateLevels = true; ///< levels 1 ... L, else L alone
        /// Whether indices are control vertices; else stencils of level i index the vertices of
        /// level i - 1, from 0.
        bool factorizeIntermediateLevels = true;
        int maxLevel = (std::numeric_limits<int>::max)(); ///< 0 or more; not cut to any bit width
        int fvarChannel =
            0; ///< for INTERPOLATE_FACE_VARYING, whose vertices are face-varying values
    };

    /// \brief Makes the table.
    ///
    /// The table has its exact size: no spare capacity, as many weights as indices, offsets filled.
    /// The indices of a stencil ascend; weights are non-negative and sum to 1.  All new points of a
    /// face have the same indices, so that some weights at borders and creases are 0.
    ///
    /// On a sharp border line that two meshes share, with the same sharpness at its vertices, the
    /// weights of the same control vertices are the same, bit for bit.  Values may still differ by the
    /// order of their sums, which follows the indices.  PrimvarRefiner and
    /// OsdExt::RefinementEvaluator give the same values, bit for bit.
    ///
    /// \return  null on failure: InvalidArgument (negative maxLevel, mode or channel out of range) or
    ///          TooLarge (more than 2^31 - 1 stencils or weights up to the level that the status
    ///          names).
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner, Options options,
                                               CallStatus *status = nullptr);
    /// Overload with default options.
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner,
                                               CallStatus *status = nullptr) {
        return Create(refiner, Options(), status);
    }

    /// \brief Counts what a table will have, before memory is taken for it.
    ///
    /// It is the first of the two passes of Create(), which finds the indices that faces share: about a
    /// quarter of the time, in about a seventh of the table's memory.
    ///
    /// \return  zeros on failure, with the status of Create()
    static StencilTableSize GetSize(TopologyRefiner const &refiner, Options options,
                                    CallStatus *status = nullptr);

    /// @name Tables of a part of the mesh
    /// @{

    /// \brief Makes the table of the refined faces, and halves of hexagons, that lie in some base
    /// faces: those whose TopologyLevel::GetFaceBaseFace() is one of \p baseFaces.
    ///
    /// For each level the table has a stencil for each vertex, or value, of these faces, in ascending order
    /// (GetVerticesOfFaces()).  Stencils have the bits of Create(), and index the control vertices of the
    /// whole mesh.  Of a hexagon that lies half in the selection, the table has the four vertices of that
    /// half (kHexagonHalves).  Two selections without a common base face share only the vertices along
    /// their borders; all base faces together have all faces.  Time and memory are proportional to the
    /// selection and the faces around it.
    ///
    /// \param baseFaces  in any order, repeated or not; none gives a table without stencils
    /// \return  null on failure: as Create(); InvalidArgument, which names the face, for one out of
    ///          range; Unsupported without factorizeIntermediateLevels.
    static std::unique_ptr<Table const> CreateOfFaces(TopologyRefiner const &refiner,
                                                      Far::ConstIndexArray baseFaces,
                                                      Options options,
                                                      CallStatus *status = nullptr);

    /// \brief The vertices, or values of options.fvarChannel, of CreateOfFaces() at \p level (0: with
    /// generateControlVerts), in the order of the stencils: ascending.
    ///
    /// \return  empty on failure: InvalidArgument as CreateOfFaces(), or for a level that the
    ///          refiner does not have.
    static std::vector<Far::Index> GetVerticesOfFaces(TopologyRefiner const &refiner,
                                                      Far::ConstIndexArray baseFaces,
                                                      Options options, int level,
                                                      CallStatus *status = nullptr);
    /// @}
};

/// In single precision, for the Osd evaluators.
using StencilTableFactory = StencilTableFactoryReal<float>;

extern template class StencilTableFactoryReal<float>;
extern template class StencilTableFactoryReal<double>;

/// \brief The types of limit stencil table by the precision of the weights.
template <typename REAL>
struct LimitStencilTableTypes {
    /// Far's table with weights of type REAL.
    using Table = Far::LimitStencilTableReal<REAL>;
};
/// \brief In single precision.
template <>
struct LimitStencilTableTypes<float> {
    /// The type that Osd's evaluators take.
    using Table = Far::LimitStencilTable;
};

/// \brief Numbers the sides of the vertices of a level, each of which has a normal: at a vertex where two or more
/// infinitely sharp edges meet, the surface has a tangent plane for each part of its faces that they bound.
///
/// \code
///     FarExt::LimitSides const sides(level);
///     int const normal = sides.FindSide(level, face, corner); // of a table with generateFurtherSides
/// \endcode
///
/// Other vertices have one side, and so have those on sharp boundaries without creases.  Sides are counted around the vertex,
/// in the order of its faces, from the first sharp edge on.  Side 0 has the index of its vertex.  The further sides of all
/// vertices follow, in the order of the vertices.
class OPENSUBDIVHEX_API LimitSides {
public:
    /// A vertex, a face or a side.
    using Index = Far::Index;

    /// \p level has full topology, else the sides are invalid; it is not referred to afterwards.
    explicit LimitSides(TopologyLevel const &level);

    /// Whether the level had full topology; else there are no sides, and no vertices.
    bool IsValid() const { return _isValid; }
    /// Vertices of the level.
    int GetNumVertices() const { return _numVertices; }
    /// Sides of all vertices, one for each at least.
    int GetNumSides() const { return _numVertices + int(_furtherSides.size()); }

    /// The vertex of a side.
    Index GetVertex(Index side) const {
        return side < _numVertices ? side : getFurtherSide(side).vert;
    }
    /// Which of the sides of its vertex a side is, from 0.
    int GetLocalSide(Index side) const {
        return side < _numVertices ? 0 : getFurtherSide(side).side;
    }

    /// \brief Whether these sides are valid, and \p level has the same sides.
    ///
    /// Finds the sides of \p level to compare them.
    bool IsOf(TopologyLevel const &level) const;

    /// \brief The side on which a face has its vertex number \p local.
    ///
    /// \param level  that of the constructor, or one for which IsOf() is true
    /// \param half   the half of a face with an infinitely sharp diagonal, as in GetPlaceInHalves(); ignored for other
    ///               faces
    Index FindSide(TopologyLevel const &level, Index face, int local, int half = 0) const;

private:
    struct FurtherSide {
        bool operator==(FurtherSide const &other) const {
            return vert == other.vert && side == other.side;
        }

        Index vert;
        int side;
    };
    // The sides of the halves of a corner, of which a face without a diagonal has one.
    struct Corner {
        bool operator==(Corner const &other) const {
            return corner == other.corner && sides[0] == other.sides[0] &&
                   sides[1] == other.sides[1];
        }

        Index corner;
        Index sides[2];
    };

    FurtherSide const &getFurtherSide(Index side) const {
        return _furtherSides[std::size_t(side - _numVertices)];
    }
    void addCorner(std::size_t begin, Index corner, int half, Index side);

    bool _isValid;
    int _numVertices;
    std::vector<FurtherSide> _furtherSides;
    std::vector<Corner> _corners; // ascending; of the vertices with more than one side
};

/// \brief Makes limit stencil tables of hexagonal refinements: points of the limit surface and its
/// first derivatives there, as weighted sums of control vertices, for any Osd evaluator.
///
/// \code
///     FarExt::TopologyRefiner::UniformOptions refineOptions(2);
///     refineOptions.fullTopologyInLastLevel = true;
///     refiner->RefineUniform(refineOptions);
///     FarExt::LimitStencilTableFactory::Options options;
///     options.level = 2;
///     auto table = FarExt::LimitStencilTableFactory::Create(*refiner, options);
/// \endcode
///
/// The derivatives du and dv span the tangent plane, and du x dv points to the side from which the
/// faces are counter-clockwise.  They are derivatives by coordinates u and v in which the edges of
/// the level are about 1 long, exactly so where the faces around are laid out regularly; along a
/// sharp boundary or crease du follows the curve.  From one point to the next these coordinates
/// turn.  Points and tangents depend on the place:
///
/// | point             | limit                                                                   |
/// |-------------------|-------------------------------------------------------------------------|
/// | vertex            | that of its V-vertices; tangents from the subdominant eigenvectors      |
/// | on a sharp curve  | a point of the curve; each side has its tangent plane (see LimitSides)  |
/// | on a boundary with| the vertex itself, unmoved, and the mean plane of its faces: there every |
/// | the paper's rule  | step adds a face and the border creeps on, without a local limit        |
/// | sharp corner with | the vertex; du along the first sharp edge of the side, dv along the     |
/// | sharp edges       | other, or into the side                                                 |
/// | side all around,  | the tip of a cone, which has no tangent plane: du and dv span the plane |
/// | whose vertex does | across its axis; with a sharp edge in the side du is along that, and dv |
/// | not depend on it  | across                                                                  |
/// | vertex, no faces  | the vertex; derivatives 0                                               |
/// | face              | the centroid, where it has no sharp features                            |
/// | half face,        | the middle of its long edge or of the diagonal, as its own parts shrink |
/// | sharp diagonal    | towards there; tangents on the side of the half face, and of half 0     |
///
/// Where the surface has no tangent plane, or none that it comes close to in any level that can be
/// made, dv goes to the middle of the faces of its side some levels on, instead of being an
/// eigenvector.  That is on the wide side of a corner (two faces and more), where the surface is
/// steeper towards its middle than along its edges, and with FaceMask::Average on the narrow side of
/// a crease or sharp boundary (one face): there a bend of the curve fades by .3062 in a step, and
/// what is across by .3273, so that normals of levels 6 and 7 differ by 30 degrees on bent meshes.
/// Where a side ends at the edge with which it begins, or faces collapse, du and dv may be parallel.
///
/// The weights of a point are not negative.  Weights of derivatives are 8 at most, whatever the
/// mesh.
///
/// Vertex interpolation alone; varying and face-varying data have no limit stencils.
///
/// Several threads may call it at once, also for the same refiner.  std::bad_alloc passes through.
template <typename REAL>
class OPENSUBDIVHEX_API LimitStencilTableFactoryReal {
public:
    /// Far::LimitStencilTable, or Far::LimitStencilTableReal<double>.
    using Table = typename LimitStencilTableTypes<REAL>::Table;

    /// \brief Which points, in this order: the vertices of the level, the further sides of
    /// vertices, the centres of the level's faces.
    struct Options {
        /// \brief The level of the points, 0 ... refiner.GetMaxLevel(); -1: the last.  It must have full
        /// topology.
        ///
        /// Level 0 gives the limits of the control vertices alone, however far the refiner is refined.
        int level = -1;
        bool generateVertices = true;       ///< the vertices, one point each
        bool generateFurtherSides = false;  ///< only with vertices; as LimitSides numbers them
        bool generateFaceCenters = false;   ///< the centres of faces
        bool generate1stDerivatives = true; ///< else the table has no derivative weights

        /// Whether indices are control vertices; else they are vertices of the level, and an evaluator
        /// applies the table to the refined level.
        bool factorizeIntermediateLevels = true;
    };

    /// \brief Makes the table.
    ///
    /// The indices of a stencil are control vertices, or vertices of the level, and ascend; offsets
    /// are filled, and the arrays have their exact size.  The weights of a point sum to 1, those of a
    /// derivative to 0.  Every point depends on the topology around it alone: any number of threads
    /// makes the same bits.
    ///
    /// \return  null on failure: InvalidArgument (level out of range or without full topology, no
    ///          points asked for, further sides without vertices), TooLarge (more than 2^31 - 1
    ///          weights, here or in the stencils of the level) or Unsupported (the level is not
    ///          refined by hexagonal steps; or, for points at vertices, a vertex or a face, which the
    ///          status names: a vertex whose tangents iteration does not find, where a single sharp
    ///          edge ends among more than 100 faces; one with more than 1,024 faces, or at a non-manifold
    ///          corner as many in one fan; or a face with more than 1,024 vertices).
    static std::unique_ptr<Table const> Create(TopologyRefiner const &refiner, Options options,
                                               CallStatus *status = nullptr);
};

/// In single precision, for the Osd evaluators.
using LimitStencilTableFactory = LimitStencilTableFactoryReal<float>;

extern template class LimitStencilTableFactoryReal<float>;
extern template class LimitStencilTableFactoryReal<double>;

} // namespace OpenSubdivHex::FarExt

#endif
