// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_BFR_EXT_STREAM_PATCH_PLANS_H
#define OPENSUBDIVHEX_BFR_EXT_STREAM_PATCH_PLANS_H

#include "bfr_ext/cell/cellPlan.h"
#include "bfr_ext/cell/faceSections.h"
#include "bfr_ext/levelTessellation.h"

#include <atomic>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <unordered_map>
#include <vector>

namespace OpenSubdivHex::BfrExt::internal {

/// Key of plans.
struct PlanOptions {
    LevelTessellation::Options tessellation;
    bool hasDerivatives;
};

/// \brief Shared by patches with the same levels, or the same tree: their tessellation, with the
/// cells its places lie in.
struct PatchPlan {
    PatchPlan(FaceLevels const &ofFace, PlanOptions const &options)
        : tessellation(Parameterization(ofFace.shape), int(ofFace.levels.size()),
                       ofFace.levels.data(), options.tessellation) {}
    PatchPlan(FaceSections const &sections, int section, PlanOptions const &options)
        : tessellation(sections, section, options.tessellation) {}
    explicit PatchPlan(LevelTessellation ofFace) : tessellation(std::move(ofFace)) {}

    /// \brief About what it takes in memory to make the plan of some levels, with the plan itself.
    ///
    /// The cells in which the levels of edges take part are counted as if they had that of the inside;
    /// derivatives on an edge follow cells that are there for one or two of its points alone.
    static std::size_t GetSizeOfMaking(FaceLevels const &ofFace, bool hasDerivatives) {
        std::vector<int> const &levels = ofFace.levels;
        std::size_t const bytes = GetBytesOfPlace(hasDerivatives);
        std::size_t const bytesOnEdge = bytes + (hasDerivatives ? 700 : 0);
        std::size_t const numCells = (std::size_t(1) << (2 * levels.back())) / 3;
        std::size_t size = kBytesOfPlan + (levels.size() - 1) * (numCells + 2) * bytes;
        for (std::size_t edge = 0; edge + 1 < levels.size(); ++edge) {
            size += ((std::size_t(2) << levels[edge]) / 3 + 1) * bytesOnEdge;
        }
        return size;
    }

    /// Bytes of each place, where facets are triangles: in the plan, and in the tessellation's data.
    static constexpr std::size_t GetBytesOfPlace(bool hasDerivatives) {
        return kBytesOfCoord + 8 * sizeof(int) + 2 * sizeof(int) + (hasDerivatives ? 300 : 160);
    }

    /// Bytes of its further members, and of the heap's share of its arrays.
    static constexpr std::size_t kBytesOfPlan = 2048;

    LevelTessellation const tessellation;

private:
    // Its place, and its u and v.
    static constexpr std::size_t kBytesOfCoord = sizeof(LeafPlaces::Place) + 2 * sizeof(double);
};

/// \brief The plans that have been asked for.  Where they come to take too much memory, those that nobody
/// uses are forgotten, beginning with the one that was not asked for longest.  Any number of threads may
/// use it.
class PatchPlans {
public:
    PatchPlans(PlanOptions const &options, std::size_t maxMemory)
        : _options(options), _maxMemory(maxMemory) {}

    std::size_t GetMaxMemory() const { return _maxMemory; }
    /// PatchPlan::GetSizeOfMaking().
    std::size_t GetSizeOfMaking(FaceLevels const &levels) const {
        return PatchPlan::GetSizeOfMaking(levels, _options.hasDerivatives);
    }

    /// Whether a face that takes so much and has so many cells comes in sections.
    bool IsCut(double size, double numLeaves) const {
        return numLeaves > kMaxLeavesOfFace && size > double(_maxMemory) / 4;
    }
    /// Overload for a face with levels.
    bool IsCut(FaceLevels const &levels) const {
        return IsCut(double(GetSizeOfMaking(levels)), FaceSections::CountLeaves(levels));
    }
    /// Overload for a face with a tree.
    bool IsCut(CellTree const &tree) const {
        double const numLeaves = tree.GetNumLeaves();
        return IsCut(numLeaves * double(PatchPlan::GetBytesOfPlace(_options.hasDerivatives)),
                     numLeaves);
    }
    /// How many cells a section has at most.
    int GetMaxLeaves() const {
        std::size_t const wanted =
            _maxMemory / 8 / PatchPlan::GetBytesOfPlace(_options.hasDerivatives);
        return int(std::min(std::max(wanted, kMinLeaves), kMaxLeaves));
    }

    /// \brief Finds the plan of some levels, or makes it.
    ///
    /// Threads that want a plan wait for it, since it takes memory to make one.
    std::shared_ptr<PatchPlan const> Find(FaceLevels const &levels) {
        return find(levels.GetKey(), GetSizeOfMaking(levels),
                    [&] { return std::make_shared<PatchPlan const>(levels, _options); });
    }
    /// \brief The plan of a tree, whose tessellation makeTessellation() makes if there is none.
    ///
    /// Threads do not wait for each other: that of small trees takes little memory.
    ///
    /// \param key  tells the tree and the polylines
    template <typename MAKE>
    std::shared_ptr<PatchPlan const> Find(std::vector<int> const &key,
                                          MAKE const &makeTessellation) {
        {
            std::lock_guard<std::mutex> const lock(_mutex);
            if (std::shared_ptr<PatchPlan const> plan = look(key)) {
                return plan;
            }
        }
        auto plan = std::make_shared<PatchPlan const>(makeTessellation());
        std::size_t const size =
            PatchPlan::kBytesOfPlan + std::size_t(plan->tessellation.GetNumCoords()) *
                                          PatchPlan::GetBytesOfPlace(_options.hasDerivatives);
        std::lock_guard<std::mutex> const lock(_mutex);
        if (std::shared_ptr<PatchPlan const> other = look(key)) {
            return other;
        }
        makeRoom(size);
        return add(key, std::move(plan), size);
    }
    /// Whether the faces of a forest with such a tree are likely to be several.
    static bool IsShared(CellTree const &tree) { return tree.GetNumCells() <= kMaxCellsOfShared; }
    /// The plan of a section.
    std::shared_ptr<PatchPlan const> Find(FaceSections const &sections, int section) {
        std::vector<int> key = FaceLevels{sections.GetFaceShape(), sections.GetLevels()}.GetKey();
        key.push_back(-1 - section);
        std::size_t const bytes = PatchPlan::GetBytesOfPlace(_options.hasDerivatives);
        return find(key, std::size_t(GetMaxLeaves()) * bytes,
                    [&] { return std::make_shared<PatchPlan const>(sections, section, _options); });
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

    struct Hash {
        std::size_t operator()(std::vector<int> const &key) const {
            std::size_t hash = key.size();
            for (int const number : key) {
                hash = (hash ^ std::size_t(number)) * 0x9e3779b97f4a7c15;
                hash ^= hash >> 29;
            }
            return hash;
        }
    };
    struct Entry {
        std::vector<int> key;
        std::shared_ptr<PatchPlan const> plan;
        std::size_t size;
    };

    static constexpr int kMaxCellsOfShared = 128;

    // The plan of a key, or null.
    std::shared_ptr<PatchPlan const> look(std::vector<int> const &key) {
        auto const found = _places.find(key);
        if (found == _places.end()) {
            return nullptr;
        }
        _plans.splice(_plans.begin(), _plans, found->second);
        return _plans.front().plan;
    }

    std::shared_ptr<PatchPlan const> add(std::vector<int> const &key,
                                         std::shared_ptr<PatchPlan const> plan, std::size_t size) {
        _plans.push_front({key, std::move(plan), size});
        try {
            _places.emplace(key, _plans.begin());
        } catch (...) {
            _plans.pop_front();
            throw;
        }
        _memory += size;
        return _plans.front().plan;
    }

    // A key is the levels, and behind them -1 - section; or what tells a tree.
    template <typename MAKE>
    std::shared_ptr<PatchPlan const> find(std::vector<int> const &key, std::size_t sizeOfMaking,
                                          MAKE const &make) {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (std::shared_ptr<PatchPlan const> plan = look(key)) {
            return plan;
        }
        makeRoom(sizeOfMaking);
        return add(key, make(), sizeOfMaking);
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

    PlanOptions const _options;
    std::size_t const _maxMemory;
    std::size_t _memory = 0;
    std::mutex _mutex;
    std::list<Entry> _plans; // the one that was asked for last comes first
    std::unordered_map<std::vector<int>, std::list<Entry>::iterator, Hash> _places;
};

/// \brief Adds up what plans take in memory, each counted once, until it is more than there is.  Any
/// number of threads may add to it, each by a Counter of its own.
class PlanMemory {
public:
    explicit PlanMemory(PatchPlans const &plans) : _plans(plans) {}

    /// Whether all plans that were added have room.
    bool HasRoom() const { return _hasRoom; }

    /// Whether a face comes in sections, so that its plan is never kept as a whole.
    void SetCut() { _hasRoom = false; }

    /// Adds the plans that it is told of, and remembers them, so that few have to be looked up together.
    class Counter {
    public:
        explicit Counter(PlanMemory &memory) : _memory(memory) {}

        void Add(FaceLevels const &levels) {
            if (levels == _last || !_memory.HasRoom()) {
                return;
            }
            _last = levels;
            if (_known.insert(levels.GetKey()).second) {
                _memory.add(levels);
            }
        }

    private:
        PlanMemory &_memory;
        FaceLevels _last;
        std::set<std::vector<int>> _known;
    };

private:
    void add(FaceLevels const &levels) {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (_known.insert(levels.GetKey()).second) {
            _memory += _plans.GetSizeOfMaking(levels);
            if (_memory > _plans.GetMaxMemory() || _plans.IsCut(levels)) {
                _hasRoom = false;
            }
        }
    }

    PatchPlans const &_plans;
    std::size_t _memory = 0;
    std::atomic<bool> _hasRoom{true};
    std::mutex _mutex;
    std::set<std::vector<int>> _known;
};

} // namespace OpenSubdivHex::BfrExt::internal

#endif
