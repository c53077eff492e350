// SPDX-License-Identifier: Apache-2.0
#include "patchScene.h"

#include "far_ext/executor.h"
#include "tools/render/embreeError.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <list>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using SharedScene = std::shared_ptr<RTCSceneTy>;

RTCRay makeRay(Vec3 origin, Vec3 direction, float distance) {
    RTCRay ray = {};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tfar = distance;
    ray.mask = ~0U;
    return ray;
}

} // namespace

/// The boxes, and the patches that are there.
class PatchScene::Patches {
public:
    Patches(BfrExt::PatchStream<float> const &stream, std::vector<float> const &positions,
            std::size_t maxMemory, std::function<void()> onShortage);

    /// Throws what went wrong in a callback, which nothing may leave.
    void Rethrow() const {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (_exception) {
            std::rethrow_exception(_exception);
        }
    }
    RTCScene GetScene() const { return _scene.get(); }
    int GetFace(unsigned primitive) const { return _faces[primitive]; }
    Statistics GetStatistics() const {
        std::lock_guard<std::mutex> const lock(_mutex);
        Statistics statistics = _statistics;
        statistics.peakMemory = std::size_t(_peakMemory);
        return statistics;
    }

private:
    struct Box {
        float low[3];
        float high[3];
    };
    /// A patch that is there: where it stands among the others.
    struct Entry {
        SharedScene scene;
        std::list<unsigned>::iterator place;
        bool wasMade = false;
    };

    static bool monitor(void *patches, ssize_t bytes, bool post);
    static void getBounds(RTCBoundsFunctionArguments const *arguments);
    static void intersect(RTCIntersectFunctionNArguments const *arguments);
    static void isOccluded(RTCOccludedFunctionNArguments const *arguments);

    SharedScene find(unsigned primitive);
    SharedScene keep(unsigned primitive, SharedScene scene, std::int64_t numTriangles);
    SharedScene make(unsigned primitive, std::int64_t *numTriangles) const;
    template <typename FUNCTION>
    void guard(FUNCTION function) noexcept;

    BfrExt::PatchStream<float> const &_stream;
    std::vector<float> const &_positions;
    std::ptrdiff_t const _maxMemory;
    std::function<void()> const _onShortage;
    std::once_flag _isShort;
    // Embree calls monitor() to its end.
    std::atomic<std::ptrdiff_t> _memory{0};
    std::atomic<std::ptrdiff_t> _peakMemory{0};
    std::vector<int> _faces;
    std::vector<Box> _boxes;
    Device _device;
    SharedScene _scene;
    mutable std::mutex _mutex;
    std::vector<Entry> _entries;
    std::list<unsigned> _recent; // the last used one first
    std::exception_ptr _exception;
    Statistics _statistics = {};
};

// One thread makes a patch: that which needs it.
PatchScene::Patches::Patches(BfrExt::PatchStream<float> const &stream,
                             std::vector<float> const &positions, std::size_t maxMemory,
                             std::function<void()> onShortage)
    : _stream(stream), _positions(positions), _maxMemory(std::ptrdiff_t(maxMemory)),
      _onShortage(std::move(onShortage)), _device(rtcNewDevice("threads=1")) {
    if (!_device) {
        throw std::runtime_error("Embree does not start");
    }
    rtcSetDeviceMemoryMonitorFunction(_device.get(), monitor, this);
    BfrExt::SurfaceFactory const &factory = stream.GetFactory();
    BfrExt::Surface<float> surface;
    for (int face = 0; face < factory.GetNumFaces(); ++face) {
        if (factory.GetLevel().IsFaceHole(face)) {
            continue;
        }
        FarExt::CallStatus status;
        if (!factory.InitVertexSurface(face, &surface, &status)) {
            throw std::runtime_error(status.GetErrorMessage());
        }
        Box box;
        surface.BoundControlPointsFromMesh(positions.data(), 3, box.low, box.high);
        // Points are rounded.
        for (std::size_t i = 0; i < 3; ++i) {
            float const margin = 1e-5F * (box.high[i] - box.low[i]) +
                                 1e-6F * std::max(std::abs(box.high[i]), std::abs(box.low[i]));
            box.low[i] -= margin;
            box.high[i] += margin;
        }
        _faces.push_back(face);
        _boxes.push_back(box);
    }
    _entries.resize(_faces.size());
    RTCGeometry const geometry = rtcNewGeometry(_device.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(_faces.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(geometry, getBounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, isOccluded);
    rtcCommitGeometry(geometry);
    _scene.reset(rtcNewScene(_device.get()), Release());
    rtcAttachGeometry(_scene.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(_scene.get());
    ThrowEmbreeError(_device.get());
}

bool PatchScene::Patches::monitor(void *patches, ssize_t bytes, bool /*post*/) {
    auto &self = *static_cast<Patches *>(patches);
    std::ptrdiff_t const memory = self._memory += bytes;
    std::ptrdiff_t peak = self._peakMemory;
    while (memory > peak && !self._peakMemory.compare_exchange_weak(peak, memory)) {
    }
    return true;
}

void PatchScene::Patches::getBounds(RTCBoundsFunctionArguments const *arguments) {
    auto const &self = *static_cast<Patches const *>(arguments->geometryUserPtr);
    Box const &box = self._boxes[arguments->primID];
    RTCBounds &bounds = *arguments->bounds_o;
    bounds.lower_x = box.low[0];
    bounds.lower_y = box.low[1];
    bounds.lower_z = box.low[2];
    bounds.upper_x = box.high[0];
    bounds.upper_y = box.high[1];
    bounds.upper_z = box.high[2];
}

// Nothing that is thrown may leave a callback: the ray passes the patch, and whoever traces it throws.
template <typename FUNCTION>
void PatchScene::Patches::guard(FUNCTION function) noexcept {
    try {
        function();
    } catch (...) {
        std::lock_guard<std::mutex> const lock(_mutex);
        _exception = std::current_exception();
    }
}

// Single rays are all that is traced.
void PatchScene::Patches::intersect(RTCIntersectFunctionNArguments const *arguments) {
    if (arguments->valid[0] == 0) {
        return;
    }
    auto &self = *static_cast<Patches *>(arguments->geometryUserPtr);
    self.guard([&] {
        SharedScene const scene = self.find(arguments->primID);
        auto &ray = *reinterpret_cast<RTCRayHit *>(arguments->rayhit);
        float const distance = ray.ray.tfar;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene.get(), &context, &ray);
        if (ray.ray.tfar < distance) {
            ray.hit.geomID = arguments->geomID;
            ray.hit.primID = arguments->primID;
        }
    });
}

void PatchScene::Patches::isOccluded(RTCOccludedFunctionNArguments const *arguments) {
    if (arguments->valid[0] == 0) {
        return;
    }
    auto &self = *static_cast<Patches *>(arguments->geometryUserPtr);
    self.guard([&] {
        SharedScene const scene = self.find(arguments->primID);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene.get(), &context, reinterpret_cast<RTCRay *>(arguments->ray));
    });
}

// The patch of a box: as it is there, or made now.
SharedScene PatchScene::Patches::find(unsigned primitive) {
    Entry &entry = _entries[primitive];
    {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (entry.scene) {
            _recent.splice(_recent.begin(), _recent, entry.place);
            return entry.scene;
        }
    }
    std::int64_t numTriangles = 0;
    SharedScene scene = make(primitive, &numTriangles);
    scene = keep(primitive, std::move(scene), numTriangles);
    Statistics const statistics = GetStatistics();
    if (statistics.numMade > kMaxTimesMade * statistics.numFaces) {
        std::call_once(_isShort, _onShortage);
    }
    return scene;
}

// Takes a patch that was made, and forgets others where memory is short.
SharedScene PatchScene::Patches::keep(unsigned primitive, SharedScene scene,
                                      std::int64_t numTriangles) {
    Entry &entry = _entries[primitive];
    std::lock_guard<std::mutex> const lock(_mutex);
    if (entry.scene) {
        return entry.scene; // another thread was faster
    }
    _statistics.numFaces += entry.wasMade ? 0 : 1;
    entry.wasMade = true;
    ++_statistics.numMade;
    _statistics.numTriangles += numTriangles;
    entry.scene = scene;
    _recent.push_front(primitive);
    entry.place = _recent.begin();
    while (_memory > _maxMemory && _recent.size() > 1) {
        Entry &last = _entries[_recent.back()];
        last.scene.reset();
        _recent.pop_back();
        ++_statistics.numForgotten;
    }
    return scene;
}

SharedScene PatchScene::Patches::make(unsigned primitive, std::int64_t *numTriangles) const {
    FarExt::ExecutorScope const alone(nullptr, 1);
    SharedScene scene(rtcNewScene(_device.get()), Release());
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT);
    // A large face has several sections.
    auto const sink = [&](BfrExt::PatchStream<float>::Patch const &patch) {
        RTCGeometry const geometry = rtcNewGeometry(_device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto const numPoints = std::size_t(patch.tessellation.GetNumCoords());
        auto const numFacets = std::size_t(patch.tessellation.GetNumFacets());
        auto *const points = static_cast<float *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), numPoints));
        auto *const triangles = static_cast<int *>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), numFacets));
        if (points && triangles) {
            std::copy(patch.points, patch.points + 3 * numPoints, points);
            patch.tessellation.GetFacets(triangles);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene.get(), geometry);
        }
        rtcReleaseGeometry(geometry);
        *numTriangles += std::int64_t(numFacets);
        return points && triangles;
    };
    int const face = _faces[primitive];
    FarExt::CallStatus status;
    if (!_stream.Run(_positions.data(), 3, face, face + 1, sink, &status)) {
        ThrowEmbreeError(_device.get());
        throw std::runtime_error(status.GetErrorMessage());
    }
    rtcCommitScene(scene.get());
    return scene;
}

PatchScene::PatchScene(BfrExt::PatchStream<float> const &stream,
                       std::vector<float> const &positions, std::size_t maxMemory,
                       std::function<void()> onShortage)
    : _patches(std::make_unique<Patches>(stream, positions, maxMemory, std::move(onShortage))) {}

PatchScene::~PatchScene() = default;

bool PatchScene::Intersect(Vec3 origin, Vec3 direction, Hit *hit) const {
    RTCRayHit ray = {};
    ray.ray = makeRay(origin, direction, std::numeric_limits<float>::infinity());
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(_patches->GetScene(), &context, &ray);
    _patches->Rethrow();
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        return false;
    }
    hit->point = origin + ray.ray.tfar * direction;
    hit->normal = Normalize({ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z});
    hit->face = _patches->GetFace(ray.hit.primID);
    return true;
}

bool PatchScene::IsOccluded(Vec3 origin, Vec3 direction, float distance) const {
    RTCRay ray = makeRay(origin, direction, distance);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(_patches->GetScene(), &context, &ray);
    _patches->Rethrow();
    return ray.tfar < 0;
}

PatchScene::Statistics PatchScene::GetStatistics() const { return _patches->GetStatistics(); }

} // namespace OpenSubdivHex::Tools
