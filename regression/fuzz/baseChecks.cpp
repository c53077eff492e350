// SPDX-License-Identifier: Apache-2.0
#include "oracle.h"

#include "far_ext/topologyRefinerFactory.h"
#include "regression/far_ext/baseDifference.h"
#include "regression/far_ext/shapeFactory.h"
#include "regression/shapes/shapeDescriptor.h"

#include <set>

namespace OpenSubdivHex::Regression {

namespace {

/// The shape without what a refiner of Far does not tell of it: creases at vertices that a face has
/// several times, and holes at boundaries that it makes holes of itself.
Shape withoutLosses(OracleCase const &oracleCase) {
    Shape shape = oracleCase.shape;
    if (oracleCase.sdcOptions.GetVtxBoundaryInterpolation() == Sdc::Options::VTX_BOUNDARY_NONE) {
        shape.holeFaces.clear();
    }
    auto first = shape.faceVertices.begin();
    for (int size : shape.faceSizes) {
        if (std::set<int>(first, first + size).size() < std::size_t(size)) {
            shape.creaseVertexPairs.clear();
            shape.creaseSharpness.clear();
        }
        first += size;
    }
    return shape;
}

} // namespace

void CheckBases(OracleCase const &oracleCase) {
    Shape const shape = withoutLosses(oracleCase);
    auto const base = CreateFarRefiner(shape, oracleCase.sdcOptions);
    ShapeDescriptor const descriptor(shape);
    FarExt::CallStatus status;
    auto const ofDescriptor =
        FarExt::TopologyRefinerFactory::Create(descriptor.Get(), oracleCase.sdcOptions, &status);
    FarExt::CallStatus statusOfBase;
    auto const ofBase = FarExt::TopologyRefinerFactory::Create(*base, &statusOfBase);
    if (status.GetErrorMessage() != statusOfBase.GetErrorMessage() ||
        status.GetComponentIndex() != statusOfBase.GetComponentIndex() ||
        status.GetWarnings().size() != statusOfBase.GetWarnings().size()) {
        Fail("from a descriptor \"", status.GetErrorMessage(), "\", from a refiner \"",
             statusOfBase.GetErrorMessage(), "\"");
    }
    for (std::size_t i = 0; i < status.GetWarnings().size(); ++i) {
        if (status.GetWarnings()[i].message != statusOfBase.GetWarnings()[i].message) {
            Fail("other warnings: ", status.GetWarnings()[i].message, ", ",
                 statusOfBase.GetWarnings()[i].message);
        }
    }
    if (!ofDescriptor) {
        return;
    }
    if (std::string const what = FindBaseDifference(*ofDescriptor, *ofBase); !what.empty()) {
        Fail("level 0 from a descriptor and from a refiner: ", what);
    }
    if (!shape.leftHanded) {
        auto const ofMesh =
            FarExt::MeshRefinerFactory<Shape>::Create(shape, oracleCase.sdcOptions, &status);
        std::string const what =
            ofMesh ? FindBaseDifference(*ofDescriptor, *ofMesh) : status.GetErrorMessage();
        if (!what.empty()) {
            Fail("level 0 from a descriptor and from a mesh class: ", what);
        }
    }
    if (std::string const what = FindFarDifference(*ofDescriptor, base->GetLevel(0));
        !what.empty()) {
        Fail("level 0 and that of Far: ", what);
    }
}

} // namespace OpenSubdivHex::Regression
