// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"

#include <opensubdiv/bfr/tessellation.h>

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

namespace Bfr = OpenSubdiv::Bfr;

namespace {

/// Tessellations of Bfr of all surfaces of a mesh, with a rate for each edge.
template <typename REAL>
class RatesChecker {
public:
    RatesChecker(MeshSurfaces<REAL> const &mesh, Dice &dice)
        : _mesh(mesh), _faces(mesh.factory->GetFaces()), _dice(dice) {
        for (int edge = 0; edge < _faces.GetNumEdges(); ++edge) {
            _rates.push_back(1 + dice.Roll(dice.IsOneOf(8) ? 40 : 9));
        }
        _boundaries.resize(std::size_t(_faces.GetNumFaces()));
    }

    void Check() {
        for (int face = 0; face < _faces.GetNumFaces(); ++face) {
            if (_mesh.Has(face)) {
                checkFace(face);
            }
        }
        for (int edge = 0; edge < _faces.GetNumEdges(); ++edge) {
            checkEdge(edge);
        }
    }

private:
    /// The points on the boundary of a face, and where its edges begin among them.
    struct Boundary {
        std::vector<REAL> points;
        std::vector<int> starts;
    };

    void checkFace(int face) {
        Boundary &boundary = _boundaries[std::size_t(face)];
        std::vector<int> rates;
        int numOnBoundary = 0;
        for (int local = 0; local < _faces.GetShape(face).size; ++local) {
            boundary.starts.push_back(numOnBoundary);
            rates.push_back(_rates[std::size_t(_faces.GetEdge(face, local).edge)]);
            numOnBoundary += rates.back();
        }
        if (_dice.IsOneOf(2)) {
            rates.push_back(1 + _dice.Roll(8)); // of the inside
        }
        BfrExt::Surface<REAL> const &surface = _mesh.surfaces[std::size_t(face)];
        Bfr::Tessellation const tessellation(surface.GetParameterization(), int(rates.size()),
                                             rates.data());
        int const numPlaces = tessellation.GetNumCoords();
        int const size = _mesh.pointSize;
        std::vector<REAL> p(std::size_t(size * numPlaces)), du(p), dv(p), alone(p);
        REAL const *const control = _mesh.GetControlPoints(face);
        surface.Evaluate(tessellation, control, size, alone.data(), size);
        surface.Evaluate(tessellation, control, size, p.data(), du.data(), dv.data(), size);
        if (p != alone) {
            Fail("the points of face ", face,
                 " at rates depend on whether derivatives are evaluated");
        }
        for (std::vector<REAL> const *const values : {&p, &du, &dv}) {
            if (!std::all_of(values->begin(), values->end(),
                             [](REAL x) { return std::isfinite(x); })) {
                Fail("face ", face, " has values at rates that are not finite");
            }
        }
        std::vector<REAL> coords(2 * std::size_t(numPlaces));
        tessellation.GetCoords(coords.data());
        constexpr int kNumPlaces = 6; // about so many are looked at
        for (int i = 0; i < numPlaces; ++i) {
            if (_dice.Roll(numPlaces) <= kNumPlaces) {
                checkPlace(face, &coords[2 * std::size_t(i)], &p[std::size_t(size * i)]);
            }
        }
        boundary.points.assign(p.begin(), p.begin() + std::ptrdiff_t(size) * numOnBoundary);
    }

    void checkPlace(int face, REAL const *uv, REAL const *point) const {
        Eigen::RowVectorXd const expected = _mesh.Evaluate(face, uv).row(0);
        // Both are a millionth away at most, as single precision is.
        double const allowed =
            _mesh.GetTolerance() + 1e-5 * std::max(1.0, GetSize(_mesh.values.levels[0]));
        for (int k = 0; k < _mesh.pointSize; ++k) {
            if (!(std::abs(double(point[k]) - expected[k]) <= allowed)) {
                Fail("face ", face, " at ", uv[0], ", ", uv[1], " has ", point[k],
                     " in a tessellation with rates, not ", expected[k]);
            }
        }
    }

    /// Both faces beside an edge have the same points there, to the bit.
    void checkEdge(int edge) const {
        FarExt::SurfaceFaces::Side const sides[2] = {_faces.GetSide(edge, 0),
                                                     _faces.GetSide(edge, 1)};
        if (!std::all_of(sides, sides + 2, [this](FarExt::SurfaceFaces::Side const &side) {
                return side.face >= 0 && _mesh.Has(side.face) && _mesh.IsJoined(side.face);
            })) {
            return;
        }
        int const rate = _rates[std::size_t(edge)];
        for (int i = 0; i <= rate; ++i) {
            REAL const *const point = findPoint(sides[0], i, rate);
            if (!std::equal(point, point + _mesh.pointSize, findPoint(sides[1], i, rate))) {
                Fail("faces ", sides[0].face, " and ", sides[1].face, " have other bits at ", i,
                     " of ", rate, " on edge ", edge);
            }
        }
    }
    /// Point \p i of an edge in its own direction.
    REAL const *findPoint(FarExt::SurfaceFaces::Side const &side, int i, int rate) const {
        Boundary const &boundary = _boundaries[std::size_t(side.face)];
        bool const isReversed = _faces.GetEdge(side.face, side.local).isReversed;
        int const numPoints = int(boundary.points.size()) / _mesh.pointSize;
        int const place =
            (boundary.starts[std::size_t(side.local)] + (isReversed ? rate - i : i)) % numPoints;
        return &boundary.points[std::size_t(place * _mesh.pointSize)];
    }

    MeshSurfaces<REAL> const &_mesh;
    FarExt::SurfaceFaces const &_faces;
    Dice &_dice;
    std::vector<int> _rates; // by edge
    std::vector<Boundary> _boundaries;
};

} // namespace

template <typename REAL>
void CheckRates(MeshSurfaces<REAL> const &mesh, Dice &dice) {
    RatesChecker<REAL>(mesh, dice).Check();
}

template void CheckRates(MeshSurfaces<float> const &, Dice &);
template void CheckRates(MeshSurfaces<double> const &, Dice &);

} // namespace OpenSubdivHex::Regression
