# What `cmake --install` leaves behind: headers, libraries, the CMake package `viewgain` and pkg-config
# files. Install components are those of the Debian packages (viewgain_packages.cmake).
include(CMakePackageConfigHelpers)
set(VIEWGAIN_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/viewgain)

# viewgain_link_flags(variable libraries...): -l of each library, a target or a file.
function(viewgain_link_flags variable)
  set(flags "")
  foreach(library IN LISTS ARGN)
    if(TARGET ${library})
      get_target_property(library ${library} LOCATION)
    endif()
    cmake_path(GET library FILENAME name)
    string(REGEX REPLACE "^lib(.+)\\.(so|a)[.0-9]*$" "-l\\1" flag "${name}")
    list(APPEND flags ${flag})
  endforeach()
  set(${variable} ${flags} PARENT_SCOPE)
endfunction()

# viewgain_install_libraries(names... [COMPONENT name] [RUNTIME name] [HEADERS folders...]
#                            [DEPENDENCIES lines...] [STATIC_DEPENDENCIES lines...] [AFTERWARDS lines...]
#                            [REQUIRES modules...] [STATIC_REQUIRES modules...] [STATIC_LIBRARIES libraries...])
# Installs libraries made by viewgain_add_library and what finds them.
#   COMPONENT: what a user asks find_package for; without one they come with the package itself.
#   RUNTIME: the install component of a shared library; all else is in `dev`.
#   HEADERS: folders whose contents go to include/.
#   DEPENDENCIES: find_dependency lines that clients need; STATIC_DEPENDENCIES: for static libraries too.
#   AFTERWARDS: lines once the targets are defined.
#   REQUIRES: pkg-config's modules that clients need. STATIC_REQUIRES, STATIC_LIBRARIES: what linking statically
#     takes besides, modules and libraries (targets or files) that have none.
# A library comes after those it uses.
function(viewgain_install_libraries)
  if(NOT VIEWGAIN_INSTALL)
    return()
  endif()
  cmake_parse_arguments(ARG "" "COMPONENT;RUNTIME"
    "HEADERS;DEPENDENCIES;STATIC_DEPENDENCIES;AFTERWARDS;REQUIRES;STATIC_REQUIRES;STATIC_LIBRARIES" ${ARGN})
  set(stem viewgain)
  if(ARG_COMPONENT)
    set(stem viewgain-${ARG_COMPONENT})
  endif()

  install(TARGETS ${ARG_UNPARSED_ARGUMENTS} EXPORT ${stem}Targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${ARG_RUNTIME} NAMELINK_COMPONENT dev
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
  foreach(folder IN LISTS ARG_HEADERS)
    install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
            FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
  endforeach()

  # <stem>-libraries.cmake finds what the libraries need, then defines their targets.
  set(lines ${ARG_DEPENDENCIES})
  set(private_requires "")
  set(private_flags "")
  if(NOT BUILD_SHARED_LIBS)
    list(APPEND lines ${ARG_STATIC_DEPENDENCIES})
    set(private_requires ${ARG_STATIC_REQUIRES})
    viewgain_link_flags(private_flags ${ARG_STATIC_LIBRARIES})
  endif()
  list(JOIN lines "\n" lines)
  list(JOIN ARG_AFTERWARDS "\n" afterwards)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${stem}-libraries.cmake @ONLY
       CONTENT "@lines@\ninclude(\${CMAKE_CURRENT_LIST_DIR}/@stem@Targets.cmake)\n@afterwards@\n")
  install(FILES ${PROJECT_BINARY_DIR}/${stem}-libraries.cmake
          DESTINATION ${VIEWGAIN_CMAKE_DIR} COMPONENT dev)
  install(EXPORT ${stem}Targets NAMESPACE viewgain:: DESTINATION ${VIEWGAIN_CMAKE_DIR} COMPONENT dev)

  set(flags "")
  foreach(library IN LISTS ARG_UNPARSED_ARGUMENTS)
    get_target_property(type ${library} TYPE)
    if(NOT type STREQUAL INTERFACE_LIBRARY)  # headers alone
      list(PREPEND flags ${library})
    endif()
  endforeach()
  list(TRANSFORM flags PREPEND "-l")
  list(JOIN flags " " flags)
  list(JOIN private_flags " " private_flags)
  list(JOIN ARG_REQUIRES ", " requires)
  list(JOIN private_requires ", " private_requires)
  # Relative to the file, so that the installed tree can be moved; not where a folder is absolute.
  file(RELATIVE_PATH prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  set(prefix "\${pcfiledir}/${prefix}")
  if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
    set(prefix "${CMAKE_INSTALL_PREFIX}")
  endif()
  foreach(folder IN ITEMS LIBDIR INCLUDEDIR)
    set(${folder} "\${prefix}/${CMAKE_INSTALL_${folder}}")
    if(IS_ABSOLUTE "${CMAKE_INSTALL_${folder}}")
      set(${folder} "${CMAKE_INSTALL_FULL_${folder}}")
    endif()
  endforeach()
  configure_file(${PROJECT_SOURCE_DIR}/cmake/viewgain.pc.in ${PROJECT_BINARY_DIR}/${stem}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${stem}.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endfunction()

# The package file itself. It takes any component whose <stem>-libraries.cmake was installed.
if(VIEWGAIN_INSTALL)
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/viewgainConfig.cmake.in
    ${PROJECT_BINARY_DIR}/viewgainConfig.cmake INSTALL_DESTINATION ${VIEWGAIN_CMAKE_DIR}
    NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
  # As the binary interface: the same minor version while the version is 0.x.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/viewgainConfigVersion.cmake
                                   COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/viewgainConfig.cmake
                ${PROJECT_BINARY_DIR}/viewgainConfigVersion.cmake
          DESTINATION ${VIEWGAIN_CMAKE_DIR} COMPONENT dev)
  if(NOT BUILD_SHARED_LIBS)
    install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindViewgainOpenVDB.cmake
            DESTINATION ${VIEWGAIN_CMAKE_DIR} COMPONENT dev)
  endif()
endif()
