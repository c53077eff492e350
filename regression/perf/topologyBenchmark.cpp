// SPDX-License-Identifier: Apache-2.0
//
// Topology of all levels, with all incidences or with face-vertices alone in the last one, against
// Far's: nanoseconds per vertex of the last level.  Refiners with the base level are made before,
// a new one for each turn.
#include "makers.h"
#include "suite.h"

namespace OpenSubdivHex::Regression {

void AddTopologyBenchmarks(Suite &suite) {
    for (Memory memory : {Memory::Default, Memory::Warm}) {
        for (BenchMesh const &mesh : suite.GetMeshes()) {
            for (bool isFull : {true, false}) {
                Setting const setting{isFull ? "topology-full" : "topology-faces", "vertex", mesh,
                                      memory};
                suite.AddContest(setting, [=] {
                    return Contest{{MakeTopologyContestant(mesh, isFull, 1),
                                    MakeFarTopologyContestant(mesh, isFull)},
                                   {{setting.work, 0, {1}}}};
                });
            }
        }
    }
}

} // namespace OpenSubdivHex::Regression
