# Writes the commit that is being built, "-dirty" where files differ, into a header; run at each build.
#   cmake -DSOURCE=... -DHEADER=... -P commit.cmake
execute_process(COMMAND git describe --always --dirty --abbrev=12 --exclude=*
                WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit RESULT_VARIABLE result
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT result EQUAL 0)
  set(commit "unknown")
endif()
# Written only if it changes, so that nothing is compiled again for the same commit.
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define VIEWGAIN_COMMIT \"${commit}\"\n")
