// SPDX-License-Identifier: Apache-2.0
#include "adaptive.h"
#include "cellPieces.h"

#include "bfr_ext/surfaceFactory.h"
#include "bfr_ext/view.h"
#include "tools/mesh/boundaryRule.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshText.h"
#include "tools/mesh/program.h"
#include "tools/mesh/shownVertices.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Tools {

using BfrExt::CellForest;
using BfrExt::SurfaceFactory;

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

/// Looks at all points, of which there is one at least, from the front and above.
void lookAtAll(std::vector<float> const &points, BfrExt::Camera *camera) {
    double least[3];
    double largest[3];
    std::copy_n(points.data(), 3, least);
    std::copy_n(points.data(), 3, largest);
    for (std::size_t i = 0; i < points.size(); ++i) {
        least[i % 3] = std::min(least[i % 3], double(points[i]));
        largest[i % 3] = std::max(largest[i % 3], double(points[i]));
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

BfrExt::View makeView(AdaptiveArguments const &arguments, FarExt::TopologyLevel const &level,
                      std::vector<float> const &positions) {
    BfrExt::Camera camera;
    camera.fieldOfView = double(arguments.fieldOfView);
    parseResolution(arguments.resolution, &camera.width, &camera.height);
    if (arguments.camera.empty()) {
        lookAtAll(GatherPositions(FindShownVertices(level), positions), &camera);
    } else {
        std::copy_n(arguments.camera.begin(), 3, camera.eye);
        std::copy_n(arguments.camera.begin() + 3, 3, camera.target);
    }
    return BfrExt::View(camera, BfrExt::View::Options()
                                    .SetFlatness(double(arguments.pixelError))
                                    .SetMaxLevel(arguments.maxLevel)
                                    .SetCulling(arguments.isCulling));
}

} // namespace

void AddAdaptiveOptions(CLI::App &app, AdaptiveArguments *arguments) {
    auto *const adaptive = app.add_flag("--adaptive", arguments->isAdaptive,
                                        "Refine parts of the mesh as far as a camera needs them, "
                                        "in place of --level, with vertices "
                                        "on the limit surface and without gaps; not with --limit, "
                                        "--evaluator, --simd, --coplanar or --separate-vertices");
    AddNumbers(app, "--camera", &arguments->camera, 6, 6,
               "Eye and target of the camera of --adaptive, with y up")
        ->type_name("EX,EY,EZ,TX,TY,TZ")
        ->needs(adaptive)
        ->default_str("all of the mesh, from the front and above");
    app.add_option("--fov", arguments->fieldOfView, "Angle of the height of its picture")
        ->check(MakeOpenRange(0, 180, "an angle between 0 and 180"))
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
        ->check(MakePositive())
        ->type_name("PIXELS")
        ->needs(adaptive)
        ->capture_default_str();
    app.add_flag("--cull", arguments->isCulling,
                 "Leave coarse what is outside of the picture or faces away")
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
    struct Refused {
        char const *option;
        char const *reason;
    };
    for (auto const &[option, reason] :
         {Refused{"--level", ", which refines up to --max-level"},
          Refused{"--limit", ", whose vertices are limit points already"},
          Refused{"--evaluator", ""}, Refused{"--simd", ""}, Refused{"--coplanar", ""},
          Refused{"--separate-vertices", ""}}) {
        if (arguments.isAdaptive && app.count(option) > 0) {
            throw CLI::ValidationError(option, std::string("is not for --adaptive") + reason);
        }
    }
}

AdaptiveRefinement::AdaptiveRefinement(Mesh const &mesh, std::string const &output, bool isKept)
    : _mesh(mesh), _isKept(isKept) {
    if (!output.empty()) {
        _writer.emplace(mesh, output);
    }
}

void AdaptiveRefinement::Refine(AdaptiveArguments const &arguments,
                                FarExt::TopologyRefiner const &refiner, std::string const &input) {
    FarExt::CallStatus status;
    BfrExt::SurfaceFactoryCache cache;
    auto const factory = SurfaceFactory::Create(
        refiner, SurfaceFactory::Options().SetExternalCache(&cache), &status);
    if (!factory) {
        throw FileError(input, "--adaptive: " + status.GetErrorMessage());
    }
    FarExt::TopologyLevel const base = factory->GetLevel();
    BfrExt::Surface<float> surface;
    std::int64_t numSurfaces = 0;
    for (int face = 0; face < factory->GetNumFaces(); ++face) {
        if (factory->GetFaces().IsHole(face)) {
            continue;
        }
        if (!factory->InitVertexSurface(face, &surface, &status)) {
            RequireBoundaryRule(refiner, input);
            throw FileError(input, "--adaptive: " + status.GetErrorMessage());
        }
        ++numSurfaces;
    }
    _statistics.types = std::int64_t(cache.GetNumTypes());
    _statistics.hits = numSurfaces - _statistics.types;

    BfrExt::View const view = makeView(arguments, base, _mesh.positions);
    if (!view.IsValid()) {
        throw FileError(input,
                        "the camera of --adaptive sees nothing: eye and target are one place, "
                        "or too far away");
    }
    BfrExt::View::Counts counts;
    CellForest const forest =
        view.MakeForest<float>(*factory, _mesh.positions.data(), 3, nullptr, &counts);
    _statistics.outside = counts.outside;
    _statistics.backFacing = counts.backFacing;
    _statistics.facesByLevel.assign(std::size_t(arguments.maxLevel) + 1, 0);
    _statistics.channelValues.assign(_mesh.channels.size(), 0);

    CellPieces pieces(*factory, forest, _mesh, input);
    while (pieces.MakeNext()) {
        take(pieces.GetPiece(), pieces.GetFaceLevels());
    }
    _front = pieces.TakeFront();
    _statistics.points += _front.GetNumVertices();
    _statistics.bytes += std::int64_t(sizeof(float) * _front.positions.size());
    _kept.positions.insert(_kept.positions.begin(), _front.positions.begin(),
                           _isKept ? _front.positions.end() : _front.positions.begin());
    _statistics.facesOfMaxLevel = _statistics.facesByLevel.back();
    _statistics.maxLevel = arguments.maxLevel;
    _statistics.pixelError = arguments.pixelError;
    while (_statistics.facesByLevel.size() > 1 && _statistics.facesByLevel.back() == 0) {
        _statistics.facesByLevel.pop_back();
    }
    BfrExt::Camera const &camera = view.GetCamera();
    for (int k = 0; k < 3; ++k) {
        _camera.eye[k] = camera.eye[k];
        _camera.target[k] = camera.target[k];
    }
    _camera.fieldOfView = arguments.fieldOfView;
    _camera.width = camera.width;
    _camera.height = camera.height;
}

void AdaptiveRefinement::take(Mesh const &piece, std::vector<int> const &faceLevels) {
    for (std::size_t face = 0; face < piece.faceSizes.size(); ++face) {
        int const size = piece.faceSizes[face];
        if (size > AdaptiveStatistics::kMaxReadSize && _statistics.facesNotRead++ == 0) {
            _statistics.firstNotRead = piece.baseFaces[face];
            _statistics.sizeOfFirstNotRead = size;
        }
    }
    for (int const level : faceLevels) {
        ++_statistics.facesByLevel[std::size_t(level)];
    }
    for (std::size_t channel = 0; channel < piece.channels.size(); ++channel) {
        _statistics.channelValues[channel] += piece.channels[channel].GetNumValues();
    }
    _statistics.faces += piece.GetNumFaces();
    _statistics.points += piece.GetNumVertices();
    _statistics.bytes +=
        std::int64_t(sizeof(float) * piece.positions.size() +
                     sizeof(int) * (piece.faceSizes.size() + piece.faceVertices.size()));
    if (_writer) {
        _writer->Add(piece);
    }
    if (_isKept) {
        auto const append = [](auto &to, auto const &from) {
            to.insert(to.end(), from.begin(), from.end());
        };
        append(_kept.positions, piece.positions);
        append(_kept.faceSizes, piece.faceSizes);
        append(_kept.faceVertices, piece.faceVertices);
        append(_kept.baseFaces, piece.baseFaces);
        append(_kept.tags.creaseVertices, piece.tags.creaseVertices);
        append(_kept.tags.creaseSharpness, piece.tags.creaseSharpness);
        append(_faceLevels, faceLevels);
    }
}

} // namespace OpenSubdivHex::Tools
