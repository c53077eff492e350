# SPDX-License-Identifier: Apache-2.0

# The option OPENSUBDIVHEX_PYTHON: on where pybind11 and what Python needs to be extended are found.
# The Python is the system's, whose packages have pybind11 and numpy, unless Python_EXECUTABLE or a
# virtual environment says otherwise: a first python3 on the PATH may be another, without them.
if(NOT DEFINED OPENSUBDIVHEX_PYTHON OR OPENSUBDIVHEX_PYTHON)
  if(NOT DEFINED Python_EXECUTABLE AND NOT DEFINED ENV{VIRTUAL_ENV} AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the module is for")
  endif()
  find_package(Python 3.8 COMPONENTS Interpreter Development.Module)
  if(Python_FOUND)
    find_package(pybind11 2.10 CONFIG)
  endif()
endif()
set(hasPython OFF)
if(Python_FOUND AND pybind11_FOUND AND PROJECT_IS_TOP_LEVEL)
  set(hasPython ON)
endif()
option(OPENSUBDIVHEX_PYTHON "Build the Python module" ${hasPython})
if(OPENSUBDIVHEX_PYTHON AND NOT pybind11_FOUND)
  message(FATAL_ERROR "OPENSUBDIVHEX_PYTHON needs Python 3 with its headers, and pybind11: the "
    "packages python3-dev and pybind11-dev (Debian, Ubuntu)")
endif()
set(OPENSUBDIVHEX_PYTHON_DIR ${PROJECT_BINARY_DIR}/python)
