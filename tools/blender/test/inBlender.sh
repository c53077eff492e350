#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# inBlender.sh SCRIPT [ARGUMENT...]: runs a Python script in Blender, without its settings; fails where it fails.
PYTHONDONTWRITEBYTECODE=1 exec blender --background --factory-startup \
    --python-exit-code 1 --python "$1" -- "${@:2}"
