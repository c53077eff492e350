// SPDX-License-Identifier: Apache-2.0
#include "farPatchTable.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

namespace {

// Quads, each with vertices of its own, which are the values of as many channels as are wanted.
struct IsolatedQuads {
    int numQuads;
    std::vector<PatchTableContent::Channel> const &channels;
};
using QuadRefinerFactory = OpenSubdiv::Far::TopologyRefinerFactory<IsolatedQuads>;

void setCorners(Far::Index quad, OpenSubdiv::Vtr::Array<Far::Index> corners) {
    std::iota(corners.begin(), corners.end(), 4 * quad);
}

} // namespace

} // namespace OpenSubdivHex::FarExt::internal

// Far's way to take a mesh.
namespace OpenSubdiv::OPENSUBDIV_VERSION::Far {

using OpenSubdivHex::FarExt::internal::IsolatedQuads;
using OpenSubdivHex::FarExt::internal::setCorners;

template <>
bool TopologyRefinerFactory<IsolatedQuads>::resizeComponentTopology(TopologyRefiner &refiner,
                                                                    IsolatedQuads const &mesh) {
    setNumBaseVertices(refiner, 4 * mesh.numQuads);
    setNumBaseFaces(refiner, mesh.numQuads);
    for (Index quad = 0; quad < mesh.numQuads; ++quad) {
        setNumBaseFaceVertices(refiner, quad, 4);
    }
    return true;
}

template <>
bool TopologyRefinerFactory<IsolatedQuads>::assignComponentTopology(TopologyRefiner &refiner,
                                                                    IsolatedQuads const &mesh) {
    for (Index quad = 0; quad < mesh.numQuads; ++quad) {
        setCorners(quad, getBaseFaceVertices(refiner, quad));
    }
    return true;
}

template <>
bool TopologyRefinerFactory<IsolatedQuads>::assignFaceVaryingTopology(TopologyRefiner &refiner,
                                                                      IsolatedQuads const &mesh) {
    for (auto const &wanted : mesh.channels) {
        Sdc::Options options;
        options.SetFVarLinearInterpolation(wanted.isLinear ? Sdc::Options::FVAR_LINEAR_ALL
                                                           : Sdc::Options::FVAR_LINEAR_NONE);
        int const channel = createBaseFVarChannel(refiner, 4 * mesh.numQuads, options);
        for (Index quad = 0; quad < mesh.numQuads; ++quad) {
            setCorners(quad, getBaseFaceFVarValues(refiner, quad, channel));
        }
    }
    return true;
}

} // namespace OpenSubdiv::OPENSUBDIV_VERSION::Far

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using OpenSubdiv::Far::PatchDescriptor;
using OpenSubdiv::Far::PatchTable;
using OpenSubdiv::Far::StencilTableReal;

namespace {

using Factory = OpenSubdiv::Far::PatchTableFactory;

// A stencil table whose arrays are given.
template <typename REAL>
class FilledTable : public StencilTableReal<REAL> {
public:
    FilledTable(int numControlVertices, std::vector<int> &&sizes, std::vector<Index> &&indices,
                std::vector<REAL> &&weights)
        : StencilTableReal<REAL>(numControlVertices) {
        this->_offsets.resize(sizes.size());
        std::exclusive_scan(sizes.begin(), sizes.end(), this->_offsets.begin(), 0);
        this->_sizes = std::move(sizes);
        this->_indices = std::move(indices);
        this->_weights = std::move(weights);
    }
    void MoveTo(StencilTableReal<REAL> &table) {
        // Protected members of another object are out of reach; its public accessors lead to them.
        const_cast<std::vector<int> &>(table.GetSizes()).clear();
        table = FilledTable(this->_numControlVertices);
        const_cast<std::vector<int> &>(table.GetSizes()).swap(this->_sizes);
        const_cast<std::vector<int> &>(table.GetOffsets()).swap(this->_offsets);
        const_cast<std::vector<Index> &>(table.GetControlIndices()).swap(this->_indices);
        const_cast<std::vector<REAL> &>(table.GetWeights()).swap(this->_weights);
    }

private:
    explicit FilledTable(int numControlVertices) : StencilTableReal<REAL>(numControlVertices) {}
};

std::unique_ptr<PatchTable> makeTable(PatchTableContent const &content) {
    OpenSubdiv::Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> const refiner(
        QuadRefinerFactory::Create({int(content.params.size()), content.channels},
                                   {OpenSubdiv::Sdc::SCHEME_CATMARK, sdcOptions}));
    if (!refiner) {
        return nullptr;
    }
    Factory::Options options(0);
    options.SetEndCapType(Factory::Options::ENDCAP_GREGORY_BASIS);
    options.generateLegacySharpCornerPatches = false;
    options.generateVaryingTables = !content.varyingVertices.empty();
    options.generateVaryingLocalPoints = !content.varyingVertices.empty();
    options.generateFVarTables = !content.channels.empty();
    options.generateFVarLegacyLinearPatches = false;
    options.patchPrecisionDouble = content.isDouble;
    options.fvarPatchPrecisionDouble = content.isFVarDouble;
    refiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
    return std::unique_ptr<PatchTable>(Factory::Create(*refiner, options));
}

// Replaces elements of a table that Far's accessors return as constant, although the table is not.
template <typename ELEMENT, typename ARRAY>
void replace(ARRAY const &array, std::vector<ELEMENT> const &elements) {
    std::copy(elements.begin(), elements.end(), const_cast<ELEMENT *>(array.begin()));
}

// getTable(REAL()) is the table that Far made, in the precision of the points.
template <typename GET_TABLE>
bool replacePoints(bool isDouble, LocalPoints points, GET_TABLE const &getTable) {
    auto const replaceIn = [&](auto const *table, auto weights) {
        using Real = typename decltype(weights)::value_type;
        if (table) {
            FilledTable<Real>(points.numControlPoints, std::move(points.sizes),
                              std::move(points.indices), std::move(weights))
                .MoveTo(const_cast<StencilTableReal<Real> &>(*table));
        }
        return table != nullptr;
    };
    return isDouble ? replaceIn(getTable(double()), std::move(points.doubleWeights))
                    : replaceIn(getTable(float()), std::move(points.weights));
}

bool replaceChannel(bool isDouble, PatchTableContent::Channel channel, int number,
                    std::vector<OpenSubdiv::Far::PatchParam> const &params, PatchTable &table) {
    auto const type = channel.isLinear ? PatchDescriptor::QUADS : PatchDescriptor::GREGORY_BASIS;
    if (table.GetFVarPatchDescriptor(number).GetType() != type ||
        std::size_t(table.GetFVarValues(number).size()) != channel.values.size()) {
        return false;
    }
    replace(table.GetFVarValues(number), channel.values);
    replace(table.GetFVarPatchParams(number), params);
    // Far's tables have no local points of linear channels.
    return channel.isLinear || replacePoints(isDouble, std::move(channel.points), [&](auto real) {
               return table.GetLocalPointFaceVaryingStencilTable<decltype(real)>(number);
           });
}

} // namespace

std::unique_ptr<PatchTable const> MakeFarPatchTable(PatchTableContent content) {
    std::unique_ptr<PatchTable> table = makeTable(content);
    auto const numPatches = int(content.params.size());
    if (!table || table->GetNumPatchArrays() != 1 || table->GetNumPatches(0) != numPatches ||
        table->GetPatchArrayDescriptor(0).GetType() != PatchDescriptor::GREGORY_BASIS ||
        table->GetNumFVarChannels() != int(content.channels.size())) {
        return nullptr;
    }
    const_cast<PatchTable::PatchVertsTable &>(table->GetPatchControlVerticesTable())
        .swap(content.vertices);
    bool isWell = replacePoints(content.isDouble, std::move(content.points), [&](auto real) {
        return table->GetLocalPointStencilTable<decltype(real)>();
    });
    if (!content.varyingVertices.empty()) {
        replace(table->GetVaryingVertices(), content.varyingVertices);
        isWell = isWell &&
                 replacePoints(content.isDouble, std::move(content.varyingPoints), [&](auto real) {
                     return table->GetLocalPointVaryingStencilTable<decltype(real)>();
                 });
    }
    for (std::size_t i = 0; i < content.channels.size() && isWell; ++i) {
        isWell = replaceChannel(content.isFVarDouble, std::move(content.channels[i]), int(i),
                                content.params, *table);
    }
    const_cast<OpenSubdiv::Far::PatchParamTable &>(table->GetPatchParamTable())
        .swap(content.params);
    return isWell ? std::move(table) : nullptr;
}

} // namespace OpenSubdivHex::FarExt::internal
