// SPDX-License-Identifier: Apache-2.0
#include "farPatchTable.h"

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <numeric>

namespace OpenSubdivHex::FarExt::internal {

using Far::Index;
using OpenSubdiv::Far::PatchDescriptor;
using OpenSubdiv::Far::PatchTable;
using OpenSubdiv::Far::StencilTableReal;

namespace {

using Factory = OpenSubdiv::Far::PatchTableFactory;
using Descriptor = OpenSubdiv::Far::TopologyDescriptor;

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
        // What is protected in the base of another object can be reached through what is public.
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

// The quads, each with vertices of its own, and as many channels as are wanted.
std::unique_ptr<PatchTable> makeTable(PatchTableContent const &content) {
    auto const numPatches = int(content.params.size());
    std::vector<int> const sizes(std::size_t(numPatches), 4);
    std::vector<Index> verts(4 * std::size_t(numPatches));
    std::iota(verts.begin(), verts.end(), 0);
    Descriptor descriptor;
    descriptor.numVertices = 4 * numPatches;
    descriptor.numFaces = numPatches;
    descriptor.numVertsPerFace = sizes.data();
    descriptor.vertIndicesPerFace = verts.data();
    std::vector<Descriptor::FVarChannel> channels(content.channels.size());
    for (Descriptor::FVarChannel &channel : channels) {
        channel.numValues = descriptor.numVertices;
        channel.valueIndices = verts.data();
    }
    descriptor.numFVarChannels = int(channels.size());
    descriptor.fvarChannels = channels.data();
    OpenSubdiv::Sdc::Options sdcOptions;
    sdcOptions.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
    sdcOptions.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_NONE);
    std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> const refiner(
        OpenSubdiv::Far::TopologyRefinerFactory<Descriptor>::Create(
            descriptor, {OpenSubdiv::Sdc::SCHEME_CATMARK, sdcOptions}));
    if (!refiner) {
        return nullptr;
    }
    Factory::Options options(0);
    options.SetEndCapType(Factory::Options::ENDCAP_GREGORY_BASIS);
    options.generateLegacySharpCornerPatches = false;
    options.generateVaryingTables = !content.varyingVertices.empty();
    options.generateVaryingLocalPoints = !content.varyingVertices.empty();
    options.generateFVarTables = !channels.empty();
    options.generateFVarLegacyLinearPatches = false;
    options.patchPrecisionDouble = content.isDouble;
    options.fvarPatchPrecisionDouble = content.isFVarDouble;
    refiner->RefineAdaptive(options.GetRefineAdaptiveOptions());
    return std::unique_ptr<PatchTable>(Factory::Create(*refiner, options));
}

// What Far's accessors give of a table that is not constant.
template <typename ELEMENT, typename ARRAY>
void replace(ARRAY const &array, std::vector<ELEMENT> const &elements) {
    std::copy(elements.begin(), elements.end(), const_cast<ELEMENT *>(array.begin()));
}

bool replacePoints(bool isDouble, LocalPoints points, StencilTableReal<float> const *table,
                   StencilTableReal<double> const *doubleTable) {
    if (isDouble ? !doubleTable : !table) {
        return false;
    }
    if (isDouble) {
        FilledTable<double>(points.numControlPoints, std::move(points.sizes),
                            std::move(points.indices), std::move(points.doubleWeights))
            .MoveTo(const_cast<StencilTableReal<double> &>(*doubleTable));
    } else {
        FilledTable<float>(points.numControlPoints, std::move(points.sizes),
                           std::move(points.indices), std::move(points.weights))
            .MoveTo(const_cast<StencilTableReal<float> &>(*table));
    }
    return true;
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
    const_cast<OpenSubdiv::Far::PatchParamTable &>(table->GetPatchParamTable())
        .swap(content.params);
    bool isWell =
        replacePoints(content.isDouble, std::move(content.points),
                      content.isDouble ? nullptr : table->GetLocalPointStencilTable<float>(),
                      content.isDouble ? table->GetLocalPointStencilTable<double>() : nullptr);
    if (!content.varyingVertices.empty()) {
        replace(table->GetVaryingVertices(), content.varyingVertices);
        isWell =
            isWell &&
            replacePoints(
                content.isDouble, std::move(content.varyingPoints),
                content.isDouble ? nullptr : table->GetLocalPointVaryingStencilTable<float>(),
                content.isDouble ? table->GetLocalPointVaryingStencilTable<double>() : nullptr);
    }
    return isWell ? std::move(table) : nullptr;
}

} // namespace OpenSubdivHex::FarExt::internal
