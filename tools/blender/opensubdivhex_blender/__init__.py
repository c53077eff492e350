# SPDX-License-Identifier: Apache-2.0
"""Hexagonal subdivision in Blender: objects that follow a mesh, refined by opensubdivhex."""

import pathlib
import sys

bl_info = {
    "name": "Hexagonal Subdivision",
    "description": "Objects that follow a mesh, subdivided into hexagons by OpenSubdivHex",
    "author": "OpenSubdivHex",
    "version": (2, 0, 0),
    "blender": (3, 4, 0),
    "location": "Object > Hexagonal Subdivision; Properties > Object Data",
    "category": "Object",
}

# The module may lie beside the add-on, in its folder.
_folder = str(pathlib.Path(__file__).parent)
if _folder not in sys.path and (pathlib.Path(_folder) / "opensubdivhex").is_dir():
    sys.path.append(_folder)

try:
    import opensubdivhex
except ImportError as error:
    raise ImportError(
        "the Python module opensubdivhex is not found: install it for Blender's Python, or copy its "
        f"folder to {_folder}") from error

from . import follower, ui


def register():
    ui.register()
    follower.register()


def unregister():
    follower.unregister()
    ui.unregister()
