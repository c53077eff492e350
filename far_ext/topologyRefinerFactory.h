// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_FACTORY_H

#include "topologyRefiner.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <functional>

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
///     options.schemeOptions.faceMask = FarExt::FaceMask::Smooth;
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
        HexSchemeOptions schemeOptions; ///< scheme and face mask
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

} // namespace OpenSubdivHex::FarExt

#endif
