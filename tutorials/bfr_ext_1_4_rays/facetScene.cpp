// SPDX-License-Identifier: Apache-2.0
#include "facetScene.h"

#include "tools/render/embreeError.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

namespace {

RTCRay makeRay(Vec3 origin, Vec3 direction) {
    RTCRay ray = {};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0U;
    return ray;
}

template <typename T>
void setBuffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
               std::vector<T> const &values) {
    void *const buffer =
        rtcSetNewGeometryBuffer(geometry, type, 0, format, 3 * sizeof(T), values.size() / 3);
    ThrowEmbreeError(device);
    std::copy(values.begin(), values.end(), static_cast<T *>(buffer));
}

} // namespace

void FacetScene::Release::operator()(RTCDeviceTy *device) const { rtcReleaseDevice(device); }
void FacetScene::Release::operator()(RTCSceneTy *scene) const { rtcReleaseScene(scene); }

// One thread builds: the same tree, and so the same picture, each time.
FacetScene::FacetScene(std::vector<FaceFacets> const &faces)
    : _faces(faces), _device(rtcNewDevice("threads=1")) {
    if (!_device) {
        throw std::runtime_error("Embree does not start");
    }
    _scene.reset(rtcNewScene(_device.get()));
    rtcSetSceneFlags(_scene.get(), RTC_SCENE_FLAG_ROBUST);
    // A geometry for each face, whose number is that of the face.
    for (std::size_t face = 0; face < faces.size(); ++face) {
        if (faces[face].facets.empty()) {
            continue;
        }
        RTCGeometry const geometry = rtcNewGeometry(_device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        setBuffer(_device.get(), geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                  faces[face].points);
        setBuffer(_device.get(), geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                  faces[face].facets);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(_scene.get(), geometry, unsigned(face));
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(_scene.get());
    ThrowEmbreeError(_device.get());
}

FacetScene::~FacetScene() = default;

FacetScene::Hit FacetScene::Intersect(Vec3 origin, Vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray = {};
    ray.ray = makeRay(origin, direction);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(_scene.get(), &context, &ray);
    Hit hit;
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return hit;
    }
    hit.face = int(ray.hit.geomID);
    hit.point = origin + ray.ray.tfar * direction;
    // Embree says how much of each corner there is.  These have a mean in the plane of the face: faces of five and
    // more sides have sub-faces, between which there is none of u and v.
    FaceFacets const &face = _faces[ray.hit.geomID];
    int const *const corners = &face.facets[3 * std::size_t(ray.hit.primID)];
    float const weights[3] = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
    float mean[2] = {0, 0};
    for (int i = 0; i < 3; ++i) {
        float const *const coords = &face.coords[2 * std::size_t(corners[i])];
        mean[0] += weights[i] * coords[0];
        mean[1] += weights[i] * coords[1];
        hit.side = std::max(hit.side, Length(GetVec3(face.points.data(), corners[(i + 1) % 3]) -
                                             GetVec3(face.points.data(), corners[i])));
    }
    face.parameterization.ConvertFromPlane(mean, hit.uv);
    return hit;
}

bool FacetScene::IsOccluded(Vec3 origin, Vec3 direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray = makeRay(origin, direction);
    rtcOccluded1(_scene.get(), &context, &ray);
    return ray.tfar < 0;
}

} // namespace OpenSubdivHex::Tools
