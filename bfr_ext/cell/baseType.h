// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_BASE_TYPE_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_BASE_TYPE_H

#include "keptFaces.h"
#include "plainFace.h"

namespace OpenSubdivHex::BfrExt::internal {

/// The type of a base face: that of a plain one, or one that was made at once.
class BaseType {
public:
    BaseType() = default;
    explicit BaseType(CellType const &type) : _type(&type) {}
    explicit BaseType(PlainFaceType const &plain) : _plain(&plain) {}

    explicit operator bool() const { return _type || _plain; }
    CellType const &operator*() const { return _plain ? _plain->Get() : *_type; }
    CellType const *operator->() const { return &**this; }
    bool IsInLattice() const { return _type ? _type->IsInLattice() : _plain->IsInLattice(); }
    /// The shape of a face of \p size vertices.
    FaceShape GetShape(int size) const { return _type ? _type->GetShape() : FaceShape(size); }
    /// Whether something sharp is near.
    bool IsSharp() const { return _type && _type->IsSharp(); }
    /// The type of a plain face outside lattices, whose CellType need not be made; null for other faces.
    PlainFaceType const *GetPlain() const {
        return _plain && !_plain->IsInLattice() ? _plain : nullptr;
    }

private:
    CellType const *_type = nullptr;
    PlainFaceType const *_plain = nullptr;
};

/// The type and the points of a base face's surface.
using BaseFace = KeptFace<BaseType>;

} // namespace OpenSubdivHex::BfrExt::internal

#endif
