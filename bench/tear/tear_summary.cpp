#include "bench/tear/tear_summary.h"

#include <cstdio>
#include <optional>

#include "bench/harness/in_turns.h"
#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/tear/cut_figures.h"
#include "bench/tear/model_memory.h"
#include "bench/tear/removal_times.h"
#include "bench/tear/repeated_operation.h"
#include "bench/tear/tear_stages.h"
#include "bench/tear/twenty_cuts.h"

#if SUNDER_BENCH_CGAL
#include "bench/peers/cgal_peer.h"
#endif

namespace sunder::bench {
namespace {

constexpr double kMicroseconds = 1e6, kNanoseconds = 1e9;

using Figures = std::array<double, kDivisions.size()>;  ///< By size.

std::vector<std::pair<std::string, double>> by_size(const Figures& values, double unit = 1) {
  std::vector<std::pair<std::string, double>> named;
  for (std::size_t i = 0; i < values.size(); ++i)
    named.emplace_back(size_name(kDivisions[i]), values[i] * unit);
  return named;
}

/// Medians of tears by size, and of CGAL's corefinement at the smallest and the largest, in
/// seconds.
struct Tears {
  Figures warm = {}, cold = {}, faces_crossed = {}, allocations = {}, undo_allocations = {};
  std::optional<double> cgal_smallest, cgal_largest;
};

Tears measure_tears() {
  std::vector<RepeatedOperation> tears;
  std::vector<Candidate> candidates;
  for (const int divisions : kDivisions) tears.emplace_back(scene_of(divisions), tear_along_stroke);
  for (RepeatedOperation& tear : tears)
    candidates.push_back({[&tear] { return tear.run(); }, {30, 0.5, 2}});
#if SUNDER_BENCH_CGAL
  CgalPeer smallest(scene_of(kSmallest)), largest(scene_of(kLargest));
  candidates.push_back({[&] { return smallest.corefine(); }, {10, 0.2, 2}});
  candidates.push_back({[&] { return largest.corefine(); }, {1, 0, 1}, 3, 0});
#endif
  measure_in_turns(candidates);
  Tears result;
  for (std::size_t i = 0; i < tears.size(); ++i) {
    result.warm[i] = median(candidates[i].seconds);
    result.faces_crossed[i] = tears[i].report.faces_crossed;
    result.allocations[i] = static_cast<double>(tears[i].allocations);
    result.undo_allocations[i] = static_cast<double>(tears[i].undo_allocations);
  }
#if SUNDER_BENCH_CGAL
  result.cgal_smallest = median(candidates[tears.size()].seconds);
  result.cgal_largest = median(candidates[tears.size() + 1].seconds);
#endif

  candidates.clear();
  for (RepeatedOperation& tear : tears)
    candidates.push_back({[&tear] { return tear.run(Caches::swept); }, {20, 0.5, 2}, 5, 0});
  measure_in_turns(candidates);
  for (std::size_t i = 0; i < tears.size(); ++i) result.cold[i] = median(candidates[i].seconds);
  return result;
}

/// Adds the figures of widths and bores.
void add_removals(JsonObject& object) {
  Figures width = {}, bore = {}, walled_bore = {};
  double worst = 0, allocations = 0, undo_allocations = 0;
  for (std::size_t i = 0; i < kDivisions.size(); ++i) {
    const RemovalTimes times = measure_removals(scene_of(kDivisions[i]));
    width[i] = times.width;
    bore[i] = times.bore;
    walled_bore[i] = times.walled_bore;
    worst = std::max({worst, times.width, times.bore});
    allocations = std::max(allocations, times.allocations);
    undo_allocations = std::max(undo_allocations, times.undo_allocations);
  }
  object.add("width_vs_tear", worst);
  object.add("width_vs_tear_by_size", by_size(width));
  object.add("bore_vs_tear_by_size", by_size(bore));
  object.add("walled_bore_vs_tear_by_size", by_size(walled_bore));
  object.add("width_allocations", allocations);
  object.add("width_undo_allocations", undo_allocations);
}

/// Seconds of the entry query at the largest size.
double measure_query() {
  StagedTear staged(scene_of(kLargest));
  return median(sample({100, 2}, [&] { return staged.run_query().query; }));
}

/// Seconds until a new model has done its first tear, at the largest size.
double measure_first_tear() {
  return median(sample({3, 20}, [] {
    const FirstTear first = time_first_tear(scene_of(kLargest));
    return first.create + first.tear;
  }));
}

/// Adds the figures of plane cuts.
void add_cuts(const CutFigures& cuts, JsonObject& object) {
  constexpr double kMilliseconds = 1e3;
  if (const auto plain = cuts.ratios_to_vtk(), capped = cuts.capped_ratios_to_vtk();
      plain && capped) {
    object.add("cut_vs_vtk", plain->back());
    object.add("cut_vs_vtk_by_size", by_size(*plain));
    object.add("capped_cut_vs_vtk", by_size(*capped));
  } else {
    object.add("cut_vs_vtk", std::nullopt);
    object.add("capped_cut_vs_vtk", std::nullopt);
  }
  Figures filling_ms = {};
  for (std::size_t i = 0; i < filling_ms.size(); ++i)
    filling_ms[i] = kMilliseconds * (cuts.capped_seconds[i] - cuts.seconds[i]);
  object.add("filling_ms", by_size(filling_ms));
  const TwentyCuts twenty = worst_of_twenty_cuts();
  object.add("twenty_cuts_faces", static_cast<double>(twenty.faces));
  object.add("twenty_cuts_slowest_ms", twenty.slowest_seconds * kMilliseconds);
}

}  // namespace

void print_removals() {
  JsonObject object;
  add_removals(object);
  object.end();
}

void print_summary() {
  const BytesPerPoint bytes = bytes_per_point(scene_of(kLargest));
  const Tears tears = measure_tears();
  const auto worst = [](const Figures& figures) {
    return *std::max_element(figures.begin(), figures.end());
  };
  const double faces = scene_of(kLargest).mesh().triangle_count(), query = measure_query(),
               first = measure_first_tear();
  const CutFigures cuts = measure_cuts();
  double nanoseconds_per_face = 0;
  Figures warm_us = {}, cold_us = {}, points = {};
  for (std::size_t i = 0; i < kDivisions.size(); ++i) {
    nanoseconds_per_face =
        std::max(nanoseconds_per_face, tears.warm[i] * kNanoseconds / tears.faces_crossed[i]);
    warm_us[i] = tears.warm[i] * kMicroseconds;
    cold_us[i] = tears.cold[i] * kMicroseconds;
    points[i] = scene_of(kDivisions[i]).mesh().vertex_count();
  }
  const auto by_tear = [](std::optional<double> peer, double tear) {
    return peer ? std::optional(*peer / tear) : std::nullopt;
  };
  JsonObject object;
  object.add("warm_growth_3k_900k", tears.warm.back() / tears.warm.front());
  object.add("speedup_cgal_3k", by_tear(tears.cgal_smallest, tears.warm.front()));
  object.add("speedup_cgal_900k", by_tear(tears.cgal_largest, tears.warm.back()));
  object.add("ns_per_crossed_face", nanoseconds_per_face);
  object.add("build_ns_per_face", (first - tears.warm.back()) * kNanoseconds / faces);
  object.add("bytes_per_point", bytes.model);
  object.add("posed_bytes_per_point", bytes.posed_points);
  object.add("warm_allocations", worst(tears.allocations));
  object.add("warm_undo_allocations", worst(tears.undo_allocations));
  add_removals(object);
  object.add("warm_us", by_size(warm_us));
  object.add("cold_us", by_size(cold_us));
  object.add("query_us_900k", query * kMicroseconds);
  add_cuts(cuts, object);
  object.add("faces_crossed", by_size(tears.faces_crossed));
  object.add("points", by_size(points));
  object.end();
}

}  // namespace sunder::bench
