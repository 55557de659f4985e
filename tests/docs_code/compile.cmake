# Compiles the C++ of the pages: cmake -D BUILD=… -D CONFIG=… -P compile.cmake
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BUILD} --config "${CONFIG}" --target docs_code RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "C++ shown in README.md or docs/*.md does not compile. The errors above name the page and the line. "
    "A fragment is the body of a function; declare the names that it uses in a comment on the line above its ```cpp:\n"
    "  <!-- given: TornModel& model, const ModelPose& pose -->\n"
    "A block with #include lines is compiled as a file.")
endif()
