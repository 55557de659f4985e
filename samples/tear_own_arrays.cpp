// A character from arrays of one's own, without any file: a tube of two bones, bent at the elbow
// and torn along its front.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

namespace {

constexpr std::uint32_t kAround = 16, kAlong = 20;

/// One metre up, bones from 0 to 0.5 m and from there to 1 m; the ends are open.
sunder::Mesh make_tube() {
  sunder::Mesh mesh;
  mesh.name = "Tube";
  for (std::uint32_t ring = 0; ring <= kAlong; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kAround;
      const float height = static_cast<float>(ring) / kAlong;
      mesh.positions.emplace_back(0.15f * std::sin(angle), height, 0.15f * std::cos(angle));
      mesh.normals.emplace_back(std::sin(angle), 0.0f, std::cos(angle));
      // The upper bone takes over within 0.2 m around the elbow. Weights that are zero are left
      // out.
      const float upper = std::clamp((height - 0.4f) / 0.2f, 0.0f, 1.0f);
      const sunder::Influence both[] = {{0, 1.0f - upper}, {1, upper}};
      if (upper == 0.0f)
        mesh.weights.append({both, 1});
      else if (upper == 1.0f)
        mesh.weights.append({both + 1, 1});
      else
        mesh.weights.append(both);
    }
  for (std::uint32_t ring = 0; ring < kAlong; ++ring)
    for (std::uint32_t i = 0; i < kAround; ++i) {
      const std::uint32_t a = ring * kAround + i, b = ring * kAround + (i + 1) % kAround;
      mesh.triangles.push_back({a, b, b + kAround});
      mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  mesh.submeshes.push_back({"Rubber", sunder::kNone});
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  return mesh;
}

sunder::Character make_character() {
  sunder::Character character;
  sunder::BoneTransform at_elbow;
  at_elbow.translation = {0, 0.5f, 0};
  character.skeleton.bones = {{"lower", sunder::kNone, {}}, {"upper", 0, at_elbow}};
  // At bind the bones stand as at rest: bone_from_bind undoes that.
  sunder::Affine3f upper_from_bind = sunder::Affine3f::Identity();
  upper_from_bind.translation() = -at_elbow.translation;
  character.skins = {{"Tube", {0, 1}, {sunder::Affine3f::Identity(), upper_from_bind}}};
  character.meshes = {make_tube()};
  return character;
}

}  // namespace

int main() {
  const auto character = std::make_shared<const sunder::Character>(make_character());
  if (const sunder::Status status = validate_character(*character); !status)
    return std::printf("%s\n", status.text().data()), 1;

  sunder::Pose pose = local_rest_pose(*character);
  pose.parent_from_bone[1].rotation =
      sunder::Quatf(Eigen::AngleAxisf(0.8f, Eigen::Vector3f::UnitX()));
  sunder::ModelPose model_pose;
  if (const sunder::Status status = compute_model_pose(character->skeleton, pose, model_pose);
      !status)
    return 1;

  auto torn = sunder::TornModel::create(character);
  if (!torn) return std::printf("%s\n", torn.error().text().data()), 1;
  const sunder::Stroke stroke = {{{0.02, 0.25, 0.5}, {0.02, 0.25, 0.0}},
                                 {{0.01, 0.40, 0.5}, {0.01, 0.40, 0.0}},
                                 {{-0.03, 0.55, 0.6}, {-0.03, 0.55, 0.1}}};
  const auto report = torn->tear(model_pose, stroke);
  if (!report) return std::printf("%s\n", report.error().text().data()), 1;

  const sunder::TopologyCounts before = count_topology(*character),
                               after = count_topology(torn->character());
  std::printf("segments %u, faces crossed %u, length %.3f m\n", report->segments,
              report->faces_crossed, report->length_posed);
  std::printf("points %u -> %u, triangles %u -> %u, boundary loops %u -> %u\n", before.points,
              after.points, before.triangles, after.triangles, before.boundary_loops,
              after.boundary_loops);
  return report->runs > 0 && after.boundary_loops == before.boundary_loops + 1 ? 0 : 1;
}
