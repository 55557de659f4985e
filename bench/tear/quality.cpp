// Measures the faces of a model after a thousand random tears: their number, and their smallest
// angles in bind space. Prints a JSON object: a run of tears without width, and one in which every
// other tear has a width; of the bunny, or of a ball where no file is there.
//
//   bench_quality [model file]
#include <sunder/io/character_file.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/models/rigs.h"
#include "support/oracles/face_quality.h"

namespace sunder {
namespace {

constexpr int kTears = 1000;

/// The bunny is one rigid part; four bones along it let it bend.
Character model_or_ball(const std::string& file) {
  if (std::filesystem::exists(file)) {
    auto loaded = load_character(file);
    if (!loaded) {
      std::fprintf(stderr, "%s: %s\n", file.c_str(), std::string(loaded.error().text()).c_str());
      std::exit(1);
    }
    Character character = *loaded->character;
    if (character.skeleton.bones.size() < 3) test::rig_along(character, 4);
    return character;
  }
  std::fprintf(stderr, "%s is not there: a procedural ball of 3,486 points instead\n",
               file.c_str());
  return test::make_bumpy_ball(3486);
}

void print_quality(const char* name, const test::FaceQuality& quality) {
  std::printf(
      "\"%s\": {\"faces\": %zu, \"faces_without_area\": %zu, \"smallest_angle_percentiles\": ",
      name, quality.smallest_angles.size(), quality.faces_without_area);
  std::printf("{\"0\": %.3g, \"1\": %.4g, \"5\": %.4g, \"50\": %.4g}}", quality.angle_at(0),
              quality.angle_at(0.01), quality.angle_at(0.05), quality.angle_at(0.5));
}

void run(const std::string& file, bool has_widths) {
  auto model = TornModel::create(std::make_shared<const Character>(model_or_ball(file)));
  if (!model) std::exit(1);
  const test::FaceQuality before = test::face_quality(*model);
  const std::uint32_t points_before = model->point_count();
  test::Random random(1);
  TearReport sum;
  int did_something = 0;
  double seconds = 0;
  for (int i = 0; i < kTears; ++i) {
    const ModelPose pose = test::random_pose(model->source(), random, 0.4, 1.1);
    const double length = random.uniform(0.02, 0.3);
    const Stroke stroke =
        test::random_stroke(model->source(), pose, random, length, 1 + random.index(6));
    TearOptions options;
    if (has_widths && i % 2 == 1)
      options.width = random.uniform(0.001, 0.01) * test::posed_diagonal(model->source(), pose);
    const auto begin = std::chrono::steady_clock::now();
    const auto report = model->tear(pose, stroke, options);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!report) std::exit(1);
    did_something += report->runs > 0 ? 1 : 0;
    sum.blocked += report->blocked;
    sum.faces_crossed += report->faces_crossed;
    sum.triangles_retired += report->triangles_retired;
  }
  std::printf("{\"tears\": %d, \"with_width\": %d, ", kTears, has_widths ? kTears / 2 : 0);
  print_quality("before", before);
  std::printf(", ");
  print_quality("after", test::face_quality(*model));
  std::printf(", \"points_before\": %u, \"points_after\": %u, \"faces_crossed\": %u, ",
              points_before, model->point_count(), sum.faces_crossed);
  std::printf("\"tears_that_tore\": %d, \"places_blocked\": %u, \"seconds\": %.3f}", did_something,
              sum.blocked, seconds);
}

}  // namespace
}  // namespace sunder

int main(int argc, char** argv) {
  const std::string file = argc > 1 ? argv[1] : SUNDER_SHARED_MODELS "/static/bunny_3485.off";
  std::printf("{\"%s\": {\"plain\": ", std::filesystem::exists(file) ? "model" : "ball");
  sunder::run(file, false);
  std::printf(",\n \"widths\": ");
  sunder::run(file, true);
  std::printf("}}\n");
}
