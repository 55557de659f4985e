#include "tools/open/flesh_option.h"

#include <charconv>
#include <sstream>

#include "tools/render/texture.h"

namespace sunder::tools {
namespace {

Status refused(const std::string& field, const char* expected) {
  return Status::failure(StatusCode::invalid_argument, kNone, "'%.60s': expected %s", field.c_str(),
                         expected);
}

/// @param text  "#8a2b22".
Status read_colour(const std::string& text, Vec4f& colour) {
  std::uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + 1, end, rgb, 16);
  if (text.size() != 7 || read.ec != std::errc() || read.ptr != end)
    return refused(text, "a colour of six hexadecimal digits, '#8a2b22'");
  for (int i = 0; i < 3; ++i) colour[i] = linear_from_srgb()[rgb >> (16 - 8 * i) & 0xffu];
  return {};
}

Status read_field(const std::string& field, AppendedMaterial& material) {
  if (field.starts_with("#")) return read_colour(field, material.base_colour);
  if (field.starts_with("name=") && field.size() > 5) {
    material.name = field.substr(5);
    return {};
  }
  constexpr std::string_view kRoughness = "roughness=";
  if (!field.starts_with(kRoughness))
    return refused(field, "none, source, #RRGGBB, roughness=SHARE or name=TEXT");
  const char* const end = field.data() + field.size();
  const auto read = std::from_chars(field.data() + kRoughness.size(), end, material.roughness);
  const bool is_share = read.ec == std::errc() && read.ptr == end && material.roughness >= 0 &&
                        material.roughness <= 1;
  return is_share ? Status() : refused(field, "a roughness from 0 to 1");
}

}  // namespace

Result<FleshOption> parse_flesh(const std::string& text) {
  FleshOption option;
  if (text == "none" || text == "source") {
    option.use = text == "none" ? FleshOption::Use::none : FleshOption::Use::source;
    return option;
  }
  std::istringstream fields(text + ",");
  for (std::string field; std::getline(fields, field, ',');)
    if (const Status status = read_field(field, option.material); !status) return status;
  return option;
}

}  // namespace sunder::tools
