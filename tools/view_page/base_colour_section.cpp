#include "tools/view_page/base_colour_section.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace sunder::tools {
namespace {

const char* wrap_name(BaseColour::Wrap wrap) {
  switch (wrap) {
    case BaseColour::Wrap::repeat: return "repeat";
    case BaseColour::Wrap::clamp: return "clamp";
    case BaseColour::Wrap::mirror: return "mirror";
  }
  return "repeat";
}

Json material_json(const BaseColour& colour, const BaseColours& all, PageImages& images) {
  const Vec4f& factor = colour.factor;
  const auto& transform = colour.image_from_uv;
  Json image_from_uv = Json::array();  // row by row
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 3; ++column) image_from_uv.push_back(transform(row, column));
  return {{"factor", {factor[0], factor[1], factor[2], factor[3]}},
          {"image", colour.image == kNone ? Json() : Json(images.add(all.images[colour.image]))},
          {"image_from_uv", std::move(image_from_uv)},
          {"wrap", {wrap_name(colour.wrap_u), wrap_name(colour.wrap_v)}},
          {"is_pixelated", colour.is_pixelated},
          {"cutoff", colour.cutoff}};
}

/// The material of a triangle; kNone: it has none.
Index material_of(const Mesh& mesh, Index triangle, const BaseColours& colours) {
  const Index material = mesh.submeshes[mesh.triangle_submesh[triangle]].material;
  return material < colours.materials.size() ? material : kNone;
}

/// The texture coordinates that the materials use; a vertex of several materials has those of the
/// last one.
std::vector<Vec2f> used_uvs(const Mesh& mesh, const BaseColours& colours) {
  std::vector<Vec2f> uvs(mesh.vertex_count(), Vec2f::Zero());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Index material = material_of(mesh, t, colours);
    if (material == kNone) continue;
    const Index set = colours.materials[material].uv_set;
    if (set >= mesh.uv_sets.size()) continue;
    for (const Index vertex : mesh.triangles[t]) uvs[vertex] = mesh.uv_sets[set][vertex];
  }
  return uvs;
}

/// 16 bits per channel of linear RGBA; white without colours.
void append_colours(const Mesh& mesh, std::vector<std::uint16_t>& colours) {
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    for (int i = 0; i < 4; ++i) {
      const float value = mesh.color_sets.empty() ? 1.0f : mesh.color_sets[0][v][i];
      colours.push_back(
          static_cast<std::uint16_t>(std::lround(65535.0f * std::clamp(value, 0.0f, 1.0f))));
    }
}

}  // namespace

std::size_t PageImages::add(const BaseColours::Image& image) {
  const auto [entry, is_new] = numbers_.try_emplace(image.bytes, list_.size());
  if (is_new) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(image.bytes.data());
    list_.push_back(
        {{"media", image.type},
         {"bytes", arrays_.add(std::vector<std::uint8_t>(first, first + image.bytes.size()))}});
  }
  return entry->second;
}

void add_base_colours(const ViewedModel& model, PageImages& images, DataArrays& arrays,
                      Json& section) {
  Json materials = Json::array();
  for (const BaseColour& colour : model.colours.materials)
    materials.push_back(material_json(colour, model.colours, images));
  std::vector<std::uint32_t> triangle_materials;
  std::vector<float> uvs;
  std::vector<std::uint16_t> colours;
  bool has_colours = false;
  for (const Mesh& mesh : model.character->meshes) {
    for (Index t = 0; t < mesh.triangle_count(); ++t)
      if (!is_retired(mesh.triangles[t]))
        triangle_materials.push_back(material_of(mesh, t, model.colours));
    for (const Vec2f& uv : used_uvs(mesh, model.colours))
      uvs.insert(uvs.end(), uv.data(), uv.data() + 2);
    append_colours(mesh, colours);
    has_colours = has_colours || !mesh.color_sets.empty();
  }
  section["materials"] = std::move(materials);
  section["triangle_materials"] = arrays.add(triangle_materials);
  section["uvs"] = arrays.add(uvs);
  section["colours"] = has_colours ? arrays.add(colours) : Json();
}

}  // namespace sunder::tools
