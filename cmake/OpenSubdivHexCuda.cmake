# SPDX-License-Identifier: Apache-2.0

# The compiler of CUDA, where its installer puts it, too, and the devices that it compiles for unless
# someone says: those of three generations, and later ones by translation.
if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
  find_program(OPENSUBDIVHEX_NVCC nvcc HINTS $ENV{CUDA_PATH}/bin /usr/local/cuda/bin)
  mark_as_advanced(OPENSUBDIVHEX_NVCC)
  if(OPENSUBDIVHEX_NVCC)
    set(CMAKE_CUDA_COMPILER ${OPENSUBDIVHEX_NVCC})
  endif()
endif()
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES 75-real 80-real 90)
endif()
set(CMAKE_CUDA_STANDARD 17)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
