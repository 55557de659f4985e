#include "support/models/own_models.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

constexpr std::uint32_t kMostInfluences = 6;

/// Cuts the texture of a sheet along its middle column: each vertex there becomes two.
void add_uv_seam(Mesh& mesh, std::uint32_t cells) {
  const std::uint32_t middle = cells / 2;
  const std::uint32_t first_copy = mesh.vertex_count();
  for (std::uint32_t row = 0; row <= cells; ++row) {
    const std::uint32_t vertex = row * (cells + 1) + middle;
    mesh.positions.push_back(Vec3f(mesh.positions[vertex]));
    mesh.normals.push_back(Vec3f(mesh.normals[vertex]));
    mesh.uv_sets[0].emplace_back(0.0f, mesh.uv_sets[0][vertex].y());
    const auto of_vertex = mesh.weights.of(vertex);
    mesh.weights.append(std::vector<Influence>(of_vertex.begin(), of_vertex.end()));
  }
  for (Triangle& triangle : mesh.triangles) {
    const bool is_right = std::ranges::any_of(triangle, [&](std::uint32_t vertex) {
      return vertex < first_copy && vertex % (cells + 1) > middle;
    });
    for (std::uint32_t& vertex : triangle)
      if (is_right && vertex < first_copy && vertex % (cells + 1) == middle)
        vertex = first_copy + vertex / (cells + 1);
  }
}

Character make_seamed_sheet() {
  constexpr std::uint32_t kCells = 10;
  Character character = make_sheet(kCells);
  Mesh& mesh = character.meshes[0];
  add_uv_seam(mesh, kCells);
  MorphTarget wave{"wave", {}, {}, {}};
  for (const Vec3f& position : mesh.positions)
    wave.position_deltas.emplace_back(0.0f, 0.0f, 0.1f * std::sin(6.0f * position.x()));
  mesh.morph_targets.push_back(std::move(wave));
  character.rest_morph_weights = {0.25f};
  return character;
}

/// A tube whose vertices follow six bones each, which takes two sets of joints and weights.
Character make_tube_of_six_influences() {
  constexpr std::uint32_t kBones = 8;
  Character character = make_tube(20, 12, kBones);
  Mesh& mesh = character.meshes[0];
  mesh.weights = {};
  for (const Vec3f& position : mesh.positions) {
    std::vector<Influence> influences;
    const auto nearest = static_cast<std::uint32_t>(std::max(position.y() - 2.5f, 0.0f));
    const std::uint32_t first = std::min(nearest, kBones - kMostInfluences);
    float sum = 0;
    for (std::uint32_t bone = first; bone < first + kMostInfluences; ++bone) {
      const float distance = position.y() - (static_cast<float>(bone) + 0.5f);
      influences.push_back({bone, 1.0f / (0.5f + distance * distance)});
      sum += influences.back().weight;
    }
    for (Influence& influence : influences) influence.weight /= sum;
    std::ranges::sort(influences, std::ranges::greater(), &Influence::weight);
    mesh.weights.append(influences);
  }
  return character;
}

Channel channel_of(ChannelTarget target, std::uint32_t bone, Interpolation interpolation,
                   std::vector<float> times, std::vector<float> values) {
  Channel channel;
  channel.target = target;
  channel.index = bone;
  channel.width = target == ChannelTarget::rotation ? 4 : 3;
  channel.interpolation = interpolation;
  channel.times = std::move(times);
  channel.values = std::move(values);
  return channel;
}

/// Cubic and stepped channels in two clips, and a rest pose that is not the bind pose.
Character make_tube_of_two_clips() {
  Character character = make_tube(12, 10, 3);
  character.skeleton.bones[1].rest.rotation =
      Quatf(Eigen::AngleAxisf(0.3f, Eigen::Vector3f::UnitZ()));
  const float s = std::sin(0.4f), c = std::cos(0.4f);
  Clip sway{"Sway", 1.5f, {}};
  sway.channels.push_back(channel_of(ChannelTarget::rotation, 2, Interpolation::cubic_spline,
                                     {0.0f, 0.5f, 1.5f},
                                     {0, 0, 0, 0, 0, 0, 0, 1, 0.2f, 0, 0, 0,      //
                                      0, 0, 0, 0, s, 0, 0, c, 0,    0, 0, -0.1f,  //
                                      0, 0, 0, 0, 0, 0, s, c, 0,    0, 0, 0}));
  sway.channels.push_back(channel_of(ChannelTarget::translation, 0, Interpolation::cubic_spline,
                                     {0.0f, 1.0f},
                                     {0, 0, 0, 0, 0, 0, 1, 0, 0,  //
                                      0, 1, 0, 0.5f, 0, 0, 0, 0, 0}));
  Clip pulse{"Pulse", 1.0f, {}};
  pulse.channels.push_back(channel_of(ChannelTarget::scale, 1, Interpolation::step,
                                      {0.0f, 0.5f, 1.0f}, {1, 1, 1, 1.2f, 1, 1.2f, 1, 0.8f, 1}));
  character.clips = {std::move(sway), std::move(pulse)};
  return character;
}

/// A mesh in centimetres below a root that scales by 0.01, on bones that are scaled unevenly.
Character make_tube_of_scaled_bones() {
  Character character = make_tube(12, 10, 3);
  character.skeleton.bones[0].rest.scale.setConstant(0.01f);
  character.skeleton.bones[1].rest.scale = Vec3f(1.0f, 1.25f, 0.8f);
  for (std::size_t i = 1; i < 3; ++i) character.skeleton.bones[i].rest.translation *= 100.0f;
  Mesh& mesh = character.meshes[0];
  for (Vec3f& position : mesh.positions) position *= 100.0f;
  for (Vec3f& delta : mesh.morph_targets[0].position_deltas) delta *= 100.0f;
  Affine3f model_from_bone = Affine3f::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const BoneTransform& rest = character.skeleton.bones[i].rest;
    model_from_bone.translate(Eigen::Vector3f(rest.translation));
    model_from_bone.scale(Eigen::Vector3f(rest.scale));
    Affine3f model_from_bind = Affine3f::Identity();
    model_from_bind.scale(0.01f);
    character.skins[0].bone_from_bind[i] = model_from_bone.inverse() * model_from_bind;
  }
  return character;
}

/// More bones than a signed byte can count, and a closed mesh without texture.
Character make_ball_of_many_bones() {
  Character character = make_bumpy_ball(800);
  rig_along(character, 130);
  return character;
}

}  // namespace

std::vector<OwnModel> make_own_models() {
  const SaveOptions floats, bytes{0, WeightFormat::unorm8}, shorts{0, WeightFormat::unorm16};
  std::vector<OwnModel> models;
  models.push_back({"tube.glb", make_tube(16, 12, 2), floats});
  models.push_back({"tube_weights_u8.glb", make_tube(16, 12, 2), bytes});
  models.push_back({"seamed_sheet.glb", make_seamed_sheet(), floats});
  models.push_back({"two_skins.glb", make_two_tubes(10, 10), floats});
  models.push_back({"six_influences.glb", make_tube_of_six_influences(), floats});
  models.push_back({"two_clips.glb", make_tube_of_two_clips(), floats});
  models.push_back({"scaled_bones.glb", make_tube_of_scaled_bones(), floats});
  models.push_back({"many_bones.glb", make_ball_of_many_bones(), shorts});
  return models;
}

}  // namespace sunder::test
