#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace sunder {

/// The cause of a failure; one enumerator per cause that a caller may want to handle differently.
enum class StatusCode : std::uint8_t {
  ok,
  empty_input,             ///< Nothing to work on: no mesh, no stroke, no file content.
  size_mismatch,           ///< Two arrays that must agree in length do not.
  index_out_of_range,      ///< A bone, vertex, accessor … index beyond its array.
  non_finite_value,        ///< NaN or infinity.
  weights_not_normalized,  ///< Negative weights, or a sum that is not one.
  not_a_tree,              ///< A cycle, or a node with two parents.
  invalid_argument,        ///< An option, name or stroke is outside its documented range.
  not_found,               ///< No clip, bone or mesh has that name.
  file_not_found,
  file_unreadable,      ///< Exists but cannot be read or written.
  path_not_allowed,     ///< A file refers to something outside its own folder.
  unsupported_format,   ///< This build does not read the format, or this version of it.
  unsupported_feature,  ///< The format is supported; a part of it that the file uses is not.
  malformed_file,       ///< The content contradicts its own format.
  limit_exceeded,       ///< A limit on size, depth, memory or time is exceeded.
  capacity_exceeded,    ///< A buffer of fixed capacity is full; nothing was changed.
  internal_error,       ///< A bug in Sunder or in a library that it uses.
};

/// The enumerator's name as text, for logs and JSON ("index_out_of_range").
[[nodiscard]] SUNDER_API std::string_view status_name(StatusCode code);

/// Outcome of a call: success, or a cause with an index and a text. Fixed size; never allocates.
class [[nodiscard]] SUNDER_API Status {
 public:
  Status() = default;

  /// @param index   first offending element of the array that the text names, or kNone.
  /// @param format  printf format of the text: what was expected and what was found. Texts are cut
  ///                at 255 bytes.
  SUNDER_PRINTF(3, 4)
  static Status failure(StatusCode code, std::uint32_t index, const char* format, ...);

  [[nodiscard]] bool is_ok() const { return code_ == StatusCode::ok; }
  explicit operator bool() const { return is_ok(); }
  [[nodiscard]] StatusCode code() const { return code_; }
  [[nodiscard]] std::uint32_t index() const { return index_; }
  [[nodiscard]] std::string_view text() const { return text_; }

 private:
  StatusCode code_ = StatusCode::ok;
  std::uint32_t index_ = kNone;
  char text_[256] = {};
};

/// A value, or the Status that says why there is none. Members are named as in std::expected.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(Status error) : error_(error) {}        // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const { return value_.has_value(); }
  explicit operator bool() const { return has_value(); }
  /// Precondition: has_value().
  [[nodiscard]] T& value() { return **this; }
  [[nodiscard]] const T& value() const { return **this; }
  T& operator*() & {
    SUNDER_ASSERT(has_value());
    return *value_;
  }
  const T& operator*() const& {
    SUNDER_ASSERT(has_value());
    return *value_;
  }
  /// Moves out of a result that is not kept, so that nothing refers to it: `for (x : *call())`.
  T operator*() && {
    SUNDER_ASSERT(has_value());
    return std::move(*value_);
  }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  /// The failure; ok if has_value().
  [[nodiscard]] const Status& error() const { return error_; }

 private:
  std::optional<T> value_;
  Status error_;
};

}  // namespace sunder
