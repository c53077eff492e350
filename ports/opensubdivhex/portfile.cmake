# SPDX-License-Identifier: Apache-2.0
#
# An overlay port, which builds the clone that it lies in:
#
#     vcpkg install opensubdivhex --overlay-ports=CLONE/ports
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS featureOptions
  FEATURES
    tools OPENSUBDIVHEX_TOOLS)
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS
    ${featureOptions}
    -DOPENSUBDIVHEX_TUTORIALS=OFF
    -DOPENSUBDIVHEX_REGRESSION=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME OpenSubdivHex CONFIG_PATH lib/cmake/OpenSubdivHex)
vcpkg_fixup_pkgconfig()
if("tools" IN_LIST FEATURES)
  vcpkg_copy_tools(TOOL_NAMES hexrefine AUTO_CLEAN)
endif()
file(REMOVE_RECURSE
  "${CURRENT_PACKAGES_DIR}/debug/include"
  "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
