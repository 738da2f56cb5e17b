# Makes the report's page out of viewer/ (SOURCE) with npm (NPM): PAGE, in the folder WORK. An empty
# page with a warning where that cannot be had.
file(WRITE ${PAGE} "")
if(NOT NPM)
  message(WARNING "npm is missing: the program will have no --report")
  return()
endif()
file(COPY ${SOURCE}/ DESTINATION ${WORK})
foreach(arguments "ci;--ignore-scripts;--no-audit;--no-fund;--loglevel=error" "run;build;--silent;--;${PAGE}")
  execute_process(COMMAND ${NPM} ${arguments} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE failed
                  OUTPUT_VARIABLE said ERROR_VARIABLE said)
  if(failed)
    file(WRITE ${PAGE} "")
    message(WARNING "npm ${arguments} failed, the program will have no --report: ${said}")
    return()
  endif()
endforeach()
