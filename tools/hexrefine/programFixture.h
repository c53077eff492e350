// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PROGRAM_FIXTURE_H
#define OPENSUBDIVHEX_TOOLS_PROGRAM_FIXTURE_H

#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/meshReader.h"
#include "tools/mesh/meshWriter.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/testFolder.h"
#include "tools/mesh/topologyDescriptor.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace OpenSubdivHex::Tools {

using Json = nlohmann::ordered_json;

struct Result {
    int status;
    std::string out;
    std::string error;
};

class Hexrefine : public TestFolder {
protected:
    Result run(std::string const &arguments, std::string const &before = "") const {
        int const status = runProgram(HEXREFINE_PROGRAM, arguments, before);
        std::string const out = getPath("stdout");
        std::string const error = getPath("stderr");
        Result result{status, getContent(out), getContent(error)};
        std::filesystem::remove(out);
        std::filesystem::remove(error);
        return result;
    }

    std::string makeCubeFile() const {
        WriteMesh(MakeCube(), getPath("cube.obj"));
        return getPath("cube.obj");
    }

    /// Expects exit status 1, one line on stderr that begins with the file, and no output.
    void expectFailure(std::string const &arguments, std::string const &path,
                       std::string const &cause, std::string const &before = "") const {
        Result const result = run(arguments, before);
        EXPECT_EQ(result.status, 1) << arguments;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(result.error.rfind("hexrefine: " + path + ": ", 0), 0u) << result.error;
        EXPECT_NE(result.error.find(cause), std::string::npos) << result.error;
        EXPECT_EQ(result.error.find('\n'), result.error.size() - 1) << result.error;
    }

    void expectBadUsage(std::string const &arguments, std::string const &cause) const {
        Result const result = run(arguments);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.error.find(cause), std::string::npos) << result.error;
    }
};

/// Whether the faces make a closed, manifold, consistently oriented surface.
inline void expectClosed(Mesh const &mesh) {
    FarExt::CallStatus status;
    auto const refiner =
        FarExt::TopologyRefinerFactory::Create(DescribeTopology(mesh), Sdc::Options(), &status);
    ASSERT_TRUE(refiner) << status.GetErrorMessage();
    EXPECT_EQ(refiner->GetLevel(0).GetNumBoundaryEdges(), 0);
    EXPECT_TRUE(refiner->GetLevel(0).Validate(&status)) << status.GetErrorMessage();
}

} // namespace OpenSubdivHex::Tools

#endif
