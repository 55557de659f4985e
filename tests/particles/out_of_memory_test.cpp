// No exception leaves the API of particles: if memory runs out, a call returns a failure or an
// empty result, and works again later.

#include <sunder/particles/force_tearing.h>

#include <algorithm>
#include <array>
#include <optional>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/machine/allocation_count.h"

namespace sunder {
namespace {

using test::FailingAllocations;
using test::SoftScene;

constexpr double kStarvedStep = 1.0 / 60;
/// More allocations than any of the calls makes.
constexpr std::uint64_t kMost = 4000;

/// A sheet that is torn; its particles have followed, or not.
struct TornSheet : SoftScene {
  explicit TornSheet(bool follows) : SoftScene(test::make_sheet(10), {}, 0.2) {
    const std::array<Blade, 2> stroke = {test::down_at(0.503, 0.3), test::down_at(0.503, 0.7)};
    const auto report = model->tear(pose, stroke, {}, &change);
    EXPECT_TRUE(report) << report.error().text();
    if (!follows) return;
    EXPECT_TRUE(set->follow(*model, {&change, 1}));
  }

  ChangeRecord change;
};

/// The result of a call with too little memory, or with enough.
enum class Answer { refused, done, wrong };

Answer answer_of(const Status& status) {
  if (status) return Answer::done;
  return status.code() == StatusCode::limit_exceeded ? Answer::refused : Answer::wrong;
}

/// Calls on a new scene, with memory for 0, 1, 2 … allocations, until there is enough.
/// @param call  called with the scene; must return `refused` until it returns `done`.
/// @param then  called with the scene and enough memory, after each call.
template <class MakeScene, class Call, class Then>
void starve(MakeScene make_scene, Call call, Then then) {
  if (!FailingAllocations::are_possible())
    GTEST_SKIP() << "this program has no operator new of its own";
  for (std::uint64_t count = 0; count < kMost; ++count) {
    auto scene = make_scene();
    Answer answer = Answer::wrong;
    ASSERT_NO_THROW({
      const FailingAllocations failing(count);
      answer = call(*scene);
    }) << count;
    ASSERT_NE(answer, Answer::wrong) << count;
    ASSERT_NO_THROW(then(*scene)) << count;
    if (answer == Answer::done) return;
  }
  FAIL() << "there was never enough memory";
}

template <class MakeScene, class Call>
void starve(MakeScene make_scene, Call call) {
  starve(make_scene, call, [](const auto&) {});
}

std::unique_ptr<TornSheet> followed() { return std::make_unique<TornSheet>(true); }
std::unique_ptr<TornSheet> unfollowed() { return std::make_unique<TornSheet>(false); }

TEST(OutOfMemory, create_is_refused) {
  starve(unfollowed, [](TornSheet& scene) {
    const auto set = ParticleSet::create(*scene.model, scene.pose);
    return answer_of(set.error());
  });
  starve(unfollowed, [](TornSheet& scene) {
    const SoftMaterial material;
    const auto body = SoftBody::create(*scene.set, scene.pose, {&material, 1});
    return answer_of(body.error());
  });
}

TEST(OutOfMemory, follow_reports_it_and_nothing_breaks_afterwards) {
  starve(
      unfollowed,
      [](TornSheet& scene) {
        return answer_of(scene.set->follow(*scene.model, {&scene.change, 1}));
      },
      [](TornSheet& scene) {
        (void)scene.set->settle(*scene.model);
        (void)scene.set->dirty_points();
        (void)scene.set->gradients(*scene.model);
        (void)scene.body->step(*scene.model, scene.pose, kStarvedStep);
        (void)scene.body->displacements();
        for (std::uint32_t p = 0; p < scene.set->particle_count(); ++p) (void)scene.set->members(p);
      });
}

TEST(OutOfMemory, settle_ends) {
  starve(followed, [](TornSheet& scene) {
    while (scene.set->settle(*scene.model, 50)) continue;
    return scene.set->is_settled() ? Answer::done : Answer::refused;
  });
}

TEST(OutOfMemory, lists_are_refused) {
  starve(followed, [](TornSheet& scene) { return answer_of(scene.set->members(0).error()); });
  starve(followed,
         [](TornSheet& scene) { return answer_of(find_tips(*scene.set, *scene.model).error()); });
}

TEST(OutOfMemory, accessors_answer_nothing_and_later_all) {
  const auto has_all = [](TornSheet& scene) {
    EXPECT_EQ(scene.body->displacements().size(), scene.set->particle_count());
    EXPECT_EQ(scene.body->rotations().size(), scene.set->particle_count());
    EXPECT_EQ(scene.set->gradients(*scene.model).size(), scene.set->point_count());
  };
  starve(
      followed,
      [](TornSheet& scene) {
        return scene.body->displacements().empty() ? Answer::refused : Answer::done;
      },
      has_all);
  starve(
      followed,
      [](TornSheet& scene) {
        return scene.body->rotations().empty() ? Answer::refused : Answer::done;
      },
      has_all);
  starve(
      followed,
      [](TornSheet& scene) {
        return scene.set->gradients(*scene.model).empty() ? Answer::refused : Answer::done;
      },
      has_all);
  const auto displaced = [] {
    auto scene = followed();
    EXPECT_TRUE(scene->body->add_impulse(0, {0, 0, 0.01}));
    scene->step(kStarvedStep);
    return scene;
  };
  starve(
      displaced,
      [](TornSheet& scene) {
        return scene.body->moved_vertices(*scene.model, 0).empty() ? Answer::refused : Answer::done;
      },
      [](TornSheet& scene) { EXPECT_FALSE(scene.body->moved_vertices(*scene.model, 0).empty()); });
}

/// A torn sheet whose particles have an asset, so that they can be packed.
struct PackableSheet {
  std::shared_ptr<const Character> character =
      std::make_shared<const Character>(test::make_sheet(30));
  ModelPose pose = *bind_pose(*character);
  TornModel model = *TornModel::create(character);
  ParticleSet set = *ParticleSet::create(*ParticleAsset::create(model, pose), model);

  PackableSheet() {
    const std::array<Blade, 2> stroke = {test::down_at(0.503, 0.4), test::down_at(0.503, 0.5)};
    ChangeRecord change;
    EXPECT_TRUE(model.tear(pose, stroke, {}, &change));
    EXPECT_TRUE(set.follow(model, {&change, 1}));
    while (set.settle(model, 1000)) {
    }
    (void)set.gradients(model);
  }
};

TEST(OutOfMemory, a_set_that_cannot_be_packed_stays_as_it_is) {
  StateArrays before;
  starve(
      [&] {
        auto sheet = std::make_unique<PackableSheet>();
        before = *sheet->set.save();
        return sheet;
      },
      [&](PackableSheet& sheet) { return answer_of(sheet.set.pack()); },
      [&](PackableSheet& sheet) { EXPECT_EQ(*sheet.set.save(), before); });
}

TEST(OutOfMemory, a_packed_set_has_no_points_until_there_is_memory) {
  std::vector<ParticleInfluences> before;
  starve(
      [&] {
        auto sheet = std::make_unique<PackableSheet>();
        before.assign(sheet->set.influences().begin(), sheet->set.influences().end());
        const std::size_t unpacked = sheet->set.memory_bytes();
        EXPECT_TRUE(sheet->set.pack());
        EXPECT_LT(sheet->set.memory_bytes(), unpacked / 2);
        EXPECT_EQ(sheet->set.point_count(), before.size());
        return sheet;
      },
      [&](PackableSheet& sheet) {
        return sheet.set.influences().empty() ? Answer::refused : Answer::done;
      },
      [&](PackableSheet& sheet) {
        EXPECT_TRUE(std::ranges::equal(sheet.set.influences(), before));
      });
}

TEST(OutOfMemory, accessors_that_do_not_list_need_none) {
  const auto scene = followed();
  const std::uint64_t before = test::allocation_count();
  (void)scene->set->dirty_points();
  ParticleRest rest;
  const std::uint32_t first = 0;
  EXPECT_TRUE(scene->set->rest(scene->pose, {&first, 1}, {&rest, 1}));
  EXPECT_EQ(test::allocation_count(), before);
}

/// Calls an action with ever more memory, until it has enough.
template <class Action>
void expect_refused_without_change(Action action) {
  StateArrays before;
  Status status;
  starve(
      [&] {
        auto scene = followed();
        (void)scene->body->displacements();  // follows the set
        before = *scene->body->save();
        return scene;
      },
      [&](TornSheet& scene) {
        status = action(*scene.body);
        return answer_of(status);
      },
      [&](TornSheet& scene) {
        if (!status) {
          EXPECT_EQ(*scene.body->save(), before);
        }
        scene.step(kStarvedStep);
      });
}

TEST(OutOfMemory, actions_on_a_body_are_refused_and_change_nothing) {
  expect_refused_without_change([](SoftBody& body) { return body.hold(0, {0, 0, 1}).error(); });
  expect_refused_without_change([](SoftBody& body) {
    return body.hold_point(0, {0, 0, 1}).error();
  });
  const Collider ball{Collider::Sphere{0.1}, {0.5, 0.5, 0}};
  expect_refused_without_change([&](SoftBody& body) { return body.set_colliders({&ball, 1}); });
  SoftMaterial material;
  material.name = "a name that is longer than any string keeps in itself";
  expect_refused_without_change([&](SoftBody& body) { return body.change_material(0, material); });
}

TEST(OutOfMemory, a_step_is_refused_and_the_next_one_continues) {
  const Collider ball{Collider::Sphere{0.1}, {0.5, 0.5, 0}};
  const auto busy = [&] {
    auto scene = followed();
    EXPECT_TRUE(scene->body->set_colliders({&ball, 1}));
    EXPECT_TRUE(scene->body->hold_point(0, {0, 0, 0.1}));
    EXPECT_TRUE(scene->body->set_gravity({0, -1, 0}));
    return scene;
  };
  starve(
      busy,
      [](TornSheet& scene) {
        return answer_of(scene.body->step(*scene.model, scene.pose, kStarvedStep));
      },
      [](TornSheet& scene) {
        // If settle() had too little memory, the set is broken; the body continues as far as
        // possible.
        (void)scene.body->step(*scene.model, scene.pose, kStarvedStep);
        for (const Vec4f& u : scene.body->displacements()) EXPECT_TRUE(u.allFinite());
      });
}

TEST(OutOfMemory, a_tear_by_force_is_refused_or_recorded) {
  const auto stretched = [] {
    SoftMaterial material;
    material.return_frequency = 0;
    material.strength = 1.05;
    auto scene = std::make_unique<SoftScene>(test::make_sheet(10), material, 0.2);
    for (std::uint32_t p = 0; p < scene->count(); ++p) {
      const Vec3d at = scene->body->place(p);
      if (at.x() > 0.3 && at.x() < 0.7) continue;
      EXPECT_TRUE(scene->body->hold(p, at + Vec3d(at.x() < 0.5 ? -0.3 : 0.3, 0, 0)));
    }
    scene->run(0.5);
    return scene;
  };
  std::vector<ChangeRecord> changes;
  starve(
      stretched,
      [&](SoftScene& scene) {
        changes.clear();
        const auto report =
            tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, {}, &changes);
        if (report && !report->has_torn) return Answer::wrong;
        return answer_of(report.error());
      },
      [&](SoftScene& scene) { EXPECT_EQ(changes.size(), scene.model->history()->size()); });
}

}  // namespace
}  // namespace sunder
