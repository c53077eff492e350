// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include "far_ext/vtr/baseImporter.h"
#include "far_ext/vtr/farBase.h"
#include "far_ext/vtr/inputChecks.h"

namespace OpenSubdivHex::FarExt {

namespace {

std::unique_ptr<TopologyRefiner> create(Far::TopologyRefiner const &base, bool const *isHole,
                                        TopologyRefinerFactory::Options options, Status *status) {
    Status result = internal::CheckOptions(options.schemeOptions, base.GetSchemeOptions());
    if (result.IsOk()) {
        result = internal::CheckBase(base.GetLevel(0));
    }
    std::unique_ptr<internal::Hierarchy> hierarchy;
    if (result.IsOk()) {
        hierarchy = internal::ImportBase(base, isHole, result);
    }
    if (result.IsOk()) {
        if (Status scheme = internal::CheckScheme(options.schemeOptions, *hierarchy);
            !scheme.IsOk()) {
            result = std::move(scheme);
        }
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    return std::make_unique<TopologyRefiner>(std::move(hierarchy), base.GetSchemeOptions(),
                                             options.schemeOptions);
}

} // namespace

std::unique_ptr<TopologyRefiner> TopologyRefinerFactory::Create(Far::TopologyRefiner const &base,
                                                                Options options, Status *status) {
    return create(base, nullptr, options, status);
}

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyDescriptor const &descriptor, Sdc::Options sdcOptions,
                               Options options, Status *status) {
    Status result = internal::CheckOptions(options.schemeOptions, sdcOptions);
    if (result.IsOk()) {
        result = internal::CheckDescriptor(descriptor);
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    std::unique_ptr<Far::TopologyRefiner> const base =
        internal::CreateFarBase(descriptor, sdcOptions);
    if (!base) {
        internal::Report(
            internal::Failure(StatusCode::InvalidTopology,
                              "OpenSubdiv refuses the mesh; its error callback has the cause"),
            status);
        return nullptr;
    }
    auto const isHole = std::make_unique<bool[]>(descriptor.numFaces);
    for (int i = 0; i < descriptor.numHoles; ++i) {
        isHole[descriptor.holeIndices[i]] = true;
    }
    return create(*base, isHole.get(), options, status);
}

} // namespace OpenSubdivHex::FarExt
