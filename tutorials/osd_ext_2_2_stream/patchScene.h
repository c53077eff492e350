// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_PATCH_SCENE_H
#define OPENSUBDIVHEX_TUTORIALS_PATCH_SCENE_H

#include "bfr_ext/patchStream.h"
#include "tools/render/vec3.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Tools {

/// \brief The surface of a mesh for rays, in Embree's hands, of which only those parts are there that
/// rays have come near to.
///
/// Each base face has a box.  Its patch is made when a ray first hits the box.  When all
/// patches take more memory than they may, the least recently used ones go.
/// Hits of rays do not depend on that: a patch that is made again is the same, bit for bit.
///
/// Rays may be traced by several threads at once.
class PatchScene {
public:
    static constexpr int kMaxTimesMade = 2;

    /// \brief Makes the boxes.
    ///
    /// \param stream     makes the patches, of triangles; it must live as long
    /// \param positions  x y z of each vertex of the base mesh; they must live as long
    /// \param maxMemory  bytes that Embree has for patches; the one that is needed is always there
    /// \param onShortage  called once, by a thread that traces a ray, if patches are made again and again
    ///                    since \p maxMemory is less than what rays need: when more than
    ///                    kMaxTimesMade times as many were made as there are faces that needed one
    ///
    /// Throws std::runtime_error when Embree does not start or a face has no surface.
    PatchScene(BfrExt::PatchStream<float> const &stream, std::vector<float> const &positions,
               std::size_t maxMemory, std::function<void()> onShortage);
    ~PatchScene();

    PatchScene(PatchScene const &) = delete;
    PatchScene &operator=(PatchScene const &) = delete;

    /// Where a ray hits first.
    struct Hit {
        Vec3 point;
        Vec3 normal; ///< of the triangle, of length 1
        int face;    ///< the base face
    };

    /// Whether the ray hits something.  Throws what making a patch throws.
    bool Intersect(Vec3 origin, Vec3 direction, Hit *hit) const;
    /// Whether it hits something nearer than \p distance.
    bool IsOccluded(Vec3 origin, Vec3 direction, float distance) const;

    /// Counts so far.
    struct Statistics {
        std::int64_t numMade;      ///< patches, each as often as it was made
        std::int64_t numForgotten; ///< of these
        std::int64_t numFaces;     ///< whose patches were made at all
        std::int64_t numTriangles; ///< of all that were made
        std::size_t peakMemory;    ///< of Embree, in bytes, all that it has included
    };
    Statistics GetStatistics() const;

private:
    class Patches;

    std::unique_ptr<Patches> _patches;
};

} // namespace OpenSubdivHex::Tools

#endif
