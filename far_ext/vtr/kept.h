// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_KEPT_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_KEPT_H

#include <memory>

namespace OpenSubdivHex::FarExt::internal {

/// \brief Something that is made when it is first asked for, and kept for all who ask later.
template <typename T>
class Kept {
public:
    /// \brief The kept value, or else a new one by \p make(): a shared pointer.
    ///
    /// Several threads may call it at once: of those that they have made, all get the first.
    template <typename MAKE>
    std::shared_ptr<T const> Get(MAKE make) const {
        std::shared_ptr<T const> kept = std::atomic_load(&_kept);
        if (kept) {
            return kept;
        }
        std::shared_ptr<T const> const made = make();
        return std::atomic_compare_exchange_strong(&_kept, &kept, made) ? made : kept;
    }
    void Clear() { _kept.reset(); }

private:
    mutable std::shared_ptr<T const> _kept;
};

} // namespace OpenSubdivHex::FarExt::internal

#endif
