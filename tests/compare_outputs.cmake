# cmake -DFIRST=<program> -DSECOND=<program> -P compare_outputs.cmake: fails unless both succeed and
# print the same.
foreach(which FIRST SECOND)
  execute_process(COMMAND ${${which}} OUTPUT_VARIABLE ${which}_OUTPUT RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${${which}} failed: ${result}\n${${which}_OUTPUT}")
  endif()
endforeach()
if(FIRST_OUTPUT STREQUAL "" OR NOT FIRST_OUTPUT STREQUAL SECOND_OUTPUT)
  message(FATAL_ERROR "${FIRST} printed\n${FIRST_OUTPUT}\n${SECOND} printed\n${SECOND_OUTPUT}")
endif()
