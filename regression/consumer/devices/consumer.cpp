// SPDX-License-Identifier: Apache-2.0
//
// A program that asks for an evaluator of a device, where there is perhaps none.  Exits with 1 unless
// it gets one, or is told that this machine has none.

#include EVALUATOR_HEADER
#include <far_ext/topologyRefinerFactory.h>

#include <cstdio>

namespace FarExt = OpenSubdivHex::FarExt;
namespace OsdExt = OpenSubdivHex::OsdExt;

int main() {
    constexpr int kVertsPerFace[] = {3, 3, 3, 3};
    constexpr int kFaceVerts[] = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
    OpenSubdiv::Far::TopologyDescriptor descriptor;
    descriptor.numVertices = 4;
    descriptor.numFaces = 4;
    descriptor.numVertsPerFace = kVertsPerFace;
    descriptor.vertIndicesPerFace = kFaceVerts;
    FarExt::CallStatus status;
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(descriptor, OpenSubdiv::Sdc::Options(), &status);
    if (!refiner || !refiner->RefineUniform({3}, &status)) {
        std::printf("%s\n", status.GetErrorMessage().c_str());
        return 1;
    }
    auto const evaluator = OsdExt::EVALUATOR::Create(*refiner, &status);
    if (!evaluator) {
        std::printf("%s\n", status.GetErrorMessage().c_str());
        return status.GetCode() == FarExt::StatusCode::Unsupported &&
                       !status.GetErrorMessage().empty()
                   ? 0
                   : 1;
    }
    std::printf("%d vertices at level 3\n", evaluator->GetNumElements(3));
    return evaluator->GetNumElements(3) == refiner->GetLevel(3).GetNumVertices() ? 0 : 1;
}
