// SPDX-License-Identifier: Apache-2.0
#include "evaluationChecks.h"

#include "far_ext/status.h"

#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::Status;
using FarExt::StatusCode;
using FarExt::TopologyRefiner;
using Options = RefinementEvaluator::Options;

namespace {

Status invalidArgument(std::string const &message) {
    return FarExt::internal::Failure(StatusCode::InvalidArgument, message);
}

} // namespace

Status CheckOptions(TopologyRefiner const &refiner, Options options) {
    if (!FarExt::internal::IsInEnum(options.interpolationMode, FarExt::INTERPOLATE_FACE_VARYING)) {
        return invalidArgument("there is no interpolationMode " +
                               std::to_string(int(options.interpolationMode)));
    }
    if (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING &&
        (options.fvarChannel < 0 || options.fvarChannel >= refiner.GetNumFVarChannels())) {
        return invalidArgument("there is no face-varying channel " +
                               std::to_string(options.fvarChannel) + " among the refiner's " +
                               std::to_string(refiner.GetNumFVarChannels()));
    }
    return Status();
}

FarExt::Interpolation GetInterpolation(TopologyRefiner const &refiner, Options options) {
    bool const isLinear =
        options.interpolationMode == FarExt::INTERPOLATE_VARYING ||
        (options.interpolationMode == FarExt::INTERPOLATE_FACE_VARYING &&
         refiner.GetFVarLinearInterpolation(options.fvarChannel) == Sdc::Options::FVAR_LINEAR_ALL);
    return isLinear ? FarExt::Interpolation::Varying : FarExt::Interpolation::Vertex;
}

Status CheckLevel(int level, int maxLevel) {
    if (0 <= level && level <= maxLevel) {
        return Status();
    }
    return Status(StatusCode::InvalidArgument, FarExt::ComponentType::Level, level,
                  "level " + std::to_string(level) + " is not between 0 and " +
                      std::to_string(maxLevel));
}

Status CheckDescriptors(Osd::BufferDescriptor const &srcDesc,
                        Osd::BufferDescriptor const &dstDesc) {
    if (srcDesc.length < 1 || srcDesc.length != dstDesc.length) {
        return invalidArgument("the lengths of source and destination are " +
                               std::to_string(srcDesc.length) + " and " +
                               std::to_string(dstDesc.length) + ": not the same, or less than 1");
    }
    for (Osd::BufferDescriptor const *desc : {&srcDesc, &dstDesc}) {
        if (desc->stride < desc->length || desc->offset < 0) {
            return invalidArgument("a descriptor has stride " + std::to_string(desc->stride) +
                                   " for length " + std::to_string(desc->length) + " and offset " +
                                   std::to_string(desc->offset));
        }
    }
    return Status();
}

} // namespace OpenSubdivHex::OsdExt::internal
