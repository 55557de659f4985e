// Limits of memory and size.

#include <sunder/skinning/pose.h>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/machine/allocation_count.h"
#include "support/machine/say.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;

/// A sheet of squares whose last ones are left out, so that it has exactly this many vertices.
Character sheet_of(std::uint32_t vertices) {
  std::uint32_t cells = 1;
  while ((cells + 1) * (cells + 1) < vertices) ++cells;
  Character character = test::make_sheet(cells);
  Mesh& mesh = character.meshes[0];
  std::vector<Triangle> kept;
  std::vector<std::uint32_t> submesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (a >= vertices || b >= vertices || c >= vertices) continue;
    kept.push_back(mesh.triangles[t]);
    submesh.push_back(mesh.triangle_submesh[t]);
  }
  mesh.triangles = std::move(kept);
  mesh.triangle_submesh = std::move(submesh);
  mesh.positions.resize(vertices);
  if (!mesh.normals.empty()) mesh.normals.resize(vertices);
  if (!mesh.tangents.empty()) mesh.tangents.resize(vertices);
  for (auto& set : mesh.uv_sets) set.resize(vertices);
  for (auto& set : mesh.color_sets) set.resize(vertices);
  mesh.weights.influences.resize(mesh.weights.first[vertices]);
  mesh.weights.first.resize(vertices + 1);
  return character;
}

/// One operation with memory for `count` allocations.
/// @return whether that was enough.
bool operate_with(TornModel& model, const Operation& operation, std::uint64_t count,
                  CaseReport& report) {
  const std::uint64_t before = model.digest();
  Status status;
  {
    const test::FailingAllocations failing(count);
    status = test::play(model, operation).error();
  }
  if (status) return true;
  ++report.allocation_failures;
  if (status.code() == StatusCode::invalid_argument) return true;  // not for want of memory
  if (status.code() != StatusCode::limit_exceeded)
    report.violate("refusal", std::string(status.text()));
  if (model.digest() != before)
    report.violate("failing call changes nothing", test::say("after ", count, " allocations"));
  return false;
}

}  // namespace

void every_capacity(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornCapacity capacity;
  const auto most = static_cast<std::uint32_t>(test::any_scale(random, 1, 3000));
  capacity.vertices = random.index(most + 1);
  capacity.triangles = random.index(2 * most + 1);
  capacity.operations = 1 + random.index(8);
  TornSubject subject(test::random_character(random), report, capacity);
  subject.accept(StatusCode::capacity_exceeded);
  run_steps(subject, seed, steps, 8, [](TornSubject& of, Random& numbers, std::uint32_t) {
    of.operate(test::random_operation(of.model(), numbers));
  });
}

void failing_allocations(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  if (!test::FailingAllocations::are_possible()) return;
  Random random = random_of(seed, 0);
  const auto source = std::make_shared<const Character>(test::random_character(random));
  auto fed = TornModel::create(source), starved = TornModel::create(source);
  if (!fed || !starved) return report.violate("create", "refused");
  for (std::uint32_t step = 1; step <= 3 && report.violations.empty(); ++step) {
    if (!steps.has(step)) continue;
    Random numbers = random_of(seed, step);
    const Operation operation = test::random_operation(*fed, numbers);
    (void)test::play(*fed, operation);
    // The first allocations one by one, later ones in growing strides.
    std::uint64_t count = 0;
    while (!operate_with(*starved, operation, count, report)) {
      count += 1 + count / 64;
      if (count > 1'000'000) return report.violate("memory", "there was never enough");
    }
    ++report.operations;
    report.mix(fed->digest());
    if (fed->digest() != starved->digest())
      report.violate("memory", "another state after failures");
  }
}

void vertex_counts(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  TornSubject subject(sheet_of(65'534 + static_cast<std::uint32_t>(seed % 4)), report);
  run_steps(subject, seed, steps, 3, [](TornSubject& of, Random& numbers, std::uint32_t) {
    of.operate(test::random_operation(of.model(), numbers));
  });
}

}  // namespace sunder::stress
