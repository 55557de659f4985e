#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "bench/stress/case_report.h"

namespace sunder::stress {

/// Cases of one kind. A case is found again by its family and its seed.
struct Family {
  std::string_view name;
  std::string_view subject;     ///< In one line: what is tried.
  bool is_adversarial = false;  ///< Aims at degenerate places; otherwise random.
  std::uint32_t share = 1;      ///< Of a run without a choice of families.
  void (*run)(std::uint64_t seed, const Steps& steps, CaseReport& report) = nullptr;
};

[[nodiscard]] std::span<const Family> families();
/// Null if there is no family of this name.
[[nodiscard]] const Family* find_family(std::string_view name);
/// The family and seed of the case with a number.
[[nodiscard]] CaseName case_of(std::uint64_t number, std::span<const Family* const> chosen);

/// If it is not 0, all scenes get this number of threads; otherwise 1 to 4.
extern std::uint32_t threads_of_scenes;

using CaseFunction = void(std::uint64_t seed, const Steps& steps, CaseReport& report);

// Operations on one model (model_cases.cpp).
CaseFunction random_operations, hard_operations, cracked_bodies, scaled_and_shifted, hard_poses;
// Planes that meet vertices and edges, and one another (plane_cases.cpp).
CaseFunction planes_at_vertices, plane_bundles, plane_stacks;
// Strokes that turn, return and end at difficult places (stroke_cases.cpp).
CaseFunction winding_strokes, retraced_strokes, strokes_that_end_anywhere, far_turns, long_strokes,
    tiny_strokes;
// Long sequences (sequence_cases.cpp).
CaseFunction many_cuts, one_region, welded_wounds;
// Limits of memory and size (limit_cases.cpp).
CaseFunction every_capacity, failing_allocations, vertex_counts;
// Weights, tissue, scenes, files (weight_cases.cpp, tissue_cases.cpp, …).
CaseFunction singular_refits, moving_tissue, authored_tissue, busy_scenes, models_in_files;

// Masks of wounds (mask_cases.cpp).
CaseFunction followed_masks;

}  // namespace sunder::stress
