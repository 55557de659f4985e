#include "io/import_checks/check_x.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "io/import_checks/check_nesting.h"
#include "io/import_checks/text_lines.h"

namespace sunder::assimp_import {
namespace {

/// Words, numbers, strings with their quotes, and braces. Other separators and comments are
/// skipped.
class XTokens {
 public:
  explicit XTokens(std::string_view text) : text_(text) {}

  /// Empty at the end.
  std::string_view next() {
    skip();
    if (at_ >= text_.size()) return {};
    const std::size_t begin = at_;
    if (text_[begin] == '"') {
      const std::size_t end = text_.find('"', begin + 1);
      at_ = end == std::string_view::npos ? text_.size() : end + 1;
    } else if (text_[begin] == '{' || text_[begin] == '}') {
      ++at_;
    } else {
      at_ = std::min(text_.find_first_of(" \t\r\n;,{}\"", begin), text_.size());
    }
    return text_.substr(begin, at_ - begin);
  }

 private:
  void skip() {
    for (;;) {
      at_ = std::min(text_.find_first_not_of(" \t\r\n;,", at_), text_.size());
      const bool is_comment =
          at_ < text_.size() && (text_[at_] == '#' || text_.substr(at_).starts_with("//"));
      if (!is_comment) return;
      at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// The first token of an object's data, after its optional name.
std::string_view first_of_object(XTokens& tokens) {
  std::string_view token = tokens.next();
  if (token != "{") token = tokens.next();
  return token == "{" ? tokens.next() : std::string_view();
}

/// @return the first vertex of a SkinWeights object that is not below `vertices`.
std::optional<std::uint64_t> bad_vertex(XTokens& tokens, std::uint64_t vertices) {
  if (!first_of_object(tokens).starts_with('"')) return std::nullopt;
  const auto count = parse_count(tokens.next());
  for (std::uint64_t i = 0; count && i < *count; ++i) {
    const auto vertex = parse_count(tokens.next());
    if (!vertex) return std::nullopt;  // assimp refuses it
    if (*vertex >= vertices) return vertex;
  }
  return std::nullopt;
}

}  // namespace

Status check_x(std::string_view content, const std::string& file_name) {
  if (const Status status = check_x_depth(content, file_name); !status) return status;
  std::optional<std::uint64_t> vertices;
  XTokens tokens(content);
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
    if (token == "Mesh")
      vertices = parse_count(first_of_object(tokens));
    else if (token == "SkinWeights" && vertices)
      if (const auto vertex = bad_vertex(tokens, *vertices))
        return Status::failure(
            StatusCode::index_out_of_range, kNone,
            "%.100s: weights of vertex %llu, which does not exist; the mesh has %llu",
            file_name.c_str(), static_cast<unsigned long long>(*vertex),
            static_cast<unsigned long long>(*vertices));
  }
  return {};
}

}  // namespace sunder::assimp_import
