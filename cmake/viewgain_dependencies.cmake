# The libraries that viewgain stands on. Everything is found, nothing is downloaded.

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

# OpenVDB's own find module asks for Boost.Iostreams and PyImath, which a user of the library does not
# need; Imath carries the half-float tables that its headers refer to.
find_package(TBB CONFIG REQUIRED)
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h REQUIRED)
find_library(OpenVDB_LIBRARY openvdb REQUIRED)
find_library(Imath_LIBRARY NAMES Imath Imath-3_1 Imath-3_2 REQUIRED)
if(NOT TARGET viewgain_openvdb)
  add_library(viewgain_openvdb INTERFACE)
  target_include_directories(viewgain_openvdb SYSTEM INTERFACE ${OpenVDB_INCLUDE_DIR})
  target_link_libraries(viewgain_openvdb INTERFACE ${OpenVDB_LIBRARY} TBB::tbb ${Imath_LIBRARY})
endif()

# Highway: one SIMD source, the instruction set chosen at run time.
find_package(hwy CONFIG REQUIRED)
