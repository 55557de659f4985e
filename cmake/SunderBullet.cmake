# The target sunder_third_party::bullet: rigid bodies of Bullet in single precision. CMake's own module finds variables only, and
# an export needs a target; so this file is used here and installed beside SunderConfig.cmake.
if(NOT TARGET sunder_third_party::bullet)
  include(CMakeFindDependencyMacro)
  if(PROJECT_NAME STREQUAL "Sunder")
    find_package(Bullet MODULE REQUIRED)
  else()
    find_dependency(Bullet MODULE)
  endif()
  add_library(sunder_third_party::bullet INTERFACE IMPORTED GLOBAL)
  target_include_directories(sunder_third_party::bullet INTERFACE ${BULLET_INCLUDE_DIRS})
  target_link_libraries(sunder_third_party::bullet INTERFACE
    ${BULLET_DYNAMICS_LIBRARY} ${BULLET_COLLISION_LIBRARY} ${BULLET_MATH_LIBRARY})
endif()
