// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_PERF_SUBDIVISION_PEER_H
#define OPENSUBDIVHEX_REGRESSION_PERF_SUBDIVISION_PEER_H

#include "regression/shapes/shapes.h"

#include <memory>
#include <string>

namespace OpenSubdivHex::Regression {

/// \brief Another library's subdivision of a mesh with positions, as floats.
class SubdivisionPeer {
public:
    virtual ~SubdivisionPeer() = default;

    /// Copies the base mesh.
    virtual void Prepare() = 0;
    /// Subdivides the copy.
    virtual void Subdivide(int level) = 0;
    virtual int GetNumVertices() const = 0;
    /// Drops the copy.
    virtual void Release() = 0;
};

/// Catmull-Clark subdivision of OpenMesh.
std::unique_ptr<SubdivisionPeer> MakeOpenMeshPeer(Shape const &shape);

/// Doo-Sabin subdivision of CGAL; null where the program was built without CGAL.
std::unique_ptr<SubdivisionPeer> MakeCgalPeer(Shape const &shape);

/// @name Versions, "none" of a library that the program was built without
/// @{
std::string GetOpenMeshVersion();
std::string GetCgalVersion();
/// @}

} // namespace OpenSubdivHex::Regression

#endif
