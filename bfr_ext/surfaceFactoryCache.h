// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_SURFACE_FACTORY_CACHE_H
#define OPENSUBDIVHEX_BFR_EXT_SURFACE_FACTORY_CACHE_H

#include "far_ext/export.h"

#include <cstddef>
#include <memory>

namespace OpenSubdivHex::BfrExt {

namespace internal {
class CellTypes;
}

/// \brief Keeps the weights that surfaces of faces that look alike share, as Bfr::SurfaceFactoryCache.
///
/// Faces whose neighbourhoods have the same topology and tags have one *type*, in one mesh or in several, with any
/// options.  The weights of a type are found once.  Every SurfaceFactory has a cache of its own unless it is given one:
///
/// \code
///     BfrExt::SurfaceFactoryCache cache; // for several meshes
///     BfrExt::SurfaceFactory::Options options;
///     options.SetCache(&cache);
/// \endcode
///
/// Any number of threads and of factories may share a cache.  It grows by some hundred bytes with each type
/// of faces that it meets.  When a surface of the type is first evaluated, or at once where a feature is
/// near, it grows by some kilobytes for it and for each type of cell that evaluation goes through.  Of the
/// tessellations that are evaluated it keeps the weights, for types of faces or of cells.  Surfaces keep
/// what they need of the cache, so that it may go before them.
class OPENSUBDIVHEX_API SurfaceFactoryCache {
public:
    SurfaceFactoryCache();
    ~SurfaceFactoryCache();

    SurfaceFactoryCache(SurfaceFactoryCache const &) = delete;
    SurfaceFactoryCache &operator=(SurfaceFactoryCache const &) = delete;

    /// Types that are there: those of faces, and those of the cells that evaluation went through.
    std::size_t GetNumTypes() const;

    /// The types, for the classes of this library.
    std::shared_ptr<internal::CellTypes> const &GetTypes() const { return _types; }

private:
    std::shared_ptr<internal::CellTypes> _types;
};

} // namespace OpenSubdivHex::BfrExt

#endif
