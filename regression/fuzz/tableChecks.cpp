// SPDX-License-Identifier: Apache-2.0
#include "oracle.h"

#include <algorithm>
#include <cmath>

namespace OpenSubdivHex::Regression {

using FarExt::CallStatus;
using FarExt::TopologyLevel;
using FarExt::TopologyRefiner;

namespace {

template <typename REAL>
using Factory = FarExt::StencilTableFactoryReal<REAL>;
template <typename REAL>
using Table = typename Factory<REAL>::Table;

template <typename REAL>
typename Factory<REAL>::Options makeOptions(OracleLevels::Values const &values, int flags) {
    typename Factory<REAL>::Options options;
    options.interpolationMode = values.mode;
    options.fvarChannel = values.channel;
    options.generateControlVerts = (flags & 1) != 0;
    options.generateIntermediateLevels = (flags & 2) != 0;
    options.factorizeIntermediateLevels = (flags & 4) != 0;
    return options;
}

/// Offsets without gaps, as many weights as indices, indices that ascend, weights that sum to 1.
template <typename REAL>
void checkForm(Table<REAL> const &table, std::string const &name) {
    std::size_t const numWeights = table.GetWeights().size();
    if (table.GetControlIndices().size() != numWeights ||
        table.GetOffsets().size() != table.GetSizes().size()) {
        Fail(name, " has arrays of different sizes");
    }
    std::size_t offset = 0;
    for (int i = 0; i < table.GetNumStencils(); ++i) {
        std::size_t const size = std::size_t(table.GetSizes()[std::size_t(i)]);
        if (std::size_t(table.GetOffsets()[std::size_t(i)]) != offset ||
            offset + size > numWeights) {
            Fail(name, ": stencil ", i, " has another offset than the sizes before it sum to");
        }
        double sum = 0;
        for (std::size_t k = offset; k < offset + size; ++k) {
            double const weight = table.GetWeights()[k];
            bool const ascends =
                k == offset || table.GetControlIndices()[k] > table.GetControlIndices()[k - 1];
            if (!(weight >= 0) || !ascends) {
                Fail(name, ": stencil ", i, " has weight ", weight, " of index ",
                     table.GetControlIndices()[k]);
            }
            sum += weight;
        }
        if (!(std::abs(sum - 1) < (sizeof(REAL) == 8 ? 1e-12 : 3e-6))) {
            Fail(name, ": stencil ", i, " has weights that sum to ", sum);
        }
        offset += size;
    }
    if (offset != numWeights) {
        Fail(name, " has ", numWeights, " weights, and sizes that sum to ", offset);
    }
}

template <typename REAL>
Eigen::RowVectorXd apply(Table<REAL> const &table, int stencil, ReferenceValues const &sources,
                         std::string const &name) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(sources.cols());
    std::size_t const offset = std::size_t(table.GetOffsets()[std::size_t(stencil)]);
    for (std::size_t k = 0; k < std::size_t(table.GetSizes()[std::size_t(stencil)]); ++k) {
        int const index = table.GetControlIndices()[offset + k];
        if (index < 0 || index >= sources.rows()) {
            Fail(name, ": stencil ", stencil, " refers to ", index, " of ", sources.rows());
        }
        sum += double(table.GetWeights()[offset + k]) * sources.row(index);
    }
    return sum;
}

template <typename REAL>
void checkSize(TopologyRefiner const &refiner, Table<REAL> const &table,
               typename Factory<REAL>::Options const &options, std::string const &name) {
    FarExt::StencilTableSize const size = Factory<REAL>::GetSize(refiner, options);
    auto const numWeights = std::int64_t(table.GetWeights().size());
    if (size.numStencils != table.GetNumStencils() || size.numWeights != numWeights) {
        Fail(name, " was to have ", size.numStencils, " stencils and ", size.numWeights,
             " weights, and has ", table.GetNumStencils(), " and ", numWeights);
    }
}

/// A table of some base faces has the rows of the whole table.
template <typename REAL>
void checkSelection(OracleLevels const &levels, OracleLevels::Values const &values,
                    Table<REAL> const &whole, typename Factory<REAL>::Options const &options,
                    Dice &dice) {
    TopologyRefiner const &refiner = levels.refiner;
    int const numFaces = refiner.GetLevel(0).GetNumFaces();
    std::vector<int> faces;
    for (int i = dice.Roll(4); i > 0; --i) {
        faces.push_back(dice.Roll(numFaces));
    }
    Far::ConstIndexArray const selected(faces.data(), int(faces.size()));
    CallStatus status;
    auto const part = Factory<REAL>::CreateOfFaces(refiner, selected, options, &status);
    if (!part) {
        Fail("no table of ", faces.size(), " faces: ", status.GetErrorMessage());
    }
    std::string const name = "the table of " + std::to_string(faces.size()) + " faces, mode " +
                             std::to_string(values.mode);
    int row = 0;
    int first = 0; // row of the whole table where the level starts
    for (int depth = 0; depth <= refiner.GetMaxLevel(); ++depth) {
        TopologyLevel const &level = refiner.GetLevel(depth);
        std::vector<int> expected;
        for (int f = 0; f < level.GetNumFaces(); ++f) {
            bool const isFVar = values.mode == FarExt::INTERPOLATE_FACE_VARYING;
            for (int half = 0; half < 2; ++half) {
                if (std::count(faces.begin(), faces.end(), level.GetFaceBaseFace(f, half)) == 0) {
                    continue;
                }
                bool const isSplit = isFVar && level.IsFaceFVarSplit(f, values.channel);
                Far::ConstIndexArray const indices =
                    isSplit  ? level.GetFaceFVarValues(f, values.channel, half)
                    : isFVar ? level.GetFaceFVarValues(f, values.channel)
                             : level.GetFaceVertices(f);
                bool const isWhole = isSplit || !level.IsFaceBaseSplit(f);
                int const end = level.GetFaceDiagonalEnd(f);
                int const count =
                    isWhole ? indices.size() : FarExt::GetHalfSize(half, indices.size(), end);
                for (int i = 0; i < count; ++i) {
                    expected.push_back(
                        indices[isWhole ? i : FarExt::GetPlaceInHalves(half, i, end)]);
                }
            }
        }
        std::sort(expected.begin(), expected.end());
        expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
        if (Factory<REAL>::GetVerticesOfFaces(refiner, selected, options, depth) != expected) {
            Fail(name, " has other vertices of level ", depth);
        }
        bool const isStored =
            depth == 0 ? options.generateControlVerts
                       : options.generateIntermediateLevels || depth == refiner.GetMaxLevel();
        if (!isStored) {
            continue;
        }
        for (int vertex : expected) {
            auto const wholeRow = std::size_t(first + vertex);
            if (row >= part->GetNumStencils() ||
                part->GetSizes()[std::size_t(row)] != whole.GetSizes()[wholeRow]) {
                Fail(name, " has another row ", row);
            }
            auto const size = std::ptrdiff_t(whole.GetSizes()[wholeRow]);
            auto const wholeOffset = std::ptrdiff_t(whole.GetOffsets()[wholeRow]);
            auto const offset = std::ptrdiff_t(part->GetOffsets()[std::size_t(row)]);
            if (!std::equal(whole.GetWeights().begin() + wholeOffset,
                            whole.GetWeights().begin() + wholeOffset + size,
                            part->GetWeights().begin() + offset) ||
                !std::equal(whole.GetControlIndices().begin() + wholeOffset,
                            whole.GetControlIndices().begin() + wholeOffset + size,
                            part->GetControlIndices().begin() + offset)) {
                Fail(name, " has another row ", row, " than that of vertex ", vertex);
            }
            ++row;
        }
        first += int(values.levels[std::size_t(depth)].rows());
    }
    if (row != part->GetNumStencils()) {
        Fail(name, " has ", part->GetNumStencils(), " rows instead of ", row);
    }
}

template <typename REAL>
void checkTable(OracleLevels const &levels, OracleLevels::Values const &values, int flags,
                Dice &dice) {
    TopologyRefiner const &refiner = levels.refiner;
    auto const options = makeOptions<REAL>(values, flags);
    std::string const name = "the table of mode " + std::to_string(values.mode) + ", flags " +
                             std::to_string(flags) + (sizeof(REAL) == 8 ? ", double" : ", float");
    CallStatus status;
    auto const table = Factory<REAL>::Create(refiner, options, &status);
    if (!table) {
        Fail("no ", name, ": ", status.GetErrorMessage());
    }
    checkForm<REAL>(*table, name);
    double const allowed =
        (sizeof(REAL) == 8 ? 1e-12 : 2e-6) * std::max(1.0, GetSize(values.levels[0]));
    int stencil = 0;
    int const last = refiner.GetMaxLevel();
    for (int level = options.generateControlVerts ? 0 : 1; level <= last; ++level) {
        if (level > 0 && level < last && !options.generateIntermediateLevels) {
            continue;
        }
        bool const isFromBase = level == 0 || options.factorizeIntermediateLevels;
        ReferenceValues const &sources = values.levels[std::size_t(isFromBase ? 0 : level - 1)];
        ReferenceValues const &expected = values.levels[std::size_t(level)];
        for (Eigen::Index row = 0; row < expected.rows(); ++row, ++stencil) {
            if (stencil >= table->GetNumStencils()) {
                Fail(name, " ends before level ", level, ", row ", row);
            }
            Eigen::RowVectorXd const actual = apply<REAL>(*table, stencil, sources, name);
            if (!(GetDifference(actual, expected.row(row)) <= allowed)) {
                Fail(name, " gives ", actual, " at level ", level, ", row ", row, ", not ",
                     expected.row(row));
            }
        }
    }
    if (stencil != table->GetNumStencils()) {
        Fail(name, " has ", table->GetNumStencils(), " stencils, not ", stencil);
    }
    checkSize<REAL>(refiner, *table, options, name);
    if (options.factorizeIntermediateLevels) {
        checkSelection<REAL>(levels, values, *table, options, dice);
    }
}

} // namespace

void CheckTables(OracleLevels const &levels, Dice &dice) {
    bool const hasAll = dice.IsOneOf(16);
    for (OracleLevels::Values const &values : levels.values) {
        for (int flags = hasAll ? 0 : dice.Roll(8), end = hasAll ? 8 : flags + 1; flags < end;
             ++flags) {
            bool const isDouble = dice.IsOneOf(2);
            if (hasAll || isDouble) {
                checkTable<double>(levels, values, flags, dice);
            }
            if (hasAll || !isDouble) {
                checkTable<float>(levels, values, flags, dice);
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression
