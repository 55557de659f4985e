// A scalpel is guided over a bending tube: a cursor follows the surface, touch and cutting forces
// are computed at 1 kHz between frames, and before each tear a preview says what it would do.

#include <sunder/scene/character_instance.h>
#include <sunder/tear/blade_force.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/preview.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "samples/tube.h"

namespace {

constexpr double kRadius = 0.15;                 ///< Of the tube, metres.
constexpr sunder::CuttingResistance kTissue = {  // J/m^2, metres, N/m, N
    2000, 0.002, 20, 30};

/// The blade at a time in seconds: it comes down, draws a line along the tube, and leaves.
sunder::Blade blade_at(double seconds) {
  const double down =
      std::clamp(seconds / 0.2, 0.0, 1.0) - std::clamp((seconds - 0.8) / 0.2, 0.0, 1.0);
  const double along = 0.3 + 0.2 * std::clamp((seconds - 0.2) / 0.6, 0.0, 1.0);
  const double tip = kRadius + 0.03 - 0.04 * down;
  return {{0.01, along, tip + 0.1}, {0.01, along, tip}};
}

struct Feedback {
  double length_torn = 0;  ///< Per frame, metres.
  double frame_motion = 0;
  double greatest = 0;  ///< Newtons.
  int touches = 0;
};

/// One frame of the haptic loop: 16 queries of the pose of the frame.
sunder::Status feel(double seconds, sunder::SurfaceQuery& query, Feedback& feedback) {
  std::vector<sunder::SurfaceContact> contacts;
  for (int i = 0; i < 16; ++i) {
    const sunder::Blade now = blade_at(seconds + 0.001 * i),
                        next = blade_at(seconds + 0.001 * (i + 1));
    if (const sunder::Status status = query.find_blade_contacts(now, contacts); !status)
      return status;
    if (contacts.empty()) continue;
    ++feedback.touches;
    // The tear of the last frame, per metre that the blade moved in it, holds until the next one.
    const sunder::Vec3d motion = next.tip - now.tip;
    const double per_metre =
        feedback.frame_motion > 0 ? feedback.length_torn / feedback.frame_motion : 0;
    const auto force =
        sunder::blade_force(kTissue, {per_metre * motion.norm(), contacts[0].depth, motion});
    if (!force) return force.error();
    feedback.greatest = std::max(feedback.greatest, force->newtons);
  }
  return {};
}

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

}  // namespace

int main() {
  const auto character = std::make_shared<const sunder::Character>(samples::make_tube({32, 60}));
  sunder::CharacterAssetOptions options;
  options.soft.emplace();
  auto instance = sunder::CharacterInstance::create(character, options);
  if (!instance) return fail("create", instance.error());
  if (const auto status = instance->prepare_to_tear(); !status) return fail("prepare", status);
  auto query = sunder::SurfaceQuery::create(*instance->model());
  if (!query) return fail("query", query.error());

  const sunder::ModelPose pose = samples::bent(*character, 0.2);
  if (const auto status = instance->begin_stroke(pose, blade_at(0)); !status)
    return fail("stroke", status);
  Feedback feedback;
  double torn = 0;
  int above = 0;
  for (int frame = 1; frame <= 60; ++frame) {
    const double seconds = frame / 60.0;
    const sunder::Blade blade = blade_at(seconds);
    const auto report = instance->extend_stroke(pose, blade);
    if (!report) return fail("extend", report.error());
    torn += report->length_posed;
    feedback.length_torn = report->length_posed;
    feedback.frame_motion = (blade.tip - blade_at(seconds - 1 / 60.0).tip).norm();
    if (const auto status = instance->advance(pose, 1.0 / 60); !status)
      return fail("advance", status);
    const sunder::VertexDisplacements displacements[] = {instance->displacements(0)};
    sunder::ContactOptions contact;
    contact.displacements = displacements;
    if (const auto status = query->set_pose(pose, contact); !status) return fail("pose", status);
    const auto cursor =
        query->cast_ray({blade.base, blade.tip - blade.base, (blade.tip - blade.base).norm()});
    if (!cursor) return fail("cursor", cursor.error());
    if (*cursor) ++above;
    if (const auto status = feel(seconds, *query, feedback); !status) return fail("feel", status);
  }
  const auto end = instance->end_stroke();
  if (!end) return fail("end", end.error());
  std::printf("torn: %.3f m; the blade reached the surface in %d of 60 frames\n", torn, above);
  std::printf("the blade touched in %d of 960 steps and felt at most %.2f N\n", feedback.touches,
              feedback.greatest);

  const sunder::Stroke across = {{{-0.05, 0.6, 0.3}, {-0.05, 0.6, 0.1}},
                                 {{0.05, 0.6, 0.3}, {0.05, 0.6, 0.1}}};
  const auto preview = sunder::preview_tear(*instance->model(), pose, across);
  if (!preview) return fail("preview", preview.error());
  std::printf("a stroke across would cross %u faces over %.3f m in the skin of %zu bones\n",
              preview->report.faces_crossed, preview->report.length_posed, preview->bones.size());
  const auto report = instance->tear(pose, across);
  if (!report) return fail("tear", report.error());
  const bool is_as_said = report->faces_crossed == preview->report.faces_crossed &&
                          report->length_posed == preview->report.length_posed;
  const bool is_felt = torn > 0.1 && feedback.touches > 100 && feedback.greatest > 1;
  std::puts(is_as_said && is_felt ? "it was so" : "it was NOT so");
  return is_as_said && is_felt ? 0 : 1;
}
