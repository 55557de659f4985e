#pragma once

#include <sunder/core/math.h>

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

namespace sunder::scene {

class PoseMemory;

/// The greatest enumerator of an enumeration that snapshots hold.
template <class Enum>
inline constexpr Enum kLastEnumerator{};

/// A struct whose members transfer(archive, value) lists.
template <class Archive, class T>
concept Listed = requires(Archive& archive, T& value) {
  transfer(archive, value);
};

/// Whether numbers of a type are in memory as in a snapshot, so that lists of them are copied.
template <class T>
inline constexpr bool kIsStoredAsBytes = (std::is_integral_v<T> ||
                                          std::is_floating_point_v<T>)&&!std::is_same_v<T, bool> &&
                                         std::endian::native == std::endian::little;

/// Writes values as little-endian bytes. Members of structs are listed once, by transfer(), for
/// writing and reading.
class SnapshotWriter {
 public:
  static constexpr bool kReads = false;
  /// For poses of operations; not owned.
  PoseMemory* poses = nullptr;

  template <class... Values>
  void operator()(Values&... values) {
    (write(values), ...);
  }
  [[nodiscard]] std::vector<std::byte>& bytes() { return bytes_; }

  void write_bytes(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<std::byte>(value >> (8 * i)));
  }

 private:
  template <std::integral T>
  void write(const T& value) {
    write_bytes(static_cast<std::uint64_t>(value), sizeof(T));
  }
  void write(const float& value) { write_bytes(std::bit_cast<std::uint32_t>(value), 4); }
  void write(const double& value) { write_bytes(std::bit_cast<std::uint64_t>(value), 8); }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void write(const Enum& value) { write_bytes(static_cast<std::uint64_t>(value), 1); }
  template <class Scalar, int N, int M, int Options>
  void write(const Eigen::Matrix<Scalar, N, M, Options>& matrix) {
    for (int i = 0; i < N * M; ++i) write(matrix.data()[i]);
  }
  template <class Scalar, int Options>
  void write(const Eigen::Quaternion<Scalar, Options>& turn) {
    for (int i = 0; i < 4; ++i) write(turn.coeffs()[i]);
  }
  void write(std::string& text) {
    auto size = static_cast<std::uint32_t>(text.size());
    write(size);
    for (const char c : text) write(c);
  }
  template <class T>
  void write(std::vector<T>& values) {
    auto size = static_cast<std::uint32_t>(values.size());
    write(size);
    if constexpr (kIsStoredAsBytes<T>) {
      const auto* const stored = reinterpret_cast<const std::byte*>(values.data());
      bytes_.insert(bytes_.end(), stored, stored + values.size() * sizeof(T));
      return;
    }
    for (T& value : values) write(value);
  }
  template <class T, std::size_t N>
  void write(std::array<T, N>& values) {
    for (T& value : values) write(value);
  }
  template <class T>
  void write(std::optional<T>& value) {
    write(static_cast<std::uint8_t>(value.has_value()));
    if (value) write(*value);
  }
  template <class... Kinds>
  void write(std::variant<Kinds...>& value) {
    write(static_cast<std::uint8_t>(value.index()));
    std::visit([this](auto& of) { this->write(of); }, value);
  }
  template <class T>
  requires Listed<SnapshotWriter, T>
  void write(T& value) { transfer(*this, value); }

  std::vector<std::byte> bytes_;
};

/// Reads what SnapshotWriter wrote. Bytes are not trusted: after a fault nothing is read any more,
/// values stay as they are, and has_failed() says so.
class SnapshotReader {
 public:
  static constexpr bool kReads = true;
  PoseMemory* poses = nullptr;  ///< As that of the writer.

  explicit SnapshotReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// Limits the memory of what is read from now on.
  void limit_memory(std::size_t bytes) { memory_ = bytes; }
  /// Counts memory of what is read. A fault if there is not so much left.
  void take_memory(std::size_t bytes) {
    if (has_failed()) return;
    is_too_large_ = bytes > memory_;
    if (is_too_large_)
      fail("it needs too much memory");
    else
      memory_ -= bytes;
  }
  /// Whether the fault is that of take_memory().
  [[nodiscard]] bool is_too_large() const { return is_too_large_; }

  template <class... Values>
  void operator()(Values&... values) {
    (read(values), ...);
  }
  [[nodiscard]] bool has_failed() const { return fault_ != nullptr; }
  /// The first fault, for a text: "it ends early", …
  [[nodiscard]] const char* fault() const { return fault_; }
  /// Where it was found, or how far was read.
  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - offset_; }
  void fail(const char* fault) {
    if (fault_ == nullptr) fault_ = fault;
  }

  /// @return 0 after a fault.
  std::uint64_t read_bytes(int count) {
    if (remaining() < static_cast<std::size_t>(count)) fail("it ends early");
    if (has_failed()) return 0;
    std::uint64_t value = 0;
    for (int i = 0; i < count; ++i)
      value |= std::to_integer<std::uint64_t>(bytes_[offset_ + static_cast<std::size_t>(i)])
               << (8 * i);
    offset_ += static_cast<std::size_t>(count);
    return value;
  }

 private:
  template <std::integral T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      const std::uint64_t bits = read_bytes(1);
      if (bits > 1) fail("a flag is neither 0 nor 1");
      value = bits == 1;
    } else {
      value = static_cast<T>(read_bytes(sizeof(T)));
    }
  }
  void read(float& value) {
    value = std::bit_cast<float>(static_cast<std::uint32_t>(read_bytes(4)));
  }
  void read(double& value) { value = std::bit_cast<double>(read_bytes(8)); }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void read(Enum& value) {
    const std::uint64_t bits = read_bytes(1);
    if (bits > static_cast<std::uint64_t>(kLastEnumerator<Enum>)) return fail("a kind is unknown");
    value = static_cast<Enum>(bits);
  }
  template <class Scalar, int N, int M, int Options>
  void read(Eigen::Matrix<Scalar, N, M, Options>& matrix) {
    for (int i = 0; i < N * M; ++i) read(matrix.data()[i]);
  }
  template <class Scalar, int Options>
  void read(Eigen::Quaternion<Scalar, Options>& turn) {
    for (int i = 0; i < 4; ++i) read(turn.coeffs()[i]);
  }
  /// A count of elements, each of which takes at least a byte.
  std::size_t read_count() {
    const std::uint64_t count = read_bytes(4);
    if (count > remaining()) fail("a list is longer than the rest of the bytes");
    return has_failed() ? 0 : count;
  }
  void read(std::string& text) {
    text.resize(read_count());
    for (char& c : text) c = static_cast<char>(read_bytes(1));
  }
  template <class T>
  void read(std::vector<T>& values) {
    values.clear();
    std::size_t count = read_count();
    if constexpr (kIsStoredAsBytes<T>) {
      if (count <= remaining() / sizeof(T)) {
        take_memory(count * sizeof(T));
        if (has_failed() || count == 0) return;
        values.resize(count);
        std::memcpy(values.data(), bytes_.data() + offset_, count * sizeof(T));
        offset_ += count * sizeof(T);
        return;
      }
    }
    for (; count > 0; --count) {
      take_memory(sizeof(T));
      if (has_failed()) return;
      read(values.emplace_back());
    }
  }
  template <class T, std::size_t N>
  void read(std::array<T, N>& values) {
    for (T& value : values) read(value);
  }
  template <class T>
  void read(std::optional<T>& value) {
    bool has_value = false;
    read(has_value);
    value.reset();
    if (has_value) read(value.emplace());
  }
  template <class... Kinds>
  void read(std::variant<Kinds...>& value) {
    const std::uint64_t kind = read_bytes(1);
    if (kind >= sizeof...(Kinds)) return fail("a kind is unknown");
    read_kind<0>(kind, value);
  }
  template <std::size_t I, class... Kinds>
  void read_kind(std::uint64_t kind, std::variant<Kinds...>& value) {
    if (kind == I)
      read(value.template emplace<I>());
    else if constexpr (I + 1 < sizeof...(Kinds))
      read_kind<I + 1>(kind, value);
  }
  template <class T>
  requires Listed<SnapshotReader, T>
  void read(T& value) { transfer(*this, value); }

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  std::size_t memory_ = ~std::size_t{0};  ///< Left.
  bool is_too_large_ = false;
  const char* fault_ = nullptr;
};

}  // namespace sunder::scene
