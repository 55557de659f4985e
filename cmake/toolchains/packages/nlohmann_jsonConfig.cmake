# The machine's headers of nlohmann-json for a cross compiler, which must see nothing else of /usr/include.
set(headers ${CMAKE_BINARY_DIR}/machine_headers)
file(MAKE_DIRECTORY ${headers})
file(CREATE_LINK /usr/include/nlohmann ${headers}/nlohmann SYMBOLIC)
if(NOT TARGET nlohmann_json::nlohmann_json)
  add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)
  target_include_directories(nlohmann_json::nlohmann_json INTERFACE ${headers})
endif()
