// Which motion makes this wound? A hand follows a curve across a strip of skin while it bends; the
// wound that the motion makes is compared with the curve, and the trajectory is printed.

#include <sunder/plan/plan.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>

namespace {

constexpr std::uint32_t kColumns = 24, kRows = 12;
constexpr float kCell = 0.02f;  // metres

/// A bone at one end of the strip, and one in its middle that turns up within a second.
void add_skeleton(sunder::Character& character) {
  sunder::Skin skin;
  for (std::uint32_t i = 0; i < 2; ++i) {
    sunder::Bone bone;
    bone.name = i == 0 ? "root" : "half";
    bone.parent = i == 0 ? sunder::kNone : 0;
    const float along = i == 0 ? 0.0f : kCell * kColumns / 2;
    bone.rest.translation = sunder::Vec3f(along, 0, 0);
    character.skeleton.bones.push_back(bone);
    skin.bones.push_back(i);
    sunder::Affine3f bone_from_bind = sunder::Affine3f::Identity();
    bone_from_bind.translation() = sunder::Vec3f(-along, 0, 0);
    skin.bone_from_bind.push_back(bone_from_bind);
  }
  character.skins.push_back(skin);
  sunder::Channel turn;
  turn.target = sunder::ChannelTarget::rotation;
  turn.index = 1;
  turn.width = 4;
  turn.times = {0, 1};
  turn.values = {0, 0, 0, 1, 0, -std::sin(0.4f), 0, std::cos(0.4f)};
  character.clips.push_back({"Bend", 1.0f, {turn}});
}

std::shared_ptr<const sunder::Character> make_strip() {
  sunder::Character character;
  character.name = "strip";
  add_skeleton(character);
  sunder::Mesh mesh;
  mesh.name = "strip";
  mesh.submeshes.push_back({"skin", sunder::kNone});
  for (std::uint32_t j = 0; j <= kRows; ++j)
    for (std::uint32_t i = 0; i <= kColumns; ++i) {
      mesh.positions.emplace_back(kCell * static_cast<float>(i), kCell * static_cast<float>(j),
                                  0.f);
      const float share = static_cast<float>(i) / static_cast<float>(kColumns);
      if (i == 0)
        mesh.weights.append(std::vector<sunder::Influence>{{0, 1.0f}});
      else if (i == kColumns)
        mesh.weights.append(std::vector<sunder::Influence>{{1, 1.0f}});
      else
        mesh.weights.append(std::vector<sunder::Influence>{{0, 1.0f - share}, {1, share}});
    }
  for (std::uint32_t j = 0; j < kRows; ++j)
    for (std::uint32_t i = 0; i < kColumns; ++i) {
      const std::uint32_t a = j * (kColumns + 1) + i, c = a + kColumns + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character.meshes.push_back(mesh);
  return std::make_shared<const sunder::Character>(character);
}

/// In the middle of the first triangle of a cell.
sunder::SurfaceAnchor in_cell(std::uint32_t column, std::uint32_t row) {
  return {0, {2 * (row * kColumns + column), {0.3, 0.3, 0.4}}};
}

}  // namespace

int main() {
  const auto strip = make_strip();
  sunder::WoundTarget target;
  target.places = {in_cell(4, 3), in_cell(10, 8), in_cell(15, 4), in_cell(20, 7)};
  target.depth = {0.004};
  target.angle = {1.2};
  sunder::PlanTiming timing;
  timing.pose = sunder::ClipPose{"Bend", 0};
  timing.clip_speed = 0.5;
  const auto hand = free_hand(strip, target, timing, 0.08);
  if (!hand) return 1;
  const auto planned = plan_motion(strip, target, timing, *hand);
  if (!planned) {
    std::printf("%s\n", planned.error().text().data());
    return 1;
  }
  const sunder::PlanReport& report = planned->report;
  if (!report.is_reachable) return 1;
  std::printf("a curve of %.1f cm is cut within %.2f mm, %.2f mm on average\n",
              100 * report.curve_length, 1000 * report.hausdorff, 1000 * report.mean_distance);
  for (const sunder::ValueMargin& value : report.values)
    std::printf("%-7s from %7.4f to %7.4f\n", value.name.c_str(), value.least, value.greatest);

  auto model = sunder::TornModel::create(strip);
  if (!model) return 1;
  const auto torn = apply_operation(*model, planned->tear);
  if (!torn) return 1;
  std::printf("%u runs, %u faces crossed\n", torn->runs, torn->faces_crossed);
  return torn->runs > 0 ? 0 : 1;
}
