# Links of the guide to sources lead to the site's pages of them.
s|\]\([./]*tutorials/[^)]*/([a-z0-9_]*)\.cpp\)|](\1_8cpp-example.html)|g
# Doxygen finds pictures by their names.
s|\]\([./]*images/(blender/)?|](|g
