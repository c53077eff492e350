// SPDX-License-Identifier: Apache-2.0
#include "patchStream.h"

#include "cell/faceEvaluator.h"
#include "cell/patchPlans.h"

#include "far_ext/executor.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/hash.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
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

/// The data of a stream, with all that does not depend on the precision of points.
class internal::StreamData {
public:
    using Index = Far::Index;
    using Options = PatchTessellations::Options;

    StreamData(SurfaceFactory const &ofMesh, PatchLevels ofFaces, CellForest const *ofTrees,
               Options const &ofStream)
        : factory(ofMesh), levels(std::move(ofFaces)), forest(ofTrees), options(ofStream),
          plans(options.GetTessellationOptions(), options.HasDerivatives(),
                options.GetMaxMemory()) {}

    void GetLevels(Index face, FaceLevels &result) const;
    LevelTessellation MakeWhole(Index face) const;
    std::unique_ptr<FaceSections const> MakeSections(Index face) const;
    template <typename MAKE>
    bool Run(AskedFaces const &faces, MAKE const &makeWorker, CallStatus *status) const;

    SurfaceFactory const &factory;
    PatchLevels const levels;
    CellForest const *const forest; ///< null: levels
    Options const options;
    PatchPlans mutable plans;

private:
    struct Batch;

    CallStatus checkFaces(AskedFaces const &faces, bool &arePlansKept) const;
    CallStatus checkFace(Index face, FaceLevels &ofFace) const;
    Index takeFaces(AskedFaces const &faces, Index next, Batch &batch) const;
    template <typename MAKE>
    bool runWorkers(AskedFaces const &faces, bool arePlansKept, MAKE const &makeWorker,
                    CallStatus &status) const;
};

namespace internal {

// Writes the levels of the edges, then that of the inside; none of a forest.
void StreamData::GetLevels(Index face, FaceLevels &result) const {
    result.levels.clear();
    if (forest) {
        return;
    }
    FarExt::SurfaceFaces const &faces = factory.GetFaces();
    result.shape = faces.GetShape(face);
    for (int local = 0; local < result.shape.size; ++local) {
        result.levels.push_back(levels.GetEdgeLevel(faces.GetEdge(face, local).edge));
    }
    result.levels.push_back(levels.GetFaceLevel(face));
}

LevelTessellation StreamData::MakeWhole(Index face) const {
    if (forest) {
        return forest->GetTessellation(face, options.GetTessellationOptions());
    }
    FaceLevels ofFace;
    GetLevels(face, ofFace);
    return LevelTessellation(Parameterization(ofFace.shape), int(ofFace.levels.size()),
                             ofFace.levels.data(), options.GetTessellationOptions());
}

// The sections of a face that comes in some; null for others.
std::unique_ptr<FaceSections const> StreamData::MakeSections(Index face) const {
    int const maxLeaves = plans.GetMaxLeaves();
    if (forest) {
        CellTree const &tree = forest->GetTree(face);
        return plans.IsCut(tree) ? std::make_unique<FaceSections const>(
                                       tree, forest->GetFacePolylines(face), maxLeaves)
                                 : nullptr;
    }
    FaceLevels ofFace;
    GetLevels(face, ofFace);
    return plans.IsCut(ofFace) ? std::make_unique<FaceSections const>(ofFace, maxLeaves) : nullptr;
}

/// \brief Some faces that are no holes, and what patches they have: those of faces in sections stand section
/// by section, so that faces with the same levels have each of them side by side.
struct StreamData::Batch {
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
Far::Index StreamData::takeFaces(AskedFaces const &faces, Index next, Batch &batch) const {
    constexpr std::size_t kMinNumFaces = 1024;
    constexpr std::size_t kShareOfMemory = 16;
    constexpr double kMaxLeaves = 1 << 30;
    struct LevelsOfFace {
        std::size_t hash;
        Index face;
    };
    std::size_t const numFaces =
        std::max(kMinNumFaces, options.GetMaxMemory() / kShareOfMemory / sizeof(LevelsOfFace));
    std::vector<LevelsOfFace> order;
    FaceLevels ofFace;
    std::unordered_set<std::size_t> hashes;
    std::size_t memory = 0;
    double numLeaves = 0; // at least as many as patches
    for (; next < faces.GetCount() && order.size() < numFaces && numLeaves < kMaxLeaves; ++next) {
        Index const face = faces[next];
        if (factory.GetFaces().IsHole(face)) {
            continue;
        }
        if (forest) {
            order.push_back({0, face});
            numLeaves += forest->GetTree(face).GetNumLeaves();
            continue;
        }
        GetLevels(face, ofFace);
        numLeaves += FaceSections::CountLeaves(ofFace.shape, ofFace.levels.back());
        std::size_t hash = ofFace.shape.isHalf ? 1 : 0;
        for (int const level : ofFace.levels) {
            hash = FarExt::internal::AddToHash(hash, 1 + std::uint64_t(level));
        }
        order.push_back({hash, face});
        if (memory <= plans.GetMaxMemory() && hashes.insert(hash).second) {
            memory += plans.GetSizeOfMaking(ofFace);
        }
    }
    if (memory > plans.GetMaxMemory()) {
        std::sort(order.begin(), order.end(), [](LevelsOfFace const &a, LevelsOfFace const &b) {
            return a.hash != b.hash ? a.hash < b.hash : a.face < b.face;
        });
    }
    batch = {};
    FaceLevels lastLevels;
    bool isLastCut = false;
    int numSections = 0;
    for (LevelsOfFace const &levelsOfFace : order) {
        GetLevels(levelsOfFace.face, ofFace);
        bool isOfLastGroup = !forest && !batch.groups.empty() && ofFace == lastLevels;
        if (!isOfLastGroup) {
            std::unique_ptr<FaceSections const> const sections = MakeSections(levelsOfFace.face);
            isOfLastGroup = !batch.groups.empty() && !sections && !isLastCut;
            numSections = sections ? sections->GetNumSections() : 0;
            isLastCut = sections != nullptr;
            lastLevels = ofFace;
        }
        batch.Add(levelsOfFace.face, numSections, isOfLastGroup);
    }
    return next;
}

// The status names the first wrong face, whichever thread finds it.
CallStatus StreamData::checkFaces(AskedFaces const &faces, bool &arePlansKept) const {
    FarExt::SurfaceFaces const &base = factory.GetFaces();
    constexpr int kTriangle = 3;
    if (!LevelTessellation(Parameterization(kTriangle), 0, options.GetTessellationOptions())
             .IsValid()) {
        return FarExt::internal::Failure(
            StatusCode::InvalidArgument,
            "facets of size " + std::to_string(options.GetTessellationOptions().GetFacetSize()) +
                " with these strides are none that a tessellation has");
    }
    if (forest && forest->GetNumFaces() != base.GetNumFaces()) {
        return FarExt::internal::Failure(StatusCode::InvalidArgument,
                                         "the forest has " + std::to_string(forest->GetNumFaces()) +
                                             " trees, the mesh " +
                                             std::to_string(base.GetNumFaces()) + " faces");
    }
    if (forest && &forest->GetFaces().GetLevel() != &base.GetLevel()) {
        return FarExt::internal::Failure(StatusCode::InvalidArgument,
                                         "the forest is that of another refiner");
    }
    // Threads have sizes of plans by key, which come together when they end.
    using Sizes = std::map<std::vector<int>, std::size_t>;
    std::mutex mutex;
    Sizes sizes;
    struct Checker {
        ~Checker() {
            std::lock_guard<std::mutex> const lock(mutexOfAll);
            ofAll.merge(own);
        }

        std::mutex &mutexOfAll;
        Sizes &ofAll;
        Sizes own = {};
        std::size_t memory = 0;
        FaceLevels ofFace = {};
        FaceLevels last = {};
    };
    std::atomic<bool> hasRoom(true);
    std::atomic<Index> firstBad(faces.GetCount());
    CallStatus result;
    // Whether the plans of a thread have room, with that of the face.
    auto const haveRoom = [&](Checker &checker, Index face) {
        if (forest) {
            return !plans.IsCut(forest->GetTree(face));
        }
        if (checker.ofFace != checker.last) {
            checker.last = checker.ofFace;
            auto const [size, isNew] = checker.own.emplace(checker.ofFace.GetKey(), 0);
            if (isNew) {
                size->second = plans.GetSizeOfMaking(checker.ofFace);
                checker.memory += size->second;
                return checker.memory <= plans.GetMaxMemory() && !plans.IsCut(checker.ofFace);
            }
        }
        return true;
    };
    auto const check = [&](Checker &checker, Index begin, Index end) {
        for (Index i = begin; i < end && i < firstBad; ++i) {
            Index const face = faces[i];
            if (base.IsHole(face)) {
                continue;
            }
            CallStatus status = checkFace(face, checker.ofFace);
            if (!status.IsOk()) {
                std::lock_guard<std::mutex> const lock(mutex);
                if (i < firstBad) {
                    firstBad = i;
                    result = std::move(status);
                }
                return;
            }
            if (hasRoom && !haveRoom(checker, face)) {
                hasRoom = false;
            }
        }
    };
    FarExt::internal::ParallelForRange(
        faces.GetCount(),
        [&] {
            return Checker{mutex, sizes};
        },
        check, FarExt::internal::kShortParallelRange);
    std::size_t memory = 0;
    for (auto const &[key, size] : sizes) {
        memory += size;
    }
    arePlansKept = hasRoom && memory <= plans.GetMaxMemory();
    return result;
}

// Writes the levels, in a stream of levels.
CallStatus StreamData::checkFace(Index face, FaceLevels &ofFace) const {
    CallStatus status = factory.CheckFace(face);
    if (!status.IsOk()) {
        return status;
    }
    if (forest) {
        return forest->IsMatched(face)
                   ? CallStatus()
                   : CallStatus(StatusCode::InvalidArgument, ComponentType::Face, face,
                                "the tree of face " + std::to_string(face) +
                                    " is not that of such a face, or its edges were not matched");
    }
    GetLevels(face, ofFace);
    auto const isLevel = [](int level) {
        return 0 <= level && level <= LevelTessellation::kLastLevel;
    };
    auto const refuse = [](int level, ComponentType type, char const *name, Index index) {
        return CallStatus(StatusCode::InvalidArgument, type, index,
                          std::string(name) + " " + std::to_string(index) + " has level " +
                              std::to_string(level) + ", which is not one of 0 to " +
                              std::to_string(LevelTessellation::kLastLevel));
    };
    int const ofInside = ofFace.levels.back();
    if (!isLevel(ofInside)) {
        return refuse(ofInside, ComponentType::Face, "face", face);
    }
    auto const bad = std::find_if_not(ofFace.levels.begin(), ofFace.levels.end(), isLevel);
    if (bad == ofFace.levels.end()) {
        return CallStatus();
    }
    Index const edge = factory.GetFaces().GetEdge(face, int(bad - ofFace.levels.begin())).edge;
    return refuse(*bad, ComponentType::Edge, "edge", edge);
}

// Has workers, each of which makeWorker() gives, make the patches of faces; false where one gave false.
template <typename MAKE>
bool StreamData::runWorkers(AskedFaces const &faces, bool arePlansKept, MAKE const &makeWorker,
                            CallStatus &status) const {
    std::atomic<bool> isEnded(false);
    std::mutex mutex;
    Index const length = std::min(std::max(faces.GetCount() / kNumRangesWanted, 1), kMaxRange);
    // Hands out patches getPatch(0) ... getPatch(count - 1), where their faces are no holes.
    auto const run = [&](Index count, auto const &getPatch) {
        FarExt::SurfaceFaces const &base = factory.GetFaces();
        FarExt::internal::ParallelForRange(
            count, makeWorker,
            [&](auto &worker, Index begin, Index end) {
                CallStatus workerStatus;
                for (Index i = begin; i < end && !isEnded; ++i) {
                    Batch::PatchOfFace const patch = getPatch(i);
                    if (base.IsHole(patch.face) ||
                        worker.Run(patch.face, patch.section, workerStatus)) {
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
        run(faces.GetCount(), [&](Index i) { return Batch::PatchOfFace{faces[i], -1}; });
    }
    Batch batch;
    for (Index next = 0; !arePlansKept && next < faces.GetCount() && !isEnded;) {
        next = takeFaces(faces, next, batch);
        run(batch.numPatches, [&](Index i) { return batch.Get(i); });
    }
    plans.Trim();
    return !isEnded;
}

// Checks the faces, and has workers make their patches.
template <typename MAKE>
bool StreamData::Run(AskedFaces const &faces, MAKE const &makeWorker, CallStatus *status) const {
    bool arePlansKept = false;
    CallStatus result = checkFaces(faces, arePlansKept);
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    bool const isDone = runWorkers(faces, arePlansKept, makeWorker, result);
    FarExt::internal::Report(result, status);
    return isDone;
}

} // namespace internal

namespace {

using internal::StreamData;

/// \brief Finds the tessellations of patches, or makes them: each is there until the next one is asked for.
class TessellationFinder {
public:
    explicit TessellationFinder(StreamData const &stream) : _stream(stream) {}

    /// \param section  -1: of the face as a whole
    LevelTessellation const &Find(Far::Index face, int section) {
        if (section >= 0) {
            findSection(face, section);
        } else if (_stream.forest) {
            findTree(face);
        } else {
            _stream.GetLevels(face, _levels);
            if (!_plan || _levels != _planLevels) {
                _plan.reset();
                _plan = _stream.plans.Find(_levels);
                _planLevels = _levels;
            }
        }
        return *_plan;
    }

private:
    void findTree(Far::Index face) {
        if (!internal::PatchPlans::IsShared(_stream.forest->GetTree(face))) {
            _plan.reset();
            _plan = std::make_shared<LevelTessellation const>(_stream.MakeWhole(face));
            _planKey.clear();
            return;
        }
        _stream.forest->GetTessellationKey(face, _treeKey);
        if (_treeKey != _planKey) {
            _plan.reset();
            _plan = _stream.plans.Find(_treeKey, [&] { return _stream.MakeWhole(face); });
            _planKey = _treeKey;
        }
    }

    void findSection(Far::Index face, int section) {
        _plan.reset();
        _planKey.clear();
        _planLevels = {};
        _stream.GetLevels(face, _levels);
        if (_stream.forest ? _sectionsFace != face
                           : !_sections || _sections->GetLevels() != _levels.levels ||
                                 _sections->GetFaceShape() != _levels.shape) {
            _sections.reset();
            _sections = _stream.MakeSections(face);
            _sectionsFace = face;
        }
        _plan = _stream.forest ? std::make_shared<LevelTessellation const>(
                                     *_sections, section, _stream.options.GetTessellationOptions())
                               : _stream.plans.Find(*_sections, section);
    }

    StreamData const &_stream;
    internal::FaceLevels _levels;
    internal::FaceLevels _planLevels;
    std::vector<int> _treeKey; // what tells a tree
    std::vector<int> _planKey;
    internal::PatchPlans::Plan _plan;
    std::unique_ptr<internal::FaceSections const> _sections; // of the last face that came in some
    Far::Index _sectionsFace = Far::INDEX_INVALID;
};

/// \brief Makes the patches of some faces one by one, and hands them out.
template <typename REAL>
class alignas(FarExt::internal::kCacheLine) PatchWorker {
public:
    using Index = Far::Index;
    using Stream = PatchStream<REAL>;
    using Values = typename Stream::Values;
    using PointDescriptor = typename Stream::PointDescriptor;

    /// \param values  of vertices first, and then what is wanted besides
    PatchWorker(StreamData const &stream, std::vector<Values> const &values,
                typename Stream::Sink const &sink)
        : _stream(stream), _finder(stream), _values(values), _sink(sink), _results(values.size()),
          _resultStarts(values.size()) {}

    /// \brief Makes the patch of a face that is no hole, or of one of its sections.
    ///
    /// \param section  -1: of the face as a whole
    /// \return  false where the sink ended the stream, or a face has no surface, as status says
    bool Run(Index face, int section, CallStatus &status) {
        LevelTessellation const &tessellation = _finder.Find(face, section);
        for (std::size_t i = 0; i < _values.size(); ++i) {
            if (!evaluate(face, tessellation, i, status)) {
                return false;
            }
        }
        bool const hasDerivatives = _stream.options.HasDerivatives();
        return _sink({face, tessellation, _resultStarts[0], _values[0].desc.size,
                      hasDerivatives ? _du.data() : nullptr, hasDerivatives ? _dv.data() : nullptr,
                      _resultStarts.data() + 1});
    }

private:
    bool evaluate(Index face, LevelTessellation const &tessellation, std::size_t i,
                  CallStatus &status) {
        Values const &values = _values[i];
        SurfaceFactory const &factory = _stream.factory;
        FarExt::Interpolation const interpolation =
            i == 0 ? FarExt::Interpolation::Vertex
            : values.channel == Values::kVarying
                ? FarExt::Interpolation::Varying
                : FarExt::internal::GetChannelInterpolation(factory.GetMesh(), values.channel);
        status = factory.TryInit(face, interpolation, values.channel, _surface);
        if (!status.IsOk()) {
            return false;
        }
        std::size_t const size =
            std::size_t(tessellation.GetNumCoords()) * std::size_t(values.desc.size);
        _results[i].numbers.resize(size);
        _resultStarts[i] = _results[i].numbers.data();
        REAL *results[6] = {_results[i].numbers.data()};
        if (i == 0 && _stream.options.HasDerivatives()) {
            _du.resize(size);
            _dv.resize(size);
            results[1] = _du.data();
            results[2] = _dv.data();
        }
        internal::FaceEvaluator<REAL>(_surface.GetFace(), values.values, values.desc,
                                      &_results[i].shared)
            .Evaluate(tessellation.GetData(), results, PointDescriptor(values.desc.size));
        return true;
    }

    struct Results {
        std::vector<REAL> numbers;
        internal::SharedRings<REAL> shared;
    };

    StreamData const &_stream;
    TessellationFinder _finder;
    std::vector<Values> const &_values;
    typename Stream::Sink const &_sink;
    Surface<REAL> _surface;
    std::vector<Results> _results; // points, and values
    std::vector<REAL const *> _resultStarts;
    std::vector<REAL> _du; // of points
    std::vector<REAL> _dv;
};

// PatchStream::Run().
template <typename REAL>
bool runStream(StreamData const &stream, REAL const *meshPoints,
               typename PatchStream<REAL>::PointDescriptor const &meshPointDesc,
               std::vector<typename PatchStream<REAL>::Values> const &values,
               AskedFaces const &faces, typename PatchStream<REAL>::Sink const &sink,
               CallStatus *status) {
    std::vector<typename PatchStream<REAL>::Values> all = {{meshPoints, meshPointDesc}};
    for (auto const &further : values) {
        CallStatus const result = further.channel == further.kVarying
                                      ? CallStatus()
                                      : FarExt::internal::CheckChannel(
                                            further.channel, stream.factory.GetNumFVarChannels());
        if (!result.IsOk()) {
            return FarExt::internal::Report(result, status);
        }
        all.push_back(further);
    }
    return stream.Run(
        faces, [&] { return PatchWorker<REAL>(stream, all, sink); }, status);
}

} // namespace

PatchTessellations::PatchTessellations(SurfaceFactory const &factory, PatchLevels levels,
                                       CellForest const *forest, Options const &options)
    : _data(std::make_shared<StreamData const>(factory, std::move(levels), forest, options)) {}

bool PatchTessellations::RunTessellations(TessellationSink const &sink, CallStatus *status) const {
    struct alignas(FarExt::internal::kCacheLine) Finder {
        bool Run(Index face, int section, CallStatus & /*status*/) {
            return sink(face, finder.Find(face, section));
        }

        TessellationFinder finder;
        TessellationSink const &sink;
    };
    return _data->Run(
        AskedFaces(0, GetFactory().GetNumFaces()),
        [&] {
            return Finder{TessellationFinder(*_data), sink};
        },
        status);
}

int PatchTessellations::GetNumSections(Index face) const {
    std::unique_ptr<internal::FaceSections const> const sections = _data->MakeSections(face);
    return sections ? sections->GetNumSections() : 1;
}

LevelTessellation PatchTessellations::MakeTessellation(Index face) const {
    return _data->MakeWhole(face);
}

LevelTessellation PatchTessellations::MakeTessellation(Index face, int section) const {
    std::unique_ptr<internal::FaceSections const> const sections = _data->MakeSections(face);
    return sections ? LevelTessellation(*sections, section, GetOptions().GetTessellationOptions())
                    : MakeTessellation(face);
}

auto PatchTessellations::GetSectionPolygons(Index face) const -> SectionPolygons {
    SectionPolygons result;
    std::unique_ptr<internal::FaceSections const> const sections = _data->MakeSections(face);
    if (!sections) {
        return result;
    }
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

SurfaceFactory const &PatchTessellations::GetFactory() const { return _data->factory; }

PatchLevels const &PatchTessellations::GetLevels() const { return _data->levels; }

CellForest const *PatchTessellations::GetForest() const { return _data->forest; }

auto PatchTessellations::GetOptions() const -> Options const & { return _data->options; }

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            std::vector<Values> const &values, Index beginFace, Index endFace,
                            Sink const &sink, CallStatus *status) const {
    int const numFaces = GetFactory().GetNumFaces();
    if (!(0 <= beginFace && beginFace <= endFace && endFace <= numFaces)) {
        return FarExt::internal::Report(
            FarExt::internal::Failure(StatusCode::InvalidArgument,
                                      "faces " + std::to_string(beginFace) + " to " +
                                          std::to_string(endFace) + " are no range of the " +
                                          std::to_string(numFaces) + " of the mesh"),
            status);
    }
    return runStream(*_data, meshPoints, meshPointDesc, values, AskedFaces(beginFace, endFace),
                     sink, status);
}

template <typename REAL>
bool PatchStream<REAL>::Run(REAL const meshPoints[], PointDescriptor const &meshPointDesc,
                            std::vector<Values> const &values, std::vector<Index> const &faces,
                            Sink const &sink, CallStatus *status) const {
    int const numFaces = GetFactory().GetNumFaces();
    auto const bad = std::find_if(faces.begin(), faces.end(),
                                  [&](Index face) { return face < 0 || face >= numFaces; });
    if (bad != faces.end()) {
        return FarExt::internal::Report(
            CallStatus(StatusCode::InvalidArgument, ComponentType::Face, *bad,
                       "face " + std::to_string(*bad) + " is none of the " +
                           std::to_string(numFaces) + " of the mesh"),
            status);
    }
    return runStream(*_data, meshPoints, meshPointDesc, values, AskedFaces(faces), sink, status);
}

template class PatchStream<float>;
template class PatchStream<double>;

} // namespace OpenSubdivHex::BfrExt
