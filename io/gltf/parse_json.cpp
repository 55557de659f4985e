#include "io/gltf/parse_json.h"

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
  std::vector<std::string_view> names;
  names.reserve(members.size());
  for (const auto& member : members) names.push_back(member.first);
  std::sort(names.begin(), names.end());
  return std::adjacent_find(names.begin(), names.end()) != names.end();
}

/// Copies simdjson's values, whose nesting the parser has limited, to those of nlohmann.
class Copier {
 public:
  explicit Copier(std::size_t maximum_members) : maximum_members_(maximum_members) {}

  /// Whether an object has too many members, or names one twice.
  [[nodiscard]] bool found_unusual_object() const { return found_unusual_object_; }

  Json copy(const dom::element& element) {
    switch (element.type()) {
      case dom::element_type::ARRAY: return copy_array(dom::array(element));
      case dom::element_type::OBJECT: return copy_object(dom::object(element));
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

  Json copy_array(const dom::array& array) {
    Json::array_t copies;
    copies.reserve(array.size());
    for (const dom::element element : array) copies.push_back(copy(element));
    return copies;
  }

  Json copy_object(const dom::object& object) {
    Json::object_t members;
    members.reserve(object.size());
    for (const auto& [name, value] : object) members.emplace_back(std::string(name), copy(value));
    found_unusual_object_ |= members.size() > maximum_members_ || repeats_name(members);
    return members;
  }

  std::size_t maximum_members_;
  bool found_unusual_object_ = false;
};

}  // namespace

std::optional<Json> parse_json_fast(std::string_view text, const JsonLimits& limits) {
  dom::parser parser;
  // The parser counts the document as a level.
  if (parser.allocate(text.size(), limits.levels + 1) != simdjson::SUCCESS) return std::nullopt;
  dom::element document;
  if (parser.parse(text.data(), text.size()).get(document) != simdjson::SUCCESS)
    return std::nullopt;
  Copier copier(limits.members);
  Json copy = copier.copy(document);
  if (copier.found_unusual_object()) return std::nullopt;
  return copy;
}

}  // namespace sunder::gltf
