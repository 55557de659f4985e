# sunder_api.json is what make_api.py writes for the header.
execute_process(COMMAND ${PYTHON} ${GENERATOR} ${HEADER} OUTPUT_VARIABLE fresh COMMAND_ERROR_IS_FATAL ANY)
file(READ ${KEPT} kept)
if(NOT fresh STREQUAL kept)
  message(FATAL_ERROR "sunder_c.h has changed: python3 bindings/c/make_api.py include/sunder_c.h > bindings/c/sunder_api.json")
endif()
