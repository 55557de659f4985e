#include "bench/stress/trouble_tables.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/plot.h"
#include "bench/stress/torn_subject.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder::stress {
namespace {

using test::Random;

/// A model, its operations and their times. Laws are checked when a row is printed.
class Trial {
 public:
  explicit Trial(Character character)
      : model_(*TornModel::create(std::make_shared<const Character>(std::move(character)))) {}

  [[nodiscard]] const TornModel& model() const { return model_; }

  void operate(const Operation& operation) {
    bool is_done = false;
    seconds_ += bench::cpu_seconds_of([&] { is_done = bool(test::play(model_, operation)); });
    ++(is_done ? done_ : refused_);
  }

  /// Prints a row and adds it to a plot. @param trouble  the size of the trouble.
  void print_row(double trouble, bench::Plot& plot) const {
    CaseReport report;
    measure(model_, report);
    const std::size_t broken = report.violations.size() + test::broken_laws(model_).size();
    const ModelPose bind = *bind_pose(model_.source());
    const auto errors = measure_weight_errors(model_, 0, kNone, {&bind, 1});
    const double posed_error = errors ? errors->of_diagonal.maximum : -1.0,
                 milliseconds = done_ > 0 ? 1e3 * seconds_ / static_cast<double>(done_) : 0;
    std::printf("| %.4g | %llu | %llu | %.1g | %.1g | %.1g | %.2g | %.3g | %zu |\n", trouble,
                static_cast<unsigned long long>(done_),
                static_cast<unsigned long long>(report.faces), report.area_drift,
                report.weight_sum_error, posed_error, report.smallest_angle, milliseconds, broken);
    std::fflush(stdout);
    plot.x.push_back(trouble);
    const std::array<double, 5> values = {posed_error, report.weight_sum_error, report.area_drift,
                                          report.smallest_angle, milliseconds};
    for (std::size_t i = 0; i < values.size(); ++i) plot.series[i].values.push_back(values[i]);
  }

 private:
  TornModel model_;
  double seconds_ = 0;
  std::uint64_t done_ = 0, refused_ = 0;
};

/// One table: the head is printed at its begin, the plot written at its end.
class Table {
 public:
  Table(const char* file, const char* title, const char* detail, const char* trouble,
        const std::filesystem::path& folder)
      : folder_(folder), file_(file) {
    plot_.title = std::string(title) + detail;
    plot_.of_x = trouble;
    for (const char* name :
         {"posed error", "weight sums", "area drift", "angle p1, degrees", "ms per operation"})
      plot_.series.push_back({name, {}});
    std::printf(
        "\n**%s**%s\n\n| %s | operations | faces | area drift | weight sums | posed error | angle "
        "p1 | ms per operation | broken laws |\n|---|---|---|---|---|---|---|---|---|\n",
        title, detail, trouble);
  }
  ~Table() {
    if (folder_.empty()) return;
    if (const auto path = folder_ / file_; !bench::write_svg(plot_, path))
      std::fprintf(stderr, "sunder-stress: cannot write \"%s\"\n", path.c_str());
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  [[nodiscard]] bench::Plot& plot() { return plot_; }

 private:
  std::filesystem::path folder_;
  const char* file_;
  bench::Plot plot_;
};

CutOperation random_cut(const Character& source, Random& random) {
  const ModelPose pose = test::random_pose(source, random, 0.3);
  const auto positions = test::posed_positions(source, 0, pose);
  PlaneCut cut;
  cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
  cut.normal = random.direction();
  return {pose, cut};
}

TearOperation tear_on_a_side(const Character& source, const Vec3d& side, Random& random) {
  TearOperation tear;
  const ModelPose pose = test::random_pose(source, random, 0.3);
  tear.pose = pose;
  for (int tries = 0; tries < 50; ++tries) {
    tear.stroke = test::random_stroke(source, pose, random, 0.1, 3);
    if (tear.stroke[0].base.normalized().dot(side) > 0.9) break;
  }
  return tear;
}

template <class Make>
void print_sequence(Character character, std::initializer_list<int> counts, Make make,
                    bench::Plot& plot) {
  Trial trial(std::move(character));
  int done = 0;
  for (const int count : counts) {
    for (; done < count; ++done) trial.operate(make(trial.model().source()));
    trial.print_row(count, plot);
  }
}

/// Twenty operations on a tube that was scaled and moved.
void print_moved(double scale, double offset, double trouble, bench::Plot& plot) {
  Random random(7);
  Character tube = test::make_tube(12, 10, 3);
  for (Vec3f& position : tube.meshes[0].positions)
    position = (scale * (position.cast<double>() + Vec3d(offset, 0, 0))).cast<float>();
  Trial trial(std::move(tube));
  const ModelPose pose = *bind_pose(trial.model().source());
  for (int i = 0; i < 20; ++i) {
    CutOperation cut = random_cut(trial.model().source(), random);
    const auto positions = test::posed_positions(trial.model().source(), 0, pose);
    cut.cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    cut.pose = pose;
    trial.operate(cut);
  }
  trial.print_row(trouble, plot);
}

/// Planes that pass a ring of vertices at a distance, one after another from both sides.
void print_near_planes(double distance, bench::Plot& plot) {
  Trial trial(test::make_tube(12, 10, 3));
  const ModelPose pose = *bind_pose(trial.model().source());
  const auto positions = test::posed_positions(trial.model().source(), 0, pose);
  for (int i = 0; i < 20; ++i) {
    CutOperation cut;
    cut.pose = pose;
    cut.cut.normal = Vec3d(0, 1, 0);
    cut.cut.point = positions[static_cast<std::size_t>(10 + 5 * i)] +
                    Vec3d(0, i % 2 == 0 ? distance : -distance, 0);
    trial.operate(cut);
  }
  trial.print_row(distance, plot);
}

}  // namespace

void print_trouble_tables(const std::filesystem::path& folder) {
  Random random(1);
  {
    Table table("stability_cuts.svg", "Successive cuts", " of a tube, in random poses", "cuts",
                folder);
    print_sequence(
        test::make_tube(12, 12, 4), {1, 3, 10, 30, 100, 300},
        [&](const Character& source) { return random_cut(source, random); }, table.plot());
  }
  {
    Table table("stability_region.svg", "Tears of one region",
                " of a ball of 7,200 faces, in random poses", "tears", folder);
    const Vec3d side = random.direction();
    print_sequence(
        test::make_bumpy_ball(3485), {1, 10, 100, 300, 1000},
        [&](const Character& source) { return tear_on_a_side(source, side, random); },
        table.plot());
  }
  {
    Table table("stability_scale.svg", "Scale", ": twenty cuts of a tube of 3 m, scaled", "scale",
                folder);
    for (const double scale : {1e-4, 1e-2, 1.0, 1e2, 1e4})
      print_moved(scale, 0, scale, table.plot());
  }
  {
    Table table("stability_offset.svg", "Distance from the origin",
                ": twenty cuts of a tube of 3 m", "metres", folder);
    for (const double offset : {0.0, 1e1, 1e2, 1e3, 1e4, 1e5})
      print_moved(1, offset, offset, table.plot());
  }
  Table table("stability_near.svg", "Planes next to vertices", " of a tube of 3 m, at a distance",
              "metres", folder);
  for (const double distance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-12, 1e-16, 0.0})
    print_near_planes(distance, table.plot());
}

}  // namespace sunder::stress
