// SPDX-License-Identifier: Apache-2.0
#include "surfaceFactory.h"

#include "cell/typeCache.h"

namespace OpenSubdivHex::BfrExt {

SurfaceFactoryCache::SurfaceFactoryCache(std::size_t maxMemory)
    : _types(std::make_shared<internal::TypeCache>(maxMemory)) {}

SurfaceFactoryCache::~SurfaceFactoryCache() = default;

std::size_t SurfaceFactoryCache::GetMaxMemory() const { return _types->GetMaxMemory(); }

std::size_t SurfaceFactoryCache::GetMemory() const { return _types->GetMemory(); }

std::size_t SurfaceFactoryCache::GetNumTypes() const { return _types->GetNumTypes(); }

} // namespace OpenSubdivHex::BfrExt
