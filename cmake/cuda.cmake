# GPU drivers (option FABRICA_CUDA): finds nvcc and switches the CUDA language on.
# The same bits as on the CPU need --fmad=false: what is fused is written as fma(). A call of a host function from a
# kernel would be dropped in silence, so it is an error.
find_program(FABRICA_NVCC nvcc HINTS /usr/local/cuda/bin)
if(NOT FABRICA_NVCC)
  message(FATAL_ERROR "FABRICA_CUDA is ON but nvcc was found neither in PATH nor in /usr/local/cuda/bin.\n"
    "Install the CUDA toolkit (12.4 or newer), set -DFABRICA_NVCC=<file>, or configure without FABRICA_CUDA.")
endif()
set(CMAKE_CUDA_COMPILER ${FABRICA_NVCC})
if(NOT CMAKE_CUDA_HOST_COMPILER)
  set(CMAKE_CUDA_HOST_COMPILER ${CMAKE_CXX_COMPILER})
endif()
if(NOT CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES "80;90")
endif()
if(CCACHE)
  set(CMAKE_CUDA_COMPILER_LAUNCHER ${CCACHE})
endif()
enable_language(CUDA)
if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # older CMake does not know that newer nvcc has C++20
  set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
  set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
endif()
set(CMAKE_CUDA_STANDARD 20)
set(CMAKE_CUDA_STANDARD_REQUIRED ON)
set(CMAKE_CUDA_EXTENSIONS OFF)
message(STATUS "GPU drivers: ${FABRICA_NVCC} ${CMAKE_CUDA_COMPILER_VERSION}, architectures ${CMAKE_CUDA_ARCHITECTURES}")
