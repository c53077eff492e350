#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
#
# Installs the packages in a bare Debian and uses them there.  It is run by ./dev package inside of
# that Debian, as root; /packages has the packages, /consumer the folder regression/consumer and
# /lantern.obj a mesh.
set -eu
export DEBIAN_FRONTEND=noninteractive

step() { printf 'package: %s\n' "$*"; }

install() { apt-get -q -y install --no-install-recommends "$@" >/tmp/apt.log 2>&1 </dev/null ||
    { cat /tmp/apt.log; exit 1; }; }

apt-get -q update >/dev/null

step "the programs, with what they depend on"
install /packages/libopensubdivhex[0-9]*.deb /packages/opensubdivhex-tools_*.deb
hexrefine --version
cd /tmp
hexrefine /lantern.obj -l 2 -o lantern.ply --limit
test -s lantern.ply

step "the development files, and a program that finds them with CMake"
install /packages/libopensubdivhex-dev_*.deb
install g++ cmake make pkgconf
version=$(dpkg-query -W -f '${Version}' libopensubdivhex-dev)
version=${version%-*}
cmake -S /consumer -B /tmp/build -D wantedVersion="$version" >/dev/null
cmake --build /tmp/build >/dev/null
/tmp/build/consumer

step "the Python module"
install /packages/python3-opensubdivhex_*.deb
python3 - "$version" <<'PYTHON'
import sys
import opensubdivhex as osh
assert osh.__version__ == sys.argv[1], osh.__version__
cube = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
refiner = osh.TopologyRefiner(cube)
refiner.refine_uniform(2)
assert refiner.get_level(2).num_vertices == 128
PYTHON

step "the add-on, without Blender itself"
install /packages/blender-opensubdivhex_*.deb
python3 - "$version" <<'PYTHON'
import ast
import pathlib
import sys
folder = pathlib.Path("/usr/share/blender/scripts/addons/opensubdivhex_blender")
trees = {path.name: ast.parse(path.read_text()) for path in folder.glob("*.py")}
info = next(ast.literal_eval(node.value) for node in trees["__init__.py"].body
            if isinstance(node, ast.Assign) and node.targets[0].id == "bl_info")
assert ".".join(map(str, info["version"])) == sys.argv[1], info["version"]
for tree in trees.values():
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
            assert node.module + ".py" in trees, node.module
PYTHON

step "the same program with pkg-config"
test "$(pkg-config --modversion opensubdivhex)" = "$version"
# shellcheck disable=SC2046  # words are meant
c++ -std=c++17 -D PACKAGE_VERSION="\"$version\"" /consumer/consumer.cpp -o /tmp/consumer \
    $(pkg-config --cflags --libs opensubdivhex)
/tmp/consumer >/dev/null

step "removal leaves nothing"
apt-get -q -y purge '*opensubdivhex*' >/dev/null
rest=$(find /usr -iname '*opensubdivhex*' -o -name hexrefine)
if [ -n "$rest" ]; then
    step "left behind: $rest"
    exit 1
fi
step "all is well"
