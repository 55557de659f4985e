#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sunder::test {

struct ScannedClass {
  std::string name;      ///< As it is written where the class is defined: "State", "Model::State".
  std::size_t line = 0;  ///< The line where it begins, from 1.
  std::size_t methods = 0;  ///< Overloads, constructors and operators each; none that is deleted.
  std::size_t members = 0;  ///< Data of each object, none that is static.
};

/// The classes and structs that a source defines, local and nested ones too.
std::vector<ScannedClass> scan_classes(const std::string& source);

}  // namespace sunder::test
