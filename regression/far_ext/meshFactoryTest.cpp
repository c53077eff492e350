// SPDX-License-Identifier: Apache-2.0
//
// Level 0 from mesh classes of a user's own, and from refiners of Far that were assembled by hand.
#include "baseDifference.h"
#include "shapeFactory.h"

#include "regression/shapes/shapeDescriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <type_traits>

namespace OpenSubdivHex::Regression {

using FarExt::CallStatus;
using FarExt::ComponentType;
using FarExt::MeshRefinerFactory;
using FarExt::StatusCode;

namespace {

/// \brief Two quads, 0 1 2 3 and 3 2 4 5, and what a test has done beside or in place of what is right.
struct Mesh {
    using Step = std::function<bool(FarExt::BaseTopology &)>;
    Step resize = nullptr;
    Step assign = nullptr;
    Step tag = nullptr;
    Step assignValues = nullptr;
};

bool run(Mesh::Step const &step, FarExt::BaseTopology &base) { return !step || step(base); }

} // namespace
} // namespace OpenSubdivHex::Regression

namespace OpenSubdivHex::FarExt {

using Regression::Mesh;

/// All that the steps of the tests call.
struct Calls : MeshRefinerFactoryBase {
    using MeshRefinerFactoryBase::createBaseFVarChannel;
    using MeshRefinerFactoryBase::findBaseEdge;
    using MeshRefinerFactoryBase::getBaseFaceFVarValues;
    using MeshRefinerFactoryBase::getBaseFaceVertices;
    using MeshRefinerFactoryBase::getNumBaseEdges;
    using MeshRefinerFactoryBase::setBaseEdgeSharpness;
    using MeshRefinerFactoryBase::setBaseFaceHole;
    using MeshRefinerFactoryBase::setBaseVertexSharpness;
    using MeshRefinerFactoryBase::setNumBaseFaces;
    using MeshRefinerFactoryBase::setNumBaseFaceVertices;
    using MeshRefinerFactoryBase::setNumBaseVertices;
};

template <>
bool MeshRefinerFactory<Mesh>::resizeComponentTopology(BaseTopology &base, Mesh const &mesh) {
    setNumBaseVertices(base, 6);
    setNumBaseFaces(base, 2);
    setNumBaseFaceVertices(base, 0, 4);
    setNumBaseFaceVertices(base, 1, 4);
    return Regression::run(mesh.resize, base);
}

template <>
bool MeshRefinerFactory<Mesh>::assignComponentTopology(BaseTopology &base, Mesh const &mesh) {
    int const verts[2][4] = {{0, 1, 2, 3}, {3, 2, 4, 5}};
    for (int face = 0; face < getNumBaseFaces(base); ++face) {
        for (int i = 0; i < getBaseFaceVertices(base, face).size() && i < 4; ++i) {
            getBaseFaceVertices(base, face)[i] = verts[face][i];
        }
    }
    return Regression::run(mesh.assign, base);
}

template <>
bool MeshRefinerFactory<Mesh>::assignComponentTags(BaseTopology &base, Mesh const &mesh) {
    return Regression::run(mesh.tag, base);
}

template <>
bool MeshRefinerFactory<Mesh>::assignFaceVaryingTopology(BaseTopology &base, Mesh const &mesh) {
    return Regression::run(mesh.assignValues, base);
}

} // namespace OpenSubdivHex::FarExt

namespace OpenSubdivHex::Regression {

using FarExt::BaseTopology;
using FarExt::Calls;

namespace {

void expectRefused(Mesh const &mesh, StatusCode code, ComponentType component, int index,
                   std::string const &word) {
    CallStatus status;
    EXPECT_FALSE(MeshRefinerFactory<Mesh>::Create(mesh, Sdc::Options(), &status)) << word;
    EXPECT_EQ(status.GetCode(), code) << status.GetErrorMessage();
    EXPECT_EQ(status.GetComponentType(), component) << status.GetErrorMessage();
    EXPECT_EQ(status.GetComponentIndex(), index) << status.GetErrorMessage();
    EXPECT_NE(status.GetErrorMessage().find(word), std::string::npos) << status.GetErrorMessage();
}

/// A step that makes a call and succeeds.
template <typename CALL>
Mesh::Step make(CALL call) {
    return [call](BaseTopology &base) {
        call(base);
        return true;
    };
}

} // namespace

TEST(MeshFactory, EqualsTheDescriptorOfAllShapes) {
    for (Shape const &shape : GetShapes()) {
        if (shape.leftHanded) {
            continue;
        }
        for (auto boundary : kBoundaries) {
            SCOPED_TRACE(shape.name + ", boundary " + std::to_string(boundary));
            Sdc::Options options;
            options.SetVtxBoundaryInterpolation(boundary);
            CallStatus status;
            auto const refiner = MeshRefinerFactory<Shape>::Create(shape, options, &status);
            ASSERT_TRUE(refiner) << status.GetErrorMessage();
            ShapeDescriptor const descriptor(shape);
            auto const expected = FarExt::TopologyRefinerFactory::Create(descriptor.Get(), options);
            EXPECT_EQ(FindBaseDifference(*refiner, *expected), "");
            EXPECT_EQ(refiner->GetSchemeOptions().GetVtxBoundaryInterpolation(), boundary);
        }
    }
}

TEST(MeshFactory, TagsAndValuesAreThoseOfTheCalls) {
    Mesh mesh;
    mesh.tag = make([](BaseTopology &base) {
        EXPECT_EQ(Calls::getNumBaseEdges(base), 7);
        EXPECT_EQ(Calls::findBaseEdge(base, 0, 2), Far::INDEX_INVALID);
        EXPECT_EQ(Calls::findBaseEdge(base, 0, 17), Far::INDEX_INVALID);
        EXPECT_EQ(Calls::findBaseEdge(base, 2, 3), 2);
        Calls::setBaseEdgeSharpness(base, Calls::findBaseEdge(base, 3, 2), 2.5f);
        Calls::setBaseVertexSharpness(base, 4, 1.5f);
        Calls::setBaseFaceHole(base, 0, true);
        Calls::setBaseFaceHole(base, 1, true);
        Calls::setBaseFaceHole(base, 0, false);
    });
    mesh.assignValues = make([](BaseTopology &base) {
        Sdc::Options linear;
        linear.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_ALL);
        EXPECT_EQ(Calls::createBaseFVarChannel(base, 6), 0);
        EXPECT_EQ(Calls::createBaseFVarChannel(base, 1, linear), 1);
        for (int face : {0, 1}) {
            for (int i = 0; i < 4; ++i) {
                Calls::getBaseFaceFVarValues(base, face)[i] = face + i;
                Calls::getBaseFaceFVarValues(base, face, 1)[i] = 0;
            }
        }
    });
    Sdc::Options options;
    options.SetFVarLinearInterpolation(Sdc::Options::FVAR_LINEAR_CORNERS_ONLY);
    auto const refiner = MeshRefinerFactory<Mesh>::Create(mesh, options);
    ASSERT_TRUE(refiner);
    FarExt::TopologyLevel const &level = refiner->GetLevel(0);
    EXPECT_EQ(level.GetEdgeSharpness(2), 2.5f);
    EXPECT_EQ(level.GetVertexSharpness(4), 1.5f);
    EXPECT_FALSE(level.IsFaceHole(0));
    EXPECT_TRUE(level.IsFaceHole(1));
    ASSERT_EQ(level.GetNumFVarChannels(), 2);
    EXPECT_EQ(level.GetNumFVarValues(1), 1);
    EXPECT_EQ(level.GetFaceFVarValues(1, 0)[3], 4);
    EXPECT_EQ(refiner->GetFVarLinearInterpolation(0), Sdc::Options::FVAR_LINEAR_CORNERS_ONLY);
    EXPECT_EQ(refiner->GetFVarLinearInterpolation(1), Sdc::Options::FVAR_LINEAR_ALL);
    EXPECT_TRUE(refiner->RefineUniform(2));
}

TEST(MeshFactory, CountsAndFacesAreChecked) {
    Mesh mesh;
    auto const expectResizeRefused = [&](auto call, StatusCode code, ComponentType component,
                                         int index, std::string const &word) {
        Mesh broken;
        broken.resize = make(call);
        expectRefused(broken, code, component, index, word);
    };
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseVertices(base, -2); },
                        StatusCode::InvalidArgument, ComponentType::NoComponent, -1, "-2");
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaces(base, -3); },
                        StatusCode::InvalidArgument, ComponentType::NoComponent, -1, "-3");
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaces(base, 0); },
                        StatusCode::InvalidTopology, ComponentType::NoComponent, -1, "empty");
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaces(base, 3); },
                        StatusCode::InvalidTopology, ComponentType::Face, 0, "0 vertices");
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaceVertices(base, 1, 2); },
                        StatusCode::InvalidTopology, ComponentType::Face, 1, "2 vertices");
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaceVertices(base, 2, 4); },
                        StatusCode::InvalidTopology, ComponentType::Face, 2,
                        "setNumBaseFaceVertices");
    // A face that has more vertices than were assigned.
    expectResizeRefused([](BaseTopology &base) { Calls::setNumBaseFaceVertices(base, 1, 5); },
                        StatusCode::InvalidTopology, ComponentType::Face, 1, "vertex -1");
    mesh.assign = make([](BaseTopology &base) { Calls::getBaseFaceVertices(base, 1)[2] = 6; });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Face, 1, "vertex 6");
    mesh.assign =
        make([](BaseTopology &base) { EXPECT_EQ(Calls::getBaseFaceVertices(base, -1).size(), 0); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Face, -1,
                  "getBaseFaceVertices");
}

TEST(MeshFactory, TagsAreChecked) {
    Mesh mesh;
    for (float sharpness : {-1.0f, std::nanf("")}) {
        mesh.tag =
            make([=](BaseTopology &base) { Calls::setBaseEdgeSharpness(base, 1, sharpness); });
        expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Edge, 1, "sharpness");
        mesh.tag =
            make([=](BaseTopology &base) { Calls::setBaseVertexSharpness(base, 5, sharpness); });
        expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Vertex, 5, "sharpness");
    }
    mesh.tag = make([](BaseTopology &base) { Calls::setBaseEdgeSharpness(base, -1, 1); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Edge, -1,
                  "setBaseEdgeSharpness");
    mesh.tag = make([](BaseTopology &base) { Calls::setBaseVertexSharpness(base, 6, 1); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Vertex, 6,
                  "setBaseVertexSharpness");
    mesh.tag = make([](BaseTopology &base) { Calls::setBaseFaceHole(base, 2, true); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Face, 2, "setBaseFaceHole");
    // The first cause counts.
    mesh.tag = make([](BaseTopology &base) {
        Calls::setBaseVertexSharpness(base, 2, -4);
        Calls::setBaseFaceHole(base, 2, true);
    });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Vertex, 2, "-4");
}

TEST(MeshFactory, ValuesAreChecked) {
    Mesh mesh;
    mesh.assignValues = make([](BaseTopology &base) { Calls::createBaseFVarChannel(base, 4); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::NoComponent, -1,
                  "corner 0 of face-varying channel 0 refers to value -1");
    mesh.assignValues = make([](BaseTopology &base) { Calls::createBaseFVarChannel(base, -4); });
    expectRefused(mesh, StatusCode::InvalidArgument, ComponentType::NoComponent, -1, "-4");
    mesh.assignValues = make(
        [](BaseTopology &base) { EXPECT_EQ(Calls::getBaseFaceFVarValues(base, 0).size(), 0); });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::NoComponent, 0, "channel");
    mesh.assignValues = make([](BaseTopology &base) {
        Calls::createBaseFVarChannel(base, 4);
        EXPECT_EQ(Calls::getBaseFaceFVarValues(base, 2).size(), 0);
    });
    expectRefused(mesh, StatusCode::InvalidTopology, ComponentType::Face, 2,
                  "getBaseFaceFVarValues");
}

// A call in a function that it is not for would change complete data, or find
// no room: it is refused.
TEST(MeshFactory, CallsAreForTheirFunctions) {
    struct Call {
        char const *name;
        int stage; // of kSteps
        void (*call)(BaseTopology &);
    };
    Call const calls[] = {
        {"setNumBaseVertices", 0, [](BaseTopology &base) { Calls::setNumBaseVertices(base, 6); }},
        {"setNumBaseFaces", 0, [](BaseTopology &base) { Calls::setNumBaseFaces(base, 1); }},
        {"setNumBaseFaceVertices", 0,
         [](BaseTopology &base) { Calls::setNumBaseFaceVertices(base, 0, 4); }},
        {"getBaseFaceVertices", 1,
         [](BaseTopology &base) { EXPECT_EQ(Calls::getBaseFaceVertices(base, 0).size(), 0); }},
        {"setBaseEdgeSharpness", 2,
         [](BaseTopology &base) { Calls::setBaseEdgeSharpness(base, 0, 1); }},
        {"setBaseVertexSharpness", 2,
         [](BaseTopology &base) { Calls::setBaseVertexSharpness(base, 0, 1); }},
        {"setBaseFaceHole", 2, [](BaseTopology &base) { Calls::setBaseFaceHole(base, 0, true); }},
        {"createBaseFVarChannel", 3,
         [](BaseTopology &base) {
             EXPECT_EQ(Calls::createBaseFVarChannel(base, 4), Far::INDEX_INVALID);
         }},
        {"getBaseFaceFVarValues", 3,
         [](BaseTopology &base) { EXPECT_EQ(Calls::getBaseFaceFVarValues(base, 0).size(), 0); }},
    };
    constexpr struct {
        Mesh::Step Mesh::*step;
        char const *name;
    } kSteps[] = {{&Mesh::resize, "resizeComponentTopology"},
                  {&Mesh::assign, "assignComponentTopology"},
                  {&Mesh::tag, "assignComponentTags"},
                  {&Mesh::assignValues, "assignFaceVaryingTopology"}};
    for (Call const &call : calls) {
        for (int stage = 0; stage < 4; ++stage) {
            if (stage != call.stage) {
                Mesh mesh;
                mesh.*kSteps[stage].step = make(call.call);
                expectRefused(mesh, StatusCode::InvalidArgument, ComponentType::NoComponent, -1,
                              std::string(call.name) + " is for " + kSteps[call.stage].name +
                                  ", not for " + kSteps[stage].name);
            }
        }
    }
}

TEST(MeshFactory, AFunctionMayRefuse) {
    auto const no = [](BaseTopology &) { return false; };
    expectRefused({no}, StatusCode::InvalidTopology, ComponentType::NoComponent, -1,
                  "resizeComponentTopology returned false");
    expectRefused({nullptr, no}, StatusCode::InvalidTopology, ComponentType::NoComponent, -1,
                  "assignComponentTopology returned false");
    expectRefused({nullptr, nullptr, no}, StatusCode::InvalidTopology, ComponentType::NoComponent,
                  -1, "assignComponentTags returned false");
    expectRefused({nullptr, nullptr, nullptr, no}, StatusCode::InvalidTopology,
                  ComponentType::NoComponent, -1, "assignFaceVaryingTopology returned false");
}

namespace {

/// The base level of Far, to be changed.
OpenSubdiv::Vtr::internal::Level &getLevel(Far::TopologyRefiner const &base) {
    return const_cast<OpenSubdiv::Vtr::internal::Level &>(base.getLevel(0));
}

} // namespace

TEST(HandMadeRefiner, EdgesMayRunTheOtherWay) {
    for (char const *name : {"cube", "quadGrid", "mixedPatch"}) {
        SCOPED_TRACE(name);
        auto const base = CreateFarRefiner(GetShape(name));
        for (int edge = 0; edge < base->GetLevel(0).GetNumEdges(); edge += 3) {
            auto verts = getLevel(*base).getEdgeVertices(edge);
            std::swap(verts[0], verts[1]);
        }
        CallStatus status;
        auto const refiner = FarExt::TopologyRefinerFactory::Create(*base, &status);
        ASSERT_TRUE(refiner) << status.GetErrorMessage();
        FarExt::TopologyLevel const &level = refiner->GetLevel(0);
        EXPECT_TRUE(level.Validate(&status)) << status.GetErrorMessage();
        EXPECT_EQ(FindFarDifference(*refiner, base->GetLevel(0)), "");
        for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
            if (!level.IsEdgeBoundary(edge)) {
                EXPECT_EQ(level.GetEdgeVertices(edge)[0],
                          base->GetLevel(0).GetEdgeVertices(edge)[0]);
            }
        }
        EXPECT_TRUE(refiner->RefineUniform(2));
    }
}

TEST(HandMadeRefiner, FacesMayBeginElsewhereAroundAVertex) {
    Shape const &shape = GetShape("cube");
    auto const base = CreateFarRefiner(shape);
    auto const expected = FarExt::TopologyRefinerFactory::Create(*base);
    auto const rotate = [](auto array) {
        std::rotate(array.begin(), array.begin() + 1, array.end());
    };
    auto &level = getLevel(*base);
    for (int vert : {1, 4}) {
        rotate(level.getVertexFaces(vert));
        rotate(level.getVertexFaceLocalIndices(vert));
        rotate(level.getVertexEdges(vert));
        rotate(level.getVertexEdgeLocalIndices(vert));
    }
    auto const refiner = FarExt::TopologyRefinerFactory::Create(*base);
    ASSERT_TRUE(refiner);
    EXPECT_EQ(FindBaseDifference(*refiner, *expected), "");
}

// One number of all relations is wrong: what is around vertices is found anew, and edges that are not
// what their faces say are refused.
TEST(HandMadeRefiner, NothingWrongIsCopied) {
    for (char const *name : {"cube", "quadGrid", "mixedPatch", "octahedron"}) {
        SCOPED_TRACE(name);
        auto const base = CreateFarRefiner(GetShape(name));
        auto const expected = FarExt::TopologyRefinerFactory::Create(*base);
        auto &level = getLevel(*base);
        auto const expectNotCopied = [&](auto array, int numValues, bool isOfVertex) {
            for (auto &number : array) {
                auto const right = number;
                number = std::decay_t<decltype(number)>((number + 1) % numValues);
                auto const refiner = FarExt::TopologyRefinerFactory::Create(*base);
                number = right;
                ASSERT_TRUE(refiner || !isOfVertex);
                ASSERT_EQ(refiner ? FindBaseDifference(*refiner, *expected) : "", "");
            }
        };
        for (int vert = 0; vert < level.getNumVertices(); ++vert) {
            SCOPED_TRACE("vertex " + std::to_string(vert));
            expectNotCopied(level.getVertexFaces(vert), level.getNumFaces(), true);
            expectNotCopied(level.getVertexFaceLocalIndices(vert), 3, true);
            expectNotCopied(level.getVertexEdges(vert), level.getNumEdges(), true);
        }
        for (int edge = 0; edge < level.getNumEdges(); ++edge) {
            SCOPED_TRACE("edge " + std::to_string(edge));
            expectNotCopied(level.getEdgeVertices(edge), level.getNumVertices(), false);
            expectNotCopied(level.getEdgeFaces(edge), level.getNumFaces(), false);
            expectNotCopied(level.getEdgeFaceLocalIndices(edge), 3, false);
        }
        for (int face = 0; face < level.getNumFaces(); ++face) {
            SCOPED_TRACE("face " + std::to_string(face));
            expectNotCopied(level.getFaceEdges(face), level.getNumEdges(), false);
        }
    }
}

TEST(HandMadeRefiner, EdgesThatAreNoneOfTheirFacesAreNamed) {
    auto const expectNamed = [](auto damage, int edge) {
        auto const base = CreateFarRefiner(GetShape("cube"));
        damage(getLevel(*base));
        CallStatus status;
        EXPECT_FALSE(FarExt::TopologyRefinerFactory::Create(*base, &status));
        EXPECT_EQ(status.GetCode(), StatusCode::InvalidTopology);
        EXPECT_EQ(status.GetComponentType(), ComponentType::Edge) << status.GetErrorMessage();
        EXPECT_EQ(status.GetComponentIndex(), edge) << status.GetErrorMessage();
        EXPECT_NE(status.GetErrorMessage().find("edge " + std::to_string(edge)), std::string::npos);
    };
    expectNamed([](auto &level) { level.getEdgeVertices(5)[0] = 7 - level.getEdgeVertices(5)[0]; },
                5);
    expectNamed([](auto &level) { level.getEdgeFaces(3)[1] = 5 - level.getEdgeFaces(3)[1]; }, 3);
    expectNamed(
        [](auto &level) {
            int const first = level.getFaceEdges(2)[0];
            level.getFaceEdges(2)[0] = first == 0 ? 1 : 0;
        },
        CreateFarRefiner(GetShape("cube"))->GetLevel(0).GetFaceEdges(2)[0]);
}

} // namespace OpenSubdivHex::Regression
