#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# docs/site/page.sh PAGE.md: the page as Doxygen takes it.  Headings of the changelog, which come once for each
# version, get no labels.
page=$(basename "$1" .md)
exec sed -E -f docs/site/links.sed -e "s/@PAGE@/$page/" -e 's/ \{#CHANGELOG--.*//' "$1"
