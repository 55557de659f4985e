# Flags against the use of faults by hostile files. Links, everywhere: position-independent programs, tables of addresses that are
# read-only before main() runs, no executable stack. Compiled, with sunder_harden(<target>), what reads files of strangers:
# checked copies and stack protectors. The modules that run within a frame are compiled as without it.
option(SUNDER_HARDENING "Hardening flags: RELRO, -z now, PIE; _FORTIFY_SOURCE and stack protectors in what reads files" ${PROJECT_IS_TOP_LEVEL})
if(SUNDER_HARDENING AND UNIX AND NOT APPLE)
  include(CheckPIESupported)
  check_pie_supported(LANGUAGES CXX)
  add_link_options(LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)
endif()

function(sunder_harden target)
  if(NOT SUNDER_HARDENING)
    return()
  endif()
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  # Checked copies need an optimised build; some distributions set the macro, and a second definition is a warning.
  target_compile_options(${target} PRIVATE -fstack-protector-strong
    $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release,RelWithDebInfo,MinSizeRel>:-D_FORTIFY_SOURCE=2>)
endfunction()
