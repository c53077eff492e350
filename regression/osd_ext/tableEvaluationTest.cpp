// SPDX-License-Identifier: Apache-2.0
//
// The functions of the evaluators that take buffers and tables.
#include "evaluatorWorkspace.h"

#include "osd_ext/cpuEvaluator.h"
#include "osd_ext/stencilEvaluator.h"
#include "regression/shapes/shapeDescriptor.h"

#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuVertexBuffer.h>
#include <opensubdiv/osd/mesh.h>

#include <limits>
#include <memory>

namespace OpenSubdivHex::Regression::tableEvaluationTest {
namespace {

using Buffer = std::unique_ptr<Osd::CpuVertexBuffer>;

Buffer makeBuffer(int numElements, int numVertices) {
    Buffer buffer(Osd::CpuVertexBuffer::Create(numElements, numVertices));
    std::fill_n(buffer->BindCpuBuffer(), numElements * numVertices, kGuard);
    return buffer;
}

Buffer makeSource(int numVertices) {
    Buffer buffer = makeBuffer(3, numVertices);
    FillSources(buffer->BindCpuBuffer(), Descriptor(0, 3, 3), numVertices);
    return buffer;
}

void expectSameValues(Buffer const &actual, Buffer const &expected) {
    ASSERT_EQ(actual->GetNumVertices(), expected->GetNumVertices());
    for (int i = 0; i < 3 * actual->GetNumVertices(); ++i) {
        float const value = expected->BindCpuBuffer()[i];
        ASSERT_NEAR(actual->BindCpuBuffer()[i], value, 1e-5 * (1 + std::abs(value))) << i;
    }
}

struct TableWithoutOffsets : Far::StencilTable {
    explicit TableWithoutOffsets(Far::StencilTable const &table)
        : Far::StencilTable(table.GetNumControlVertices()) {
        _sizes = table.GetSizes();
        _indices = table.GetControlIndices();
        _weights = table.GetWeights();
    }
};

/// As far as sizes go.
struct TableOfSizes : Far::StencilTable {
    TableOfSizes(int numControlVertices, int numStencils) : Far::StencilTable(numControlVertices) {
        _sizes.resize(std::size_t(numStencils));
    }
};

/// Records the sizes that buffers are created with.
struct BufferOfSizes {
    static BufferOfSizes *Create(int numElements, int numVertices) {
        return new BufferOfSizes{numElements, numVertices};
    }
    int GetNumElements() const { return numElements; }

    int numElements;
    int numVertices;
};

/// Keeps the offset of what is to be written.
struct OffsetEvaluator {
    static bool EvalStencils(BufferOfSizes *, Osd::BufferDescriptor const &, BufferOfSizes *,
                             Osd::BufferDescriptor const &dstDesc, Far::StencilTable const *) {
        offset = dstDesc.offset;
        return true;
    }
    static inline int offset = -1;
};

TEST(EvaluationOfTables, RefusesBuffersThatIntsDoNotCount) {
    constexpr int kMost = std::numeric_limits<int>::max();
    struct Case {
        int numElements;
        int numControlVertices;
        int numStencils;
        bool hasBuffer;
    };
    for (Case const &c :
         {Case{3, kMost / 3 - 10, 10, true}, Case{3, kMost / 3 - 10, 11, false},
          Case{1, kMost, 0, true}, Case{1, kMost, 1, false}, Case{64, 50000000, 5, false},
          Case{0, 8, 5, false}, Case{-1, 8, 5, false}}) {
        TableOfSizes const table(c.numControlVertices, c.numStencils);
        auto const buffer = OsdExt::CreateInPlaceBuffer<BufferOfSizes>(table, c.numElements);
        ASSERT_EQ(buffer != nullptr, c.hasBuffer);
        if (buffer) {
            EXPECT_EQ(buffer->numElements, c.numElements);
            EXPECT_EQ(buffer->numVertices, c.numControlVertices + c.numStencils);
        }
    }
    TableOfSizes const table(kMost / 3, 1);
    BufferOfSizes buffer = {3, 0};
    EXPECT_TRUE(OsdExt::EvalStencilsInPlace<OffsetEvaluator>(table, &buffer));
    EXPECT_EQ(OffsetEvaluator::offset, kMost / 3 * 3);
    OffsetEvaluator::offset = -1;
    for (int const numElements : {4, 100, 0, -1}) {
        buffer.numElements = numElements;
        EXPECT_FALSE(OsdExt::EvalStencilsInPlace<OffsetEvaluator>(table, &buffer));
    }
    BufferOfSizes *const none = nullptr;
    EXPECT_FALSE(OsdExt::EvalStencilsInPlace<OffsetEvaluator>(table, none));
    EXPECT_FALSE(OsdExt::EvalStencils<OffsetEvaluator>(table, none, &buffer));
    EXPECT_FALSE(OsdExt::EvalStencils<OffsetEvaluator>(table, &buffer, none));
    EXPECT_EQ(OffsetEvaluator::offset, -1);
}

template <class EVALUATOR>
class EvaluatorOfTables : public testing::Test {};
using EvaluatorTypes = testing::Types<OsdExt::CpuEvaluator, OsdExt::ParallelEvaluator>;
TYPED_TEST_SUITE(EvaluatorOfTables, EvaluatorTypes, );

TYPED_TEST(EvaluatorOfTables, TakesTablesOfEitherLibrary) {
    auto const hex = MakeHexTable("prism5", 3);
    auto const catmark = MakeCatmarkTable("prism5", 4);
    TableWithoutOffsets const withoutOffsets(*catmark);
    struct Case {
        Far::StencilTable const *table;
        Far::StencilTable const *equalTable; ///< that Osd takes
    };
    for (auto const &[table, equalTable] :
         {Case{hex.get(), hex.get()}, Case{catmark.get(), catmark.get()},
          Case{&withoutOffsets, catmark.get()}}) {
        Buffer const src = makeSource(table->GetNumControlVertices());
        Buffer const expected = makeBuffer(3, table->GetNumStencils());
        Buffer const actual = makeBuffer(3, table->GetNumStencils());
        ASSERT_TRUE(
            OsdExt::EvalStencils<Osd::CpuEvaluator>(*equalTable, src.get(), expected.get()));
        ASSERT_TRUE(OsdExt::EvalStencils<TypeParam>(*table, src.get(), actual.get()));
        ASSERT_NO_FATAL_FAILURE(expectSameValues(actual, expected));

        auto const inPlace = OsdExt::CreateInPlaceBuffer<Osd::CpuVertexBuffer>(*table, 3);
        inPlace->UpdateData(src->BindCpuBuffer(), 0, table->GetNumControlVertices());
        ASSERT_TRUE(OsdExt::EvalStencilsInPlace<TypeParam>(*table, inPlace.get()));
        EXPECT_TRUE(std::equal(actual->BindCpuBuffer(),
                               actual->BindCpuBuffer() + 3 * table->GetNumStencils(),
                               inPlace->BindCpuBuffer() + 3 * table->GetNumControlVertices()));
    }
}

TYPED_TEST(EvaluatorOfTables, TakesInstanceAndContext) {
    auto const table = MakeHexTable("cube", 1);
    Buffer const src = makeSource(8);
    Buffer const dst = makeBuffer(3, table->GetNumStencils());
    Descriptor const desc(0, 3, 3);
    TypeParam const instance;
    int context = 0;
    EXPECT_TRUE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, table.get(), &instance,
                                        &context));
    TypeParam::Synchronize(&context);
    EXPECT_NE(dst->BindCpuBuffer()[0], kGuard);
}

TYPED_TEST(EvaluatorOfTables, TakesEmptyAndRefusesNull) {
    struct EmptyTable : Far::StencilTable {
        EmptyTable() : Far::StencilTable(0) {}
    } const empty;
    Buffer const src = makeSource(1);
    Buffer const dst = makeBuffer(3, 1);
    Descriptor const desc(0, 3, 3);
    EXPECT_TRUE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, &empty));
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, dst.get(), Descriptor(0, 2, 3), &empty));
    EXPECT_EQ(dst->BindCpuBuffer()[0], kGuard);
    // As Osd does not.
    EXPECT_FALSE(Osd::CpuEvaluator::EvalStencils(src.get(), desc, dst.get(), desc, &empty));

    auto const table = MakeHexTable("cube", 1);
    Osd::CpuVertexBuffer *const noBuffer = nullptr;
    EXPECT_FALSE(TypeParam::EvalStencils(noBuffer, desc, dst.get(), desc, table.get()));
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, noBuffer, desc, table.get()));
    Far::StencilTable const *const noTable = nullptr;
    EXPECT_FALSE(TypeParam::EvalStencils(src.get(), desc, dst.get(), desc, noTable));
}

std::unique_ptr<Far::LimitStencilTable const> makeLimitTable(bool first, bool second) {
    auto const refiner = CreateFarRefiner(GetShape("torus"));
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(3));
    std::vector<float> const s = {0.0f, 0.25f, 0.5f, 0.8f, 1.0f};
    std::vector<float> const t = {0.1f, 0.9f, 0.5f, 0.0f, 0.3f};
    Far::LimitStencilTableFactory::LocationArrayVec locations;
    int const numFaces = Far::PtexIndices(*refiner).GetNumFaces();
    for (int face = 0; face < numFaces; ++face) {
        Far::LimitStencilTableFactory::LocationArray array;
        array.ptexIdx = face;
        array.numLocations = int(s.size());
        array.s = s.data();
        array.t = t.data();
        locations.push_back(array);
    }
    Far::LimitStencilTableFactory::Options options;
    options.generate1stDerivatives = first;
    options.generate2ndDerivatives = second;
    return std::unique_ptr<Far::LimitStencilTable const>(
        Far::LimitStencilTableFactory::Create(*refiner, locations, nullptr, nullptr, options));
}

TYPED_TEST(EvaluatorOfTables, TakesLimitStencilTables) {
    auto const table = makeLimitTable(true, true);
    ASSERT_TRUE(table);
    Buffer const src = makeSource(table->GetNumControlVertices());
    std::vector<Buffer> expected;
    std::vector<Buffer> first;
    std::vector<Buffer> second;
    for (int i = 0; i < kNumOutputs; ++i) {
        expected.push_back(makeBuffer(3, table->GetNumStencils()));
        first.push_back(makeBuffer(3, table->GetNumStencils()));
        second.push_back(makeBuffer(3, table->GetNumStencils()));
    }
    Descriptor const d(0, 3, 3);
    ASSERT_TRUE(Osd::CpuEvaluator::EvalStencils(
        src.get(), d, expected[0].get(), d, expected[1].get(), d, expected[2].get(), d,
        expected[3].get(), d, expected[4].get(), d, expected[5].get(), d, table.get()));
    ASSERT_TRUE(TypeParam::EvalStencils(src.get(), d, first[0].get(), d, first[1].get(), d,
                                        first[2].get(), d, table.get()));
    ASSERT_TRUE(TypeParam::EvalStencils(src.get(), d, second[0].get(), d, second[1].get(), d,
                                        second[2].get(), d, second[3].get(), d, second[4].get(), d,
                                        second[5].get(), d, table.get()));
    for (std::size_t i = 0; i < kNumOutputs; ++i) {
        SCOPED_TRACE(i);
        ASSERT_NO_FATAL_FAILURE(expectSameValues(second[i], expected[i]));
        if (i < 3) {
            ASSERT_NO_FATAL_FAILURE(expectSameValues(first[i], expected[i]));
        }
    }
}

TYPED_TEST(EvaluatorOfTables, RefusesDerivativesThatTheTableHasNot) {
    Descriptor const d(0, 3, 3);
    for (bool const hasFirst : {false, true}) {
        auto const table = makeLimitTable(hasFirst, false);
        Buffer const src = makeSource(table->GetNumControlVertices());
        Buffer const dst = makeBuffer(3, table->GetNumStencils());
        if (!hasFirst) {
            EXPECT_FALSE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, dst.get(), d,
                                                 dst.get(), d, table.get()));
        }
        EXPECT_FALSE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, dst.get(), d, dst.get(), d,
                                             dst.get(), d, dst.get(), d, dst.get(), d,
                                             table.get()));
        EXPECT_EQ(dst->BindCpuBuffer()[0], kGuard);
        EXPECT_TRUE(TypeParam::EvalStencils(src.get(), d, dst.get(), d, table.get()));
    }
}

/// Adds the functions that Osd::Mesh needs to Osd::CpuVertexBuffer.
struct MeshBuffer : Osd::CpuVertexBuffer {
    static MeshBuffer *Create(int numElements, int numVertices, void * /*context*/ = nullptr) {
        auto buffer = std::make_unique<MeshBuffer>(numElements, numVertices);
        buffer->values.resize(std::size_t(numElements) * std::size_t(numVertices));
        return buffer.release();
    }
    MeshBuffer(int numElements, int numVertices)
        : Osd::CpuVertexBuffer(numElements, numVertices), width(numElements) {}
    void UpdateData(float const *src, int start, int count, void * /*context*/) {
        std::copy_n(src, count * width, values.begin() + start * width);
    }
    float *BindCpuBuffer() { return values.data(); }
    float *BindVBO(void * /*context*/) { return BindCpuBuffer(); }

    int width;
    std::vector<float> values;
};

struct MeshPatchTable {
    using VertexBufferBinding = float *;
    static MeshPatchTable *Create(Far::PatchTable const * /*table*/, void * /*context*/) {
        return new MeshPatchTable;
    }
};

template <class EVALUATOR>
std::vector<float> refineMesh() {
    Shape const &shape = GetShape("torus");
    using Mesh = Osd::Mesh<MeshBuffer, Far::StencilTable, EVALUATOR, MeshPatchTable>;
    Osd::MeshBitset bits;
    bits.set(Osd::MeshInterleaveVarying);
    Mesh mesh(CreateFarRefiner(shape).release(), 3, 2, 2, bits);
    std::vector<float> controls(std::size_t(5 * shape.GetNumVertices()));
    FillSources(controls.data(), Descriptor(0, 5, 5), shape.GetNumVertices());
    mesh.UpdateVertexBuffer(controls.data(), 0, shape.GetNumVertices());
    mesh.Refine();
    mesh.Synchronize();
    return mesh.GetVertexBuffer()->values;
}

TYPED_TEST(EvaluatorOfTables, ServesOsdMesh) {
    std::vector<float> const expected = refineMesh<Osd::CpuEvaluator>();
    std::vector<float> const actual = refineMesh<TypeParam>();
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i) {
        ASSERT_NEAR(actual[i], expected[i], 1e-5) << i;
    }
}

} // namespace
} // namespace OpenSubdivHex::Regression::tableEvaluationTest
