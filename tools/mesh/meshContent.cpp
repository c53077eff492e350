// SPDX-License-Identifier: Apache-2.0
#include "meshContent.h"

#include <algorithm>
#include <utility>

namespace OpenSubdivHex::Tools {

namespace {

using Names = std::vector<char const *>;

/// \brief The properties with these names, which all have one of \p types; none where one of them
/// is missing or has another type than the first.
template <typename PROPERTY>
std::vector<std::size_t> find(std::vector<PROPERTY> const &properties, Names const &names,
                              std::vector<NumberType> const &types) {
    std::vector<std::size_t> found;
    for (char const *name : names) {
        auto const property =
            std::find_if(properties.begin(), properties.end(),
                         [name](PROPERTY const &one) { return one.name == name; });
        if (property == properties.end()) {
            return {};
        }
        found.push_back(std::size_t(property - properties.begin()));
    }
    NumberType const type = properties[found[0]].type;
    bool const isOneType = std::all_of(found.begin(), found.end(),
                                       [&](std::size_t i) { return properties[i].type == type; });
    bool const isHeld = std::find(types.begin(), types.end(), type) != types.end();
    return isOneType && isHeld ? found : std::vector<std::size_t>();
}

/// With alpha where there is one.
template <typename PROPERTY>
std::vector<std::size_t> findOffColor(std::vector<PROPERTY> const &properties) {
    std::vector<NumberType> const types = {NumberType::UChar, NumberType::Float};
    std::vector<std::size_t> const rgba =
        find(properties, {"red", "green", "blue", "alpha"}, types);
    return rgba.empty() ? find(properties, {"red", "green", "blue"}, types) : rgba;
}

void append(std::vector<std::size_t> const &from, std::vector<std::size_t> *to) {
    to->insert(to->end(), from.begin(), from.end());
}

/// Keeps those of \p properties whose indices are \p held, and adds the names of the others.
template <typename PROPERTY>
void keep(std::vector<std::size_t> const &held, std::string const &kind,
          std::vector<PROPERTY> *properties, std::vector<std::string> *removed) {
    std::vector<PROPERTY> kept;
    for (std::size_t i = 0; i < properties->size(); ++i) {
        PROPERTY &property = (*properties)[i];
        if (std::find(held.begin(), held.end(), i) != held.end()) {
            kept.push_back(std::move(property));
        } else {
            removed->push_back(kind + " property " + property.name);
        }
    }
    *properties = std::move(kept);
}

void removeLabels(Mesh *mesh, std::vector<std::string> *removed) {
    struct Part {
        char const *name;
        std::string FaceLabel::*words;
    };
    for (Part const &part :
         {Part{"objects", &FaceLabel::object}, Part{"groups", &FaceLabel::groups},
          Part{"materials", &FaceLabel::material},
          Part{"smoothing groups", &FaceLabel::smoothing}}) {
        bool const isThere =
            std::any_of(mesh->labels.begin(), mesh->labels.end(),
                        [&](FaceLabel const &label) { return !(label.*part.words).empty(); });
        if (isThere) {
            removed->emplace_back(part.name);
        }
    }
    if (!mesh->materialLibraries.empty()) {
        removed->emplace_back("material libraries");
    }
    mesh->labels.clear();
    mesh->faceLabels.clear();
    mesh->materialLibraries.clear();
}

} // namespace

MeshContent FindContent(MeshFormat format, Mesh const &mesh) {
    MeshContent content;
    switch (format) {
    case MeshFormat::Obj:
        content.hasChannels = true;
        content.hasLabels = true;
        content.vertexProperties =
            find(mesh.vertexProperties, {"red", "green", "blue"},
                 {NumberType::UChar, NumberType::UShort, NumberType::Float, NumberType::Double});
        if (content.vertexProperties.empty()) {
            content.vertexProperties =
                find(mesh.vertexProperties, {"w"}, {NumberType::Float, NumberType::Double});
        }
        break;
    case MeshFormat::Off:
        append(find(mesh.vertexProperties, {"nx", "ny", "nz"}, {NumberType::Float}),
               &content.vertexProperties);
        append(findOffColor(mesh.vertexProperties), &content.vertexProperties);
        append(find(mesh.vertexProperties, {"s", "t"}, {NumberType::Float}),
               &content.vertexProperties);
        content.faceProperties = findOffColor(mesh.faceProperties);
        break;
    case MeshFormat::Ply:
        for (std::size_t i = 0; i < mesh.vertexProperties.size(); ++i) {
            content.vertexProperties.push_back(i);
        }
        for (std::size_t i = 0; i < mesh.faceProperties.size(); ++i) {
            if (mesh.faceProperties[i].name != kPlyFaceVertices) {
                content.faceProperties.push_back(i);
            }
        }
        break;
    }
    return content;
}

std::vector<std::string> RemoveWhatIsNotHeld(std::string const &path, Mesh *mesh) {
    std::vector<std::string> removed;
    std::optional<MeshFormat> const format = FindMeshFormat(path);
    if (!format) {
        return removed;
    }
    MeshContent const content = FindContent(*format, *mesh);
    if (!content.hasChannels) {
        for (FVarChannel const &channel : mesh->channels) {
            removed.push_back("channel " + GetName(channel.kind));
        }
        mesh->channels.clear();
    }
    keep(content.vertexProperties, "vertex", &mesh->vertexProperties, &removed);
    keep(content.faceProperties, "face", &mesh->faceProperties, &removed);
    if (!content.hasLabels) {
        removeLabels(mesh, &removed);
    }
    return removed;
}

} // namespace OpenSubdivHex::Tools
