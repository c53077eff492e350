// SPDX-License-Identifier: Apache-2.0
#include "errors.h"

namespace OpenSubdivHex::Python {

namespace {

// Exceptions of the module, which the interpreter keeps.
PyObject *statusError = nullptr;
PyObject *statusWarning = nullptr;

PyObject *addClass(py::module_ &module, char const *name, char const *docstring, PyObject *base) {
    std::string const fullName = std::string("opensubdivhex.") + name;
    PyObject *const type = PyErr_NewExceptionWithDoc(fullName.c_str(), docstring, base, nullptr);
    if (!type) {
        throw py::error_already_set();
    }
    module.attr(name) = py::handle(type);
    return type;
}

py::object componentIndex(Far::Index index) {
    return index == Far::INDEX_INVALID ? py::object(py::none()) : py::object(py::int_(index));
}

} // namespace

void BindErrors(py::module_ &module) {
    py::enum_<FarExt::StatusCode>(module, "StatusCode",
                                  "What kind of failure a StatusError reports.")
        .value("INVALID_ARGUMENT", FarExt::StatusCode::InvalidArgument,
               "An option or argument is outside its range.")
        .value("INVALID_TOPOLOGY", FarExt::StatusCode::InvalidTopology,
               "The mesh itself is broken.")
        .value("UNSUPPORTED", FarExt::StatusCode::Unsupported,
               "Valid for OpenSubdiv, but not handled by this scheme.")
        .value("TOO_LARGE", FarExt::StatusCode::TooLarge, "A size would exceed 32-bit indices.");
    py::enum_<FarExt::ComponentType>(module, "ComponentType",
                                     "The kind of mesh component that an error or warning names.")
        .value("NONE", FarExt::ComponentType::NoComponent)
        .value("FACE", FarExt::ComponentType::Face)
        .value("EDGE", FarExt::ComponentType::Edge)
        .value("VERTEX", FarExt::ComponentType::Vertex)
        .value("LEVEL", FarExt::ComponentType::Level);
    py::enum_<FarExt::WarningCode>(module, "WarningCode", "What a StatusWarning is about.")
        .value("INCONSISTENT_ORIENTATION", FarExt::WarningCode::InconsistentOrientation,
               "Edges that both of their faces run in the same direction.")
        .value("NON_MANIFOLD_EDGES", FarExt::WarningCode::NonManifoldEdges,
               "Other edges that come apart, as those of three faces and more.");
    statusError = addClass(module, "StatusError",
                           "A failure that the library reports: a mesh or an argument that it "
                           "refuses.\n\n"
                           "Attributes:\n"
                           "    code (StatusCode): what kind of failure it is\n"
                           "    component (ComponentType): what the index counts\n"
                           "    index (int | None): of the offending component in the input",
                           PyExc_ValueError);
    statusWarning = addClass(module, "StatusWarning",
                             "Something that the library noticed without a failure.\n\n"
                             "Attributes:\n"
                             "    code (WarningCode): what it is about\n"
                             "    component (ComponentType): what the index counts\n"
                             "    index (int): of the first of them in the input\n"
                             "    count (int): how many there are",
                             PyExc_UserWarning);
}

void Raise(FarExt::CallStatus const &status) {
    py::object const error = py::handle(statusError)(status.GetErrorMessage());
    error.attr("code") = status.GetCode();
    error.attr("component") = status.GetComponentType();
    error.attr("index") = componentIndex(status.GetComponentIndex());
    PyErr_SetObject(statusError, error.ptr());
    throw py::error_already_set();
}

void Warn(FarExt::CallStatus const &status) {
    constexpr int kOfCaller = 2; // the frame behind that of _arguments.py
    for (FarExt::Warning const &warning : status.GetWarnings()) {
        py::object const notice = py::handle(statusWarning)(warning.message);
        notice.attr("code") = warning.code;
        notice.attr("component") = warning.component;
        notice.attr("index") = componentIndex(warning.index);
        notice.attr("count") = warning.count;
        py::module_::import("warnings").attr("warn")(notice, py::none(), kOfCaller);
    }
}

} // namespace OpenSubdivHex::Python
