// SPDX-License-Identifier: Apache-2.0
//
// Tutorial description:
//
//     One mesh from many processes: MPI's ranks refine a share of the base faces each, and write one
//     file.
//
//     The surface of a base face needs no neighbours, and where its points and facets go in the file
//     follows from the base mesh and the levels alone.  So the ranks tell each other nothing: each
//     streams its faces to a sink that writes them to their places, and the file has the same bytes for
//     any number of ranks.
//
//     Usage: mpirun -n RANKS bfr_ext_2_2_processes MESH.ply LEVEL
//
#include "far_ext/executor.h"
#include "far_ext/topologyRefinerFactory.h"
#include "tools/mesh/shapes.h"
#include "tools/mesh/topologyDescriptor.h"
#include "tools/stream/plySink.h"

#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

using namespace OpenSubdivHex;

namespace {

/// Refines the share of one of the ranks.
bool run(char const *path, int level, int rank, int numRanks) {
    Tools::Mesh const cube = Tools::MakeCube();
    auto const refiner = FarExt::TopologyRefinerFactory::Create(Tools::DescribeTopology(cube));
    auto const factory = refiner ? BfrExt::SurfaceFactory::Create(*refiner) : nullptr;
    if (!factory) {
        return false;
    }
    // Finer towards one side; an edge is as fine as the finer of its faces.
    auto const getFaceLevel = [&](int face) { return face % 2 == 0 ? level : level - 1; };
    auto const getEdgeLevel = [&](int edge) {
        int result = 0;
        for (int const face : refiner->GetLevel(0).GetEdgeFaces(edge)) {
            result = std::max(result, getFaceLevel(face));
        }
        return result;
    };
    BfrExt::PatchStream<float> const stream(*factory,
                                            BfrExt::PatchLevels(getFaceLevel, getEdgeLevel));
    FarExt::CallStatus status;
    auto const numbering = Tools::PatchNumbering::Create(stream, &status);
    if (!numbering) {
        std::fprintf(stderr, "%s\n", status.GetErrorMessage().c_str());
        return false;
    }

    MPI_File file = MPI_FILE_NULL;
    if (MPI_File_open(MPI_COMM_WORLD, path, MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL,
                      &file) != MPI_SUCCESS) {
        std::fprintf(stderr, "%s: cannot be written\n", path);
        return false;
    }
    auto const write = [&](std::uint64_t offset, char const *bytes, std::size_t size) {
        return MPI_File_write_at(file, MPI_Offset(offset), bytes, int(size), MPI_BYTE,
                                 MPI_STATUS_IGNORE) == MPI_SUCCESS;
    };
    auto const sink = Tools::PlySink<float>::Create(*numbering, write, &status);
    bool isWritten = sink != nullptr;
    if (sink) {
        isWritten = MPI_File_set_size(file, MPI_Offset(sink->GetFileSize())) == MPI_SUCCESS;
        if (rank == 0) {
            isWritten = sink->WriteHeader() && isWritten;
        }
        // Ranks take all processors, and MPI's calls come from one thread each.
        FarExt::SetNumThreads(1);
        int const numFaces = factory->GetNumFaces();
        isWritten = stream.Run(cube.positions.data(), 3, numFaces * rank / numRanks,
                               numFaces * (rank + 1) / numRanks, *sink, &status) &&
                    sink->Flush() && isWritten;
    }
    isWritten = MPI_File_close(&file) == MPI_SUCCESS && isWritten;
    if (!isWritten) {
        std::fprintf(stderr, "%s: %s\n", path, status.GetErrorMessage().c_str());
    } else if (rank == 0) {
        std::printf("%lld points, %lld triangles\n",
                    static_cast<long long>(numbering->GetNumPoints()),
                    static_cast<long long>(numbering->GetNumFacets()));
    }
    return isWritten;
}

} // namespace

int main(int argc, char *argv[]) {
    MPI_Init(&argc, &argv);
    int rank = 0;
    int numRanks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &numRanks);
    bool isDone = false;
    if (argc == 3) {
        isDone = run(argv[1], std::atoi(argv[2]), rank, numRanks);
    } else if (rank == 0) {
        std::fprintf(stderr, "usage: %s MESH.ply LEVEL\n", argv[0]);
    }
    // All ranks have the same status.
    int result = isDone ? 1 : 0;
    int isDoneByAll = 0;
    MPI_Allreduce(&result, &isDoneByAll, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    MPI_Finalize();
    return isDoneByAll == 1 ? 0 : 1;
}
