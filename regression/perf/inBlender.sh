#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# inBlender.sh [--quick] [--turns N] [--threads N] [--json FILE] [--markdown FILE]: runs pythonBenchmark.py in
# Blender, so that all contestants take turns in one process, and reports what it measured.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

fail() {
    printf 'bench --python: %s\n' "$*" >&2
    exit 1
}

command="./dev bench --python${*:+ $*}" threads=1 timing=() reporting=() build=build/release
while [[ $# -gt 0 ]]; do
    case $1 in
    --quick)
        timing+=("$1")
        shift
        continue
        ;;
    --turns | --threads | --json | --markdown) ;;
    *) fail "no argument is called $1" ;;
    esac
    [[ $# -gt 1 ]] || fail "$1 needs a value"
    case $1 in
    --turns) timing+=("$1" "$2") ;;
    --threads) threads=$2 ;;
    *) reporting+=("$1" "$2") ;;
    esac
    shift 2
done
mkdir -p build/blender
PYTHONDONTWRITEBYTECODE=1 blender --background --factory-startup \
    --threads "$threads" --python-exit-code 1 --python regression/perf/pythonBenchmark.py -- \
    --modules "$PWD/$build/python" --addons "$PWD/tools/blender" \
    --native $build/regression/perf/libnativePeer.so --threads "$threads" \
    --json build/blender/benchmark.json "${timing[@]}" >build/blender/benchmark.log
$build/bin/perf --measured build/blender/benchmark.json --command "$command" "${reporting[@]}"
