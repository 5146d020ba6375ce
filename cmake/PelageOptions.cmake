# SPDX-License-Identifier: Apache-2.0
# Compiler settings that every target of ours shares, as one interface target.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(PELAGE_CCACHE ccache)
if(PELAGE_CCACHE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${PELAGE_CCACHE})
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_CXX_FLAGS_SANITIZE "-O1 -g1 -fno-omit-frame-pointer")
set(CMAKE_CXX_FLAGS_COVERAGE "-O1 --coverage")

add_library(pelage_options INTERFACE)
# Law 1 (docs/LAWS.md): the same scene gives the same pixels, so no contraction into fused multiply-add and no -march=native.
target_compile_options(pelage_options INTERFACE -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Joined sources take 400 MB; to collect garbage before that would cost 8 % of the time to compile.
  target_compile_options(pelage_options INTERFACE --param=ggc-min-heapsize=600000)
endif()
target_compile_features(pelage_options INTERFACE cxx_std_20)

add_library(pelage_warnings INTERFACE)
# GCC 12 warns of overlaps and overflows inside std::string + std::string, and of uninitialised memory, where there are
# none.
target_compile_options(pelage_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow
                       "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds;-Wno-maybe-uninitialized>"
                       $<$<BOOL:${PELAGE_WERROR}>:-Werror>)
if(PELAGE_SANITIZE)
  target_compile_options(pelage_options INTERFACE -fsanitize=${PELAGE_SANITIZE})
  target_link_options(pelage_options INTERFACE -fsanitize=${PELAGE_SANITIZE})
  if(PELAGE_SANITIZE MATCHES "undefined")
    # What the address sanitizer stops anyway, and what doubles the time to compile for checks of virtual calls.
    target_compile_options(pelage_options INTERFACE -fno-sanitize-recover=undefined
                           -fno-sanitize=null,vptr,object-size,pointer-overflow)
  endif()
  if(PELAGE_SANITIZE MATCHES "thread")
    # TBB's workers are not instrumented: correct loops would be reported and planted races hidden.
    target_compile_definitions(pelage_options INTERFACE PELAGE_STD_THREADS=1)
  endif()
endif()

if(PELAGE_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "PELAGE_FUZZ needs clang: configure with the preset 'fuzz'")
  endif()
  target_compile_options(pelage_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
