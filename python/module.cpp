// SPDX-License-Identifier: Apache-2.0
#include "errors.h"
#include "options.h"
#include "refiner.h"

#include "far_ext/version.h"

PYBIND11_MODULE(_opensubdivhex, module) {
    using namespace OpenSubdivHex::Python;
    py::options options;
    options.disable_function_signatures(); // the docstrings begin with them, spelled as in Python
    options.disable_enum_members_docstring();
    module.attr("__version__") = OPENSUBDIVHEX_VERSION;
    // False of an object whose constructor raised an error, which tracebacks show.
    module.def("_is_initialized", [](py::handle object) {
        auto *const instance = reinterpret_cast<py::detail::instance *>(object.ptr());
        return instance->get_value_and_holder().value_ptr() != nullptr;
    });
    BindErrors(module);
    BindOptions(module);
    BindThreads(module);
    BindRefiner(module);
    BindLevel(module);
    BindPrimvarRefiner(module);
    BindStencilTables(module);
    BindPatches(module);
    BindEvaluators(module);
    BindSurfaces(module);
    BindStreams(module);
}
