// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include "arrays.h"

#include "far_ext/hexSchemeOptions.h"
#include "far_ext/stencilTableFactory.h"
#include "osd_ext/polygonIndices.h"
#include "osd_ext/simdLevel.h"

#include <opensubdiv/sdc/crease.h>
#include <opensubdiv/sdc/options.h>

#include <stdexcept>

namespace OpenSubdivHex::Python {

namespace {

using namespace FarExt;

void bindEnums(py::module_ &module) {
    py::enum_<FaceMask>(module, "FaceMask", "The mask that makes the new vertices of a face.")
        .value("AVERAGE", FaceMask::Average, "The paper's, and the default.")
        .value("COSINE", FaceMask::Cosine, "Doo and Sabin's of 1978: bounded curvature.")
        .value("SMOOTH", FaceMask::Smooth, "This project's, the smoothest: for renderers.");
    py::enum_<SchemeType>(module, "SchemeType", "The subdivision scheme.")
        .value("HEXAGONAL", SchemeType::Hexagonal)
        .value("DOO_SABIN", SchemeType::DooSabin)
        .value("TRI_HEX", SchemeType::TriHex);
    py::enum_<FirstStep>(
        module, "FirstStep",
        "The kind of the step that makes level 1, where it differs from the others.")
        .value("NONE", FirstStep::Same)
        .value("TRI_HEX", FirstStep::TriHex, "A step of the tri-hex scheme.")
        .value("TRUNCATE", FirstStep::Truncate, "Corners are cut off: for meshes of triangles.");
    py::enum_<StencilMode>(module, "StencilMode", "The kind of data that stencils interpolate.")
        .value("VERTEX", INTERPOLATE_VERTEX)
        .value("VARYING", INTERPOLATE_VARYING)
        .value("FACE_VARYING", INTERPOLATE_FACE_VARYING);
    py::enum_<FaceKind>(module, "FaceKind", "What a face of a refined level was made from.")
        .value("BASE", FaceKind::Base, "A face of level 0.")
        .value("FACE", FaceKind::Face, "The smaller copy of a parent face.")
        .value("EDGE", FaceKind::Edge, "The hexagon of a parent edge.")
        .value("VERTEX", FaceKind::Vertex, "Made for a parent vertex.");

    using Sdc = OpenSubdiv::Sdc::Options;
    py::enum_<Sdc::VtxBoundaryInterpolation>(module, "VtxBoundaryInterpolation",
                                             "The rule for boundaries.")
        .value("NONE", Sdc::VTX_BOUNDARY_NONE, "The paper's: the border moves inward.")
        .value("EDGE_ONLY", Sdc::VTX_BOUNDARY_EDGE_ONLY, "A smooth border curve.")
        .value("EDGE_AND_CORNER", Sdc::VTX_BOUNDARY_EDGE_AND_CORNER,
               "A smooth border curve; vertices with one face stay.");
    py::enum_<Sdc::FVarLinearInterpolation>(module, "FVarLinearInterpolation",
                                            "Where face-varying data are interpolated linearly.")
        .value("NONE", Sdc::FVAR_LINEAR_NONE)
        .value("CORNERS_ONLY", Sdc::FVAR_LINEAR_CORNERS_ONLY)
        .value("CORNERS_PLUS1", Sdc::FVAR_LINEAR_CORNERS_PLUS1)
        .value("CORNERS_PLUS2", Sdc::FVAR_LINEAR_CORNERS_PLUS2)
        .value("BOUNDARIES", Sdc::FVAR_LINEAR_BOUNDARIES)
        .value("ALL", Sdc::FVAR_LINEAR_ALL);
    py::enum_<Sdc::CreasingMethod>(module, "CreasingMethod", "How semi-sharp creases fade.")
        .value("UNIFORM", Sdc::CREASE_UNIFORM)
        .value("CHAIKIN", Sdc::CREASE_CHAIKIN);
    using Crease = OpenSubdiv::Sdc::Crease;
    py::enum_<Crease::Rule>(module, "Rule", "The rule that moves a vertex to the next level.")
        .value("SMOOTH", Crease::RULE_SMOOTH)
        .value("DART", Crease::RULE_DART)
        .value("CREASE", Crease::RULE_CREASE)
        .value("CORNER", Crease::RULE_CORNER);
    module.attr("SHARPNESS_INFINITE") = Crease::SHARPNESS_INFINITE;

    py::enum_<OsdExt::CreaseCuts>(module, "CreaseCuts", "The creases along which hexagons are cut.")
        .value("NONE", OsdExt::CreaseCuts::NoCreases)
        .value("INFINITELY_SHARP", OsdExt::CreaseCuts::InfinitelySharp)
        .value("ALL", OsdExt::CreaseCuts::All);
    py::enum_<OsdExt::SimdLevel>(module, "SimdLevel", "The SIMD instructions that evaluators use.")
        .value("PORTABLE", OsdExt::SimdLevel::Portable)
        .value("AVX2", OsdExt::SimdLevel::Avx2)
        .value("AVX512", OsdExt::SimdLevel::Avx512);
}

} // namespace

void BindOptions(py::module_ &module) {
    bindEnums(module);
    module.def("get_max_simd_level", &OsdExt::GetMaxSimdLevel,
               "get_max_simd_level()\n\n"
               "The highest SimdLevel of this build on this machine.");
    module.def("get_simd_level", &OsdExt::GetSimdLevel,
               "get_simd_level()\n\n"
               "The SimdLevel that evaluators use.");
    module.def(
        "set_simd_level",
        [](py::object const &level) {
            if (!OsdExt::SetSimdLevel(TakeEnum<OsdExt::SimdLevel>(level, "level"))) {
                throw py::value_error(
                    "level: this machine, or this build, has none above '" +
                    std::string(OsdExt::GetSimdLevelName(OsdExt::GetMaxSimdLevel())) + "'");
            }
        },
        "set_simd_level(level)\n\n"
        "Sets the SimdLevel of the whole process.  Raises ValueError above get_max_simd_level().",
        py::arg("level"));
}

} // namespace OpenSubdivHex::Python
