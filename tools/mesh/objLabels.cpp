// SPDX-License-Identifier: Apache-2.0
#include "objLabels.h"

#include <algorithm>

namespace OpenSubdivHex::Tools::internal {

namespace {

std::string_view trim(std::string_view text) {
    constexpr char kSpace[] = " \t";
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

} // namespace

bool ObjLabelReader::IsName(std::string_view statement) {
    return statement == "o" || statement == "g" || statement == "usemtl" || statement == "mtllib";
}

bool ObjLabelReader::Read(std::string_view statement, std::string_view words) {
    std::string const text(trim(words));
    if (statement == "mtllib") {
        bool const isKnown =
            std::find(_libraries.begin(), _libraries.end(), text) != _libraries.end();
        if (!text.empty() && !isKnown) {
            _libraries.push_back(text);
        }
        return true;
    }
    std::string *const said = statement == "o"        ? &_current.object
                              : statement == "g"      ? &_current.groups
                              : statement == "usemtl" ? &_current.material
                              : statement == "s"      ? &_current.smoothing
                                                      : nullptr;
    if (!said) {
        return false;
    }
    if (*said != text) {
        *said = text;
        _currentIndex = -1;
    }
    return true;
}

void ObjLabelReader::AddFace() {
    if (_currentIndex < 0) {
        Key const key{_current.object, _current.groups, _current.material, _current.smoothing};
        auto const [found, isNew] = _indices.insert({key, int(_labels.size())});
        if (isNew) {
            _labels.push_back(_current);
        }
        _currentIndex = found->second;
    }
    _faceLabels.push_back(_currentIndex);
}

void ObjLabelReader::Finish(Mesh *mesh) {
    mesh->materialLibraries = std::move(_libraries);
    if (_labels.size() == 1 && _labels[0] == FaceLabel()) {
        return;
    }
    mesh->labels = std::move(_labels);
    mesh->faceLabels = std::move(_faceLabels);
}

} // namespace OpenSubdivHex::Tools::internal
