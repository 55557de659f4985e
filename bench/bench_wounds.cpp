// What it costs to keep the wounds in a texture in step with tears, how far a mask is from brute
// force, and what it costs to close wounds again.

#include <sunder/skinning/pose.h>
#include <sunder/tear/wound_mask.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/tear/weld_figures.h"
#include "support/machine/random.h"
#include "support/models/atlas_tube.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/wound_distances.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kSize = 1024, kRings = 160, kSides = 120;
constexpr double kReach = 0.01;      ///< Metres; the tube is three metres long.
constexpr std::size_t kFaces = 100;  ///< Of a stroke, about.
constexpr double kLeast = 0.7, kMost = 1.4;

WoundMask mask_of(const TornModel& model, std::uint32_t size, double reach) {
  WoundMaskOptions options;
  options.width = options.height = size;
  options.reach = reach;
  return std::move(*WoundMask::create(model, 0, options));
}

struct Figures {
  std::vector<double> update_ms, undo_ms, texels, faces;
  double create_ms = 0;
};

/// Tears of about a hundred faces, each undone again, and what following them takes.
Figures measure_updates() {
  const Character tube = test::make_atlas_tube(kRings, kSides);
  TornModel model = test::make_model(tube);
  const ModelPose pose = *bind_pose(tube);
  Figures figures;
  const double seconds = seconds_of([&] { (void)mask_of(model, kSize, kReach); });
  figures.create_ms = 1e3 * seconds;
  WoundMask mask = mask_of(model, kSize, kReach);
  test::Random random(1);
  for (int tries = 0; figures.update_ms.size() < 60 && tries < 1000; ++tries) {
    const Stroke stroke = test::random_stroke(tube, pose, random, 0.35);
    ChangeRecord change;
    const auto report = model.tear(pose, stroke, {}, &change);
    if (!report || report->runs == 0) continue;
    const bool is_of_size =
        report->faces_crossed > kLeast * kFaces && report->faces_crossed < kMost * kFaces;
    TexelRectangle painted;
    const double update = seconds_of([&] { painted = *mask.update(model, change); });
    ChangeRecord back;
    if (!model.undo(&back)) break;
    const double undo = seconds_of([&] { (void)*mask.update(model, back); });
    if (!is_of_size) continue;
    figures.update_ms.push_back(1e3 * update);
    figures.undo_ms.push_back(1e3 * undo);
    figures.texels.push_back(double{1} * painted.width * painted.height);
    figures.faces.push_back(report->faces_crossed);
  }
  return figures;
}

/// The largest difference from brute force over the texels near lips of some models, in texels.
double largest_error() {
  constexpr std::uint32_t kSmall = 128;
  constexpr double kSmallReach = 0.4;
  double largest = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    test::Random random(seed);
    const Character tube = test::make_atlas_tube(6 + random.index(8), 6 + random.index(8));
    TornModel model = test::make_model(tube);
    for (int i = 0; i < 3; ++i)
      if (!test::play(model, test::random_tear(model, random, false))) return NAN;
    const WoundMask mask = mask_of(model, kSmall, kSmallReach);
    const std::vector<double> wanted = test::brute_force_wound(model, 0, kSmall, kSmall, 24);
    const double texel = test::texel_size(tube.meshes[0], kSmall);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if (wanted[i] >= 0)
        largest = std::max(largest, std::abs(static_cast<double>(mask.distances()[i]) -
                                             std::min(wanted[i], kSmallReach)) /
                                        texel);
  }
  return largest;
}

void run(bool is_summary) {
  const Figures figures = measure_updates();
  const double error = largest_error();
  const WeldFigures welds = measure_welds();
  if (is_summary) {
    JsonObject json;
    json.add("mask_ms_1024", median(figures.update_ms));
    json.add("mask_undo_ms_1024", median(figures.undo_ms));
    json.add("mask_create_ms_1024", figures.create_ms);
    json.add("mask_rectangle_share", median(figures.texels) / (double{kSize} * kSize));
    json.add("mask_error_texels", error);
    json.add("weld_ms", welds.weld_ms);
    json.add("weld_vs_tear", welds.vs_tear);
    json.add("weld_position_error", welds.position_error);
    json.add("weld_position_error_barycentric", welds.position_error_barycentric);
    json.add("weld_open_share", welds.open_share);
    return json.end();
  }
  std::printf(
      "a texture of %u x %u on a tube of %u x %u faces, reach %g m; %zu strokes of %g faces\n",
      kSize, kSize, kRings, kSides, kReach, figures.update_ms.size(), median(figures.faces));
  std::printf("  whole texture   %8.2f ms\n", figures.create_ms);
  std::printf("  after a stroke  %8.3f ms, worst %.3f ms\n", median(figures.update_ms),
              *std::ranges::max_element(figures.update_ms));
  std::printf("  after its undo  %8.3f ms, worst %.3f ms\n", median(figures.undo_ms),
              *std::ranges::max_element(figures.undo_ms));
  std::printf("  rectangle       %8.2f %% of the texture\n",
              100 * median(figures.texels) / (double{kSize} * kSize));
  std::printf("  largest difference from brute force, at 128 x 128: %.3f texels\n", error);
  std::printf("welds of such strokes: %.3f ms, %.2f x their tears; %.0f %% stay open\n",
              welds.weld_ms, welds.vs_tear, 100 * welds.open_share);
  std::printf("  from the untorn surface %.2g diagonals, with barycentric weights %.2g\n",
              welds.position_error, welds.position_error_barycentric);
}

}  // namespace
}  // namespace sunder::bench

int main(int count, char** arguments) {
  sunder::bench::run(count > 1 && std::strcmp(arguments[1], "--summary") == 0);
  return 0;
}
