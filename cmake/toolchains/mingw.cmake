# 64-bit Windows by Debian's MinGW-w64, with threads of POSIX (scripts/setup mingw); programs run by wine.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_CROSSCOMPILING_EMULATOR wine)
# gcc takes inline functions of this format for ones that the linker never replaces, and keeps values in registers that another
# copy of the function overwrites.
set(CMAKE_CXX_FLAGS_INIT -fno-ipa-ra)
# The runtime of gcc is linked into each library and program: nothing else needs to be installed with them.
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-static")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
# Packages of the machine that consist of headers.
set(Eigen3_DIR /usr/share/eigen3/cmake)
set(nlohmann_json_DIR ${CMAKE_CURRENT_LIST_DIR}/packages)
