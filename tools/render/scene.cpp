// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include "embreeError.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace OpenSubdivHex::Tools {

namespace {

enum GeometryId : unsigned { kSurfaceId = 0, kRodsId = 1 };

/// A buffer of \p geometry, of Embree's own, of one element at least; throws as ThrowEmbreeError().
template <typename T>
T *createBuffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
                std::size_t elementSize, std::size_t numElements) {
    void *const buffer =
        rtcSetNewGeometryBuffer(geometry, type, 0, format, elementSize, numElements);
    ThrowEmbreeError(device);
    return static_cast<T *>(buffer);
}

void attach(RTCScene scene, RTCGeometry geometry, GeometryId id) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

} // namespace

void Scene::Release::operator()(RTCDeviceTy *device) const { rtcReleaseDevice(device); }
void Scene::Release::operator()(RTCSceneTy *scene) const { rtcReleaseScene(scene); }

// One thread builds: the same tree, and so the same picture, each time.
Scene::Scene() : _device(rtcNewDevice("threads=1")) {
    if (!_device) {
        throw std::runtime_error("Embree does not start");
    }
}

Scene::~Scene() = default;

void Scene::Build(Surface const *surface, std::vector<float> const &rodEnds, float rodRadius) {
    _surface = surface;
    _scene.reset(rtcNewScene(_device.get()));
    rtcSetSceneFlags(_scene.get(), RTC_SCENE_FLAG_ROBUST);
    bool const hasTriangles = surface && surface->GetTriangles().GetNumTriangles() > 0;
    if (hasTriangles) {
        addSurface();
    }
    if (!rodEnds.empty()) {
        addRods(rodEnds, rodRadius);
    }
    rtcCommitScene(_scene.get());
    ThrowEmbreeError(_device.get());
    RTCBounds bounds = {};
    if (hasTriangles || !rodEnds.empty()) {
        rtcGetSceneBounds(_scene.get(), &bounds);
    }
    _low = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
    _high = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
}

void Scene::addSurface() {
    RTCGeometry const geometry = rtcNewGeometry(_device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    std::vector<float> const &positions = _surface->GetPositions();
    auto *const points =
        createBuffer<float>(_device.get(), geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                            3 * sizeof(float), positions.size() / 3);
    std::copy(positions.begin(), positions.end(), points);
    std::vector<int> const &vertices = _surface->GetTriangles().vertices;
    auto *const indices =
        createBuffer<unsigned>(_device.get(), geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3,
                               3 * sizeof(unsigned), vertices.size() / 3);
    std::copy(vertices.begin(), vertices.end(), indices);
    attach(_scene.get(), geometry, kSurfaceId);
}

void Scene::addRods(std::vector<float> const &rodEnds, float rodRadius) {
    RTCGeometry const geometry =
        rtcNewGeometry(_device.get(), RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    std::size_t const numRods = rodEnds.size() / 6;
    auto *const points = createBuffer<float>(_device.get(), geometry, RTC_BUFFER_TYPE_VERTEX,
                                             RTC_FORMAT_FLOAT4, 4 * sizeof(float), 2 * numRods);
    for (std::size_t i = 0; i < 2 * numRods; ++i) {
        std::copy_n(rodEnds.begin() + 3 * std::ptrdiff_t(i), 3, points + 4 * i);
        points[4 * i + 3] = rodRadius;
    }
    auto *const indices = createBuffer<unsigned>(_device.get(), geometry, RTC_BUFFER_TYPE_INDEX,
                                                 RTC_FORMAT_UINT, sizeof(unsigned), numRods);
    for (std::size_t i = 0; i < numRods; ++i) {
        indices[i] = unsigned(2 * i);
    }
    attach(_scene.get(), geometry, kRodsId);
}

bool Scene::Intersect(Vec3 origin, Vec3 direction, Hit *hit) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit ray = {};
    ray.ray.org_x = origin.x;
    ray.ray.org_y = origin.y;
    ray.ray.org_z = origin.z;
    ray.ray.dir_x = direction.x;
    ray.ray.dir_y = direction.y;
    ray.ray.dir_z = direction.z;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(_scene.get(), &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    hit->point = origin + ray.ray.tfar * direction;
    hit->normal = Normalize({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z});
    hit->triangle = ray.hit.geomID == kSurfaceId ? int(ray.hit.primID) : -1;
    hit->u = ray.hit.u;
    hit->v = ray.hit.v;
    return true;
}

void Scene::FindOccluded(Vec3 origin, Vec3 const (&directions)[kNumRays],
                         bool const (&isWanted)[kNumRays], bool (&isOccluded)[kNumRays]) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay4 rays = {};
    alignas(16) int valid[kNumRays];
    for (int i = 0; i < kNumRays; ++i) {
        valid[i] = isWanted[i] ? -1 : 0;
        rays.org_x[i] = origin.x;
        rays.org_y[i] = origin.y;
        rays.org_z[i] = origin.z;
        rays.dir_x[i] = directions[i].x;
        rays.dir_y[i] = directions[i].y;
        rays.dir_z[i] = directions[i].z;
        rays.tfar[i] = std::numeric_limits<float>::infinity();
        rays.mask[i] = ~0u;
    }
    rtcOccluded4(valid, _scene.get(), &context, &rays);
    for (int i = 0; i < kNumRays; ++i) {
        isOccluded[i] = isWanted[i] && rays.tfar[i] < 0;
    }
}

} // namespace OpenSubdivHex::Tools
