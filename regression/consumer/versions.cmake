# SPDX-License-Identifier: Apache-2.0
#
# cmake -D sourceDir=... -D version=... -P versions.cmake
#
# Checks that files which have the version as a text have that of CMakeLists.txt: the recipe of vcpkg, and the add-on for
# Blender, which Blender reads without running it.
string(REPLACE "." ", " versionOfPython ${version})
set(ports/opensubdivhex/vcpkg.json "\"version\": \"${version}\"")
set(tools/blender/opensubdivhex_blender/__init__.py "\"version\": (${versionOfPython})")
foreach(name IN ITEMS ports/opensubdivhex/vcpkg.json tools/blender/opensubdivhex_blender/__init__.py)
  file(READ ${sourceDir}/${name} text)
  string(FIND "${text}" "${${name}}" found)
  if(found EQUAL -1)
    message(SEND_ERROR "${name} does not have ${${name}}, the version of CMakeLists.txt")
  endif()
endforeach()
