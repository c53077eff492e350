// SPDX-License-Identifier: Apache-2.0
#include "topologyRefinerFactory.h"

#include "far_ext/vtr/farBase.h"
#include "far_ext/vtr/inputChecks.h"

namespace OpenSubdivHex::FarExt {

// The refiner of a base that read(mesh) reads.
std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::create(Sdc::Options sdcOptions, Options options, CallStatus *status,
                               std::function<CallStatus(internal::BaseMesh &)> const &read) {
    CallStatus result = internal::CheckOptions(options.schemeOptions, sdcOptions);
    internal::BaseMesh mesh(sdcOptions);
    if (result.IsOk()) {
        result = read(mesh);
    }
    std::unique_ptr<internal::Hierarchy> hierarchy = mesh.Release();
    if (result.IsOk()) {
        if (CallStatus scheme = internal::CheckScheme(options.schemeOptions, *hierarchy);
            !scheme.IsOk()) {
            result = std::move(scheme);
        }
    }
    if (!internal::Report(result, status)) {
        return nullptr;
    }
    return std::make_unique<TopologyRefiner>(std::move(hierarchy), sdcOptions,
                                             options.schemeOptions);
}

std::unique_ptr<TopologyRefiner> TopologyRefinerFactory::Create(Far::TopologyRefiner const &base,
                                                                Options options,
                                                                CallStatus *status) {
    return create(base.GetSchemeOptions(), options, status,
                  [&](internal::BaseMesh &mesh) { return internal::ReadRefiner(base, mesh); });
}

std::unique_ptr<TopologyRefiner>
TopologyRefinerFactory::Create(Far::TopologyDescriptor const &descriptor, Sdc::Options sdcOptions,
                               Options options, CallStatus *status) {
    return create(sdcOptions, options, status, [&](internal::BaseMesh &mesh) {
        return internal::ReadDescriptor(descriptor, mesh);
    });
}

} // namespace OpenSubdivHex::FarExt
