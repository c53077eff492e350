// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_SURFACE_CASE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_SURFACE_CASE_H

#include "regression/far_ext/referenceMatch.h"
#include "regression/shapes/shapes.h"

#include <memory>
#include <ostream>
#include <string>

namespace OpenSubdivHex::Regression {

/// The masks, each without a first step and behind one.
struct SurfaceCase {
    bool HasFirstStep() const { return firstStep != FarExt::FirstStep::Same; }
    FarExt::HexSchemeOptions GetOptions() const {
        FarExt::HexSchemeOptions options;
        options.firstStep = firstStep;
        return options;
    }
    /// Whether the first step has no rules for tags, seams and flaws.
    bool IsPlain() const { return firstStep == FarExt::FirstStep::TriHex; }

    std::string GetName() const {
        char const *const steps[] = {"", "TriHex", "Truncate"};
        return ToString(mask) + std::string(steps[int(firstStep)]);
    }

    ReferenceMask mask;
    FarExt::FirstStep firstStep;
};

inline void PrintTo(SurfaceCase const &surfaceCase, std::ostream *stream) {
    *stream << surfaceCase.GetName();
}

inline constexpr SurfaceCase kPlainCases[] = {{ReferenceMask::Average, FarExt::FirstStep::Same},
                                              {ReferenceMask::Cosine, FarExt::FirstStep::Same},
                                              {ReferenceMask::Smooth, FarExt::FirstStep::Same}};
inline constexpr SurfaceCase kTruncateCases[] = {
    {ReferenceMask::Average, FarExt::FirstStep::Truncate},
    {ReferenceMask::Cosine, FarExt::FirstStep::Truncate},
    {ReferenceMask::Smooth, FarExt::FirstStep::Truncate}};
inline constexpr SurfaceCase kTriHexCases[] = {{ReferenceMask::Average, FarExt::FirstStep::TriHex},
                                               {ReferenceMask::Cosine, FarExt::FirstStep::TriHex},
                                               {ReferenceMask::Smooth, FarExt::FirstStep::TriHex}};

/// A refiner with \p level levels behind the surface level.
inline std::unique_ptr<FarExt::TopologyRefiner>
CreateSurfaceRefiner(Shape shape, SurfaceCase const &surfaceCase, int level,
                     Sdc::Options options = Sdc::Options()) {
    FarExt::HexSchemeOptions const schemeOptions = surfaceCase.GetOptions();
    if (surfaceCase.IsPlain()) {
        shape.fvarChannels.clear();
    }
    return CreateRefiner(shape, surfaceCase.mask, schemeOptions.GetSurfaceLevel() + level, options,
                         schemeOptions);
}

} // namespace OpenSubdivHex::Regression

#endif
