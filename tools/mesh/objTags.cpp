// SPDX-License-Identifier: Apache-2.0
#include "objTags.h"

#include "fileError.h"
#include "meshText.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace OpenSubdivHex::Tools::internal {

namespace {

std::string quote(std::string_view word) { return "'" + std::string(word.substr(0, 40)) + "'"; }

/// Whether \p word is three counts, "1/0/0".
bool parseCounts(std::string_view word, int counts[3]) {
    for (int i = 0; i < 3; ++i) {
        std::size_t const end = i < 2 ? word.find('/') : word.size();
        if (end == std::string_view::npos || !ParseInt(word.substr(0, end), &counts[i]) ||
            counts[i] < 0) {
            return false;
        }
        word.remove_prefix(std::min(end + 1, word.size()));
    }
    return true;
}

} // namespace

void ObjTagReader::Read(int line, std::string_view text) {
    Tag const tag = parse(line, text);
    if (tag.name == "crease") {
        readCreases(tag);
    } else if (tag.name == "corner") {
        readCorners(tag);
    } else if (tag.name == "hole") {
        readHoles(tag);
    } else if (tag.name == "interpolateboundary") {
        readBoundary(tag);
    } else if (tag.name == "facevaryinginterpolateboundary") {
        _rules.fvarInterpolation = MeshTags::Options::FVarLinearInterpolation(onlyInt(tag, 5));
    } else if (tag.name == "facevaryingpropagatecorners") {
        _propagatesCorners = onlyInt(tag, 1) == 1;
    } else if (tag.name == "creasemethod") {
        readCreasingMethod(tag);
    } else if (tag.name == "smoothtriangles") {
        _hasSmoothTriangles = true;
    } else {
        refuse(line, "tag " + quote(tag.name) + " is not supported");
    }
}

void ObjTagReader::Finish(Mesh *mesh) const {
    checkEdges(*mesh);
    if (_hasSmoothTriangles) {
        AddNotRead("tag smoothtriangles", mesh);
    }
    MeshTags &tags = mesh->tags;
    tags = _rules;
    if (_propagatesCorners &&
        tags.fvarInterpolation == MeshTags::Options::FVAR_LINEAR_CORNERS_PLUS1) {
        tags.fvarInterpolation = MeshTags::Options::FVAR_LINEAR_CORNERS_PLUS2;
    }
    for (auto const &[edge, sharpness] : _creases) {
        if (sharpness.value > 0) {
            tags.creaseVertices.insert(tags.creaseVertices.end(), {edge.first, edge.second});
            tags.creaseSharpness.push_back(sharpness.value);
        }
    }
    for (auto const &[vertex, sharpness] : _corners) {
        if (vertex < 0 || vertex >= mesh->GetNumVertices()) {
            refuse(sharpness.line, "vertex " + std::to_string(vertex) + " is out of range");
        }
        if (sharpness.value > 0) {
            tags.cornerVertices.push_back(vertex);
            tags.cornerSharpness.push_back(sharpness.value);
        }
    }
    for (auto const &[face, line] : _holes) {
        if (face < 0 || face >= mesh->GetNumFaces()) {
            refuse(line, "face " + std::to_string(face) + " is out of range");
        }
        tags.holes.push_back(face);
    }
}

void ObjTagReader::refuse(int line, std::string const &cause) const {
    throw FileError(_path, "line " + std::to_string(line) + ": " + cause);
}

ObjTagReader::Tag ObjTagReader::parse(int line, std::string_view text) const {
    std::vector<std::string_view> const words = SplitWords(text);
    int counts[3];
    if (words.size() < 2 || !parseCounts(words[1], counts)) {
        refuse(line, "a tag needs a name and three counts, as in 't hole 1/0/0 7'");
    }
    Tag tag;
    tag.line = line;
    tag.name = words[0];
    std::size_t const numArguments = words.size() - 2;
    if (std::int64_t(counts[0]) + counts[1] + counts[2] != std::int64_t(numArguments)) {
        refuse(line, "tag " + quote(tag.name) + " has " + std::to_string(numArguments) +
                         " arguments where " + quote(words[1]) + " are announced");
    }
    auto word = words.begin() + 2;
    for (int i = 0; i < counts[0]; ++i, ++word) {
        tag.ints.emplace_back();
        if (!ParseInt(*word, &tag.ints.back())) {
            refuse(line, quote(*word) + " is not an integer");
        }
    }
    for (int i = 0; i < counts[1]; ++i, ++word) {
        tag.floats.emplace_back();
        if (!ParseFiniteFloat(*word, &tag.floats.back())) {
            refuse(line, quote(*word) + " is " + NameFloatFailure(*word));
        }
    }
    tag.strings.assign(word, words.end());
    return tag;
}

int ObjTagReader::onlyInt(Tag const &tag, int maxValue) const {
    if (tag.ints.size() != 1 || !tag.floats.empty() || !tag.strings.empty() || tag.ints[0] < 0 ||
        tag.ints[0] > maxValue) {
        refuse(tag.line,
               "tag " + quote(tag.name) + " needs one integer, 0 to " + std::to_string(maxValue));
    }
    return tag.ints[0];
}

ObjTagReader::Sharpness ObjTagReader::sharpness(Tag const &tag, std::size_t i) const {
    return {tag.line, tag.floats[tag.floats.size() == 1 ? 0 : i]};
}

void ObjTagReader::checkSharpness(Tag const &tag) const {
    for (float const sharpness : tag.floats) {
        if (sharpness < 0) {
            std::ostringstream text;
            text << "sharpness " << sharpness << " is negative";
            refuse(tag.line, text.str());
        }
    }
}

void ObjTagReader::readCreases(Tag const &tag) {
    std::size_t const numEdges = tag.ints.size() / 2;
    if (numEdges == 0 || tag.ints.size() % 2 != 0 || !tag.strings.empty() ||
        (tag.floats.size() != 1 && tag.floats.size() != numEdges)) {
        refuse(tag.line, "tag 'crease' needs pairs of vertices and one sharpness, or one for each");
    }
    checkSharpness(tag);
    for (std::size_t i = 0; i < numEdges; ++i) {
        _creases[std::minmax(tag.ints[2 * i], tag.ints[2 * i + 1])] = sharpness(tag, i);
    }
}

void ObjTagReader::readCorners(Tag const &tag) {
    if (tag.ints.empty() || !tag.strings.empty() ||
        (tag.floats.size() != 1 && tag.floats.size() != tag.ints.size())) {
        refuse(tag.line, "tag 'corner' needs vertices and one sharpness, or one for each");
    }
    checkSharpness(tag);
    for (std::size_t i = 0; i < tag.ints.size(); ++i) {
        _corners[tag.ints[i]] = sharpness(tag, i);
    }
}

void ObjTagReader::readHoles(Tag const &tag) {
    if (tag.ints.empty() || !tag.floats.empty() || !tag.strings.empty()) {
        refuse(tag.line, "tag 'hole' needs faces");
    }
    for (int face : tag.ints) {
        _holes[face] = tag.line;
    }
}

void ObjTagReader::readBoundary(Tag const &tag) {
    using Options = MeshTags::Options;
    // RenderMan's order, which is not Sdc's.
    constexpr Options::VtxBoundaryInterpolation kBoundaries[] = {
        Options::VTX_BOUNDARY_NONE, Options::VTX_BOUNDARY_EDGE_AND_CORNER,
        Options::VTX_BOUNDARY_EDGE_ONLY};
    _rules.boundary = kBoundaries[onlyInt(tag, 2)];
}

void ObjTagReader::readCreasingMethod(Tag const &tag) {
    bool const isOneWord = tag.ints.empty() && tag.floats.empty() && tag.strings.size() == 1;
    if (isOneWord && tag.strings[0] == "normal") {
        _rules.creasingMethod = MeshTags::Options::CREASE_UNIFORM;
    } else if (isOneWord && tag.strings[0] == "chaikin") {
        _rules.creasingMethod = MeshTags::Options::CREASE_CHAIKIN;
    } else {
        refuse(tag.line, "tag 'creasemethod' needs one word, normal or chaikin");
    }
}

void ObjTagReader::checkEdges(Mesh const &mesh) const {
    std::set<Edge> missing;
    for (auto const &[edge, sharpness] : _creases) {
        missing.insert(edge);
    }
    int const *vertices = mesh.faceVertices.data();
    for (int size : mesh.faceSizes) {
        for (int i = 0; i < size && !missing.empty(); ++i) {
            missing.erase(std::minmax(vertices[i], vertices[(i + 1) % size]));
        }
        vertices += size;
    }
    if (!missing.empty()) {
        Edge const edge = *missing.begin();
        refuse(_creases.at(edge).line, "no face has an edge between vertices " +
                                           std::to_string(edge.first) + " and " +
                                           std::to_string(edge.second));
    }
}

} // namespace OpenSubdivHex::Tools::internal
