// SPDX-License-Identifier: Apache-2.0
#include "surfaceFactory.h"

#include "cell/cellType.h"

namespace OpenSubdivHex::BfrExt {

SurfaceFactoryCache::SurfaceFactoryCache() : _types(std::make_shared<internal::CellTypes>()) {}

SurfaceFactoryCache::~SurfaceFactoryCache() = default;

std::size_t SurfaceFactoryCache::GetNumTypes() const { return _types->GetSize(); }

} // namespace OpenSubdivHex::BfrExt
