// Masks of wounds that follow operations, undo and redo.

#include <sunder/skinning/pose.h>
#include <sunder/tear/wound_mask.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;

constexpr std::uint32_t kSteps = 60, kCheckEvery = 10;

WoundMaskOptions random_options(Random& random) {
  WoundMaskOptions options;
  options.width = 8 + random.index(56);
  options.height = 8 + random.index(56);
  options.reach = random.uniform(0.02, 0.3);
  options.dilation = 1 + random.index(4);
  return options;
}

bool are_same(std::span<const float> a, std::span<const float> b) {
  return std::ranges::equal(a, b, [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  });
}

/// A model and the mask that follows it.
class MaskSubject {
 public:
  MaskSubject(TornModel model, const WoundMaskOptions& options, CaseReport& report)
      : report_(report), options_(options), model_(std::move(model)) {
    auto mask = WoundMask::create(model_, 0, options_);
    if (mask)
      mask_.emplace(std::move(*mask));
    else
      report_.violate("mask", std::string(mask.error().text()));
  }

  [[nodiscard]] bool has_failed() const { return !report_.violations.empty(); }
  [[nodiscard]] TornModel& model() { return model_; }

  /// Lets the mask follow what was done. Texels outside of the rectangle must stay.
  void follow(const ChangeRecord& change) {
    ++report_.operations;
    const std::vector<float> before(mask_->distances().begin(), mask_->distances().end());
    const auto changed = mask_->update(model_, change);
    if (!changed) return report_.violate("update", std::string(changed.error().text()));
    for (std::uint32_t i = 0; i < before.size(); ++i) {
      const float now = mask_->distances()[i];
      if (!std::isfinite(now) || !(std::abs(now) <= static_cast<float>(options_.reach)))
        return report_.violate("mask", "texel " + std::to_string(i) + " is beyond the reach");
      const std::uint32_t x = i % options_.width - changed->left,
                          y = i / options_.width - changed->top;
      if ((x >= changed->width || y >= changed->height) && before[i] != now)
        return report_.violate("rectangle", "texel " + std::to_string(i) + " is outside of it");
    }
  }

  /// The mask must be that which is painted as a whole, and so must the blood that runs.
  void compare_with_whole(const ModelPose& pose) {
    const auto whole = WoundMask::create(model_, 0, options_);
    if (!whole) return report_.violate("mask", std::string(whole.error().text()));
    if (!are_same(whole->distances(), mask_->distances()))
      report_.violate("mask", "differs from one that is painted as a whole");
    BloodFlowOptions flow;
    flow.length = 2 * options_.reach;
    flow.width = 0.3 * options_.reach;
    flow.spacing = options_.reach;
    const auto followed = mask_->flow(model_, pose, flow), anew = whole->flow(model_, pose, flow);
    if (!followed || !anew || !are_same(*followed, *anew))
      report_.violate("flow", "differs from that of a mask that is painted as a whole");
    for (const float distance : whole->distances())
      report_.mix(std::bit_cast<std::uint32_t>(distance));
  }

 private:
  CaseReport& report_;
  WoundMaskOptions options_;
  TornModel model_;
  std::optional<WoundMask> mask_;
};

void act(MaskSubject& subject, Random& random, CaseReport& report) {
  TornModel& model = subject.model();
  ChangeRecord change;
  const std::uint32_t choice = random.index(5);
  Status status;
  if (choice == 0 && model.undo_count() > 0)
    status = model.undo(&change);
  else if (choice == 1 && model.redo_count() > 0)
    status = model.redo(&change);
  else
    status = test::play(model, test::random_operation(model, random), &change).error();
  if (status)
    subject.follow(change);
  else
    ++report.refused;
}

}  // namespace

void followed_masks(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  const Character character = test::random_character(random);
  if (character.meshes[0].uv_sets.empty()) return;
  auto model = TornModel::create(std::make_shared<const Character>(character));
  if (!model) return report.violate("model", std::string(model.error().text()));
  MaskSubject subject(std::move(*model), random_options(random), report);
  for (std::uint32_t step = 1; step <= kSteps && !subject.has_failed(); ++step) {
    if (!steps.has(step)) continue;
    Random of_step = random_of(seed, step);
    act(subject, of_step, report);
    if (step % kCheckEvery == 0 && !subject.has_failed())
      subject.compare_with_whole(test::random_pose(character, of_step, 0.3));
  }
}

}  // namespace sunder::stress
