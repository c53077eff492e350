// SPDX-License-Identifier: Apache-2.0
//
// Meshes with tags, options and channels, made of bytes, against each other and the reference.
#include "apart.h"
#include "oracle.h"

#include "far_ext/executor.h"

#include <cstdlib>
#include <iostream>

using namespace OpenSubdivHex::Regression;

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const *data, std::size_t size) {
    OpenSubdivHex::FarExt::SetNumThreads(1);
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
                    OpenSubdivHex::FarExt::SetNumThreads(1);
                    CheckOracleCase(oracleCase);
                },
                kNumSeconds);
        });
    std::cerr << "oracle: the smallest input\n\n" << Print(smallest);
    try {
        OpenSubdivHex::FarExt::SetNumThreads(1);
        CheckOracleCase(smallest);
    } catch (std::exception const &failure) {
        std::cerr << "\noracle: which fails thus: " << failure.what() << '\n';
    }
}
