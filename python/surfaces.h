// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_PYTHON_SURFACES_H
#define OPENSUBDIVHEX_PYTHON_SURFACES_H

#include "arrays.h"
#include "errors.h"
#include "refiner.h"

#include "bfr_ext/levelTessellation.h"
#include "bfr_ext/surfaceFactory.h"

#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace OpenSubdivHex::Python {

/// A LevelTessellation whose coordinates and facets are arrays.
class FaceTessellation {
public:
    explicit FaceTessellation(BfrExt::LevelTessellation tessellation)
        : _tessellation(std::move(tessellation)) {}

    BfrExt::LevelTessellation const &Get() const { return _tessellation; }

    std::vector<int> GetLevels() const {
        std::vector<int> levels(std::size_t(_tessellation.GetFaceSize()) + 1);
        levels.resize(std::size_t(_tessellation.GetLevels(levels.data())));
        return levels;
    }
    py::array_t<double> GetCoords() const {
        py::array_t<double> coords({py::ssize_t(_tessellation.GetNumCoords()), py::ssize_t(2)});
        double *const data = coords.mutable_data();
        py::gil_scoped_release const release;
        _tessellation.GetCoords(data);
        return coords;
    }
    py::array_t<int> GetFacetSizes() const {
        std::vector<int> sizes;
        {
            py::gil_scoped_release const release;
            sizes.resize(std::size_t(_tessellation.GetNumFacets()));
            _tessellation.GetFacetSizes(sizes.data());
        }
        return TakeOver(std::move(sizes));
    }
    py::array_t<int> GetFacets() const {
        int const stride = _tessellation.GetFacetStride();
        std::vector<int> facets;
        {
            py::gil_scoped_release const release;
            facets = TakeFacets(_tessellation);
        }
        py::array_t<int> array = TakeOver(std::move(facets));
        return stride > 0 ? array.reshape({_tessellation.GetNumFacets(), stride}) : array;
    }

    /// The facets of a tessellation, one behind the other.
    static std::vector<int> TakeFacets(BfrExt::LevelTessellation const &tessellation) {
        int const stride = tessellation.GetFacetStride();
        std::vector<int> facets(stride > 0
                                    ? std::size_t(stride) * std::size_t(tessellation.GetNumFacets())
                                    : std::size_t(tessellation.GetNumFacetVertices()));
        tessellation.GetFacets(facets.data());
        return facets;
    }

private:
    BfrExt::LevelTessellation _tessellation;
};

/// Raises ValueError unless \p size is a size of facets.
void CheckFacetSize(int size);

/// \brief BfrExt::SurfaceFactory, which keeps the refiner.
///
/// Behind a first step it is out of date once the refiner refined again: only functions that do not call Read() may be
/// called then.
class FaceSurfaceFactory {
public:
    explicit FaceSurfaceFactory(std::shared_ptr<Refiner> refiner) : _refiner(std::move(refiner)) {
        FarExt::CallStatus status;
        _refiner->Read([&](FarExt::TopologyRefiner const &base) {
            _factory = BfrExt::SurfaceFactory::Create(base, &status);
            if (_factory) {
                _numRefinements = base.GetNumRefinements();
                _depth = _factory->GetLevel().GetDepth();
                _numFaces = _factory->GetNumFaces();
                _numEdges = _factory->GetFaces().GetNumEdges();
                _numVertices = _factory->GetLevel().GetNumVertices();
                _numFVarChannels = _factory->GetNumFVarChannels();
            }
        });
        RaiseUnlessOk(status);
    }

    /// Keeps the levels as they are while Python code runs, which must not happen inside Read().
    Refiner::Hold HoldLevels() const { return Refiner::Hold(_refiner); }
    /// The factory, for which a Hold, or Read(), is needed.
    BfrExt::SurfaceFactory const &Get() const { return *_factory; }

    /// The level whose faces have the surfaces.
    int GetDepth() const { return _depth; }
    int GetNumFaces() const { return _numFaces; }
    int GetNumEdges() const { return _numEdges; }
    int GetNumFVarChannels() const { return _numFVarChannels; }
    int CountVertices() const { return _numVertices; }
    /// Calls function(factory) without the interpreter's lock, while no thread refines.  Raises RuntimeError for one
    /// out of date.
    template <typename FUNCTION>
    auto Read(FUNCTION const &function) const {
        return _refiner->Read([&](FarExt::TopologyRefiner const &refiner) {
            if (_depth > 0 && refiner.GetNumRefinements() != _numRefinements) {
                throw std::runtime_error("the refiner has refined again since the SurfaceFactory "
                                         "was made: make it again");
            }
            BfrExt::SurfaceFactory const &factory = *_factory;
            return function(factory);
        });
    }
    /// Values of \p channel, which is in range.
    int CountValues(int channel) const {
        return Read([&](BfrExt::SurfaceFactory const &factory) {
            return factory.GetLevel().GetNumFVarValues(channel);
        });
    }

private:
    std::shared_ptr<Refiner> _refiner;
    std::unique_ptr<BfrExt::SurfaceFactory> _factory;
    int _numRefinements = 0;
    int _depth = 0;
    int _numFaces = 0;
    int _numEdges = 0;
    int _numVertices = 0;
    int _numFVarChannels = 0;
};

} // namespace OpenSubdivHex::Python

#endif
