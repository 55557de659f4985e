# Run by ctest with -P; see CMakeLists.txt. Any failing step stops it.
function(run)
  execute_process(COMMAND ${ARGN}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
endfunction()

set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${prefix} ${WORK}/find_package)
run(${CMAKE_COMMAND} --install ${SUNDER_BUILD} --config ${CONFIG} --prefix ${prefix})

# The installed headers are exactly the files of include/.
file(GLOB_RECURSE written RELATIVE ${SUNDER_SOURCE}/include ${SUNDER_SOURCE}/include/*)
file(GLOB_RECURSE installed RELATIVE ${prefix}/${INCLUDE_DIR} ${prefix}/${INCLUDE_DIR}/*)
if(NOT WITH_IO)
  list(FILTER written EXCLUDE REGEX "^sunder/io/")
endif()
if(NOT WITH_C)
  list(FILTER written EXCLUDE REGEX "^sunder_c.h")
endif()
if(NOT WITH_CERES)
  list(FILTER written EXCLUDE REGEX "^sunder/(coupled_refit|plan)/")
endif()
list(SORT written)
list(SORT installed)
if(NOT written STREQUAL installed)
  message(FATAL_ERROR "include/ and the installed headers differ\n"
    "written:   ${written}\ninstalled: ${installed}")
endif()

include(${SUNDER_SOURCE}/tests/package/needed.cmake)
check_needed(${prefix} ${SUNDER_SOURCE}/THIRD_PARTY.md)
include(${SUNDER_SOURCE}/tests/package/hardening.cmake)
if(WITH_HARDENING AND NOT CXX_FLAGS MATCHES "sanitize")
  string(REGEX MATCH "Rel" optimised "${CONFIG}")
  check_hardening(${prefix} "${optimised}")
endif()

# The installed command finds the installed helper executable.
find_program(command sunder PATHS ${prefix}/bin NO_DEFAULT_PATH)
if(WITH_IO AND command)
  file(WRITE ${WORK}/triangle.off "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
  run(${command} info ${WORK}/triangle.off)
endif()

set(consumer ${SUNDER_SOURCE}/tests/package/consumer)
set(common -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}"
  -D CMAKE_CXX_COMPILER_LAUNCHER=${CXX_COMPILER_LAUNCHER} -D CMAKE_BUILD_TYPE=${CONFIG})

run(${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/find_package ${common}
  -D CMAKE_PREFIX_PATH=${prefix} -D CONSUMER_IO=${WITH_IO}
  -D CONSUMER_COUPLED_REFIT=${WITH_CERES} -D CONSUMER_C=${WITH_C})
run(${CMAKE_COMMAND} --build ${WORK}/find_package --config ${CONFIG})
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/find_package -C ${CONFIG} --output-on-failure
  --no-tests=error)

# The C library by pkg-config, wherever the package is.
find_program(pkg_config pkg-config)
find_program(c_compiler NAMES cc gcc clang)
file(GLOB_RECURSE pc ${prefix}/sunder_c.pc)
if(WITH_C AND pkg_config AND c_compiler AND NOT CXX_FLAGS MATCHES "sanitize")
  cmake_path(GET pc PARENT_PATH pc_folder)
  set(ENV{PKG_CONFIG_PATH} ${pc_folder})
  execute_process(COMMAND ${pkg_config} --cflags --libs sunder_c OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${c_compiler} ${consumer}/c_consumer.c -o ${WORK}/c_consumer ${flags})
  cmake_path(GET pc_folder PARENT_PATH libraries)
  run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${libraries} ${WORK}/c_consumer)
endif()

# The runtime with Eigen only, as shared libraries: other packages are hidden from CMake, so a
# dependency on one fails. The whole runtime is configured; the parts that the consumer needs are
# built.
set(hidden "")
foreach(package hwy TBB TinyGLTF assimp draco meshoptimizer nlohmann_json CLI11 GTest benchmark Ceres Bullet)
  list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${consumer} -B ${WORK}/add_subdirectory ${common}
  -D SUNDER_SOURCE=${SUNDER_SOURCE} -D SUNDER_IO=OFF -D SUNDER_HIGHWAY=OFF -D CONSUMER_IO=OFF
  -D BUILD_SHARED_LIBS=ON -D CMAKE_UNITY_BUILD=ON -D CMAKE_UNITY_BUILD_BATCH_SIZE=48 ${hidden})
run(${CMAKE_COMMAND} --build ${WORK}/add_subdirectory --config ${CONFIG} --target consumer tear_consumer)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/add_subdirectory -C ${CONFIG} --output-on-failure
  --no-tests=error)
