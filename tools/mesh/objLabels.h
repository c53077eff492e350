// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_OBJ_LABELS_H
#define OPENSUBDIVHEX_TOOLS_OBJ_LABELS_H

#include "mesh.h"

#include <map>
#include <string_view>
#include <tuple>

namespace OpenSubdivHex::Tools::internal {

/// \brief Collects what the statements `o`, `g`, `usemtl`, `s` and `mtllib` of an OBJ file say, line
/// by line.  Each of the first four holds for the faces behind it, up to the next of its kind; with
/// nothing behind the keyword it says that there is none.
class ObjLabelReader {
public:
    /// Reads \p words, the whole text behind the keyword \p statement; false if it is none of
    /// these.
    bool Read(std::string_view statement, std::string_view words);

    /// The next face has the label that holds.
    void AddFace();

    /// Gives labels and libraries to \p mesh.  Labels that say nothing of any face are none.
    void Finish(Mesh *mesh);

    /// Whether a line that begins with \p statement is read as a whole: names may have a #.
    static bool IsName(std::string_view statement);

private:
    using Key = std::tuple<std::string, std::string, std::string, std::string>;

    FaceLabel _current{};
    int _currentIndex = -1; ///< of _labels; -1: not known yet
    std::map<Key, int> _indices{};
    std::vector<FaceLabel> _labels{};
    std::vector<int> _faceLabels{};
    std::vector<std::string> _libraries{};
};

} // namespace OpenSubdivHex::Tools::internal

#endif
