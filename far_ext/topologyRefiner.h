// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_H
#define OPENSUBDIVHEX_FAR_EXT_TOPOLOGY_REFINER_H

#include "hexSchemeOptions.h"
#include "topologyLevel.h"

#include <opensubdiv/sdc/options.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace OpenSubdivHex::FarExt {

/// \brief The topology of a mesh and of its refined levels.
///
/// \code
///     auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, options);
///     refiner->RefineUniform(3);
///     FarExt::TopologyLevel const &level = refiner->GetLevel(3);
/// \endcode
///
/// TopologyRefinerFactory makes it and copies the base mesh: the refiner does not refer to the base refiner or descriptor.
/// Indices, channels and levels are not checked, as in Far.
///
/// **Threads.** Several threads may call const functions, and make tables and evaluators of a refiner, at once.
/// RefineUniform, RefineCoplanar and Unrefine are called by one thread while no other uses the refiner or its levels.
class OPENSUBDIVHEX_API TopologyRefiner {
public:
    /// Takes level 0.  Use TopologyRefinerFactory, which makes and validates it.
    TopologyRefiner(std::unique_ptr<internal::Hierarchy> base, Sdc::Options sdcOptions,
                    HexSchemeOptions schemeOptions);
    ~TopologyRefiner();

    TopologyRefiner(TopologyRefiner const &) = delete;
    TopologyRefiner &operator=(TopologyRefiner const &) = delete;

    /// The scheme, as the factory was given it.
    HexSchemeOptions GetHexSchemeOptions() const { return _schemeOptions; }
    /// The boundary, crease and face-varying options of the base mesh.
    Sdc::Options GetSchemeOptions() const { return _sdcOptions; }

    /// Levels, the base included.
    int GetNumLevels() const { return int(_levels.size()); }
    /// The last level; 0 where there is the base alone.
    int GetMaxLevel() const { return GetNumLevels() - 1; }
    /// False after RefineCoplanar.
    bool IsUniform() const { return _isUniform; }

    /// Whether the base has faces tagged as holes.
    bool HasHoles() const;

    /// @name Face-varying channels, as in Far::TopologyRefiner
    /// @{

    /// Face-varying channels of the mesh.
    int GetNumFVarChannels() const { return GetLevel(0).GetNumFVarChannels(); }
    /// How a channel is interpolated.
    Sdc::Options::FVarLinearInterpolation GetFVarLinearInterpolation(int channel = 0) const;
    /// Sum over all levels.
    int GetNumFVarValuesTotal(int channel = 0) const;
    /// @}

    /// Vertices of all levels.
    int GetNumVerticesTotal() const;
    /// Edges of all levels.
    int GetNumEdgesTotal() const;
    /// Faces of all levels.
    int GetNumFacesTotal() const;
    /// Face-vertices of all levels.
    int GetNumFaceVerticesTotal() const;

    /// \p level is 0 ... GetMaxLevel().
    TopologyLevel const &GetLevel(int level) const { return _levels[std::size_t(level)]; }

    /// The last level that any refinement makes.  Levels that grow are too large long before it.
    static constexpr int kLastLevel = 100;

    /// \brief Options of RefineUniform, as Far::TopologyRefiner::UniformOptions.
    struct UniformOptions {
        /// \p level steps, and the defaults.
        UniformOptions(int level) : refinementLevel(level) {}

        int refinementLevel;                  ///< number of refinement steps, 0 or more
        bool fullTopologyInLastLevel = false; ///< false: the last level has face-vertices alone
        /// A label of each base face, such as the number of its material, or empty: where labels
        /// differ, FirstStep::Truncate cuts the polygons of vertices, so that every face lies in base
        /// faces of one label.  Hexagonal steps need none: each half of a hexagon lies in one base face.
        /// Steps of Doo-Sabin and tri-hex, which cut no polygons, are refused with labels that differ.
        std::vector<int> faceLabels;
    };

    /// \brief Refines all faces \p options.refinementLevel times, replacing earlier refinements.
    ///
    /// \return  false on failure:
    ///          - InvalidArgument: a negative level; another number of labels than of base faces
    ///          - TooLarge, which names the level and the count: a size, or its sum over the levels, exceeds 2^31 - 1; a
    ///            level beyond kLastLevel
    ///          - Unsupported: labels that differ where a step does not keep them apart
    ///
    ///          The levels are then as before, with one exception: sizes behind a tri-hex step with borders, and behind a
    ///          truncation that cuts polygons, are known only when that step is made; if they are too large, level 0 alone
    ///          is left.  After std::bad_alloc there are all levels of before, or level 0 alone.
    bool RefineUniform(UniformOptions options, CallStatus *status = nullptr);

    /// The options of the last successful RefineUniform; of level 0 after RefineCoplanar and
    /// Unrefine.
    UniformOptions GetUniformOptions() const { return _uniformOptions; }

    /// \brief Options of RefineCoplanar.
    struct CoplanarOptions {
        /// \p level steps, and the defaults.
        CoplanarOptions(int level) : refinementLevel(level) {}

        int refinementLevel;         ///< number of refinement steps, 0 or more
        double angleTolerance = 0.1; ///< largest angle in degrees between normals taken as equal
        /// Whether polygons at the vertices close the gaps between the faces; false is the paper's
        /// literal form, in which they stay open.
        bool closeGaps = true;
        bool fullTopologyInLastLevel = false; ///< as in UniformOptions
    };

    /// \brief Refines as the paper's stage 3: an edge between two faces of the same normal makes a quad, other edges make
    /// hexagons.  Replaces earlier refinements.
    ///
    /// Normals are those of a rest pose, which is refined with the levels.  They fix the topology: tables and primvars then
    /// work for any other pose.  The normal of a face is the direction of its polygon's vector area, planar or not; a face
    /// of no area has none.  Edges at boundaries, creases, crease diagonals, sharp and non-manifold vertices and face-varying
    /// seams always make hexagons.
    /// INDEXING.md has the numbering.
    ///
    /// \param restPositions  x, y, z of the GetLevel(0).GetNumVertices() vertices of level 0
    /// \return  false with StatusCode::InvalidArgument for a negative level, an angle that is not
    ///          between 0 and 180, a coordinate that is not finite (its vertex is named) or a null
    ///          pointer; Unsupported for other schemes than Hexagonal; TooLarge, as RefineUniform,
    ///          for sizes that are too large whichever edges are flat, or for a level beyond
    ///          kLastLevel; the levels are then as before.  Other sizes are known only once the
    ///          level before is made: false with TooLarge, and the base alone is left.  When
    ///          std::bad_alloc is thrown, it is, too, unless all levels are as before.
    bool RefineCoplanar(float const *restPositions, CoplanarOptions options,
                        CallStatus *status = nullptr);
    /// \copydoc RefineCoplanar(float const *, CoplanarOptions, CallStatus *)
    bool RefineCoplanar(double const *restPositions, CoplanarOptions options,
                        CallStatus *status = nullptr);

    /// How often levels were made or removed.  What refers to levels, as OsdExt's
    /// RefinementEvaluator does, is out of date when this has changed.
    int GetNumRefinements() const { return _numRefinements; }

    /// Removes all levels but the base; their memory is kept for the next refinement.
    void Unrefine();

    /// All levels, for the library's own use.
    internal::Hierarchy const &GetHierarchy() const { return *_hierarchy; }

private:
    template <typename REAL>
    bool refineCoplanar(REAL const *restPositions, CoplanarOptions const &options,
                        CallStatus *status);
    template <typename REFINE>
    CallStatus replaceLevels(REFINE refine);
    int total(int (TopologyLevel::*count)() const) const;

    std::unique_ptr<internal::Hierarchy> _hierarchy;
    Sdc::Options _sdcOptions;
    HexSchemeOptions _schemeOptions;
    UniformOptions _uniformOptions{0};
    bool _isUniform = true;
    int _numRefinements = 0;
    std::vector<TopologyLevel> _levels;
};

} // namespace OpenSubdivHex::FarExt

#endif
