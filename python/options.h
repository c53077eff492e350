// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_OPTIONS_H
#define OPENSUBDIVHEX_PYTHON_OPTIONS_H

#include <pybind11/pybind11.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace OpenSubdivHex::Python {

namespace py = pybind11;

/// Adds the enumerations of options, and SIMD levels.
void BindOptions(py::module_ &module);

/// Adds executors and numbers of threads.
void BindThreads(py::module_ &module);

/// \brief Takes a member of an enumeration, or its name in small letters.
///
/// Raises ValueError for another name, which lists those that there are, and TypeError for what is
/// neither.
template <typename ENUM>
ENUM TakeEnum(py::handle object, char const *argument) {
    if (py::isinstance<ENUM>(object)) {
        return object.cast<ENUM>();
    }
    py::dict const members = py::type::of<ENUM>().attr("__members__");
    std::string names;
    for (auto const &member : members) {
        std::string name = py::str(member.first);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return char(std::tolower(c)); });
        if (py::isinstance<py::str>(object) && std::string(py::str(object)) == name) {
            return member.second.cast<ENUM>();
        }
        names += (names.empty() ? "'" : ", '") + name + "'";
    }
    if (py::isinstance<py::str>(object)) {
        throw py::value_error(std::string(argument) + ": " + std::string(py::repr(object)) +
                              " is none of " + names);
    }
    throw py::type_error(std::string(argument) + ": one of " + names + " is needed, not " +
                         std::string(py::str(py::type::of(object).attr("__name__"))));
}

} // namespace OpenSubdivHex::Python

#endif
