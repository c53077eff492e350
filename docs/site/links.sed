# For page.sh, which puts the name of the page for @PAGE@.
/^```/,/^```/b
# Links of the guide to sources lead to the site's pages of them.
s|\]\([./]*tutorials/[^)]*/([a-z0-9_]*)\.cpp\)|](\1_8cpp-example.html)|g
# Doxygen finds pictures by their names.
s|\]\([./]*images/(blender/)?|](|g
# Headings get labels, PAGE--name-of-heading, to which links to headings lead: Doxygen does not know the
# names that GitHub gives them.
s|\]\(([./A-Za-z]*/)?([A-Za-z_-]+)\.md#([a-z0-9_-]+)\)|](#\2--\3)|g
/^##+ /{
    h
    s/^#+ //
    s/.*/\L&/
    s/[^a-z0-9 _-]//g
    s/ /-/g
    H
    g
    s/\n(.*)/ {#@PAGE@--\1}/
}
