// SPDX-License-Identifier: Apache-2.0
#include "patchCycle.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::FarExt::internal {

namespace {

using Far::Index;

// The vertices of the parent patch, ascending, that rows of a step depend on.
std::vector<Index> findParents(PatchRefinement const &step, std::vector<Index> const &rows) {
    std::vector<Index> parents;
    for (Index row : rows) {
        auto const verts = step.verts.begin();
        parents.insert(parents.end(), verts + step.firsts[std::size_t(row)],
                       verts + step.firsts[std::size_t(row) + 1]);
    }
    SortUnique(parents);
    return parents;
}

// A step of vectors that have rows alone, which depend on parents.
PatchRefinement confine(PatchRefinement const &step, std::vector<Index> const &rows,
                        std::vector<Index> const &parents) {
    PatchRefinement result;
    result.numParentVerts = int(parents.size());
    result.firsts.push_back(0);
    for (Index row : rows) {
        for (int k = step.firsts[std::size_t(row)]; k < step.firsts[std::size_t(row) + 1]; ++k) {
            auto const place =
                std::lower_bound(parents.begin(), parents.end(), step.verts[std::size_t(k)]);
            result.verts.push_back(int(place - parents.begin()));
            result.weights.push_back(step.weights[std::size_t(k)]);
        }
        result.firsts.push_back(int(result.verts.size()));
    }
    return result;
}

// By a power of two, which changes no bits but those of exponents.
void scaleToOne(std::vector<double> &vector) {
    double largest = 0;
    for (double x : vector) {
        largest = std::max(largest, std::abs(x));
    }
    if (largest > 0) {
        double const factor = std::ldexp(1.0, -std::ilogb(largest));
        for (double &x : vector) {
            x *= factor;
        }
    }
}

} // namespace

std::vector<Index> PatchCycle::Confine(std::vector<Index> verts, bool isCorner) {
    _isCorner = isCorner;
    std::size_t numBefore = 0;
    std::vector<std::vector<Index>> vertsBySteps(_steps.size()); // before each of the steps
    while (verts.size() != numBefore) {
        numBefore = verts.size();
        if (int(numBefore) == _steps.front()->numParentVerts) {
            return verts;
        }
        std::vector<Index> const *rows = &verts;
        for (std::size_t i = _steps.size(); i-- > 0;) {
            vertsBySteps[i] = findParents(*_steps[i], *rows);
            rows = &vertsBySteps[i];
        }
        verts.insert(verts.end(), rows->begin(), rows->end());
        SortUnique(verts);
    }
    vertsBySteps.front() = verts;
    for (std::size_t i = 0; i < _steps.size(); ++i) {
        bool const isLast = i + 1 == _steps.size();
        _confined.push_back(
            confine(*_steps[i], isLast ? verts : vertsBySteps[i + 1], vertsBySteps[i]));
    }
    for (std::size_t i = 0; i < _steps.size(); ++i) {
        _steps[i] = &_confined[i];
    }
    return verts;
}

void PatchCycle::ApplyLeft(Vector &left) {
    for (auto step = _steps.rbegin(); step != _steps.rend(); ++step) {
        if (step != _steps.rbegin()) {
            if (_isCorner) {
                left[0] = 0;
            }
            scaleToOne(left);
        }
        (*step)->ApplyLeft(left, _scratch);
        left.swap(_scratch);
    }
}

void PatchCycle::ApplyRight(Vector &right) {
    for (auto step = _steps.begin(); step != _steps.end(); ++step) {
        if (step != _steps.begin()) {
            scaleToOne(right);
        }
        (*step)->ApplyRight(right, _scratch);
        right.swap(_scratch);
    }
}

} // namespace OpenSubdivHex::FarExt::internal
