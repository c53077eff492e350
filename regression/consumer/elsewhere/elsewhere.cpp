// SPDX-License-Identifier: Apache-2.0
//
// Prints the file that OpenSubdiv's functions were loaded from.
#include <opensubdiv/far/error.h>

#include <dlfcn.h>

#include <cstdio>

int main() {
    Dl_info info;
    if (dladdr(reinterpret_cast<void *>(&OpenSubdiv::Far::SetErrorCallback), &info) == 0) {
        return 1;
    }
    std::puts(info.dli_fname);
    return 0;
}
