#include "bench/harness/skinned_subdivision.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <array>
#include <map>

namespace sunder::bench {
namespace {

/// A vertex inside a triangle: its corners and their shares.
struct Blend {
  Triangle corners;
  std::array<float, 3> shares;
};

class SkinnedSubdivision {
 public:
  SkinnedSubdivision(const Mesh& base, int divisions, Mesh& mesh)
      : base_(base), divisions_(static_cast<std::uint32_t>(divisions)), mesh_(mesh) {
    mesh_.uv_sets.resize(base.uv_sets.size());
    for (std::uint32_t v = 0; v < base.vertex_count(); ++v) append({{v, v, v}, {1, 0, 0}});
  }

  void add(const Triangle& triangle, std::uint32_t submesh) {
    const std::uint32_t n = divisions_;
    std::vector<std::uint32_t> row_before, row;
    for (std::uint32_t i = 0; i <= n; ++i) {  // from the first corner to the opposite side
      row.clear();
      for (std::uint32_t j = 0; j <= i; ++j) row.push_back(vertex(triangle, {n - i, i - j, j}));
      for (std::uint32_t j = 0; j < i; ++j) {
        mesh_.triangles.push_back({row_before[j], row[j], row[j + 1]});
        if (j + 1 < i) mesh_.triangles.push_back({row_before[j], row[j + 1], row_before[j + 1]});
      }
      row_before = row;
    }
    mesh_.triangle_submesh.resize(mesh_.triangles.size(), submesh);
  }

 private:
  using Parts = std::array<std::uint32_t, 3>;  // of divisions_

  std::uint32_t vertex(const Triangle& corners, const Parts& parts) {
    for (std::size_t i = 0; i < 3; ++i)
      if (parts[i] == divisions_) return corners[i];
    for (std::size_t i = 0; i < 3; ++i)
      if (parts[i] == 0)
        return on_edge(corners[(i + 1) % 3], corners[(i + 2) % 3], parts[(i + 2) % 3]);
    return append({corners, shares(parts)});
  }

  /// The vertex `part` steps along an edge, which both faces share.
  std::uint32_t on_edge(std::uint32_t from, std::uint32_t to, std::uint32_t part) {
    if (from > to) return on_edge(to, from, divisions_ - part);
    const auto [known, is_new] = first_on_edge_.try_emplace({from, to}, mesh_.vertex_count());
    for (std::uint32_t i = 1; is_new && i < divisions_; ++i)
      append({{from, to, to}, shares({divisions_ - i, i, 0})});
    return known->second + part - 1;
  }

  [[nodiscard]] std::array<float, 3> shares(const Parts& parts) const {
    const auto all = static_cast<float>(divisions_);
    return {static_cast<float>(parts[0]) / all, static_cast<float>(parts[1]) / all,
            static_cast<float>(parts[2]) / all};
  }

  template <class Vector>
  static Vector mix(const std::vector<Vector>& values, const Blend& blend) {
    Vector sum = Vector::Zero();
    for (std::size_t i = 0; i < 3; ++i) sum += blend.shares[i] * values[blend.corners[i]];
    return sum;
  }

  std::uint32_t append(const Blend& blend) {
    mesh_.positions.push_back(mix(base_.positions, blend));
    if (!base_.normals.empty()) mesh_.normals.push_back(mix(base_.normals, blend).normalized());
    for (std::size_t set = 0; set < base_.uv_sets.size(); ++set)
      mesh_.uv_sets[set].push_back(mix(base_.uv_sets[set], blend));
    influences_.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      if (blend.shares[i] <= 0) continue;
      for (const Influence& influence : base_.weights.of(blend.corners[i]))
        add(influence, blend.shares[i]);
    }
    influences_.resize(prune_influences(influences_, 4));
    double sum = 0;
    for (const Influence& influence : influences_) sum += static_cast<double>(influence.weight);
    for (Influence& influence : influences_)
      influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
    mesh_.weights.append(influences_);
    return mesh_.vertex_count() - 1;
  }

  void add(const Influence& influence, float share) {
    const auto known =
        std::find_if(influences_.begin(), influences_.end(),
                     [&](const Influence& other) { return other.slot == influence.slot; });
    if (known == influences_.end())
      influences_.push_back({influence.slot, share * influence.weight});
    else
      known->weight += share * influence.weight;
  }

  const Mesh& base_;
  std::uint32_t divisions_;
  Mesh& mesh_;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> first_on_edge_;
  std::vector<Influence> influences_;
};

}  // namespace

Character subdivide_skinned(const Character& character, int divisions) {
  Character result = character;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    const Mesh& base = character.meshes[m];
    Mesh& mesh = result.meshes[m] = {};
    mesh.name = base.name;
    mesh.skin = base.skin;
    mesh.submeshes = base.submeshes;
    SkinnedSubdivision subdivision(base, divisions, mesh);
    for (std::size_t t = 0; t < base.triangles.size(); ++t)
      subdivision.add(base.triangles[t], base.triangle_submesh[t]);
  }
  result.rest_morph_weights.clear();
  for (Clip& clip : result.clips)
    std::erase_if(clip.channels, [](const Channel& channel) {
      return channel.target == ChannelTarget::morph_weights;
    });
  return result;
}

}  // namespace sunder::bench
