// SPDX-License-Identifier: Apache-2.0
#include "patchStream.h"

#include "cell/patchEvaluator.h"

#include "far_ext/threads.h"
#include "far_ext/vtr/parallel.h"

#include <atomic>
#include <map>
#include <mutex>
#include <string>

namespace OpenSubdivHex::BfrExt {

using FarExt::ComponentType;
using FarExt::Status;
using FarExt::StatusCode;

namespace internal {

/// \brief What patches with the same levels have in common: their tessellation, and which cells its
/// places lie in.
struct PatchPlan {
    PatchPlan(std::vector<int> const &levels, Tessellation::Options const &options)
        : tessellation(Parameterization(int(levels.size()) - 1), int(levels.size()), levels.data(),
                       options),
          cells(tessellation.GetFaceSize(), levels.back(), getInteriorPlaces(tessellation),
                tessellation.GetNumBoundaryCoords()) {}

    /// Memory, in bytes.
    std::size_t GetSize() const {
        return std::size_t(tessellation.GetNumCoords()) *
                   (2 * sizeof(double) + sizeof(LeafPlaces::Place)) +
               std::size_t(tessellation.GetNumFacetVertices() + tessellation.GetNumFacets()) *
                   sizeof(int) +
               cells.GetSize();
    }

    Tessellation const tessellation;
    CellPlan const cells;

private:
    static std::vector<LeafPlaces::Place> getInteriorPlaces(Tessellation const &tessellation) {
        std::vector<LeafPlaces::Place> places;
        for (auto place = tessellation._places.begin() + tessellation.GetNumBoundaryCoords();
             place != tessellation._places.end(); ++place) {
            places.push_back({place->sector, {place->start, place->end}});
        }
        return places;
    }
};

/// \brief The plans that have been asked for; they are forgotten when they have come to take too much
/// memory.  Any number of threads may use it.
class PatchPlans {
public:
    PatchPlans(Tessellation::Options const &options, std::size_t maxMemory)
        : _options(options), _maxMemory(maxMemory) {}

    /// Threads that want a plan wait for it, since it takes memory to make one.
    std::shared_ptr<PatchPlan const> Find(std::vector<int> const &levels) {
        std::lock_guard<std::mutex> const lock(_mutex);
        auto const found = _plans.find(levels);
        if (found != _plans.end()) {
            return found->second;
        }
        auto plan = std::make_shared<PatchPlan const>(levels, _options);
        std::size_t const size = plan->GetSize();
        if (_memory + size > _maxMemory) {
            _plans.clear();
            _memory = 0;
        }
        _memory += size;
        return _plans.emplace(levels, std::move(plan)).first->second;
    }

private:
    Tessellation::Options const _options;
    std::size_t const _maxMemory;
    std::size_t _memory = 0;
    std::mutex _mutex;
    std::map<std::vector<int>, std::shared_ptr<PatchPlan const>> _plans;
};

} // namespace internal

namespace {

// Faces that a worker takes at a time: enough for leaves of one type to come together, and few where
// the mesh has few.
constexpr Far::Index kMaxRange = 128;
constexpr Far::Index kNumRangesWanted = 64;

} // namespace

/// \brief Makes the patches of some faces, and hands them out when they take as much memory as they
/// may.
template <typename REAL>
class PatchStream<REAL>::Worker {
public:
    Worker(PatchStream const &stream, REAL const *meshPoints, PointDescriptor const &meshPointDesc,
           internal::PatchPlans &plans, Sink const &sink, std::size_t maxMemory)
        : _stream(stream), _meshPoints(meshPoints), _meshPointDesc(meshPointDesc), _plans(plans),
          _sink(sink), _maxMemory(maxMemory), _evaluator(meshPointDesc.size) {}

    /// \return  false where the sink ended the stream, or a face has no surface, as status says
    bool Run(Index beginFace, Index endFace, Status *status) {
        SurfaceFactory const &factory = _stream._factory;
        for (Index face = beginFace; face < endFace; ++face) {
            if (factory.GetMesh().GetLevel(0).IsFaceHole(face)) {
                continue;
            }
            _stream.getLevels(face, _levels);
            if (!_plan || _levels != _planLevels) {
                _plan = _plans.Find(_levels);
                _planLevels = _levels;
            }
            std::size_t const size = getSize(*_plan);
            if (_memory > 0 && _memory + size > _maxMemory && !handOut()) {
                return false;
            }
            if (!factory.InitVertexSurface(face, &_surface, status)) {
                return false;
            }
            add(face, size);
        }
        return handOut();
    }

private:
    struct Pending {
        Index face;
        std::shared_ptr<internal::PatchPlan const> plan;
        std::vector<REAL> points;
    };

    std::size_t getSize(internal::PatchPlan const &plan) const {
        return std::size_t(plan.tessellation.GetNumCoords()) * std::size_t(_meshPointDesc.size) *
               sizeof(REAL);
    }

    void add(Index face, std::size_t size) {
        if (_numPending == _pending.size()) {
            _pending.emplace_back();
        }
        Pending &pending = _pending[_numPending++];
        pending.face = face;
        pending.plan = _plan;
        pending.points.resize(size / sizeof(REAL));
        _memory += size;
        auto const pointSize = std::size_t(_meshPointDesc.size);
        _controlPoints.resize(std::size_t(_surface.GetNumControlPoints()) * pointSize);
        PointDescriptor const desc(_meshPointDesc.size);
        _surface.GatherControlPoints(_meshPoints, _meshPointDesc, _controlPoints.data(), desc);
        _surface.evaluateBorder(_plan->tessellation, _controlPoints.data(), desc,
                                pending.points.data(), desc);
        _evaluator.Add(*_surface._type, _plan->cells, _controlPoints.data(), pending.points.data());
    }

    bool handOut() {
        _evaluator.Finish();
        bool isWanted = true;
        for (std::size_t i = 0; i < _numPending && isWanted; ++i) {
            Pending const &pending = _pending[i];
            isWanted = _sink({pending.face, pending.plan->tessellation, pending.points.data(),
                              _meshPointDesc.size});
        }
        _numPending = 0;
        _memory = 0;
        return isWanted;
    }

    PatchStream const &_stream;
    REAL const *const _meshPoints;
    PointDescriptor const _meshPointDesc;
    internal::PatchPlans &_plans;
    Sink const &_sink;
    std::size_t const _maxMemory;
    internal::PatchEvaluator<REAL> _evaluator;
    std::vector<int> _levels;
    std::vector<int> _planLevels;
    std::shared_ptr<internal::PatchPlan const> _plan;
    Surface<REAL> _surface;
    std::vector<REAL> _controlPoints;
    std::vector<Pending> _pending;
    std::size_t _numPending = 0;
    std::size_t _memory = 0;
};

template <typename REAL>
PatchStream<REAL>::PatchStream(SurfaceFactory const &factory, PatchLevels levels,
                               Options const &options)
    : _factory(factory), _levels(std::move(levels)), _options(options),
      _plans(std::make_shared<internal::PatchPlans>(options.GetTessellationOptions(),
                                                    getHalfMemory())) {}

// The levels of the edges, then that of the inside.
template <typename REAL>
void PatchStream<REAL>::getLevels(Index face, std::vector<int> &levels) const {
    levels.clear();
    for (Index const edge : _factory.GetMesh().GetLevel(0).GetFaceEdges(face)) {
        levels.push_back(_levels.GetEdgeLevel(edge));
    }
    levels.push_back(_levels.GetFaceLevel(face));
}

template <typename REAL>
Tessellation PatchStream<REAL>::MakeTessellation(Index face) const {
    std::vector<int> levels;
    getLevels(face, levels);
    return Tessellation(_factory.GetFaceParameterization(face), int(levels.size()), levels.data(),
                        _options.GetTessellationOptions());
}

template <typename REAL>
Status PatchStream<REAL>::check(Index beginFace, Index endFace) const {
    FarExt::TopologyLevel const &base = _factory.GetMesh().GetLevel(0);
    if (beginFace < 0 || endFace < beginFace || endFace > base.GetNumFaces()) {
        return FarExt::internal::Failure(StatusCode::InvalidArgument,
                                         "faces " + std::to_string(beginFace) + " to " +
                                             std::to_string(endFace) + " are no range of the " +
                                             std::to_string(base.GetNumFaces()) + " of the mesh");
    }
    constexpr int kTriangle = 3;
    if (!Tessellation(Parameterization(kTriangle), 0, _options.GetTessellationOptions())
             .IsValid()) {
        return FarExt::internal::Failure(
            StatusCode::InvalidArgument,
            "facets of size " + std::to_string(_options.GetTessellationOptions().GetFacetSize()) +
                " with these strides are none that a tessellation has");
    }
    auto const checkLevel = [](int level, ComponentType type, char const *name, Index index) {
        if (0 <= level && level <= Tessellation::kLastLevel) {
            return Status();
        }
        return Status(StatusCode::InvalidArgument, type, index,
                      std::string(name) + " " + std::to_string(index) + " has level " +
                          std::to_string(level) + ", which is not one of 0 to " +
                          std::to_string(Tessellation::kLastLevel));
    };
    for (Index face = beginFace; face < endFace; ++face) {
        if (base.IsFaceHole(face)) {
            continue;
        }
        Status status;
        if (!_factory.FaceHasLimitSurface(face, &status)) {
            return status;
        }
        status = checkLevel(_levels.GetFaceLevel(face), ComponentType::Face, "face", face);
        for (Index const edge : base.GetFaceEdges(face)) {
            if (status.IsOk()) {
                status = checkLevel(_levels.GetEdgeLevel(edge), ComponentType::Edge, "edge", edge);
            }
        }
        if (!status.IsOk()) {
            return status;
        }
    }
    return Status();
}

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            Index beginFace, Index endFace, Sink const &sink,
                            Status *status) const {
    Status result = check(beginFace, endFace);
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    std::size_t const workerMemory = getHalfMemory() / std::size_t(FarExt::GetNumThreads());
    std::atomic<bool> isEnded(false);
    std::mutex mutex;
    auto const run = [&](std::unique_ptr<Worker> &worker, Index begin, Index end) {
        Status workerStatus;
        if (isEnded || worker->Run(beginFace + begin, beginFace + end, &workerStatus)) {
            return;
        }
        isEnded = true;
        std::lock_guard<std::mutex> const lock(mutex);
        if (result.IsOk()) {
            result = workerStatus;
        }
    };
    Index const numFaces = endFace - beginFace;
    FarExt::internal::ParallelForRange(
        numFaces,
        [&] {
            return std::make_unique<Worker>(*this, meshPoints, meshPointDesc, *_plans, sink,
                                            workerMemory);
        },
        run, std::min(std::max(numFaces / kNumRangesWanted, 1), kMaxRange));
    FarExt::internal::Report(result, status);
    return !isEnded;
}

template class PatchStream<float>;
template class PatchStream<double>;

} // namespace OpenSubdivHex::BfrExt
