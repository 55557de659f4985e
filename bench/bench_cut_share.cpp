// The share of hard plane cuts of closed bodies that are right, per family of planes and program:
// both sides closed and oriented, with the area and the volume of an exact clip.
// Usage: bench_cut_share [cuts per family] [--faults]
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <string>

#include "bench/cut_share/cut_sides.h"
#include "support/oracles/side_oracle.h"
#if SUNDER_BENCH_CGAL
#include "bench/peers/cgal_clip_peer.h"
#endif
#if SUNDER_BENCH_VTK
#include "bench/peers/vtk_clip_peer.h"
#endif

namespace sunder::bench {
namespace {

struct Program {
  const char* name;
  std::function<std::optional<CutSidesOfAll>(const std::vector<test::HardCut>&)> cut;
};

std::vector<Program> programs() {
  std::vector<Program> all = {{"Sunder", cut_by_sunder}};
#if SUNDER_BENCH_CGAL
  all.push_back({"CGAL", cut_by_cgal});
#endif
  all.push_back({"Manifold", cut_by_manifold});
#if SUNDER_BENCH_VTK
  all.push_back({"VTK", cut_by_vtk});
#endif
  return all;
}

std::string fault_of(const std::optional<CutSides>& sides, const test::HardCut& cut,
                     const test::ExactSides& exact) {
  if (!sides) return "failed";
  for (std::size_t side = 0; side < 2; ++side)
    if (std::string fault = fault_of_side((*sides)[side], true, side, exact, cut.point);
        !fault.empty())
      return fault;
  return {};
}

void print_share(const Program& program, test::PlaneFamily family,
                 const std::vector<test::HardCut>& cuts, const std::vector<test::ExactSides>& exact,
                 bool with_faults) {
  const auto sides = program.cut(cuts);
  if (!sides) {
    std::printf(" %10s", "absent");
    return;
  }
  std::size_t right = 0;
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const std::string fault = fault_of((*sides)[i], cuts[i], exact[i]);
    right += fault.empty() ? 1 : 0;
    if (with_faults && !fault.empty())
      std::fprintf(stderr, "%s, %s, seed %zu, %s: %s\n", program.name, name_of(family), i,
                   cuts[i].body_name, fault.c_str());
  }
  std::printf(" %8.1f %%", 100.0 * static_cast<double>(right) / static_cast<double>(cuts.size()));
}

void print_table(std::size_t count, bool with_faults) {
  const std::vector<Program> all = programs();
  std::printf("%-18s", "plane");
  for (const Program& program : all) std::printf(" %10s", program.name);
  std::printf("\n");
  for (const test::PlaneFamily family : test::kPlaneFamilies) {
    std::vector<test::HardCut> cuts;
    std::vector<test::ExactSides> exact;
    for (std::size_t seed = 0; seed < count; ++seed) {
      test::Random random(seed);
      cuts.push_back(random_hard_cut(family, random));
      exact.push_back(exact_sides(cuts.back().body, cuts.back().point, cuts.back().normal));
    }
    std::printf("%-18s", name_of(family));
    for (const Program& program : all) print_share(program, family, cuts, exact, with_faults);
    std::printf("\n");
    std::fflush(stdout);
  }
#if !SUNDER_BENCH_CGAL
  std::printf("CGAL is absent (scripts/setup oracle)\n");
#endif
#if !SUNDER_BENCH_VTK
  std::printf("VTK is absent (scripts/setup vtk)\n");
#endif
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  std::size_t count = 100;
  bool with_faults = false;
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], "--faults") == 0)
      with_faults = true;
    else if (const long given = std::strtol(argv[i], nullptr, 10); given > 0)
      count = static_cast<std::size_t>(given);
  sunder::bench::print_table(count, with_faults);
  return 0;
}
