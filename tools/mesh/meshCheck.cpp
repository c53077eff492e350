// SPDX-License-Identifier: Apache-2.0
#include "meshCheck.h"

#include "fileError.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace OpenSubdivHex::Tools {

void CheckFinite(Mesh const &mesh, std::string const &path, std::string const &place,
                 MeshStart const &start) {
    auto const check = [&](char const *name, char const *number, std::vector<float> const &values,
                           int width, std::int64_t first) {
        auto const bad = std::find_if(values.begin(), values.end(),
                                      [](float value) { return !std::isfinite(value); });
        if (bad != values.end()) {
            throw FileError(path, place + name + " " +
                                      std::to_string(first + (bad - values.begin()) / width) +
                                      " has a " + number +
                                      (place.empty() ? " that is not a finite number"
                                                     : " that is too large for a float"));
        }
    };
    check("vertex", "coordinate", mesh.positions, 3, start.vertex);
    for (VertexProperty const &property : mesh.vertexProperties) {
        check("vertex", property.name.c_str(), property.values, 1, start.vertex);
    }
    for (std::size_t i = 0; i < mesh.channels.size(); ++i) {
        FVarChannel const &channel = mesh.channels[i];
        bool const isUv = channel.kind == FVarKind::Uv;
        check(isUv ? "texture coordinate" : "normal", "part", channel.values, channel.width,
              start.values.empty() ? 0 : start.values[i]);
    }
}

void CheckMesh(Mesh const &mesh, std::string const &path) {
    if (mesh.faceSizes.empty()) {
        throw FileError(path, "has no faces");
    }
    std::size_t count = std::max(mesh.positions.size() / 3, mesh.faceVertices.size());
    for (FVarChannel const &channel : mesh.channels) {
        count = std::max(count, channel.values.size() / std::size_t(channel.width));
    }
    if (count > std::size_t(std::numeric_limits<int>::max())) {
        throw FileError(path, "has more than 2147483647 vertices, values or face corners");
    }
    CheckFinite(mesh, path);
}

} // namespace OpenSubdivHex::Tools
