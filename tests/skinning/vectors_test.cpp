// Compares all vector extensions of this CPU, and scalar code, with each other.

#include <sunder/skinning/skinned_mesh.h>

#include <hwy/targets.h>

#include <gtest/gtest.h>

#include "support/models/posed_arrays.h"
#include "support/models/random_displacements.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

/// Restricts the library to some vector extensions during its lifetime.
class OnlyTargets {
 public:
  explicit OnlyTargets(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(targets);
  }
  ~OnlyTargets() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
  OnlyTargets(const OnlyTargets&) = delete;
  OnlyTargets& operator=(const OnlyTargets&) = delete;
};

TEST(Vectors, all_kinds_give_the_same_bits) {
  const std::int64_t supported = hwy::SupportedTargets();
  test::Random random(1);
  for (const test::RandomSkin& kind :
       {test::RandomSkin{1000, 40, 4, 2, true, 6}, test::RandomSkin{400, 300, 6, 0, false, 300},
        test::RandomSkin{77, 9, 9, 1, true, 9}})
    for (const SkinningMethod method : {SkinningMethod::linear, SkinningMethod::dual_quaternion})
      for (const double scale : {1.0, 1.4})
        for (const bool unit_length : {false, true}) {
          Mesh mesh = test::make_random_skin(random, kind);
          for (std::uint32_t v = 0; v < mesh.vertex_count() / 2; v += 7)
            mesh.normals[v] *= 1e-30f;  // its square underflows
          const auto made = SkinnedMesh::create(source_of(mesh), kind.slots);
          ASSERT_TRUE(made);
          BonePalette palette = *BonePalette::create(kind.slots, kind.morph_targets, method);
          ASSERT_TRUE(palette.set(test::in_float(test::random_palette(random, kind.slots, scale)),
                                  std::vector<float>(kind.morph_targets, 0.7f)));
          test::Soft soft = test::make_soft(random, kind.vertices);
          soft.moved = {{3, kind.vertices / 2}, {kind.vertices / 2 + 5, 30}};
          const VertexDisplacements displaced = soft.view();
          const auto pose_into = [&](test::PosedArrays& posed) {
            PosedBuffer buffer(posed.target());
            ASSERT_TRUE(made->deform(palette, buffer, {}, &displaced));
          };
          test::PosedArrays one_by_one(mesh, 0, unit_length);
          {
            const OnlyTargets only(HWY_SCALAR);
            pose_into(one_by_one);
          }
          int kinds = 0;
          for (std::int64_t targets = supported; targets != 0; targets &= targets - 1) {
            const OnlyTargets only(targets & -targets);
            test::PosedArrays posed(mesh, 0, unit_length);
            pose_into(posed);
            EXPECT_EQ(posed.first_difference(one_by_one), kNone)
                << hwy::TargetName(targets & -targets);
            EXPECT_TRUE(posed.margins_are_untouched());
            ++kinds;
          }
          EXPECT_GT(kinds, 1);
        }
}

}  // namespace
}  // namespace sunder
