#include "io/gltf_decoders/parse_json.h"

#include <algorithm>
#include <cstdint>
#include <simdjson.h>
#include <string>
#include <utility>
#include <vector>

namespace sunder::gltf {
namespace {

namespace dom = simdjson::dom;

bool repeats_name(const Json::object_t& members) {
  constexpr std::size_t kFew = 12;  // fewer are compared with each other, without an allocation
  if (members.size() < kFew) {
    for (auto one = members.begin(); one != members.end(); ++one)
      for (auto other = members.begin(); other != one; ++other)
        if (one->first == other->first) return true;
    return false;
  }
  std::vector<std::string_view> names;
  names.reserve(members.size());
  for (const auto& member : members) names.push_back(member.first);
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) != names.end();
}

/// Copies simdjson's values, whose nesting the parser has limited, to those of nlohmann.
class Copier {
 public:
  Copier(const JsonLimits& limits, std::uint64_t text_bytes)
      : limits_(limits), memory_(text_bytes) {}

  /// Whether a limit was exceeded, or an object names a member twice. The copy is not complete
  /// then.
  [[nodiscard]] bool gave_up() const { return gave_up_; }

  Json copy(const dom::element& element, std::size_t level = 0) {
    switch (element.type()) {
      case dom::element_type::ARRAY: return copy_array(dom::array(element), level + 1);
      case dom::element_type::OBJECT: return copy_object(dom::object(element), level + 1);
      case dom::element_type::STRING: return std::string(std::string_view(element));
      case dom::element_type::DOUBLE: return double(element);
      case dom::element_type::UINT64: return std::uint64_t(element);
      case dom::element_type::INT64: return copy_integer(std::int64_t(element));
      case dom::element_type::BOOL: return bool(element);
      case dom::element_type::NULL_VALUE: break;
    }
    return nullptr;
  }

 private:
  /// As nlohmann's parser: signed if and only if it is negative.
  static Json copy_integer(std::int64_t number) {
    return number < 0 ? Json(number) : Json(static_cast<std::uint64_t>(number));
  }

  /// Adds the memory of an array or object. @return whether the limit allows it.
  bool charge(std::uint64_t size) {
    constexpr std::uint64_t kOfContainer = 80, kOfComma = 32;
    memory_ += kOfContainer + kOfComma * (size > 0 ? size - 1 : 0);
    return memory_ <= limits_.memory;
  }

  Json give_up() {
    gave_up_ = true;
    return nullptr;
  }

  Json copy_array(const dom::array& array, std::size_t level) {
    if (level > limits_.levels || !charge(array.size())) return give_up();
    Json::array_t copies;
    copies.reserve(array.size());
    for (const dom::element element : array) copies.push_back(copy(element, level));
    return copies;
  }

  Json copy_object(const dom::object& object, std::size_t level) {
    if (level > limits_.levels || !charge(object.size())) return give_up();
    Json::object_t members;
    members.reserve(object.size());
    for (const auto& [name, value] : object)
      members.emplace_back(std::string(name), copy(value, level));
    gave_up_ |= members.size() > limits_.members || repeats_name(members);
    return members;
  }

  JsonLimits limits_;
  std::uint64_t memory_;
  bool gave_up_ = false;
};

}  // namespace

std::optional<Json> parse_json_fast(std::string_view text, const JsonLimits& limits) {
  dom::parser parser;
  // The parser counts the document as a level, and leaves out empty arrays; the copier is exact.
  if (parser.allocate(text.size(), limits.levels + 1) != simdjson::SUCCESS) return std::nullopt;
  dom::element document;
  if (parser.parse(text.data(), text.size()).get(document) != simdjson::SUCCESS)
    return std::nullopt;
  Copier copier(limits, text.size());
  Json copy = copier.copy(document);
  if (copier.gave_up()) return std::nullopt;
  return copy;
}

}  // namespace sunder::gltf
