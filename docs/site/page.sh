#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# docs/site/page.sh PAGE.md: the page as Doxygen takes it.  Headings get no labels in the changelog,
# where each version has the same ones, nor on the first page, whose headings the site's tree would have.
page=$(basename "$1" .md)
exec sed -E -f docs/site/links.sed -e "s/@PAGE@/$page/" -e 's/ \{#(CHANGELOG|index)--.*//' "$1"
