// SPDX-License-Identifier: Apache-2.0
#include "baseType.h"

namespace OpenSubdivHex::BfrExt::internal {

CellType const &BaseType::operator*() const { return _plain ? _plain->Get() : *_type; }

} // namespace OpenSubdivHex::BfrExt::internal
