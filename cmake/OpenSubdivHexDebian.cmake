# SPDX-License-Identifier: Apache-2.0

# Debian packages, made by CPack: one for each component of the installation.  The preset `package`
# has the settings that Debian's folders need; ./dev package makes and tests them.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME opensubdivhex)
# Who makes packages for others says who maintains them, as Debian's tools are told; else the address
# says of itself that it is none (RFC 2606).
set(contact "The OpenSubdivHex authors <nobody@opensubdivhex.invalid>")
if(NOT "$ENV{DEBEMAIL}" STREQUAL "" AND NOT "$ENV{DEBFULLNAME}" STREQUAL "")
  set(contact "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_CONTACT "${contact}" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS
  ${PROJECT_BINARY_DIR}/far_ext ${PROJECT_BINARY_DIR}/osd_ext ${PROJECT_BINARY_DIR}/bfr_ext)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(debianDir ${PROJECT_BINARY_DIR}/debian)
set(debianVersion ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
file(WRITE ${debianDir}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: OpenSubdivHex

Files: *
Copyright: 2026 the OpenSubdivHex authors
License: Apache-2.0
 On Debian systems the full text of the Apache License, version 2.0, is in the file
 /usr/share/common-licenses/Apache-2.0.
")

# Debian wants the strongest compression and no time in it.
function(compressForDebian input output)
  execute_process(COMMAND gzip -9nc INPUT_FILE ${input} OUTPUT_FILE ${output})
endfunction()
compressForDebian(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${debianDir}/changelog.gz)

# opensubdivhex_add_debian_package(COMPONENT NAME SECTION CONTENT [DEPENDS...]): the package NAME of a
# component.  DEPENDS is what it needs besides what its binaries are linked with.
macro(opensubdivhex_add_debian_package component name section content)
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION
    "The scheme of Ghaleb and Abd El-Latif (2005) beside Catmull-Clark and Loop:\n"
    "base meshes and stencil tables are those of OpenSubdiv.\n.\n${content}")
  string(CONCAT CPACK_DEBIAN_${upper}_DESCRIPTION ${CPACK_DEBIAN_${upper}_DESCRIPTION})
  string(JOIN ", " CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS ${ARGN})

  # Every package says its licence and what changed, where Debian looks for it.
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${debianDir}/${name}.changelog
    "${name} (${debianVersion}) unstable; urgency=medium\n\n"
    "  * Release ${PROJECT_VERSION}: see changelog.gz beside this file.\n\n"
    " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  compressForDebian(${debianDir}/${name}.changelog ${debianDir}/${name}.changelog.gz)
  set(docDir ${CMAKE_INSTALL_DATAROOTDIR}/doc/${name})
  install(FILES ${debianDir}/copyright ${debianDir}/changelog.gz DESTINATION ${docDir}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
  install(FILES ${debianDir}/${name}.changelog.gz RENAME changelog.Debian.gz DESTINATION ${docDir}
    COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

# opensubdivhex_clean_byte_code(COMPONENT NAME): removing the package removes the byte code that Python has made of it.
macro(opensubdivhex_clean_byte_code component name)
  string(TOUPPER ${component} upper)
  file(WRITE ${debianDir}/${name}/prerm "#!/bin/sh\nset -e\npy3clean -p ${name}\n")
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA ${debianDir}/${name}/prerm)
endmacro()

set(CPACK_COMPONENTS_ALL "")
set(libraryPackage libopensubdivhex${OPENSUBDIVHEX_SOVERSION})
opensubdivhex_add_debian_package(library ${libraryPackage} libs
  "This package has the shared libraries.")
file(WRITE ${debianDir}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${debianDir}/triggers)

opensubdivhex_add_debian_package(development libopensubdivhex-dev libdevel
  "This package has the headers, the guide, and files for CMake and pkg-config."
  "${libraryPackage} (= ${debianVersion})" libosd-dev)

if(TARGET hexrefine)
  opensubdivhex_add_debian_package(tools opensubdivhex-tools graphics
    "This package has hexrefine, which refines OBJ, OFF and PLY files."
    "${libraryPackage} (= ${debianVersion})")
  find_program(OPENSUBDIVHEX_HELP2MAN help2man)
  mark_as_advanced(OPENSUBDIVHEX_HELP2MAN)
  if(OPENSUBDIVHEX_HELP2MAN)
    add_custom_command(OUTPUT ${debianDir}/hexrefine.1.gz
      COMMAND ${OPENSUBDIVHEX_HELP2MAN} --no-info --name "refine polygon meshes hexagonally"
        --output ${debianDir}/hexrefine.1 $<TARGET_FILE:hexrefine>
      COMMAND gzip -9nf ${debianDir}/hexrefine.1
      DEPENDS hexrefine VERBATIM)
    add_custom_target(hexrefineManual ALL DEPENDS ${debianDir}/hexrefine.1.gz)
    install(FILES ${debianDir}/hexrefine.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
      COMPONENT tools EXCLUDE_FROM_ALL)
  endif()
endif()

if(TARGET opensubdivhex_python)
  # An extension is for one version of Python.
  math(EXPR nextMinor "${Python_VERSION_MINOR} + 1")
  opensubdivhex_add_debian_package(python python3-opensubdivhex python
    "This package has the module opensubdivhex for Python 3."
    "${libraryPackage} (= ${debianVersion})" python3-numpy
    "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}~)"
    "python3 (<< ${Python_VERSION_MAJOR}.${nextMinor})")
  opensubdivhex_clean_byte_code(python python3-opensubdivhex)

  # Where Debian's Blender, whose Python is the system's, looks for add-ons.
  opensubdivhex_add_debian_package(blender blender-opensubdivhex graphics
    "This package has the add-on for Blender: objects that follow a mesh,\nsubdivided into hexagons."
    "python3-opensubdivhex (= ${debianVersion})")
  opensubdivhex_clean_byte_code(blender blender-opensubdivhex)
  set(CPACK_DEBIAN_BLENDER_PACKAGE_ARCHITECTURE all)
  set(CPACK_DEBIAN_BLENDER_PACKAGE_RECOMMENDS "blender (>= 3.4)")
endif()
include(CPack)
