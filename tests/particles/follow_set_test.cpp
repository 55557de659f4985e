// A body that follows its set change by change has the rests and masses of one that was made on the
// set as it is.

#include <sunder/particles/soft_body.h>

#include "particles/soft_scene.h"
#include "support/models/random_operations.h"

namespace sunder {
namespace {

using test::Random;
using test::SoftScene;

/// One random call. @return whether the set changed.
bool act(SoftScene& scene, Random& random) {
  ChangeRecord change;
  bool is_changed = false;
  const std::uint32_t kind = random.index(6);
  if (kind < 3)
    is_changed =
        bool(test::play(*scene.model, test::random_operation(*scene.model, random), &change));
  else if (kind == 3)
    is_changed = bool(scene.model->undo(&change));
  else if (kind == 4)
    is_changed = bool(scene.model->redo(&change));
  else
    return scene.set->settle(*scene.model, 1 + random.index(400));
  if (!is_changed) return false;
  EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  return true;
}

TEST(follow_set, is_as_good_as_a_new_body) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Random of_character(seed);
    SoftBodyOptions options;
    options.tracks_rest = true;
    SoftScene scene(test::random_character(of_character), {*find_material("skin")}, 0.1, options);
    const ModelPose bind = scene.pose;
    for (int i = 0; i < 20; ++i) {
      (void)act(scene, random);
      if (random.index(3) == 0)
        scene.pose = test::moved(bind, test::turn_by(random.uniform(0, 1), {0, 0, 1}));
      ASSERT_TRUE(scene.body->step(*scene.model, scene.pose, 1.0 / 60, 0));
      auto made = SoftBody::create(*scene.set, bind, scene.body->materials(), options);
      ASSERT_TRUE(made);
      ASSERT_TRUE(made->step(*scene.model, scene.pose, 1.0 / 60, 0));
      for (std::uint32_t p = 0; p < scene.count(); ++p) {
        ASSERT_EQ(scene.body->mass(p), made->mass(p)) << p;
        ASSERT_EQ(scene.body->place(p) - scene.body->displacement(p),
                  made->place(p) - made->displacement(p))
            << p;
      }
    }
  }
}

}  // namespace
}  // namespace sunder
