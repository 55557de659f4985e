/* A program that uses the installed C library. */

#include <stdio.h>
#include <sunder_c.h>

int main(void) {
  sunder_scene scene = 0;
  sunder_instance instance = 0;
  if (sunder_check_abi(SUNDER_C_VERSION, 0) != SUNDER_OK) return 1;
  if (sunder_create_scene(NULL, &scene) != SUNDER_OK) return 1;
  if (sunder_spawn(scene, 0, NULL, &instance) != SUNDER_INVALID_HANDLE) return 1;
  printf("%s\n", sunder_last_error());
  return sunder_destroy_scene(scene) == SUNDER_OK ? 0 : 1;
}
