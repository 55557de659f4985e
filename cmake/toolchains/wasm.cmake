# WebAssembly by Debian's clang and wasi-libc (scripts/setup wasm): one thread, vectors of 128 bits, exceptions in the form that
# node and all browsers read. The runtime of exceptions is compiled by bindings/wasm.
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-22)
set(CMAKE_CXX_COMPILER clang++-22)
set(CMAKE_AR llvm-ar)
set(CMAKE_RANLIB llvm-ranlib)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_ASM_COMPILER clang-22)
set(CMAKE_ASM_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-Wno-deprecated -msimd128")
set(CMAKE_CXX_FLAGS_INIT "-Wno-deprecated -msimd128 -fwasm-exceptions -mllvm -wasm-use-legacy-eh=true")
# Packages of the machine that consist of headers.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(Eigen3_DIR /usr/share/eigen3/cmake)
set(nlohmann_json_DIR /usr/share/cmake/nlohmann_json)
