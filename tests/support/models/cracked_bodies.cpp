#include "support/models/cracked_bodies.h"

#include <algorithm>
#include <array>
#include <map>

#include "support/machine/say.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

using Place = std::array<float, 3>;

Place place_of(const Mesh& mesh, std::uint32_t vertex) {
  const Vec3f& at = mesh.positions[vertex];
  return {at.x() + 0.0f, at.y() + 0.0f, at.z() + 0.0f};
}

/// Bodies of closed_body() have no custom attributes. @return the copy.
std::uint32_t append_copy(Mesh& mesh, std::uint32_t vertex) {
  const auto append = [&](auto& values) {
    if (values.empty()) return;
    const auto value = values[vertex];  // by value: push_back may move the array
    values.push_back(value);
  };
  const std::uint32_t copy = mesh.vertex_count();
  append(mesh.positions);
  append(mesh.normals);
  append(mesh.tangents);
  for (auto& uvs : mesh.uv_sets) append(uvs);
  for (auto& colors : mesh.color_sets) append(colors);
  for (MorphTarget& target : mesh.morph_targets) {
    append(target.position_deltas);
    append(target.normal_deltas);
    append(target.tangent_deltas);
  }
  const auto of = mesh.weights.of(vertex);
  const std::vector<Influence> influences(of.begin(), of.end());
  mesh.weights.influences.insert(mesh.weights.influences.end(), influences.begin(),
                                 influences.end());
  mesh.weights.first.push_back(static_cast<std::uint32_t>(mesh.weights.influences.size()));
  return copy;
}

/// Gives the triangles on one side of a plane vertices of their own, with other weights: the
/// surface cracks along the plane when bones move.
/// @param change  change(vertex): its influences are the last ones of the mesh.
template <class Change>
void crack(Character& character, Random& random, Change change) {
  Mesh& mesh = character.meshes[0];
  const Vec3f normal = random.direction().cast<float>(),
              point = mesh.positions[random.index(mesh.vertex_count())];
  std::map<std::uint32_t, std::uint32_t> copies;
  std::vector<bool> stays(mesh.vertex_count(), false);
  const auto is_beyond = [&](const Triangle& t) {
    return normal.dot(mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]] -
                      3 * point) > 0;
  };
  std::vector<bool> beyond;
  for (const Triangle& t : mesh.triangles) beyond.push_back(is_beyond(t));
  for (std::size_t i = 0; i < beyond.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) stays[v] = stays[v] || !beyond[i];
  // Vertices in the same place are copied together.
  std::map<Place, bool> stays_at;
  for (std::uint32_t v = 0; v < stays.size(); ++v) stays_at[place_of(mesh, v)] |= stays[v];
  for (std::size_t i = 0; i < beyond.size(); ++i)
    for (std::uint32_t& v : mesh.triangles[i])
      if (beyond[i] && stays_at[place_of(mesh, v)]) {
        const auto [known, is_new] = copies.emplace(v, mesh.vertex_count());
        if (is_new) change(append_copy(mesh, v));
        v = known->second;
      }
}

void crack_wide(Character& character, Random& random) {
  crack(character, random, [&](std::uint32_t copy) {
    Mesh& mesh = character.meshes[0];
    const std::uint32_t slot =
        random.index(static_cast<std::uint32_t>(character.skins[mesh.skin].bones.size()));
    mesh.weights.influences.resize(mesh.weights.first[copy]);
    mesh.weights.influences.push_back({slot, 1.0f});
    mesh.weights.first.back() = static_cast<std::uint32_t>(mesh.weights.influences.size());
  });
}

void crack_slightly(Character& character, Random& random) {
  crack(character, random, [&](std::uint32_t copy) {
    Mesh& mesh = character.meshes[0];
    const std::uint32_t first = mesh.weights.first[copy];
    if (mesh.weights.influences.size() < first + 2) return;
    Influence &a = mesh.weights.influences[first], &b = mesh.weights.influences[first + 1];
    const float part = std::min(a.weight * 0.5f, static_cast<float>(1 + random.index(3)) / 256);
    const float both = a.weight + b.weight;
    a.weight -= part;
    b.weight = both - a.weight;
  });
}

}  // namespace

Character closed_body(Random& random) {
  if (random.index(2) == 0) return make_bumpy_ball(50 + random.index(300));
  const std::uint32_t rings = 2 + random.index(12), sides = 3 + random.index(10);
  return make_tube(rings, sides, 2 + random.index(4));
}

Character cracked_body(Random& random) {
  Character character = closed_body(random);
  for (std::uint32_t n = 1 + random.index(3); n > 0; --n) crack_wide(character, random);
  return character;
}

Character coarsely_weighted_body(Random& random) {
  Character character = closed_body(random);
  for (std::uint32_t n = 1 + random.index(3); n > 0; --n) crack_slightly(character, random);
  return character;
}

std::vector<std::string> unmatched_edges(const Character& character) {
  std::map<std::array<Place, 2>, int> balance;
  for (const Mesh& mesh : character.meshes)
    for (const Triangle& t : mesh.triangles) {
      if (is_retired(t)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Place a = place_of(mesh, t[k]), b = place_of(mesh, t[(k + 1) % 3]);
        if (a < b)
          ++balance[{a, b}];
        else
          --balance[{b, a}];
      }
    }
  std::vector<std::string> open;
  for (const auto& [edge, count] : balance)
    if (count != 0)
      open.push_back(say(edge[0][0], " ", edge[0][1], " ", edge[0][2], " to ", edge[1][0], " ",
                         edge[1][1], " ", edge[1][2], ": ", count));
  return open;
}

}  // namespace sunder::test
