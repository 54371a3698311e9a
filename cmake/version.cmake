# The commit that --version names. Taken at configure time; "unknown" outside a git checkout.
execute_process(COMMAND git -C ${CMAKE_SOURCE_DIR} rev-parse --short=9 HEAD
  OUTPUT_VARIABLE TALUS_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT TALUS_COMMIT)
  set(TALUS_COMMIT unknown)
endif()
