#include "io/gltf/cursor.h"

#include <cmath>
#include <string_view>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

[[noreturn]] void refuse_type(const Cursor& at, const char* expected) {
  refuse(StatusCode::malformed_file, kNone, "%.120s: expected %s, found %s", at.pointer().c_str(),
         expected, at.json().type_name());
}

}  // namespace

std::string Cursor::pointer() const {
  std::string pointer = base_;
  for (std::size_t i = 0; i < step_count_; ++i) {
    const Step& step = steps_[i];
    pointer.append("/").append(step.key != nullptr ? *step.key : std::to_string(step.index));
  }
  return pointer;
}

Cursor Cursor::child(const Json& value, const Step& step) const {
  if (step_count_ == steps_.size()) return Cursor(value, pointer()).child(value, step);
  Cursor child(*this);
  child.value_ = &value;
  child.steps_[child.step_count_++] = step;
  return child;
}

const Json::object_t::value_type* Cursor::find_member(const char* key) const {
  if (!value_->is_object()) refuse_type(*this, "an object");
  const std::string_view wanted = key;
  for (const auto& member : value_->get_ref<const Json::object_t&>())
    if (member.first == wanted) return &member;
  return nullptr;
}

std::optional<Cursor> Cursor::find(const char* key) const {
  const auto* const found = find_member(key);
  if (found == nullptr) return std::nullopt;
  return child(found->second, {&found->first, 0});
}

Cursor Cursor::member(const char* key) const {
  if (const auto* const found = find_member(key)) return child(found->second, {&found->first, 0});
  refuse(StatusCode::malformed_file, kNone, "%.120s: '%s' is missing", pointer().c_str(), key);
}

std::size_t Cursor::size() const {
  if (!value_->is_array()) refuse_type(*this, "an array");
  return value_->size();
}

Cursor Cursor::element(std::size_t index) const {
  if (index >= size())
    refuse(StatusCode::index_out_of_range, static_cast<std::uint32_t>(index),
           "%.120s: element %zu does not exist; there are %zu", pointer().c_str(), index, size());
  return child((*value_)[index], {nullptr, index});
}

std::uint64_t Cursor::to_unsigned() const {
  constexpr double kLargest = 9007199254740992.0;
  if (!value_->is_number()) refuse_type(*this, "a whole number");
  const double number = value_->get<double>();
  if (!(number >= 0.0 && number <= kLargest) || number != std::floor(number))
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
  if (!value_->is_number()) refuse_type(*this, "a number");
  const auto number = static_cast<float>(value_->get<double>());
  if (!std::isfinite(number))
    refuse(StatusCode::non_finite_value, kNone, "%.120s: number too large for a float",
           pointer().c_str());
  return number;
}

bool Cursor::to_bool() const {
  if (!value_->is_boolean()) refuse_type(*this, "true or false");
  return value_->get<bool>();
}

const std::string& Cursor::to_string() const {
  if (!value_->is_string()) refuse_type(*this, "a string");
  return value_->get_ref<const std::string&>();
}

std::uint64_t Cursor::unsigned_or(const char* key, std::uint64_t otherwise) const {
  return find_member(key) != nullptr ? member(key).to_unsigned() : otherwise;
}

bool Cursor::bool_or(const char* key, bool otherwise) const {
  return find_member(key) != nullptr ? member(key).to_bool() : otherwise;
}

std::string Cursor::name() const {
  const auto* const found = find_member("name");
  return found != nullptr && found->second.is_string() ? found->second.get_ref<const std::string&>()
                                                       : std::string();
}

std::size_t count_of(const Json& document, const char* list) {
  const auto found = Cursor(document, "").find(list);
  return found ? found->size() : 0;
}

Cursor entry(const Json& document, const char* list, std::size_t index) {
  return Cursor(document, "").member(list).element(index);
}

}  // namespace sunder::gltf
