#include "io/usd_write/usd_text.h"

#include <array>
#include <charconv>

namespace sunder::usd {
namespace {

template <class Value, class... Format>
void append_digits(std::string& text, Value value, Format... format) {
  // A double without an exponent has up to 309 digits, or 17 behind 307 zeros.
  std::array<char, 384> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, format...);
  text.append(digits.data(), end.ptr);
}

/// Puts entries between brackets, separated by commas. @param append  writes entry i.
template <class Append>
std::string bracketed(std::size_t count, const Append& append) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) text += ", ";
    append(text, i);
  }
  return text += "]";
}

void append_row(std::string& text, const Affine3d& value, Eigen::Index row, const char* last) {
  text += "(";
  for (Eigen::Index i = 0; i < 3; ++i) {
    append_digits(text, value.matrix()(i, row));
    text += ", ";
  }
  text.append(last).append(")");
}

void append_matrix(std::string& text, const Affine3d& value) {
  text += "( ";
  for (Eigen::Index row = 0; row < 4; ++row) {
    append_row(text, value, row, row == 3 ? "1" : "0");
    text += row == 3 ? " )" : ", ";
  }
}

}  // namespace

std::string number(float value) {
  std::string text;
  append_digits(text, value);
  return text;
}

std::string number(double value) {
  std::string text;
  append_digits(text, value);
  return text;
}

std::string fixed_number(double value) {
  std::string text;
  append_digits(text, value, std::chars_format::fixed);
  return text;
}

std::string literal(std::string_view text) {
  std::string result = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') result += '\\';
    const auto code = static_cast<unsigned char>(letter);
    result += code < 0x20 || code == 0x7f ? ' ' : letter;
  }
  return result += '"';
}

std::string array_of(std::span<const float> values, std::size_t components) {
  return bracketed(values.size() / components, [&](std::string& text, std::size_t i) {
    if (components > 1) text += "(";
    for (std::size_t c = 0; c < components; ++c) {
      if (c > 0) text += ", ";
      append_digits(text, values[i * components + c]);
    }
    if (components > 1) text += ")";
  });
}

std::string array_of(std::span<const std::uint32_t> values) {
  return bracketed(values.size(),
                   [&](std::string& text, std::size_t i) { append_digits(text, values[i]); });
}

std::string array_of(std::span<const std::string> texts) {
  return bracketed(texts.size(),
                   [&](std::string& text, std::size_t i) { text += literal(texts[i]); });
}

std::string matrix(const Affine3d& value) {
  std::string text;
  append_matrix(text, value);
  return text;
}

std::string array_of(std::span<const Affine3d> matrices) {
  return bracketed(matrices.size(),
                   [&](std::string& text, std::size_t i) { append_matrix(text, matrices[i]); });
}

void UsdText::line(std::string_view text) {
  if (!text.empty()) text_.append(4 * depth_, ' ');
  text_.append(text).append("\n");
}

void UsdText::open(std::string_view head, char bracket) {
  line(std::string(head) + " " + bracket);
  ++depth_;
}

void UsdText::close(char bracket) {
  --depth_;
  line(std::string(1, bracket));
}

void UsdText::open_prim(std::string_view type, std::string_view name,
                        std::span<const std::string> metadata) {
  const std::string head = "def " + std::string(type) + " \"" + std::string(name) + "\"";
  if (metadata.empty()) {
    line(head);
  } else {
    open(head, '(');
    for (const std::string& entry : metadata) line(entry);
    close(')');
  }
  line("{");
  ++depth_;
}

}  // namespace sunder::usd
