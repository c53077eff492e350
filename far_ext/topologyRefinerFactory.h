// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <functional>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt {

namespace internal {
class BaseMesh;
}

/// \brief Makes a TopologyRefiner from OpenSubdiv's base mesh, a Far::TopologyDescriptor or Far::TopologyRefiner.
/// MeshRefinerFactory makes one from your own mesh class.
///
/// \code
///     Sdc::Options sdcOptions;
///     sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
///     FarExt::TopologyRefinerFactory::Options options;
///     options.hexSchemeOptions.faceMask = FarExt::FaceMask::Smooth;
///     auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options);
/// \endcode
///
/// Level 0 keeps the base's numbering of vertices, edges, faces, corners and face-varying values;
/// INDEXING.md says what becomes of non-manifold edges.
///
/// Several threads may call it at once, also for the same base.  std::bad_alloc passes through.
class OPENSUBDIVHEX_API TopologyRefinerFactory {
public:
    /// \brief The scheme of the refinement.
    struct Options {
        HexSchemeOptions hexSchemeOptions; ///< scheme and face mask
    };

    /// \brief Takes level 0 of \p base, which need not be refined and may have any Sdc scheme type
    /// that accepts its faces (Catmark takes all), with its sharpness, holes and face-varying
    /// channels.  Boundary, crease and face-varying rules are those of base.GetSchemeOptions().
    ///
    /// Non-manifold edges and vertices are infinitely sharp, as in Far: vertices stay, unless they
    /// lie inside of a curve that three or more sheets share.  An edge that its two faces run in the
    /// same direction is non-manifold.  \p status has a Warning of these,
    /// WarningCode::InconsistentOrientation, and one of other non-manifold edges,
    /// WarningCode::NonManifoldEdges.  A vertex that a face has several times is non-manifold
    /// and stays.  With VTX_BOUNDARY_NONE all boundaries follow the paper's rule, whatever sharpness
    /// they have, and holes beside a boundary are not taken over, since Far tags all faces there as
    /// holes.
    ///
    /// \return  null on failure:
    ///           - InvalidTopology: no faces, a face with fewer than three vertices, an edge without a
    ///             face or that is none of its faces, a value out of range, a sharpness that is
    ///             negative or not a number
    ///           - InvalidArgument: an option that is none of its enumeration's values
    ///           - TooLarge: a face of more than 65,535 vertices, a vertex of more than 65,535 faces,
    ///             more than 2^31 - 1 of anything
    ///           - Unsupported with other steps than hexagonal ones: creases, interior corners,
    ///             non-manifold edges or face-varying channels
    ///           - Unsupported at a vertex inside of such a curve: a channel without a seam there, where
    ///             a semi-sharp crease meets the curve or some faces meet one end alone
    ///           - Unsupported with CREASE_CHAIKIN at any non-manifold vertex: a channel without a seam
    ///             there, where semi-sharp creases meet that lie between faces which no edges join
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyRefiner const &base,
                                                   Options options, CallStatus *status = nullptr);
    /// Overload with default options.
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyRefiner const &base,
                                                   CallStatus *status = nullptr) {
        return Create(base, Options(), status);
    }

    /// \brief Overload for a descriptor, with the boundary, crease and face-varying options \p sdcOptions.  Edges are
    /// numbered as Far numbers them: see INDEXING.md.
    ///
    /// Additionally refuses, with InvalidTopology, indices out of range: of vertices in faces,
    /// creases and corners, of faces that are holes, and of face-varying values; a crease that is
    /// no edge; and, with InvalidArgument, a descriptor without an array that it has a count for.
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyDescriptor const &descriptor,
                                                   Sdc::Options sdcOptions, Options options,
                                                   CallStatus *status = nullptr);
    /// Overload with default scheme options.
    static std::unique_ptr<TopologyRefiner> Create(Far::TopologyDescriptor const &descriptor,
                                                   Sdc::Options sdcOptions = Sdc::Options(),
                                                   CallStatus *status = nullptr) {
        return Create(descriptor, sdcOptions, Options(), status);
    }

private:
    friend class MeshRefinerFactoryBase;
    static std::unique_ptr<TopologyRefiner>
    create(Sdc::Options sdcOptions, Options options, CallStatus *status,
           std::function<CallStatus(internal::BaseMesh &)> const &read);
};

/// \brief Level 0 in the making, which the functions of a MeshRefinerFactory fill by those of
/// MeshRefinerFactoryBase.
class OPENSUBDIVHEX_API BaseTopology {
public:
    BaseTopology(BaseTopology const &) = delete;
    BaseTopology &operator=(BaseTopology const &) = delete;

private:
    friend class MeshRefinerFactoryBase;
    struct Channel;

    explicit BaseTopology(internal::BaseMesh &mesh);
    ~BaseTopology();

    /// The functions of the factory, in their order.
    enum class Stage {
        Resize,            ///< resizeComponentTopology()
        Assign,            ///< assignComponentTopology()
        AssignTags,        ///< assignComponentTags()
        AssignFaceVarying, ///< assignFaceVaryingTopology()
    };

    static char const *getName(Stage stage);
    void refuse(CallStatus const &status);
    /// Whether \p function, which is for \p stage, was called there; else refuses.
    bool isIn(Stage stage, char const *function);
    /// Refuses a call of \p function: for its stage, else for its index.
    void refuseIndex(Stage stage, char const *function, Far::Index index, int count,
                     ComponentType component);

    internal::BaseMesh &_mesh;
    CallStatus _status; // the first failure
    Stage _stage = Stage::Resize;
    int _numFaces = 0;
    Far::Index *_faceSizes = nullptr;         // while they are assigned
    Far::Index const *_firstCorner = nullptr; // by face, once these have their sizes
    Far::Index *_faceVerts = nullptr;         // by corner, while they are assigned
    std::vector<Channel> _channels;
};

/// \brief The functions that a specialised MeshRefinerFactory calls, named as in Far::TopologyRefinerFactory.
///
/// An index that is out of range, a count that is negative, a sharpness that is negative or not a
/// number, and what is called elsewhere than in the function that it is for are refused by name: the
/// call returns without effect (or with an empty array, or INDEX_INVALID), and Create() fails with the
/// first of these causes.
class OPENSUBDIVHEX_API MeshRefinerFactoryBase {
protected:
    /// A vertex, an edge, a face or a value.
    using Index = Far::Index;
    /// Indices to be written.
    using IndexArray = Far::IndexArray;

    /// @name For resizeComponentTopology()
    /// The number of faces comes before the numbers of their vertices.
    /// @{

    /// Says how many vertices there are.
    static void setNumBaseVertices(BaseTopology &base, int count);
    /// Says how many faces there are.
    static void setNumBaseFaces(BaseTopology &base, int count);
    /// Says how many vertices a face has.
    static void setNumBaseFaceVertices(BaseTopology &base, Index face, int count) {
        if (base._faceSizes && 0 <= face && face < base._numFaces) {
            base._faceSizes[face] = count;
        } else {
            base.refuseIndex(BaseTopology::Stage::Resize, "setNumBaseFaceVertices", face,
                             base._numFaces, ComponentType::Face);
        }
    }
    /// @}

    /// @name For assignComponentTopology()
    /// @{

    /// Vertices, as was said.
    static int getNumBaseVertices(BaseTopology const &base);
    /// Faces, as was said.
    static int getNumBaseFaces(BaseTopology const &base) { return base._numFaces; }
    /// The vertices of a face, counter-clockwise, to be written: all of them, of all faces.
    static IndexArray getBaseFaceVertices(BaseTopology &base, Index face) {
        if (base._faceVerts && 0 <= face && face < base._numFaces) {
            Index const first = base._firstCorner[face];
            return IndexArray(base._faceVerts + first, base._firstCorner[face + 1] - first);
        }
        base.refuseIndex(BaseTopology::Stage::Assign, "getBaseFaceVertices", face, base._numFaces,
                         ComponentType::Face);
        return IndexArray();
    }
    /// @}

    /// @name For assignComponentTags()
    /// Edges are found and numbered as Far does: see INDEXING.md.
    /// @{

    /// Edges that were found.
    static int getNumBaseEdges(BaseTopology const &base);
    /// The edge between two vertices, INDEX_INVALID if there is none.
    static Index findBaseEdge(BaseTopology const &base, Index v0, Index v1);
    /// Makes an edge a crease.
    static void setBaseEdgeSharpness(BaseTopology &base, Index edge, float sharpness);
    /// Makes a vertex a corner.
    static void setBaseVertexSharpness(BaseTopology &base, Index vert, float sharpness);
    /// Says whether a face is a hole.
    static void setBaseFaceHole(BaseTopology &base, Index face, bool isHole);
    /// @}

    /// @name For assignFaceVaryingTopology()
    /// @{

    /// \brief Adds a channel of \p numValues values, with the face-varying rule of \p options or
    /// else of the options of the refiner.
    /// \return  its number, from 0 on; INDEX_INVALID where it is refused
    static int createBaseFVarChannel(BaseTopology &base, int numValues);
    /// \copydoc createBaseFVarChannel(BaseTopology &, int)
    static int createBaseFVarChannel(BaseTopology &base, int numValues,
                                     Sdc::Options const &options);
    /// The values of the corners of a face, to be written: all of them, of all faces.
    static IndexArray getBaseFaceFVarValues(BaseTopology &base, Index face, int channel = 0);
    /// @}

    /// One of the four functions, for a mesh.
    using Function = std::function<bool(BaseTopology &)>;
    /// Makes the refiner by the four functions, in their order.
    static std::unique_ptr<TopologyRefiner>
    create(Sdc::Options sdcOptions, TopologyRefinerFactory::Options options, CallStatus *status,
           Function const &resize, Function const &assign, Function const &assignTags,
           Function const &assignFaceVarying);
};

/// \brief Makes a TopologyRefiner from a mesh class of your own, without a descriptor between: as
/// Far::TopologyRefinerFactory<MESH> does, and with the same functions to write.
///
/// Specialise resizeComponentTopology() and assignComponentTopology() and, for a mesh with tags or
/// face-varying values, the other two.  What you have written for Far serves with FarExt::BaseTopology
/// in place of Far::TopologyRefiner, unless it assigns edges of its own, which are found here:
///
/// \code
/// namespace OpenSubdivHex::FarExt {
/// template <>
/// bool MeshRefinerFactory<Mesh>::resizeComponentTopology(BaseTopology &base, Mesh const &mesh) {
///     setNumBaseVertices(base, mesh.GetNumVertices());
///     setNumBaseFaces(base, mesh.GetNumFaces());
///     for (int face = 0; face < mesh.GetNumFaces(); ++face) {
///         setNumBaseFaceVertices(base, face, mesh.GetFaceSize(face));
///     }
///     return true;
/// }
/// template <>
/// bool MeshRefinerFactory<Mesh>::assignComponentTopology(BaseTopology &base, Mesh const &mesh) {
///     for (int face = 0; face < mesh.GetNumFaces(); ++face) {
///         IndexArray verts = getBaseFaceVertices(base, face);
///         std::copy_n(mesh.GetFace(face), verts.size(), verts.begin());
///     }
///     return true;
/// }
/// } // namespace OpenSubdivHex::FarExt
///
/// auto refiner = FarExt::MeshRefinerFactory<Mesh>::Create(mesh, sdcOptions);
/// \endcode
///
/// Where a function returns false, Create() fails.  Several threads may call it at once, also for the
/// same mesh if that bears it.  What the functions throw passes through.
template <class MESH>
class MeshRefinerFactory : protected MeshRefinerFactoryBase {
public:
    /// How the mesh is refined.
    using Options = TopologyRefinerFactory::Options;

    /// \return  null on failure, with the causes of TopologyRefinerFactory::Create from a descriptor
    ///          or, where a function returned false, InvalidTopology
    static std::unique_ptr<TopologyRefiner> Create(MESH const &mesh, Sdc::Options sdcOptions,
                                                   Options options, CallStatus *status = nullptr) {
        return create(
            sdcOptions, options, status,
            [&](BaseTopology &base) { return resizeComponentTopology(base, mesh); },
            [&](BaseTopology &base) { return assignComponentTopology(base, mesh); },
            [&](BaseTopology &base) { return assignComponentTags(base, mesh); },
            [&](BaseTopology &base) { return assignFaceVaryingTopology(base, mesh); });
    }
    /// Overload with default options.
    static std::unique_ptr<TopologyRefiner> Create(MESH const &mesh,
                                                   Sdc::Options sdcOptions = Sdc::Options(),
                                                   CallStatus *status = nullptr) {
        return Create(mesh, sdcOptions, Options(), status);
    }

protected:
    /// Sets the numbers of vertices and faces, and that of the vertices of each face.
    static bool resizeComponentTopology(BaseTopology &base, MESH const &mesh);
    /// Assigns the vertices of each face.
    static bool assignComponentTopology(BaseTopology &base, MESH const &mesh);
    /// Sets the sharpness of edges and vertices, and holes.  None, unless it is specialised.
    static bool assignComponentTags(BaseTopology &, MESH const &) { return true; }
    /// Creates channels, and assigns their values.  None, unless it is specialised.
    static bool assignFaceVaryingTopology(BaseTopology &, MESH const &) { return true; }
};

} // namespace OpenSubdivHex::FarExt

#endif
