#include "tools/picture/model_looks.h"

#include <algorithm>
#include <utility>

namespace sunder::tools {
namespace {

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

Result<ModelLooks> ModelLooks::create(const SourceDocument* source, std::uint64_t most_pixels) {
  ModelLooks looks;
  RenderMaterial plain, flesh;
  plain.factor = kPlainColor;
  plain.is_skin = true;
  flesh.factor = Vec4f::Ones();
  flesh.is_flesh = true;
  looks.materials_ = {flesh, plain};
  looks.colours_.resize(kFirst);
  looks.lack_images_.resize(kFirst);
  if (source == nullptr) return looks;
  Result<BaseColours> colours = read_base_colours(*source, kMostImageBytes);
  if (!colours) return colours.error();
  std::uint64_t pixels_left = most_pixels;
  looks.most_pixels_ = most_pixels;
  for (const BaseColours::Image& image : colours->images) {
    std::uint64_t pixels = 0;  // Broken images count too: they take as much time.
    Result<Image> decoded = decode_image(image.bytes, pixels_left, &pixels);
    looks.images_.push_back(decoded ? std::move(*decoded) : Image());
    pixels_left -= pixels;
  }
  for (BaseColour& colour : colours->materials) {
    bool lacks_image = colour.lacks_image;
    looks.materials_.push_back(looks.material_of(colour, lacks_image));
    looks.lack_images_.push_back(lacks_image);
    looks.colours_.push_back(colour);
  }
  return looks;
}

RenderMaterial ModelLooks::material_of(const BaseColour& colour, bool& lacks_image) const {
  const auto find = [&](std::uint32_t image) -> const Image* {
    if (image == kNone) return nullptr;
    if (images_[image].width > 0) return &images_[image];
    lacks_image = true;
    return nullptr;
  };
  RenderMaterial material;
  material.factor = colour.factor;
  material.image = find(colour.image);
  material.emission_image = find(colour.emission_image);
  if (colour.emission_image == kNone || material.emission_image != nullptr)
    material.emission = colour.emission;
  material.wrap = {wrap_of(colour.wrap_u), wrap_of(colour.wrap_v)};
  material.is_pixelated = colour.is_pixelated;
  if (colour.cutoff > 0) material.alpha = RenderMaterial::Alpha::cut;
  if (colour.is_blended) material.alpha = RenderMaterial::Alpha::blended;
  material.cutoff = colour.cutoff;
  material.is_unlit = colour.is_unlit;
  material.is_skin = true;
  return material;
}

std::string ModelLooks::missing_textures() const {
  const auto without = std::ranges::count(lack_images_, true);
  if (without == 0) return {};
  return std::to_string(without) +
         " materials are drawn without a texture: its image is missing, neither PNG nor JPEG, or "
         "too large (all together may have " +
         std::to_string(most_pixels_) + " pixels)";
}

ModelLooks::OfFile ModelLooks::of_file(std::uint32_t material) const {
  if (material == kNone || kFirst + std::size_t{material} >= materials_.size()) {
    OfFile none;
    none.material.factor.setOnes();
    none.material.is_skin = true;
    return none;
  }
  const std::size_t at = kFirst + std::size_t{material};
  return {colours_[at], materials_[at], lack_images_[at]};
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
    drawn.has_flesh_inside = flesh.inside != nullptr && (*flesh.inside)[t];
    // The plain material does not darken the colours of the vertices.
    const bool is_plain = drawn.material == kPlain && has_colors;
    Cover cover{kNone, colours_[drawn.material].uv_set, colours_[drawn.material].image_from_uv};
    if (submesh < flesh.covers.size() && flesh.covers[submesh].material != kNone) {
      cover = flesh.covers[submesh];
      drawn.material = cover.material;
    }
    const bool has_uvs = cover.uv_set < mesh.uv_sets.size();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t vertex = triangle[i];
      drawn.corners[i] = posed.positions[vertex];
      drawn.normals[i] = posed.normals[vertex];
      drawn.rest[i] = flesh.reaches * mesh.positions[vertex];
      const Vec3f at = posed.positions[vertex] / flesh.unit;
      drawn.uvs[i] = Vec2f::Zero();
      if (has_uvs)
        drawn.uvs[i] = cover.image_from_uv * mesh.uv_sets[cover.uv_set][vertex].homogeneous();
      if (is_flesh) drawn.uvs[i] = {at.x() + 0.5f * at.y(), -1000 - at.z() - 0.5f * at.y()};
      drawn.tints[i] = has_colors ? mesh.color_sets[0][vertex] : Vec4f(Vec4f::Ones());
      if (is_plain) drawn.tints[i] = drawn.tints[i].cwiseQuotient(kPlainColor);
    }
    scene.triangles.push_back(drawn);
  }
}

}  // namespace sunder::tools
