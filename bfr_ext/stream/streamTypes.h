// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_STREAM_STREAM_TYPES_H
#define OPENSUBDIVHEX_BFR_EXT_STREAM_STREAM_TYPES_H

#include "bfr_ext/surfaceFactory.h"

#include <cstddef>
#include <memory>
#include <mutex>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief A factory with a cache of its own, made anew when the cache has too many types.  Any number of
/// threads may use it.
class StreamTypes {
public:
    StreamTypes(SurfaceFactory const &factory, std::size_t maxTypes)
        : _factory(factory), _maxTypes(maxTypes) {}

    /// The factory to make some surfaces with, which lives as long as it is held.
    std::shared_ptr<SurfaceFactory const> Get() {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (!_generation || _generation->cache.GetNumTypes() > _maxTypes) {
            _generation.reset();
            _generation = std::make_shared<Generation>(_factory);
        }
        return std::shared_ptr<SurfaceFactory const>(_generation, _generation->factory.get());
    }

private:
    struct Generation {
        explicit Generation(SurfaceFactory const &of)
            : factory(of.CreateWith(SurfaceFactory::Options().SetExternalCache(&cache))) {}

        SurfaceFactoryCache cache;
        std::unique_ptr<SurfaceFactory const> const factory;
    };

    SurfaceFactory const &_factory;
    std::size_t const _maxTypes;
    std::mutex _mutex;
    std::shared_ptr<Generation> _generation;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
