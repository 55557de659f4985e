#include "bench/stress/families.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace sunder::stress {
namespace {

constexpr std::array kFamilies = {
    Family{"random", "tears, gaps, cuts and bores in random poses", false, 1000, random_operations},
    Family{"hard", "operations through vertices, along edges, far too small and far too large",
           true, 200, hard_operations},
    Family{"cracks", "surfaces whose sides of an edge have different weights", true, 40,
           cracked_bodies},
    Family{"scales", "models of 0.1 mm to 10 km, up to 100 km from the origin", true, 40,
           scaled_and_shifted},
    Family{"poses", "bones that collapse, mirror, shear or turn by 180 degrees; not a number", true,
           40, hard_poses},
    Family{"planes", "planes through vertices, along edges and in faces, or nearly so", true, 60,
           planes_at_vertices},
    Family{"bundles", "planes that nearly meet in one line", true, 20, plane_bundles},
    Family{"stacks", "parallel planes down to one unit in the last place apart", true, 20,
           plane_stacks},
    Family{"winding", "hairpins, spirals, strokes that cross and retrace themselves", true, 60,
           winding_strokes},
    Family{"retraced", "the same operation again, and nearly the same, with gaps and walls", true,
           40, retraced_strokes},
    Family{"ends", "tears that end in faces, on edges, in vertices, on tips and on older tears",
           true, 60, strokes_that_end_anywhere},
    Family{"turns", "blades that turn about a far point and step back", true, 60, far_turns},
    Family{"long", "strokes of thousands of blades", true, 1, long_strokes},
    Family{"tiny", "strokes and bores smaller than a face", true, 40, tiny_strokes},
    Family{"cuts", "300 cuts one after another", false, 1, many_cuts},
    Family{"region", "1,000 tears of the same region in changing poses", false, 1, one_region},
    Family{"suture",
           "wounds that cross one another, with walls and caps, sutures and welds of them", false,
           100, welded_wounds},
    Family{"capacities", "models of every capacity", true, 20, every_capacity},
    Family{"allocations", "operations that run out of memory at each of their allocations", true, 2,
           failing_allocations},
    Family{"counts", "models of 65,534 to 65,537 vertices", true, 1, vertex_counts},
    Family{"refits", "weights fitted over poses that determine nothing", true, 10, singular_refits},
    Family{"tissue", "soft bodies of any material in steps of any length", true, 20, moving_tissue},
    Family{"authored", "tissue of random fields and perforations that yields, touches and tears",
           true, 20, authored_tissue},
    Family{"mask", "masks of wounds that follow operations, undo and redo", false, 20,
           followed_masks},
    Family{"files", "operations on rigged models in files", false, 20, models_in_files},
    Family{"scenes", "instances made, torn, destroyed, saved and restored", false, 20, busy_scenes},
};

}  // namespace

std::span<const Family> families() { return kFamilies; }

const Family* find_family(std::string_view name) {
  const auto at = std::find_if(kFamilies.begin(), kFamilies.end(),
                               [&](const Family& family) { return family.name == name; });
  return at == kFamilies.end() ? nullptr : &*at;
}

CaseName case_of(std::uint64_t number, std::span<const Family* const> chosen) {
  std::uint64_t total = 0;
  for (const Family* family : chosen) total += family->share;
  const std::uint64_t round = number / total;
  // A stride that has no factor in common with the total mixes the families.
  std::uint64_t stride = 7919;
  while (std::gcd(stride, total) > 1) ++stride;
  std::uint64_t place = number % total * stride % total;
  for (const Family* family : chosen) {
    if (place < family->share) return {std::string(family->name), round * family->share + place};
    place -= family->share;
  }
  return {};  // Not reached: the shares add up to the total.
}

}  // namespace sunder::stress
