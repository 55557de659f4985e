#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder::fbx {

/// A value of a record: a text, a number, or an array of numbers.
struct Value {
  std::string text;
  std::int64_t integer = 0;     ///< A number without its fraction.
  std::vector<double> numbers;  ///< One for a number, all of an array, none for a text.

  [[nodiscard]] double number() const { return numbers.empty() ? 0.0 : numbers.front(); }
};

/// A node of an FBX document, as binary and text files have it: `name: values { children }`.
struct Record {
  std::string name;
  std::vector<Value> values;
  std::vector<Record> children;

  /// The first child of that name; null if there is none.
  [[nodiscard]] const Record* child(std::string_view wanted) const;
  /// The array in a child's first value; in text files it is in the child's child `a`. Empty if
  /// there is none.
  [[nodiscard]] std::span<const double> array(std::string_view wanted) const;
};

/// Reads the records that animate: those of models, animations and connections. Records of
/// geometry, textures and everything else are skipped, not decoded.
///
/// @param file  a binary or text FBX file of version 7.
/// @throws std::runtime_error with a text that says what is wrong and where.
[[nodiscard]] Record read_records(std::span<const std::byte> file);

/// Whether the document's section, or the object in its section `Objects`, is one that animates.
[[nodiscard]] bool is_needed(std::string_view section, std::string_view object);

[[nodiscard]] Record read_binary_records(std::span<const std::byte> file);
[[nodiscard]] Record read_text_records(std::string_view file);

}  // namespace sunder::fbx
