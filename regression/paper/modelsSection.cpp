// SPDX-License-Identifier: Apache-2.0
//
// Reflection lines of whole models, with the masks of this library and those of others.
#include "meshes.h"
#include "picture.h"
#include "schemes.h"
#include "sections.h"

#include <algorithm>

namespace OpenSubdivHex::Regression {

namespace {

namespace Sdc = OpenSubdiv::Sdc;

struct Model {
    std::string name;
    Shape shape;
    bool isTriangles; ///< nearly all of it
    Tools::View view;
};

/// One of the catalogue, which may not have it, or of the tutorials.
Model findModel(char const *name, Tools::View const &view, char const *other,
                Tools::View const &otherView, bool isTriangles) {
    for (Shape const &shape : GetShapes()) {
        if (shape.name == name) {
            Model model = {name, shape, isTriangles, view};
            // They come with the second axis up.
            for (std::size_t i = 0; i < shape.positions.size(); i += 3) {
                std::rotate_copy(shape.positions.begin() + std::ptrdiff_t(i),
                                 shape.positions.begin() + std::ptrdiff_t(i) + 2,
                                 shape.positions.begin() + std::ptrdiff_t(i) + 3,
                                 model.shape.positions.begin() + std::ptrdiff_t(i));
            }
            return model;
        }
    }
    return {other, LoadTutorialMesh(other), isTriangles, otherView};
}

/// Each face of more sides cut into triangles, for Loop.
Shape makeTriangles(Shape const &shape) {
    Shape result;
    result.name = shape.name;
    result.positions = shape.positions;
    std::size_t first = 0;
    for (int const size : shape.faceSizes) {
        for (std::size_t i = 2; i < std::size_t(size); ++i) {
            result.faceSizes.push_back(3);
            result.faceVertices.insert(result.faceVertices.end(),
                                       {shape.faceVertices[first],
                                        shape.faceVertices[first + i - 1],
                                        shape.faceVertices[first + i]});
        }
        first += std::size_t(size);
    }
    return result;
}

/// At most \p level, and some 300 000 faces.
int limitLevel(Shape const &shape, int level) {
    double numFaces = shape.GetNumCorners() / 2.0; // hexagons at level 1, and four times at each
    int result = 1;
    while (result < level && numFaces < 75000) {
        numFaces *= 4;
        ++result;
    }
    return result;
}

} // namespace

void AddModelSection(Page *page, Settings const &settings) {
    page->BeginSection("models", "Whole models");
    page->AddParagraph(
        "Reflection lines break where normals do, bend sharply where curvature "
        "jumps, and waver where it is uneven.  Smooth has masks of its own around "
        "vertices with four faces or more and beside quads; the first pictures show "
        "it without them.  Where Suzanne and Spot are not at hand, two meshes of the tutorials "
        "stand for them.");
    Sdc::Options options;
    options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    for (Model const &model : {findModel("suzanne", {30, 10, 1}, "ring", {20, 35, 1}, false),
                               findModel("spot", {110, 15, 1}, "triangles", {20, 35, 1}, true)}) {
        int const level = limitLevel(model.shape, std::max(1, settings.maskLevel - 1));
        Shape shape = model.shape;
        shape.fvarChannels.clear();
        PictureOptions picture;
        picture.view = model.view;
        picture.look = Tools::SurfaceLook::Zebra;
        std::vector<std::string> pictures;
        auto const add = [&](char const *name, std::vector<SurfaceLevel> const &levels) {
            pictures.push_back(
                Captioned(DrawMesh(levels.back().mesh, levels[0].mesh, picture, settings), name));
        };
        auto const refine = [&](Shape const &mesh, AnyScheme const &scheme) {
            return RefineSurface(mesh, scheme, level, MeshCenter(), options);
        };
        add("Smooth, one mask for all hexagons", RefineWithOneMask(shape, level, options));
        if (model.isTriangles) {
            add("Smooth, truncate first", refine(shape, MakeTruncateFirst(FaceMask::Smooth)));
        } else {
            add("Smooth", refine(shape, MakeHexagonal(FaceMask::Smooth)));
        }
        add("Catmull-Clark", refine(shape, Sdc::SCHEME_CATMARK));
        add("Loop", refine(makeTriangles(shape), Sdc::SCHEME_LOOP));
        page->AddFigure(pictures, 2,
                        "Reflection lines of " + model.name + ", level " + std::to_string(level) +
                            (model.isTriangles ? "." : "; for Loop, faces are cut in triangles."));
    }
}

} // namespace OpenSubdivHex::Regression
