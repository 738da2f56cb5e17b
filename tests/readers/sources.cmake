# The table of readers, the calls of C, and the sources of the planner and the program that they reach into.
find_package(nlohmann_json CONFIG REQUIRED)
set(apps ${PROJECT_SOURCE_DIR}/apps)
set(VIEWGAIN_READERS
  ${CMAKE_CURRENT_LIST_DIR}/readers.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../fuzz/c_calls.cpp ${CMAKE_CURRENT_LIST_DIR}/../fuzz/scorer_calls.cpp
  ${CMAKE_CURRENT_LIST_DIR}/../mesh/files/mesh_dialects.cpp
  ${apps}/program/cli/values.cpp ${apps}/program/commands/reconstruct/checkpoint.cpp)
if(BUILD_SHARED_LIBS)  # of which this is hidden
  list(APPEND VIEWGAIN_READERS ${apps}/planner/src/choose/planner_state.cpp)
endif()

function(viewgain_link_readers target)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${apps} ${apps}/planner/src)
  target_link_libraries(${target} PRIVATE viewgain_planner viewgain_formats viewgain_mesh_io nlohmann_json::nlohmann_json)
  target_compile_definitions(${target} PRIVATE VIEWGAIN_DATA="${PROJECT_SOURCE_DIR}/tests/data")
endfunction()
