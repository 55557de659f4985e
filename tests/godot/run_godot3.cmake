# cmake -DGODOT=<godot3-server> -DPROJECT=<folder> -DPROGRAM=<program> -P run_godot3.cmake: fails unless the script of the project
# prints what the program prints. Godot writes its settings into a home of its own.
execute_process(COMMAND ${PROGRAM} OUTPUT_VARIABLE wanted RESULT_VARIABLE result OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT result EQUAL 0 OR wanted STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} failed: ${result}")
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env HOME=${PROJECT}/home XDG_DATA_HOME=${PROJECT}/home XDG_CONFIG_HOME=${PROJECT}/home
    XDG_CACHE_HOME=${PROJECT}/home ${GODOT} --path ${PROJECT} -s main.gd
  OUTPUT_VARIABLE printed ERROR_VARIABLE errors RESULT_VARIABLE result TIMEOUT 120 OUTPUT_STRIP_TRAILING_WHITESPACE)
string(REGEX MATCH "[^\n]*$" last "${printed}")
if(NOT result EQUAL 0 OR NOT last STREQUAL wanted)
  message(FATAL_ERROR "Godot: ${result}, expected\n${wanted}\nfound\n${printed}\n${errors}")
endif()
