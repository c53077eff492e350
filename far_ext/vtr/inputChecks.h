// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_FAR_EXT_VTR_INPUT_CHECKS_H
#define OPENSUBDIVHEX_FAR_EXT_VTR_INPUT_CHECKS_H

#include "hierarchy.h"

#include "far_ext/hexSchemeOptions.h"

#include <opensubdiv/far/topologyDescriptor.h>

namespace OpenSubdivHex::FarExt::internal {

/// @name What the input of a refiner may be
/// Each returns Ok, or a CallStatus that names the component and what is wrong with it.
/// @{

/// Options that are none of their enumerations' values.
CallStatus CheckOptions(HexSchemeOptions schemeOptions, Sdc::Options sdcOptions);
/// A mesh without vertices or faces.
CallStatus CheckCounts(int numVertices, int numFaces);
/// Arrays of a descriptor that are not there.
CallStatus CheckArrays(Far::TopologyDescriptor const &descriptor);
/// Values of the corners of a face-varying channel.
CallStatus CheckValues(Far::Index const *values, Far::Index numCorners, Far::Index numValues,
                       int channel);
/// Features that the scheme has no rules for.
CallStatus CheckScheme(HexSchemeOptions schemeOptions, Hierarchy const &base);

CallStatus SharpnessFailure(float sharpness, ComponentType component, Far::Index index,
                            std::string const &name);
/// An index that is out of range: of a vertex, an edge or a face, as \p component says, else of a value.
CallStatus IndexFailure(Far::Index index, int count, ComponentType component,
                        std::string const &name);

/// A sharpness that is negative or not a number; \p getName() is called for it alone.
template <typename GET_NAME>
CallStatus CheckSharpness(float sharpness, ComponentType component, Far::Index index,
                          GET_NAME getName) {
    return sharpness >= 0 ? CallStatus() : SharpnessFailure(sharpness, component, index, getName());
}
/// An index that is not below \p count.
template <typename GET_NAME>
CallStatus CheckIndex(Far::Index index, int count, ComponentType component, GET_NAME getName) {
    return 0 <= index && index < count ? CallStatus()
                                       : IndexFailure(index, count, component, getName());
}
/// @}

} // namespace OpenSubdivHex::FarExt::internal

#endif
