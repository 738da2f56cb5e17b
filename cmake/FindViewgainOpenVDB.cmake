# OpenVDB for linking, as the imported target viewgain_openvdb. OpenVDB's own find module asks for
# Boost.Iostreams and PyImath, which a user of the library does not need; Imath carries the half-float
# tables that its headers refer to. Installed beside a static viewgain, whose users link OpenVDB too.
find_package(TBB CONFIG QUIET)
find_path(OpenVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OpenVDB_LIBRARY openvdb)
find_library(Imath_LIBRARY NAMES Imath Imath-3_1 Imath-3_2)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ViewgainOpenVDB
  REQUIRED_VARS OpenVDB_LIBRARY OpenVDB_INCLUDE_DIR Imath_LIBRARY TBB_FOUND)
if(ViewgainOpenVDB_FOUND AND NOT TARGET viewgain_openvdb)
  # Global: a static viewgain taken in by add_subdirectory is linked from the directories above.
  add_library(viewgain_openvdb INTERFACE IMPORTED GLOBAL)
  target_include_directories(viewgain_openvdb INTERFACE ${OpenVDB_INCLUDE_DIR})
  target_link_libraries(viewgain_openvdb INTERFACE ${OpenVDB_LIBRARY} TBB::tbb ${Imath_LIBRARY})
endif()
