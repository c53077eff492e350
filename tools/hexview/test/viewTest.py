# SPDX-License-Identifier: Apache-2.0
"""Looks at what hexview shows.

usage: viewTest.py pictures|window HEXVIEW MESHES

pictures  draws without a window: every evaluator the same picture, every shading another one, cells
          that a view needs, patches, frames of the animation
window    opens a window in Xvfb, presses keys and a button, drags the camera and a control vertex with
          the mouse, and looks at the screen
"""

import os
import struct
import subprocess
import sys
import tempfile
import time

from PIL import Image, ImageChops

WIDTH, HEIGHT = 480, 360
LEFT = WIDTH * 11 // 20  # the panel ends before
BUTTON = 42, 75, 120  # the colour of the panel's buttons, but for what shines through
TIMEOUT = 60  # seconds, of a busy machine without a GPU
INTERVAL = 0.2  # seconds between two looks at the screen


def share_of_different(a, b, by=32):
    """The share of pixels that differ by that many of 255 levels of grey or more."""
    difference = ImageChops.difference(a, b).convert("L")
    return sum(difference.histogram()[by:]) / (a.width * a.height)


def share_of_dark(image):
    return sum(image.convert("L").histogram()[:64]) / (image.width * image.height)


def share_of_white(image):
    return image.convert("L").histogram()[255] / (image.width * image.height)


def hues_of(image, least):
    """Hues, in 16 steps, of that many pixels that have some colour."""
    counts = {}
    for count, (hue, saturation, _) in image.convert("HSV").getcolors(1 << 20):
        if saturation >= 64:
            counts[hue // 16] = counts.get(hue // 16, 0) + count
    return {hue for hue, count in counts.items() if count >= least}


def expect(condition, what):
    if not condition:
        sys.exit("failed: " + what)


def draw(program, mesh, *options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "view.png")
        subprocess.run([program, mesh, "--png", path, "--width", str(WIDTH), "--height",
                        str(HEIGHT), *options], check=True, timeout=TIMEOUT)
        image = Image.open(path).convert("RGB")
        image.load()
        return image


def test_pictures(program, meshes):
    torus = os.path.join(meshes, "torus.obj")
    smooth = draw(program, torus, "-l", "3")
    expect(smooth.size == (WIDTH, HEIGHT), "the picture has the size that was asked for")
    expect(0.3 < share_of_white(smooth) < 0.8, "a torus fills a part of the picture")
    for options in ([], ["--limit"]):
        pictures = [draw(program, torus, "-l", "3", "--evaluator", evaluator, *options)
                    for evaluator in ("cpu", "tables", "opengl")]
        for other in pictures[1:]:
            expect(share_of_different(pictures[0], other) < 1e-3,
                   "tables and OpenGL draw what the CPU does")
    expect(share_of_different(smooth, pictures[0]) > 1e-3, "limit points are others")
    shadings = {name: draw(program, torus, "-l", "3", "--no-edges", "--shading", name)
                for name in ("smooth", "facets", "reflection", "curvature", "base-faces",
                             "checker", "levels")}
    for name, picture in shadings.items():
        for other in shadings:
            expect(name == other or share_of_different(picture, shadings[other], 4) > 0.02,
                   f"{name} differs from {other}")
    expect(share_of_dark(shadings["reflection"]) > 0.1, "there are dark reflection lines")
    cube = draw(program, os.path.join(meshes, "cube.obj"), "-l", "4", "--no-edges", "--shading",
                "base-faces")
    expect(len(hues_of(cube, 500)) >= 3, "three sides of a cube have three colours")
    test_cells(program, meshes)
    test_patches(program, meshes)
    test_what_is_shown(program, os.path.join(meshes, "cube.obj"))
    test_frames(program, os.path.join(meshes, "cube.obj"))
    test_sizes(program, os.path.join(meshes, "cube.obj"))
    for options, cause in ((["--level", "99"], "99"), (["--mask", "none"], "none"),
                           (["--distance", "nan"], "nan"), (["--azimuth", "361"], "361"),
                           (["--png", "no.jpg"], "'no.jpg' is not a .png file")):
        run = subprocess.run([program, torus, *options], capture_output=True, text=True)
        expect(run.returncode == 2 and cause in run.stderr, "bad options are named")
    run = subprocess.run([program, torus, "--evaluator", "opengl", "--limit", "--scheme",
                          "doo-sabin", "--png", "no.png"], capture_output=True, text=True)
    expect(run.returncode == 1 and "alone have limits" in run.stderr and
           not os.path.exists("no.png"), "Doo-Sabin has no limit points")


def test_cells(program, meshes):
    torus = os.path.join(meshes, "torus.obj")
    lantern = os.path.join(meshes, "lantern.obj")
    for shading in ("smooth", "checker"):
        level = draw(program, torus, "-l", "6", "--limit", "--no-edges", "--shading", shading)
        fine, coarse = (draw(program, torus, "--adaptive", "--no-edges", "--pixel-error", error,
                             "--shading", shading) for error in ("0.1", "40"))
        expect(share_of_different(level, fine, 16) < 0.01,
               "cells that are flat to a part of a pixel look like those of a level")
        expect(share_of_different(level, coarse, 16) > 0.02, "coarse cells do not")
    for step in ("truncate", "tri-hex"):
        level = draw(program, torus, "-l", "5", "--limit", "--no-edges", "--first-step", step)
        cells = draw(program, torus, "--adaptive", "--no-edges", "--pixel-error", "0.1",
                     "--first-step", step)
        expect(share_of_different(level, cells, 16) < 0.01,
               f"cells behind a first step, {step}, look like those of a level")
    far = draw(program, lantern, "--adaptive", "--no-edges", "--shading", "levels",
               "--pixel-error", "4")
    near = draw(program, lantern, "--adaptive", "--no-edges", "--shading", "levels",
                "--pixel-error", "0.25")
    expect(len(hues_of(far, 100)) >= 3 and share_of_different(far, near, 16) > 0.05,
           "cells have colours by their levels, and other levels for other errors")
    last = draw(program, lantern, "--adaptive", "--no-edges", "--shading", "levels",
                "--max-level", "0")
    expect(share_of_different(last, near, 16) > 0.05, "there is a last level")
    # Each side of a creased cube is even: normals are not shared across creases.
    facets, smooth = (draw(program, os.path.join(meshes, "cube.obj"), "--adaptive", "--no-edges",
                           "--crease-angle", "60", "--max-level", "2", "--pixel-error", "0.001",
                           "--shading", shading) for shading in ("facets", "smooth"))
    expect(share_of_different(facets, smooth, 16) < 0.01,
           "the sides of a cube with creases are flat")
    for options, cause, code in (
            (["--adaptive", "--level", "2"], "--level", 2),
            (["--adaptive", "--limit"], "--limit", 2),
            (["--pixel-error", "1"], "--adaptive", 2),
            (["--adaptive", "--scheme", "doo-sabin", "--png", "no.png"], "level 0", 1)):
        run = subprocess.run([program, torus, *options], capture_output=True, text=True)
        expect(run.returncode == code and cause in run.stderr and not os.path.exists("no.png"),
               f"{options} is refused")


def test_patches(program, meshes):
    for name in ("torus", "lantern"):
        mesh = os.path.join(meshes, name + ".obj")
        for shading in ("smooth", "reflection"):
            limit = draw(program, mesh, "-l", "5", "--limit", "--no-edges", "--shading", shading)
            for options in ([], ["--edge-pixels", "4"]):
                patches = draw(program, mesh, "-l", "3", "--patches", "--no-edges", "--shading",
                               shading, *options)
                expect(share_of_different(limit, patches) < 0.01,
                       f"patches of the {name} look like its limit, {shading} {options}")
    torus = os.path.join(meshes, "torus.obj")
    fine, coarse = (draw(program, torus, "-l", "0", "--patches", "--no-edges", "--shading",
                         "facets", "--rate", rate) for rate in ("16", "1"))
    expect(share_of_different(fine, coarse, 16) > 0.02, "few segments are coarse")
    edges = draw(program, torus, "-l", "2", "--patches")
    plain = draw(program, torus, "-l", "2", "--patches", "--no-edges")
    expect(share_of_dark(edges) > share_of_dark(plain) + 0.02, "patches have dark borders")
    cube = draw(program, os.path.join(meshes, "cube.obj"), "-l", "3", "--patches", "--no-edges",
                "--shading", "base-faces")
    expect(len(hues_of(cube, 500)) >= 3, "patches have the colours of three sides of a cube")
    # Meshes without texture coordinates have a checker in each face.
    triangles = os.path.join(meshes, "triangles.obj")
    for mesh, shading in ((triangles, "checker"), (torus, "curvature")):
        level = draw(program, mesh, "-l", "5", "--limit", "--no-edges", "--shading", shading)
        patches = draw(program, mesh, "-l", "3", "--patches", "--no-edges", "--shading", shading)
        expect(share_of_different(level, patches) < 0.05, f"patches have the {shading} of the limit")
    for options, cause, code in (
            (["--patches", "--limit"], "--limit", 2),
            (["--patches", "--adaptive"], "--adaptive", 2),
            (["--rate", "2"], "--patches", 2),
            (["--patches", "--scheme", "doo-sabin", "--png", "no.png"], "hexagonal", 1)):
        run = subprocess.run([program, torus, *options], capture_output=True, text=True)
        expect(run.returncode == code and cause in run.stderr and not os.path.exists("no.png"),
               f"{options} is refused")


def test_what_is_shown(program, cube):
    """Vertices without faces and those of holes alone have no place in the picture."""
    far = "v 200 0 0\nv 1e30 0 0\nv 0 1e30 0\nv 1e30 2 9\n"
    hole = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt hole 1/0/0 0\n"
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(folder, "mesh.obj")

        def draw_text(text, *options):
            with open(mesh, "w") as file:
                file.write(text)
            return draw(program, mesh, *options)

        with open(cube) as file:
            text = file.read()
        for options in (["-l", "3"], ["--adaptive", "--frames", "2"]):
            alone, beside = (draw_text(text + more, *options)
                             for more in ("", far + "f 10 11 12\nt hole 1/0/0 6\n"))
            expect(share_of_white(alone) < 0.9 and share_of_different(alone, beside, 1) == 0,
                   "vertices that no face shows leave the picture as it is")
            expect(share_of_white(draw_text(hole, *options)) == 1, "holes alone show nothing")


def test_frames(program, cube):
    # Cells of a frame stay refined in the next one: their edges would be others.
    for options in (["-l", "3"], ["--adaptive", "--pixel-error", "0.1", "--no-edges"]):
        strip = draw(program, cube, "--frames", "3", *options)
        expect(strip.size == (3 * WIDTH, HEIGHT), "pictures are beside each other")
        first, rest, last = (strip.crop((i * WIDTH, 0, (i + 1) * WIDTH, HEIGHT))
                             for i in range(3))
        expect(share_of_different(rest, draw(program, cube, *options)) < 1e-2,
               "the mesh is at rest in the middle")
        expect(min(share_of_different(first, rest), share_of_different(first, last),
                   share_of_different(rest, last)) > 0.01, "it is twisted to and fro")
    for options, cause in ((["--frames", "3"], "--png"),
                           (["--frames", "64", "--width", "8192", "--height", "8192", "--png",
                             "no.png"], "64 pictures of 8192 by 8192 pixels take 12288 MiB")):
        run = subprocess.run([program, cube, *options], capture_output=True, text=True)
        expect(run.returncode == 2 and cause in run.stderr and not os.path.exists("no.png"),
               f"{options} is refused")


def test_sizes(program, cube):
    # Squares of lengths leave the range of floats, from 1.8e19 on and below 1e-19.
    with tempfile.TemporaryDirectory() as folder:
        for options in (["-l", "3"], ["--adaptive"]):
            usual = draw(program, cube, *options)
            for exponent in (126, 80, -100):
                path = os.path.join(folder, "cube.obj")
                with open(cube) as source, open(path, "w") as scaled:
                    for line in source:
                        words = line.split()
                        if words and words[0] == "v":
                            line = " ".join(["v", *(repr(float(word) * 2.0 ** exponent)
                                                    for word in words[1:])]) + "\n"
                        scaled.write(line)
                expect(share_of_different(usual, draw(program, path, *options), 1) == 0,
                       f"a mesh 2^{exponent} times as large looks the same")


def read_screen(display):
    """The picture of an X server."""
    data = subprocess.run(["xwd", "-root", "-silent", "-display", display], check=True,
                          capture_output=True).stdout
    header = struct.unpack(">25I", data[:100])
    size, width, height, order = header[0], header[4], header[5], header[7]
    line, colors = header[12], header[19]
    pixels = data[size + 12 * colors:]
    return Image.frombuffer("RGB", (width, height), pixels, "raw",
                            "BGRX" if order == 0 else "XRGB", line, 1)


class Screen:
    """An X server without a screen, and what lies on it."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            # Without -noreset the server begins anew whenever its last client leaves.
            ["Xvfb", "-noreset", "-displayfd", str(write), "-screen", "0",
             f"{WIDTH}x{HEIGHT}x24"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as numbers:
            self.display = ":" + numbers.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()

    def read(self):
        """What is beside the panel."""
        return read_screen(self.display).crop((LEFT, 0, WIDTH, HEIGHT))

    def do(self, *arguments):
        subprocess.run(["xdotool", *arguments], check=True,
                       env={**os.environ, "DISPLAY": self.display})

    def wait(self, condition, what, meanwhile=lambda: None):
        """The first picture that is as it should be, of what may go on changing."""
        end = time.monotonic() + TIMEOUT
        while not condition(image := self.read()):
            expect(time.monotonic() < end, what)
            meanwhile()
            time.sleep(INTERVAL)
        return image

    def settle(self, condition=lambda image: True, what="the picture comes to rest"):
        """The first picture that is as it should be and the same as the one before."""
        last = None

        def has_settled(image):
            nonlocal last
            is_same, last = image == last, image
            return is_same and condition(image)
        return self.wait(has_settled, what)

    def drag(self, x, y, least, what):
        """Moves the mouse that far with its button down, so that a share of pixels changes."""
        before = self.settle()
        self.do("mousedown", "1")
        # A move in the frame of the press is not seen: some pixels more, until one is.
        self.wait(lambda image: image != before, what,
                  lambda: self.do("mousemove_relative", "1", "1"))
        self.do("mousemove_relative", "--", str(x), str(y))
        self.settle(lambda image: share_of_different(image, before) > least, what)
        self.do("mouseup", "1")

    def click_rest(self):
        """Clicks the button that puts the control mesh back."""
        place = find_last_button(read_screen(self.display).crop((0, 0, LEFT, HEIGHT)))
        expect(place, "the panel has a button")
        self.do("mousemove", *map(str, place), "click", "1")


def find_last_button(panel):
    """A place in the lowest button that is wider than the arrows of boxes are."""
    width = 24
    for y in reversed(range(panel.height)):
        run = 0
        for x in range(panel.width):
            is_button = all(abs(a - b) <= 12 for a, b in zip(panel.getpixel((x, y)), BUTTON))
            run = run + 1 if is_button else 0
            if run == width:
                return x - width // 2, y - 2
    return None


def find_control_vertex(image):
    """The place of the control vertex that is drawn furthest to the right."""
    def is_blue(x, y):
        red, green, blue = image.getpixel((x, y))
        return blue > 150 and red < 80 and green < 130
    for x in range(image.width - 6, 0, -1):
        for y in range(image.height - 6):
            if all(is_blue(x + i, y + j) for i in range(4) for j in range(4)):
                return LEFT + x + 2, y + 2
    return None


def test_window_of_control_mesh(screen):
    before = screen.settle()
    screen.do("key", "c")
    x, y = find_control_vertex(screen.settle(find_control_vertex, "C shows the control mesh"))
    screen.do("mousemove", str(x), str(y))
    screen.settle(lambda image: 0 in hues_of(image, 50), "the vertex under the mouse is red")
    screen.drag(-30, -40, 0.01, "the mouse drags the vertex")
    screen.do("key", "c")
    dragged = screen.settle(lambda image: share_of_different(image, before) > 0.01 and
                            not find_control_vertex(image), "the surface follows the vertex")
    # Whoever turned the camera instead would move all of it.
    far = (8, 0, dragged.width // 8, dragged.height)
    expect(share_of_different(dragged.crop(far), before.crop(far)) < 1e-3,
           "it stays where it is far from the vertex")
    screen.click_rest()
    screen.settle(lambda image: share_of_different(image, before) < 1e-3,
                  "the button puts the vertex back")


def test_window_of_animation(screen):
    before = screen.settle()
    screen.do("key", "a")
    one = screen.wait(lambda image: share_of_different(image, before) > 0.01,
                      "A twists the surface")
    screen.wait(lambda image: share_of_different(image, one) > 0.01, "it goes on")
    screen.do("key", "a")
    screen.settle(what="A stops it")
    screen.click_rest()
    screen.settle(lambda image: share_of_different(image, before) < 1e-3,
                  "the button brings it to rest")


def test_window_of_cells(screen):
    before = screen.settle()
    screen.do("key", "Tab", "Tab", "Tab", "Tab")
    one = screen.settle(lambda image: share_of_different(image, before) > 0.1 and
                        len(hues_of(image, 1000)) == 1, "Tab shows the colour of one level")
    screen.do("key", "v")
    cells = screen.settle(lambda image: share_of_different(image, one, 16) > 0.1,
                          "V shows cells of several levels")
    screen.do("key", "f")
    screen.do("click", "--repeat", "8", "--delay", "200", "4")
    frozen = screen.settle(lambda image: share_of_white(image) < share_of_white(cells) - 0.05,
                           "the wheel comes nearer")
    screen.do("key", "f")
    screen.settle(lambda image: share_of_different(image, frozen, 16) > 0.05,
                  "cells follow the camera unless they are frozen")
    screen.do("key", "p")
    screen.settle(lambda image: len(hues_of(image, 1000)) == 1, "P shows patches of one level")


def test_window(program, meshes):
    torus = os.path.join(meshes, "torus.obj")
    with Screen() as screen:
        viewer = subprocess.Popen([program, torus, "--width", str(WIDTH), "--height", str(HEIGHT)],
                                  env={**os.environ, "DISPLAY": screen.display})
        try:
            first = screen.settle(lambda image: 0.1 < share_of_white(image) < 0.9,
                                  "the window shows a torus")
            window = subprocess.run(["xdotool", "search", "--name", "hexview"], check=True,
                                    capture_output=True, text=True,
                                    env={**os.environ, "DISPLAY": screen.display}).stdout.split()[0]
            screen.do("windowfocus", "--sync", window)
            screen.do("key", "4")
            fine = screen.settle(lambda image: share_of_different(image, first) > 0.02,
                                 "4 shows another level")
            test_window_of_animation(screen)
            screen.do("key", "e")
            plain = screen.settle(lambda image: share_of_dark(image) < share_of_dark(fine) - 0.05,
                                  "E shows no edges")
            test_window_of_control_mesh(screen)
            screen.do("key", "Tab", "Tab")
            screen.settle(lambda image: share_of_dark(image) > share_of_dark(plain) + 0.05 and
                          share_of_different(image, plain) > 0.1, "Tab shows reflection lines")
            screen.do("mousemove", str(WIDTH * 3 // 4), str(HEIGHT // 8))
            screen.drag(30, 60, 0.05, "the mouse turns the mesh")
            test_window_of_cells(screen)
            screen.do("key", "Escape")
            expect(viewer.wait(TIMEOUT) == 0, "Esc ends the program")
        finally:
            viewer.kill()


if __name__ == "__main__":
    {"pictures": test_pictures, "window": test_window}[sys.argv[1]](*sys.argv[2:])
