// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TUTORIALS_FACET_SCENE_H
#define OPENSUBDIVHEX_TUTORIALS_FACET_SCENE_H

#include "bfr_ext/parameterization.h"
#include "tools/render/vec3.h"

#include <memory>
#include <vector>

struct RTCDeviceTy;
struct RTCSceneTy;

namespace OpenSubdivHex::Tools {

/// A face of a mesh, cut into triangles.
struct FaceFacets {
    BfrExt::Parameterization parameterization;
    std::vector<float> coords; ///< of each point, two in the plane of the parameterization
    std::vector<float> points; ///< x y z
    std::vector<int> facets;   ///< three points each; none where the face is a hole
};

/// \brief The facets of all faces, in Embree's hands: a ray that hits one learns the face, and u and v there.
class FacetScene {
public:
    /// \param faces  must live unchanged as long.  Throws std::runtime_error with an error of Embree
    explicit FacetScene(std::vector<FaceFacets> const &faces);
    ~FacetScene();

    struct Hit {
        int face = -1; ///< -1: the ray hits nothing
        float uv[2] = {0, 0};
        Vec3 point;     ///< of the facet
        float side = 0; ///< length of the facet's longest one
    };
    /// Finds the first hit of a ray.  Threads may trace at once.
    Hit Intersect(Vec3 origin, Vec3 direction) const;
    /// Whether it hits anything.
    bool IsOccluded(Vec3 origin, Vec3 direction) const;

private:
    struct Release {
        void operator()(RTCDeviceTy *device) const;
        void operator()(RTCSceneTy *scene) const;
    };

    std::vector<FaceFacets> const &_faces;
    std::unique_ptr<RTCDeviceTy, Release> _device;
    std::unique_ptr<RTCSceneTy, Release> _scene;
};

} // namespace OpenSubdivHex::Tools

#endif
