// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_SHAPES_SHAPE_DESCRIPTOR_H
#define OPENSUBDIVHEX_REGRESSION_SHAPES_SHAPE_DESCRIPTOR_H

#include "shapes.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <memory>

namespace OpenSubdivHex::Regression {

/// All rules for boundaries.
inline constexpr OpenSubdiv::Sdc::Options::VtxBoundaryInterpolation kBoundaries[] = {
    OpenSubdiv::Sdc::Options::VTX_BOUNDARY_NONE, OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
    OpenSubdiv::Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER};

/// \brief A Far::TopologyDescriptor of a shape.  It points into the shape, which must outlive it.
class ShapeDescriptor {
public:
    explicit ShapeDescriptor(Shape const &shape);
    explicit ShapeDescriptor(Shape &&) = delete;

    OpenSubdiv::Far::TopologyDescriptor const &Get() const { return _descriptor; }

private:
    std::vector<OpenSubdiv::Far::TopologyDescriptor::FVarChannel> _fvarChannels;
    OpenSubdiv::Far::TopologyDescriptor _descriptor;
};

/// The unrefined Catmark refiner of a shape; null if Far refuses it.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner>
CreateFarRefiner(Shape const &shape, OpenSubdiv::Sdc::Options options = OpenSubdiv::Sdc::Options());

} // namespace OpenSubdivHex::Regression

#endif
