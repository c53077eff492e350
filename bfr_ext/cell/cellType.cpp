// SPDX-License-Identifier: Apache-2.0
#include "cellType.h"

#include "plainFace.h"
#include "ringCell.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

namespace OpenSubdivHex::BfrExt::internal {

using namespace FarExt::internal;
using FarExt::CallStatus;
using FarExt::Interpolation;

namespace {

using Vector = std::vector<double>;

bool isSharp(LimitPatch const &patch) {
    auto const isNone = [](auto const &tags) {
        return std::all_of(tags.begin(), tags.end(), [](float tag) { return tag == 0; });
    };
    auto const isBoundary = [](int other) { return other < 0 && other != kFreeBoundary; };
    return !isNone(patch.edgeSharpness) || !isNone(patch.diagonalSharpness) ||
           !isNone(patch.vertSharpness) || !patch.nonManifoldVerts.empty() ||
           !patch.sharpVerts.empty() ||
           std::any_of(patch.otherCorners.begin(), patch.otherCorners.end(), isBoundary);
}

bool isInLattice(LimitPatch const &patch) {
    int const faceSize = patch.faceSizes[0];
    int const valence = CellType::GetLatticeValence(faceSize);
    auto const isSame = [&](int size) { return size == faceSize; };
    if (valence == 0 || !std::all_of(patch.faceSizes.begin(), patch.faceSizes.end(), isSame) ||
        isSharp(patch) || patch.HasCornerTags()) {
        return false;
    }
    // Vertices where the patch ends have fewer faces.
    std::vector<int> numFaces(patch.sources.size());
    std::vector<bool> isOuter(patch.sources.size());
    for (std::size_t corner = 0; corner < patch.faceVerts.size(); ++corner) {
        auto const vert = std::size_t(patch.faceVerts[corner]);
        ++numFaces[vert];
        if (patch.otherCorners[corner] < 0) {
            std::size_t const local = corner % std::size_t(faceSize);
            std::size_t const next =
                local + 1 == std::size_t(faceSize) ? corner - local : corner + 1;
            isOuter[vert] = true;
            isOuter[std::size_t(patch.faceVerts[next])] = true;
        }
    }
    for (std::size_t vert = 0; vert < numFaces.size(); ++vert) {
        if (isOuter[vert] ? numFaces[vert] >= valence : numFaces[vert] != valence) {
            return false;
        }
    }
    return true;
}

double dot(Vector const &a, Vector const &b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

// The factors of two vectors in the sums of them that come closest to the rows.
struct Projection {
    // False where the two vectors do not span a plane, or the rows do not turn in it as they do.
    bool Find(Vector const (&rows)[2], LimitMask::Tangents const &tangents) {
        double const uu = dot(tangents.du, tangents.du);
        double const uv = dot(tangents.du, tangents.dv);
        double const vv = dot(tangents.dv, tangents.dv);
        double const determinant = uu * vv - uv * uv;
        if (!(determinant > 1e-10 * uu * vv)) {
            return false;
        }
        for (std::size_t i = 0; i < 2; ++i) {
            double const u = dot(rows[i], tangents.du);
            double const v = dot(rows[i], tangents.dv);
            factors[i] = {(u * vv - v * uv) / determinant, (v * uu - u * uv) / determinant};
        }
        return factors[0][0] * factors[1][1] > factors[0][1] * factors[1][0];
    }

    double GetLength(std::size_t column) const {
        return std::hypot(factors[0][column], factors[1][column]);
    }

    Pair factors[2];
};

std::uint64_t takeNumber() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

} // namespace

CellType::CellType(CellTypes &types, CellPatch const &cell, std::string packed,
                   CellRules const &rules)
    : _types(types), _number(takeNumber()), _packedCell(std::move(packed)), _kind(cell.kind),
      _numCorners(cell.GetNumCorners()), _numPoints(int(cell.patch.sources.size())),
      _isInLattice(isInLattice(cell.patch)), _isSharp(isSharp(cell.patch)), _rules(rules),
      _patterns(types.GetMemory()) {}

void CellType::makeChildren(CellRefinement const *known) const {
    CellRefinement const own = known ? CellRefinement()
                                     : RefineCell(MakeCell(), _rules.sdcOptions,
                                                  _rules.hexSchemeOptions, _rules.interpolation);
    CellRefinement const &refinement = known ? *known : own;
    std::vector<Child> children;
    children.reserve(refinement.children.size());
    for (std::size_t i = 0; i < refinement.children.size(); ++i) {
        children.push_back(
            {&_types.Find(refinement.children[i], _rules), ChildStep(_step, refinement.rows[i])});
    }
    if (!children.empty()) {
        _step = StepMatrix(refinement.step);
    }
    _children = std::move(children);
    GetMemory().Add(GetHeapSizes(_children, _step));
}

bool CellType::IsRegular() const {
    std::vector<Child> const &children = GetChildren();
    return std::all_of(children.begin(), children.end(),
                       [&](Child const &child) { return child.type == this; });
}

std::vector<Vector> const &CellType::GetCornerPoints() const {
    std::call_once(_oncePoints, [&] {
        std::vector<Vector> points;
        if (_rules.interpolation == Interpolation::Varying) {
            // Vertices stay.
            for (Far::Index const vert : MakeCell().corners) {
                points.emplace_back(std::size_t(GetNumPoints()));
                points.back()[std::size_t(vert)] = 1;
            }
        } else {
            for (CornerLimit &limit : _types.FindLimits(MakeCell(), _rules)) {
                points.push_back(std::move(limit.weights));
            }
        }
        _points = std::move(points);
        GetMemory().Add(internal::GetHeapSize(_points));
    });
    return _points;
}

// Those at a corner; none of edges and vertices, of data that have kinks, and where there is no limit.
std::optional<LimitMask::Tangents> CellType::findTangents(int corner) const {
    if (_rules.interpolation == Interpolation::Varying || (!IsWhole() && _kind != CellKind::Half)) {
        return {};
    }
    CellPatch cell = MakeCell();
    cell.corners = {cell.corners[std::size_t(corner)]};
    std::vector<CornerLimit> limits = _types.FindLimits(cell, _rules);
    return limits.empty() ? std::nullopt : std::optional(std::move(limits[0].tangents));
}

// The derivatives at a corner, from the edges there of the cell that has it \p numSteps steps on.
void CellType::findDifferences(int corner, int numSteps, Vector (&result)[2]) const {
    CellType const *type = this;
    CellMap map = {{{1, 0}, {0, 1}}, {0, 0}};
    std::vector<ChildStep const *> steps;
    for (int i = 0; i < numSteps; ++i) {
        CornerChild const next = FindCornerChild(type->GetShape(), corner);
        Child const &child = type->GetChildren()[next.child];
        map = Concatenate(map, *next.map);
        corner = next.corner;
        steps.push_back(&child.step);
        type = child.type;
    }
    // For a half cell, at an end of its long edge.
    std::vector<Vector> const &points = type->GetCornerPoints();
    auto &[along, across] = result;
    along.resize(points[0].size());
    across.resize(points[0].size());
    for (std::size_t i = 0; i < along.size(); ++i) {
        along[i] = points[1][i] - points[0][i];
        across[i] = corner == 0 ? 2 * (points[3][i] - points[0][i]) - 0.5 * along[i]
                                : 2 * (points[2][i] - points[1][i]) + 0.5 * along[i];
    }
    Vector scratch;
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
        for (Vector &left : result) {
            (*step)->ApplyLeft(left, scratch);
            left.swap(scratch);
        }
    }
    map.TurnDerivatives(result);
}

// The derivatives that the cell before the last has.
//
// Differences tend to sums of the masks of the tangents, with factors that tend to those of the
// derivatives; or grow or shrink by a rate that each step makes, where there are no derivatives: then
// that is taken off.  Where they tend to nothing of the kind, as at some tips of cones, there is no
// tangent plane, and they are taken as they are.
CellType::Derivatives CellType::findEarlierDerivatives(int corner) const {
    // Sharp features alternate, so that two steps make a rate; those of the parent's parent are two more.
    constexpr int kSteps = 22;
    constexpr int kStepsAlone = 5;
    constexpr double kLeastRate = 1e-4; // of two steps; less is what convergence leaves
    Derivatives derivatives;
    Vector(&result)[2] = derivatives.rows;
    std::optional<LimitMask::Tangents> const tangents = findTangents(corner);
    if (tangents) {
        findDifferences(corner, kSteps - 2, result);
    }
    Projection last;
    Projection before;
    if (!tangents || !last.Find(result, *tangents)) {
        findDifferences(corner, kStepsAlone, result);
        return derivatives;
    }
    findDifferences(corner, kSteps - 4, result);
    before.Find(result, *tangents);
    Pair scales;
    for (std::size_t column = 0; column < 2; ++column) {
        double const rate = last.GetLength(column) / before.GetLength(column);
        bool const isRate = std::abs(rate - 1) > kLeastRate && std::isnormal(rate);
        scales[column] = isRate ? std::pow(rate, -kSteps / 2) : 1;
    }
    for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t i = 0; i < result[k].size(); ++i) {
            result[k][i] = scales[0] * last.factors[k][0] * tangents->du[i] +
                           scales[1] * last.factors[k][1] * tangents->dv[i];
        }
    }
    return derivatives;
}

// Those of the child that has the corner, by the coordinates of this cell.
CellType::Derivatives const &CellType::GetDerivatives(int corner, StencilOf of,
                                                      bool areParents) const {
    int const key[3] = {corner, int(of), int(areParents)};
    constexpr int kKind = PatternTable::GetKind<double>(PatternOf::Derivatives);
    return _patterns.Get<Derivatives>(kKind, key, key + 3, [&] {
        CornerChild const next = FindCornerChild(GetShape(), corner);
        Child const &child = GetChildren()[next.child];
        Derivatives ofChild =
            areParents ? child.type->findEarlierDerivatives(next.corner)
                       : child.type->GetDerivatives(next.corner, StencilOf::Points, true);
        next.map->TurnDerivatives(ofChild.rows);
        Derivatives result;
        for (std::size_t k = 0; k < 2; ++k) {
            if (of == StencilOf::Step) {
                child.step.Spread(ofChild.rows[k], result.rows[k]);
            } else {
                child.step.ApplyLeft(ofChild.rows[k], result.rows[k]);
            }
        }
        return result;
    });
}

CellType::BorderItem const &CellType::GetBorderItem(int const *turns, std::size_t item) const {
    return FindBorderItem(_patterns, turns, item, [&] {
        std::vector<CellPatch> const patches = GatherBorder(MakeCell(), turns, _rules.sdcOptions);
        std::vector<BorderItem> items;
        items.reserve(patches.size());
        for (CellPatch const &patch : patches) {
            CellType const &type = _types.Find(patch, _rules);
            RingItem const &rings = RingItem::Get(type, patch, _types.GetRingCells(_rules));
            std::size_t const i = items.size();
            items.push_back({&type, patch.patch.sources, i < patches.size() / 2 && turns[i] == 1,
                             rings.cell ? &rings : nullptr});
        }
        return items;
    });
}

std::vector<double> CellType::FindPatchPoints(PatchAges const &ages) const {
    std::vector<double> rows;
    CallStatus status;
    _types.UseMaskFinder(_rules, [&](LimitMaskFinder &finder) {
        status = FindCellPatchPoints(MakeCell(), finder, _rules.interpolation, ages, rows);
    });
    if (!status.IsOk()) {
        FaceCells const cells = MakeFaceCells({GetNumCorners(), _kind != CellKind::Whole});
        rows.assign(std::size_t(cells.GetNumPatches()) * std::size_t(kNumPatchPoints) *
                        std::size_t(GetNumPoints()),
                    std::numeric_limits<double>::quiet_NaN());
    }
    return rows;
}

MemoryCount &CellType::GetMemory() const { return _types.GetMemory(); }

// Data by rules, besides the types of cells.
struct CellTypes::OfRules {
    struct Finder {
        explicit Finder(CellRules const &rules) : masks(rules.sdcOptions, rules.hexSchemeOptions) {}

        LimitMaskFinder masks;
        int numUses = 0;
    };

    OfRules(CellTypes &types, CellRules const &rules)
        : ringCells(types, rules), plainFaces(types, ringCells) {}

    RingCells ringCells;
    PlainFaceTypes plainFaces;
    std::vector<std::unique_ptr<Finder>> finders; // that no thread uses
};

CellTypes::CellTypes(std::shared_ptr<MemoryCount::Total> memory) : _memory(std::move(memory)) {}
CellTypes::~CellTypes() = default;

void CellTypes::addRules(CellRules const &rules, Key &key) {
    for (int const number : {int(rules.sdcOptions.GetVtxBoundaryInterpolation()),
                             int(rules.sdcOptions.GetCreasingMethod()),
                             int(rules.hexSchemeOptions.faceMask), int(rules.interpolation)}) {
        PackNumber(number, key);
    }
}

CellType const &CellTypes::Find(CellPatch const &cell, CellRules const &rules) {
    static thread_local Key key;
    key.clear();
    PackCell(cell, key);
    addRules(rules, key);
    std::size_t const hash = std::hash<Key>()(key);
    auto const isSame = [&](Entry const &entry) { return entry.type.GetPackedCell() == key; };
    if (Entry const *const found = _types.Find(hash, isSame)) {
        return found->type;
    }
    std::size_t const size = decltype(_types)::kEntrySize + key.size();
    auto const [entry, isNew] = _types.Add(
        std::unique_ptr<Entry const>(new Entry{hash, {*this, cell, key, rules}}), isSame);
    if (isNew) {
        ++_numTypes;
        _memory.Add(size);
    }
    return entry->type;
}

auto CellTypes::getRules(CellRules const &rules) -> OfRules & {
    std::lock_guard<std::mutex> const lock(_mutex);
    Key key;
    addRules(rules, key);
    std::unique_ptr<OfRules> &ofRules = _rules[key];
    if (!ofRules) {
        ofRules = std::make_unique<OfRules>(*this, rules);
    }
    return *ofRules;
}

PlainFaceTypes &CellTypes::GetPlainFaces(CellRules const &rules) {
    return getRules(rules).plainFaces;
}

RingCells &CellTypes::GetRingCells(CellRules const &rules) { return getRules(rules).ringCells; }

void CellTypes::UseMaskFinder(CellRules const &rules,
                              std::function<void(LimitMaskFinder &)> const &use) {
    // Types keep what they get: a finder need not remember more than a mesh's usual cells.
    constexpr int kMaxUses = 512;
    OfRules &ofRules = getRules(rules);
    std::unique_ptr<OfRules::Finder> finder;
    {
        std::lock_guard<std::mutex> const lock(_mutex);
        if (!ofRules.finders.empty()) {
            finder = std::move(ofRules.finders.back());
            ofRules.finders.pop_back();
        }
    }
    if (!finder) {
        finder = std::make_unique<OfRules::Finder>(rules);
    }
    use(finder->masks);
    if (++finder->numUses < kMaxUses) {
        std::lock_guard<std::mutex> const lock(_mutex);
        ofRules.finders.push_back(std::move(finder));
    }
}

std::vector<CornerLimit> CellTypes::FindLimits(CellPatch const &cell, CellRules const &rules) {
    std::vector<CornerLimit> limits;
    UseMaskFinder(rules, [&](LimitMaskFinder &finder) { limits = FindCornerLimits(cell, finder); });
    return limits;
}

std::size_t CellTypes::GetSize() const {
    std::lock_guard<std::mutex> const lock(_mutex);
    std::size_t size = _numTypes;
    for (auto const &[key, ofRules] : _rules) {
        size += ofRules->plainFaces.GetNumUnmade();
    }
    return size;
}

} // namespace OpenSubdivHex::BfrExt::internal
