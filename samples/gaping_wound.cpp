// A wound that gapes as it was drawn: a hand cuts a sheet of skin along a line, and the tension
// that was planned along the line opens it, widest at a third of its length.

#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>
#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <vector>

namespace {

constexpr std::uint32_t kCells = 40;
constexpr float kCell = 0.01f;  // metres

std::shared_ptr<const sunder::Character> make_sheet() {
  sunder::Character character;
  character.name = "sheet";
  sunder::Bone root;
  root.name = "root";
  character.skeleton.bones.push_back(root);
  sunder::Skin skin;
  skin.bones.push_back(0);
  skin.bone_from_bind.push_back(sunder::Affine3f::Identity());
  character.skins.push_back(skin);
  sunder::Mesh mesh;
  mesh.name = "sheet";
  mesh.submeshes.push_back({"skin", sunder::kNone});
  for (std::uint32_t j = 0; j <= kCells; ++j)
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      mesh.positions.emplace_back(kCell * static_cast<float>(i), kCell * static_cast<float>(j),
                                  0.f);
      mesh.weights.append(std::vector<sunder::Influence>{{0, 1.0f}});
    }
  for (std::uint32_t j = 0; j < kCells; ++j)
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, c = a + kCells + 1;
      mesh.triangles.push_back({a, a + 1, c + 1});
      mesh.triangles.push_back({a, c + 1, c});
    }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character.meshes.push_back(mesh);
  return std::make_shared<const sunder::Character>(character);
}

/// A line of 12 cells with a place in each, and a gape that is closed at its ends.
sunder::WoundTarget make_target() {
  sunder::WoundTarget target;
  target.gape.clear();
  for (std::uint32_t i = 0; i <= 12; ++i) {
    target.places.push_back({0, {2 * (20 * kCells + 14 + i), {0.3, 0.3, 0.4}}});
    const double share = i / 12.0;
    target.gape.push_back(0.02 * std::sqrt(share) * (1 - share));
  }
  target.depth = {0.004};
  return target;
}

/// Tears the sheet and lets the planned tension open it. @return the widest gape, metres.
double open_wound(const std::shared_ptr<const sunder::Character>& sheet,
                  const sunder::WoundTarget& target, const sunder::PlanTiming& timing,
                  const sunder::PlannedMotion& planned) {
  const auto pose = sunder::make_pose(*sheet, timing.pose);
  const auto skin = sunder::find_material("skin");
  auto model = sunder::TornModel::create(sheet);
  if (!pose || !skin || !model) return 0;
  auto set = sunder::ParticleSet::create(*model, *pose, {0.015, false, 1});
  if (!set) return 0;
  auto body = sunder::SoftBody::create(*set, *pose, {&*skin, 1});
  std::vector<sunder::ChangeRecord> changes;
  if (!body || !apply_operation(*model, planned.tear, &changes)) return 0;
  if (!set->follow(*model, changes)) return 0;
  while (set->settle(*model)) continue;
  auto tension = tension_of_gape(target, timing, planned, *model, changes);
  if (!tension || !body->set_tension(*tension)) return 0;
  for (int i = 0; i < 600 && (i == 0 || body->awake_count() > 0); ++i)
    if (!body->step(*model, *pose, 1.0 / 30)) return 0;
  double widest = 0;
  for (const sunder::ChangeRecord& change : changes)
    for (const sunder::LipPair& lip : change.lips)
      widest = std::max(
          widest,
          (body->point_displacement(lip.left) - body->point_displacement(lip.right)).norm());
  return widest;
}

}  // namespace

int main() {
  const auto sheet = make_sheet();
  const sunder::WoundTarget target = make_target();
  sunder::PlanTiming timing;
  timing.pose = sunder::BindPose{};
  const auto hand = free_hand(sheet, target, timing, 0.08);
  if (!hand) return 1;
  const auto planned = plan_motion(sheet, target, timing, *hand);
  if (!planned) {
    std::printf("%s\n", planned.error().text().data());
    return 1;
  }
  if (!planned->report.is_reachable || !planned->report.gape) return 1;
  const sunder::PlannedGape& gape = *planned->report.gape;
  std::printf("along the wound, mm: wanted, planned, and the tension, N/m\n");
  for (std::size_t i = 0; i < gape.gape_along.size(); ++i)
    std::printf("%5.2f %5.2f %7.2f\n", 1000 * gape.wanted_along[i], 1000 * gape.gape_along[i],
                gape.tension * gape.tension_shares[i]);
  std::printf("off by %.2f mm at most\n", 1000 * gape.most_error);
  const double widest = open_wound(sheet, target, timing, *planned);
  std::printf("the wound of other particles gapes by %.2f mm\n", 1000 * widest);
  return std::abs(widest - gape.widest) < 0.2 * gape.widest ? 0 : 1;
}
