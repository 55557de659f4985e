// Tissue in steps of any length, of any stiffness, on surfaces that operations change.

#include <sunder/particles/soft_body.h>
#include <sunder/skinning/pose.h>

#include <bit>
#include <cmath>
#include <memory>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/machine/say.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/particle_laws.h"

namespace sunder::stress {
namespace {

using test::Random;
using test::say;

/// Zero, or as likely in each decade.
double any_or_none(Random& random, double low, double high) {
  return random.index(4) == 0 ? 0.0 : test::any_scale(random, low, high);
}

SoftMaterial any_material(Random& random) {
  SoftMaterial material;
  material.return_frequency = any_or_none(random, 5e-3, 5e3);
  material.membrane_stiffness = any_or_none(random, 1e-3, 1e9);
  material.damping_ratio = any_or_none(random, 1e-3, 1e3);
  material.membrane_damping = any_or_none(random, 1e-3, 1e6);
  material.areal_density = test::any_scale(random, 1e-9, 1e3);
  if (random.index(3) == 0) material.stretch_limit = random.uniform(1, 3);
  return material;
}

/// A model whose points may all be in one place.
Character tissue_character(Random& random) {
  Character character = test::random_character(random);
  if (random.index(8) == 0)
    for (Mesh& mesh : character.meshes)
      for (Vec3f& position : mesh.positions) position = mesh.positions[0];
  return character;
}

/// A torn model with tissue.
class Tissue {
 public:
  explicit Tissue(CaseReport& report) : report_(report) {}

  /// @return whether the subject could be made; a fault of the interface is reported.
  bool make(Character character, Random& random) {
    auto model = TornModel::create(std::make_shared<const Character>(std::move(character)));
    if (!model) return refuse(model.error());
    model_ = std::make_unique<TornModel>(std::move(*model));
    pose_ = *bind_pose(model_->source());
    DecompositionOptions decomposition;
    decomposition.range = test::any_scale(random, 0.03, 1);
    auto set = ParticleSet::create(*model_, pose_, decomposition);
    if (!set) return refuse(set.error());
    set_ = std::make_unique<ParticleSet>(std::move(*set));
    const SoftMaterial material = any_material(random);
    SoftBodyOptions options;
    options.follow = random.index(2) == 0 ? Follow::ride : Follow::lag;
    auto body = SoftBody::create(*set_, pose_, {&material, 1}, options);
    if (!body) return refuse(body.error());
    body_ = std::make_unique<SoftBody>(std::move(*body));
    if (random.index(2) == 0)
      expect(body_->set_tension({test::any_scale(random, 1e-3, 1e6), {}, random.index(2) == 0}),
             "set_tension");
    if (random.index(2) == 0)
      expect(body_->set_gravity(test::any_vector(random, 1e-2, 1e4)), "set_gravity");
    return true;
  }

  void act(Random& random) {
    switch (random.index(6)) {
      case 0: operate(random); break;
      case 1: pose_ = test::random_pose(model_->source(), random, 2); break;
      case 2: {
        const Vec3d impulse = test::any_vector(random, 1e-9, 1e6);
        // A point that lost its faces is refused.
        (void)body_->add_point_impulse(random.index(set_->point_count()), impulse);
        break;
      }
      case 3: {
        const Vec3d force = test::any_vector(random, 1e-9, 1e9);
        expect(body_->set_force(random.index(body_->particle_count()), force), "set_force");
        break;
      }
      default: break;
    }
    const double seconds = test::any_scale(random, 1e-6, 10);
    for (std::uint32_t n = 1 + random.index(4); n > 0; --n)
      expect(body_->step(*model_, pose_, seconds), "step");
    ++report_.operations;
    check();
  }

 private:
  bool refuse(const Status& status) {
    ++report_.refused;
    if (status.code() != StatusCode::invalid_argument && status.code() != StatusCode::empty_input)
      expect(status, "create");
    return false;
  }
  void expect(const Status& status, const char* call) {
    if (!status) report_.violate("refusal", say(call, ": ", status.text()));
  }

  void operate(Random& random) {
    const std::uint32_t kind = random.index(4);
    ChangeRecord change;
    const bool is_done = kind == 0
                             ? static_cast<bool>(model_->undo(&change))
                             : static_cast<bool>(test::play(
                                   *model_, test::random_operation(*model_, random), &change));
    if (!is_done) return;
    expect(set_->follow(*model_, {&change, 1}), "follow");
    for (const std::string& fault : test::broken_particles(*model_, *set_))
      report_.violate("particles", fault);
  }

  void check() {
    const auto displacements = body_->displacements();
    for (std::uint32_t p = 0; p < displacements.size(); ++p)
      if (!displacements[p].allFinite())
        return report_.violate("finite motion",
                               say("particle ", p, " is at ", displacements[p].transpose()));
    for (std::uint32_t p = 0; p < body_->particle_count(); ++p)
      if (!body_->velocity(p).allFinite())
        return report_.violate("finite motion", say("particle ", p, " has no speed"));
    for (const auto& displacement : displacements)
      for (int i = 0; i < 3; ++i)
        report_.mix(std::bit_cast<std::uint64_t>(static_cast<double>(displacement[i])));
  }

  CaseReport& report_;
  std::unique_ptr<TornModel> model_;
  ModelPose pose_;
  std::unique_ptr<ParticleSet> set_;
  std::unique_ptr<SoftBody> body_;
};

}  // namespace

void moving_tissue(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  Tissue tissue(report);
  if (!tissue.make(tissue_character(random), random)) return;
  for (std::uint32_t step = 1; step <= 20 && report.violations.empty(); ++step) {
    if (!steps.has(step)) continue;
    Random numbers = random_of(seed, step);
    tissue.act(numbers);
  }
}

}  // namespace sunder::stress
