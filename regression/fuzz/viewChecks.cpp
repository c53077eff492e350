// SPDX-License-Identifier: Apache-2.0
#include "meshSurfaces.h"

#include "bfr_ext/view.h"
#include "regression/bfr_ext/facePlaces.h"
#include "regression/bfr_ext/picture.h"

#include <cmath>
#include <limits>

namespace OpenSubdivHex::Regression {

using BfrExt::Camera;
using BfrExt::CellForest;
using BfrExt::CellTree;
using BfrExt::CellVisibility;
using BfrExt::View;
using BfrExt::ViewBounds;

namespace {

using Coords = std::array<double, 2>;

double rollNumber(Dice &dice) { return dice.Roll(1 << 20) / double(1 << 19) - 1; }

/// Around the mesh, or within it.
Camera makeCamera(Dice &dice) {
    double const distance = dice.IsOneOf(2) ? 1 : 6;
    Camera camera;
    for (int k = 0; k < 3; ++k) {
        camera.eye[k] = distance * rollNumber(dice);
        camera.target[k] = rollNumber(dice);
        camera.up[k] = rollNumber(dice);
    }
    camera.fieldOfView = 60 + 50 * rollNumber(dice);
    camera.width = 1 + dice.Roll(300);
    camera.height = 1 + dice.Roll(300);
    return camera;
}

View::Options makeOptions(Dice &dice) {
    View::Options options;
    bool const hasFlatness = !dice.IsOneOf(4);
    options.SetFlatness(hasFlatness ? 1.6 + 1.5 * rollNumber(dice) : 0);
    options.SetEdgeLength(hasFlatness && dice.IsOneOf(2) ? 0 : 40 + 38 * rollNumber(dice));
    return options.SetMaxLevel(dice.Roll(5)).SetCulling(dice.IsOneOf(2));
}

/// Calls function(cell, corners) for all cells of a tree that are not refined, with the coordinates of
/// their corners.
template <typename FUNCTION>
void forLeaves(CellTree const &tree, int cell, std::vector<Coords> const &corners,
               FUNCTION const &function) {
    if (!tree.IsRefined(cell)) {
        function(cell, corners);
        return;
    }
    std::size_t const numCorners = corners.size();
    // The centre of a half cell, and of half a polygon, is in the middle of its long edge.
    bool const hasLongEdge = !tree.IsWhole(cell) || tree.GetFaceShape().isHalf;
    std::size_t const numAroundCenter = hasLongEdge ? 2 : numCorners;
    Coords center = {};
    for (std::size_t i = 0; i < numAroundCenter; ++i) {
        center[0] += corners[i][0] / double(numAroundCenter);
        center[1] += corners[i][1] / double(numAroundCenter);
    }
    std::vector<Coords> inner;
    for (Coords const &corner : corners) {
        inner.push_back({(corner[0] + center[0]) / 2, (corner[1] + center[1]) / 2});
    }
    int child = tree.GetFirstChild(cell);
    forLeaves(tree, child, inner, function);
    for (std::size_t i = hasLongEdge ? 1 : 0; i < numCorners; ++i) {
        std::size_t const next = (i + 1) % numCorners;
        forLeaves(tree, ++child, {corners[i], corners[next], inner[next], inner[i]}, function);
    }
}

/// A place in a cell.
Coords rollPlace(std::vector<Coords> const &corners, Dice &dice) {
    std::vector<double> weights;
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        weights.push_back(rollNumber(dice) + 1 + 1e-9);
        sum += weights.back();
    }
    Coords place = {};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        place[0] += weights[i] / sum * corners[i][0];
        place[1] += weights[i] / sum * corners[i][1];
    }
    return place;
}

/// The surface in the cells of a face's tree, at some places of each.
class TreeCheck {
public:
    TreeCheck(MeshSurfaces<double> const &mesh, View const &view, int face, Dice &dice)
        : _mesh(mesh), _view(view), _picture(view.GetCamera()), _face(face), _dice(dice) {}

    void Check(CellTree const &tree, std::vector<CellVisibility> const &visibilities) {
        std::vector<Coords> corners(std::size_t(tree.GetFaceSize()));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            _mesh.factory->GetFaceParameterization(_face).GetVertexCoord(int(i), corners[i].data());
            corners[i] = ToPlane(tree.GetFaceSize(), corners[i].data());
        }
        forLeaves(tree, 0, corners, [&](int cell, std::vector<Coords> const &ofCell) {
            if (!_dice.IsOneOf(1 + tree.GetNumLeaves() / 10)) {
                return;
            }
            if (visibilities[std::size_t(cell)] != CellVisibility::Visible) {
                checkIsNotSeen(cell, ofCell);
            } else if (_view.GetOptions().GetFlatness() > 0 &&
                       tree.GetLevel(cell) < _view.GetOptions().GetMaxLevel()) {
                checkIsFlat(cell, ofCell);
            }
        });
    }

private:
    static constexpr int kNumPlaces = 4;

    // At a place in the plane of the face.
    SurfacePoint evaluate(Coords const &place) const {
        int const size = _mesh.factory->GetFaceParameterization(_face).GetFaceSize();
        Coords const uv = FromPlane(size, place);
        ReferenceValues const values = _mesh.Evaluate(_face, uv.data());
        auto const row = [&](int i) { return Vector3{values(i, 0), values(i, 1), values(i, 2)}; };
        return {row(0), row(1), row(2)};
    }

    void checkIsNotSeen(int cell, std::vector<Coords> const &corners) {
        for (int i = 0; i < kNumPlaces; ++i) {
            SurfacePoint const at = evaluate(rollPlace(corners, _dice));
            Vector3 const toEye = Subtract(ToVector(_view.GetCamera().eye), at.p);
            if (_picture.HasPoint(at.p) && Dot(Cross(at.du, at.dv), toEye) > 0) {
                Fail("cell ", cell, " of face ", _face, " is culled and seen");
            }
        }
    }

    void checkIsFlat(int cell, std::vector<Coords> const &corners) {
        Vector3 const first = evaluate(corners[0]).p;
        Vector3 area = {};
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            Vector3 const part = Cross(Subtract(evaluate(corners[i]).p, first),
                                       Subtract(evaluate(corners[i + 1]).p, first));
            area = Subtract(area, Scale(part, -1));
        }
        if (GetLength(area) < 1e-9) {
            return;
        }
        Vector3 const normal = Normalize(area);
        for (int i = 0; i < kNumPlaces; ++i) {
            Vector3 const p = evaluate(rollPlace(corners, _dice)).p;
            Vector3 const foot = Subtract(p, Scale(normal, Dot(normal, Subtract(p, first))));
            double const pixels = _picture.GetDistance(p, foot);
            if (_picture.HasPoint(p) && !(pixels <= 1.0001 * _view.GetOptions().GetFlatness())) {
                Fail("the surface is ", pixels, " pixels from cell ", cell, " of face ", _face,
                     ", and not ", _view.GetOptions().GetFlatness());
            }
        }
    }

    MeshSurfaces<double> const &_mesh;
    View const &_view;
    Picture const _picture;
    int const _face;
    Dice &_dice;
};

bool haveSameCells(CellTree const &a, CellTree const &b) {
    bool areSame = a.GetFaceSize() == b.GetFaceSize() && a.GetNumCells() == b.GetNumCells();
    for (int cell = 0; areSame && cell < a.GetNumCells(); ++cell) {
        areSame = a.GetFirstChild(cell) == b.GetFirstChild(cell);
    }
    return areSame;
}

void compareForests(CellForest const &kept, CellForest const &found, int numEdges) {
    for (int face = 0; face < found.GetNumFaces(); ++face) {
        if (!haveSameCells(kept.GetTree(face), found.GetTree(face))) {
            Fail("a view has another tree of face ", face, " with bounds that were kept");
        }
    }
    for (int edge = 0; edge < numEdges; ++edge) {
        if (kept.GetPolyline(edge) != found.GetPolyline(edge)) {
            Fail("a view has another polyline of edge ", edge, " with bounds that were kept");
        }
    }
}

/// Frames whose points move, with numbers that are none among them.
void checkFrames(MeshSurfaces<double> const &mesh, Dice &dice) {
    ViewBounds::Options boundsOptions;
    if (dice.IsOneOf(2)) {
        boundsOptions.SetMaxMemory(std::size_t(dice.Roll(200000)));
    }
    ViewBounds bounds(*mesh.factory, boundsOptions);
    std::vector<double> points = mesh.points;
    std::unique_ptr<CellForest> last;
    for (int frame = 0; frame < 4; ++frame) {
        for (int i = dice.Roll(4); i > 0 && frame > 0; --i) {
            points[std::size_t(dice.Roll(int(points.size())))] = 2 * rollNumber(dice);
        }
        if (dice.IsOneOf(10)) {
            constexpr double kWrong[] = {std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity(), 1e300, 1e-300};
            points[std::size_t(dice.Roll(int(points.size())))] = kWrong[dice.Roll(4)];
        }
        View const view(makeCamera(dice), makeOptions(dice));
        CellForest const *const previous = dice.IsOneOf(2) ? last.get() : nullptr;
        auto const kept = view.MakeForest<double>(bounds, points.data(), 3, previous);
        auto const found = view.MakeForest<double>(*mesh.factory, points.data(), 3, previous);
        compareForests(kept, found, mesh.factory->GetFaces().GetNumEdges());
        if (bounds.GetMemory() > boundsOptions.GetMaxMemory()) {
            Fail("bounds take ", bounds.GetMemory(), " bytes of ", boundsOptions.GetMaxMemory());
        }
        last = std::make_unique<CellForest>(found);
    }
}

} // namespace

void CheckViews(MeshSurfaces<double> const &mesh, Dice &dice) {
    for (int i = 0; i < 4; ++i) {
        View const view(makeCamera(dice), makeOptions(dice));
        if (!view.IsValid()) {
            Fail("a view is not valid");
        }
        View::Counts counts;
        auto const forest =
            view.MakeForest<double>(*mesh.factory, mesh.points.data(), 3, nullptr, &counts);
        for (int face = 0; face < forest.GetNumFaces(); ++face) {
            if (mesh.Has(face)) {
                TreeCheck(mesh, view, face, dice)
                    .Check(forest.GetTree(face), counts.visibilities[std::size_t(face)]);
            }
        }
        if (i == 0) {
            CheckForest(mesh, forest, dice);
        }
    }
    checkFrames(mesh, dice);
}

} // namespace OpenSubdivHex::Regression
