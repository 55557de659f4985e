# CMake 3.25 does not know WASI, and says so at length without this file. Its defaults are right.
