// SPDX-License-Identifier: Apache-2.0
//
// Camera, View, ViewBounds, CellForest: what a camera sees.  PatchStream: surfaces of all faces, in bounded memory.
#include "surfaces.h"

#include "bfr_ext/patchStream.h"
#include "bfr_ext/view.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

namespace OpenSubdivHex::Python {

namespace {

using BfrExt::Camera;
using BfrExt::LevelTessellation;
using BfrExt::PatchLevels;

/// Text of a number, as Python writes it.
std::string describe(double number) { return py::str(py::float_(number)); }

/// \name Cameras and views
/// @{

void takePoint(py::object const &object, char const *name, double *point) {
    auto const source = TakeSource<double>(object, name, -1, true);
    if (source.array.ndim() != 1 || source.count != 3) {
        throw py::value_error(std::string(name) + ": x, y and z are needed, the shape is " +
                              DescribeShape(source.array));
    }
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(source.data[i])) {
            throw py::value_error(std::string(name) + ": " + describe(source.data[i]) +
                                  " is not finite");
        }
        point[i] = source.data[i];
    }
}

py::tuple showPoint(double const *point) { return py::make_tuple(point[0], point[1], point[2]); }

Camera makeCamera(py::object const &eye, py::object const &target, py::object const &up,
                  double fieldOfView, int width, int height) {
    Camera camera;
    takePoint(eye, "eye", camera.eye);
    takePoint(target, "target", camera.target);
    takePoint(up, "up", camera.up);
    if (!(fieldOfView > 0 && fieldOfView < 180)) {
        throw py::value_error("field_of_view: " + describe(fieldOfView) +
                              " is not between 0 and 180 degrees");
    }
    for (auto const &[size, name] : {std::pair(width, "width"), std::pair(height, "height")}) {
        if (size < 1) {
            throw py::value_error(std::string(name) + ": " + std::to_string(size) +
                                  " is less than 1");
        }
    }
    camera.fieldOfView = fieldOfView;
    camera.width = width;
    camera.height = height;
    return camera;
}

BfrExt::View makeView(Camera const &camera, double flatness, double edgeLength, int maxLevel,
                      bool isCulling, double hysteresis) {
    for (auto const &[pixels, name] :
         {std::pair(flatness, "flatness"), std::pair(edgeLength, "edge_length")}) {
        if (!(pixels >= 0) || std::isinf(pixels)) {
            throw py::value_error(std::string(name) + ": " + describe(pixels) +
                                  " is not a number of pixels");
        }
    }
    if (flatness == 0 && edgeLength == 0) {
        throw py::value_error("flatness, edge_length: one of them must be above 0");
    }
    if (maxLevel < 0 || maxLevel > BfrExt::CellTree::kLastLevel) {
        throw py::value_error("max_level: " + std::to_string(maxLevel) + " is not one of 0 ... " +
                              std::to_string(BfrExt::CellTree::kLastLevel));
    }
    if (!(hysteresis >= 0 && hysteresis <= 1)) {
        throw py::value_error("hysteresis: " + describe(hysteresis) + " is not one of 0 ... 1");
    }
    BfrExt::View view(camera, BfrExt::View::Options()
                                  .SetFlatness(flatness)
                                  .SetEdgeLength(edgeLength)
                                  .SetMaxLevel(maxLevel)
                                  .SetCulling(isCulling)
                                  .SetHysteresis(hysteresis));
    if (!view.IsValid()) {
        throw py::value_error("camera: eye and target are equal, up is 0, or squares of numbers "
                              "are beyond double precision");
    }
    return view;
}

/// BfrExt::CellForest, which keeps the factory.
class Forest {
public:
    Forest(std::shared_ptr<FaceSurfaceFactory const> factory, BfrExt::CellForest forest,
           BfrExt::View::Counts counts)
        : _factory(std::move(factory)), _forest(std::move(forest)), _counts(std::move(counts)) {}

    std::shared_ptr<FaceSurfaceFactory const> const &GetFactory() const { return _factory; }
    BfrExt::CellForest const &Get() const { return _forest; }
    BfrExt::View::Counts const &GetCounts() const { return _counts; }

    FaceTessellation MakeTessellation(int face, int facetSize) const {
        CheckIndex(face, _forest.GetNumFaces(), "face");
        CheckFacetSize(facetSize);
        return _factory->Read([&](BfrExt::SurfaceFactory const &) {
            return FaceTessellation(_forest.GetTessellation(
                face, LevelTessellation::Options().SetFacetSize(facetSize)));
        });
    }
    py::array_t<int> GetBoundaryPoints(int face) const {
        CheckIndex(face, _forest.GetNumFaces(), "face");
        std::vector<int> points = _factory->Read([&](BfrExt::SurfaceFactory const &) {
            std::vector<int> result(
                std::size_t(_forest.GetTessellation(face).GetNumBoundaryCoords()));
            result.resize(std::size_t(_forest.GetBoundaryPoints(face, result.data())));
            return result;
        });
        return TakeOver(std::move(points));
    }
    py::array_t<int> FindChangedFaces(Forest const &previous) const {
        return TakeOver(_factory->Read([&](BfrExt::SurfaceFactory const &) {
            return _forest.FindChangedFaces(previous._forest);
        }));
    }

private:
    std::shared_ptr<FaceSurfaceFactory const> _factory;
    BfrExt::CellForest _forest;
    BfrExt::View::Counts _counts;
};

/// BfrExt::ViewBounds, which keeps the factory, for one thread after the other.
class Bounds {
public:
    Bounds(std::shared_ptr<FaceSurfaceFactory> factory, std::size_t maxMemory)
        : _factory(std::move(factory)),
          _bounds(_factory->Get(), BfrExt::ViewBounds::Options().SetMaxMemory(maxMemory)) {}

    std::shared_ptr<FaceSurfaceFactory const> GetFactory() const { return _factory; }
    /// Calls function(bounds) in one thread at a time.  The interpreter's lock is not held.
    template <typename FUNCTION>
    auto Use(FUNCTION const &function) {
        std::lock_guard const lock(_mutex);
        return function(_bounds);
    }

private:
    std::shared_ptr<FaceSurfaceFactory> _factory;
    std::mutex _mutex;
    BfrExt::ViewBounds _bounds;
};

template <typename REAL>
std::shared_ptr<Forest>
makeForest(BfrExt::View const &view, std::shared_ptr<FaceSurfaceFactory const> const &factory,
           Bounds *bounds, py::object const &points, Forest const *previous) {
    auto const source = TakeSource<REAL>(points, "points", factory->CountVertices());
    if (source.desc.length < 3) {
        throw py::value_error("points: x, y and z of each are needed, the shape is " +
                              DescribeShape(source.array));
    }
    typename BfrExt::Surface<REAL>::PointDescriptor const desc(source.desc.length,
                                                               source.desc.stride);
    BfrExt::View::Counts counts;
    BfrExt::CellForest const *const before = previous ? &previous->Get() : nullptr;
    BfrExt::CellForest forest = factory->Read([&](BfrExt::SurfaceFactory const &surfaces) {
        return bounds ? bounds->Use([&](BfrExt::ViewBounds &kept) {
            return view.MakeForest(kept, source.data, desc, before, &counts);
        })
                      : view.MakeForest(surfaces, source.data, desc, before, &counts);
    });
    return std::make_shared<Forest>(factory, std::move(forest), std::move(counts));
}

std::shared_ptr<Forest> takeMesh(BfrExt::View const &view, py::object const &mesh,
                                 py::object const &points, Forest const *previous) {
    std::shared_ptr<FaceSurfaceFactory const> factory;
    Bounds *bounds = nullptr;
    if (py::isinstance<Bounds>(mesh)) {
        bounds = mesh.cast<Bounds *>();
        factory = bounds->GetFactory();
    } else if (py::isinstance<FaceSurfaceFactory>(mesh)) {
        factory = mesh.cast<std::shared_ptr<FaceSurfaceFactory>>();
    } else {
        throw py::type_error(
            std::string("factory: a SurfaceFactory or ViewBounds is needed, not ") +
            Py_TYPE(mesh.ptr())->tp_name);
    }
    return IsDouble(points) ? makeForest<double>(view, factory, bounds, points, previous)
                            : makeForest<float>(view, factory, bounds, points, previous);
}
/// @}

/// \name Streams
/// @{

/// A patch as a sink gets it: with arrays of its own, since a sink may keep them.
struct StreamedPatch {
    int face;
    FaceTessellation tessellation;
    py::object points;
    py::object du;
    py::object dv;
    py::object varying;
    py::list fvarValues;
};

/// Levels of components, as an array.
std::shared_ptr<std::vector<int> const> takeLevels(py::object const &object, char const *name,
                                                   int count) {
    py::array_t<int> const array = TakeIndices(object, name);
    if (array.size() != count) {
        throw py::value_error(std::string(name) + ": " + std::to_string(count) +
                              " levels are needed, not " + std::to_string(array.size()));
    }
    auto levels = std::make_shared<std::vector<int>>(array.data(), array.data() + count);
    for (int i = 0; i < count; ++i) {
        int const level = (*levels)[std::size_t(i)];
        if (level < 0 || level > LevelTessellation::kLastLevel) {
            throw py::value_error(std::string(name) + ": number " + std::to_string(i) + " is " +
                                  std::to_string(level) + ", not one of 0 ... " +
                                  std::to_string(LevelTessellation::kLastLevel));
        }
    }
    return levels;
}

/// Data of patches besides points: sources of numbers, as a run reads them.
template <typename REAL>
struct StreamSources {
    using Stream = BfrExt::PatchStream<REAL>;

    Elements<REAL const> points;
    std::vector<Elements<REAL const>> others;
    std::vector<typename Stream::Values> values;
    std::vector<int> channels; // by value; kVarying

    typename Stream::PointDescriptor GetPointDescriptor() const {
        return {points.desc.length, points.desc.stride};
    }
};

/// The patches of a range of faces, one behind the other, in one array of each kind.
template <typename REAL>
class PatchCollection {
public:
    using Patch = typename BfrExt::PatchStream<REAL>::Patch;

    PatchCollection(StreamSources<REAL> const &sources, bool hasDerivatives) {
        _sizes.assign(hasDerivatives ? 3 : 1, sources.points.desc.length);
        for (Elements<REAL const> const &other : sources.others) {
            _sizes.push_back(other.desc.length);
        }
    }

    /// Takes a patch, from any thread.
    void Add(Patch const &patch) {
        LevelTessellation const &tessellation = patch.tessellation;
        auto const numPoints = std::size_t(tessellation.GetNumCoords());
        Part part;
        part.face = patch.face;
        part.section = tessellation.GetSection();
        part.numPoints = numPoints;
        for (std::size_t i = 0; i < _sizes.size(); ++i) {
            REAL const *const numbers = getNumbers(patch, i);
            part.numbers.emplace_back(numbers, numbers + numPoints * std::size_t(_sizes[i]));
        }
        part.facets = FaceTessellation::TakeFacets(tessellation);
        if (tessellation.GetFacetSize() == 0) {
            part.facetSizes.resize(std::size_t(tessellation.GetNumFacets()));
            tessellation.GetFacetSizes(part.facetSizes.data());
        }
        part.numFacets = tessellation.GetNumFacets();
        std::lock_guard const lock(_mutex);
        _parts.push_back(std::move(part));
    }

    /// The arrays.  The interpreter's lock is held.
    py::dict MakeArrays(StreamSources<REAL> const &sources, bool hasDerivatives, int facetSize) {
        std::sort(_parts.begin(), _parts.end(), [](Part const &a, Part const &b) {
            return std::tie(a.face, a.section) < std::tie(b.face, b.section);
        });
        std::size_t numPoints = 0;
        std::size_t numFacets = 0;
        std::size_t numIndices = 0;
        std::vector<int> faces;
        std::vector<int> firstPoints = {0};
        std::vector<int> firstFacets = {0};
        for (Part const &part : _parts) {
            numPoints += part.numPoints;
            numFacets += std::size_t(part.numFacets);
            numIndices += part.facets.size();
            constexpr std::size_t kMost = std::numeric_limits<int>::max();
            if (numPoints > kMost || numFacets > kMost) {
                throw py::value_error("begin_face, end_face: up to face " +
                                      std::to_string(part.face) + " there are more than " +
                                      std::to_string(kMost) + " points or facets: take fewer");
            }
            faces.push_back(part.face);
            firstPoints.push_back(int(numPoints));
            firstFacets.push_back(int(numFacets));
        }

        std::vector<py::array_t<REAL>> arrays;
        std::vector<REAL *> data;
        for (int const size : _sizes) {
            arrays.emplace_back(std::vector<py::ssize_t>{py::ssize_t(numPoints), size});
            data.push_back(arrays.back().mutable_data());
        }
        std::vector<int> facets(numIndices);
        std::vector<int> facetSizes;
        {
            py::gil_scoped_release const release;
            int *facet = facets.data();
            for (std::size_t p = 0; p < _parts.size(); ++p) {
                Part &part = _parts[p];
                for (std::size_t i = 0; i < _sizes.size(); ++i) {
                    data[i] = std::copy(part.numbers[i].begin(), part.numbers[i].end(), data[i]);
                }
                for (int const vertex : part.facets) {
                    *facet++ = vertex == Far::INDEX_INVALID ? vertex : firstPoints[p] + vertex;
                }
                facetSizes.insert(facetSizes.end(), part.facetSizes.begin(), part.facetSizes.end());
                part = Part(); // its memory is free for what comes
            }
        }
        py::dict result;
        result["faces"] = TakeOver(std::move(faces));
        result["first_points"] = TakeOver(std::move(firstPoints));
        result["first_facets"] = TakeOver(std::move(firstFacets));
        result["points"] = arrays[0];
        result["du"] = hasDerivatives ? py::object(arrays[1]) : py::none();
        result["dv"] = hasDerivatives ? py::object(arrays[2]) : py::none();
        result["varying"] = py::none();
        py::list fvarValues;
        std::size_t const firstOther = hasDerivatives ? 3 : 1;
        for (std::size_t i = firstOther; i < arrays.size(); ++i) {
            if (sources.channels[i - firstOther] < 0) {
                result["varying"] = arrays[i];
            } else {
                fvarValues.append(arrays[i]);
            }
        }
        result["fvar_values"] = fvarValues;
        py::array_t<int> const indices = TakeOver(std::move(facets));
        if (facetSize == 0) {
            result["facets"] = indices;
            result["facet_sizes"] = TakeOver(std::move(facetSizes));
        } else {
            result["facets"] =
                py::array_t<int>(indices).reshape({py::ssize_t(numFacets), py::ssize_t(facetSize)});
            result["facet_sizes"] = py::none();
        }
        return result;
    }

private:
    struct Part {
        int face = 0;
        int section = 0;
        int numFacets = 0;
        std::size_t numPoints = 0;
        std::vector<std::vector<REAL>> numbers;
        std::vector<int> facets;
        std::vector<int> facetSizes;
    };

    REAL const *getNumbers(Patch const &patch, std::size_t i) const {
        if (i == 0) {
            return patch.points;
        }
        if (patch.du && i < 3) {
            return i == 1 ? patch.du : patch.dv;
        }
        return patch.values[i - (patch.du ? 3 : 1)];
    }

    std::vector<int> _sizes; // of points, derivatives and values
    std::mutex _mutex;
    std::vector<Part> _parts;
};

/// BfrExt::PatchStream for both types of numbers, which keeps what it needs.
class Stream {
public:
    Stream(std::shared_ptr<FaceSurfaceFactory const> factory, py::object const &levels,
           int facetSize, bool hasDerivatives, std::size_t maxMemory)
        : _factory(std::move(factory)), _facetSize(facetSize), _hasDerivatives(hasDerivatives) {
        CheckFacetSize(facetSize);
        makeStream(std::get<0>(_streams), levels, maxMemory);
        makeStream(std::get<1>(_streams), levels, maxMemory);
    }

    int GetNumFaces() const { return _factory->GetNumFaces(); }

    bool Run(py::object const &points, py::object const &sink, py::object const &varying,
             py::object const &fvarValues, int beginFace, std::optional<int> endFace,
             py::object const &faces) const {
        if (!PyCallable_Check(sink.ptr())) {
            throw py::type_error(std::string("sink: a function of a patch is needed, not ") +
                                 Py_TYPE(sink.ptr())->tp_name);
        }
        auto const run = [&](auto real) {
            using REAL = decltype(real);
            auto const sources = takeSources<REAL>(points, varying, fvarValues);
            return runStream<REAL>(sources, beginFace, endFace, faces, [&](auto const &patch) {
                py::gil_scoped_acquire const acquire;
                py::object const answer = sink(showPatch<REAL>(sources, patch));
                if (!answer.is_none() && !py::isinstance<py::bool_>(answer)) {
                    throw py::type_error(std::string("sink: it returns None, True or False, not ") +
                                         Py_TYPE(answer.ptr())->tp_name);
                }
                return !answer.is(py::bool_(false));
            });
        };
        return IsDouble(points) ? run(double()) : run(float());
    }

    py::dict Evaluate(py::object const &points, py::object const &varying,
                      py::object const &fvarValues, int beginFace, std::optional<int> endFace,
                      py::object const &faces) const {
        auto const run = [&](auto real) {
            using REAL = decltype(real);
            auto const sources = takeSources<REAL>(points, varying, fvarValues);
            PatchCollection<REAL> patches(sources, _hasDerivatives);
            runStream<REAL>(sources, beginFace, endFace, faces, [&](auto const &patch) {
                patches.Add(patch);
                return true;
            });
            return patches.MakeArrays(sources, _hasDerivatives, _facetSize);
        };
        return IsDouble(points) ? run(double()) : run(float());
    }

private:
    template <typename REAL>
    using StreamPointer = std::unique_ptr<BfrExt::PatchStream<REAL>>;

    template <typename REAL>
    void makeStream(StreamPointer<REAL> &stream, py::object const &levels, std::size_t maxMemory) {
        using Made = BfrExt::PatchStream<REAL>;
        auto const options =
            typename Made::Options()
                .SetTessellationOptions(LevelTessellation::Options().SetFacetSize(_facetSize))
                .SetDerivatives(_hasDerivatives)
                .SetMaxMemory(maxMemory);
        if (py::isinstance<Forest>(levels)) {
            _forest = levels.cast<std::shared_ptr<Forest>>();
            stream = std::make_unique<Made>(_factory->Get(), _forest->Get(), options);
            return;
        }
        stream = std::make_unique<Made>(_factory->Get(), takePatchLevels(levels), options);
    }
    PatchLevels takePatchLevels(py::object const &levels) const {
        if (py::isinstance<py::int_>(levels)) {
            auto const level = levels.cast<long long>();
            if (level < 0 || level > LevelTessellation::kLastLevel) {
                throw py::value_error("levels: " + std::to_string(level) + " is not one of 0 ... " +
                                      std::to_string(LevelTessellation::kLastLevel));
            }
            return PatchLevels(int(level));
        }
        if ((!py::isinstance<py::tuple>(levels) && !py::isinstance<py::list>(levels)) ||
            py::len(levels) != 2) {
            throw py::type_error("levels: an int, a pair (levels of faces, levels of edges) or a "
                                 "CellForest is needed, not " +
                                 std::string(Py_TYPE(levels.ptr())->tp_name));
        }
        auto const pair = py::reinterpret_borrow<py::sequence>(levels);
        auto const ofFaces = takeLevels(pair[0], "levels[0]", _factory->GetNumFaces());
        auto const ofEdges = takeLevels(pair[1], "levels[1]", _factory->GetNumEdges());
        return {[ofFaces](int face) { return (*ofFaces)[std::size_t(face)]; },
                [ofEdges](int edge) { return (*ofEdges)[std::size_t(edge)]; }};
    }

    template <typename REAL>
    StreamSources<REAL> takeSources(py::object const &points, py::object const &varying,
                                    py::object const &fvarValues) const {
        StreamSources<REAL> sources;
        sources.points = TakeSource<REAL>(points, "points", _factory->CountVertices());
        auto const add = [&](py::handle object, char const *name, int count, int channel) {
            sources.others.push_back(TakeSource<REAL>(object, name, count));
            Osd::BufferDescriptor const &desc = sources.others.back().desc;
            sources.values.push_back(
                {sources.others.back().data, {desc.length, desc.stride}, channel});
            sources.channels.push_back(channel);
        };
        if (!varying.is_none()) {
            add(varying, "varying", _factory->CountVertices(),
                BfrExt::PatchStream<REAL>::Values::kVarying);
        }
        if (!fvarValues.is_none()) {
            if (!py::isinstance<py::sequence>(fvarValues) ||
                py::isinstance<py::array>(fvarValues)) {
                throw py::type_error("fvar_values: a list of arrays is needed, one for each of the "
                                     "first channels, not " +
                                     std::string(Py_TYPE(fvarValues.ptr())->tp_name));
            }
            auto const channels = py::reinterpret_borrow<py::sequence>(fvarValues);
            if (int(channels.size()) > _factory->GetNumFVarChannels()) {
                throw py::value_error("fvar_values: " + std::to_string(channels.size()) +
                                      " arrays, but the mesh has " +
                                      std::to_string(_factory->GetNumFVarChannels()) + " channels");
            }
            for (int channel = 0; channel < int(channels.size()); ++channel) {
                std::string const name = "fvar_values[" + std::to_string(channel) + "]";
                add(channels[std::size_t(channel)], name.c_str(), _factory->CountValues(channel),
                    channel);
            }
        }
        return sources;
    }

    /// Runs the stream without the interpreter's lock.  The refiner's is not held, since sinks call Python.
    template <typename REAL, typename SINK>
    bool runStream(StreamSources<REAL> const &sources, int beginFace, std::optional<int> endFace,
                   py::object const &listedFaces, SINK const &sink) const {
        int const end = endFace.value_or(GetNumFaces());
        if (beginFace < 0 || beginFace > end || end > GetNumFaces()) {
            throw py::index_error("begin_face, end_face: " + std::to_string(beginFace) + " ... " +
                                  std::to_string(end) + " is no range of the " +
                                  std::to_string(GetNumFaces()) + " faces");
        }
        std::vector<int> list;
        bool const isListed = !listedFaces.is_none();
        if (isListed && (beginFace != 0 || endFace)) {
            throw py::value_error("faces: no begin_face and end_face beside them");
        }
        if (isListed) {
            py::array_t<int> const numbers = TakeIndices(listedFaces, "faces");
            list.assign(numbers.data(), numbers.data() + numbers.size());
        }
        Refiner::Hold const hold = _factory->HoldLevels();
        _factory->Read([](BfrExt::SurfaceFactory const &) {}); // raises where it is out of date
        FarExt::CallStatus status;
        bool isComplete = false;
        {
            py::gil_scoped_release const release;
            BfrExt::PatchStream<REAL> const &stream = *std::get<StreamPointer<REAL>>(_streams);
            auto const run = [&](auto const &...faces) {
                return stream.Run(sources.points.data, sources.GetPointDescriptor(), sources.values,
                                  faces..., sink, &status);
            };
            isComplete = isListed ? run(list) : run(beginFace, end);
        }
        RaiseUnlessOk(status);
        return isComplete;
    }

    template <typename REAL>
    StreamedPatch showPatch(StreamSources<REAL> const &sources,
                            typename BfrExt::PatchStream<REAL>::Patch const &patch) const {
        auto const show = [&](REAL const *numbers, int size) {
            return numbers
                       ? py::object(py::array_t<REAL>(
                             {py::ssize_t(patch.tessellation.GetNumCoords()), py::ssize_t(size)},
                             numbers))
                       : py::object(py::none());
        };
        StreamedPatch shown = {patch.face,
                               FaceTessellation(patch.tessellation),
                               show(patch.points, patch.pointSize),
                               show(patch.du, patch.pointSize),
                               show(patch.dv, patch.pointSize),
                               py::none(),
                               py::list()};
        for (std::size_t i = 0; i < sources.others.size(); ++i) {
            py::object const values = show(patch.values[i], sources.others[i].desc.length);
            if (sources.channels[i] < 0) {
                shown.varying = values;
            } else {
                shown.fvarValues.append(values);
            }
        }
        return shown;
    }

    std::shared_ptr<FaceSurfaceFactory const> _factory;
    std::shared_ptr<Forest const> _forest;
    int _facetSize;
    bool _hasDerivatives;
    std::tuple<StreamPointer<float>, StreamPointer<double>> _streams;
};
/// @}

void bindViews(py::module_ &module) {
    py::class_<Camera>(module, "Camera",
                       "Camera(eye, target=(0, 0, 0), up=(0, 1, 0), field_of_view=40.0, "
                       "width=1280, height=720)\n\n"
                       "A pinhole camera, as in glTF and USD.\n\n"
                       "Args:\n"
                       "    eye: position of the camera, x, y and z\n"
                       "    target: the point in the middle of the picture\n"
                       "    up: the direction that is upright in the picture.  A camera that looks "
                       "along up takes\n"
                       "        -z instead, or y if it looks more along z than along y\n"
                       "    field_of_view: vertical angle in degrees, between 0 and 180\n"
                       "    width, height: size of the picture in pixels")
        .def(py::init(&makeCamera), py::arg("eye"), py::arg("target") = py::make_tuple(0, 0, 0),
             py::arg("up") = py::make_tuple(0, 1, 0), py::arg("field_of_view") = 40.0,
             py::arg("width") = 1280, py::arg("height") = 720)
        .def_property_readonly(
            "eye", [](Camera const &self) { return showPoint(self.eye); },
            "Position of the camera.")
        .def_property_readonly(
            "target", [](Camera const &self) { return showPoint(self.target); },
            "The point in the middle of the picture.")
        .def_property_readonly(
            "up", [](Camera const &self) { return showPoint(self.up); },
            "The upright direction that was given.")
        .def_readonly("field_of_view", &Camera::fieldOfView, "Vertical angle in degrees.")
        .def_readonly("width", &Camera::width, "Pixels.")
        .def_readonly("height", &Camera::height, "Pixels.")
        .def(py::pickle(
            [](Camera const &self) {
                return py::make_tuple(showPoint(self.eye), showPoint(self.target),
                                      showPoint(self.up), self.fieldOfView, self.width,
                                      self.height);
            },
            [](py::tuple const &state) {
                return makeCamera(state[0], state[1], state[2], state[3].cast<double>(),
                                  state[4].cast<int>(), state[5].cast<int>());
            }));

    py::class_<Forest, std::shared_ptr<Forest>>(
        module, "CellForest",
        "A watertight tessellation of a mesh, made by View.make_forest(): each face is refined as "
        "far\n"
        "as a camera sees it.  A PatchStream evaluates it.")
        .def_property_readonly(
            "num_faces", [](Forest const &self) { return self.Get().GetNumFaces(); },
            "Faces of the mesh.")
        .def_property_readonly(
            "num_cells",
            [](Forest const &self) {
                std::vector<long> const &counts = self.GetCounts().cellsByLevel;
                return std::accumulate(counts.begin(), counts.end(), 0L);
            },
            "Cells that are not refined further: the polygons of facet size 0.")
        .def_property_readonly(
            "cells_by_level", [](Forest const &self) { return self.GetCounts().cellsByLevel; },
            "The number of cells of level 0, 1, 2 ...")
        .def_property_readonly(
            "num_outside", [](Forest const &self) { return self.GetCounts().outside; },
            "Cells left coarse because they are outside of the picture.")
        .def_property_readonly(
            "num_back_facing", [](Forest const &self) { return self.GetCounts().backFacing; },
            "Cells left coarse because they face away.")
        .def_property_readonly(
            "num_boundary_points",
            [](Forest const &self) { return self.Get().GetNumBoundaryPoints(); },
            "Vertices of the mesh and points on its edges, which faces share.")
        .def("tessellation", &Forest::MakeTessellation,
             "tessellation(face, facet_size=3)\n\n"
             "The LevelTessellation of a face, for Surface.evaluate.",
             py::arg("face"), py::arg("facet_size") = 3)
        .def("boundary_points", &Forest::GetBoundaryPoints,
             "boundary_points(face)\n\n"
             "int32: for each point on the boundary of a face, in the order of its tessellation's\n"
             "coords, the index among the num_boundary_points.  Faces that share a point have the\n"
             "same index for it.",
             py::arg("face"))
        .def("find_changed_faces", &Forest::FindChangedFaces,
             "find_changed_faces(previous)\n\n"
             "int32, ascending: the faces whose tessellations differ from those in another forest "
             "of the mesh.\n"
             "Where positions are the same, all other faces have the same patches, to the bit.  "
             "PatchStream\n"
             "takes them as faces.",
             py::arg("previous").none(false));

    py::class_<Bounds>(
        module, "ViewBounds",
        "ViewBounds(factory, max_memory=268435456)\n\n"
        "Caches the flatness of a mesh's cells for further views of the mesh: pass it to\n"
        "View.make_forest() in place of the factory.  Forests are equal, and take less time.\n"
        "max_memory bounds the cache, in bytes.  Threads that share it wait for each other.")
        .def(py::init<std::shared_ptr<FaceSurfaceFactory>, std::size_t>(),
             py::arg("factory").none(false), py::arg("max_memory") = std::size_t(1) << 28)
        .def_property_readonly(
            "memory",
            [](Bounds &self) {
                py::gil_scoped_release const release;
                return self.Use([](BfrExt::ViewBounds &bounds) { return bounds.GetMemory(); });
            },
            "Bytes in the cache.")
        .def(
            "clear",
            [](Bounds &self) {
                py::gil_scoped_release const release;
                self.Use([](BfrExt::ViewBounds &bounds) { bounds.Clear(); });
            },
            "clear()\n\nForgets all cells.");

    BfrExt::View::Options const options;
    py::class_<BfrExt::View>(
        module, "View",
        "View(camera, *, flatness=0.5, edge_length=0.0, max_level=8, culling=False,\n"
        "     hysteresis=0.5)\n\n"
        "Refines a mesh only as far as a camera sees.\n\n"
        "Args:\n"
        "    camera: a Camera\n"
        "    flatness: largest distance between facets and surface, in pixels, estimated; 0: no "
        "bound\n"
        "    edge_length: largest length of a cell's side, in pixels; 0: no bound\n"
        "    max_level: the largest level of cells, 0 ... 12\n"
        "    culling: leaves cells coarse that are outside the picture or face away\n"
        "    hysteresis: 0 ... 1: a cell that was refined in the previous forest stays refined "
        "above\n"
        "        this fraction of flatness and edge_length, so that pictures do not flicker\n\n"
        "Raises ValueError for numbers out of range, and where eye and target are equal.")
        .def(py::init(&makeView), py::arg("camera").none(false), py::kw_only(),
             py::arg("flatness") = options.GetFlatness(),
             py::arg("edge_length") = options.GetEdgeLength(),
             py::arg("max_level") = options.GetMaxLevel(), py::arg("culling") = options.IsCulling(),
             py::arg("hysteresis") = options.GetHysteresis())
        .def_property_readonly("camera", &BfrExt::View::GetCamera,
                               "The Camera, with the up direction that is used.")
        .def_property_readonly(
            "flatness", [](BfrExt::View const &self) { return self.GetOptions().GetFlatness(); },
            "Pixels.")
        .def_property_readonly(
            "edge_length",
            [](BfrExt::View const &self) { return self.GetOptions().GetEdgeLength(); }, "Pixels.")
        .def_property_readonly(
            "max_level", [](BfrExt::View const &self) { return self.GetOptions().GetMaxLevel(); },
            "The largest level of cells.")
        .def_property_readonly(
            "culling", [](BfrExt::View const &self) { return self.GetOptions().IsCulling(); },
            "Whether unseen cells are left coarse.")
        .def_property_readonly(
            "hysteresis",
            [](BfrExt::View const &self) { return self.GetOptions().GetHysteresis(); },
            "The fraction below which refined cells are merged.")
        .def("make_forest", &takeMesh,
             "make_forest(factory, points, previous=None)\n\n"
             "The CellForest of a mesh.  Faces without a surface are not refined:\n"
             "PatchStream.run() raises StatusError for them.\n\n"
             "Args:\n"
             "    factory: a SurfaceFactory, or ViewBounds, which save time from view to view\n"
             "    points: positions of the mesh, shape (points, 3 or more); float32 and float64 "
             "are\n"
             "        read in place\n"
             "    previous: the CellForest of the previous frame, of the same mesh",
             py::arg("factory"), py::arg("points"), py::arg("previous") = py::none())
        .def(py::pickle(
            [](BfrExt::View const &self) {
                BfrExt::View::Options const &o = self.GetOptions();
                return py::make_tuple(self.GetCamera(), o.GetFlatness(), o.GetEdgeLength(),
                                      o.GetMaxLevel(), o.IsCulling(), o.GetHysteresis());
            },
            [](py::tuple const &state) {
                return makeView(state[0].cast<Camera const &>(), state[1].cast<double>(),
                                state[2].cast<double>(), state[3].cast<int>(),
                                state[4].cast<bool>(), state[5].cast<double>());
            }));
}

} // namespace

void BindStreams(py::module_ &module) {
    bindViews(module);

    py::class_<StreamedPatch>(module, "Patch",
                              "A tessellated base face, or a section of one, that a PatchStream "
                              "passes to its sink.  A sink\n"
                              "may keep the arrays.")
        .def_readonly("face", &StreamedPatch::face, "The base face.")
        .def_readonly("tessellation", &StreamedPatch::tessellation,
                      "The LevelTessellation: coords of the points, and facets between them.")
        .def_readonly("points", &StreamedPatch::points, "Shape (coords, length).")
        .def_readonly("du", &StreamedPatch::du, "Derivatives by u, or None without derivatives.")
        .def_readonly("dv", &StreamedPatch::dv, "Derivatives by v, or None without derivatives.")
        .def_readonly("varying", &StreamedPatch::varying, "Varying data, or None.")
        .def_readonly("fvar_values", &StreamedPatch::fvarValues,
                      "Face-varying data, an array for each channel that was given.");

    py::class_<Stream>(
        module, "PatchStream",
        "PatchStream(factory, levels, *, facet_size=3, derivatives=False, max_memory=4194304)\n\n"
        "Tessellates the limit surfaces of all faces in bounded memory: run() passes the patch of "
        "each\n"
        "face to a function, evaluate() writes the patches of a range of faces into arrays.  "
        "Patches that\n"
        "share an edge have the same points there.  A patch has the same bits for any number of "
        "threads\n"
        "and any range of faces.\n\n"
        "Args:\n"
        "    factory: a SurfaceFactory\n"
        "    levels: 0 ... 12 for all; or a pair of arrays, levels of faces and levels of edges;\n"
        "        or a CellForest of the factory\n"
        "    facet_size: 3: triangles; 4: quads where all cells are quads, else triangles; 0: "
        "polygons\n"
        "    derivatives: whether patches have du and dv\n"
        "    max_memory: bytes of the tessellations that exist at a time; a face that needs more "
        "comes\n"
        "        as several patches, its sections\n\n"
        "Holes have no patch.  Refining the refiner raises BufferError while a stream runs.")
        .def(py::init<std::shared_ptr<FaceSurfaceFactory>, py::object, int, bool, std::size_t>(),
             py::arg("factory").none(false), py::arg("levels"), py::kw_only(),
             py::arg("facet_size") = 3, py::arg("derivatives") = false,
             py::arg("max_memory") = BfrExt::PatchStream<float>::Options().GetMaxMemory())
        .def_property_readonly("num_faces", &Stream::GetNumFaces, "Faces of the mesh.")
        .def("run", &Stream::Run,
             "run(points, sink, *, varying=None, fvar_values=None, begin_face=0, end_face=None,\n"
             "    faces=None)\n\n"
             "Calls sink(patch) with the Patch of each face begin_face ... end_face - 1, or of "
             "faces.\n\n"
             "Args:\n"
             "    points: positions of the mesh, shape (points,) or (points, length): float32 and\n"
             "        float64 are read in place, and results have the same type\n"
             "    sink: a function that takes a Patch.  If it returns False, the stream ends.  "
             "Threads of\n"
             "        the library call it, one call at a time, in any order of faces.  An "
             "exception of\n"
             "        the sink ends the stream, and run() raises it\n"
             "    varying: varying data of the mesh, shape (points, length), or None\n"
             "    fvar_values: a list of arrays, the values of the first channels\n"
             "    faces: numbers of faces, in place of begin_face and end_face\n\n"
             "Returns True, or False if the sink ended the stream.  Raises StatusError for a face "
             "without a\n"
             "surface, unless it is a hole.",
             py::arg("points"), py::arg("sink"), py::kw_only(), py::arg("varying") = py::none(),
             py::arg("fvar_values") = py::none(), py::arg("begin_face") = 0,
             py::arg("end_face") = py::none(), py::arg("faces") = py::none())
        .def(
            "evaluate", &Stream::Evaluate,
            "evaluate(points, *, varying=None, fvar_values=None, begin_face=0, end_face=None,\n"
            "    faces=None)\n\n"
            "The patches of these faces in ascending order, as arrays.  "
            "Takes twice the\n"
            "memory of the result: for large meshes evaluate some faces at a time.  Arguments are "
            "those of\n"
            "run().\n\n"
            "Returns a dict:\n"
            "    'faces': int32, the face of each patch\n"
            "    'first_points', 'first_facets': int32, where the points and facets of each patch\n"
            "        begin; then their end\n"
            "    'points', 'du', 'dv', 'varying': shape (all points, length), or None\n"
            "    'fvar_values': a list with such an array for each channel\n"
            "    'facets': int32, indices of points: shape (facets, facet_size), triangles among "
            "quads\n"
            "        padded with -1; with facet size 0 the corners of all polygons in one array\n"
            "    'facet_sizes': int32, for polygons, or None",
            py::arg("points"), py::kw_only(), py::arg("varying") = py::none(),
            py::arg("fvar_values") = py::none(), py::arg("begin_face") = 0,
            py::arg("end_face") = py::none(), py::arg("faces") = py::none());
}

} // namespace OpenSubdivHex::Python
