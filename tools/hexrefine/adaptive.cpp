// SPDX-License-Identifier: Apache-2.0
#include "adaptive.h"
#include "faceLoop.h"

#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshText.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Tools {

using BfrExt::CellForest;
using BfrExt::Surface;
using BfrExt::SurfaceFactory;
using BfrExt::Tessellation;

namespace {

constexpr int kMaxPixels = 65536; // a side of the picture

/// The width and the height that WxH says; false if it says none.
bool parseResolution(std::string const &text, int *width, int *height) {
    std::size_t const x = text.find('x');
    return x != std::string::npos && ParseInt(text.substr(0, x), width) &&
           ParseInt(text.substr(x + 1), height) && *width > 0 && *width <= kMaxPixels &&
           *height > 0 && *height <= kMaxPixels;
}

std::string checkResolution(std::string const &word) {
    int width = 0;
    int height = 0;
    return parseResolution(word, &width, &height)
               ? ""
               : "'" + word + "' is not a resolution, as 1280x720, with sides up to " +
                     std::to_string(kMaxPixels);
}

/// Looks at all of the mesh from the front and above.
void lookAtAll(std::vector<float> const &positions, BfrExt::Camera *camera) {
    double least[3];
    double largest[3];
    std::copy_n(positions.data(), 3, least);
    std::copy_n(positions.data(), 3, largest);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        least[i % 3] = std::min(least[i % 3], double(positions[i]));
        largest[i % 3] = std::max(largest[i % 3], double(positions[i]));
    }
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        camera->target[k] = (least[k] + largest[k]) / 2;
        square += std::pow((largest[k] - least[k]) / 2, 2);
    }
    // The ball around the box touches the sides of the picture.
    double const tangent = std::tan(camera->fieldOfView * std::acos(-1.0) / 360) *
                           std::min(1.0, double(camera->width) / camera->height);
    double const distance = std::max(std::sqrt(square) * std::hypot(1, 1 / tangent), 1e-30);
    constexpr double kElevation = 0.5; // upwards, over what it is to the front
    camera->eye[0] = camera->target[0];
    camera->eye[1] = camera->target[1] + distance * kElevation / std::hypot(1, kElevation);
    camera->eye[2] = camera->target[2] + distance / std::hypot(1, kElevation);
}

BfrExt::View makeView(AdaptiveArguments const &arguments, std::vector<float> const &positions) {
    BfrExt::Camera camera;
    camera.fieldOfView = double(arguments.fieldOfView);
    parseResolution(arguments.resolution, &camera.width, &camera.height);
    if (arguments.camera.empty()) {
        lookAtAll(positions, &camera);
    } else {
        std::copy_n(arguments.camera.begin(), 3, camera.eye);
        std::copy_n(arguments.camera.begin() + 3, 3, camera.target);
        if (camera.eye[0] == camera.target[0] && camera.eye[2] == camera.target[2]) {
            camera.up[1] = 0; // a look straight up or down
            camera.up[2] = -1;
        }
    }
    return BfrExt::View(camera, BfrExt::View::Options()
                                    .SetFlatness(double(arguments.pixelError))
                                    .SetMaxLevel(arguments.maxLevel)
                                    .SetCulling(arguments.isCulling));
}

/// The tessellations of all faces, with values at their places.
class Cells {
public:
    Cells(FarExt::TopologyRefiner const &refiner, CellForest const &forest)
        : _base(refiner.GetLevel(0)), _forest(forest), _faces(std::size_t(forest.GetNumFaces())),
          _points(_faces.size()) {
        Tessellation::Options const options = Tessellation::Options().SetFacetSize(0);
        forFaces([&](int face) {
            _faces[std::size_t(face)] =
                std::make_unique<Tessellation>(forest.GetTessellation(face, options));
        });
        numberPoints();
    }

    bool HasFace(int face) const { return !_base.IsFaceHole(face); }
    int GetNumPoints() const { return _numPoints; }
    Tessellation const &GetTessellation(int face) const { return *_faces[std::size_t(face)]; }
    /// The point at each place of a face.
    std::vector<int> const &GetPoints(int face) const { return _points[std::size_t(face)]; }

    /// \brief Values at all places of all faces.
    ///
    /// \param init   init(face, surface) makes the surface of a face
    /// \param width  numbers of a value
    template <typename INIT>
    std::vector<std::vector<float>> Evaluate(INIT init, std::vector<float> const &values,
                                             int width) const {
        std::vector<std::vector<float>> result(_faces.size());
        forFaces([&](int face) {
            Surface<float> surface;
            init(face, &surface);
            std::vector<float> control(std::size_t(surface.GetNumControlPoints()) *
                                       std::size_t(width));
            surface.GatherControlPoints(values.data(), width, control.data(), width);
            std::vector<float> &places = result[std::size_t(face)];
            places.resize(std::size_t(GetTessellation(face).GetNumCoords()) * std::size_t(width));
            surface.Evaluate(GetTessellation(face), control.data(), width, places.data(), width);
        });
        return result;
    }
    /// The same by point, of data that have no seams.
    template <typename INIT>
    std::vector<float> EvaluatePoints(INIT init, std::vector<float> const &values,
                                      int width) const {
        std::vector<std::vector<float>> const places = Evaluate(init, values, width);
        std::vector<float> result(std::size_t(_numPoints) * std::size_t(width));
        for (std::size_t face = 0; face < places.size(); ++face) {
            float const *value = places[face].data();
            for (std::size_t i = 0; i < places[face].size() / std::size_t(width); ++i) {
                std::copy_n(value, width,
                            &result[std::size_t(_points[face][i]) * std::size_t(width)]);
                value += width;
            }
        }
        return result;
    }

    /// Numbers of the face's places that follow one another, facet by facet.
    std::vector<int> GetFacets(int face) const {
        std::vector<int> facets(std::size_t(GetTessellation(face).GetNumFacetVertices()));
        GetTessellation(face).GetFacets(facets.data());
        return facets;
    }

private:
    template <typename FUNCTION>
    void forFaces(FUNCTION function) const {
        ForEachFace(_forest.GetNumFaces(), [&](int face) {
            if (HasFace(face)) {
                function(face);
            }
        });
    }

    // Those of boundaries that some face has, in the order of the forest, then those inside of faces.
    void numberPoints() {
        std::vector<int> numbers(std::size_t(_forest.GetNumBoundaryPoints()), -1);
        for (int face = 0; face < _forest.GetNumFaces(); ++face) {
            if (HasFace(face)) {
                std::vector<int> &points = _points[std::size_t(face)];
                points.resize(std::size_t(GetTessellation(face).GetNumCoords()));
                int const numBoundary = _forest.GetBoundaryPoints(face, points.data());
                std::for_each(points.begin(), points.begin() + numBoundary,
                              [&](int point) { numbers[std::size_t(point)] = 0; });
            }
        }
        for (int &number : numbers) {
            number = number == 0 ? _numPoints++ : number;
        }
        for (int face = 0; face < _forest.GetNumFaces(); ++face) {
            if (HasFace(face)) {
                std::vector<int> &points = _points[std::size_t(face)];
                auto const numBoundary = GetTessellation(face).GetNumBoundaryCoords();
                for (int i = 0; i < int(points.size()); ++i) {
                    int &point = points[std::size_t(i)];
                    point = i < numBoundary ? numbers[std::size_t(point)] : _numPoints++;
                }
            }
        }
    }

    FarExt::TopologyLevel _base;
    CellForest const &_forest;
    std::vector<std::unique_ptr<Tessellation>> _faces; // null of holes
    std::vector<std::vector<int>> _points;
    int _numPoints = 0;
};

/// Replaces the values of a channel: places of one point that have the same value share it.
void setChannel(Cells const &cells, std::vector<std::vector<float>> const &places,
                FVarChannel *channel) {
    auto const width = std::size_t(channel->width);
    channel->values.clear();
    channel->faceValues.clear();
    std::vector<std::vector<int>> valuesOfPoints(std::size_t(cells.GetNumPoints()));
    for (std::size_t face = 0; face < places.size(); ++face) {
        if (places[face].empty()) {
            continue;
        }
        for (int const place : cells.GetFacets(int(face))) {
            float const *const value = &places[face][std::size_t(place) * width];
            std::vector<int> &known =
                valuesOfPoints[std::size_t(cells.GetPoints(int(face))[std::size_t(place)])];
            auto const found = std::find_if(known.begin(), known.end(), [&](int other) {
                return std::equal(value, value + width,
                                  &channel->values[std::size_t(other) * width]);
            });
            if (found != known.end()) {
                channel->faceValues.push_back(*found);
                continue;
            }
            known.push_back(channel->GetNumValues());
            channel->faceValues.push_back(known.back());
            channel->values.insert(channel->values.end(), value, value + width);
        }
    }
}

void setProperties(Cells const &cells, SurfaceFactory const &factory, Mesh *mesh) {
    std::size_t const width = mesh->vertexProperties.size();
    if (width == 0) {
        return;
    }
    std::vector<float> values(width * mesh->vertexProperties[0].values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = mesh->vertexProperties[i % width].values[i / width];
    }
    std::vector<float> const points = cells.EvaluatePoints(
        [&](int face, Surface<float> *surface) { factory.InitVaryingSurface(face, surface); },
        values, int(width));
    for (std::size_t k = 0; k < width; ++k) {
        std::vector<float> &property = mesh->vertexProperties[k].values;
        property.clear();
        for (std::size_t i = k; i < points.size(); i += width) {
            property.push_back(points[i]);
        }
    }
}

/// Faces, and their levels.
void setFaces(Cells const &cells, int numBaseFaces, Mesh *mesh, AdaptiveCells *result) {
    mesh->faceSizes.clear();
    mesh->faceVertices.clear();
    mesh->baseFaces.clear();
    for (int face = 0; face < numBaseFaces; ++face) {
        if (!cells.HasFace(face)) {
            continue;
        }
        Tessellation const &tessellation = cells.GetTessellation(face);
        auto const numFacets = std::size_t(tessellation.GetNumFacets());
        std::vector<int> numbers(numFacets);
        tessellation.GetFacetSizes(numbers.data());
        mesh->faceSizes.insert(mesh->faceSizes.end(), numbers.begin(), numbers.end());
        mesh->baseFaces.insert(mesh->baseFaces.end(), numFacets, face);
        tessellation.GetFacetLevels(numbers.data());
        for (int const level : numbers) {
            ++result->statistics.facesByLevel[std::size_t(level)];
            result->faceLevels.push_back(level);
        }
        for (int const place : cells.GetFacets(face)) {
            mesh->faceVertices.push_back(cells.GetPoints(face)[std::size_t(place)]);
        }
    }
}

} // namespace

void AddAdaptiveOptions(CLI::App &app, AdaptiveArguments *arguments) {
    auto *const adaptive = app.add_flag("--adaptive", arguments->isAdaptive,
                                        "Refine parts of the mesh as far as a camera needs them, "
                                        "in place of --level, with vertices "
                                        "on the limit surface and without gaps");
    app.add_option("--camera", arguments->camera,
                   "Eye and target of the camera of --adaptive, with y up")
        ->delimiter(',')
        ->expected(6)
        ->check([](std::string const &word) {
            float number = 0;
            return std::string(ParseFiniteFloat(word, &number) ? ""
                                                               : "'" + word + "' is not a number");
        })
        ->type_name("EX,EY,EZ,TX,TY,TZ")
        ->needs(adaptive)
        ->default_str("all of the mesh, from the front and above");
    app.add_option("--fov", arguments->fieldOfView, "Angle of the height of its picture")
        ->check([](std::string const &word) {
            float angle = 0;
            return std::string(ParseFiniteFloat(word, &angle) && angle > 0 && angle < 180
                                   ? ""
                                   : "'" + word + "' is not an angle between 0 and 180");
        })
        ->type_name("DEG")
        ->needs(adaptive)
        ->capture_default_str();
    app.add_option("--resolution", arguments->resolution, "Pixels of its picture")
        ->check(checkResolution)
        ->type_name("WxH")
        ->needs(adaptive)
        ->capture_default_str();
    app.add_option("--pixel-error", arguments->pixelError,
                   "How many pixels faces may be away from the limit surface in it")
        ->check([](std::string const &word) {
            float pixels = 0;
            return std::string(ParseFiniteFloat(word, &pixels) && pixels > 0
                                   ? ""
                                   : "'" + word + "' is not a number above 0");
        })
        ->type_name("PIXELS")
        ->needs(adaptive)
        ->capture_default_str();
    app.add_flag("--cull", arguments->isCulling,
                 "Leave coarse what is outside of the picture or faces away for certain")
        ->needs(adaptive);
    app.add_option("--max-level", arguments->maxLevel, "The last level that --adaptive makes")
        ->check([](std::string const &word) {
            int level = 0;
            return std::string(ParseInt(word, &level) && level >= 0 &&
                                       level <= BfrExt::CellTree::kLastLevel
                                   ? ""
                                   : "'" + word + "' is not a level, 0 to " +
                                         std::to_string(BfrExt::CellTree::kLastLevel));
        })
        ->needs(adaptive)
        ->capture_default_str();
}

void CheckAdaptiveOptions(CLI::App const &app, AdaptiveArguments const &arguments) {
    for (char const *const option :
         {"--level", "--limit", "--evaluator", "--coplanar", "--separate-vertices"}) {
        if (arguments.isAdaptive && app.count(option) > 0) {
            throw CLI::ValidationError(option, "is not for --adaptive");
        }
    }
}

AdaptiveCells RefineAdaptively(AdaptiveArguments const &arguments,
                               FarExt::TopologyRefiner const &refiner, std::string const &input,
                               Mesh *mesh) {
    AdaptiveCells result;
    AdaptiveStatistics &statistics = result.statistics;
    FarExt::Status status;
    BfrExt::SurfaceFactoryCache cache;
    auto const factory = SurfaceFactory::Create(
        refiner, SurfaceFactory::Options().SetExternalCache(&cache), &status);
    if (!factory) {
        throw FileError(input, "--adaptive: " + status.GetMessage());
    }
    FarExt::TopologyLevel const base = refiner.GetLevel(0);
    int const numFaces = base.GetNumFaces();
    Surface<float> surface;
    std::int64_t numSurfaces = 0;
    for (int face = 0; face < numFaces; ++face) {
        if (base.IsFaceHole(face)) {
            continue;
        }
        if (!factory->InitVertexSurface(face, &surface, &status)) {
            throw FileError(input, "--adaptive: " + status.GetMessage());
        }
        ++numSurfaces;
    }
    statistics.types = std::int64_t(cache.GetNumTypes());
    statistics.hits = numSurfaces - statistics.types;

    BfrExt::View const view = makeView(arguments, mesh->positions);
    if (!view.IsValid()) {
        throw FileError(input,
                        "the camera of --adaptive sees nothing: eye and target are one place, "
                        "or too far away");
    }
    BfrExt::View::Counts counts;
    CellForest const forest =
        view.MakeForest<float>(*factory, mesh->positions.data(), 3, nullptr, &counts);
    statistics.outside = counts.outside;
    statistics.backFacing = counts.backFacing;
    statistics.facesByLevel.assign(std::size_t(arguments.maxLevel) + 1, 0);

    Cells const cells(refiner, forest);
    mesh->positions = cells.EvaluatePoints(
        [&](int face, Surface<float> *faceSurface) {
            factory->InitVertexSurface(face, faceSurface);
        },
        mesh->positions, 3);
    setProperties(cells, *factory, mesh);
    for (std::size_t channel = 0; channel < mesh->channels.size(); ++channel) {
        FVarChannel &values = mesh->channels[channel];
        setChannel(cells,
                   cells.Evaluate(
                       [&](int face, Surface<float> *faceSurface) {
                           factory->InitFaceVaryingSurface(face, faceSurface, int(channel));
                       },
                       values.values, values.width),
                   &values);
        statistics.channelValues.push_back(values.GetNumValues());
    }
    setFaces(cells, numFaces, mesh, &result);
    statistics.facesOfMaxLevel = statistics.facesByLevel.back();
    statistics.maxLevel = arguments.maxLevel;
    statistics.pixelError = arguments.pixelError;
    while (statistics.facesByLevel.size() > 1 && statistics.facesByLevel.back() == 0) {
        statistics.facesByLevel.pop_back();
    }
    statistics.faces = mesh->GetNumFaces();
    statistics.points = mesh->GetNumVertices();
    statistics.bytes =
        std::int64_t(sizeof(float) * mesh->positions.size() +
                     sizeof(int) * (mesh->faceSizes.size() + mesh->faceVertices.size()));
    BfrExt::Camera const &camera = view.GetCamera();
    for (int k = 0; k < 3; ++k) {
        result.camera.eye[k] = camera.eye[k];
        result.camera.target[k] = camera.target[k];
    }
    result.camera.fieldOfView = arguments.fieldOfView;
    result.camera.width = camera.width;
    result.camera.height = camera.height;
    return result;
}

} // namespace OpenSubdivHex::Tools
