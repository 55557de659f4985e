#include "io/usd_write/blend_shapes.h"

#include <span>

#include "io/gltf_write/mesh_writer.h"

namespace sunder::usd {
namespace {

/// The names of a mesh's targets, in order.
std::span<const std::string> names_of(const Mesh& mesh, const std::vector<std::string>& names) {
  return std::span(names).subspan(mesh.first_morph_weight, mesh.morph_targets.size());
}

const Vec3f& delta(const std::vector<Vec3f>& deltas, std::uint32_t vertex) {
  static const Vec3f zero = Vec3f::Zero();
  return deltas.empty() ? zero : deltas[vertex];
}

void write_blend_shape(UsdText& text, const MorphTarget& target, std::uint32_t vertex_count) {
  std::vector<std::uint32_t> points;
  std::vector<Vec3f> offsets, normal_offsets;
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    const Vec3f &offset = delta(target.position_deltas, v), &turn = delta(target.normal_deltas, v);
    if (offset.isZero(0) && turn.isZero(0)) continue;
    points.push_back(v);
    offsets.push_back(offset);
    normal_offsets.push_back(turn);
  }
  text.line("uniform vector3f[] offsets = " + array_of(offsets));
  if (!target.normal_deltas.empty())
    text.line("uniform vector3f[] normalOffsets = " + array_of(normal_offsets));
  text.line("uniform int[] pointIndices = " + array_of(points));
}

}  // namespace

std::vector<std::string> blend_shape_names(const Character& character) {
  std::vector<std::string> names(character.rest_morph_weights.size());
  Identifiers taken;
  for (const Mesh& mesh : character.meshes) {
    if (!gltf::MeshWriter::has_triangles(mesh)) continue;
    for (std::size_t i = 0; i < mesh.morph_targets.size(); ++i)
      if (std::string& name = names[mesh.first_morph_weight + i]; name.empty())
        name = taken.add(mesh.morph_targets[i].name, "shape");
  }
  return names;
}

void write_blend_shape_bindings(UsdText& text, const Mesh& mesh, const std::string& path,
                                const std::vector<std::string>& names) {
  if (mesh.morph_targets.empty()) return;
  const std::span<const std::string> own = names_of(mesh, names);
  text.line("uniform token[] skel:blendShapes = " + array_of(own));
  std::string targets;
  for (const std::string& name : own)
    targets += (targets.empty() ? "<" : ", <") + path + "/" + name + ">";
  text.line("rel skel:blendShapeTargets = " + (own.size() == 1 ? targets : "[" + targets + "]"));
}

void write_blend_shapes(UsdText& text, const Mesh& mesh, const std::vector<std::string>& names,
                        Identifiers& children) {
  const std::span<const std::string> own = names_of(mesh, names);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const MorphTarget& target = mesh.morph_targets[i];
    text.line("");
    text.open_prim("BlendShape", children.add(own[i], "shape"), display_name(target.name, own[i]));
    write_blend_shape(text, target, mesh.vertex_count());
    text.close('}');
  }
}

}  // namespace sunder::usd
