#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# test.sh CMAKE BUILD_DIR WORK_DIR: makes the bundle of devices below WORK_DIR and runs it as on a machine
# that has glibc, Bash and what run calls, and nothing else: in a folder that is its root, where this
# user may do that.
set -euo pipefail
cmake=$1 build=$2 work=$3
bundle=$work/root/bundle
results=$work/root/results

fail() {
    echo "bundle: $*" >&2
    exit 1
}

rm -rf "$work"
mkdir -p "$results"
"$cmake" --install "$build" --prefix "$bundle" --component bundle --strip >"$work/install.log"

numBytes=$(du -sb "$bundle" | cut -f 1)
echo "bundle: $numBytes bytes"
[[ $numBytes -le 60000000 ]] || fail "more than 60 MB"

# Ubuntu 22.04 has glibc 2.35, and GCC's libraries.
newest=$({ find "$bundle" -path "$bundle/lib/gcc" -prune -o -type f -exec objdump -T {} + || true; } 2>/dev/null |
    grep -F '*UND*' | grep -o 'GLIBC_[0-9.]*' | sort -uV | tail -n 1)
echo "bundle: needs $newest"
[[ $(printf '%s\n' "$newest" GLIBC_2.35 | sort -V | tail -n 1) == GLIBC_2.35 ]] ||
    fail "$newest is newer than that of Ubuntu 22.04"

# The root: glibc, and tools with their libraries.
tools=(bash cat date dirname env grep head mkdir rm sleep tail timeout uname wc)
for tool in "${tools[@]}"; do
    file=$(command -v "$tool")
    cp -L --parents "$file" "$work/root"
    ldd "$file" | grep -o '/[^ ]*'
done | sort -u >"$work/libraries"
folder=$(dirname "$(grep '/libc\.so\.6$' "$work/libraries")")
for name in libm.so.6 libdl.so.2 libpthread.so.0 librt.so.1; do
    echo "$folder/$name"
done >>"$work/libraries"
xargs -a "$work/libraries" cp -L --parents -t "$work/root"
mkdir -p "$work/root/dev" "$work/root/proc"
: >"$work/root/dev/null"

# Programs find their libraries by way of /proc.
enter=(unshare --map-root-user --pid --fork "--root=$work/root" --mount-proc)
if ! "${enter[@]}" "$(command -v bash)" -c : 2>/dev/null; then
    if compgen -G '/dev/nvidia[0-9]*' >/dev/null; then
        echo "bundle: this user may not change its root, and the device would be run: not run" >&2
        exit 0
    fi
    echo "bundle: this user may not change its root: run beside what this machine has" >&2
    enter=()
fi

# runBundle STATUS ARGUMENT...
runBundle() {
    local expected=$1 status=0 place=
    shift
    [[ ${#enter[@]} -gt 0 ]] || place=$work/root
    timeout 600 "${enter[@]}" "$(command -v env)" -i "PATH=$place/tools:/usr/bin:/bin" \
        "$(command -v bash)" "$place/bundle/run" --output "$place/results" "$@" \
        >"$work/out" 2>&1 || status=$?
    cat "$work/out"
    [[ $status -eq $expected ]] || fail "run $*: exit status $status instead of $expected"
}

# expectSteps STEP:STATE...: those of the report, and no others.
expectSteps() {
    local found
    found=$(python3 -c '
import json, sys
for step in json.load(open(sys.argv[1]))["steps"]:
    print(step["step"] + ":" + step["state"])' "$results/report.json")
    [[ $found == "$(printf '%s\n' "$@")" ]] || fail "other steps than $*: $found"
    for step in "$@"; do
        grep -q "^| ${step%:*} | ${step#*:} |" "$results/report.md" || fail "report.md: no $step"
    done
}

runBundle 0 all
grep -q 'there is no device' "$work/out" || fail "it does not say that there is no device"
expectSteps 'cudaTest:no device' 'glRefinementTest:no device' 'glTest:no device' \
    'sanitizer:no device' 'bench:no device'
grep -q '"details": "1 passed, 0 failed, [1-9][0-9]* skipped: there is no device of CUDA' \
    "$results/report.json" || fail "cudaTest has not said that there is no device"
grep -q '^- CUDA: no device' "$results/bench.md" || fail "bench.md: CUDA was measured"
grep -q '"name": "cuda-huge"' "$results/bench.json" || fail "bench.json has no rows of CUDA"

# Programs that are not whole, where the system has no such library.
if [[ ${#enter[@]} -gt 0 ]]; then
    library=$(echo "$bundle"/lib/libosdCPU.so.*)
    mv "$library" "$work"
    runBundle 1 tests
    expectSteps cudaTest:failed glRefinementTest:failed glTest:failed
    mv "$work/${library##*/}" "$library"
fi

# A driver that has no device for CUDA is no machine without a device.
mkdir "$work/root/tools"
cat >"$work/root/tools/nvidia-smi" <<END
#!$(command -v bash)
case "\$*" in
--list-gpus) echo 'GPU 0: Planted' ;;
*name*) echo 'Planted "device" \\ 1' ;;
*) echo 'planted value' ;;
esac
END
chmod +x "$work/root/tools/nvidia-smi"
runBundle 1 tests bench
expectSteps cudaTest:failed 'glRefinementTest:not there' 'glTest:not there' bench:failed
grep -q '"device": "Planted \\"device\\" \\\\ 1"' "$results/report.json" || fail "another name of the device"

# A step that does not end, and one that is not begun.
printf '#!%s\necho begun\nexec sleep 100\n' "$(command -v bash)" >"$bundle/bin/cudaTest"
runBundle 1 --time 2 tests
expectSteps 'cudaTest:out of time' 'glRefinementTest:out of time' 'glTest:out of time'
grep -q '^begun$' "$results/tests.log" || fail "the output of a step that was ended is lost"

runBundle 2 --time 0
runBundle 2 test
rm -rf "$work/root"
