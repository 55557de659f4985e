// Two characters are equal if all of their parts are. Undo and replay are checked by this, so no
// part may be forgotten.

#include <sunder/core/character.h>

#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

using Change = std::function<void(Character&)>;

/// A change of each part of a mesh.
std::vector<Change> changes_of_mesh() {
  const auto of = [](auto change) { return [change](Character& c) { change(c.meshes[0]); }; };
  return {
      of([](Mesh& m) { m.name = "other"; }),
      of([](Mesh& m) { m.skin = 1; }),
      of([](Mesh& m) { m.positions[3].x() += 1; }),
      of([](Mesh& m) { m.positions.pop_back(); }),
      of([](Mesh& m) { m.normals[3].z() += 1; }),
      of([](Mesh& m) { m.tangents.emplace_back(1, 0, 0, -1); }),
      of([](Mesh& m) { m.uv_sets[0][3].y() += 1; }),
      of([](Mesh& m) { m.color_sets.emplace_back(); }),
      of([](Mesh& m) { m.custom_attributes.pop_back(); }),
      of([](Mesh& m) { m.custom_attributes[0].name = "other"; }),
      of([](Mesh& m) { m.custom_attributes[0].components = 2; }),
      of([](Mesh& m) { m.custom_attributes[0].interpolates = false; }),
      of([](Mesh& m) { m.custom_attributes[0].values[3] += 1; }),
      of([](Mesh& m) { m.weights.first[3] += 1; }),
      of([](Mesh& m) { m.weights.influences[3].slot += 1; }),
      of([](Mesh& m) { m.weights.influences[3].weight /= 2; }),
      of([](Mesh& m) { m.morph_targets[0].name = "other"; }),
      of([](Mesh& m) { m.morph_targets[0].position_deltas[3].x() += 1; }),
      of([](Mesh& m) { m.morph_targets[0].normal_deltas.emplace_back(0, 0, 1); }),
      of([](Mesh& m) { m.morph_targets[0].tangent_deltas.emplace_back(0, 0, 1); }),
      of([](Mesh& m) { m.first_morph_weight += 1; }),
      of([](Mesh& m) { m.triangles[3][2] += 1; }),
      of([](Mesh& m) { m.triangle_submesh[3] += 1; }),
      of([](Mesh& m) { m.submeshes[1].name = "other"; }),
      of([](Mesh& m) { m.submeshes[1].material = 7; }),
  };
}

/// A change of each other part of a character.
std::vector<Change> changes_of_rig() {
  return {
      [](Character& c) { c.name = "other"; },
      [](Character& c) { c.meshes.push_back(c.meshes[0]); },
      [](Character& c) { c.rest_morph_weights[0] = 0.5f; },
      [](Character& c) { c.skeleton.bones[1].name = "other"; },
      [](Character& c) { c.skeleton.bones[1].parent = kNone; },
      [](Character& c) { c.skeleton.bones[1].rest.translation.x() += 1; },
      [](Character& c) { c.skeleton.bones[1].rest.rotation.coeffs() *= -1; },
      [](Character& c) { c.skeleton.bones[1].rest.scale.x() += 1; },
      [](Character& c) { c.skins[0].name = "other"; },
      [](Character& c) { c.skins[0].bones[1] = 0; },
      [](Character& c) { c.skins[0].bone_from_bind[1].matrix()(0, 3) += 1; },
      [](Character& c) { c.skins[0].bone_from_bind.pop_back(); },
      [](Character& c) { c.clips.clear(); },
      [](Character& c) { c.clips[0].name = "other"; },
      [](Character& c) { c.clips[0].duration += 1; },
      [](Character& c) { c.clips[0].channels.pop_back(); },
      [](Character& c) { c.clips[0].channels[0].target = ChannelTarget::scale; },
      [](Character& c) { c.clips[0].channels[0].index += 1; },
      [](Character& c) { c.clips[0].channels[0].width += 1; },
      [](Character& c) { c.clips[0].channels[0].interpolation = Interpolation::step; },
      [](Character& c) { c.clips[0].channels[0].times[0] += 1; },
      [](Character& c) { c.clips[0].channels[0].values[0] += 1; },
  };
}

TEST(Equality, characters_differ_in_any_part) {
  Character character = test::make_tube(4, 6, 3);
  CustomAttribute heat;
  heat.name = "_HEAT";
  heat.values.assign(character.meshes[0].vertex_count(), 0.5f);
  character.meshes[0].custom_attributes.push_back(heat);
  const Character same = character;
  EXPECT_EQ(same, character);
  for (const std::vector<Change>& changes : {changes_of_mesh(), changes_of_rig()})
    for (std::size_t i = 0; i < changes.size(); ++i) {
      Character other = character;
      changes[i](other);
      EXPECT_NE(other, character) << "change " << i << " of " << changes.size();
      EXPECT_EQ(other, Character(other)) << "change " << i << " of " << changes.size();
    }
}

TEST(Equality, triangles_are_retired_or_the_same_by_all_corners) {
  EXPECT_TRUE(is_retired({4, 4, 4}));
  for (const Triangle& triangle : {Triangle{4, 4, 5}, Triangle{4, 5, 4}, Triangle{5, 4, 4}}) {
    EXPECT_FALSE(is_retired(triangle));
    EXPECT_FALSE(is_same(triangle, {4, 4, 4}));
    EXPECT_TRUE(is_same(triangle, triangle));
  }
}

}  // namespace
}  // namespace sunder
