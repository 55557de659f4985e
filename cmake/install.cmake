# find_package(Sunder CONFIG) provides the targets sunder::<module>.
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY SUNDER_MODULES)
add_custom_target(sunder_libraries DEPENDS ${modules})
install(TARGETS ${modules} EXPORT SunderTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET sunder)
  install(TARGETS sunder RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET sunder-coupled-refit)
  install(TARGETS sunder-coupled-refit RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR})
endif()
install(FILES THIRD_PARTY.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(TARGET sunder-import)  # also for users of the package: $<TARGET_FILE:sunder::sunder-import>
  install(TARGETS sunder-import EXPORT SunderTargets RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR})
endif()

# Relative run paths: shared libraries find one another, and the command finds them, under any
# prefix.
if(BUILD_SHARED_LIBS AND UNIX AND NOT APPLE)
  set_target_properties(${modules} PROPERTIES INSTALL_RPATH "$ORIGIN")
  if(TARGET sunder)
    file(RELATIVE_PATH lib_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
    set_target_properties(sunder PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
  endif()
  file(RELATIVE_PATH lib_from_libexec ${CMAKE_INSTALL_FULL_LIBEXECDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  foreach(program sunder-import sunder-coupled-refit)
    if(TARGET ${program})
      set_target_properties(${program} PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_libexec}")
    endif()
  endforeach()
endif()

# Programs that link a static archive also link its private libraries.
set(SUNDER_STATIC_DEPENDENCIES "")
if(NOT BUILD_SHARED_LIBS)
  string(APPEND SUNDER_STATIC_DEPENDENCIES "find_dependency(Threads)\n")
endif()
if(SUNDER_HIGHWAY AND NOT BUILD_SHARED_LIBS)
  string(APPEND SUNDER_STATIC_DEPENDENCIES "find_dependency(hwy 1.0.3)\n")
endif()
if(SUNDER_CERES)  # only for programs that ask for one of these components
  string(APPEND SUNDER_STATIC_DEPENDENCIES "set(Sunder_coupled_refit_FOUND TRUE)\nset(Sunder_plan_FOUND TRUE)\n")
  if(NOT BUILD_SHARED_LIBS)
    string(APPEND SUNDER_STATIC_DEPENDENCIES
      "if(coupled_refit IN_LIST Sunder_FIND_COMPONENTS OR plan IN_LIST Sunder_FIND_COMPONENTS)\n  find_dependency(Ceres 2.1)\nendif()\n")
  endif()
endif()
if(SUNDER_BULLET AND NOT BUILD_SHARED_LIBS)
  string(APPEND SUNDER_STATIC_DEPENDENCIES "include(\${CMAKE_CURRENT_LIST_DIR}/SunderBullet.cmake)\n")
endif()
if(SUNDER_QHULL AND NOT BUILD_SHARED_LIBS)
  string(APPEND SUNDER_STATIC_DEPENDENCIES "find_dependency(Qhull CONFIG)\n")
endif()
if(SUNDER_IO AND NOT BUILD_SHARED_LIBS)
  string(APPEND SUNDER_STATIC_DEPENDENCIES "find_dependency(assimp)\nfind_dependency(nlohmann_json)\n"
    "find_dependency(simdjson)\nfind_dependency(draco)\nfind_dependency(meshoptimizer)\n"
    "find_dependency(tinyxml2)\nfind_dependency(urdfdom)\nfind_dependency(ZLIB)")
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Sunder)
install(EXPORT SunderTargets NAMESPACE sunder:: DESTINATION ${package_dir})
configure_package_config_file(cmake/SunderConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/SunderConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/SunderConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/SunderConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/SunderConfigVersion.cmake DESTINATION ${package_dir})
if(SUNDER_BULLET AND NOT BUILD_SHARED_LIBS)
  install(FILES cmake/SunderBullet.cmake DESTINATION ${package_dir})
endif()
