// Tissue with random fields and perforations, that yields, touches itself and tears by force.

#include <sunder/particles/force_tearing.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <bit>
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

std::vector<float> any_field(std::uint32_t count, Random& random) {
  std::vector<float> values;
  if (random.index(3) == 0) return values;
  for (std::uint32_t v = 0; v < count; ++v)
    values.push_back(static_cast<float>(test::any_scale(random, 2e-3, 500)));
  return values;
}

/// Places of one mesh, which need not lie next to one another.
Perforation any_perforation(const Character& character, Random& random) {
  Perforation made;
  made.strength = test::any_scale(random, 2e-3, 0.9);
  const std::uint32_t mesh = random.index(static_cast<std::uint32_t>(character.meshes.size()));
  const std::uint32_t triangles = character.meshes[mesh].triangle_count();
  for (std::uint32_t n = 2 + random.index(20); n > 0; --n) {
    const double a = random.uniform(0, 1), b = random.uniform(0, 1 - a);
    made.line.push_back({mesh, random.index(triangles), {a, b, 1 - a - b}});
  }
  if (random.index(3) == 0) made.line.push_back(made.line.front());
  return made;
}

AuthoredTissue any_authored(const Character& character, Random& random) {
  AuthoredTissue tissue;
  for (const Mesh& mesh : character.meshes) {
    const std::uint32_t count = mesh.vertex_count();
    TissueFactors& of = tissue.meshes.emplace_back();
    for (auto* field : {&of.strength, &of.toughness, &of.stiffness, &of.tension, &of.thickness})
      *field = any_field(count, random);
    if (mesh.triangle_count() > 0 && random.index(2) == 0)
      tissue.perforations.push_back(any_perforation(character, random));
  }
  return tissue;
}

SoftMaterial weak_material(Random& random) {
  SoftMaterial material;
  material.membrane_stiffness = test::any_scale(random, 1e-2, 1e3);
  material.strength = random.uniform(1.01, 2);
  if (random.index(2) == 0) material.toughness = test::any_scale(random, 1e-6, 1e2);
  if (random.index(2) == 0) material.yield_stretch = random.uniform(1.001, 1.5);
  material.plastic_limit = test::any_scale(random, 1e-2, 1e2);
  return material;
}

class Authored {
 public:
  explicit Authored(CaseReport& report) : report_(report) {}

  bool make(Character character, Random& random) {
    auto model = TornModel::create(std::make_shared<const Character>(std::move(character)));
    if (!model) return refuse(model.error());
    model_ = std::make_unique<TornModel>(std::move(*model));
    pose_ = *bind_pose(model_->source());
    auto set = ParticleSet::create(*model_, pose_, {test::any_scale(random, 0.05, 0.5)},
                                   any_authored(model_->source(), random));
    if (!set) return refuse(set.error());
    set_ = std::make_unique<ParticleSet>(std::move(*set));
    const SoftMaterial material = weak_material(random);
    SoftBodyOptions options;
    options.follow = random.index(2) == 0 ? Follow::ride : Follow::lag;
    if (random.index(3) > 0)
      options.self_contact = {test::any_scale(random, 1e-4, 0.1), random.uniform(0, 2)};
    auto body = SoftBody::create(*set_, pose_, {&material, 1}, options);
    if (!body) return refuse(body.error());
    body_ = std::make_unique<SoftBody>(std::move(*body));
    expect(body_->set_tension({test::any_scale(random, 1e-3, 1e2), {}}), "set_tension");
    return true;
  }

  void act(Random& random) {
    if (random.index(3) == 0) operate(random);
    if (random.index(4) == 0) pose_ = test::random_pose(model_->source(), random, 1);
    for (std::uint32_t n = random.index(4); n > 0; --n)
      // The body follows the set in its next step.
      expect(
          body_->set_force(random.index(std::min(body_->particle_count(), set_->particle_count())),
                           test::any_vector(random, 1e-6, 1e3)),
          "set_force");
    const double seconds = test::any_scale(random, 1e-4, 0.1);
    for (std::uint32_t n = 1 + random.index(6); n > 0; --n) {
      expect(body_->step(*model_, pose_, seconds), "step");
      tear(random);
    }
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
    ChangeRecord change;
    const bool is_done = random.index(4) == 0
                             ? static_cast<bool>(model_->undo(&change))
                             : static_cast<bool>(test::play(
                                   *model_, test::random_operation(*model_, random), &change));
    if (is_done) expect(set_->follow(*model_, {&change, 1}), "follow");
  }
  void tear(Random& random) {
    expect(body_->step(*model_, pose_, 0), "step");
    ForceTearingOptions options;
    options.length = random.uniform(0.05, 1);
    if (random.index(2) == 0) options.metres_per_second = test::any_scale(random, 1e-2, 10);
    if (random.index(3) == 0) options.least_piece_area = test::any_scale(random, 1e-6, 1);
    const auto torn = tear_overstretched(*body_, *set_, *model_, pose_, options);
    if (!torn) return expect(torn.error(), "tear_overstretched");
    if (!torn->has_torn) return;
    for (const std::string& fault : test::broken_particles(*model_, *set_))
      report_.violate("particles", fault);
  }
  void check() {
    const auto displacements = body_->displacements();
    for (std::uint32_t p = 0; p < displacements.size(); ++p)
      if (!displacements[p].allFinite() || !body_->velocity(p).allFinite())
        return report_.violate("finite motion",
                               say("particle ", p, " is at ", displacements[p].transpose()));
    for (const auto& displacement : displacements)
      for (int i = 0; i < 3; ++i)
        report_.mix(std::bit_cast<std::uint64_t>(static_cast<double>(displacement[i])));
    report_.mix(model_->digest());
  }

  CaseReport& report_;
  std::unique_ptr<TornModel> model_;
  ModelPose pose_;
  std::unique_ptr<ParticleSet> set_;
  std::unique_ptr<SoftBody> body_;
};

}  // namespace

void authored_tissue(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  Authored subject(report);
  if (!subject.make(test::random_character(random), random)) return;
  for (std::uint32_t step = 1; step <= 16 && report.violations.empty(); ++step) {
    if (!steps.has(step)) continue;
    Random numbers = random_of(seed, step);
    subject.act(numbers);
  }
}

}  // namespace sunder::stress
