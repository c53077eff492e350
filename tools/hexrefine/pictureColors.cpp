// SPDX-License-Identifier: Apache-2.0
#include "pictureColors.h"

#include "tools/mesh/fileError.h"

#include <map>
#include <numeric>

namespace OpenSubdivHex::Tools {

std::vector<int> FindRegions(std::string const &colors, Mesh const &mesh, std::string const &path) {
    std::vector<int> regions(colors.empty() ? 0 : std::size_t(mesh.GetNumFaces()));
    std::iota(regions.begin(), regions.end(), 0);
    if (colors.empty() || colors == kPictureColors[0]) {
        return regions;
    }
    std::string FaceLabel::*const name = colors == "materials" ? &FaceLabel::material
                                         : colors == "groups"  ? &FaceLabel::groups
                                                               : &FaceLabel::object;
    std::map<std::string, int> numbers; // in the order of the file
    for (int &region : regions) {
        std::string const label =
            mesh.faceLabels.empty()
                ? std::string()
                : mesh.labels[std::size_t(mesh.faceLabels[std::size_t(region)])].*name;
        region = numbers.try_emplace(label, int(numbers.size())).first->second;
    }
    if (numbers.size() == 1 && numbers.begin()->first.empty()) {
        throw FileError(path, "has no " + colors + " to colour");
    }
    return regions;
}

} // namespace OpenSubdivHex::Tools
