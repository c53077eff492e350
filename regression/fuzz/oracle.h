// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_FUZZ_ORACLE_H
#define OPENSUBDIVHEX_REGRESSION_FUZZ_ORACLE_H

#include "oracleCase.h"

#include "far_ext/stencilTableFactory.h"
#include "regression/far_ext/referenceMatch.h"
#include "regression/far_ext/valueLevels.h"

#include <sstream>
#include <stdexcept>
#include <vector>

namespace OpenSubdivHex::Regression {

/// \brief Refines the case and compares all ways to the same values with each other, and with the
/// reference: topology, base faces, values of vertices, varying and face-varying values, tables, tables of some
/// faces, evaluators, limits, surfaces of base faces with their tessellations, streams and views, patches, other orders of faces and
/// vertices, numbers of threads.
///
/// The dearer comparisons are made for a share of the cases, which OracleCase::checks chooses.
/// Throws OracleFailure at the first difference.
void CheckOracleCase(OracleCase const &oracleCase);

/// A difference, with its place.
class OracleFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

template <typename... PARTS>
[[noreturn]] void Fail(PARTS const &...parts) {
    std::ostringstream text;
    text.precision(17);
    (text << ... << parts);
    throw OracleFailure(text.str());
}

/// Numbers that follow from OracleCase::checks.
class Dice {
public:
    explicit Dice(unsigned seed) : _state(seed * 2654435761u + 12345u) {}

    /// 0 ... count - 1
    int Roll(int count) {
        _state ^= _state << 13;
        _state ^= _state >> 17;
        _state ^= _state << 5;
        return count > 0 ? int((_state >> 4) % unsigned(count)) : 0;
    }
    bool IsOneOf(int count) { return Roll(count) == 0; }

private:
    std::uint32_t _state;
};

/// \brief A refined case, with the values of all its levels as PrimvarRefiner computes them in
/// double precision.
struct OracleLevels {
    /// Data that are interpolated, with control values and the values of all levels.
    struct Values {
        FarExt::StencilMode mode;
        int channel;
        std::vector<ReferenceValues> levels;
    };

    OracleCase const &oracleCase;
    FarExt::TopologyRefiner const &refiner;
    std::vector<Values> values; ///< vertex, varying, then the channels
};

/// \brief Level 0 from a descriptor against those from a refiner of Far and from a mesh class, to the
/// bit, and against the base level of Far.
void CheckBases(OracleCase const &oracleCase);

/// \brief Stencil tables against the values: all options, both precisions; tables of some faces
/// against those of all, to the bit; sizes before tables are made.
void CheckTables(OracleLevels const &levels, Dice &dice);

/// \brief Evaluators against the values and, where they are to be the same to the bit, each other.
void CheckEvaluators(OracleLevels const &levels, Dice &dice);

/// \brief Limit tables: weights that sum up and are bounded, the same points and tangent planes from
/// every level, and points and derivatives that are those of RefinementEvaluator.
void CheckLimits(OracleLevels const &levels, Dice &dice);

/// \brief Surfaces of base faces, of one of the values: against the limits of vertices, at single places and
/// in tessellations by levels and by rates, streams and views.
void CheckSurfaces(OracleLevels const &levels, Dice &dice);

/// \brief Patches of a level: they cover their faces, places are found in them, weights sum up, and their corners lie
/// on the surface.
void CheckPatches(OracleLevels const &levels, Dice &dice);

/// \brief Faces in other orders, begun elsewhere and turned over, and vertices of other numbers
/// give the same surface.
void CheckOrders(OracleLevels const &levels, Dice &dice);

/// One to three threads make the same bits, at a level that is large enough for them.
void CheckThreads(OracleCase const &oracleCase);

/// Whether a vertex is on a boundary of the paper's rule, and so has no limit.
bool IsOnFreeBoundary(FarExt::TopologyRefiner const &refiner, FarExt::TopologyLevel const &level,
                      int vert);

/// The largest difference of two rows, infinite if one of them is not finite.
double GetDifference(Eigen::RowVectorXd const &a, Eigen::RowVectorXd const &b);

} // namespace OpenSubdivHex::Regression

#endif
