// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_SCENE_H
#define OPENSUBDIVHEX_TOOLS_SCENE_H

#include "surface.h"
#include "vec3.h"

#include <memory>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace OpenSubdivHex::Tools {

/// \brief The content of a picture as an Embree scene: a surface, rods, both or neither.
class Scene {
public:
    /// Throws std::runtime_error when Embree does not start.
    Scene();
    ~Scene();

    /// \brief Replaces everything.  Throws std::bad_alloc, or std::runtime_error with an error of Embree.
    ///
    /// \param surface    null for none; must live unchanged as long as rays are traced
    /// \param rodEnds    x y z of two points for each rod
    /// \param rodRadius  of all rods
    void Build(Surface const *surface, std::vector<float> const &rodEnds, float rodRadius);

    struct Hit {
        Vec3 point;
        Vec3 normal;       ///< of the triangle or rod, of length 1
        int triangle = -1; ///< of the surface; -1 for a rod
        float u = 0;
        float v = 0;
    };

    /// Whether the ray hits something, and what it hits first.
    bool Intersect(Vec3 origin, Vec3 direction, Hit *hit) const;

    static constexpr int kNumRays = 4;

    /// Whether each of the rays from \p origin hits something; of those with \p isWanted set alone.
    void FindOccluded(Vec3 origin, Vec3 const (&directions)[kNumRays],
                      bool const (&isWanted)[kNumRays], bool (&isOccluded)[kNumRays]) const;

    /// Least and largest coordinates; 0 where there is nothing.
    Vec3 GetLow() const { return _low; }
    Vec3 GetHigh() const { return _high; }
    Surface const *GetSurface() const { return _surface; }

private:
    struct Release {
        void operator()(RTCDeviceTy *device) const;
        void operator()(RTCSceneTy *scene) const;
    };

    void addSurface();
    void addRods(std::vector<float> const &rodEnds, float rodRadius);

    std::unique_ptr<RTCDeviceTy, Release> _device;
    std::unique_ptr<RTCSceneTy, Release> _scene;
    Surface const *_surface = nullptr;
    Vec3 _low;
    Vec3 _high;
};

} // namespace OpenSubdivHex::Tools

#endif
