// SPDX-License-Identifier: Apache-2.0
#include "patchStream.h"

#include "cell/faceEvaluator.h"
#include "stream/forestData.h"
#include "stream/patchPlans.h"

#include "far_ext/executor.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_set>

namespace OpenSubdivHex::BfrExt {

using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::StatusCode;

namespace {

// Faces that a worker takes at a time: few where the mesh has few.
constexpr Far::Index kMaxRange = 128;
constexpr Far::Index kNumRangesWanted = 64;

/// \brief The faces that a call asks for: a range, or a list that outlives the object.
class AskedFaces {
public:
    AskedFaces(Far::Index begin, Far::Index end) : _begin(begin), _count(end - begin) {}
    explicit AskedFaces(std::vector<Far::Index> const &list)
        : _list(list.data()), _count(Far::Index(list.size())) {}

    Far::Index GetCount() const { return _count; }
    Far::Index operator[](Far::Index i) const { return _list ? _list[i] : _begin + i; }

private:
    Far::Index const *_list = nullptr; // null: a range
    Far::Index _begin = 0;
    Far::Index _count;
};

} // namespace

/// \brief The data of a stream, with all that it does.
template <typename REAL>
class PatchStream<REAL>::Data {
public:
    /// \param forest  null: levels
    Data(SurfaceFactory const &factory, PatchLevels levels, CellForest const *forest,
         Options const &options)
        : _factory(factory), _levels(std::move(levels)), _forest(forest), _options(options),
          _plans(std::make_unique<internal::PatchPlans>(
              internal::PlanOptions{options.GetTessellationOptions(), options.HasDerivatives()},
              options.GetMaxMemory())) {}

    SurfaceFactory const &GetFactory() const { return _factory; }
    PatchLevels const &GetLevels() const { return _levels; }
    CellForest const *GetForest() const { return _forest; }
    Options const &GetOptions() const { return _options; }

    bool Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
             std::vector<Values> const &values, AskedFaces const &faces, Sink const &sink,
             CallStatus *status) const;
    CallStatus CheckRange(Index beginFace, Index endFace) const;
    CallStatus CheckList(std::vector<Index> const &faces) const;
    bool RunTessellations(TessellationSink const &sink, CallStatus *status) const;
    int GetNumSections(Index face) const;
    LevelTessellation MakeTessellation(Index face) const;
    LevelTessellation MakeTessellation(Index face, int section) const;
    SectionPolygons GetSectionPolygons(Index face) const;

private:
    class TessellationFinder;
    class Worker;
    struct Batch;

    CallStatus checkFaces(AskedFaces const &faces, bool *arePlansKept) const;
    CallStatus checkFace(Index face, internal::FaceLevels &levels) const;
    CallStatus checkLevels(Index face, internal::FaceLevels const &levels) const;
    CallStatus checkTree(Index face) const;
    void getLevels(Index face, internal::FaceLevels &levels) const;
    bool isCut(Index face, internal::FaceLevels const &levels) const;
    std::unique_ptr<internal::FaceSections const> makeSections(Index face) const;
    Index takeFaces(AskedFaces const &faces, Index next, Batch &batch) const;
    template <typename MAKE>
    bool runWorkers(AskedFaces const &faces, bool arePlansKept, MAKE const &makeWorker,
                    CallStatus &status) const;

    SurfaceFactory const &_factory;
    PatchLevels const _levels;
    CellForest const *const _forest; // null: levels
    Options const _options;
    std::unique_ptr<internal::PatchPlans> const _plans;
};

/// \brief Finds the tessellations of patches, or makes them: each is there until the next one is asked for.
template <typename REAL>
class PatchStream<REAL>::Data::TessellationFinder {
public:
    explicit TessellationFinder(Data const &stream) : _stream(stream) {}

    /// \param section  -1: of the face as a whole
    LevelTessellation const &Find(Index face, int section) {
        return section < 0 ? find(face) : find(face, section);
    }

private:
    LevelTessellation const &find(Index face) {
        if (_stream._forest) {
            return findTree(face);
        }
        _stream.getLevels(face, _levels);
        if (!_plan || _levels != _planLevels) {
            _plan.reset();
            _plan = _stream._plans->Find(_levels);
            _planLevels = _levels;
        }
        return _plan->tessellation;
    }

    LevelTessellation const &findTree(Index face) {
        auto const make = [&] { return _stream.MakeTessellation(face); };
        if (!internal::PatchPlans::IsShared(_stream._forest->GetTree(face))) {
            _tessellation.reset();
            return _tessellation.emplace(make());
        }
        _stream._forest->GetData().GetKey(face, _treeKey);
        if (!_plan || _treeKey != _planKey) {
            _plan.reset();
            _plan = _stream._plans->Find(_treeKey, make);
            _planKey = _treeKey;
        }
        return _plan->tessellation;
    }

    LevelTessellation const &find(Index face, int section) {
        _tessellation.reset();
        _plan.reset();
        _stream.getLevels(face, _levels);
        if (_stream._forest ? _sectionsFace != face
                            : !_sections || _sections->GetLevels() != _levels.levels ||
                                  _sections->GetFaceShape() != _levels.shape) {
            _sections.reset();
            _sections = _stream.makeSections(face);
            _sectionsFace = face;
        }
        if (_stream._forest) {
            return _tessellation.emplace(
                LevelTessellation(*_sections, section, _stream._options.GetTessellationOptions()));
        }
        _plan = _stream._plans->Find(*_sections, section);
        _planLevels = {};
        return _plan->tessellation;
    }

    Data const &_stream;
    std::optional<LevelTessellation> _tessellation; // of a tree
    internal::FaceLevels _levels;
    internal::FaceLevels _planLevels;
    std::vector<int> _treeKey; // what tells a tree
    std::vector<int> _planKey;
    std::shared_ptr<internal::PatchPlan const> _plan;
    std::unique_ptr<internal::FaceSections const> _sections; // of the last face that came in some
    Index _sectionsFace = Far::INDEX_INVALID;
};

/// \brief Makes the patches of some faces one by one, and hands them out.
template <typename REAL>
class alignas(FarExt::internal::kCacheLine) PatchStream<REAL>::Data::Worker {
public:
    Worker(Data const &stream, REAL const *meshPoints, PointDescriptor const &meshPointDesc,
           std::vector<Values> const &values, Sink const &sink)
        : _stream(stream), _finder(stream), _factory(stream._factory), _meshPoints(meshPoints),
          _meshPointDesc(meshPointDesc), _values(values), _sink(sink), _results(values.size()),
          _resultStarts(values.size()) {}

    /// \brief Makes the patch of a face that is no hole, or of one of its sections.
    ///
    /// \param section  -1: of the face as a whole
    /// \return  false where the sink ended the stream, or a face has no surface, as status says
    bool Run(Index face, int section, CallStatus &status) {
        LevelTessellation const &tessellation = _finder.Find(face, section);
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
    // Makes the surface of a face, and evaluates it at all places of the tessellation; results: as of FaceEvaluator.
    bool evaluate(Index face, FarExt::Interpolation interpolation, int channel,
                  LevelTessellation const &tessellation, REAL const *points,
                  PointDescriptor const &desc, internal::SharedRings<REAL> &shared,
                  REAL *const (&results)[6], CallStatus &status) {
        status = _factory.TryInit(face, interpolation, channel, _surface);
        if (status.IsOk()) {
            internal::FaceEvaluator<REAL>(_surface.GetFace(), points, desc, &shared)
                .Evaluate(tessellation.GetData(), results, PointDescriptor(desc.size));
        }
        return status.IsOk();
    }

    bool evaluatePoints(Index face, LevelTessellation const &tessellation, CallStatus &status) {
        std::size_t const size =
            std::size_t(tessellation.GetNumCoords()) * std::size_t(_meshPointDesc.size);
        _points.resize(size);
        REAL *results[6] = {_points.data()};
        if (_stream._options.HasDerivatives()) {
            _du.resize(size);
            _dv.resize(size);
            results[1] = _du.data();
            results[2] = _dv.data();
        }
        return evaluate(face, FarExt::Interpolation::Vertex, -1, tessellation, _meshPoints,
                        _meshPointDesc, _shared, results, status);
    }

    bool evaluateValues(Index face, LevelTessellation const &tessellation, CallStatus &status) {
        for (std::size_t i = 0; i < _values.size(); ++i) {
            Values const &values = _values[i];
            FarExt::Interpolation const interpolation =
                values.channel == Values::kVarying
                    ? FarExt::Interpolation::Varying
                    : FarExt::internal::GetChannelInterpolation(_factory.GetMesh(), values.channel);
            std::vector<REAL> &result = _results[i].numbers;
            result.resize(std::size_t(tessellation.GetNumCoords()) * std::size_t(values.desc.size));
            REAL *const results[6] = {result.data()};
            if (!evaluate(face, interpolation, values.channel, tessellation, values.values,
                          values.desc, _results[i].shared, results, status)) {
                return false;
            }
            _resultStarts[i] = result.data();
        }
        return true;
    }

    struct Results {
        std::vector<REAL> numbers;
        internal::SharedRings<REAL> shared;
    };

    Data const &_stream;
    TessellationFinder _finder;
    SurfaceFactory const &_factory;
    REAL const *const _meshPoints;
    PointDescriptor const _meshPointDesc;
    std::vector<Values> const &_values;
    Sink const &_sink;
    Surface<REAL> _surface;
    internal::SharedRings<REAL> _shared;
    std::vector<REAL> _points;
    std::vector<REAL> _du;
    std::vector<REAL> _dv;
    std::vector<Results> _results; // of values
    std::vector<REAL const *> _resultStarts;
};

// The levels of the edges, then that of the inside; none of a forest.
template <typename REAL>
void PatchStream<REAL>::Data::getLevels(Index face, internal::FaceLevels &levels) const {
    levels.levels.clear();
    if (_forest) {
        return;
    }
    FarExt::SurfaceFaces const &faces = _factory.GetFaces();
    levels.shape = faces.GetShape(face);
    for (int local = 0; local < levels.shape.size; ++local) {
        levels.levels.push_back(_levels.GetEdgeLevel(faces.GetEdge(face, local).edge));
    }
    levels.levels.push_back(_levels.GetFaceLevel(face));
}

// Whether a face comes in sections.
template <typename REAL>
bool PatchStream<REAL>::Data::isCut(Index face, internal::FaceLevels const &levels) const {
    return _forest ? _plans->IsCut(_forest->GetTree(face)) : _plans->IsCut(levels);
}

// The sections of a face that is cut.
template <typename REAL>
std::unique_ptr<internal::FaceSections const>
PatchStream<REAL>::Data::makeSections(Index face) const {
    using internal::FaceSections;
    int const maxLeaves = _plans->GetMaxLeaves();
    if (_forest) {
        return std::make_unique<FaceSections const>(_forest->GetTree(face),
                                                    _forest->GetFacePolylines(face), maxLeaves);
    }
    internal::FaceLevels levels;
    getLevels(face, levels);
    return std::make_unique<FaceSections const>(levels, maxLeaves);
}

/// \brief Some faces that are no holes, and what patches they have: those of faces in sections stand section
/// by section, so that faces with the same levels have each of them side by side.
template <typename REAL>
struct PatchStream<REAL>::Data::Batch {
    /// Faces that follow one another, whole or with the same sections.
    struct Group {
        std::size_t firstFace;
        std::size_t numFaces;
        int numSections; ///< 0: whole
        Index firstPatch;
    };
    struct PatchOfFace {
        Index face;
        int section; ///< -1: whole
    };

    void Add(Index face, int numSections, bool isOfLastGroup) {
        if (!isOfLastGroup) {
            groups.push_back({faces.size(), 0, numSections, numPatches});
        }
        faces.push_back(face);
        ++groups.back().numFaces;
        numPatches += std::max(numSections, 1);
    }

    PatchOfFace Get(Index patch) const {
        auto const group = std::upper_bound(groups.begin(), groups.end(), patch,
                                            [](Index number, Group const &other) {
                                                return number < other.firstPatch;
                                            }) -
                           1;
        auto const place = std::size_t(patch - group->firstPatch);
        return {faces[group->firstFace + place % group->numFaces],
                group->numSections == 0 ? -1 : int(place / group->numFaces)};
    }

    std::vector<Index> faces;
    std::vector<Group> groups;
    Index numPatches = 0;
};

// Takes faces from number next on that are no holes, of a stream whose plans do not all fit in memory; where not all
// of theirs do, faces with the same levels stand side by side.
template <typename REAL>
Far::Index PatchStream<REAL>::Data::takeFaces(AskedFaces const &faces, Index next,
                                              Batch &batch) const {
    constexpr std::size_t kMinNumFaces = 1024;
    constexpr std::size_t kShareOfMemory = 16;
    constexpr double kMaxLeaves = 1 << 30;
    struct LevelsOfFace {
        std::size_t hash;
        Index face;
    };
    std::size_t const numFaces =
        std::max(kMinNumFaces, _options.GetMaxMemory() / kShareOfMemory / sizeof(LevelsOfFace));
    std::vector<LevelsOfFace> order;
    internal::FaceLevels levels;
    std::unordered_set<std::size_t> hashes;
    std::size_t memory = 0;
    double numLeaves = 0; // at least as many as patches
    for (; next < faces.GetCount() && order.size() < numFaces && numLeaves < kMaxLeaves; ++next) {
        Index const face = faces[next];
        if (_factory.GetFaces().IsHole(face)) {
            continue;
        }
        if (_forest) {
            order.push_back({0, face});
            numLeaves += _forest->GetTree(face).GetNumLeaves();
            continue;
        }
        getLevels(face, levels);
        numLeaves += internal::FaceSections::CountLeaves(levels);
        std::size_t hash = levels.shape.isHalf ? 1 : 0;
        for (int const level : levels.levels) {
            hash = (hash ^ std::size_t(level + 1)) * 0x9e3779b97f4a7c15;
            hash ^= hash >> 29;
        }
        order.push_back({hash, face});
        if (memory <= _plans->GetMaxMemory() && hashes.insert(hash).second) {
            memory += _plans->GetSizeOfMaking(levels);
        }
    }
    if (memory > _plans->GetMaxMemory()) {
        std::sort(order.begin(), order.end(), [](LevelsOfFace const &a, LevelsOfFace const &b) {
            return a.hash != b.hash ? a.hash < b.hash : a.face < b.face;
        });
    }
    batch = {};
    internal::FaceLevels lastLevels;
    bool isLastCut = false;
    int numSections = 0;
    for (LevelsOfFace const &levelsOfFace : order) {
        getLevels(levelsOfFace.face, levels);
        bool isOfLastGroup = !_forest && !batch.groups.empty() && levels == lastLevels;
        if (!isOfLastGroup) {
            bool const isFaceCut = isCut(levelsOfFace.face, levels);
            isOfLastGroup = !batch.groups.empty() && !isFaceCut && !isLastCut;
            numSections = isFaceCut ? makeSections(levelsOfFace.face)->GetNumSections() : 0;
            isLastCut = isFaceCut;
            lastLevels = levels;
        }
        batch.Add(levelsOfFace.face, numSections, isOfLastGroup);
    }
    return next;
}

template <typename REAL>
int PatchStream<REAL>::Data::GetNumSections(Index face) const {
    internal::FaceLevels levels;
    getLevels(face, levels);
    return isCut(face, levels) ? makeSections(face)->GetNumSections() : 1;
}

template <typename REAL>
LevelTessellation PatchStream<REAL>::Data::MakeTessellation(Index face, int section) const {
    internal::FaceLevels levels;
    getLevels(face, levels);
    return isCut(face, levels)
               ? LevelTessellation(*makeSections(face), section, _options.GetTessellationOptions())
               : MakeTessellation(face);
}

template <typename REAL>
LevelTessellation PatchStream<REAL>::Data::MakeTessellation(Index face) const {
    if (_forest) {
        return _forest->GetTessellation(face, _options.GetTessellationOptions());
    }
    internal::FaceLevels levels;
    getLevels(face, levels);
    return LevelTessellation(_factory.GetFaceParameterization(face), int(levels.levels.size()),
                             levels.levels.data(), _options.GetTessellationOptions());
}

template <typename REAL>
CallStatus PatchStream<REAL>::Data::CheckRange(Index beginFace, Index endFace) const {
    int const numFaces = _factory.GetNumFaces();
    return 0 <= beginFace && beginFace <= endFace && endFace <= numFaces
               ? CallStatus()
               : FarExt::internal::Failure(StatusCode::InvalidArgument,
                                           "faces " + std::to_string(beginFace) + " to " +
                                               std::to_string(endFace) + " are no range of the " +
                                               std::to_string(numFaces) + " of the mesh");
}

template <typename REAL>
CallStatus PatchStream<REAL>::Data::CheckList(std::vector<Index> const &faces) const {
    int const numFaces = _factory.GetNumFaces();
    auto const bad = std::find_if(faces.begin(), faces.end(),
                                  [&](Index face) { return face < 0 || face >= numFaces; });
    return bad == faces.end() ? CallStatus()
                              : CallStatus(StatusCode::InvalidArgument, ComponentType::Face, *bad,
                                           "face " + std::to_string(*bad) + " is none of the " +
                                               std::to_string(numFaces) + " of the mesh");
}

// The status names the first wrong face, whichever thread finds it.
template <typename REAL>
CallStatus PatchStream<REAL>::Data::checkFaces(AskedFaces const &faces, bool *arePlansKept) const {
    FarExt::SurfaceFaces const &base = _factory.GetFaces();
    constexpr int kTriangle = 3;
    if (!LevelTessellation(Parameterization(kTriangle), 0, _options.GetTessellationOptions())
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
    if (_forest && &_forest->GetData().faces.GetLevel() != &base.GetLevel()) {
        return FarExt::internal::Failure(StatusCode::InvalidArgument,
                                         "the forest is that of another refiner");
    }
    struct Checker {
        internal::PlanMemory::Counter counter;
        internal::FaceLevels levels;
    };
    internal::PlanMemory memory(*_plans);
    std::atomic<Index> firstBad(faces.GetCount());
    CallStatus result;
    std::mutex mutex;
    auto const check = [&](Checker &checker, Index begin, Index end) {
        for (Index i = begin; i < end && i < firstBad; ++i) {
            Index const face = faces[i];
            if (base.IsHole(face)) {
                continue;
            }
            CallStatus status = checkFace(face, checker.levels);
            if (!status.IsOk()) {
                std::lock_guard<std::mutex> const lock(mutex);
                if (i < firstBad) {
                    firstBad = i;
                    result = std::move(status);
                }
                return;
            }
            if (!_forest) {
                checker.counter.Add(checker.levels);
            } else if (_plans->IsCut(_forest->GetTree(face))) {
                memory.SetCut();
            }
        }
    };
    FarExt::internal::ParallelForRange(
        faces.GetCount(),
        [&] {
            return Checker{internal::PlanMemory::Counter(memory), {}};
        },
        check, FarExt::internal::kShortParallelRange);
    *arePlansKept = memory.HasRoom();
    return result;
}

// Writes the levels, in a stream of levels.
template <typename REAL>
CallStatus PatchStream<REAL>::Data::checkFace(Index face, internal::FaceLevels &levels) const {
    CallStatus status = _factory.CheckFace(face);
    if (!status.IsOk()) {
        return status;
    }
    if (_forest) {
        return checkTree(face);
    }
    getLevels(face, levels);
    return checkLevels(face, levels);
}

template <typename REAL>
CallStatus PatchStream<REAL>::Data::checkTree(Index face) const {
    return _forest->IsMatched(face)
               ? CallStatus()
               : CallStatus(StatusCode::InvalidArgument, ComponentType::Face, face,
                            "the tree of face " + std::to_string(face) +
                                " is not that of such a face, or its edges were not matched");
}

// Whether those of a face and its edges are some that a tessellation has.
template <typename REAL>
CallStatus PatchStream<REAL>::Data::checkLevels(Index face,
                                                internal::FaceLevels const &faceLevels) const {
    std::vector<int> const &levels = faceLevels.levels;
    auto const isLevel = [](int level) {
        return 0 <= level && level <= LevelTessellation::kLastLevel;
    };
    auto const refuse = [](int level, ComponentType type, char const *name, Index index) {
        return CallStatus(StatusCode::InvalidArgument, type, index,
                          std::string(name) + " " + std::to_string(index) + " has level " +
                              std::to_string(level) + ", which is not one of 0 to " +
                              std::to_string(LevelTessellation::kLastLevel));
    };
    if (!isLevel(levels.back())) {
        return refuse(levels.back(), ComponentType::Face, "face", face);
    }
    auto const bad = std::find_if_not(levels.begin(), levels.end(), isLevel);
    if (bad == levels.end()) {
        return CallStatus();
    }
    Index const edge = _factory.GetFaces().GetEdge(face, int(bad - levels.begin())).edge;
    return refuse(*bad, ComponentType::Edge, "edge", edge);
}

// Has workers, each of which makeWorker() gives, make the patches of faces; false where one gave false.
template <typename REAL>
template <typename MAKE>
bool PatchStream<REAL>::Data::runWorkers(AskedFaces const &faces, bool arePlansKept,
                                         MAKE const &makeWorker, CallStatus &status) const {
    std::atomic<bool> isEnded(false);
    std::mutex mutex;
    Index const length = std::min(std::max(faces.GetCount() / kNumRangesWanted, 1), kMaxRange);
    // Hands out patches getPatch(0) ... getPatch(count - 1), where their faces are no holes.
    auto const run = [&](Index count, auto const &getPatch) {
        using PatchOfFace = typename Batch::PatchOfFace;
        FarExt::SurfaceFaces const &base = _factory.GetFaces();
        FarExt::internal::ParallelForRange(
            count, makeWorker,
            [&](auto &worker, Index begin, Index end) {
                CallStatus workerStatus;
                for (Index i = begin; i < end && !isEnded; ++i) {
                    PatchOfFace const patch = getPatch(i);
                    if (base.IsHole(patch.face) ||
                        worker->Run(patch.face, patch.section, workerStatus)) {
                        continue;
                    }
                    isEnded = true;
                    std::lock_guard<std::mutex> const lock(mutex);
                    if (status.IsOk()) {
                        status = workerStatus;
                    }
                }
            },
            length);
    };
    if (arePlansKept) {
        run(faces.GetCount(), [&](Index i) { return typename Batch::PatchOfFace{faces[i], -1}; });
    }
    Batch batch;
    for (Index next = 0; !arePlansKept && next < faces.GetCount() && !isEnded;) {
        next = takeFaces(faces, next, batch);
        run(batch.numPatches, [&](Index i) { return batch.Get(i); });
    }
    _plans->Trim();
    return !isEnded;
}

template <typename REAL>
bool PatchStream<REAL>::Data::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                                  std::vector<Values> const &values, AskedFaces const &faces,
                                  Sink const &sink, CallStatus *status) const {
    bool arePlansKept = false;
    CallStatus result = checkFaces(faces, &arePlansKept);
    for (Values const &further : values) {
        if (result.IsOk() && further.channel != Values::kVarying) {
            result = FarExt::internal::CheckChannel(further.channel, _factory.GetNumFVarChannels());
        }
    }
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    bool const isDone = runWorkers(
        faces, arePlansKept,
        [&] { return std::make_unique<Worker>(*this, meshPoints, meshPointDesc, values, sink); },
        result);
    FarExt::internal::Report(result, status);
    return isDone;
}

template <typename REAL>
bool PatchStream<REAL>::Data::RunTessellations(TessellationSink const &sink,
                                               CallStatus *status) const {
    AskedFaces const faces(0, _factory.GetNumFaces());
    bool arePlansKept = false;
    CallStatus result = checkFaces(faces, &arePlansKept);
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    struct alignas(FarExt::internal::kCacheLine) Finder {
        bool Run(Index face, int section, CallStatus & /*status*/) {
            return sink(face, finder.Find(face, section));
        }

        TessellationFinder finder;
        TessellationSink const &sink;
    };
    return runWorkers(
        faces, arePlansKept,
        [&] {
            return std::unique_ptr<Finder>(new Finder{TessellationFinder(*this), sink});
        },
        result);
}

template <typename REAL>
auto PatchStream<REAL>::Data::GetSectionPolygons(Index face) const -> SectionPolygons {
    SectionPolygons result;
    internal::FaceLevels levels;
    getLevels(face, levels);
    if (!isCut(face, levels)) {
        return result;
    }
    std::unique_ptr<internal::FaceSections const> const sections = makeSections(face);
    for (int section = 0; section < sections->GetNumSections(); ++section) {
        std::vector<int> const polygon = sections->GetPolygon(section);
        result.firstCorners.push_back(int(result.vertices.size()));
        result.vertices.insert(result.vertices.end(), polygon.begin(), polygon.end());
    }
    result.firstCorners.push_back(int(result.vertices.size()));
    for (internal::CellMesh::Vertex const &vert : sections->GetVertices()) {
        internal::EdgePlace<int> const place = sections->FindEdge(vert);
        result.edges.push_back(place.edge);
        result.edgePoints.push_back(
            place.edge < 0 || place.end == 0 ? -1 : sections->CountPointsBefore(place));
    }
    return result;
}

template <typename REAL>
PatchStream<REAL>::PatchStream(SurfaceFactory const &factory, PatchLevels levels,
                               Options const &options)
    : _data(std::make_shared<Data const>(factory, std::move(levels), nullptr, options)) {}

template <typename REAL>
PatchStream<REAL>::PatchStream(SurfaceFactory const &factory, CellForest const &forest,
                               Options const &options)
    : _data(std::make_shared<Data const>(factory, PatchLevels(0), &forest, options)) {}

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            std::vector<Values> const &values, Index beginFace, Index endFace,
                            Sink const &sink, CallStatus *status) const {
    CallStatus const result = _data->CheckRange(beginFace, endFace);
    return result.IsOk() ? _data->Run(meshPoints, meshPointDesc, values,
                                      AskedFaces(beginFace, endFace), sink, status)
                         : FarExt::internal::Report(result, status);
}

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            std::vector<Values> const &values, std::vector<Index> const &faces,
                            Sink const &sink, CallStatus *status) const {
    CallStatus const result = _data->CheckList(faces);
    return result.IsOk()
               ? _data->Run(meshPoints, meshPointDesc, values, AskedFaces(faces), sink, status)
               : FarExt::internal::Report(result, status);
}

template <typename REAL>
bool PatchStream<REAL>::RunTessellations(TessellationSink const &sink, CallStatus *status) const {
    return _data->RunTessellations(sink, status);
}

template <typename REAL>
int PatchStream<REAL>::GetNumSections(Index face) const {
    return _data->GetNumSections(face);
}

template <typename REAL>
LevelTessellation PatchStream<REAL>::MakeTessellation(Index face) const {
    return _data->MakeTessellation(face);
}

template <typename REAL>
LevelTessellation PatchStream<REAL>::MakeTessellation(Index face, int section) const {
    return _data->MakeTessellation(face, section);
}

template <typename REAL>
auto PatchStream<REAL>::GetSectionPolygons(Index face) const -> SectionPolygons {
    return _data->GetSectionPolygons(face);
}

template <typename REAL>
SurfaceFactory const &PatchStream<REAL>::GetFactory() const {
    return _data->GetFactory();
}

template <typename REAL>
PatchLevels const &PatchStream<REAL>::GetLevels() const {
    return _data->GetLevels();
}

template <typename REAL>
CellForest const *PatchStream<REAL>::GetForest() const {
    return _data->GetForest();
}

template <typename REAL>
auto PatchStream<REAL>::GetOptions() const -> Options const & {
    return _data->GetOptions();
}

template class PatchStream<float>;
template class PatchStream<double>;

} // namespace OpenSubdivHex::BfrExt
