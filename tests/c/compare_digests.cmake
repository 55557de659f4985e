# Fails unless the C program and a program of another binding print the same of all cases.
#
#   cmake -D WRITE=… -D PRINT=… -D RUN=program;arguments -D FOLDER=… -D COUNT=… -P compare_digests.cmake
#
# RUN gets the folder, the count and the file to which it prints. Without the file NEEDS, if that is given, nothing runs.
if(NEEDS AND NOT EXISTS ${NEEDS})
  message(STATUS "the comparison is left out: ${NEEDS} is absent")
  return()
endif()
execute_process(COMMAND ${WRITE} ${FOLDER} ${COUNT} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${PRINT} ${FOLDER} ${COUNT} OUTPUT_FILE ${FOLDER}/c.txt COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${RUN} ${FOLDER} ${COUNT} ${FOLDER}/binding.txt COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${FOLDER}/c.txt wanted)
file(STRINGS ${FOLDER}/binding.txt have)
list(LENGTH wanted lines)
list(LENGTH have lines_of_binding)
if(NOT lines EQUAL COUNT OR NOT lines_of_binding EQUAL COUNT)
  message(FATAL_ERROR "${lines} and ${lines_of_binding} cases of ${COUNT}")
endif()
foreach(want one IN ZIP_LISTS wanted have)
  if(NOT want STREQUAL one)
    message(FATAL_ERROR "C:           ${want}\nthe binding: ${one}")
  endif()
endforeach()
message(STATUS "${lines} cases have the same digests")
