#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs and uses the packages of ./dev package in a bare Debian 12, and the add-on's package in this
# machine's Blender.  For root, with debootstrap.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

say() { printf 'packages: %s\n' "$*" >&2; }

fail() {
    say "$*"
    exit 1
}

# Every package in a Debian that has nothing else but what they depend on.  That Debian is kept bare
# in build/debian/bare, and tested in a copy.
test_packages() {
    local bare=$PWD/build/debian/bare root=$PWD/build/debian/test
    local mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}
    [[ $(id -u) -eq 0 ]] || fail "this is for root: it makes a root of its own"
    if [[ ! -d $bare ]]; then
        rm -rf "$bare.part"
        mkdir -p "$bare.part"
        debootstrap --variant=minbase bookworm "$bare.part" "$mirror" >build/debian/log.txt ||
            fail "no bare Debian could be made; see build/debian/log.txt"
        mv "$bare.part" "$bare"
    fi
    rm -rf "$root"
    cp -a "$bare" "$root"
    mkdir "$root/packages"
    cp build/package/packages/*.deb "$root/packages"
    cp -r regression/consumer tutorials/meshes/lantern.obj regression/consumer/debian.sh "$root"
    # What is mounted is gone with the process.  The network is that of this machine, its environment is not.
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    unshare --mount sh -c "mount -t proc proc '$root/proc' &&
        exec env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin chroot '$root' /debian.sh" ||
        fail "the packages do not work in a bare Debian"
    rm -rf "$root"
    test_addon_package
}

# The add-on's package in the Blender of this machine, which is too large for a bare Debian of each
# test, with the module and the libraries of the packages.
test_addon_package() {
    local root=$PWD/build/debian/addon package
    if ! command -v blender >/dev/null; then
        say "Blender is not here: the package of the add-on was not used in it (./dev blender installs it)"
        return
    fi
    rm -rf "$root"
    for package in build/package/packages/*.deb; do
        dpkg-deb --extract "$package" "$root"
    done
    LD_LIBRARY_PATH=$(dirname "$root"/usr/lib/*/libopensubdivhex_far_ext.so) \
        tools/blender/test/inBlender.sh tools/blender/test/addonTest.py "$root/usr/lib/python3/dist-packages" \
        "$root/usr/share/blender/scripts/addons"
    rm -rf "$root"
}

test_packages
