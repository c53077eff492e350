// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_REGRESSION_BFR_EXT_STREAM_FIXTURE_H
#define OPENSUBDIVHEX_REGRESSION_BFR_EXT_STREAM_FIXTURE_H

#include "bfr_ext/patchStream.h"
#include "far_ext/executor.h"

#include <random>
#include <vector>

namespace OpenSubdivHex::Regression {

/// Restores the number of threads.
struct ThreadsScope {
    explicit ThreadsScope(int count) { FarExt::SetNumThreads(count); }
    ~ThreadsScope() { FarExt::SetNumThreads(0); }
    ThreadsScope(ThreadsScope const &) = delete;
    ThreadsScope &operator=(ThreadsScope const &) = delete;
};

/// A level for each face and edge of a mesh, below \p numLevels; must live as long as what Get() gives.
struct RandomPatchLevels {
    RandomPatchLevels(FarExt::TopologyLevel const &base, int numLevels, unsigned seed) {
        std::mt19937 random(seed);
        FarExt::SurfaceFaces const ofSurfaces(base.GetLevel());
        for (int face = 0; face < ofSurfaces.GetNumFaces(); ++face) {
            faces.push_back(int(random() % unsigned(numLevels)));
        }
        for (int edge = 0; edge < ofSurfaces.GetNumEdges(); ++edge) {
            edges.push_back(int(random() % unsigned(numLevels)));
        }
    }

    BfrExt::PatchLevels Get() const {
        return BfrExt::PatchLevels([this](int face) { return faces[std::size_t(face)]; },
                                   [this](int edge) { return edges[std::size_t(edge)]; });
    }

    std::vector<int> faces;
    std::vector<int> edges;
};

} // namespace OpenSubdivHex::Regression

#endif
