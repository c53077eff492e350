#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# Makes the reference, the guide and the tutorials as one site below build/docs, with Doxygen.  What is
# public and not documented is an error.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

say() { printf 'docs: %s\n' "$*" >&2; }

fail() {
    say "$*"
    exit 1
}

out=build/docs
rm -rf $out
mkdir -p $out/include/far_ext
version=$(sed -n 's/^project(OpenSubdivHex VERSION \([0-9.]*\) .*/\1/p' CMakeLists.txt)
IFS=. read -r major minor patch <<<"$version"
sed -e "s/@PROJECT_VERSION@/$version/" -e "s/@PROJECT_VERSION_MAJOR@/$major/" \
    -e "s/@PROJECT_VERSION_MINOR@/$minor/" -e "s/@PROJECT_VERSION_PATCH@/$patch/" \
    far_ext/version.h.in >$out/include/far_ext/version.h

# The paper's page, where ./dev paper made one.
sed "/paper\/index.html/d" docs/site/layout.xml >$out/layout.xml
if [[ -f build/paper/index.html ]]; then
    cp docs/site/layout.xml $out/layout.xml
fi
if ! OUTPUT=$out VERSION=$version doxygen docs/site/Doxyfile; then
    cat $out/warnings.txt >&2
    fail "what is public and has no documentation, or is wrong in it, is listed above"
fi
# Where all classes within a class are private it links to a list of them that it does not make.
grep -L 'name="nested-classes"' $out/html/class*.html | xargs sed -i \
    's|<a href="#nested-classes">Classes</a> &#124;||'
# It links to friends that classes define, for which it makes no place.
for friend in $({ grep -ohE 'hl_friend" href="[^"]*"' $out/html/*_source.html || true; } |
    sed -E 's/.*href="([^"]*)"/\1/' | sort -u); do
    if ! grep -q "id=\"${friend#*#}\"" "$out/html/${friend%#*}"; then
        sed -i "s|href=\"$friend\"||g" $out/html/*.html
    fi
done
# Doxygen does not ask for the documentation of enumerators.
missing=$(awk '/<enumvalue /{said = 0} /<para>/{said = 1} /<name>/{name = $0}
    /<\/enumvalue>/{if (!said) print name}' $out/xml/*.xml | sed 's/<[^>]*>//g')
[[ -z $missing ]] || fail "enumerators without documentation:" $missing
if [[ -f build/paper/index.html ]]; then
    mkdir $out/html/paper
    cp build/paper/index.html $out/html/paper/
fi
say "$(find $out/html -name '*.html' | wc -l) pages, no warning"
