#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>

#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

template <class T>
void reorder(std::vector<T>& values, std::size_t components,
             std::span<const std::uint32_t> old_from_new) {
  if (values.empty()) return;
  const std::vector<T> old = values;
  for (std::size_t v = 0; v < old_from_new.size(); ++v)
    std::copy_n(old.begin() + static_cast<std::ptrdiff_t>(components * old_from_new[v]), components,
                values.begin() + static_cast<std::ptrdiff_t>(components * v));
}

std::vector<std::uint32_t> find_order(const Mesh& mesh) {
  std::vector<std::uint32_t> slots;  // per vertex, ascending
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    for (const Influence& influence : mesh.weights.of(v)) slots.push_back(influence.slot);
    std::sort(slots.begin() + mesh.weights.first[v], slots.end());
  }
  const auto slots_of = [&](std::uint32_t v) {
    return std::span<const std::uint32_t>(slots.data() + mesh.weights.first[v],
                                          slots.data() + mesh.weights.first[v + 1]);
  };
  std::vector<std::uint32_t> old_from_new(mesh.vertex_count());
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) old_from_new[v] = v;
  std::stable_sort(old_from_new.begin(), old_from_new.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto of_a = slots_of(a), of_b = slots_of(b);
    return std::lexicographical_compare(of_a.begin(), of_a.end(), of_b.begin(), of_b.end());
  });
  return old_from_new;
}

/// A copy of the mesh in another order.
Mesh reordered(const Mesh& from, std::span<const std::uint32_t> old_from_new,
               std::span<const std::uint32_t> new_from_old) {
  Mesh mesh = from;
  reorder(mesh.positions, 1, old_from_new);
  reorder(mesh.normals, 1, old_from_new);
  reorder(mesh.tangents, 1, old_from_new);
  for (auto& uvs : mesh.uv_sets) reorder(uvs, 1, old_from_new);
  for (auto& colors : mesh.color_sets) reorder(colors, 1, old_from_new);
  for (CustomAttribute& attribute : mesh.custom_attributes)
    reorder(attribute.values, attribute.components, old_from_new);
  for (MorphTarget& target : mesh.morph_targets) {
    reorder(target.position_deltas, 1, old_from_new);
    reorder(target.normal_deltas, 1, old_from_new);
    reorder(target.tangent_deltas, 1, old_from_new);
  }
  SkinWeights weights;
  weights.influences.reserve(mesh.weights.influences.size());
  weights.first.reserve(old_from_new.size() + 1);
  for (const std::uint32_t old : old_from_new) weights.append(from.weights.of(old));
  mesh.weights = std::move(weights);
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_from_old[vertex];
  return mesh;
}

}  // namespace

Result<std::vector<std::uint32_t>> order_for_skinning(const Mesh& mesh) {
  return or_out_of_memory([&]() -> Result<std::vector<std::uint32_t>> { return find_order(mesh); });
}

Status reorder_vertices(Mesh& mesh, std::span<const std::uint32_t> old_from_new) {
  const std::uint32_t count = mesh.vertex_count();
  if (old_from_new.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the order has %zu entries, the mesh has %u vertices",
                           old_from_new.size(), count);
  return or_out_of_memory([&]() -> Status {
    std::vector<std::uint32_t> new_from_old(count, kNone);
    for (std::uint32_t v = 0; v < count; ++v) {
      const std::uint32_t old = old_from_new[v];
      if (old >= count || new_from_old[old] != kNone)
        return Status::failure(StatusCode::index_out_of_range, v,
                               "entry %u: vertex %u does not exist or occurs twice", v, old);
      new_from_old[old] = v;
    }
    mesh = reordered(mesh, old_from_new, new_from_old);
    return {};
  });
}

}  // namespace sunder
