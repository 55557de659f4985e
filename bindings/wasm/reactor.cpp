// A module without main(): its functions are those of the C library.
