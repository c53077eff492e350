// SPDX-License-Identifier: Apache-2.0
#include "patchStream.h"

#include "cell/cellPlan.h"

#include "far_ext/threads.h"
#include "far_ext/vtr/parallel.h"

#include <algorithm>
#include <atomic>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>

namespace OpenSubdivHex::BfrExt {

using FarExt::ComponentType;
using FarExt::Status;
using FarExt::StatusCode;

namespace internal {

/// What plans are made for.
struct PlanOptions {
    Tessellation::Options tessellation;
    bool hasDerivatives;
};

/// \brief What patches with the same levels have in common: their tessellation, with the cells its places
/// lie in.
struct PatchPlan {
    PatchPlan(std::vector<int> const &levels, PlanOptions const &options)
        : tessellation(Parameterization(int(levels.size()) - 1), int(levels.size()), levels.data(),
                       options.tessellation),
          hasDerivatives(options.hasDerivatives) {}

    /// Memory, in bytes.
    std::size_t GetSize() const {
        return kBytesOfPlan + std::size_t(tessellation.GetNumCoords()) * kBytesOfCoord +
               std::size_t(tessellation.GetNumFacetVertices()) * sizeof(int) +
               std::size_t(tessellation.GetNumFacets()) * 2 * sizeof(int) +
               tessellation.getCellPlan().GetSize() +
               (hasDerivatives ? tessellation.getCellPlan(true).GetSize() : 0);
    }

    /// \brief About what it takes in memory to make the plan of some levels, with the plan itself.
    ///
    /// The cells in which the levels of edges take part are counted as if they had that of the inside;
    /// derivatives on an edge follow cells that are there for one or two of its points alone.
    static std::size_t GetSizeOfMaking(std::vector<int> const &levels, bool hasDerivatives) {
        // Bytes for each place, of triangles: of the plan, and of what the tessellation is made of.
        std::size_t const bytes =
            kBytesOfCoord + 8 * sizeof(int) + 2 * sizeof(int) + (hasDerivatives ? 300 : 160);
        std::size_t const bytesOnEdge = bytes + (hasDerivatives ? 700 : 0);
        std::size_t const numCells = (std::size_t(1) << (2 * levels.back())) / 3;
        std::size_t size = kBytesOfPlan + (levels.size() - 1) * (numCells + 2) * bytes;
        for (std::size_t edge = 0; edge + 1 < levels.size(); ++edge) {
            size += ((std::size_t(2) << levels[edge]) / 3 + 1) * bytesOnEdge;
        }
        return size;
    }

    Tessellation const tessellation;
    bool const hasDerivatives;

private:
    // Its place, and its u and v.
    static constexpr std::size_t kBytesOfCoord = sizeof(LeafPlaces::Place) + 2 * sizeof(double);
    // What it has besides arrays of its own, and what the heap keeps of these.
    static constexpr std::size_t kBytesOfPlan = 2048;
};

/// \brief The plans that have been asked for.  Where they come to take too much memory, those that nobody
/// uses are forgotten, beginning with the one that was not asked for longest.  Any number of threads may
/// use it.
class PatchPlans {
public:
    PatchPlans(PlanOptions const &options, std::size_t maxMemory)
        : _options(options), _maxMemory(maxMemory) {}

    std::size_t GetMaxMemory() const { return _maxMemory; }
    /// PatchPlan::GetSizeOfMaking().
    std::size_t GetSizeOfMaking(std::vector<int> const &levels) const {
        return PatchPlan::GetSizeOfMaking(levels, _options.hasDerivatives);
    }

    /// \brief Finds the plan of some levels, or makes it.
    ///
    /// Threads that want a plan wait for it, since it takes memory to make one.
    std::shared_ptr<PatchPlan const> Find(std::vector<int> const &levels) {
        std::lock_guard<std::mutex> const lock(_mutex);
        auto const found = _places.find(levels);
        if (found != _places.end()) {
            _plans.splice(_plans.begin(), _plans, found->second);
            return _plans.front().plan;
        }
        makeRoom(GetSizeOfMaking(levels));
        auto plan = std::make_shared<PatchPlan const>(levels, _options);
        std::size_t const size = plan->GetSize();
        _plans.push_front({levels, std::move(plan), size});
        try {
            _places.emplace(levels, _plans.begin());
        } catch (...) {
            _plans.pop_front();
            throw;
        }
        _memory += size;
        return _plans.front().plan;
    }

    /// Forgets what is too much.
    void Trim() {
        std::lock_guard<std::mutex> const lock(_mutex);
        makeRoom(0);
    }

private:
    struct Entry {
        std::vector<int> levels;
        std::shared_ptr<PatchPlan const> plan;
        std::size_t size;
    };

    // For something of this size, as far as plans are not in use.
    void makeRoom(std::size_t size) {
        for (auto entry = _plans.end(); entry != _plans.begin() && _memory + size > _maxMemory;) {
            --entry;
            // It is given away under the lock alone, so that nobody can begin to use it meanwhile.
            if (entry->plan.use_count() == 1) {
                _memory -= entry->size;
                _places.erase(entry->levels);
                entry = _plans.erase(entry);
            }
        }
    }

    PlanOptions const _options;
    std::size_t const _maxMemory;
    std::size_t _memory = 0;
    std::mutex _mutex;
    std::list<Entry> _plans; // the one that was asked for last comes first
    std::map<std::vector<int>, std::list<Entry>::iterator> _places;
};

/// \brief Adds up what plans take in memory, each counted once, until it is more than there is.  Any
/// number of threads may add to it, each by a Counter of its own.
class PlanMemory {
public:
    explicit PlanMemory(PatchPlans const &plans) : _plans(plans) {}

    /// Whether all plans that were added have room.
    bool HasRoom() const { return _hasRoom; }

    /// Adds the plans that it is told of, and remembers them, so that few have to be looked up together.
    class Counter {
    public:
        explicit Counter(PlanMemory &memory) : _memory(memory) {}

        void Add(std::vector<int> const &levels) {
            if (levels == _last || !_memory.HasRoom()) {
                return;
            }
            _last = levels;
            if (_known.insert(levels).second) {
                _memory.add(levels);
            }
        }

    private:
        PlanMemory &_memory;
        std::vector<int> _last;
        std::set<std::vector<int>> _known;
    };

private:
    void add(std::vector<int> const &levels) {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (_known.insert(levels).second) {
            _memory += _plans.GetSizeOfMaking(levels);
            _hasRoom = _memory <= _plans.GetMaxMemory();
        }
    }

    PatchPlans const &_plans;
    std::size_t _memory = 0;
    std::atomic<bool> _hasRoom{true};
    std::mutex _mutex;
    std::set<std::vector<int>> _known;
};

/// \brief A factory with a cache of its own, made anew when the cache has too many types.  Any number of
/// threads may use it.
class StreamTypes {
public:
    StreamTypes(SurfaceFactory const &factory, std::size_t maxTypes)
        : _mesh(factory.GetMesh()), _maxTypes(maxTypes) {}

    /// The factory to make some surfaces with, which lives as long as it is held.
    std::shared_ptr<SurfaceFactory const> Get() {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (!_generation || _generation->cache.GetNumTypes() > _maxTypes) {
            _generation.reset();
            _generation = std::make_shared<Generation>(_mesh);
        }
        return std::shared_ptr<SurfaceFactory const>(_generation, _generation->factory.get());
    }

private:
    struct Generation {
        explicit Generation(FarExt::TopologyRefiner const &mesh)
            : factory(SurfaceFactory::Create(
                  mesh, SurfaceFactory::Options().SetExternalCache(&cache), nullptr)) {}

        SurfaceFactoryCache cache;
        std::unique_ptr<SurfaceFactory> factory; // of a mesh that has been found to have surfaces
    };

    FarExt::TopologyRefiner const &_mesh;
    std::size_t const _maxTypes;
    std::mutex _mutex;
    std::shared_ptr<Generation> _generation;
};

} // namespace internal

namespace {

// Faces that a worker takes at a time: few where the mesh has few.
constexpr Far::Index kMaxRange = 128;
constexpr Far::Index kNumRangesWanted = 64;

} // namespace

/// \brief Makes the patches of some faces one by one, and hands them out.
template <typename REAL>
class alignas(FarExt::internal::kCacheLine) PatchStream<REAL>::Worker {
public:
    Worker(PatchStream const &stream, REAL const *meshPoints, PointDescriptor const &meshPointDesc,
           std::vector<Values> const &values, Sink const &sink)
        : _stream(stream), _factory(&stream._factory), _meshPoints(meshPoints),
          _meshPointDesc(meshPointDesc), _values(values), _sink(sink), _results(values.size()),
          _resultStarts(values.size()) {}

    /// \brief Makes the patch of a face that is no hole.
    ///
    /// \return  false where the sink ended the stream, or a face has no surface, as status says
    bool Run(Index face, Status *status) {
        if (_stream._types && _numPatches++ % kFacesOfFactory == 0) {
            _surface.Clear();
            _ownFactory.reset();
            _ownFactory = _stream._types->Get();
            _factory = _ownFactory.get();
        }
        Tessellation const &tessellation = findTessellation(face);
        if (!evaluatePoints(face, tessellation, status) ||
            !evaluateValues(face, tessellation, status)) {
            return false;
        }
        bool const hasDerivatives = _stream._options.HasDerivatives();
        return _sink({face, tessellation, _points.data(), _meshPointDesc.size,
                      hasDerivatives ? _du.data() : nullptr, hasDerivatives ? _dv.data() : nullptr,
                      _resultStarts.data()});
    }

private:
    Tessellation const &findTessellation(Index face) {
        if (_stream._forest) {
            _tessellation.reset();
            return _tessellation.emplace(_stream.MakeTessellation(face));
        }
        _stream.getLevels(face, _levels);
        if (!_plan || _levels != _planLevels) {
            _plan.reset();
            _plan = _stream._plans->Find(_levels);
            _planLevels = _levels;
        }
        return _plan->tessellation;
    }

    // Gathers the control points of the surface, without gaps.
    void gather(REAL const *meshPoints, PointDescriptor const &desc) {
        _controlPoints.resize(std::size_t(_surface.GetNumControlPoints()) * std::size_t(desc.size));
        _surface.GatherControlPoints(meshPoints, desc, _controlPoints.data(), desc.size);
    }

    bool evaluatePoints(Index face, Tessellation const &tessellation, Status *status) {
        if (!_factory->InitVertexSurface(face, &_surface, status)) {
            return false;
        }
        PointDescriptor const desc(_meshPointDesc.size);
        std::size_t const size = std::size_t(tessellation.GetNumCoords()) * std::size_t(desc.size);
        gather(_meshPoints, _meshPointDesc);
        _points.resize(size);
        if (_stream._options.HasDerivatives()) {
            _du.resize(size);
            _dv.resize(size);
            _surface.Evaluate(tessellation, _controlPoints.data(), desc, _points.data(), _du.data(),
                              _dv.data(), desc);
        } else {
            _surface.Evaluate(tessellation, _controlPoints.data(), desc, _points.data(), desc);
        }
        return true;
    }

    bool evaluateValues(Index face, Tessellation const &tessellation, Status *status) {
        for (std::size_t i = 0; i < _values.size(); ++i) {
            Values const &values = _values[i];
            bool const isInit =
                values.channel == Values::kVarying
                    ? _factory->InitVaryingSurface(face, &_surface, status)
                    : _factory->InitFaceVaryingSurface(face, &_surface, values.channel, status);
            if (!isInit) {
                return false;
            }
            PointDescriptor const desc(values.desc.size);
            gather(values.values, values.desc);
            std::vector<REAL> &result = _results[i];
            result.resize(std::size_t(tessellation.GetNumCoords()) * std::size_t(desc.size));
            _surface.Evaluate(tessellation, _controlPoints.data(), desc, result.data(), desc);
            _resultStarts[i] = result.data();
        }
        return true;
    }

    // Faces after which the types may be other ones.
    static constexpr std::size_t kFacesOfFactory = 16;

    PatchStream const &_stream;
    std::shared_ptr<SurfaceFactory const> _ownFactory; // while types are not kept
    SurfaceFactory const *_factory;
    REAL const *const _meshPoints;
    PointDescriptor const _meshPointDesc;
    std::vector<Values> const &_values;
    Sink const &_sink;
    std::size_t _numPatches = 0;
    std::optional<Tessellation> _tessellation; // of a tree
    std::vector<int> _levels;
    std::vector<int> _planLevels;
    std::shared_ptr<internal::PatchPlan const> _plan;
    Surface<REAL> _surface;
    std::vector<REAL> _controlPoints;
    std::vector<REAL> _points;
    std::vector<REAL> _du;
    std::vector<REAL> _dv;
    std::vector<std::vector<REAL>> _results; // of values
    std::vector<REAL const *> _resultStarts;
};

template <typename REAL>
PatchStream<REAL>::PatchStream(SurfaceFactory const &factory, PatchLevels levels,
                               Options const &options)
    : _factory(factory), _levels(std::move(levels)), _forest(nullptr), _options(options),
      _plans(makePlans()), _types(makeTypes()) {}

template <typename REAL>
PatchStream<REAL>::PatchStream(SurfaceFactory const &factory, CellForest const &forest,
                               Options const &options)
    : _factory(factory), _levels(0), _forest(&forest), _options(options), _plans(makePlans()),
      _types(makeTypes()) {}

template <typename REAL>
std::shared_ptr<internal::PatchPlans> PatchStream<REAL>::makePlans() const {
    return std::make_shared<internal::PatchPlans>(
        internal::PlanOptions{_options.GetTessellationOptions(), _options.HasDerivatives()},
        _options.GetMaxMemory());
}

// Null where those of the factory are kept.
template <typename REAL>
std::shared_ptr<internal::StreamTypes> PatchStream<REAL>::makeTypes() const {
    return _options.GetMaxTypes() == 0
               ? nullptr
               : std::make_shared<internal::StreamTypes>(_factory, _options.GetMaxTypes());
}

// The levels of the edges, then that of the inside.
template <typename REAL>
void PatchStream<REAL>::getLevels(Index face, std::vector<int> &levels) const {
    levels.clear();
    for (Index const edge : _factory.GetMesh().GetLevel(0).GetFaceEdges(face)) {
        levels.push_back(_levels.GetEdgeLevel(edge));
    }
    levels.push_back(_levels.GetFaceLevel(face));
}

// Takes the next faces that are no holes, of a stream whose plans do not all fit in memory; where not all
// of theirs do, faces with the same levels stand side by side.
template <typename REAL>
Far::Index PatchStream<REAL>::takeFaces(Index beginFace, Index endFace,
                                        std::vector<Index> &faces) const {
    constexpr std::size_t kMinNumFaces = 1024;
    constexpr std::size_t kShareOfMemory = 16;
    struct LevelsOfFace {
        std::size_t hash;
        Index face;
    };
    std::size_t const numFaces =
        std::max(kMinNumFaces, _options.GetMaxMemory() / kShareOfMemory / sizeof(LevelsOfFace));
    std::vector<LevelsOfFace> order;
    std::vector<int> levels;
    std::unordered_set<std::size_t> hashes;
    std::size_t memory = 0;
    for (; beginFace < endFace && order.size() < numFaces; ++beginFace) {
        if (_factory.GetMesh().GetLevel(0).IsFaceHole(beginFace)) {
            continue;
        }
        getLevels(beginFace, levels);
        std::size_t hash = 0;
        for (int const level : levels) {
            hash = (hash ^ std::size_t(level + 1)) * 0x9e3779b97f4a7c15;
            hash ^= hash >> 29;
        }
        order.push_back({hash, beginFace});
        if (memory <= _plans->GetMaxMemory() && hashes.insert(hash).second) {
            memory += _plans->GetSizeOfMaking(levels);
        }
    }
    if (memory > _plans->GetMaxMemory()) {
        std::sort(order.begin(), order.end(), [](LevelsOfFace const &a, LevelsOfFace const &b) {
            return a.hash != b.hash ? a.hash < b.hash : a.face < b.face;
        });
    }
    faces.clear();
    for (LevelsOfFace const &levelsOfFace : order) {
        faces.push_back(levelsOfFace.face);
    }
    return beginFace;
}

template <typename REAL>
Tessellation PatchStream<REAL>::MakeTessellation(Index face) const {
    if (_forest) {
        return _forest->GetTessellation(face, _options.GetTessellationOptions());
    }
    std::vector<int> levels;
    getLevels(face, levels);
    return Tessellation(_factory.GetFaceParameterization(face), int(levels.size()), levels.data(),
                        _options.GetTessellationOptions());
}

// Of several faces that are wrong, the first is told of, whoever finds it.
template <typename REAL>
Status PatchStream<REAL>::check(Index beginFace, Index endFace, bool *arePlansKept) const {
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
    if (_forest && _forest->GetNumFaces() != base.GetNumFaces()) {
        return FarExt::internal::Failure(
            StatusCode::InvalidArgument,
            "the forest has " + std::to_string(_forest->GetNumFaces()) + " trees, the mesh " +
                std::to_string(base.GetNumFaces()) + " faces");
    }
    struct Checker {
        internal::PlanMemory::Counter counter;
        std::vector<int> levels;
    };
    internal::PlanMemory memory(*_plans);
    std::atomic<Index> firstBad(endFace);
    Status result;
    std::mutex mutex;
    auto const check = [&](Checker &checker, Index begin, Index end) {
        for (Index face = beginFace + begin; face < beginFace + end && face < firstBad; ++face) {
            if (base.IsFaceHole(face)) {
                continue;
            }
            Status status = checkFace(face, checker.levels);
            if (!status.IsOk()) {
                std::lock_guard<std::mutex> const lock(mutex);
                if (face < firstBad) {
                    firstBad = face;
                    result = std::move(status);
                }
                return;
            }
            if (!_forest) {
                checker.counter.Add(checker.levels);
            }
        }
    };
    FarExt::internal::ParallelForRange(
        endFace - beginFace,
        [&] {
            return Checker{internal::PlanMemory::Counter(memory), {}};
        },
        check, FarExt::internal::kShortParallelRange);
    if (arePlansKept) {
        *arePlansKept = memory.HasRoom();
    }
    return result;
}

// Of a stream of levels, these are written.
template <typename REAL>
Status PatchStream<REAL>::checkFace(Index face, std::vector<int> &levels) const {
    Status status;
    if (!_factory.FaceHasLimitSurface(face, &status)) {
        return status;
    }
    if (_forest) {
        return checkTree(face);
    }
    getLevels(face, levels);
    return checkLevels(face, levels);
}

template <typename REAL>
Status PatchStream<REAL>::checkTree(Index face) const {
    return _forest->IsMatched(face)
               ? Status()
               : Status(StatusCode::InvalidArgument, ComponentType::Face, face,
                        "the tree of face " + std::to_string(face) +
                            " is not that of such a face, or its edges were not matched");
}

// Whether those of a face and its edges are some that a tessellation has.
template <typename REAL>
Status PatchStream<REAL>::checkLevels(Index face, std::vector<int> const &levels) const {
    auto const isLevel = [](int level) { return 0 <= level && level <= Tessellation::kLastLevel; };
    auto const refuse = [](int level, ComponentType type, char const *name, Index index) {
        return Status(StatusCode::InvalidArgument, type, index,
                      std::string(name) + " " + std::to_string(index) + " has level " +
                          std::to_string(level) + ", which is not one of 0 to " +
                          std::to_string(Tessellation::kLastLevel));
    };
    if (!isLevel(levels.back())) {
        return refuse(levels.back(), ComponentType::Face, "face", face);
    }
    auto const bad = std::find_if_not(levels.begin(), levels.end(), isLevel);
    if (bad == levels.end()) {
        return Status();
    }
    Index const edge = _factory.GetMesh().GetLevel(0).GetFaceEdges(face)[int(bad - levels.begin())];
    return refuse(*bad, ComponentType::Edge, "edge", edge);
}

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            std::vector<Values> const &values, Index beginFace, Index endFace,
                            Sink const &sink, Status *status) const {
    bool arePlansKept = false;
    Status result = check(beginFace, endFace, &arePlansKept);
    for (Values const &further : values) {
        bool const isChannel =
            0 <= further.channel && further.channel < _factory.GetNumFVarChannels();
        if (result.IsOk() && further.channel != Values::kVarying && !isChannel) {
            result = FarExt::internal::Failure(
                StatusCode::InvalidArgument,
                "channel " + std::to_string(further.channel) + " is not one of the " +
                    std::to_string(_factory.GetNumFVarChannels()) + " face-varying channels");
        }
    }
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    std::atomic<bool> isEnded(false);
    std::mutex mutex;
    Index const length = std::min(std::max((endFace - beginFace) / kNumRangesWanted, 1), kMaxRange);
    // Hands out the patches of faces getFace(0) ... getFace(count - 1), where they are no holes.
    auto const run = [&](Index count, auto const &getFace) {
        FarExt::TopologyLevel const &base = _factory.GetMesh().GetLevel(0);
        FarExt::internal::ParallelForRange(
            count,
            [&] {
                return std::make_unique<Worker>(*this, meshPoints, meshPointDesc, values, sink);
            },
            [&](std::unique_ptr<Worker> &worker, Index begin, Index end) {
                Status workerStatus;
                for (Index i = begin; i < end && !isEnded; ++i) {
                    if (base.IsFaceHole(getFace(i)) || worker->Run(getFace(i), &workerStatus)) {
                        continue;
                    }
                    isEnded = true;
                    std::lock_guard<std::mutex> const lock(mutex);
                    if (result.IsOk()) {
                        result = workerStatus;
                    }
                }
            },
            length);
    };
    if (arePlansKept) {
        run(endFace - beginFace, [&](Index i) { return beginFace + i; });
    }
    std::vector<Index> faces;
    while (!arePlansKept && beginFace < endFace && !isEnded) {
        beginFace = takeFaces(beginFace, endFace, faces);
        run(Index(faces.size()), [&](Index i) { return faces[std::size_t(i)]; });
    }
    _plans->Trim();
    FarExt::internal::Report(result, status);
    return !isEnded;
}

template class PatchStream<float>;
template class PatchStream<double>;

} // namespace OpenSubdivHex::BfrExt
