// The side from which a wound is drawn: tools/picture/wound_view.h.

#include "tools/picture/wound_view.h"

#include <gtest/gtest.h>

namespace sunder::tools {
namespace {

/// Adds a square of 2 x `size` m whose middle is at a place and which faces a direction.
void add_square(const Vec3f& middle, const Vec3f& towards, float size, std::uint32_t material,
                RenderScene& scene) {
  const Vec3f side = size * towards.unitOrthogonal(), other = towards.cross(side);
  const std::array<Vec3f, 4> corners = {Vec3f(middle - side - other), Vec3f(middle + side - other),
                                        Vec3f(middle + side + other), Vec3f(middle - side + other)};
  for (const std::array<std::size_t, 3>& of :
       {std::array<std::size_t, 3>{0, 1, 2}, std::array<std::size_t, 3>{0, 2, 3}}) {
    RenderTriangle triangle;
    triangle.material = material;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.corners[i] = corners[of[i]];
      triangle.normals[i] = towards;
      triangle.uvs[i].setZero();
      triangle.tints[i].setOnes();
    }
    scene.triangles.push_back(triangle);
  }
}

/// A cube of skin, and a wound a little before one of its sides.
RenderScene wounded_cube(const Vec3f& side) {
  RenderScene scene;
  scene.materials.resize(2);
  scene.materials[1].is_flesh = true;
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f})
      add_square(sign * Vec3f::Unit(axis), sign * Vec3f::Unit(axis), 1, 0, scene);
  add_square(1.01f * side, side, 0.2f, 1, scene);
  return scene;
}

TEST(WoundView, the_preferred_view_is_kept_while_the_wound_is_seen) {
  const ViewFrame preferred = view_from({0.3, 0.4, 1});
  const ViewFrame frame = see_wound(wounded_cube(Vec3f::UnitZ()), preferred).frame;
  EXPECT_EQ(frame.towards_eye, preferred.towards_eye);
  RenderScene whole = wounded_cube(Vec3f::UnitZ());
  whole.triangles.resize(12);
  EXPECT_EQ(see_wound(whole, preferred).frame.towards_eye, preferred.towards_eye) << "no wound";
  EXPECT_FALSE(see_wound(whole, preferred).is_covered);
}

TEST(WoundView, turns_to_a_wound_on_the_other_side) {
  for (const Vec3f& side : {Vec3f(0, 0, -1), Vec3f(-1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, -1, 0)}) {
    const WoundView seen = see_wound(wounded_cube(side), view_from({0, -0.2, 1}));
    EXPECT_FALSE(seen.is_covered);
    EXPECT_GT(seen.frame.towards_eye.dot(side.cast<double>()), 0.5);
  }
}

/// A plate, as a robot might hold it, stands before the wound.
TEST(WoundView, looks_past_what_stands_in_front) {
  RenderScene scene = wounded_cube(Vec3f::UnitZ());
  add_square({0, 0, 2}, Vec3f::UnitZ(), 0.8f, 0, scene);
  const ViewFrame preferred = view_from({0, 0, 1});
  const ViewFrame frame = see_wound(scene, preferred).frame;
  EXPECT_LT(frame.towards_eye.z(), 0.85);
  EXPECT_GT(frame.towards_eye.z(), 0.3);
}

TEST(WoundView, says_that_a_wound_is_covered) {
  RenderScene scene = wounded_cube(Vec3f::UnitZ());
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f})
      add_square(2 * sign * Vec3f::Unit(axis), sign * Vec3f::Unit(axis), 2, 0, scene);
  EXPECT_TRUE(see_wound(scene, view_from({0.3, 0.4, 1})).is_covered);
  scene.triangles.resize(scene.triangles.size() - 2);  // one side of the box is open
  EXPECT_FALSE(see_wound(scene, view_from({0.3, 0.4, 1})).is_covered);
}

}  // namespace
}  // namespace sunder::tools
