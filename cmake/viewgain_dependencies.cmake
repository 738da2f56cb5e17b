# The libraries that viewgain stands on. Everything is found, nothing is downloaded.

# Where viewgain is static and taken in by add_subdirectory, its user's directory links these too.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)

# CGAL asks for Boost the old way, which newer versions of CMake warn of.
set(CMAKE_POLICY_DEFAULT_CMP0167 NEW)

find_package(Threads REQUIRED)

# Ranges over major versions are refused by Eigen's version file, hence the check by hand.
find_package(Eigen3 CONFIG REQUIRED NO_MODULE)
if(Eigen3_VERSION VERSION_LESS 3.4)
  message(FATAL_ERROR "viewgain needs Eigen 3.4 or newer, found ${Eigen3_VERSION}")
endif()

# Embree 4 where there is one, else 3.13. The choice reaches the sources as VIEWGAIN_EMBREE_MAJOR.
find_package(embree 4 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 3.13 CONFIG REQUIRED)
endif()
string(REGEX MATCH "^[0-9]+" VIEWGAIN_EMBREE_MAJOR "${embree_VERSION}")

find_package(ViewgainOpenVDB REQUIRED)

# Highway: one SIMD source, the instruction set chosen at run time.
find_package(hwy CONFIG REQUIRED)
