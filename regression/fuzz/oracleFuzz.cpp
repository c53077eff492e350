// SPDX-License-Identifier: Apache-2.0
//
// Meshes with tags, options and channels, made of bytes, against each other and the reference.
#include "apart.h"
#include "oracle.h"

#include <cstdlib>
#include <iostream>

#ifdef _OPENMP
#include <omp.h>
#endif

using namespace OpenSubdivHex::Regression;

namespace {

void setOneThread() {
#ifdef _OPENMP
    omp_set_num_threads(1);
#endif
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const *data, std::size_t size) {
    setOneThread();
    OracleCase const oracleCase = MakeOracleCase(data, size);
    try {
        CheckOracleCase(oracleCase);
    } catch (std::exception const &failure) {
        std::cerr << "oracle: " << failure.what() << "\n\n" << Print(oracleCase);
        std::abort();
    }
    return 0;
}

extern "C" void FuzzReport(unsigned char const *data, unsigned long size) {
    constexpr unsigned kNumSeconds = 60;
    OracleCase const smallest =
        Shrink(MakeOracleCase(data, size), [](OracleCase const &oracleCase) {
            return FailsApart(
                [&] {
                    setOneThread();
                    CheckOracleCase(oracleCase);
                },
                kNumSeconds);
        });
    std::cerr << "oracle: the smallest input\n\n" << Print(smallest);
    try {
        setOneThread();
        CheckOracleCase(smallest);
    } catch (std::exception const &failure) {
        std::cerr << "\noracle: which fails thus: " << failure.what() << '\n';
    }
}
