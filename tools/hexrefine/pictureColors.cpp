// SPDX-License-Identifier: Apache-2.0
#include "pictureColors.h"

#include "tools/mesh/fileError.h"

#include <map>
#include <numeric>

namespace OpenSubdivHex::Tools {

std::vector<int> FindRegions(std::string const &colors, Mesh const &mesh, std::string const &path) {
    std::vector<int> regions(
        colors.empty() || colors == kLevelColors ? 0 : std::size_t(mesh.GetNumFaces()));
    std::iota(regions.begin(), regions.end(), 0);
    if (regions.empty() || colors == kPictureColors[0]) {
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

std::vector<int> FindCellRegions(std::string const &colors, std::vector<int> const &regions,
                                 Mesh const &mesh, std::vector<int> const &faceLevels) {
    if (colors == kLevelColors) {
        return faceLevels;
    }
    std::vector<int> result;
    for (int face = 0; !regions.empty() && face < mesh.GetNumFaces(); ++face) {
        result.push_back(regions[std::size_t(mesh.GetBaseFace(face))]);
    }
    return result;
}

} // namespace OpenSubdivHex::Tools
