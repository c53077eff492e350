// SPDX-License-Identifier: Apache-2.0
#include "apart.h"

#include <cstdlib>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace OpenSubdivHex::Regression {

bool FailsApart(std::function<void()> const &run, unsigned numSeconds) {
    pid_t const child = fork();
    if (child == 0) {
        int const nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        alarm(numSeconds);
        try {
            run();
        } catch (...) {
            _exit(1);
        }
        _exit(0);
    }
    int status = 0;
    return child < 0 || waitpid(child, &status, 0) < 0 || status != 0;
}

} // namespace OpenSubdivHex::Regression
