// SPDX-License-Identifier: Apache-2.0
#include "rows.h"

#include <stdexcept>
#include <utility>

namespace OpenSubdivHex::Regression {

std::vector<Row> const &GetRows() {
    static std::vector<Row> const kRows = [] {
        std::vector<Row> result = {
            {"base-descriptor-1", "base level from a descriptor, 1 thread",
             "Far::TopologyRefinerFactory", 3, 6},
            {"base-descriptor-2", "base level from a descriptor, 2 threads",
             "Far::TopologyRefinerFactory", 5, 8},
            {"base-mesh-1", "base level from a mesh class, 1 thread", "Far::TopologyRefinerFactory",
             3, 6},
            {"base-refiner-1", "base level from a refiner, 1 thread",
             "Far::TopologyRefinerFactory, which made that", 4, 6},
            {"base-channel-1", "base level with texture coordinates, 1 thread",
             "Far::TopologyRefinerFactory", 1, 2},
            {"base-channel-2", "base level with texture coordinates, 2 threads",
             "Far::TopologyRefinerFactory", 1.8, 3.6},
            {"topology-full", "topology, full last level, 1 thread",
             "Far::TopologyRefiner, full last level", 5, 10},
            {"topology-faces", "topology, face-vertices, 1 thread", "Far::TopologyRefiner", 8, 15},
            {"positions-cgal", "topology and positions, 1 thread", "CGAL DooSabin_subdivision", 15,
             30},
            {"positions-openmesh", "topology and positions, 1 thread", "OpenMesh CatmullClarkT", 12,
             30},
            {"table-1", "table, per weight, 1 thread", "Far::StencilTableFactory", 5, 8},
            {"table-2", "table, per weight, 2 threads", "Far::StencilTableFactory", 9, 15},
            {"table-peak", "peak memory / size of the table", "(Far::StencilTableFactory)", 1.4,
             1.15, true}};
        struct Length {
            int length;
            double atLeast;
            double aim;
        };
        for (auto const &[length, atLeast, aim] : {Length{3, 6, 8}, {4, 2.5, 3.5}, {8, 4.5, 6}}) {
            std::string const suffix = "length" + std::to_string(length);
            std::string const work = "evaluation, length " + std::to_string(length);
            result.push_back(
                {"evaluation-1-" + suffix, work + ", 1 thread", "Osd::CpuEvaluator", atLeast, aim});
            result.push_back({"evaluation-2-" + suffix, work + ", 2 threads",
                              "Osd::OmpEvaluator, 2 threads", 12, 25});
            result.push_back(
                {"evaluation-2-cpu-" + suffix, work + ", 2 threads", "Osd::CpuEvaluator", 12, 25});
            result.push_back(
                {"evaluation-2-own-" + suffix, work + ", 2 threads", "own, 1 thread", 1.8, 1.8});
            result.push_back({"evaluation-compact-" + suffix, work + ", compact table, 1 thread",
                              "own, table as it is", 1, 1.5});
        }
        result.push_back(
            {"table-free-1", "table-free, all levels, 1 thread", "own best table", 3, 5});
        result.push_back({"table-free-2", "table-free, all levels, 2 threads",
                          "own best table, 2 threads", 3, 5});
        result.push_back({"smooth-table-free", "table-free by Smooth, all levels, 1 thread",
                          "own, by Average", 0.95, 1});
        result.push_back(
            {"smooth-table", "table by Smooth, per weight, 1 thread", "own, by Average", 0.95, 1});
        result.push_back({"limit-table-own", "limit table, per weight, 1 thread",
                          "own, table of the level", 0.5, 1});
        result.push_back({"limit-table-1", "limit table, per weight, 1 thread",
                          "Far::LimitStencilTableFactory", 1, 2});
        result.push_back({"limit-table-2", "limit table, per weight, 2 threads",
                          "Far::LimitStencilTableFactory", 1.8, 3.6});
        result.push_back({"limit-evaluation-own", "limit with derivatives, table-free, 1 thread",
                          "own, level alone", 0.4, 0.5});
        result.push_back({"limit-evaluation-table", "limit with derivatives, table-free, 1 thread",
                          "own limit table", 1, 3});
        result.push_back({"patches-in-order",
                          "patches, points and first derivatives, in order, 1 thread",
                          "Osd::CpuEvaluator", 4, 8});
        result.push_back({"patches-random",
                          "patches, points and first derivatives, in random order, 1 thread",
                          "Osd::CpuEvaluator", 2, 4});
        result.push_back({"surface-points", "tessellated surfaces, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 8, 15});
        result.push_back({"surface-places",
                          "places of surfaces with derivatives, in random order, 1 thread",
                          "Bfr::Surface::Evaluate", 1, 2});
        result.push_back({"surface-patch-points", "patch points of surfaces, per face, 1 thread",
                          "Bfr::Surface::PreparePatchPoints", 0.5, 1});
        result.push_back({"surface-stencils", "tessellated surfaces, per point, 1 thread",
                          "Bfr::Surface, one face's stencils kept", 4, 8});
        result.push_back({"stream-1", "streamed surfaces, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 8, 15});
        result.push_back({"stream-stencils", "streamed surfaces, per point, 1 thread",
                          "Bfr::Surface, one face's stencils kept", 4, 8});
        result.push_back(
            {"stream-2", "streamed surfaces, per point, 2 threads", "own, 1 thread", 1.85, 1.95});
        result.push_back({"surface-derivatives",
                          "tessellated surfaces with derivatives, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 8, 15});
        result.push_back({"surface-rate", "surfaces tessellated at rate 8, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 3, 6});
        result.push_back({"surface-rate-regular",
                          "regular surfaces tessellated at rate 8, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 6, 12});
        result.push_back({"surface-rate-derivatives",
                          "surfaces tessellated at rate 8, with derivatives, per point, 1 thread",
                          "Bfr::Surface::Evaluate", 2, 4});
        result.push_back({"surface-cold", "making surfaces, empty cache, per face, 1 thread",
                          "Bfr::RefinerSurfaceFactory", 3, 10});
        result.push_back({"surface-warm", "making surfaces, full cache, per face, 1 thread",
                          "Bfr::RefinerSurfaceFactory", 5, 10});
        result.push_back(
            {"surface-evaluation-cold",
             "making and evaluating surfaces, empty cache, level 3, per point, 1 thread",
             "Bfr::Surface::Evaluate, the same", 1, 3});
        result.push_back({"view", "surfaces for a camera, with their points, 1 thread",
                          "own, uniform level that is as close", 1, 4});
        result.push_back({"view-bounds",
                          "surfaces for a further camera, bounds kept, with their points, 1 thread",
                          "own, uniform level that is as close", 1, 4});
        result.push_back({"view-next",
                          "surfaces for a further camera, bounds kept, with points of faces that "
                          "change, 1 thread",
                          "own, uniform level that is as close", 5, 10});
        // Types at such a vertex have all of its faces in them.
        result.push_back({"view-pole",
                          "surfaces for a camera, 64 differently sharp edges at a vertex, empty "
                          "cache, per face, 1 thread",
                          "own, 16 such edges", 0.3, 1});
        result.push_back({"polygons-1", "polygons with their base faces, per corner, 1 thread",
                          "loop over Far::TopologyLevel", 0.5, 1});
        result.push_back({"polygons-2", "polygons with their base faces, per corner, 2 threads",
                          "loop over Far::TopologyLevel", 0.9, 1.8});
        result.push_back({"base-face-map", "map of base faces, per face, 1 thread",
                          "own, topology, face-vertices", 1, 2});
        result.push_back({"evaluation-catmark", "Far's Catmull-Clark table, length 3",
                          "Osd::CpuEvaluator", 5, 8});
        // 1.3 times as slow at most.
        for (auto const &[name, work] : {std::pair("base", "base level from a descriptor"),
                                         {"topology", "topology, full last level"},
                                         {"table", "table, per weight"},
                                         {"evaluation", "evaluation, length 3"},
                                         {"table-free", "table-free, all levels"}}) {
            result.push_back({std::string("busy-") + name,
                              std::string(work) + ", threads of all processors, all busy",
                              "own, 1 thread", 0.77, 1});
        }
        return result;
    }();
    return kRows;
}

std::vector<Row> const &GetDeviceRows() {
    static std::vector<Row> const kRows = {
        {"gl-levels", "OpenGL, all levels, length 3",
         "Osd::GLComputeEvaluator, table of all levels", 3, 5},
        {"gl-limit", "OpenGL, limit with derivatives, length 3", "own, the level alone", 0.4, 0.6},
        {"gl-preparation", "OpenGL, preparation and upload",
         "making and uploading a table of all levels", 50, 200},
        {"gl-frame", std::string("OpenGL, ms of a frame of ") + kFrameMesh + ", length 3", "-", 2,
         0.5, true},
        {"cuda-copy", "CUDA, all levels, length 3", "copying as many bytes on the device", 0.5,
         0.75},
        {"cuda-huge", "CUDA, all levels, beyond 2^31 bytes, length 3",
         "copying as many bytes on the device", 0.5, 0.75},
        {"cuda-table", "CUDA, all levels, length 3", "fastest kernel, table of all levels", 5, 8},
        {"cuda-levels-thread", "CUDA, all levels, length 3",
         "one thread for each stencil, as Osd's kernel", 5, 8},
        {"cuda-thread", "CUDA, table of all levels, length 3",
         "one thread for each stencil, as Osd's kernel", 1, 2},
        {"cuda-limit", "CUDA, limit with derivatives, length 3", "own, the level alone", 0.4, 0.6},
        {"cuda-preparation", "CUDA, preparation and upload",
         "making and uploading a table of all levels", 50, 200},
        {"cuda-frame", std::string("CUDA, ms of a frame of ") + kFrameMesh + ", length 3", "-", 2,
         0.5, true}};
    return kRows;
}

std::vector<Row> const &GetPythonRows() {
    static std::vector<Row> const kRows = {
        {"python-refinement", "topology, face-vertices", "C++", 0.9, 1},
        {"python-table", "table, per weight", "C++", 0.9, 1},
        {"python-table-evaluation", "evaluation of a table, length 3", "C++", 0.9, 1},
        {"python-evaluation", "table-free, last level, length 3", "C++", 0.9, 1},
        {"python-blender", "table-free, level 4, a frame", "Blender's subdivision", 3, 10},
        {"addon-blender", "the add-on's object, level 4, a frame", "Blender's subdivision", 1, 3}};
    return kRows;
}

Row const &GetRow(std::string const &name) {
    for (std::vector<Row> const *rows : {&GetRows(), &GetDeviceRows(), &GetPythonRows()}) {
        for (Row const &row : *rows) {
            if (row.name == name) {
                return row;
            }
        }
    }
    throw std::out_of_range("no row " + name);
}

std::string GetVerdict(Row const &row, double figure) {
    auto const meets = [&](double bound) {
        return row.isUpperBound ? figure <= bound : figure >= bound;
    };
    return meets(row.aim) ? "aim" : meets(row.atLeast) ? "at least" : "below";
}

} // namespace OpenSubdivHex::Regression
