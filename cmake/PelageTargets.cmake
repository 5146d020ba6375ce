# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)

# What most sources parse anyway, parsed once for all modules. The dev preset goes without, so that a missing include
# shows.
add_library(pelage_headers OBJECT ${CMAKE_CURRENT_LIST_DIR}/headers.cpp)
target_link_libraries(pelage_headers PRIVATE pelage_options pelage_warnings pelage::dep_imath)
target_precompile_headers(pelage_headers PRIVATE
  <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <mutex> <optional> <span>
  <string> <string_view> <utility> <variant> <vector>
  <Imath/ImathBox.h> <Imath/ImathColor.h> <Imath/ImathMatrix.h> <Imath/ImathVec.h>)

# Sources compiled as one take a third of the time that each by itself takes. The preset dev compiles each by itself, so
# that a missing include shows and one changed file is compiled quickly. A source listed after ALONE is always compiled
# by itself, because it shares a private name with another source of the module, or takes long.
option(PELAGE_JOIN_SOURCES "Compile several sources of a module as one" ON)
set(PELAGE_BATCH 16 CACHE STRING "How many sources are compiled as one at most")
function(pelage_join_sources target)
  if(PELAGE_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${PELAGE_BATCH})
    # Joined sources look like headers to GCC, which warns of types in headers with members of private types.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

# pelage_library(NAME SOURCES ... [ALONE ...] DEPS modules... [PUBLIC_LIBS dep...] [PRIVATE_LIBS dep...])
# One module as a static library, target pelage_NAME, alias pelage::NAME. DEPS are lower modules; PUBLIC_LIBS are
# libraries whose headers our headers show (only Imath, as a rule), PRIVATE_LIBS those that stay inside.
function(pelage_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;DEPS;PUBLIC_LIBS;PRIVATE_LIBS" ${ARGN})
  add_library(pelage_${name} STATIC ${ARG_SOURCES})
  add_library(pelage::${name} ALIAS pelage_${name})
  pelage_join_sources(pelage_${name} ${ARG_ALONE})
  target_precompile_headers(pelage_${name} REUSE_FROM pelage_headers)
  set_target_properties(pelage_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(pelage_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/pelage>)
  target_compile_features(pelage_${name} PUBLIC cxx_std_20)
  target_link_libraries(pelage_${name} PRIVATE $<BUILD_INTERFACE:pelage_options> $<BUILD_INTERFACE:pelage_warnings>)
  list(TRANSFORM ARG_DEPS PREPEND pelage_)
  list(TRANSFORM ARG_PUBLIC_LIBS PREPEND pelage::dep_)
  list(TRANSFORM ARG_PRIVATE_LIBS PREPEND pelage::dep_)
  target_link_libraries(pelage_${name} PUBLIC ${ARG_DEPS} ${ARG_PUBLIC_LIBS} PRIVATE ${ARG_PRIVATE_LIBS})
  install(TARGETS pelage_${name} EXPORT pelage ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# pelage_page(SOURCE FOLDER HEADER FUNCTION): makes SOURCE, a file of the build, which holds all files of FOLDER as
# std::span<const PageFile> FUNCTION(). HEADER declares this function.
function(pelage_page source folder header function)
  file(GLOB files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*)
  add_custom_command(
    OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D OUT=${CMAKE_CURRENT_BINARY_DIR}/${source} -D FOLDER=${CMAKE_CURRENT_SOURCE_DIR}/${folder}
            -D HEADER=${header} -D FUNCTION=${function} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/EmbedPage.cmake)
endfunction()

# One test program. Each of its suites becomes a test of CTest's own, listed when CTest starts. With a sanitizer, where
# every start of a program costs more than most suites, CTest runs it in a few shards instead. No test uses the cache of
# the user (PELAGE_CACHE).
function(pelage_test_program target module label)
  cmake_parse_arguments(ARG "RENDERS" "" "SOURCES;ALONE;DEPS;LIBS" ${ARGN})
  add_executable(${target} ${ARG_SOURCES})
  pelage_join_sources(${target} ${ARG_ALONE})
  list(TRANSFORM ARG_DEPS PREPEND pelage_)
  list(TRANSFORM ARG_LIBS PREPEND pelage::dep_)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE pelage_options pelage_warnings pelage_test_support ${ARG_DEPS} ${ARG_LIBS}
                        GTest::gtest GTest::gtest_main)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_precompile_headers(${target} REUSE_FROM pelage_test_headers)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  if(NOT PELAGE_SANITIZE)
    set(suites ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
    file(CONFIGURE OUTPUT ${suites} CONTENT [[
set(program "@CMAKE_BINARY_DIR@/tests/@target@")
set(name "@module@")
set(labels "@module@;@label@")
include("@PROJECT_SOURCE_DIR@/cmake/TestSuites.cmake")
]] @ONLY)
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites})
    return()
  endif()
  list(LENGTH ARG_SOURCES shards)
  math(EXPR shards "(${shards} + 9) / 10")
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    add_test(NAME ${module}.${shard} COMMAND ${target} --gtest_brief=1)
    set_tests_properties(${module}.${shard} PROPERTIES LABELS "${module};${label}" TIMEOUT 1800
                         ENVIRONMENT "PELAGE_CACHE=off;GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
    if(ARG_RENDERS)
      set_tests_properties(${module}.${shard} PROPERTIES ENVIRONMENT_MODIFICATION
                           "ASAN_OPTIONS=string_append::detect_stack_use_after_return=0")
    endif()
  endforeach()
endfunction()

# pelage_test(MODULE [RENDERS] [SOURCES ...] [THREADED ...] [STATISTICS ...] [SUPPORT ...] [ALONE ...] [DEPS modules...]
#             [LIBS dep...] [LABEL unit|slow])
# The tests of a module. A source belongs to one of three lists, and so to the builds that can find something in it:
#   SOURCES     what one thread computes: release and the address sanitizer
#   THREADED    what several threads share: these two and the thread sanitizer
#   STATISTICS  means and distributions of many samples, and measurements of memory (label `stat`): release alone;
#               single evaluations of the same code are among the others
# SUPPORT is compiled into every program of the module. RENDERS: the tests render or grow so much that the address
# sanitizer does not look for uses of variables whose function has returned, which takes three times as long.
function(pelage_test module)
  cmake_parse_arguments(ARG "RENDERS" "LABEL" "SOURCES;THREADED;STATISTICS;SUPPORT;ALONE;DEPS;LIBS" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  set(renders)
  if(ARG_RENDERS)
    set(renders RENDERS)
  endif()
  set(sources ${ARG_THREADED})
  if(NOT PELAGE_SANITIZE MATCHES "thread")
    list(APPEND sources ${ARG_SOURCES})
  endif()
  if(sources)
    pelage_test_program(test_${module} ${module} ${ARG_LABEL} ${renders} SOURCES ${sources} ${ARG_SUPPORT} ALONE ${ARG_ALONE} DEPS ${ARG_DEPS}
                        LIBS ${ARG_LIBS})
  endif()
  if(ARG_STATISTICS AND NOT PELAGE_SANITIZE)
    pelage_test_program(test_${module}_statistics ${module} stat SOURCES ${ARG_STATISTICS} ${ARG_SUPPORT} DEPS ${ARG_DEPS}
                        LIBS ${ARG_LIBS})
  endif()
endfunction()

# pelage_bench(MODULE SOURCES ... DEPS modules... [LIBS dep...]): one Google Benchmark program per module.
function(pelage_bench module)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;LIBS" ${ARGN})
  set(target bench_${module})
  add_executable(${target} ${ARG_SOURCES})
  pelage_join_sources(${target})
  list(TRANSFORM ARG_DEPS PREPEND pelage_)
  list(TRANSFORM ARG_LIBS PREPEND pelage::dep_)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE pelage_options pelage_warnings ${ARG_DEPS} ${ARG_LIBS}
                        benchmark::benchmark)
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bench)
endfunction()
