// Measures particles on one thread: dividing a surface into particles, following a tear, and a step
// of their motion.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <span>

#include "bench/harness/in_turns.h"
#include "bench/harness/json_object.h"
#include "bench/particles/particles_decompose.h"
#include "bench/particles/particles_errors.h"
#include "bench/particles/particles_fields.h"
#include "bench/particles/particles_membrane.h"
#include "bench/particles/particles_oracle.h"
#include "bench/particles/particles_repair.h"
#include "bench/particles/particles_steps.h"
#include "bench/particles/particles_surface.h"
#include "bench/particles/particles_sutures.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_particles [--summary | --surfaces | --gaps | --oracle | --fields | --sutures | --errors "
    "[FILE.svg]]\n"
    "\n"
    "The bunny with 1, 2, 3, 7 and 16 divisions per edge, on 64 bones. Medians, candidates in\n"
    "turns, one thread.\n"
    "\n"
    "Decomposition: the whole of ParticleSet::create(): posing, distances along the surface,\n"
    "memberships, weights, neighbours, rest sums. Compared with nanoflann's tree and Eigen's scan\n"
    "of all points, which get posed points and only make clusters of the same radius in a "
    "straight\n"
    "line. Our particles are more, because a cluster covers all points within the radius, a\n"
    "particle only those within 85 % of it.\n"
    "Repair: ParticleSet::follow() after a tear across about 100 faces, all calls of settle() "
    "after\n"
    "it, and follow() after the undo; the tear itself is not counted. 'first': follow() after the\n"
    "first tear of a set, once.\n"
    "Steps: a SoftBody at 60 steps per second, every bone moving. The time that displacing all\n"
    "vertices adds to skinning has a column of its own.\n"
    "\n"
    "Gaps: the width of a slit in a sheet, under tension, against finite elements.\n"
    "Errors: displacement, gap and length of such a slit against the range of particles, over six\n"
    "orders of their seeds; not among the tables by default.\n"
    "\n"
    "Oracle: gap and displacement of such slits in curved surfaces, on uneven meshes and of two\n"
    "materials, against biquadratic finite elements on grids of their own; mesh and range refined\n"
    "together, over six orders of seeds; not among the tables by default.\n"
    "\n"
    "Fields: such a slit in tissue that varies from place to place, against finite elements with "
    "the\n"
    "same fields, over six orders of seeds; not among the tables by default.\n"
    "\n"
    "Sutures: the gap of a sewn slit between its threads, against finite elements; not among the\n"
    "tables by default.\n"
    "\n"
    "Prints tables. --surfaces prints the table of displaced surfaces alone, --gaps that of gaps,\n"
    "--oracle that of the oracle, --fields that of fields, --sutures that of sutures, --errors "
    "that of errors, and draws it "
    "as SVG,\n"
    "--summary prints one JSON object instead.\n"
    "  bunny_decompose_ms      ParticleSet::create() of 3,485 points, range a tenth of the "
    "diagonal\n"
    "  bunny_particles         number of its particles\n"
    "  step_200_ms             a step of about 200 particles that are all awake, and displacing "
    "14\n"
    "                          thousand vertices by them, without skinning itself\n"
    "  repair_ms_900k          follow() at 892 thousand points, range a tenth of the diagonal; "
    "the\n"
    "                          same tear again and again, so without first allocations\n"
    "  repair_growth_3k_900k   that time / the same at 3.5 thousand points\n"
    "  asleep_us               a step of those 200 particles when all sleep, in an unchanged pose\n"
    "  normal_p99_degrees      99th percentile of the angle between displaced normals and faces, "
    "the\n"
    "                          worst of the surfaces whose lips gape by a tenth of the range; "
    "left\n"
    "                          out without the shared bunny\n"
    "  tangent_dot_max         the largest |n . t| of displaced normals and tangents\n"
    "  gap_d_ratio             the widest gap of a slit of 0.4 m over the narrowest, at ranges of "
    "0.2,\n"
    "                          0.1 and 0.05 m\n"
    "  gap_asymmetry           its largest difference between x and -x, by the width, at 0.1 m\n"
    "  ellipse_rms             difference of a slit on a very weak foundation from an ellipse, by "
    "its\n"
    "                          width; half the slit is four ranges\n"
    "  reference_rms_at_200    difference of the gap of a slit of 0.25 m from finite elements, by "
    "its\n"
    "                          width, with 200 particles\n"
    "  convergence_order       of the difference of the gap, from 0.2 m to 0.05 m\n"
    "  griffith_load_spread    of the load at which a slit runs on, over ranges and meshes\n"
    "  field_gap_error         the largest difference of the gap, or of the load of a tip, of a "
    "slit "
    "in\n"
    "                          varying tissue from finite elements, at ranges of 0.1 and 0.05 m\n"
    "  suture_gap_error        the largest difference of the widest gap between the threads of a "
    "sewn\n"
    "                          slit from finite elements, relative\n"
    "  perforation_follow_m    the greatest distance from a wavy perforation of the lips of a tear "
    "that "
    "runs\n"
    "                          along it, range 0.1 m, cells of 0.01 m\n"
    "  self_contact_ratio      a step in which lips are pressed together, all particles awake, "
    "with\n"
    "                          self-contact / without\n"
    "  vs_nanoflann            bunny_decompose_ms / nanoflann's time for its tree and clusters;\n"
    "                          null if it is not built\n";

constexpr double kMilliseconds = 1e3, kMicroseconds = 1e6, kNanoseconds = 1e9;

void print_decomposition(const DecompositionFigures& figures) {
  const DecompositionReport& report = figures.report;
  const auto memberships = static_cast<double>(report.memberships);
  std::printf("%-8s %8u %9u %12.2f %5u %8.2f %6.1f %6.0f   %8.2f %8zu", figures.name.c_str(),
              report.points, report.particles, memberships / report.points, report.most_memberships,
              figures.seconds * kMilliseconds, figures.seconds * kNanoseconds / memberships,
              figures.bytes / report.points, figures.scan.search * kMilliseconds,
              figures.scan.clusters);
  if (figures.nanoflann) {
    const DecompositionFigures::Peer& peer = *figures.nanoflann;
    std::printf("   %8.2f %8.2f %8zu %6.2f %8.2f\n", peer.build * kMilliseconds,
                peer.search * kMilliseconds, peer.clusters,
                static_cast<double>(peer.memberships) / report.points, *figures.vs_nanoflann());
  } else {
    std::printf("   nanoflann is absent\n");
  }
  std::fflush(stdout);
}

void print_decompositions() {
  std::printf(
      "Decomposition, range %g of the diagonal. Ours: along the surface, with weights, neighbours "
      "and rest sums. Eigen, nanoflann: "
      "clusters in a straight line alone.\n",
      kRange);
  std::printf("%60s %25s   %41s\n", "", "Eigen's scan", "nanoflann");
  std::printf(
      "model      points particles  memberships  most       ms     ns  bytes         ms clusters   "
      "build ms     find clusters  "
      "memb. ours/its\n");
  for (const int divisions : kDivisions)
    print_decomposition(measure_decomposition(size_name(divisions), scene_of(divisions).model(),
                                              scene_of(divisions).poses[0],
                                              divisions == kSmallest  ? 51
                                              : divisions == kLargest ? 3
                                                                      : 9));
  if (const auto cactus = measure_cactus(51)) print_decomposition(*cactus);
  std::printf("memberships, bytes: per point; ns: per membership.\n\n");
}

void print_repairs(double (*range)(int divisions)) {
  std::printf(
      "  points particles  members faces   follow us    first  settle us calls  longest  undo us  "
      "bytes per point\n");
  std::vector<RepeatedRepair> repairs;
  std::vector<Candidate> candidates;
  for (const int divisions : kDivisions)
    repairs.emplace_back(scene_of(divisions), range(divisions));
  for (RepeatedRepair& repair : repairs)
    candidates.push_back({[&repair] { return repair.run(); }, {20, 1, 2}, 5, 1});
  measure_in_turns(candidates);
  for (const RepeatedRepair& repair : repairs) {
    const RepeatedRepair::Figures figures = repair.figures();
    std::printf("%8u %9u %8.0f %5u %11.1f %8.1f %10.1f %5.0f %8.1f %8.1f %14.0f\n", figures.points,
                figures.particles, figures.members, figures.faces_crossed,
                figures.follow * kMicroseconds, figures.first * kMicroseconds,
                figures.settle * kMicroseconds, figures.settle_calls,
                figures.longest_settle_call * kMicroseconds, figures.undo * kMicroseconds,
                figures.bytes / figures.points);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void print_step(const StepFigures& figures) {
  std::printf("%9u %8u %10.1f %9.1f %11.1f %9.1f %12.1f %9.3f %13.3f\n", figures.particles,
              figures.vertices, figures.neighbours, figures.step * kMicroseconds,
              figures.displace * kMicroseconds, figures.frame * kMicroseconds,
              figures.plain_deform * kMicroseconds, figures.asleep * kMicroseconds,
              figures.asleep_moving * kMicroseconds);
  std::fflush(stdout);
}

void print_surfaces() {
  std::printf(
      "Displaced surfaces: lips that gape, their walls, and the skin around them. Angles in "
      "degrees beyond those at rest.\n"
      "surface   gap / range   normals p99    worst   |n . t|   jump between faces\n");
  for (const SurfaceFigures& figures : measure_surfaces())
    std::printf("%-8s %12.2f %13.2f %8.2f %9.1e %20.2f\n", figures.name.c_str(), figures.gap,
                figures.surface.normal_p99, figures.surface.normal_worst,
                figures.surface.tangent_dot, figures.surface.jump);
  std::printf("\n");
  std::fflush(stdout);
}

void print_gap(const char* name, const GapFigures& of) {
  std::printf("%-8s %8.3f %9u %9.1f %9.4f %10.4f %7.3f %7.1f %10.1f\n", name, of.range,
              of.particles, of.step_seconds * kMicroseconds, of.widest, of.reference_widest,
              of.widest / of.reference_widest, 100 * of.rms, 100 * of.asymmetry);
}

void print_gaps() {
  std::printf(
      "Gaps of a slit in a sheet of one metre, 1.2 N/m, against finite elements; m. RMS and "
      "asymmetry in percent of the width.\n"
      "slit        range particles   step us     width  reference   ratio     RMS  asymmetry\n");
  for (const GapFigures& figures : measure_gaps()) print_gap("0.4 m", figures);
  print_gap("0.25 m", measure_gap_at_200());
  std::printf("\n");
  std::fflush(stdout);
}

void print_errors(const std::vector<ErrorFigures>& errors) {
  std::printf(
      "Errors of a slit of 0.4 m in a sheet of one metre, 320 x 320 cells, 1.2 N/m, against finite "
      "elements, percent;\nroot mean squares over six orders of seeds.\n"
      "  range particles   step us   displacement: RMS   greatest     gap   from    to  asymmetry  "
      " "
      "length\n");
  for (const ErrorFigures& of : errors)
    std::printf("%7.3f %9.0f %9.1f %19.2f %10.1f %7.2f %6.3f %5.3f %10.1f %8.2f\n", of.range,
                of.particles, of.step_seconds * kMicroseconds, 100 * of.displacement, 100 * of.most,
                100 * of.gap, of.least_gap, of.greatest_gap, 100 * of.asymmetry, 100 * of.length);
  std::printf("displacement falls with the range to the power %.2f\n", order_of(errors));
}

void print_fields() {
  std::printf(
      "Slits of 0.4 m in varying tissue under 1.2 N/m, 160 x 160 cells, against finite elements "
      "with "
      "the same fields, percent;\nmeans over six orders of seeds. Load: at which a tip runs on.\n"
      "%-38s range    width     gap    load\n",
      "field");
  for (const FieldFigures& of : measure_fields()) {
    std::printf("%-38s %5.2f %8.2f %7.2f", of.name.c_str(), of.range, 100 * of.width, 100 * of.rms);
    if (of.has_load)
      std::printf(" %7.2f\n", 100 * of.load);
    else
      std::printf("       -\n");
  }
}

/// The largest difference at the finer ranges.
double field_gap_error() {
  double largest = 0;
  for (const FieldFigures& of : measure_fields())
    if (of.range < 0.15)
      largest = std::max({largest, std::abs(of.width), of.has_load ? std::abs(of.load) : 0.0});
  return largest;
}

void print_perforation() {
  const PerforationFigures of = measure_perforation();
  std::printf(
      "A slit that runs on along a wavy perforation: %.2g m from it at most, %.1f %% of it torn\n",
      of.follow, 100 * of.length);
  std::printf("A step with lips pressed together, with self-contact / without: %.2f\n",
              measure_self_contact_ratio());
}

void print_sutures() {
  std::printf(
      "Sewn slits of 0.6 m under 1.2 N/m, 160 x 160 cells: the widest gap between threads by that "
      "of the open slit, and\nits difference from finite elements, percent; means over three "
      "orders "
      "of seeds.\n"
      "range spacing   thread   sewn    error\n");
  for (const SutureFigures& of : measure_sutures())
    std::printf("%5.2f %7.2f %8.1f %6.1f %8.2f\n", of.range, of.spacing, of.stiffness,
                100 * of.sewn, 100 * of.error);
}

double suture_gap_error() {
  double largest = 0;
  for (const SutureFigures& of : measure_sutures()) largest = std::max(largest, std::abs(of.error));
  return largest;
}

void print_oracle(const std::vector<OracleCase>& cases) {
  std::printf(
      "Slits of 0.4 m under 1.2 N/m against biquadratic finite elements, percent; mean over six "
      "orders of seeds +- standard\ndeviation of one. Width: of the widest gap by the reference's; "
      "elements: the same of linear elements on our mesh.\nGap, displacement: root mean squares by "
      "the widest gap and by half of it. Order: of the displacement, by the range.\n"
      "surface                      cells range particles  elements          width             gap "
      "  "
      "displacement\n");
  for (const OracleCase& of : cases) {
    for (const OracleFigures& at : of.refined) {
      std::printf("%-28s %5u %5.2f %9.0f ", of.name.c_str(), at.cells, at.range, at.particles);
      if (at.elements_width > 0)
        std::printf("%9.1f", 100 * at.elements_width);
      else
        std::printf("%9s", "-");
      std::printf("  %6.1f +- %4.1f   %5.2f +- %4.2f   %5.2f +- %4.2f\n", 100 * at.width.mean,
                  100 * at.width.deviation, 100 * at.gap.mean, 100 * at.gap.deviation,
                  100 * at.displacement.mean, 100 * at.displacement.deviation);
    }
    std::printf("%-28s order %.2f; the reference on half as fine a grid: %.2f %% off\n", "",
                of.order, 100 * of.reference_error);
  }
  std::fflush(stdout);
}

constexpr std::uint32_t kStepped = 200;
constexpr int kSteppedDivisions = 2;

void print_tables() {
  print_decompositions();
  std::printf("Repair after a tear, range %g of the diagonal at every size\n", kRange);
  print_repairs([](int) { return kRange; });
  std::printf(
      "Repair after a tear, range %g of the diagonal by the divisions: about as many members at "
      "every size\n",
      kRange);
  print_repairs([](int divisions) { return kRange / divisions; });
  std::printf(
      "A step, dt = 1/60, us. Awake: every particle, pushed every tenth frame. 'displace': time "
      "that it adds to skinning.\n");
  std::printf(
      "particles vertices neighbours      step    displace      both  plain skin.    asleep  "
      "asleep, moved\n");
  for (const std::uint32_t particles : {100u, kStepped, 1000u})
    print_step(measure_steps(kSteppedDivisions, particles, 300));
  print_step(measure_steps(7, 10000, 60));
  print_surfaces();
  print_gaps();
}

void add_gaps(JsonObject& object) {
  const std::vector<GapFigures> gaps = measure_gaps();
  const auto width = [](const GapFigures& of) { return of.widest; };
  const std::span<const GapFigures> coarse = std::span(gaps).first(3);
  object.add("gap_d_ratio", std::ranges::max(coarse, {}, width).widest /
                                std::ranges::min(coarse, {}, width).widest);
  object.add("gap_asymmetry", gaps[1].asymmetry);
  object.add("ellipse_rms", measure_ellipse_rms());
  object.add("reference_rms_at_200", measure_gap_at_200().rms);
  object.add("convergence_order", std::log2(gaps[0].rms / gaps[2].rms) / 2);
  object.add("griffith_load_spread", measure_griffith_load_spread());
}

void print_summary() {
  const DecompositionFigures bunny = measure_decomposition(
      size_name(kSmallest), scene_of(kSmallest).model(), scene_of(kSmallest).poses[0], 301);
  RepeatedRepair small(scene_of(kSmallest), kRange), large(scene_of(kLargest), kRange);
  std::vector<Candidate> repairs;
  for (RepeatedRepair* repair : {&small, &large})
    repairs.push_back({[repair] { return repair->run(); }, {20, 1, 2}, 5, 1});
  measure_in_turns(repairs);
  const double small_follow = median(repairs[0].seconds), large_follow = median(repairs[1].seconds);
  const StepFigures steps = measure_steps(kSteppedDivisions, kStepped, 600);
  JsonObject object;
  object.add("bunny_decompose_ms", bunny.seconds * kMilliseconds);
  object.add("bunny_particles", bunny.report.particles);
  object.add("step_200_ms", steps.frame * kMilliseconds);
  object.add("repair_ms_900k", large_follow * kMilliseconds);
  object.add("repair_growth_3k_900k", large_follow / small_follow);
  object.add("asleep_us", steps.asleep * kMicroseconds);
  double normals = 0, tangents = 0;
  for (const SurfaceFigures& of : measure_surfaces()) {
    tangents = std::max(tangents, of.surface.tangent_dot);
    if (of.wanted_gap < 0.2) normals = std::max(normals, of.surface.normal_p99);
  }
  if (scene_of(kSmallest).character->name == "bunny") object.add("normal_p99_degrees", normals);
  object.add("tangent_dot_max", tangents);
  add_gaps(object);
  object.add("field_gap_error", field_gap_error());
  object.add("suture_gap_error", suture_gap_error());
  object.add("perforation_follow_m", measure_perforation().follow);
  object.add("self_contact_ratio", measure_self_contact_ratio());
  object.add("vs_nanoflann", bunny.vs_nanoflann());
  object.end();
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  if (argc == 1) {
    sunder::bench::print_tables();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--summary") == 0) {
    sunder::bench::print_summary();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--surfaces") == 0) {
    sunder::bench::print_surfaces();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--gaps") == 0) {
    sunder::bench::print_gaps();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--fields") == 0) {
    sunder::bench::print_fields();
    sunder::bench::print_perforation();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--sutures") == 0) {
    sunder::bench::print_sutures();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--oracle") == 0) {
    sunder::bench::print_oracle(sunder::bench::measure_against_oracle(6));
    return 0;
  }
  if ((argc == 2 || argc == 3) && std::strcmp(argv[1], "--errors") == 0) {
    const auto errors = sunder::bench::measure_errors();
    sunder::bench::print_errors(errors);
    if (argc == 2 || sunder::bench::write_errors_picture(errors, argv[2])) return 0;
    std::fprintf(stderr, "bench_particles: cannot write \"%s\"\n", argv[2]);
    return 1;
  }
  const bool asked = argc == 2 && std::strcmp(argv[1], "--help") == 0;
  std::fputs(sunder::bench::kHelp, asked ? stdout : stderr);
  return asked ? 0 : 2;
}
