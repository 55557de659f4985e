#include "support/oracles/weld_vertices.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace sunder::test {
namespace {

/// The attributes of a vertex in a fixed order, as bytes.
class Key {
 public:
  explicit Key(float tolerance) : tolerance_(tolerance) {}

  void add(float value) {
    if (tolerance_ == 0.0f)
      add_bytes(&value, sizeof value);
    else
      add_number(std::llround(value / tolerance_));
  }
  template <class Vector>
  void add_vector(const Vector& vector) {
    for (int i = 0; i < vector.size(); ++i) add(vector[i]);
  }
  /// Adds nothing if the mesh does not have this attribute.
  template <class Vector>
  void add_of(const std::vector<Vector>& array, std::uint32_t vertex) {
    if (!array.empty()) add_vector(array[vertex]);
  }
  void add_number(long long number) { add_bytes(&number, sizeof number); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  void add_bytes(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }

  float tolerance_;
  std::string bytes_;
};

std::string key_of(const Mesh& mesh, std::uint32_t vertex, float tolerance) {
  Key key(tolerance);
  key.add_of(mesh.positions, vertex);
  key.add_of(mesh.normals, vertex);
  key.add_of(mesh.tangents, vertex);
  for (const auto& uvs : mesh.uv_sets) key.add_of(uvs, vertex);
  for (const auto& colors : mesh.color_sets) key.add_of(colors, vertex);
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    for (std::uint32_t i = 0; i < attribute.components; ++i)
      key.add(attribute.values[vertex * attribute.components + i]);
  for (const MorphTarget& target : mesh.morph_targets) {
    key.add_of(target.position_deltas, vertex);
    key.add_of(target.normal_deltas, vertex);
    key.add_of(target.tangent_deltas, vertex);
  }
  for (const Influence& influence : mesh.weights.of(vertex)) {
    key.add_number(influence.slot);
    key.add(influence.weight);
  }
  return key.bytes();
}

/// Keeps `width` values per vertex of only those vertices.
template <class Value>
void keep(std::vector<Value>& values, const std::vector<std::uint32_t>& old_from_new,
          std::size_t width = 1) {
  if (values.empty()) return;
  std::vector<Value> kept;
  for (const std::uint32_t vertex : old_from_new)
    for (std::size_t i = 0; i < width; ++i) kept.push_back(values[vertex * width + i]);
  values = std::move(kept);
}

void keep_vertices(Mesh& mesh, const std::vector<std::uint32_t>& old_from_new) {
  SkinWeights weights;
  for (const std::uint32_t vertex : old_from_new) weights.append(mesh.weights.of(vertex));
  mesh.weights = std::move(weights);
  keep(mesh.positions, old_from_new);
  keep(mesh.normals, old_from_new);
  keep(mesh.tangents, old_from_new);
  for (auto& uvs : mesh.uv_sets) keep(uvs, old_from_new);
  for (auto& colors : mesh.color_sets) keep(colors, old_from_new);
  for (CustomAttribute& attribute : mesh.custom_attributes)
    keep(attribute.values, old_from_new, attribute.components);
  for (MorphTarget& target : mesh.morph_targets) {
    keep(target.position_deltas, old_from_new);
    keep(target.normal_deltas, old_from_new);
    keep(target.tangent_deltas, old_from_new);
  }
}

}  // namespace

Character weld_vertices(const Character& character, float tolerance) {
  Character welded = character;
  for (Mesh& mesh : welded.meshes) {
    std::map<std::string, std::uint32_t> known;
    std::vector<std::uint32_t> new_from_old, old_from_new;
    for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
      const auto next = static_cast<std::uint32_t>(old_from_new.size());
      const auto [at, is_new] = known.try_emplace(key_of(mesh, vertex, tolerance), next);
      if (is_new) old_from_new.push_back(vertex);
      new_from_old.push_back(at->second);
    }
    for (Triangle& triangle : mesh.triangles)
      for (std::uint32_t& vertex : triangle) vertex = new_from_old[vertex];
    keep_vertices(mesh, old_from_new);
  }
  return welded;
}

}  // namespace sunder::test
