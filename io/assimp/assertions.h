#pragma once

namespace sunder::assimp_import {

/// While it exists, assertions of assimp that fail in this thread are thrown as
/// std::runtime_error. Without it they end the process, as assimp's own do.
class AssertionsThrow {
 public:
  AssertionsThrow();
  ~AssertionsThrow();
  AssertionsThrow(const AssertionsThrow&) = delete;
  AssertionsThrow& operator=(const AssertionsThrow&) = delete;
};

}  // namespace sunder::assimp_import
