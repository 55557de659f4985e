#include "io/internal/strict_json.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace sunder {
namespace {

using Json = StrictJson;

constexpr std::size_t kMaximumDepth = 32;  ///< An operation log needs 9.
/// Bytes of the tree. A log of the largest size takes a third of it; of empty objects, thrice it.
constexpr std::size_t kMaximumTree = std::size_t{768} << 20;

/// Builds the tree from the parser's events, and refuses what is not visible in the tree: nesting
/// and repeated fields; and a tree that takes many times the memory of the text. The parser's own
/// builders take quadratic time: with a callback, they search the enclosing array at the end of
/// each object, and without one, they search an object for each of its fields.
class TreeBuilder : public Json::json_sax_t {
 public:
  explicit TreeBuilder(std::string_view text) : text_(text) {}

  [[nodiscard]] const Status& fault() const { return fault_; }
  [[nodiscard]] Json& tree() { return tree_; }

  bool null() override { return add(nullptr) != nullptr; }
  bool boolean(bool value) override { return add(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return add(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return add(value) != nullptr; }
  bool number_float(number_float_t value, const string_t& /*text*/) override {
    return add(value) != nullptr;
  }
  bool string(string_t& value) override {
    memory_ += kBlock + value.size();
    return add(std::move(value)) != nullptr;
  }
  bool binary(binary_t& /*value*/) override { return false; }  // not in a text
  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (is_too_deep()) return false;
    Open& object = open_.back();
    if (is_repeated(name, object)) {
      fault_ = Status::failure(StatusCode::malformed_file, kNone,
                               "field '%s' occurs twice in one object", name.c_str());
      return false;
    }
    memory_ += kBlock + name.size();
    fields_of(object).emplace_back(std::move(name), Json());
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    const std::size_t offset = std::min(position == 0 ? 0 : position - 1, text_.size());
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
    fault_ = Status::failure(StatusCode::malformed_file, kNone,
                             "invalid JSON: line %td, byte %zu: %s", line, offset, error.what());
    return false;
  }

 private:
  /// An array or object whose end was not read yet.
  struct Open {
    Json* value = nullptr;
    std::set<std::string> names;  ///< Of its fields; empty while there are few.
  };

  /// What an allocation of its own takes: that of a string, an array or an object.
  static constexpr std::size_t kBlock = 64;

  static Json::object_t& fields_of(const Open& object) {
    return object.value->get_ref<Json::object_t&>();
  }

  /// Adds the name, if it is not there yet.
  static bool is_repeated(const std::string& name, Open& object) {
    constexpr std::size_t kFew = 12;  // fewer are compared with each other, without an allocation
    const Json::object_t& fields = fields_of(object);
    if (fields.size() < kFew)
      return std::any_of(fields.begin(), fields.end(),
                         [&](const auto& field) { return field.first == name; });
    if (object.names.empty())
      for (const auto& field : fields) object.names.insert(field.first);
    return !object.names.insert(name).second;
  }

  bool is_too_deep() {
    if (open_.size() <= kMaximumDepth) return false;
    fault_ = Status::failure(StatusCode::limit_exceeded, kNone, "values are nested deeper than %zu",
                             kMaximumDepth);
    return true;
  }

  bool is_too_large() {
    if (memory_ <= kMaximumTree) return false;
    fault_ = Status::failure(StatusCode::limit_exceeded, kNone,
                             "the values of the JSON take more than %zu bytes", kMaximumTree);
    return true;
  }

  /// @return where it was put; null if it is nested too deeply, or beyond the memory.
  Json* add(Json value) {
    memory_ += sizeof(Json);
    if (is_too_deep() || is_too_large()) return nullptr;
    if (open_.empty()) {
      tree_ = std::move(value);
      return &tree_;
    }
    Json& parent = *open_.back().value;
    if (parent.is_array()) {
      auto& list = parent.get_ref<Json::array_t&>();
      list.push_back(std::move(value));
      return &list.back();
    }
    Json& field = fields_of(open_.back()).back().second;
    field = std::move(value);
    return &field;
  }

  /// The address stays valid until the end of the value: nothing is added to its parent before.
  bool open(Json value) {
    memory_ += kBlock;
    Json* const added = add(std::move(value));
    if (added == nullptr) return false;
    open_.push_back({added, {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  Json tree_;
  std::vector<Open> open_;  ///< Outermost first.
  std::size_t memory_ = 0;  ///< Of the tree, about.
  Status fault_;
};

}  // namespace

Result<StrictJson> parse_strict_json(std::string_view text) {
  if (text.size() > kMaximumJsonBytes)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "a JSON text of %zu bytes; the limit is %zu", text.size(),
                           kMaximumJsonBytes);
  TreeBuilder builder(text);
  if (!Json::sax_parse(text, &builder)) return builder.fault();
  return std::move(builder.tree());
}

}  // namespace sunder
