#pragma once

namespace sunder::bench {

/// Measures the cost of tears in a few minutes, all candidates in turns, and prints one JSON object
/// to stdout.
void print_summary();

/// `bench_tear --widths`: those figures of the summary that compare widths and bores with the tear.
void print_removals();

/// Explains the figures of the summary.
inline constexpr const char* kSummaryHelp =
    "bench_tear [--summary | --table | --cuts | --widths] [options of Google Benchmark: --help]\n"
    "\n"
    "Without --summary: all benchmarks. Each time is a median of up to 300 runs; the last word of "
    "a name says how often each face "
    "of\n"
    "the base model was divided (1, 3, 7, 16: about 3.5, 31, 171 and 892 thousand points).\n"
    "\n"
    "--summary prints one JSON object. The tear is the same at each size: across about 100 faces. "
    "Times are medians.\n"
    "  warm_growth_3k_900k   time of a warm tear at 892 thousand points by that at 3.5 thousand\n"
    "  speedup_cgal_3k, speedup_cgal_900k\n"
    "                        time of CGAL's corefine() with what the stroke sweeps, by that of a "
    "warm tear; null without CGAL\n"
    "  ns_per_crossed_face   warm tear, at the size where it is largest\n"
    "  build_ns_per_face     (create() + first tear - warm tear) by faces, at 892 thousand points\n"
    "  bytes_per_point       held beyond the copy of the character after a first tear, at 892 "
    "thousand points\n"
    "  warm_allocations      calls of operator new in a warm tear, at the size where they are "
    "most\n"
    "  warm_undo_allocations the same of undo()\n"
    "  width_vs_tear         time of a tear with a width, or of a bore without a wall whose rim "
    "crosses as many faces, by that\n"
    "                        of the plain tear of the same stroke, in turns; the worst of both and "
    "of all sizes\n"
    "  width_vs_tear_by_size, bore_vs_tear_by_size, walled_bore_vs_tear_by_size\n"
    "                        the same by size; the walled bore has half the radius\n"
    "  width_allocations, width_undo_allocations\n"
    "                        calls of operator new in a warm width or bore, and in its undo(); the "
    "most\n"
    "  warm_us, cold_us      by size; cold: 64 MB walked before each\n"
    "  query_us_900k         where the stroke enters the surface, in a fresh pose\n"
    "  cut_vs_vtk            time of a plane cut without caps, in two with pieces named, by that "
    "of vtkPolyDataPlaneClipper, "
    "which\n"
    "                        keeps one side; at 892 thousand points; null without VTK\n"
    "  cut_vs_vtk_by_size    the same at each size; absent without VTK\n"
    "  capped_cut_vs_vtk     the same with caps, by size\n"
    "  filling_ms            the share of the caps: time with them minus that without them\n"
    "  twenty_cuts_faces, twenty_cuts_slowest_ms\n"
    "                        after twenty cuts with caps across a tube of 7,344 faces, the most "
    "of twelve seeds, and the slowest cut\n"
    "  faces_crossed, points by size\n"
    "\n"
    "--cuts prints one JSON object about plane cuts alone, by size: cut_vs_vtk and "
    "capped_cut_vs_vtk, their\n"
    "times in microseconds, and the allocations of a cut and its undo.\n"
    "\n"
    "--table prints medians by operation and size.\n"
    "--widths prints the figures of the summary that compare widths and bores with the plain "
    "tear.\n";

}  // namespace sunder::bench
