#include "tools/open/tissue_field.h"

#include <sunder/aim/aim.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "io/internal/read_input.h"
#include "tools/model/name_at.h"
#include "tools/render/image.h"

namespace sunder::tools {
namespace {

constexpr std::uint64_t kMostImageBytes = std::uint64_t{1} << 28;
constexpr std::string_view kShown[] = {"stiffness", "tension", "thickness"};
constexpr const char* kExpectedSource =
    "bone:NAME, color:COLOR_0, attribute:_NAME or texture:FILE.png";

Status refused_part(const std::string& part, const char* expected) {
  return Status::failure(StatusCode::invalid_argument, kNone, "'%.80s': expected %s", part.c_str(),
                         expected);
}

std::optional<std::uint32_t> whole_number_in(std::string_view text) {
  std::uint32_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end ? std::optional(number) : std::nullopt;
}

/// Reads the name of a factor.
Status read_factor(const std::string& name, TissueField& field) {
  TissueFactors known;
  if (std::ranges::find(kShown, name) != std::end(kShown)) {
    field.factor = name;
    return {};
  }
  if (find_field(known, name) != nullptr || name == "perforation")
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "'%.40s' shows only where force tears, which this command does not do; "
                           "expected stiffness, tension or thickness",
                           name.c_str());
  return refused_part(name, "stiffness, tension or thickness, and '=' with its source");
}

/// Reads "bone:LeftArm".
Status read_source(const std::string& text, TissueField& field) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  const std::string name = colon == std::string::npos ? std::string() : text.substr(colon + 1);
  if (name.empty()) return refused_part(text, kExpectedSource);
  if (kind == "bone") {
    field.source.from = BoneWeight{name};
  } else if (kind == "attribute") {
    field.source.from = VertexAttribute{name};
  } else if (kind == "texture") {
    field.source.from = TextureChannel{};
    field.image = name;
  } else if (kind == "color") {
    constexpr std::string_view kSet = "COLOR_";
    const auto set = name.starts_with(kSet) ? whole_number_in(name.substr(kSet.size()))
                                            : std::optional<std::uint32_t>();
    if (!set) return refused_part(text, "colours of vertices, color:COLOR_0");
    field.source.from = VertexColor{*set};
  } else {
    return refused_part(text, kExpectedSource);
  }
  return {};
}

/// Reads "channel=g" and whatever else belongs to some sources only.
Status read_part(const std::string& part, const std::string& key, const std::string& value,
                 FieldSource& source) {
  auto* const color = std::get_if<VertexColor>(&source.from);
  auto* const attribute = std::get_if<VertexAttribute>(&source.from);
  auto* const texture = std::get_if<TextureChannel>(&source.from);
  if (key == "channel" && (color != nullptr || texture != nullptr)) {
    const std::size_t channel = std::string_view("rgba").find(value);
    if (value.size() != 1 || channel == std::string_view::npos)
      return refused_part(part, "channel=r, g, b or a");
    (color != nullptr ? color->channel : texture->channel) = static_cast<std::uint32_t>(channel);
    return {};
  }
  std::uint32_t* number = nullptr;
  if (key == "component" && attribute != nullptr) number = &attribute->component;
  if (key == "uv" && texture != nullptr) number = &texture->uv_set;
  if (number == nullptr)
    return refused_part(part,
                        "at_zero or at_one; channel of colours and textures, uv of textures, "
                        "component of attributes");
  const std::optional<std::uint32_t> read = whole_number_in(value);
  if (!read) return refused_part(part, "a whole number");
  *number = *read;
  return {};
}

/// Reads the parts behind the source.
Status read_parts(std::string_view text, TissueField& field) {
  std::vector<std::string> keys;
  std::optional<double> at_zero, at_one;
  while (!text.empty()) {
    text.remove_prefix(1);  // The comma.
    const std::string part(text.substr(0, text.find(',')));
    text.remove_prefix(part.size());
    const std::size_t equals = part.find('=');
    const std::string key = part.substr(0, equals);
    const std::string value = equals == std::string::npos ? std::string() : part.substr(equals + 1);
    if (std::ranges::find(keys, key) != keys.end())
      return Status::failure(StatusCode::invalid_argument, kNone, "'%.40s' is given twice",
                             key.c_str());
    keys.push_back(key);
    if (key != "at_zero" && key != "at_one") {
      if (const Status status = read_part(part, key, value, field.source); !status) return status;
      continue;
    }
    const std::optional<double> number = number_in(value);
    if (!number) return refused_part(part, "a number");
    (key == "at_zero" ? at_zero : at_one) = number;
  }
  if (!at_zero && !at_one) return {};
  field.source.at_zero = at_zero.value_or(1.0);
  field.source.at_one = at_one.value_or(1.0);
  return {};
}

Status read_texels(const std::filesystem::path& file, TextureChannel& texture) {
  const Result<std::string> bytes = read_input(file, kMostImageBytes);
  if (!bytes) return bytes.error();
  Result<Image> image = decode_image(std::as_bytes(std::span(*bytes)));
  if (!image)
    return Status::failure(image.error().code(), kNone, "%.150s: %.200s", file.c_str(),
                           std::string(image.error().text()).c_str());
  texture.width = static_cast<std::uint32_t>(image->width);
  texture.height = static_cast<std::uint32_t>(image->height);
  texture.rgba = std::move(image->rgba);
  return {};
}

/// Gives a source what sample_field() needs: the full name of the bone, or the texels.
Status complete_source(const Character& character, const std::filesystem::path& image,
                       FieldSource& source) {
  if (auto* const bone = std::get_if<BoneWeight>(&source.from)) {
    const Result<std::uint32_t> found = find_bone(character.skeleton, bone->bone);
    if (!found) return found.error();
    bone->bone = character.skeleton.bones[*found].name;
  }
  if (auto* const texture = std::get_if<TextureChannel>(&source.from))
    if (const Status status = read_texels(image, *texture); !status) return status;
  return {};
}

}  // namespace

Result<TissueField> parse_tissue_field(const std::string& text) {
  TissueField field;
  field.text = text;
  const std::size_t equals = text.find('=');
  if (const Status status = read_factor(text.substr(0, equals), field); !status) return status;
  if (equals == std::string::npos) return refused_part(text, kExpectedSource);
  const std::string rest = text.substr(equals + 1), source = rest.substr(0, rest.find(','));
  if (const Status status = read_source(source, field); !status) return status;
  if (const Status status = read_parts(std::string_view(rest).substr(source.size()), field);
      !status)
    return status;
  return field;
}

Status add_tissue_field(const Character& character, const TissueField& field,
                        AuthoredTissue& tissue) {
  FieldSource source = field.source;
  if (const Status status = complete_source(character, field.image, source); !status) return status;
  AuthoredTissue with = tissue;
  with.meshes.resize(character.meshes.size());
  std::optional<Status> lacking;
  bool is_anywhere = false;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    Result<std::vector<float>> values = sample_field(character, m, source);
    if (values) {
      *find_field(with.meshes[m], field.factor) = std::move(*values);
      is_anywhere = true;
      continue;
    }
    const StatusCode code = values.error().code();
    if (code != StatusCode::not_found && code != StatusCode::index_out_of_range)
      return values.error();
    if (!lacking) lacking = values.error();
  }
  if (!is_anywhere && lacking) return *lacking;
  if (const Status status = validate_authored_tissue(with, character); !status) return status;
  tissue = std::move(with);
  return {};
}

}  // namespace sunder::tools
