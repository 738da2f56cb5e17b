# How the project's targets are made.

# Warnings, sanitizers and floating-point rules that every target of ours is built with.
function(viewgain_compile_rules target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wconversion -Wshadow
                                           $<$<BOOL:${VIEWGAIN_WERROR}>:-Werror>)
  # No fused multiply-add behind our back: every instruction set must take the same steps.
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  if(VIEWGAIN_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${VIEWGAIN_SANITIZE} -fno-omit-frame-pointer
                                             -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${VIEWGAIN_SANITIZE})
  endif()
endfunction()

# SIMD through Highway: on x86-64 each source is compiled for SSE4, AVX2 and AVX-512 and no others, and
# nothing lower, whatever the compiler's flags. core/isa.hpp chooses among them at run time.
function(viewgain_use_highway target)
  target_link_libraries(${target} PRIVATE hwy::hwy)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
    target_compile_definitions(${target} PRIVATE
      "HWY_BASELINE_TARGETS=HWY_SSE4"
      "HWY_DISABLED_TARGETS=(~(HWY_SSE4|HWY_AVX2|HWY_AVX3))")
  endif()
endfunction()

# A module: an object library whose include/ is public and whose src/ is private. Arguments after the
# name: the sources. What a module may use is said by target_link_libraries in its CMakeLists.txt.
function(viewgain_add_module name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/include
                                     PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
  viewgain_compile_rules(${name})
endfunction()

# A library that users link, made of modules.
function(viewgain_add_library name)
  add_library(${name})
  add_library(viewgain::${name} ALIAS ${name})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_compile_features(${name} PUBLIC cxx_std_20)
  foreach(module IN LISTS ARGN)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:${module}>)
    target_include_directories(${name} PUBLIC $<TARGET_PROPERTY:${module},INTERFACE_INCLUDE_DIRECTORIES>)
  endforeach()
  target_link_libraries(${name} PUBLIC Eigen3::Eigen Threads::Threads
                                PRIVATE viewgain_openvdb embree hwy::hwy)
  if(VIEWGAIN_SANITIZE)
    target_link_options(${name} PUBLIC -fsanitize=${VIEWGAIN_SANITIZE})
  endif()
endfunction()
