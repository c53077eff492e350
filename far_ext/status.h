// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_STATUS_H
#define OPENSUBDIVHEX_FAR_EXT_STATUS_H

#include "export.h"

#include <opensubdiv/far/error.h>
#include <opensubdiv/far/types.h>
#include <opensubdiv/sdc/options.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace OpenSubdivHex {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

namespace FarExt {

/// \brief The kind of failure that a CallStatus reports.
enum class StatusCode {
    Ok,              ///< nothing failed
    InvalidArgument, ///< an option or argument is outside its documented range
    InvalidTopology, ///< the mesh itself is broken; CallStatus names the component
    Unsupported,     ///< valid for OpenSubdiv, but not handled by this scheme
    TooLarge         ///< a size would exceed the 32-bit indices of Far
};

/// \brief The kind of mesh component that a CallStatus points at.
enum class ComponentType {
    NoComponent, ///< no single component
    Face,        ///< a face
    Edge,        ///< an edge
    Vertex,      ///< a vertex
    Level        ///< a level of refinement
};

/// \brief The kind of a Warning.
enum class WarningCode {
    InconsistentOrientation, ///< edges that both of their faces run in the same direction
    NonManifoldEdges         ///< other edges that come apart, as those of three faces and more
};

/// \brief A notice about the input that is no failure: the message says how the result treats it.
struct Warning {
    WarningCode code;        ///< what it is about
    ComponentType component; ///< kind of the components concerned
    Far::Index index;        ///< of the first of them in the input
    std::int64_t count;      ///< how many there are
    std::string message;     ///< one sentence that names the count and the first
};

/// \brief The outcome of a call: a code, the component that caused a failure, one sentence, and warnings, which an Ok
/// status may have, too.
///
/// Every function that can fail takes an optional `CallStatus *`, and assigns it on success, too.  Nothing in this
/// library prints.
///
/// \code
///     FarExt::CallStatus status;
///     auto refiner = FarExt::TopologyRefinerFactory::Create(descriptor, sdcOptions, &status);
///     if (!refiner) {
///         std::fprintf(stderr, "%s\n", status.GetErrorMessage().c_str());
///     }
/// \endcode
///
/// **Exceptions.** Only std::bad_alloc is thrown.  A call that throws leaves nothing behind, and its objects can be used
/// again; TopologyRefiner says which levels it then has.  Exceptions of the user's own types, such as primvars, pass
/// through.
///
/// **Threads.** Const functions, and functions that make objects, may be called by several threads at once, for the same
/// arguments, too.  Other functions are called by one thread while no other uses the object.  SetNumThreads() says how
/// many threads a call uses itself.
class CallStatus {
public:
    /// Ok, no component, empty message.
    CallStatus() = default;

    /// A failure, caused by component number \p index of its kind.
    CallStatus(StatusCode code, ComponentType component, Far::Index index, std::string message)
        : _code(code), _component(component), _index(index), _message(std::move(message)) {}

    /// Whether nothing failed.
    bool IsOk() const { return _code == StatusCode::Ok; }

    /// The kind of failure.
    StatusCode GetCode() const { return _code; }

    /// Kind of the offending component, NoComponent when no single component is to blame.
    ComponentType GetComponentType() const { return _component; }

    /// Index of the offending component in the input (INDEX_INVALID when there is none).
    Far::Index GetComponentIndex() const { return _index; }

    /// One sentence that names the component and the cause; empty when Ok.
    std::string const &GetErrorMessage() const { return _message; }

    /// The warnings: at most one for each WarningCode.
    std::vector<Warning> const &GetWarnings() const { return _warnings; }
    /// Adds a warning.
    void AddWarning(Warning warning) { _warnings.push_back(std::move(warning)); }

private:
    StatusCode _code = StatusCode::Ok;
    ComponentType _component = ComponentType::NoComponent;
    Far::Index _index = Far::INDEX_INVALID;
    std::string _message;
    std::vector<Warning> _warnings;
};

/// \brief Installs \p callback as Far's error callback and has this library report through it too.
///
/// Far prints an error when it has no callback and offers no way to ask whether it has one, so
/// errors of this library are passed to Far::Error only once a callback was installed here.
/// A null pointer restores Far's default and silences this library.  Not thread-safe, as
/// Far::SetErrorCallback is not.
OPENSUBDIVHEX_API void SetErrorCallback(Far::ErrorCallbackFunc callback);

} // namespace FarExt
} // namespace OpenSubdivHex

#endif
