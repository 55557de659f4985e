#include <sunder/particles/authored_tissue.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

using Values = Result<std::vector<float>>;

/// @param what  of which there are `count`.
Status check_below(const Mesh& mesh, const char* what, std::size_t index, std::size_t count) {
  if (index < count) return {};
  return Status::failure(StatusCode::index_out_of_range, static_cast<Index>(index),
                         "mesh '%.60s' has no %s %zu; it has %zu", mesh.name.c_str(), what, index,
                         count);
}

Values sample(const Character& /*character*/, const Mesh& mesh, const VertexColor& from) {
  if (Status status = check_below(mesh, "colours", from.set, mesh.color_sets.size()); !status)
    return status;
  if (Status status = check_below(mesh, "channel of colours", from.channel, 4); !status)
    return status;
  std::vector<float> values;
  values.reserve(mesh.vertex_count());
  for (const Vec4f& color : mesh.color_sets[from.set]) values.push_back(color[from.channel]);
  return values;
}

Values sample(const Character& /*character*/, const Mesh& mesh, const VertexAttribute& from) {
  const auto found = std::ranges::find(mesh.custom_attributes, from.name, &CustomAttribute::name);
  if (found == mesh.custom_attributes.end())
    return Status::failure(StatusCode::not_found, kNone, "mesh '%.60s' has no attribute '%.60s'",
                           mesh.name.c_str(), from.name.c_str());
  if (Status status =
          check_below(mesh, "component of the attribute", from.component, found->components);
      !status)
    return status;
  std::vector<float> values;
  values.reserve(mesh.vertex_count());
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    values.push_back(found->values[v * found->components + from.component]);
  return values;
}

Values sample(const Character& character, const Mesh& mesh, const BoneWeight& from) {
  const std::vector<Bone>& bones = character.skeleton.bones;
  const auto found = std::ranges::find(bones, from.bone, &Bone::name);
  if (found == bones.end())
    return Status::failure(StatusCode::not_found, kNone, "there is no bone '%.60s'",
                           from.bone.c_str());
  const auto bone = static_cast<Index>(found - bones.begin());
  const std::vector<std::uint32_t>& slots = character.skins[mesh.skin].bones;
  std::vector<float> values;
  values.reserve(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    float sum = 0;
    for (const Influence& influence : mesh.weights.of(v))
      if (slots[influence.slot] == bone) sum += influence.weight;
    values.push_back(std::min(sum, 1.0f));
  }
  return values;
}

/// The texel at whole coordinates, repeated.
double texel(const TextureChannel& of, double x, double y) {
  const auto wrapped = [](double at, std::uint32_t count) {
    const double rest = at - std::floor(at / count) * count;
    // Of coordinates beyond 2^53 the rest is rounding, of either sign.
    return std::min(static_cast<std::size_t>(std::max(rest, 0.0)), std::size_t{count} - 1);
  };
  const std::size_t at = wrapped(y, of.height) * of.width + wrapped(x, of.width);
  return of.rgba[4 * at + of.channel] / 255.0;
}

double bilinear(const TextureChannel& of, const Vec2f& uv) {
  const double x = double{uv.x()} * of.width - 0.5, y = double{uv.y()} * of.height - 0.5;
  const double left = std::floor(x), top = std::floor(y), s = x - left, t = y - top;
  const double above = (1 - s) * texel(of, left, top) + s * texel(of, left + 1, top);
  const double below = (1 - s) * texel(of, left, top + 1) + s * texel(of, left + 1, top + 1);
  return (1 - t) * above + t * below;
}

Values sample(const Character& /*character*/, const Mesh& mesh, const TextureChannel& from) {
  if (Status status = check_below(mesh, "UVs", from.uv_set, mesh.uv_sets.size()); !status)
    return status;
  if (Status status = check_below(mesh, "channel of images", from.channel, 4); !status)
    return status;
  const std::size_t bytes = std::size_t{4} * from.width * from.height;
  if (bytes == 0 || from.rgba.size() != bytes)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "an image of %u x %u texels has %zu bytes; it must have %zu, above 0",
                           from.width, from.height, from.rgba.size(), bytes);
  std::vector<float> values;
  values.reserve(mesh.vertex_count());
  for (const Vec2f& uv : mesh.uv_sets[from.uv_set])
    values.push_back(uv.allFinite() ? static_cast<float>(bilinear(from, uv)) : 0.0f);
  return values;
}

}  // namespace

Result<std::vector<float>> sample_field(const Character& character, std::uint32_t mesh,
                                        const FieldSource& source) {
  if (mesh >= character.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, mesh,
                           "mesh %u does not exist; there are %zu", mesh, character.meshes.size());
  try {
    const Mesh& of = character.meshes[mesh];
    Values values =
        std::visit([&](const auto& from) { return sample(character, of, from); }, source.from);
    if (!values) return values;
    for (Index v = 0; v < values->size(); ++v) {
      float& value = (*values)[v];
      value = static_cast<float>(source.at_zero + (source.at_one - source.at_zero) * double{value});
      if (!std::isfinite(value))
        return Status::failure(StatusCode::non_finite_value, v,
                               "mesh '%.60s', vertex %u: the sampled factor is not finite",
                               of.name.c_str(), v);
    }
    return values;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
