// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_PLANS_H
#define OPENSUBDIVHEX_BFR_EXT_CELL_PATCH_PLANS_H

#include "cellPlan.h"
#include "faceSections.h"

#include "bfr_ext/levelTessellation.h"

#include <algorithm>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// \brief The *plans* that have been asked for: tessellations, with the cells their places lie in, of patches with the same
/// levels or the same tree.
///
/// Where plans come to take too much memory, those that nobody uses are forgotten, beginning with the one that was not
/// asked for longest.  Any number of threads may use it.
class PatchPlans {
public:
    using Plan = std::shared_ptr<LevelTessellation const>;

    PatchPlans(bool hasDerivatives, std::size_t maxMemory)
        : _hasDerivatives(hasDerivatives), _maxMemory(maxMemory) {}

    std::size_t GetMaxMemory() const { return _maxMemory; }
    /// \brief About what it takes in memory to make the plan of some levels, with the plan itself.
    ///
    /// The cells in which the levels of edges take part are counted as if they had that of the inside;
    /// derivatives on an edge follow cells that are there for one or two of its points alone.
    std::size_t GetSizeOfMaking(std::vector<int> const &levels) const {
        std::size_t const bytes = getBytesOfPlace();
        std::size_t const bytesOnEdge = bytes + (_hasDerivatives ? 700 : 0);
        std::size_t const numCells = (std::size_t(1) << (2 * levels.back())) / 3;
        std::size_t size = kBytesOfPlan + (levels.size() - 1) * (numCells + 2) * bytes;
        for (std::size_t edge = 0; edge + 1 < levels.size(); ++edge) {
            size += ((std::size_t(2) << levels[edge]) / 3 + 1) * bytesOnEdge;
        }
        return size;
    }

    /// Whether a face with some levels comes in sections.
    bool IsCut(FaceLevels const &levels) const {
        return isCut(double(GetSizeOfMaking(levels.levels)),
                     FaceSections::CountLeaves(levels.shape, levels.levels.back()));
    }
    /// Overload for a face with a tree.
    bool IsCut(CellTree const &tree) const {
        double const numLeaves = tree.GetNumLeaves();
        return isCut(numLeaves * double(getBytesOfPlace()), numLeaves);
    }
    /// How many cells a section has at most.
    int GetMaxLeaves() const {
        return int(std::clamp(_maxMemory / 8 / getBytesOfPlace(), kMinLeaves, kMaxLeaves));
    }

    /// The size of the plan of a section, and of a tree that has so many cells and points on its edges.
    std::size_t GetSizeOfSection() const { return std::size_t(GetMaxLeaves()) * getBytesOfPlace(); }
    std::size_t GetSizeOfTree(std::size_t numCells) const {
        return kBytesOfPlan + numCells * getBytesOfPlace();
    }

    /// \brief Finds a plan, or has make() make it, for which other threads wait that want the same.
    ///
    /// \param key   tells it
    /// \param size  what it takes in memory to make it
    template <typename MAKE>
    Plan Find(std::vector<int> const &key, std::size_t size, MAKE const &make) {
        std::shared_ptr<MadePlan> const plan = find(key, size);
        std::call_once(plan->once, [&] { plan->tessellation.emplace(make()); });
        return {plan, &*plan->tessellation};
    }

    /// Forgets what is too much.
    void Trim() {
        std::lock_guard<std::mutex> const lock(_mutex);
        makeRoom(0);
    }

private:
    // Faces of up to so many cells are never cut: so those whose points are made by matrices of the whole
    // face are not.
    static constexpr double kMaxLeavesOfFace = 8192;
    static constexpr std::size_t kMinLeaves = 4096;
    static constexpr std::size_t kMaxLeaves = std::size_t(1) << 24;

    // Bytes of the members of a plan, and of the heap's share of its arrays.
    static constexpr std::size_t kBytesOfPlan = 2048;

    struct MadePlan {
        std::once_flag once;
        std::optional<LevelTessellation> tessellation;
    };
    struct Entry {
        std::vector<int> key;
        std::shared_ptr<MadePlan> plan;
        std::size_t size;
    };

    // Bytes of each place, where facets are triangles: in the plan, and in the tessellation's data.
    std::size_t getBytesOfPlace() const {
        constexpr std::size_t kBytesOfCoord = sizeof(LeafPlaces::Place) + 2 * sizeof(double);
        return kBytesOfCoord + 8 * sizeof(int) + 2 * sizeof(int) + (_hasDerivatives ? 300 : 160);
    }

    // Whether a face that takes so much and has so many cells comes in sections.
    bool isCut(double size, double numLeaves) const {
        return numLeaves > kMaxLeavesOfFace && size > double(_maxMemory) / 4;
    }

    std::shared_ptr<MadePlan> find(std::vector<int> const &key, std::size_t size) {
        std::lock_guard<std::mutex> const lock(_mutex);
        auto const found = _places.find(key);
        if (found != _places.end()) {
            _plans.splice(_plans.begin(), _plans, found->second);
            return _plans.front().plan;
        }
        makeRoom(size);
        _plans.push_front({key, std::make_shared<MadePlan>(), size});
        try {
            _places.emplace(key, _plans.begin());
        } catch (...) {
            _plans.pop_front();
            throw;
        }
        _memory += size;
        return _plans.front().plan;
    }

    // For something of this size, as far as plans are not in use.
    void makeRoom(std::size_t size) {
        for (auto entry = _plans.end(); entry != _plans.begin() && _memory + size > _maxMemory;) {
            --entry;
            // It is given away under the lock alone, so that nobody can begin to use it meanwhile.
            if (entry->plan.use_count() == 1) {
                _memory -= entry->size;
                _places.erase(entry->key);
                entry = _plans.erase(entry);
            }
        }
    }

    bool const _hasDerivatives;
    std::size_t const _maxMemory;
    std::size_t _memory = 0;
    std::mutex _mutex;
    std::list<Entry> _plans; // the one that was asked for last comes first
    std::map<std::vector<int>, std::list<Entry>::iterator> _places;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
