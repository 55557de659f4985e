#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace sunder::gltf {

using Json = nlohmann::ordered_json;

/// A value of the document that knows its JSON pointer. Every access checks presence, type and
/// range; the error text names the place ("/accessors/4/bufferView: …").
class Cursor {
 public:
  Cursor(const Json& value, std::string pointer) : base_(std::move(pointer)), path_{&value} {}

  [[nodiscard]] const Json& json() const { return *path_[depth_]; }
  [[nodiscard]] std::string pointer() const;

  /// A member of an object, or nothing.
  [[nodiscard]] std::optional<Cursor> find(const char* key) const;
  [[nodiscard]] Cursor member(const char* key) const;
  /// Number of elements of an array.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Cursor element(std::size_t index) const;
  /// The same as member(key).to_unsigned().
  [[nodiscard]] std::uint64_t unsigned_of(const char* key) const;

  /// A whole number in [0, 2^53]; 4.0 is accepted.
  [[nodiscard]] std::uint64_t to_unsigned() const;
  /// An index into a list of `count` elements; `what` is their kind, for the error text.
  [[nodiscard]] std::uint32_t to_index(std::size_t count, const char* what) const;
  /// A number that is finite as a float.
  [[nodiscard]] float to_float() const;
  [[nodiscard]] bool to_bool() const;
  [[nodiscard]] const std::string& to_string() const;

  // Optional members with a default.
  [[nodiscard]] std::uint64_t unsigned_or(const char* key, std::uint64_t otherwise) const;
  [[nodiscard]] bool bool_or(const char* key, bool otherwise) const;
  [[nodiscard]] std::string name()
      const;  ///< Member "name" without NULs; empty if it is absent or not a string.

 private:
  [[nodiscard]] const Json* find_member(const char* key) const;
  [[nodiscard]] Cursor child(const Json& value) const;

  // The pointer is put together only if it is asked for, which is for faults: from its start, and
  // the values on the way from there to this one.
  std::string base_;
  std::array<const Json*, 8> path_;
  std::size_t depth_ = 0;  ///< Of this value in `path_`.
};

/// Length of a top-level list ("nodes"); 0 if it is absent.
[[nodiscard]] std::size_t count_of(const Json& document, const char* list);
/// One entry of a top-level list. `index` < count_of().
[[nodiscard]] Cursor entry(const Json& document, const char* list, std::size_t index);

}  // namespace sunder::gltf
