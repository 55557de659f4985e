#include "io/gltf/parse_json.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace sunder::gltf {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether one of eight characters ends a plain string or does not belong in one: a quotation mark,
/// a backslash, a control character, or a byte beyond ASCII.
bool has_special(std::uint64_t eight) {
  constexpr std::uint64_t kOnes = 0x0101010101010101, kHighBits = 0x8080808080808080;
  // Without high bits in the input, a byte is zero if and only if subtracting one sets its high
  // bit.
  const auto zero_bytes = [](std::uint64_t bytes) { return (bytes - kOnes) & ~bytes & kHighBits; };
  const std::uint64_t below_space = (eight - kOnes * 0x20) & ~eight & kHighBits;
  return ((eight & kHighBits) | below_space | zero_bytes(eight ^ (kOnes * '"')) |
          zero_bytes(eight ^ (kOnes * '\\'))) != 0;
}

bool is_special(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte >= 0x80 || c == '"' || c == '\\';
}

/// Recursive descent. The values of all open arrays and objects are on one stack, so that each list
/// is allocated once, in its final size.
class FastParser {
 public:
  FastParser(std::string_view text, const JsonLimits& limits)
      : at_(text.data()), end_(text.data() + text.size()), limits_(limits), memory_(text.size()) {}

  std::optional<Json> parse() {
    if (!read_value(0)) return std::nullopt;
    skip_space();
    if (at_ != end_) return std::nullopt;
    return std::move(values_.back());
  }

 private:
  void skip_space() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }

  /// Skips a character if it is the next one after white space.
  bool skip(char expected) {
    skip_space();
    if (at_ == end_ || *at_ != expected) return false;
    ++at_;
    return true;
  }

  /// Appends a value to the stack.
  bool read_value(std::size_t level) {
    skip_space();
    if (at_ == end_) return false;
    switch (*at_) {
      case '{': return level < limits_.levels && read_object(level + 1);
      case '[': return level < limits_.levels && read_array(level + 1);
      case '"': return read_string_value();
      case 't': return read_literal("true", true);
      case 'f': return read_literal("false", false);
      case 'n': return read_literal("null", nullptr);
      default: return read_number();
    }
  }

  bool read_array(std::size_t level) {
    ++at_;
    const std::size_t first = values_.size();
    if (!skip(']')) {
      do {
        if (!read_value(level)) return false;
      } while (skip(','));
      if (!skip(']')) return false;
    }
    if (!charge(values_.size() - first)) return false;
    Json::array_t array;
    array.reserve(values_.size() - first);
    std::move(values_.begin() + static_cast<std::ptrdiff_t>(first), values_.end(),
              std::back_inserter(array));
    values_.resize(first);
    values_.emplace_back(std::move(array));
    return true;
  }

  bool read_object(std::size_t level) {
    ++at_;
    const std::size_t first = values_.size(), first_key = keys_.size();
    if (!skip('}')) {
      do {
        std::string key;
        skip_space();
        if (!read_string(key) || !skip(':')) return false;
        keys_.push_back(std::move(key));
        if (!read_value(level)) return false;
      } while (skip(','));
      if (!skip('}')) return false;
    }
    const std::size_t members = values_.size() - first;
    if (members > limits_.members || !charge(members) || repeats_key(first_key)) return false;
    Json::object_t object;
    object.reserve(values_.size() - first);
    for (std::size_t i = first; i < values_.size(); ++i)
      object.emplace_back(std::move(keys_[first_key + i - first]), std::move(values_[i]));
    keys_.resize(first_key);
    values_.resize(first);
    values_.emplace_back(std::move(object));
    return true;
  }

  /// Adds what an array or object of this size takes. @return whether the limit allows it.
  bool charge(std::size_t size) {
    constexpr std::uint64_t kOfContainer = 80, kOfComma = 32;
    memory_ += kOfContainer + kOfComma * (size > 0 ? size - 1 : 0);
    return memory_ <= limits_.memory;
  }

  [[nodiscard]] bool repeats_key(std::size_t first_key) const {
    constexpr std::size_t kFew = 12;
    const std::size_t count = keys_.size() - first_key;
    if (count <= kFew) {
      for (std::size_t i = first_key; i < keys_.size(); ++i)
        for (std::size_t j = first_key; j < i; ++j)
          if (keys_[i] == keys_[j]) return true;
      return false;
    }
    std::vector<std::string_view> sorted(keys_.begin() + static_cast<std::ptrdiff_t>(first_key),
                                         keys_.end());
    std::sort(sorted.begin(), sorted.end());
    return std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  }

  template <class Value>
  bool read_literal(std::string_view literal, Value value) {
    if (std::string_view(at_, static_cast<std::size_t>(end_ - at_)).substr(0, literal.size()) !=
        literal)
      return false;
    at_ += literal.size();
    values_.emplace_back(value);
    return true;
  }

  bool read_string_value() {
    std::string text;
    if (!read_string(text)) return false;
    values_.emplace_back(std::move(text));
    return true;
  }

  bool read_string(std::string& text) {
    if (at_ == end_ || *at_ != '"') return false;
    const char* const begin = at_ + 1;
    const char* stop = first_special(begin);
    if (stop != end_ && *stop == '"') {
      text.assign(begin, stop);
      at_ = stop + 1;
      return true;
    }
    for (; stop != end_ && *stop != '"'; ++stop)
      if (*stop == '\\' && ++stop == end_) return false;
    if (stop == end_) return false;
    const Json parsed = parse_token(stop + 1);
    if (!parsed.is_string()) return false;
    text = parsed.get_ref<const std::string&>();
    return true;
  }

  [[nodiscard]] const char* first_special(const char* from) const {
    for (; end_ - from >= 8; from += 8) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, from, sizeof eight);
      if (has_special(eight)) break;
    }
    while (from != end_ && !is_special(*from)) ++from;
    return from;
  }

  bool read_number() {
    const char* stop = at_;
    const bool is_negative = *stop == '-';
    if (is_negative) ++stop;
    const char* const digits = stop;
    std::uint64_t number = 0;
    for (; stop != end_ && is_digit(*stop); ++stop)
      number = 10 * number + static_cast<std::uint64_t>(*stop - '0');
    const std::ptrdiff_t digit_count = stop - digits;
    if (digit_count == 0 || (digit_count > 1 && *digits == '0')) return false;
    if (stop == end_ || (*stop != '.' && *stop != 'e' && *stop != 'E')) {
      constexpr std::ptrdiff_t kSurelyFit = 18;
      if (digit_count > kSurelyFit) return read_unusual_number(stop);
      if (is_negative)
        values_.emplace_back(-static_cast<std::int64_t>(number));
      else
        values_.emplace_back(number);
      at_ = stop;
      return true;
    }
    return skip_fraction(stop) && read_float(stop);
  }

  /// Moves `stop` from the end of an integer to that of a fraction and an exponent.
  bool skip_fraction(const char*& stop) const {
    const auto skip_digits = [&] {
      const char* const first = stop;
      while (stop != end_ && is_digit(*stop)) ++stop;
      return stop != first;
    };
    if (*stop == '.' && (++stop, !skip_digits())) return false;
    if (stop == end_ || (*stop != 'e' && *stop != 'E')) return true;
    if (++stop != end_ && (*stop == '+' || *stop == '-')) ++stop;
    return skip_digits();
  }

  bool read_float(const char* stop) {
    double number = 0;
    const auto [used, error] = std::from_chars(at_, stop, number);
    if (error != std::errc() || used != stop) return read_unusual_number(stop);
    values_.emplace_back(number);
    at_ = stop;
    return true;
  }

  bool read_unusual_number(const char* stop) {
    Json parsed = parse_token(stop);
    if (!parsed.is_number()) return false;
    values_.push_back(std::move(parsed));
    return true;
  }

  /// The value from here to `stop`, by nlohmann's parser.
  Json parse_token(const char* stop) {
    const char* const begin = std::exchange(at_, stop);
    return Json::parse(begin, stop, nullptr, false);
  }

  const char* at_;
  const char* end_;
  JsonLimits limits_;
  std::uint64_t memory_ = 0;
  std::vector<Json> values_;
  std::vector<std::string> keys_;
};

}  // namespace

std::optional<Json> parse_json_fast(std::string_view text, const JsonLimits& limits) {
  return FastParser(text, limits).parse();
}

}  // namespace sunder::gltf
