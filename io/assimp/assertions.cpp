#include "io/assimp/assertions.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <assimp/ai_assert.h>

namespace {

thread_local int imports_of_thread = 0;

}  // namespace

// Debian builds assimp with assertions, and some valid files violate them. During an import a
// failed assertion becomes an import error; in the rest of the program, which may use assimp
// itself, it works as before. If the linker keeps assimp's own version of this function, the helper
// process aborts and the caller reports that.
namespace Assimp {
__attribute__((visibility("default"))) void aiAssertViolation(const char* expression,
                                                              const char* file, int line) {
  if (imports_of_thread > 0)
    throw std::runtime_error(std::string("assertion failed: ") + expression);
  std::fprintf(stderr, "ai_assert failure in %s(%d): %s\n", file, line, expression);
  std::abort();
}
}  // namespace Assimp

namespace sunder::assimp_import {

AssertionsThrow::AssertionsThrow() { ++imports_of_thread; }
AssertionsThrow::~AssertionsThrow() { --imports_of_thread; }

}  // namespace sunder::assimp_import
