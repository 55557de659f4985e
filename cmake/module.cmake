set(SUNDER_FRAME_OPTIMISATION -O3 CACHE STRING "How release builds optimise the modules that run within a frame")

# sunder_module(<name> [IN_FRAME] HEADERS <public headers, relative to include/> SOURCES <files> [LINK <modules below>]
#               [PRIVATE_LINK <third parties>])
#
# Adds the static or shared library of a module, `sunder::<name>`. Only its public headers, include/sunder/<name>/, are
# installed; each of them is compiled alone (target all_verify_interface_header_sets). IN_FRAME: the module runs within a
# frame. Release builds optimise it further, which saves a tenth of the time of a tear.
macro(sunder_header_module name)
  add_library(${target} INTERFACE)
  add_library(sunder::${name} ALIAS ${target})
  target_sources(${target} INTERFACE FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${arg_HEADERS})
  target_compile_features(${target} INTERFACE cxx_std_20)
  foreach(module IN LISTS arg_LINK)
    target_link_libraries(${target} INTERFACE sunder::${module})
  endforeach()
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  set_property(GLOBAL APPEND PROPERTY SUNDER_MODULES ${target})
endmacro()

function(sunder_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "IN_FRAME" "" "HEADERS;SOURCES;LINK;PRIVATE_LINK")
  list(TRANSFORM arg_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/include/sunder/)
  set(target sunder_${name})
  if(NOT arg_SOURCES)
    sunder_header_module(${name})
    return()
  endif()
  add_library(${target} ${arg_SOURCES})
  add_library(sunder::${name} ALIAS ${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${arg_HEADERS})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen)
  foreach(module IN LISTS arg_LINK)
    target_link_libraries(${target} PUBLIC sunder::${module})
  endforeach()
  foreach(library IN LISTS arg_PRIVATE_LINK)
    target_link_libraries(${target} PRIVATE ${library})
  endforeach()
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON
    VERIFY_INTERFACE_HEADER_SETS ON)
  if(BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PRIVATE SUNDER_BUILDING)
  else()
    target_compile_definitions(${target} PUBLIC SUNDER_STATIC)
  endif()
  sunder_compile_options(${target})
  if(arg_IN_FRAME)
    target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:${SUNDER_FRAME_OPTIMISATION}>)
  endif()
  set_property(GLOBAL APPEND PROPERTY SUNDER_MODULES ${target})
endfunction()

# Warnings, and the same bits at every optimisation level: no fused multiply-add. errno is not used, so square roots need not be
# calls.
function(sunder_compile_options target)
  if(MSVC)  # Nobody has run it. It fuses nothing by default since Visual Studio 2022.
    target_compile_options(${target} PRIVATE /W4 /fp:precise /permissive- /utf-8 /bigobj /Zc:__cplusplus /Zc:preprocessor)
    if(SUNDER_WARNINGS_AS_ERRORS)
      target_compile_options(${target} PRIVATE /WX)
    endif()
    return()
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -ffp-contract=off
    -fno-math-errno)
  get_target_property(is_unity ${target} UNITY_BUILD)
  # These warnings take the sources that are compiled together for headers.
  if(is_unity AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage -Wno-shadow -Wshadow=local)
  elseif(is_unity AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(${target} PRIVATE -Wno-shadow)
  endif()
  if(SUNDER_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# For what does not run long, the command and imports: -O1 in release builds, which saves a quarter of its compile time.
function(sunder_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang,AppleClang>>:-O1>)
endfunction()
