#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# docs/site/check.sh page FILE: opens a page in headless Chromium; fails if a picture or drawing of it is
#                           broken, and takes a screenshot beside it.
# docs/site/check.sh site FOLDER: opens all pages of a folder; fails if a picture or a link is broken.
set -euo pipefail

say() { printf 'check: %s\n' "$*" >&2; }

fail() {
    say "$*"
    exit 1
}

# Sets browser to the command of a headless Chromium, or to nothing.
find_browser() {
    local name
    browser=()
    for name in chromium chromium-browser google-chrome; do
        if command -v $name >/dev/null; then
            browser=($name --headless --no-sandbox --disable-gpu --hide-scrollbars
                --enable-logging=stderr)
            return
        fi
    done
    say "Chromium is not here and could not be installed: NOTHING was opened in it"
}

# Opens the page $1 in headless Chromium: fails if a picture or drawing of it is broken.
check_page() {
    local page=$1 folder browser result
    folder=$(dirname "$page")
    find_browser
    if [[ ${#browser[@]} -eq 0 ]]; then
        return
    fi
    {
        cat "$page"
        cat <<'END'
<script>
addEventListener("load", () => {
    const pictures = [...document.images], drawings = [...document.querySelectorAll("svg")];
    const broken = pictures.filter(p => !p.complete || !p.naturalWidth).length +
        drawings.filter(d => !(d.getBoundingClientRect().height > 50)).length;
    document.title = `checked: ${pictures.length} pictures, ${drawings.length} drawings, ` +
        `${broken} broken`;
});
</script>
END
    } >"$folder/check.html"
    result=$("${browser[@]}" --dump-dom "file://$folder/check.html" 2>"$folder/chromium.log" |
        grep -o '<title>checked: [^<]*' || true)
    rm "$folder/check.html"
    say "Chromium: ${result#<title>checked: }"
    if [[ $result != *' 0 broken' || $result == *' 0 pictures'* || $result == *' 0 drawings'* ]]; then
        fail "the page does not render; see $folder/chromium.log"
    fi
    if grep -q 'CONSOLE' "$folder/chromium.log"; then
        fail "the page has errors; see $folder/chromium.log"
    fi
    "${browser[@]}" --window-size=1100,2200 --screenshot="$folder/screenshot.png" "file://$page" \
        2>>"$folder/chromium.log" || fail "no screenshot; see $folder/chromium.log"
}

# Opens all pages in the folder $1 in headless Chromium: fails if a picture or a link is broken.
check_site() {
    local folder=$1 browser result
    find_browser
    if [[ ${#browser[@]} -eq 0 ]]; then
        return
    fi
    {
        echo '<!DOCTYPE html><meta charset="utf-8"><body><script>'
        cat "$(dirname "${BASH_SOURCE[0]}")/check.js"
        echo 'checkSite(['
        (cd "$folder" && find . -name '*.html' ! -path './search/*' -printf '"%P",\n' | sort)
        echo ']);</script>'
    } >"$folder/../check.html"
    mv "$folder/../check.html" "$folder/check.html"
    result=$(timeout 300 "${browser[@]}" --allow-file-access-from-files --virtual-time-budget=1000000000 \
        --dump-dom "file://$folder/check.html" 2>"$folder/../chromium.log" || true)
    rm "$folder/check.html"
    say "Chromium: $(grep -o 'checked: [^<]*' <<<"$result" || echo 'the pages could not be checked')"
    if [[ $result != *', 0 broken'* ]]; then
        sed 's/<[^>]*>/\n/g' <<<"$result" | grep ': ' | head -50 >&2
        fail "the site is broken; see $folder/../chromium.log"
    fi
}

case ${1:-} in
page) check_page "$2" ;;
site) check_site "$2" ;;
*) fail "check what? page FILE or site FOLDER" ;;
esac
