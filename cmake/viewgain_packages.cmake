# Debian packages of what is installed: `cpack` in a folder configured with the preset `packages`.

# viewgain_package(component package licence description [DEPENDS components...] [DEBIAN packages...]
#                  [SECTION section] [NOTICES files...]): one .deb of an install component. `licence` is a
# file's name in LICENSES/ without its ending, as are those of NOTICES, of what others wrote; DEPENDS: other packages of this very version; DEBIAN: further packages,
# besides those that dpkg-shlibdeps finds. A macro: CPack reads variables.
macro(viewgain_package component package licence description)
  cmake_parse_arguments(PKG "" "SECTION" "DEPENDS;DEBIAN;NOTICES" ${ARGN})
  string(TOUPPER ${component} PKG_KEY)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(VIEWGAIN_PACKAGE_${component} ${package})
  set(CPACK_COMPONENT_${PKG_KEY}_DESCRIPTION "${description}")
  set(CPACK_DEBIAN_${PKG_KEY}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${PKG_KEY}_PACKAGE_SECTION ${PKG_SECTION})
  set(PKG_LINES ${PKG_DEBIAN})
  foreach(other IN LISTS PKG_DEPENDS)
    list(APPEND PKG_LINES "${VIEWGAIN_PACKAGE_${other}} (= ${PROJECT_VERSION})")
  endforeach()
  list(JOIN PKG_LINES ", " CPACK_DEBIAN_${PKG_KEY}_PACKAGE_DEPENDS)

  file(READ ${PROJECT_SOURCE_DIR}/LICENSES/${licence}.txt PKG_LICENCE)
  foreach(notice IN LISTS PKG_NOTICES)
    file(READ ${PROJECT_SOURCE_DIR}/LICENSES/${notice}.txt PKG_NOTICE)
    string(APPEND PKG_LICENCE "\nIn it, by others (${notice}):\n\n${PKG_NOTICE}")
  endforeach()
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/copyright/${package}/copyright @ONLY CONTENT
"viewgain @PROJECT_VERSION@
Copyright: 2026 The viewgain authors
License of what is in this package: @licence@, as follows.

@PKG_LICENCE@")
  install(FILES ${PROJECT_BINARY_DIR}/copyright/${package}/copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endmacro()

set(CPACK_COMPONENTS_ALL "")
if(BUILD_SHARED_LIBS)
  viewgain_package(runtime libviewgain${VIEWGAIN_SOVERSION} Apache-2.0
    "Expected information gain of camera poses, shared libraries" SECTION libs)
  set(dev_depends runtime)
  set(dev_licence Apache-2.0)
  if(VIEWGAIN_BUILD_MESH)
    # Surface work is built from parts of CGAL that are GPL.
    viewgain_package(mesh-runtime libviewgain-mesh${VIEWGAIN_SOVERSION} GPL-3.0-or-later
      "Surfaces and candidate views for viewgain, shared libraries" SECTION libs DEPENDS runtime)
    list(APPEND dev_depends mesh-runtime)
  endif()
  # The headers and CMake files are ours and Apache-2.0; linking viewgain::mesh brings the GPL.
  viewgain_package(dev libviewgain-dev Apache-2.0 "Expected information gain of camera poses, headers"
    SECTION libdevel DEPENDS ${dev_depends} DEBIAN "libeigen3-dev (>= 3.4)")
  if(VIEWGAIN_BUILD_OCTOMAP)
    set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS liboctomap-dev) # for the component octomap
  endif()
endif()
if(VIEWGAIN_BUILD_APPS AND BUILD_SHARED_LIBS)
  viewgain_package(program viewgain GPL-3.0-or-later
    "Scores camera poses by expected information gain, program" SECTION science
    DEPENDS runtime mesh-runtime NOTICES MIT-three.js)
endif()
if(VIEWGAIN_BUILD_PYTHON AND BUILD_SHARED_LIBS)
  # An extension is for one minor version of Python.
  math(EXPR next_python "${VIEWGAIN_PYTHON_MINOR} + 1")
  set(python_depends "python3 (>= 3.${VIEWGAIN_PYTHON_MINOR})" "python3 (<< 3.${next_python})"
      python3-numpy)
  viewgain_package(python python3-viewgain Apache-2.0
    "Expected information gain of camera poses, Python" SECTION python DEPENDS runtime
    DEBIAN ${python_depends})
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-scipy, python3-matplotlib") # viewgain.study, viewgain.plot
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "viewgain, python3-distributed")
  if(TARGET _mesh)
    viewgain_package(python-mesh python3-viewgain-mesh GPL-3.0-or-later
      "Surfaces and the reconstruction loop of viewgain, Python" SECTION python
      DEPENDS runtime mesh-runtime python DEBIAN ${python_depends})
  endif()
endif()
if(VIEWGAIN_BUILD_DOCS AND TARGET docs)
  viewgain_package(doc viewgain-doc Apache-2.0
    "Expected information gain of camera poses, documentation" SECTION doc)
  set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME viewgain)
set(CPACK_PACKAGE_VENDOR "The viewgain authors")
set(CPACK_PACKAGE_CONTACT "The viewgain authors <viewgain@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where dpkg-shlibdeps finds our own libraries, which no package has yet.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}
    ${PROJECT_BINARY_DIR}/apps/formats ${PROJECT_BINARY_DIR}/apps/literature
    ${PROJECT_BINARY_DIR}/apps/planner
    ${PROJECT_BINARY_DIR}/apps/planner_mesh ${PROJECT_BINARY_DIR}/mesh)
# While the version is 0.x a binary needs the very version it was linked with.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
include(CPack)
