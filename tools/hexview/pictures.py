# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of hexview and hexrefine in docs/images:

    pictures.py HEXVIEW MESHES OUT [MODELS]

hexrefine lies beside HEXVIEW.
MODELS is a folder with suzanne.obj and spot_quadrangulated.obj, which are not in this repository;
without it their pictures stay as they are.
"""

import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

from PIL import Image

REFLECTION = "--shading", "reflection", "--no-edges"
FINE = "--adaptive", "--pixel-error", "0.02"


def draw(path, *options):
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "out.png"
        subprocess.run([hexview, path, *options, "--png", file], check=True)
        return Image.open(file).convert("RGB")


def draw_view(pixel_error, *options):
    """What a camera needs of the lantern, from the middle of a picture of 800 x 600."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "out.png"
        subprocess.run([hexview.with_name("hexrefine"), meshes / "lantern.obj", "--adaptive",
                        "--mask", "smooth", "--boundary", "edge-only", "--resolution", "800x600",
                        "--fov", "30", "--pixel-error", pixel_error, *options, "--png", file],
                       check=True)
        small = Image.open(file).convert("RGB").resize((600, 450), Image.Resampling.LANCZOS)
        return small.crop((100, 0, 500, 450))


def save(name, *images):
    """Side by side, with 256 colours, which are enough for one material."""
    whole = Image.new("RGB", (sum(image.width for image in images), images[0].height))
    left = 0
    for image in images:
        whole.paste(image, (left, 0))
        left += image.width
    whole.quantize(256, dither=Image.Dither.NONE).save(out / f"{name}.png", optimize=True)


def draw_window(width, height, *arguments):
    """The window, with its panel, some frames after it opened, in an X server without a screen."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0",
                               f"{width}x{height}x24"], pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as numbers:
        display = ":" + numbers.readline().strip()
    window = subprocess.Popen([hexview, *arguments, "--width", str(width), "--height", str(height)],
                              env={**os.environ, "DISPLAY": display})
    time.sleep(8)
    data = subprocess.run(["xwd", "-root", "-silent", "-display", display], check=True,
                          capture_output=True).stdout
    for process in window, server:
        process.terminate()
        process.wait()
    header = struct.unpack(">25I", data[:100])
    size, order, line, colors = header[0], header[7], header[12], header[19]
    return Image.frombuffer("RGB", (width, height), data[size + 12 * colors:], "raw",
                            "BGRX" if order == 0 else "XRGB", line, 1)


hexview, meshes, out = map(pathlib.Path, sys.argv[1:4])
save("hexview", draw_window(1100, 780, meshes / "lantern.obj", "--level", "3", "--control-mesh"))
save("strip", draw(meshes / "lantern.obj", "--adaptive", "--pixel-error", "3", "--shading",
                   "levels", "--elevation", "10", "--distance", "0.8", "--width", "400",
                   "--height", "520", "--frames", "3"))
save("adaptive", draw_view("4", "--png-colors", "levels"), draw_view("0.5"),
     draw_view("1e-9", "--max-level", "5"))
view = ("--patches", "--edge-pixels", "3", "--elevation", "20", "--distance", "0.8",
        "--width", "560", "--height", "520")
save("patches", draw(meshes / "jug.obj", "--level", "1", *view),
     draw(meshes / "jug.obj", "--level", "3", *REFLECTION, *view))
if len(sys.argv) > 4:
    models = pathlib.Path(sys.argv[4])
    view = "--azimuth", "200", "--distance", "0.75", "--width", "560", "--height", "600"
    spot = models / "spot_quadrangulated.obj"
    save("spot", draw(spot, "--adaptive", "--pixel-error", "1", *view),
         draw(spot, *FINE, *REFLECTION, *view))
    view = "--azimuth", "20", "--width", "520", "--height", "440"
    suzanne = models / "suzanne.obj"
    save("suzanne", draw(suzanne, "--level", "0", "--shading", "facets", *view),
         draw(suzanne, *FINE, *REFLECTION, *view))
