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
#include <vector>

namespace OpenSubdivHex::Python {

namespace py = pybind11;

/// A base mesh as it was given: arrays for a Far::TopologyDescriptor to refer to, and the options.
struct BaseMesh {
    int numVertices = 0;
    bool isLeftHanded = false;
    std::vector<int> faceSizes;
    std::vector<int> faceVertices;
    std::vector<int> creaseVertices;
    std::vector<float> creaseSharpness;
    std::vector<int> cornerVertices;
    std::vector<float> cornerSharpness;
    std::vector<int> holes;
    std::vector<std::vector<int>> channelValues;
    std::vector<int> numChannelValues;
    OpenSubdiv::Sdc::Options sdcOptions;
    FarExt::HexSchemeOptions hexSchemeOptions;
};

/// The arguments of the last call that refined.
struct Refinement {
    int level = 0;
    bool hasFullTopologyInLastLevel = false;
    std::vector<int> faceLabels; ///< of a uniform one
    /// Positions at rest of a coplanar refiner: floats or, if isDouble, doubles; else empty.
    std::vector<double> restPositions;
    bool isDouble = false;
    double angleTolerance = 0;
    bool closeGaps = true;
};

/// \brief A FarExt::TopologyRefiner as Python shares it: between threads, and with arrays that show
/// its levels.
///
/// Python cannot promise that nobody uses a level while another thread refines, so there is a lock.
/// It is never held by a thread that waits for the interpreter's lock.  Arrays that show a level, and
/// streams that call Python while they read it, are counted; while there are any, the levels cannot change, as a bytearray
/// cannot that a memoryview shows.
class Refiner : public std::enable_shared_from_this<Refiner> {
public:
    Refiner(std::unique_ptr<FarExt::TopologyRefiner> refiner, BaseMesh mesh)
        : _refiner(std::move(refiner)), _mesh(std::move(mesh)) {}

    /// The mesh that level 0 was made of.
    BaseMesh const &GetMesh() const { return _mesh; }

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

    /// The refinement that made the levels; of level 0 where there are no others.
    Refinement GetRefinement() const {
        return Read([this](FarExt::TopologyRefiner const &refiner) {
            return refiner.GetMaxLevel() > 0 ? _refinement : Refinement();
        });
    }

    /// \brief Calls function(refiner, &status), which changes the levels as \p refinement says, without the
    /// interpreter's lock.
    ///
    /// Raises BufferError while arrays show them, StatusError when the status is not Ok.
    template <typename FUNCTION>
    void Change(Refinement refinement, FUNCTION const &function) {
        FarExt::CallStatus status;
        {
            py::gil_scoped_release const release;
            std::unique_lock const lock(_mutex);
            if (_numHolds != 0) {
                throw py::buffer_error("the levels of this refiner cannot change while arrays show "
                                       "them or a stream reads them: delete the arrays, or copy "
                                       "them before");
            }
            function(*_refiner, &status);
            if (status.IsOk()) {
                _refinement = std::move(refinement);
            }
        }
        RaiseUnlessOk(status);
    }

    /// \brief Keeps a refiner, and its levels as they are: Change() raises BufferError meanwhile.
    ///
    /// Needs neither the interpreter's lock nor that of the refiner.  Levels that are looked for afterwards, by Read(),
    /// stay where they are.
    class Hold {
    public:
        explicit Hold(std::shared_ptr<Refiner const> refiner) : _refiner(std::move(refiner)) {
            ++_refiner->_numHolds;
        }
        Hold(Hold &&other) noexcept : _refiner(std::move(other._refiner)) {}
        ~Hold() {
            if (_refiner) {
                --_refiner->_numHolds;
            }
        }

        Hold &operator=(Hold &&) = delete;
        Hold(Hold const &) = delete;
        Hold &operator=(Hold const &) = delete;

    private:
        std::shared_ptr<Refiner const> _refiner;
    };

    /// An object that holds the levels, for an array to own.
    py::capsule Pin() const {
        auto hold = std::make_unique<Hold>(shared_from_this());
        py::capsule const pin(hold.get(), [](void *memory) { delete static_cast<Hold *>(memory); });
        hold.release();
        return pin;
    }

private:
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    BaseMesh const _mesh;
    Refinement _refinement;
    mutable std::shared_mutex _mutex;
    mutable std::atomic<int> _numHolds{0};
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

    /// Read() for queries that need more than face-vertices.
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
void BindStreams(py::module_ &module);

} // namespace OpenSubdivHex::Python

#endif
