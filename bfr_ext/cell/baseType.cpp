// SPDX-License-Identifier: Apache-2.0
#include "baseType.h"

namespace OpenSubdivHex::BfrExt::internal {

CellType const &BaseType::operator*() const { return _type ? *_type : _plain->Get(); }

} // namespace OpenSubdivHex::BfrExt::internal
