#include "tools/picture/model_looks.h"

#include <algorithm>
#include <utility>

#include "io/internal/base_colours.h"

namespace sunder::tools {
namespace {

constexpr std::uint64_t kMostImageBytes = std::uint64_t{1} << 28;
const Vec4f kPlainColor(0.60f, 0.55f, 0.50f, 1.0f);

RenderMaterial::Wrap wrap_of(BaseColour::Wrap wrap) {
  switch (wrap) {
    case BaseColour::Wrap::repeat: return RenderMaterial::Wrap::repeat;
    case BaseColour::Wrap::clamp: return RenderMaterial::Wrap::clamp;
    case BaseColour::Wrap::mirror: return RenderMaterial::Wrap::mirror;
  }
  return RenderMaterial::Wrap::repeat;
}

}  // namespace

Result<ModelLooks> ModelLooks::create(const SourceDocument* source) {
  ModelLooks looks;
  RenderMaterial plain, flesh;
  plain.factor = kPlainColor;
  plain.is_skin = true;
  flesh.factor = Vec4f::Ones();
  flesh.is_flesh = true;
  looks.materials_ = {flesh, plain};
  looks.uv_sets_ = {0u, 0u};
  if (source == nullptr) return looks;
  const Result<BaseColours> colours = read_base_colours(*source, kMostImageBytes);
  if (!colours) return colours.error();
  for (const BaseColours::Image& image : colours->images) {
    Result<Image> decoded = decode_image(image.bytes);
    looks.images_.push_back(decoded ? std::move(*decoded) : Image());
  }
  for (const BaseColour& colour : colours->materials) {
    RenderMaterial material;
    material.factor = colour.factor;
    if (colour.image != kNone && looks.images_[colour.image].width > 0)
      material.image = &looks.images_[colour.image];
    material.wrap = {wrap_of(colour.wrap_u), wrap_of(colour.wrap_v)};
    material.cutoff = colour.cutoff;
    material.is_skin = true;
    looks.materials_.push_back(material);
    looks.uv_sets_.push_back(colour.uv_set);
  }
  return looks;
}

RenderScene ModelLooks::begin_scene() const {
  RenderScene scene;
  scene.materials = materials_;
  return scene;
}

void ModelLooks::add_mesh(const Mesh& mesh, const DeformedMesh& posed, const Flesh& flesh,
                          RenderScene& scene) const {
  const bool has_colors = !mesh.color_sets.empty();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (is_retired(triangle)) continue;
    const std::uint32_t submesh = mesh.triangle_submesh[t];
    RenderTriangle drawn;
    const bool is_flesh = submesh >= flesh.first_submesh;
    drawn.material = kPlain;
    if (const std::size_t given = mesh.submeshes[submesh].material;
        mesh.submeshes[submesh].material != kNone && kFirst + given < materials_.size())
      drawn.material = static_cast<std::uint32_t>(kFirst + given);
    if (is_flesh) drawn.material = kFlesh;
    drawn.has_flesh_inside = flesh.is_inside;
    // The plain material does not darken the colours of the vertices.
    const bool is_plain = drawn.material == kPlain && has_colors;
    const std::uint32_t set = uv_sets_[drawn.material];
    const bool has_uvs = set < mesh.uv_sets.size();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = triangle[i];
      drawn.corners[i] = posed.positions[vertex];
      drawn.normals[i] = posed.normals[vertex];
      const Vec3f at = posed.positions[vertex] / flesh.unit;
      drawn.uvs[i] = has_uvs ? mesh.uv_sets[set][vertex] : Vec2f(Vec2f::Zero());
      if (is_flesh) drawn.uvs[i] = {at.x() + 0.5f * at.y(), -1000 - at.z() - 0.5f * at.y()};
      drawn.tints[i] = has_colors ? mesh.color_sets[0][vertex] : Vec4f(Vec4f::Ones());
      if (is_plain) drawn.tints[i] = drawn.tints[i].cwiseQuotient(kPlainColor);
    }
    scene.triangles.push_back(drawn);
  }
}

}  // namespace sunder::tools
