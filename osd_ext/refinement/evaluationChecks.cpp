// SPDX-License-Identifier: Apache-2.0
#include "evaluationChecks.h"

#include "far_ext/status.h"
#include "far_ext/vtr/report.h"

#include <string>

namespace OpenSubdivHex::OsdExt::internal {

using FarExt::CallStatus;
using FarExt::StatusCode;

namespace {

CallStatus invalidArgument(std::string const &message) {
    return FarExt::internal::Failure(StatusCode::InvalidArgument, message);
}

} // namespace

CallStatus CheckLevel(int level, int maxLevel) {
    if (0 <= level && level <= maxLevel) {
        return CallStatus();
    }
    return CallStatus(StatusCode::InvalidArgument, FarExt::ComponentType::Level, level,
                      "level " + std::to_string(level) + " is not between 0 and " +
                          std::to_string(maxLevel));
}

CallStatus CheckDescriptors(Osd::BufferDescriptor const &srcDesc,
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
    return CallStatus();
}

} // namespace OpenSubdivHex::OsdExt::internal
