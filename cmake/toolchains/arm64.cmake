# 64-bit ARM by Debian's cross compiler (scripts/setup arm64); programs run by qemu-user. Highway is unpacked to build/arm64.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64;-L;/usr/aarch64-linux-gnu)
set(packages ${CMAKE_CURRENT_LIST_DIR}/../../build/arm64_packages/usr)
list(APPEND CMAKE_PREFIX_PATH ${packages} ${packages}/lib/aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# Packages of the machine that consist of headers.
set(Eigen3_DIR /usr/share/eigen3/cmake)
set(nlohmann_json_DIR ${CMAKE_CURRENT_LIST_DIR}/packages)
