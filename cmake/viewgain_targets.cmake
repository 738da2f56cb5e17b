# How the project's targets are made.

# Warnings, sanitizers and floating-point rules that every target of ours is built with. A release is
# built at -O3 where rays and voxels are; elsewhere a folder says in VIEWGAIN_OPTIMIZE what it needs,
# since compiling takes most of a fresh machine's time.
function(viewgain_compile_rules target)
  if(VIEWGAIN_OPTIMIZE AND PROJECT_IS_TOP_LEVEL)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:${VIEWGAIN_OPTIMIZE}>)
  endif()
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                                           $<$<BOOL:${VIEWGAIN_WERROR}>:-Werror>)
  # No fused multiply-add behind our back: every instruction set must take the same steps.
  target_compile_options(${target} PRIVATE -ffp-contract=off -fno-semantic-interposition)
  if(VIEWGAIN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${VIEWGAIN_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${VIEWGAIN_SANITIZE})
  endif()
endfunction()

# viewgain_use_highway(target sources...): SIMD through Highway: on x86-64 each of the sources is compiled
# for SSE4, AVX2 and AVX-512 and no others, and nothing lower, whatever the compiler's flags. support/isa.hpp
# chooses among them at run time. On arm64 NEON alone: SVE's vectors cannot be members. Highway takes NEON to have
# AES, which the compiler must then be told; no instruction of it is used.
function(viewgain_use_highway target)
  # Each is a translation unit of its own, since it includes itself anew for each instruction set.
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_link_libraries(${target} PRIVATE hwy::hwy)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    target_compile_definitions(${target} PRIVATE
      "HWY_BASELINE_TARGETS=HWY_SSE4"
      "HWY_DISABLED_TARGETS=(~(HWY_SSE4|HWY_AVX2|HWY_AVX3))")
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_definitions(${target} PRIVATE
      "HWY_BASELINE_TARGETS=HWY_NEON"
      "HWY_DISABLED_TARGETS=(~HWY_NEON)")
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -march=armv8-a+crypto)
  endif()
endfunction()

# viewgain_reuse_headers(target owner): the precompiled headers of another target, whose flags are the same.
function(viewgain_reuse_headers target owner)
  target_precompile_headers(${target} REUSE_FROM ${owner})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT VIEWGAIN_SANITIZE)
    # GCC takes what it inlines from a precompiled <string> for ours, with its own false alarms.
    target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow)
  endif()
endfunction()

# viewgain_compile_together(target sources...): the sources of a folder are one translation unit, which
# halves what a build costs: most of a source's time goes into the same headers.
function(viewgain_compile_together target)
  if(NOT VIEWGAIN_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  list(FILTER ARGN EXCLUDE REGEX "^\\$<")  # objects of others
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder})
  endforeach()
  # GCC takes an anonymous namespace that a unit includes for one of a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# A module: an object library whose include/ is public and whose src/ is private. Arguments after the
# name: the sources. What a module may use is said by target_link_libraries in its CMakeLists.txt.
function(viewgain_add_module name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include
                                     PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  viewgain_compile_rules(${name})
  viewgain_compile_together(${name} ${ARGN})
  # Only what says VIEWGAIN_EXPORT leaves a library. Inline functions never do: those of a client that is
  # compiled for another instruction set must not take the place of ours.
  set_target_properties(${name} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# Puts modules into a library.
function(viewgain_assemble name)
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_compile_features(${name} PUBLIC cxx_std_20)
  foreach(module IN LISTS ARGN)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:${module}>)
    target_include_directories(${name} PUBLIC
      $<BUILD_INTERFACE:$<TARGET_PROPERTY:${module},INTERFACE_INCLUDE_DIRECTORIES>>)
  endforeach()
  target_include_directories(${name} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(VIEWGAIN_SANITIZE)
    # For in-tree users alone: an installed library does not ask its clients for sanitizers.
    target_link_options(${name} PUBLIC $<BUILD_INTERFACE:-fsanitize=${VIEWGAIN_SANITIZE}>)
  endif()
endfunction()

# An installed program or library finds our libraries in `folder`, relative to itself, wherever the prefix
# is moved to. The loader looks into /usr by itself.
function(viewgain_find_beside target folder)
  if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${folder}")
  endif()
endfunction()

# viewgain_add_library(name modules... [PUBLIC libraries...] [PRIVATE libraries...]): a library that users
# link, made of modules; shared if BUILD_SHARED_LIBS is on.
function(viewgain_add_library name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  string(REGEX REPLACE "^viewgain_" "" short_name ${name})
  add_library(${name})
  add_library(viewgain::${short_name} ALIAS ${name})
  viewgain_assemble(${name} ${ARG_UNPARSED_ARGUMENTS})
  set_target_properties(${name} PROPERTIES EXPORT_NAME ${short_name} VERSION ${PROJECT_VERSION}
                        SOVERSION ${VIEWGAIN_SOVERSION})
  viewgain_find_beside(${name} ".")
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()
