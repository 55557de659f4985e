#include "io/gltf/cursor.h"

#include <cmath>
#include <string_view>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::uint64_t kLargestUnsigned = std::uint64_t{1} << 53;

[[noreturn]] void refuse_type(const Cursor& at, const char* expected) {
  refuse(StatusCode::malformed_file, kNone, "%.120s: expected %s, found %s", at.pointer().c_str(),
         expected, at.json().type_name());
}

/// "/key" or "/index" of a value in the object or array that it is in.
std::string step_between(const Json& parent, const Json& value) {
  if (parent.is_array())
    return "/" + std::to_string(&value - parent.get_ref<const Json::array_t&>().data());
  for (const auto& member : parent.get_ref<const Json::object_t&>())
    if (&member.second == &value) return "/" + member.first;
  return "/";
}

/// In C a text ends at a NUL: different names would be equal there, or empty. U+FFFD replaces each.
std::string without_nuls(const std::string& text) {
  if (text.find('\0') == std::string::npos) return text;
  std::string result;
  for (const char letter : text)
    if (letter == '\0')
      result += "\xEF\xBF\xBD";
    else
      result += letter;
  return result;
}

/// The value as an index or a size, if it is one beyond doubt.
std::optional<std::uint64_t> plain_unsigned(const Json* value) {
  if (value == nullptr || !value->is_number_unsigned()) return std::nullopt;
  const std::uint64_t number = value->get<std::uint64_t>();
  if (number > kLargestUnsigned) return std::nullopt;
  return number;
}

}  // namespace

std::string Cursor::pointer() const {
  std::string pointer = base_;
  for (std::size_t i = 0; i < depth_; ++i) pointer += step_between(*path_[i], *path_[i + 1]);
  return pointer;
}

Cursor Cursor::child(const Json& value) const {
  if (depth_ + 1 == path_.size()) return Cursor(json(), pointer()).child(value);
  Cursor child(*this);
  child.path_[++child.depth_] = &value;
  return child;
}

const Json* Cursor::find_member(const char* key) const {
  if (!json().is_object()) refuse_type(*this, "an object");
  const std::string_view wanted = key;
  for (const auto& [name, value] : json().get_ref<const Json::object_t&>())
    if (name == wanted) return &value;
  return nullptr;
}

std::optional<Cursor> Cursor::find(const char* key) const {
  const Json* const found = find_member(key);
  if (found == nullptr) return std::nullopt;
  return child(*found);
}

Cursor Cursor::member(const char* key) const {
  if (const Json* const found = find_member(key)) return child(*found);
  refuse(StatusCode::malformed_file, kNone, "%.120s: '%s' is missing", pointer().c_str(), key);
}

std::size_t Cursor::size() const {
  if (!json().is_array()) refuse_type(*this, "an array");
  return json().size();
}

Cursor Cursor::element(std::size_t index) const {
  if (index >= size())
    refuse(StatusCode::index_out_of_range, static_cast<std::uint32_t>(index),
           "%.120s: element %zu does not exist; there are %zu", pointer().c_str(), index, size());
  return child(json()[index]);
}

std::uint64_t Cursor::to_unsigned() const {
  if (const auto number = plain_unsigned(&json())) return *number;
  if (!json().is_number()) refuse_type(*this, "a whole number");
  const double number = json().get<double>();
  if (!(number >= 0.0 && number <= static_cast<double>(kLargestUnsigned)) ||
      number != std::floor(number))
    refuse(StatusCode::malformed_file, kNone, "%.120s: expected a whole number >= 0, found %g",
           pointer().c_str(), number);
  return static_cast<std::uint64_t>(number);
}

std::uint32_t Cursor::to_index(std::size_t count, const char* what) const {
  const std::uint64_t index = to_unsigned();
  if (index >= count)
    refuse(StatusCode::index_out_of_range, static_cast<std::uint32_t>(index),
           "%.120s: %s %llu does not exist; the file has %zu", pointer().c_str(), what,
           static_cast<unsigned long long>(index), count);
  return static_cast<std::uint32_t>(index);
}

float Cursor::to_float() const {
  if (!json().is_number()) refuse_type(*this, "a number");
  const auto number = static_cast<float>(json().get<double>());
  if (!std::isfinite(number))
    refuse(StatusCode::non_finite_value, kNone, "%.120s: number too large for a float",
           pointer().c_str());
  return number;
}

bool Cursor::to_bool() const {
  if (!json().is_boolean()) refuse_type(*this, "true or false");
  return json().get<bool>();
}

const std::string& Cursor::to_string() const {
  if (!json().is_string()) refuse_type(*this, "a string");
  return json().get_ref<const std::string&>();
}

std::uint64_t Cursor::unsigned_of(const char* key) const {
  if (const auto number = plain_unsigned(find_member(key))) return *number;
  return member(key).to_unsigned();
}

std::uint64_t Cursor::unsigned_or(const char* key, std::uint64_t otherwise) const {
  const Json* const found = find_member(key);
  return found == nullptr ? otherwise : child(*found).to_unsigned();
}

bool Cursor::bool_or(const char* key, bool otherwise) const {
  const Json* const found = find_member(key);
  return found == nullptr ? otherwise : child(*found).to_bool();
}

std::string Cursor::name() const {
  const Json* const found = find_member("name");
  if (found == nullptr || !found->is_string()) return {};
  return without_nuls(found->get_ref<const std::string&>());
}

std::size_t count_of(const Json& document, const char* list) {
  const auto found = Cursor(document, "").find(list);
  return found ? found->size() : 0;
}

Cursor entry(const Json& document, const char* list, std::size_t index) {
  return Cursor(document, "").member(list).element(index);
}

}  // namespace sunder::gltf
