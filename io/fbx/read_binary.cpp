#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <zlib.h>

#include "io/fbx/record.h"

namespace sunder::fbx {
namespace {

constexpr std::size_t kVersionPlace = 23;
constexpr std::uint32_t kFirstWide = 7500;  ///< Versions from here on have places of 64 bits.
constexpr int kMaximumBinaryDepth = 64;
/// Deflate does not compress better than this.
constexpr std::size_t kMostCompression = 1032;

class BinaryReader {
 public:
  explicit BinaryReader(std::span<const std::byte> file) : file_(file), at_(kVersionPlace) {
    is_wide_ = number<std::uint32_t>() >= kFirstWide;
  }

  Record read() {
    Record document;
    for (Head head; read_head(head);) {
      if (is_needed(head.name, "")) {
        document.children.push_back(read_body(head, 1, head.name == "Objects"));
      }
      at_ = head.end;
    }
    return document;
  }

 private:
  struct Head {
    std::size_t end = 0, value_count = 0;
    std::string name;
  };

  [[noreturn]] void fail(const char* what) const {
    throw std::runtime_error(std::string(what) + " at byte " + std::to_string(at_));
  }

  std::span<const std::byte> bytes(std::size_t count) {
    if (count > file_.size() - at_) fail("an FBX record that ends beyond the file");
    at_ += count;
    return file_.subspan(at_ - count, count);
  }

  template <class T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }

  std::size_t place() {
    return is_wide_ ? static_cast<std::size_t>(number<std::uint64_t>()) : number<std::uint32_t>();
  }

  std::string text(std::size_t count) {
    const auto found = bytes(count);
    return {reinterpret_cast<const char*>(found.data()), found.size()};
  }

  /// @return whether a record follows; a record without an end closes its parent.
  bool read_head(Head& head) {
    if (at_ >= file_.size()) return false;
    head.end = place();
    head.value_count = place();
    place();  // Bytes of the values.
    head.name = text(number<std::uint8_t>());
    if (head.end == 0) return false;
    if (head.end < at_ || head.end > file_.size()) fail("an FBX record with an impossible end");
    return true;
  }

  Record read_body(const Head& head, int depth, bool is_objects = false) {
    if (depth > kMaximumBinaryDepth) fail("FBX records nested too deep");
    Record record;
    record.name = head.name;
    for (std::size_t i = 0; i < head.value_count; ++i) record.values.push_back(read_value());
    while (at_ < head.end) {
      Head inner;
      if (!read_head(inner)) break;
      if (inner.end > head.end) fail("an FBX record that ends after its parent");
      if (!is_objects || is_needed("Objects", inner.name))
        record.children.push_back(read_body(inner, depth + 1));
      at_ = inner.end;
    }
    return record;
  }

  Value read_value() {
    switch (static_cast<char>(number<std::uint8_t>())) {
      case 'Y': return scalar<std::int16_t>();
      case 'C': return scalar<std::uint8_t>();
      case 'I': return scalar<std::int32_t>();
      case 'L': return scalar<std::int64_t>();
      case 'F': return scalar<float>();
      case 'D': return scalar<double>();
      case 'f': return array<float>();
      case 'd': return array<double>();
      case 'l': return array<std::int64_t>();
      case 'i': return array<std::int32_t>();
      case 'b': return array<std::uint8_t>();
      case 'S':
      case 'R': return {.text = text(number<std::uint32_t>()), .integer = 0, .numbers = {}};
      default: fail("an FBX value of an unknown type");
    }
  }

  template <class T>
  Value scalar() {
    const T value = number<T>();
    Value result;
    result.numbers = {static_cast<double>(value)};
    if constexpr (std::numeric_limits<T>::is_integer) result.integer = value;
    return result;
  }

  template <class T>
  Value array() {
    const std::size_t count = number<std::uint32_t>();
    const bool is_compressed = number<std::uint32_t>() != 0;
    const std::size_t stored = number<std::uint32_t>();
    std::vector<T> values;
    if (is_compressed) {
      const auto packed = bytes(stored);
      if (count > packed.size() * kMostCompression / sizeof(T))
        fail("an FBX array that claims more numbers than its bytes can hold");
      values.resize(count);
      uLongf length = static_cast<uLongf>(count * sizeof(T));
      if (uncompress(reinterpret_cast<Bytef*>(values.data()), &length,
                     reinterpret_cast<const Bytef*>(packed.data()),
                     static_cast<uLong>(packed.size())) != Z_OK ||
          length != count * sizeof(T))
        fail("an FBX array that cannot be decompressed");
    } else {
      const auto plain = bytes(count * sizeof(T));
      values.resize(count);
      if (count > 0) std::memcpy(values.data(), plain.data(), plain.size());
    }
    Value result;
    result.numbers.assign(values.begin(), values.end());
    return result;
  }

  std::span<const std::byte> file_;
  std::size_t at_;
  bool is_wide_ = false;
};

}  // namespace

Record read_binary_records(std::span<const std::byte> file) { return BinaryReader(file).read(); }

}  // namespace sunder::fbx
