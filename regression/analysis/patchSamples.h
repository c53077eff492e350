// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_ANALYSIS_PATCH_SAMPLES_H
#define OPENSUBDIVHEX_REGRESSION_ANALYSIS_PATCH_SAMPLES_H

#include "far_ext/patchTableFactory.h"
#include "far_ext/topologyRefiner.h"
#include "regression/shapes/shapes.h"

#include <Eigen/Core>

#include <limits>
#include <memory>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief The patches of a shape with FaceMask::Smooth, and places of the limit surface all over their faces, to
/// which they are compared.
///
/// The places are the vertices that two more steps make, but for those on the edges of faces.
class PatchSamples {
public:
    using Vector = Eigen::Vector3d;

    /// How far a patch is from a place of the surface.
    struct Error {
        double distance;        ///< at right angles to the patch, of the box's diagonal
        Eigen::Vector2d normal; ///< of the patch, in the tangent plane of the surface: radians
        double GetAngle() const { return normal.norm(); }
    };

    /// \param level      the finest of patches
    /// \param tolerance  0: all are of the level; else they are of the surface level and later ones, as
    ///                   PatchTableFactory::Options::tolerance, of the box's diagonal
    /// \param maxNumSamples  how many of the places are enough, in equal distances
    PatchSamples(Shape const &shape, int level, FarExt::FirstStep firstStep, double tolerance = 0,
                 std::size_t maxNumSamples = std::numeric_limits<std::size_t>::max());

    FarExt::TopologyRefiner const &GetRefiner() const { return *_refiner; }
    int GetLevel() const { return _level; }
    Far::PatchTable const &GetTable() const { return *_table; }
    /// The local points of the patches, of stencils of as many.
    std::vector<Vector> MakePoints(std::vector<int> const &sizes, std::vector<int> const &indices,
                                   std::vector<double> const &weights) const;

    /// Measures the errors at all places, for the local points.
    std::vector<Error> Measure(std::vector<Vector> const &points) const;

private:
    struct Sample {
        int patch;
        double s;
        double t;
        Vector p;
        Vector normal;
    };
    void findSamples(FarExt::PatchTableFactory::Options const &options);

    int const _level;
    std::unique_ptr<FarExt::TopologyRefiner> _refiner;
    std::unique_ptr<Far::PatchTable const> _table;
    std::vector<Vector> _control;
    double _size; // the box's diagonal
    std::vector<Sample> _samples;
};

} // namespace OpenSubdivHex::Regression

#endif
