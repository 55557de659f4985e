#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sunder::usd {

/// The shortest decimal number that reads as the same float, or double; without an exponent where
/// `fixed`, for some readers know none in the keys of time samples.
[[nodiscard]] std::string number(float value);
[[nodiscard]] std::string number(double value);
[[nodiscard]] std::string fixed_number(double value);

/// A string literal with its quotes. Control characters become blanks.
[[nodiscard]] std::string literal(std::string_view text);

/// Arrays as they stand behind "=": "[1, 2]", "[(1, 2, 3), (4, 5, 6)]", "["a", "b"]".
[[nodiscard]] std::string array_of(std::span<const float> values, std::size_t components);
[[nodiscard]] std::string array_of(std::span<const std::uint32_t> values);
[[nodiscard]] std::string array_of(std::span<const std::string> texts);
/// Row vectors, as USD has them: the transposes of ours.
[[nodiscard]] std::string matrix(const Affine3d& value);
[[nodiscard]] std::string array_of(std::span<const Affine3d> matrices);

template <int kComponents>
[[nodiscard]] std::string array_of(
    const std::vector<Eigen::Matrix<float, kComponents, 1, Eigen::DontAlign>>& vectors) {
  return array_of({vectors.empty() ? nullptr : vectors[0].data(), vectors.size() * kComponents},
                  kComponents);
}

/// Text of a USD layer, a line after the other, with indented blocks.
class UsdText {
 public:
  void line(std::string_view text);
  /// A line, and the bracket that opens a block below it: '{' or '('.
  void open(std::string_view head, char bracket);
  void close(char bracket);
  /// "def Mesh "Body" (" with metadata, if there are any, and the brace of its block.
  void open_prim(std::string_view type, std::string_view name,
                 std::span<const std::string> metadata = {});

  /// The text so far, which is taken out.
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

}  // namespace sunder::usd
