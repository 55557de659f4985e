#include "bench/transfer/transfer_figures.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "bench/harness/measure.h"
#include "support/models/changed_surfaces.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

Character torn(const Character& source) {
  auto model = TornModel::create(std::make_shared<const Character>(source));
  if (!model) std::abort();
  test::Random random(1);
  const ModelPose pose = *rest_pose(source);
  for (int i = 0; i < 8; ++i)
    (void)model->tear(pose, test::random_stroke(source, pose, random), {});
  return model->character();
}

double squared_distances(const Character& a, const Character& b, const ModelPose& pose) {
  double sum = 0;
  for (std::uint32_t m = 0; m < a.meshes.size(); ++m) {
    const auto of_a = test::posed_positions(a, m, pose), of_b = test::posed_positions(b, m, pose);
    for (std::size_t v = 0; v < of_a.size(); ++v) sum += (of_a[v] - of_b[v]).squaredNorm();
  }
  return sum;
}

}  // namespace

std::vector<TransferCase> transfer_cases(const Character& source) {
  std::vector<TransferCase> cases = {{"self", source}, {"subdivided", test::subdivided(source)}};
  for (const double share : {0.005, 0.01, 0.02, 0.04})
    cases.push_back({"shell " + std::to_string(100 * share).substr(0, 3) + " %",
                     test::offset_shell(source, share)});
  cases.push_back({"decimated", test::decimated(source, 24)});
  cases.push_back({"torn", torn(source)});
  return cases;
}

TransferFigures measure_transfer(const Character& source, const Character& truth,
                                 const TransferOptions& options) {
  Character target = truth;
  for (Mesh& mesh : target.meshes) {
    const std::vector<Influence> one = {{0, 1.0f}};
    mesh.weights = {};
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(one);
  }
  TransferFigures figures;
  Result<TransferResult> result = Status();
  figures.seconds = seconds_of([&] { result = transfer_weights(source, target, options); });
  if (!result) {
    std::fprintf(stderr, "%.255s\n", result.error().text().data());
    return figures;
  }
  figures.matched = result->matched_share();
  const Character& found = result->character;
  double count = 0;
  for (std::uint32_t m = 0; m < truth.meshes.size(); ++m)
    for (std::uint32_t v = 0; v < truth.meshes[m].vertex_count(); ++v, ++count)
      figures.l1 += test::weight_distance(found, m, v, truth, m, v);
  figures.l1 /= count;
  constexpr int kPoses = 20;
  test::Random random(2);
  double squares = 0;
  for (int i = 0; i < kPoses; ++i) {
    ModelPose pose = test::random_pose(truth, random, 0.6, 1.0);
    squares += squared_distances(found, truth, pose);
  }
  figures.rms =
      std::sqrt(squares / (kPoses * count)) / test::posed_diagonal(truth, *rest_pose(truth));
  return figures;
}

}  // namespace sunder::bench
