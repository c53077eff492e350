// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_TURNED_FACETS_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_TURNED_FACETS_H

#include "facets.h"
#include "surfaceFixture.h"

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief Counts facets that are *turned over*: whose area, along its normal, is against the mean of the
/// surface's normals at their vertices.
class TurnedFacets {
public:
    /// Adds those of the tessellation of a face, with its control points.
    void Add(BfrExt::Surface<double> const &surface, BfrExt::LevelTessellation const &tessellation,
             std::vector<double> const &control) {
        std::vector<double> p(3 * std::size_t(tessellation.GetNumCoords()));
        std::vector<double> du(p);
        std::vector<double> dv(p);
        surface.Evaluate(tessellation, control.data(), 3, p.data(), du.data(), dv.data(), 3);
        Add(tessellation, p, du, dv);
    }
    /// Overload for points and derivatives that are known, 3 numbers each.
    void Add(BfrExt::LevelTessellation const &tessellation, std::vector<double> const &p,
             std::vector<double> const &du, std::vector<double> const &dv) {
        for (std::vector<int> const &facet : GetFacets(tessellation)) {
            Vector3 normal = {};
            Vector3 area = {};
            Vector3 const first = get(p, facet[0]);
            for (std::size_t i = 0; i < facet.size(); ++i) {
                Vector3 const n = Cross(get(du, facet[i]), get(dv, facet[i]));
                if (GetLength(n) > 0) {
                    normal = Subtract(normal, Scale(n, -1 / GetLength(n)));
                }
                if (i + 1 < facet.size()) {
                    area = Subtract(area, Cross(Subtract(get(p, facet[i + 1]), first),
                                                Subtract(get(p, facet[i]), first)));
                }
            }
            _numTurned += Dot(area, normal) < 0;
            ++_numFacets;
        }
    }

    long GetNumFacets() const { return _numFacets; }
    /// How many of all facets are turned over, 0 ... 1.
    double GetShare() const { return double(_numTurned) / double(std::max(_numFacets, 1L)); }

    /// For the log.
    void Report(std::string const &facets) const {
        std::cout << _numTurned << " of " << _numFacets << " " << facets << " are turned over\n";
    }

private:
    static Vector3 get(std::vector<double> const &vectors, int place) {
        return ToVector(&vectors[3 * std::size_t(place)]);
    }

    long _numFacets = 0;
    long _numTurned = 0;
};

} // namespace OpenSubdivHex::Regression

#endif
