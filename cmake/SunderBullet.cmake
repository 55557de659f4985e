# The target sunder_third_party::bullet: Bullet's rigid bodies in single precision. CMake's own module only sets variables, but an
# export needs a target. This file is used here and installed next to SunderConfig.cmake.
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
