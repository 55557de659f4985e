#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace sunder::gltf {

using Json = nlohmann::ordered_json;

/// A place in the document that knows its JSON pointer. Every access checks presence, type and
/// range, and refuses the file with the place in the text ("/accessors/4/bufferView: …").
class Cursor {
 public:
  Cursor(const Json& value, std::string pointer) : value_(&value), pointer_(std::move(pointer)) {}

  [[nodiscard]] const Json& json() const { return *value_; }
  [[nodiscard]] const std::string& pointer() const { return pointer_; }

  /// A member of an object, if it is there.
  [[nodiscard]] std::optional<Cursor> find(const char* key) const;
  [[nodiscard]] Cursor member(const char* key) const;
  /// Elements of an array.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Cursor element(std::size_t index) const;

  /// A whole number in [0, 2^53]; "4.0" is one.
  [[nodiscard]] std::uint64_t to_unsigned() const;
  /// An index into a list of `count` things, whose kind `what` names in the refusal.
  [[nodiscard]] std::uint32_t to_index(std::size_t count, const char* what) const;
  /// Finite as a float.
  [[nodiscard]] float to_float() const;
  [[nodiscard]] bool to_bool() const;
  [[nodiscard]] const std::string& to_string() const;

  // Optional members with their default.
  [[nodiscard]] std::uint64_t unsigned_or(const char* key, std::uint64_t otherwise) const;
  [[nodiscard]] bool bool_or(const char* key, bool otherwise) const;
  [[nodiscard]] std::string name()
      const;  ///< Member "name"; empty where it is absent or not a string.

 private:
  const Json* value_;
  std::string pointer_;
};

/// Length of a top-level list ("nodes"); 0 where it is absent.
[[nodiscard]] std::size_t count_of(const Json& document, const char* list);
/// One entry of a top-level list. `index` < count_of().
[[nodiscard]] Cursor entry(const Json& document, const char* list, std::size_t index);

}  // namespace sunder::gltf
