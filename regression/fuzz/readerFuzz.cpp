// SPDX-License-Identifier: Apache-2.0
//
// The readers of mesh files on bytes: what they refuse, they refuse with one line; what they take
// is written and read again, and refined, written and read once more.
#include "apart.h"
#include "damagedFile.h"

#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/hexrefine/evaluation.h"
#include "tools/hexrefine/levelMesh.h"
#include "tools/mesh/fileError.h"
#include "tools/mesh/meshContent.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/topologyDescriptor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <random>
#include <stdexcept>

namespace OpenSubdivHex::Regression {

namespace {

using Tools::FileError;
using Tools::FVarChannel;
using Tools::Mesh;

void require(bool isTrue, char const *what) {
    if (!isTrue) {
        throw std::logic_error(what);
    }
}

/// A folder of this process for the files that are written, removed at its end.
class Folder {
public:
    Folder() {
        std::random_device random;
        do {
            _path = std::filesystem::temp_directory_path() /
                    ("OpenSubdivHex.readerFuzz." + std::to_string(random()));
        } while (!std::filesystem::create_directories(_path));
    }
    ~Folder() {
        std::error_code error;
        std::filesystem::remove_all(_path, error);
    }
    Folder(Folder const &) = delete;
    Folder &operator=(Folder const &) = delete;

    std::string GetPath(std::string const &name) const { return (_path / name).string(); }

private:
    std::filesystem::path _path;
};

bool areIndices(std::vector<int> const &indices, int count) {
    return std::all_of(indices.begin(), indices.end(),
                       [=](int index) { return index >= 0 && index < count; });
}

bool areFinite(std::vector<float> const &values) {
    return std::all_of(values.begin(), values.end(),
                       [](float value) { return std::isfinite(value); });
}

void requireValid(Mesh const &mesh) {
    std::size_t const numCorners = mesh.faceVertices.size();
    require(mesh.GetNumFaces() > 0, "a mesh has no faces");
    require(std::accumulate(mesh.faceSizes.begin(), mesh.faceSizes.end(), std::size_t(0)) ==
                numCorners,
            "the sizes of faces do not match their corners");
    require(*std::min_element(mesh.faceSizes.begin(), mesh.faceSizes.end()) >= 3,
            "a face has fewer than three corners");
    require(mesh.positions.size() % 3 == 0 && areFinite(mesh.positions), "positions are not valid");
    require(areIndices(mesh.faceVertices, mesh.GetNumVertices()), "a vertex is out of range");
    for (FVarChannel const &channel : mesh.channels) {
        require(channel.faceValues.size() == numCorners && areFinite(channel.values) &&
                    areIndices(channel.faceValues, channel.GetNumValues()),
                "a channel is not valid");
    }
    for (Tools::VertexProperty const &property : mesh.vertexProperties) {
        require(int(property.values.size()) == mesh.GetNumVertices() && areFinite(property.values),
                "a property of vertices is not valid");
    }
    bool const areBase = mesh.baseFaces.empty();
    require(areBase || mesh.baseFaces.size() == mesh.faceSizes.size(), "base faces are missing");
    std::size_t const numBaseFaces =
        areBase ? mesh.faceSizes.size()
                : std::size_t(*std::max_element(mesh.baseFaces.begin(), mesh.baseFaces.end())) + 1;
    auto const isOfBaseFaces = [&](std::size_t size) {
        return areBase ? size == numBaseFaces : size >= numBaseFaces;
    };
    for (Tools::FaceProperty const &property : mesh.faceProperties) {
        require(isOfBaseFaces(property.values.size()), "a property of faces is not valid");
    }
    require(mesh.faceLabels.empty() == mesh.labels.empty() &&
                (mesh.faceLabels.empty() || isOfBaseFaces(mesh.faceLabels.size())) &&
                areIndices(mesh.faceLabels, int(mesh.labels.size())),
            "labels are not valid");
    require(areIndices(mesh.tags.creaseVertices, mesh.GetNumVertices()) &&
                areIndices(mesh.tags.cornerVertices, mesh.GetNumVertices()) &&
                areIndices(mesh.tags.holes, mesh.GetNumFaces()),
            "a tag is out of range");
}

bool haveSameBits(std::vector<float> const &a, std::vector<float> const &b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](float value, float other) {
               return std::memcmp(&value, &other, sizeof value) == 0;
           });
}

constexpr char const *kNames[] = {"mesh.obj", "mesh.off", "mesh.ply"};

std::string getPath(std::string const &name) {
    static Folder const folder;
    return folder.GetPath(name);
}

void requireRefused(Mesh const &mesh) {
    for (char const *name : kNames) {
        bool isWritten = true;
        try {
            Tools::WriteMesh(mesh, getPath(name));
        } catch (FileError const &) {
            isWritten = false;
        }
        require(!isWritten, "a mesh is written that would not be read");
    }
}

/// Returns the value of a property in an OBJ file, which knows no types.
float convertToObj(Tools::VertexProperty const &property, float value) {
    return Tools::IsInteger(property.type) ? value / float(Tools::GetMax(property.type)) : value;
}

void requireSameProperties(Mesh const &mesh, Mesh const &copy, bool isObj) {
    for (Tools::VertexProperty const &property : mesh.vertexProperties) {
        Tools::VertexProperty const *const other =
            Tools::FindProperty(copy.vertexProperties, property.name);
        auto const isOne = [](float value) { return value == 1; };
        if (!other && isObj && property.name == "w" &&
            std::all_of(property.values.begin(), property.values.end(), isOne)) {
            continue;
        }
        require(other && (isObj || other->type == property.type),
                "a property of vertices is not read as written");
        auto const isKept = [&](float value, float otherValue) {
            return otherValue == (isObj ? convertToObj(property, value)
                                        : float(Tools::RoundTo(property.type, double(value))));
        };
        require(std::equal(property.values.begin(), property.values.end(), other->values.begin(),
                           other->values.end(), isKept),
                "numbers of vertices are not read as written");
    }
    for (Tools::FaceProperty const &property : mesh.faceProperties) {
        Tools::FaceProperty const *const other =
            Tools::FindProperty(copy.faceProperties, property.name);
        require(other && other->type == property.type &&
                    other->values.size() == mesh.faceSizes.size(),
                "a property of faces is not read as written");
        for (int face = 0; face < mesh.GetNumFaces(); ++face) {
            require(other->values[std::size_t(face)] ==
                        property.values[std::size_t(mesh.GetBaseFace(face))],
                    "numbers of faces are not read as written");
        }
    }
}

Tools::FaceLabel getLabel(Mesh const &mesh, int face) {
    return mesh.faceLabels.empty()
               ? Tools::FaceLabel()
               : mesh.labels[std::size_t(mesh.faceLabels[std::size_t(mesh.GetBaseFace(face))])];
}

void requireSameLabels(Mesh const &mesh, Mesh const &copy) {
    for (int face = 0; face < mesh.GetNumFaces(); ++face) {
        require(getLabel(mesh, face) == getLabel(copy, face), "labels are not read as written");
    }
    require(mesh.materialLibraries == copy.materialLibraries,
            "material libraries are not read as written");
}

/// Writes the mesh in all formats, and reads it again.
void requireRoundTrip(Mesh const &mesh) {
    for (char const *name : kNames) {
        std::string const path = getPath(name);
        Tools::WriteMesh(mesh, path);
        Mesh const copy = Tools::ReadMesh(path);
        // A file that replaces another is on the disk before it has its name, which takes longer.
        std::filesystem::remove(path);
        require(haveSameBits(copy.positions, mesh.positions), "positions are not read as written");
        require(copy.faceSizes == mesh.faceSizes && copy.faceVertices == mesh.faceVertices,
                "faces are not read as written");
        Mesh held = mesh;
        Tools::RemoveWhatIsNotHeld(path, &held);
        require(copy.channels.size() == held.channels.size(), "channels are not read as written");
        for (std::size_t i = 0; i < held.channels.size(); ++i) {
            require(copy.channels[i].width == held.channels[i].width &&
                        haveSameBits(copy.channels[i].values, held.channels[i].values) &&
                        copy.channels[i].faceValues == held.channels[i].faceValues,
                    "values are not read as written");
        }
        require(copy.vertexProperties.size() <= held.vertexProperties.size() &&
                    copy.faceProperties.size() == held.faceProperties.size(),
                "there are more properties than were written");
        requireSameProperties(held, copy, path == getPath("mesh.obj"));
        requireSameLabels(held, copy);
    }
}

/// One level of \p mesh; false if the library refuses it.
bool refine(Mesh *mesh) {
    auto descriptor = Tools::DescribeTopology(*mesh);
    auto const channels = Tools::DescribeChannels(*mesh);
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(
        mesh->tags.boundary.value_or(Sdc::Options::VTX_BOUNDARY_NONE));
    options.SetFVarLinearInterpolation(
        mesh->tags.fvarInterpolation.value_or(Sdc::Options::FVAR_LINEAR_ALL));
    options.SetCreasingMethod(mesh->tags.creasingMethod.value_or(Sdc::Options::CREASE_UNIFORM));
    FarExt::CallStatus status;
    auto const refiner = FarExt::TopologyRefinerFactory::Create(descriptor, options, &status);
    if (!refiner) {
        require(!status.GetErrorMessage().empty(), "a mesh is refused without a cause");
        return false;
    }
    require(refiner->RefineUniform(1, &status), "a small mesh is not refined");
    auto const evaluate = [&](Tools::Primvar const &primvar) {
        require(Tools::EvaluateLevels(*refiner, Tools::kRefinement, primvar, &status),
                "a small mesh is not evaluated");
    };
    evaluate({FarExt::INTERPOLATE_VERTEX, 0, 3, {&mesh->positions}});
    for (Tools::VertexProperty &property : mesh->vertexProperties) {
        evaluate({FarExt::INTERPOLATE_VARYING, 0, 1, {&property.values}});
    }
    for (std::size_t i = 0; i < mesh->channels.size(); ++i) {
        evaluate({FarExt::INTERPOLATE_FACE_VARYING,
                  int(i),
                  mesh->channels[i].width,
                  {&mesh->channels[i].values}});
    }
    Tools::CopyFaces(refiner->GetLevel(1), mesh);
    mesh->tags = {};
    return true;
}

} // namespace

void TestFile(std::string const &name, std::string const &content) {
    Mesh mesh;
    try {
        mesh = Tools::internal::ParseMesh(name, content);
    } catch (FileError const &error) {
        std::string const message = error.what();
        require(message.rfind(name + ": ", 0) == 0 && message.size() > name.size() + 2,
                "a message does not begin with the file");
        require(message == Tools::EscapeControls(message), "a message is more than one line");
        return;
    }
    requireValid(mesh);
    requireRoundTrip(mesh);
    std::size_t const numHoles = mesh.tags.holes.size();
    std::size_t const numFaces = mesh.faceSizes.size();
    if (!refine(&mesh)) {
        return;
    }
    require((numHoles == numFaces) == mesh.faceSizes.empty(), "holes are not left out");
    auto const hasFiniteValues = [](auto const &part) { return areFinite(part.values); };
    bool const isFinite =
        std::all_of(mesh.channels.begin(), mesh.channels.end(), hasFiniteValues) &&
        std::all_of(mesh.vertexProperties.begin(), mesh.vertexProperties.end(), hasFiniteValues);
    // The largest floats may be rounded up to infinity.
    if (mesh.faceSizes.empty() || !isFinite || !areFinite(mesh.positions)) {
        requireRefused(mesh);
        return;
    }
    requireValid(mesh);
    requireRoundTrip(mesh);
}

} // namespace OpenSubdivHex::Regression

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const *data, std::size_t size) {
    using namespace OpenSubdivHex::Regression;
    OpenSubdivHex::FarExt::SetNumThreads(1); // more only cost time: the meshes are small
    DamagedFile const file = MakeDamagedFile(data, size);
    TestFile(file.name, file.content);
    return 0;
}

extern "C" void FuzzReport(unsigned char const *data, unsigned long size) {
    using namespace OpenSubdivHex::Regression;
    DamagedFile const file = MakeDamagedFile(data, size);
    std::fprintf(stderr, "%s, %zu bytes:\n", file.name.c_str(), file.content.size());
    std::fwrite(file.content.data(), 1, file.content.size(), stderr);
}
