// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_REFINER_H
#define OPENSUBDIVHEX_PYTHON_REFINER_H

#include "arrays.h"
#include "errors.h"

#include "far_ext/topologyRefiner.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <utility>

namespace OpenSubdivHex::Python {

namespace py = pybind11;

/// \brief A FarExt::TopologyRefiner as Python shares it: between threads, and with arrays that show
/// its levels.
///
/// Python cannot promise that nobody uses a level while another thread refines, so there is a lock.
/// It is never held by a thread that waits for the interpreter's lock.  Arrays that show a level
/// are counted; while there are any, the levels cannot change, as a bytearray cannot that a
/// memoryview shows.
class Refiner : public std::enable_shared_from_this<Refiner> {
public:
    explicit Refiner(std::unique_ptr<FarExt::TopologyRefiner> refiner)
        : _refiner(std::move(refiner)) {}

    /// \brief Calls function(refiner) without the interpreter's lock, while no thread refines.
    ///
    /// Python objects must not be touched inside.
    template <typename FUNCTION>
    auto Read(FUNCTION const &function) const {
        py::gil_scoped_release const release;
        std::shared_lock const lock(_mutex);
        FarExt::TopologyRefiner const &refiner = *_refiner;
        return function(refiner);
    }

    /// \brief Calls function(refiner, &status), which changes the levels, without the interpreter's
    /// lock.
    ///
    /// Raises BufferError while arrays show them, StatusError when the status is not Ok.
    template <typename FUNCTION>
    void Change(FUNCTION const &function) {
        FarExt::CallStatus status;
        {
            py::gil_scoped_release const release;
            std::unique_lock const lock(_mutex);
            if (_numViews != 0) {
                throw py::buffer_error("arrays show the levels of this refiner, which cannot "
                                       "change as long as they do: "
                                       "delete the arrays, or copy them before");
            }
            function(*_refiner, &status);
        }
        RaiseUnlessOk(status);
    }

    /// An object that keeps this refiner, and its levels as they are, for an array to own.
    py::capsule Pin() const {
        struct Share {
            std::shared_ptr<Refiner const> refiner;
        };
        auto share = std::make_unique<Share>(Share{shared_from_this()});
        py::capsule const pin(share.get(), [](void *memory) {
            std::unique_ptr<Share> const released(static_cast<Share *>(memory));
            --released->refiner->_numViews;
        });
        share.release();
        ++_numViews;
        return pin;
    }

private:
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    mutable std::shared_mutex _mutex;
    mutable std::atomic<int> _numViews{0};
};

/// \brief A level as Python refers to it: it is asked for whenever it is used, and is out of date
/// once the refiner refined again.
class Level {
public:
    /// Raises IndexError for a depth that the refiner has not.
    Level(std::shared_ptr<Refiner const> refiner, int depth)
        : _refiner(std::move(refiner)), _depth(depth),
          _numRefinements(_refiner->Read([depth](FarExt::TopologyRefiner const &r) {
              CheckIndex(depth, r.GetNumLevels(), "level");
              return r.GetNumRefinements();
          })) {}

    Refiner const &GetRefiner() const { return *_refiner; }
    int GetDepth() const { return _depth; }

    /// Calls function(level) as Refiner::Read does.  Raises RuntimeError for one out of date.
    template <typename FUNCTION>
    auto Read(FUNCTION const &function) const {
        return _refiner->Read([&](FarExt::TopologyRefiner const &refiner) {
            if (refiner.GetNumRefinements() != _numRefinements) {
                throw std::runtime_error("the refiner refined or unrefined since this level was "
                                         "taken: take it again");
            }
            return function(refiner.GetLevel(_depth));
        });
    }

    /// The same for queries that need more than face-vertices.
    template <typename FUNCTION>
    auto ReadFull(FUNCTION const &function) const {
        return Read([&](FarExt::TopologyLevel const &level) {
            if (!level.HasFullTopology()) {
                throw py::value_error("level " + std::to_string(_depth) +
                                      " has face-vertices alone: refine with "
                                      "full_topology_in_last_level=True");
            }
            return function(level);
        });
    }

private:
    std::shared_ptr<Refiner const> _refiner;
    int _depth;
    int _numRefinements;
};

void BindRefiner(py::module_ &module);
void BindLevel(py::module_ &module);
void BindPrimvarRefiner(py::module_ &module);
void BindStencilTables(py::module_ &module);
void BindPatches(py::module_ &module);
void BindEvaluators(py::module_ &module);
void BindSurfaces(py::module_ &module);

} // namespace OpenSubdivHex::Python

#endif
