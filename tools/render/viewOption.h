// SPDX-License-Identifier: Apache-2.0
#ifndef OPENSUBDIVHEX_TOOLS_VIEW_OPTION_H
#define OPENSUBDIVHEX_TOOLS_VIEW_OPTION_H

#include "camera.h"

#include "tools/mesh/program.h"

#include <cmath>
#include <string>
#include <vector>

namespace OpenSubdivHex::Tools {

/// Adds --camera, which replaces \p view, for cameras that see all of a mesh.
inline CLI::Option *AddViewOption(CLI::App &app, View *view) {
    auto const read = [view](std::string const &argument) {
        std::vector<float> const numbers = ReadNumbers("--camera", argument, 2, 3);
        if (std::abs(numbers[1]) > 90) {
            throw CLI::ValidationError("--camera", CLI::detail::to_string(numbers[1]) +
                                                       " is not between -90 and 90 degrees");
        }
        if (numbers.size() > 2 && numbers[2] <= 0) {
            throw CLI::ValidationError("--camera", "the zoom factor is not positive");
        }
        *view = {numbers[0], numbers[1], numbers.size() > 2 ? numbers[2] : View().zoom};
    };
    return app
        .add_option_function<std::string>(
            "--camera", read,
            "Where the camera stands, in degrees around the mesh and above the horizon, and "
            "a factor to enlarge")
        ->type_name("AZIMUTH,ELEVATION[,ZOOM]")
        ->default_str(CLI::detail::to_string(view->azimuth) + "," +
                      CLI::detail::to_string(view->elevation));
}

} // namespace OpenSubdivHex::Tools

#endif
