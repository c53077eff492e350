// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_ERRORS_H
#define OPENSUBDIVHEX_PYTHON_ERRORS_H

#include "far_ext/status.h"

#include <pybind11/pybind11.h>

namespace OpenSubdivHex::Python {

namespace py = pybind11;

/// Adds StatusError, StatusWarning, and the enumerations that these tell of.
void BindErrors(py::module_ &module);

/// Raises StatusError, with the code, component and index of \p status.  The interpreter's lock is
/// held.
[[noreturn]] void Raise(FarExt::CallStatus const &status);

inline void RaiseUnlessOk(FarExt::CallStatus const &status) {
    if (!status.IsOk()) {
        Raise(status);
    }
}

/// Has Python warn of what was noticed.
void Warn(FarExt::CallStatus const &status);

} // namespace OpenSubdivHex::Python

#endif
