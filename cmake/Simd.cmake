# rejoin::simd: Highway as our kernels use it.
#   On ARM they take NEON: scalable vectors (SVE) cannot lie in structs and arrays, as our kernels have them, and GCC puts Highway's NEON into
#   a struct's constructor only if everything is compiled with the extensions that Highway asks for.

find_package(hwy CONFIG REQUIRED)
add_library(rejoin_simd INTERFACE)
add_library(rejoin::simd ALIAS rejoin_simd)
target_link_libraries(rejoin_simd INTERFACE hwy::hwy)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/aarch64.flags flags)
  target_compile_options(rejoin_simd INTERFACE ${flags})
endif()
