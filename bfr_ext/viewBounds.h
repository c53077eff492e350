// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_VIEW_BOUNDS_H
#define OPENSUBDIVHEX_BFR_EXT_VIEW_BOUNDS_H

#include "surfaceFactory.h"

#include <cstddef>
#include <memory>

namespace OpenSubdivHex::BfrExt {

namespace internal {
struct BoundsData;
}

/// \brief Keeps how flat the cells of a mesh are, which no camera changes, for the next views of the mesh.
///
/// \code
///     BfrExt::ViewBounds bounds(*factory);
///     BfrExt::CellForest const forest = view.MakeForest(bounds, positions, 3); // each frame
/// \endcode
///
/// Flatness, places and directions of cells take most of the time of View::MakeForest().  They are kept by base face with the
/// positions that they were measured for; where positions have changed, they are measured again.  Forests are the same, to
/// the last cell, with and without.
///
/// **Memory** is Options::SetMaxMemory(), and three doubles for each vertex of the mesh.  Each cell that a view asked for
/// takes about 64 bytes; for culling, 72 more.  Each view measures anew the cells for which there is no room.
///
/// One thread at a time may use it; View::MakeForest() has threads of its own.  std::bad_alloc passes
/// through.
class OPENSUBDIVHEX_API ViewBounds {
public:
    /// A face or a vertex of the base mesh.
    using Index = Far::Index;

    /// \brief How much is kept.
    class Options {
    public:
        /// 256 MiB at most.
        Options() : _maxMemory(std::size_t(1) << 28) {}

        /// Sets how many bytes all cells may take.
        Options &SetMaxMemory(std::size_t bytes) {
            _maxMemory = bytes;
            return *this;
        }
        /// The number that was set.
        std::size_t GetMaxMemory() const { return _maxMemory; }

    private:
        std::size_t _maxMemory;
    };

    /// Bounds of no cells yet.
    ///
    /// \param factory  of the mesh, which must live as long
    /// \param options  how much is kept
    explicit ViewBounds(SurfaceFactory const &factory, Options options = Options());
    ~ViewBounds();

    ViewBounds(ViewBounds const &) = delete;
    ViewBounds &operator=(ViewBounds const &) = delete;

    /// The factory that was given.
    SurfaceFactory const &GetFactory() const;
    /// The options.
    Options const &GetOptions() const;
    /// Memory that cells take, in bytes.
    std::size_t GetMemory() const;
    /// Forgets all.
    void Clear();

    /// Its data, for the classes of this library.
    internal::BoundsData &GetData() { return *_data; }

private:
    std::unique_ptr<internal::BoundsData> _data;
};

} // namespace OpenSubdivHex::BfrExt

#endif
