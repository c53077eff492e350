// SPDX-License-Identifier: Apache-2.0
#include "typeCache.h"

namespace OpenSubdivHex::BfrExt::internal {

std::shared_ptr<CellTypes> TypeCache::Get() {
    std::shared_ptr<CellTypes> before; // goes without the lock
    std::lock_guard<std::mutex> const lock(_mutex);
    if (!_types || IsFull(*_types)) {
        before = std::move(_types);
        _types = std::make_shared<CellTypes>(_memory);
    }
    return _types;
}

std::size_t TypeCache::GetNumTypes() const {
    std::lock_guard<std::mutex> const lock(_mutex);
    return _types ? _types->GetSize() : 0;
}

} // namespace OpenSubdivHex::BfrExt::internal
