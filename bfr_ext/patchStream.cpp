// SPDX-License-Identifier: Apache-2.0
#include "patchStream.h"

#include "cell/faceEvaluator.h"
#include "cell/patchPlans.h"

#include "far_ext/executor.h"
#include "far_ext/stencil/interpolationMode.h"
#include "far_ext/vtr/parallel.h"
#include "far_ext/vtr/report.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <tuple>

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

    /// A patch that a call makes.
    struct PatchOfFace {
        std::size_t plan; ///< equal ones have the same
        int section;      ///< -1: the face as a whole
        Index face;
    };

    StreamData(SurfaceFactory const &ofMesh, PatchLevels ofFaces, CellForest const *ofTrees,
               Options const &ofStream)
        : factory(ofMesh), levels(std::move(ofFaces)), forest(ofTrees), options(ofStream),
          plans(options.HasDerivatives(), options.GetMaxMemory()) {}

    void GetLevels(Index face, std::vector<int> &result) const;
    bool GetKey(Index face, std::vector<int> &key) const;
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
    CallStatus checkFaces(AskedFaces const &faces) const;
    CallStatus checkFace(Index face, std::vector<int> &ofFace) const;
    Index takeFaces(AskedFaces const &faces, Index next, std::vector<PatchOfFace> &patches) const;
};

namespace internal {

// Writes the levels of the edges, then that of the inside.
void StreamData::GetLevels(Index face, std::vector<int> &result) const {
    FarExt::SurfaceFaces const &faces = factory.GetFaces();
    result.clear();
    for (int local = 0; local < faces.GetShape(face).size; ++local) {
        result.push_back(levels.GetEdgeLevel(faces.GetEdge(face, local).edge));
    }
    result.push_back(levels.GetFaceLevel(face));
}

// Writes numbers that tell the tessellation of a face, and returns whether others are likely to have the same.
bool StreamData::GetKey(Index face, std::vector<int> &key) const {
    constexpr int kMaxCellsOfShared = 128;
    if (forest && forest->GetTree(face).GetNumCells() > kMaxCellsOfShared) {
        key = {face};
        return false;
    }
    if (forest) {
        forest->GetTessellationKey(face, key);
        return true;
    }
    GetLevels(face, key);
    key.push_back(factory.GetFaces().GetShape(face).isHalf ? 1 : 0);
    return true;
}

LevelTessellation StreamData::MakeWhole(Index face) const {
    if (forest) {
        return forest->GetTessellation(face, options.GetTessellationOptions());
    }
    std::vector<int> ofFace;
    GetLevels(face, ofFace);
    return LevelTessellation(factory.GetFaceParameterization(face), int(ofFace.size()),
                             ofFace.data(), options.GetTessellationOptions());
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
    FaceLevels ofFace = {factory.GetFaces().GetShape(face), {}};
    GetLevels(face, ofFace.levels);
    return plans.IsCut(ofFace) ? std::make_unique<FaceSections const>(ofFace, maxLeaves) : nullptr;
}

// Takes the patches of faces from number next on that are no holes.  Where not all of their plans fit in memory, those
// with the same plan stand side by side.
Far::Index StreamData::takeFaces(AskedFaces const &faces, Index next,
                                 std::vector<PatchOfFace> &patches) const {
    constexpr std::size_t kMinNumPatches = 1024;
    constexpr std::size_t kBytesOfPatch = 256; // with its key
    struct KnownPlan {
        std::size_t number;
        int numSections; // 0: whole
    };
    std::size_t const maxNumPatches =
        std::max(kMinNumPatches, options.GetMaxMemory() / kBytesOfPatch);
    std::map<std::vector<int>, KnownPlan> known;
    std::vector<int> key;
    std::vector<int> lastKey;
    KnownPlan plan = {};
    std::vector<int> ofFace;
    std::size_t memory = 0;
    patches.clear();
    for (; next < faces.GetCount() && patches.size() < maxNumPatches; ++next) {
        Index const face = faces[next];
        if (factory.GetFaces().IsHole(face)) {
            continue;
        }
        auto const countSections = [&] {
            std::unique_ptr<FaceSections const> const sections = MakeSections(face);
            return sections ? sections->GetNumSections() : 0;
        };
        if (forest) {
            plan = {0, countSections()};
        } else if (GetKey(face, key); key != lastKey) {
            lastKey = key;
            auto const [place, isNew] = known.emplace(key, KnownPlan{known.size(), 0});
            if (isNew) {
                GetLevels(face, ofFace);
                memory += plans.GetSizeOfMaking(ofFace);
                place->second.numSections = countSections();
            }
            plan = place->second;
        }
        for (int section = plan.numSections > 0 ? 0 : -1; section < plan.numSections; ++section) {
            patches.push_back({plan.number, section, face});
        }
    }
    if (memory > plans.GetMaxMemory()) {
        std::sort(patches.begin(), patches.end(), [](PatchOfFace const &a, PatchOfFace const &b) {
            return std::tie(a.plan, a.section, a.face) < std::tie(b.plan, b.section, b.face);
        });
    }
    return next;
}

// The status names the first wrong face, whichever thread finds it.
CallStatus StreamData::checkFaces(AskedFaces const &faces) const {
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
    std::mutex mutex;
    std::atomic<Index> firstBad(faces.GetCount());
    CallStatus result;
    FarExt::internal::ParallelForRange(
        faces.GetCount(), [] { return std::vector<int>(); },
        [&](std::vector<int> &ofFace, Index begin, Index end) {
            for (Index i = begin; i < end && i < firstBad; ++i) {
                if (base.IsHole(faces[i])) {
                    continue;
                }
                CallStatus status = checkFace(faces[i], ofFace);
                if (!status.IsOk()) {
                    std::lock_guard<std::mutex> const lock(mutex);
                    if (i < firstBad) {
                        firstBad = i;
                        result = std::move(status);
                    }
                    return;
                }
            }
        },
        FarExt::internal::kShortParallelRange);
    return result;
}

CallStatus StreamData::checkFace(Index face, std::vector<int> &ofFace) const {
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
    int const ofInside = ofFace.back();
    if (!isLevel(ofInside)) {
        return refuse(ofInside, ComponentType::Face, "face", face);
    }
    auto const bad = std::find_if_not(ofFace.begin(), ofFace.end(), isLevel);
    if (bad == ofFace.end()) {
        return CallStatus();
    }
    Index const edge = factory.GetFaces().GetEdge(face, int(bad - ofFace.begin())).edge;
    return refuse(*bad, ComponentType::Edge, "edge", edge);
}

// Checks the faces, and has workers, each of which makeWorker() gives, make their patches; false where one gave false.
template <typename MAKE>
bool StreamData::Run(AskedFaces const &faces, MAKE const &makeWorker, CallStatus *status) const {
    CallStatus result = checkFaces(faces);
    if (!FarExt::internal::Report(result, status)) {
        return false;
    }
    std::atomic<bool> isEnded(false);
    std::mutex mutex;
    std::vector<PatchOfFace> patches;
    for (Index next = 0; next < faces.GetCount() && !isEnded;) {
        next = takeFaces(faces, next, patches);
        auto const count = Index(patches.size());
        FarExt::internal::ParallelForRange(
            count, makeWorker,
            [&](auto &worker, Index begin, Index end) {
                CallStatus workerStatus;
                for (Index i = begin; i < end && !isEnded; ++i) {
                    PatchOfFace const &patch = patches[std::size_t(i)];
                    if (worker.Run(patch.face, patch.section, workerStatus)) {
                        continue;
                    }
                    isEnded = true;
                    std::lock_guard<std::mutex> const lock(mutex);
                    if (result.IsOk()) {
                        result = workerStatus;
                    }
                }
            },
            std::min(std::max(count / kNumRangesWanted, 1), kMaxRange));
    }
    plans.Trim();
    FarExt::internal::Report(result, status);
    return !isEnded;
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
        bool const isShared = _stream.GetKey(face, _key);
        if (_plan && _planSection == section && _planKey == _key) {
            return *_plan;
        }
        _plan.reset();
        auto const make = [&] {
            return section < 0 ? _stream.MakeWhole(face)
                               : LevelTessellation(findSections(face), section,
                                                   _stream.options.GetTessellationOptions());
        };
        _planKey = _key;
        _planSection = section;
        if (isShared) {
            _key.push_back(section);
            _plan = _stream.plans.Find(_key, findSize(face, section), make);
        } else {
            _plan = std::make_shared<LevelTessellation const>(make());
        }
        return *_plan;
    }

private:
    std::size_t findSize(Far::Index face, int section) {
        if (section >= 0) {
            return _stream.plans.GetSizeOfSection();
        }
        if (_stream.forest) {
            return _stream.plans.GetSizeOfTree(_planKey.size());
        }
        _stream.GetLevels(face, _levels);
        return _stream.plans.GetSizeOfMaking(_levels);
    }

    internal::FaceSections const &findSections(Far::Index face) {
        if (!_sections || _sectionsKey != _planKey) {
            _sections.reset();
            _sections = _stream.MakeSections(face);
            _sectionsKey = _planKey;
        }
        return *_sections;
    }

    StreamData const &_stream;
    std::vector<int> _levels;
    std::vector<int> _key;
    std::vector<int> _planKey;
    int _planSection = -1;
    internal::PatchPlans::Plan _plan;
    std::unique_ptr<internal::FaceSections const> _sections; // of the last face that came in some
    std::vector<int> _sectionsKey;
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
