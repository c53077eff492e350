// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_PROGRAM_H
#define OPENSUBDIVHEX_TOOLS_PROGRAM_H

#include "fileError.h"

#include <CLI/CLI.hpp>

#include <iostream>
#include <new>

namespace OpenSubdivHex::Tools {

enum ExitCode { kSuccess = 0, kFailure = 1, kBadUsage = 2 };

/// \brief What main does: reads the command line into \p app, calls work() and gives the exit code.
///
/// Whatever they throw ends the program with one line, "PROGRAM: cause"; a CLI::ParseError, which
/// work may throw too, with CLI11's text.
template <typename WORK>
int RunProgram(CLI::App &app, int argc, char const *const *argv, WORK work) {
    auto const fail = [&](std::string const &cause) {
        std::cerr << app.get_name() << ": " << EscapeControls(cause) << "\n";
        return kFailure;
    };
    app.failure_message([](CLI::App const *failed, CLI::Error const &error) {
        return EscapeControls(error.what()) + "\nRun " + failed->get_name() +
               " with --help for more information.\n";
    });
    try {
        try {
            app.parse(argc, argv);
            work();
        } catch (CLI::ParseError const &error) {
            return app.exit(error) == 0 ? kSuccess : kBadUsage;
        }
    } catch (std::bad_alloc const &) {
        return fail("not enough memory");
    } catch (std::exception const &error) {
        return fail(error.what());
    } catch (...) {
        return fail("an error that says nothing of itself");
    }
    return kSuccess;
}

} // namespace OpenSubdivHex::Tools

#endif
