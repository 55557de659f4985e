// What C programs see of pieces, contact and tissue is what C++ programs see.

#include <sunder/tear/contact.h>
#include <sunder/tear/detached_piece.h>

#include <algorithm>
#include <array>

#include "c/c_twins.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

TEST(CTissue, threads_hold_vertices_of_both_lips) {
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  sunder_cut cut = sunder_default_cut();
  cut.normal[1] = 1.0;
  cut.normal[2] = 0.0;
  cut.point[1] = 0.51;
  const sunder_suture_thread* threads = nullptr;
  std::uint32_t count = 7;
  EXPECT_DONE(sunder_get_threads(twins.c_scene, twins.c_id, &threads, &count));
  EXPECT_EQ(count, 0u);
  EXPECT_DONE(sunder_submit_cut(twins.c_scene, twins.c_id, &cut, 0, nullptr));
  sunder_suture suture = sunder_default_suture();
  suture.spacing = 0.1;
  EXPECT_DONE(sunder_submit_suture(twins.c_scene, twins.c_id, &suture, 0, nullptr));
  EXPECT_DONE(sunder_update(twins.c_scene, 0.0));
  EXPECT_DONE(sunder_get_threads(twins.c_scene, twins.c_id, &threads, &count));
  EXPECT_GT(count, 3u);
  const sunder_posed_mesh posed = posed_mesh(twins.c_scene, twins.c_id, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    EXPECT_EQ(threads[i].is_broken, 0u);
    ASSERT_LT(threads[i].left_vertex, posed.vertex_count);
    ASSERT_LT(threads[i].right_vertex, posed.vertex_count);
    EXPECT_NE(threads[i].left_vertex, threads[i].right_vertex);
    for (std::uint32_t k = 0; k < 3; ++k)
      EXPECT_NEAR(posed.positions[3 * threads[i].left_vertex + k],
                  posed.positions[3 * threads[i].right_vertex + k], 1e-3);
  }
}

TEST(CTissue, a_piece_comes_off) {
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  sunder_cut cut = sunder_default_cut();
  cut.normal[1] = 1.0;
  cut.normal[2] = 0.0;
  const sunder_posed_mesh before = posed_mesh(twins.c_scene, twins.c_id, 0);
  double low = 1e9, high = -1e9;
  for (std::uint32_t v = 0; v < before.vertex_count; ++v) {
    low = std::min<double>(low, before.positions[3 * v + 1]);
    high = std::max<double>(high, before.positions[3 * v + 1]);
  }
  cut.point[1] = low + 0.6 * (high - low);
  cut.has_caps = 1;
  EXPECT_DONE(sunder_submit_cut(twins.c_scene, twins.c_id, &cut, 0, nullptr));
  EXPECT_DONE(sunder_update(twins.c_scene, 0.0));
  sunder_detach detach = sunder_default_detach();
  for (int i = 0; i < 3; ++i) detach.point[i] = 0.0;
  detach.point[1] = high;
  sunder_command command = 0;
  EXPECT_DONE(sunder_submit_detach(twins.c_scene, twins.c_id, &detach, &command));
  EXPECT_DONE(sunder_update(twins.c_scene, 0.0));
  sunder_piece piece = 0;
  ASSERT_EQ(sunder_take_piece(twins.c_scene, command, &piece), SUNDER_OK) << sunder_last_error();
  EXPECT_EQ(sunder_take_piece(twins.c_scene, command + 1, &piece), SUNDER_NOT_FOUND);

  sunder_piece_info info = {};
  info.struct_size = sizeof info;
  EXPECT_DONE(sunder_get_piece(piece, &info));
  EXPECT_GT(info.mass, 0.0);
  EXPECT_EQ(info.holes, 0u);  // Caps close it.
  EXPECT_GT(info.centre[1], cut.point[1]);
  ASSERT_EQ(info.mesh_count, 1u);
  std::uint32_t torn_mesh = 9, count = 0;
  const std::uint32_t* vertices = nullptr;
  EXPECT_DONE(sunder_get_piece_vertices(piece, 0, &torn_mesh, &vertices, &count));
  EXPECT_EQ(torn_mesh, 0u);

  // A frozen piece stands where it was: its asset in the rest pose has the vertices of the torn
  // one.
  sunder_character character = 0;
  sunder_asset asset = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_get_piece_character(piece, &character));
  sunder_asset_options options = sunder_default_asset_options();
  options.is_soft = 1;
  EXPECT_DONE(sunder_create_asset(character, &options, &asset));
  EXPECT_DONE(sunder_spawn(twins.c_scene, asset, nullptr, &id));
  EXPECT_DONE(sunder_prepare_to_tear(twins.c_scene, id));
  EXPECT_DONE(sunder_inherit_motion(twins.c_scene, id, piece));
  EXPECT_DONE(sunder_update(twins.c_scene, 0.0));
  const sunder_posed_mesh of_piece = posed_mesh(twins.c_scene, id, 0);
  ASSERT_EQ(of_piece.vertex_count, count);
  for (std::uint32_t v = 0; v < count; ++v)
    EXPECT_GT(of_piece.positions[3 * v + 1], cut.point[1] - 1e-4);

  std::uint32_t hulls = 0;
  const sunder_hull* hull = nullptr;
  if ((sunder_features() & SUNDER_FEATURE_HULLS) != 0) {
    EXPECT_DONE(sunder_get_piece_hulls(piece, 4, 32, &hull, &hulls));
    ASSERT_GT(hulls, 0u);
    EXPECT_LE(hull[0].point_count, 32u);
    EXPECT_GT(hull[0].volume, 0.0);
    EXPECT_EQ(sunder_get_piece_hulls(piece, 0, 32, &hull, &hulls), SUNDER_INVALID_ARGUMENT);
  }
  EXPECT_DONE(sunder_destroy_piece(piece));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CTissue, contacts_are_those_of_the_library) {
  Random random(6);
  Twins twins(make_tube(24, 12, 6));
  EXPECT_TRUE(twins.scene->find(twins.id)->prepare_to_tear());
  EXPECT_DONE(sunder_prepare_to_tear(twins.c_scene, twins.c_id));
  for (int frame = 0; frame < 12; ++frame) {
    twins.update();
    if (frame > 0) submit_random(twins, random);
    twins.update();
    CharacterInstance& instance = *twins.scene->find(twins.id);
    SurfaceQuery query = *SurfaceQuery::create(*instance.model());
    const std::array displacements = {instance.displacements(0)};
    ContactOptions options;
    options.displacements = displacements;
    ASSERT_TRUE(query.set_pose(instance.pose(), options));
    for (int i = 0; i < 20; ++i) {
      const Vec3d target = random.direction() * 0.2;
      const Ray ray{target + random.direction() * 2.0, random.direction(), 10.0};
      const auto expected = query.cast_ray(ray);
      sunder_contact contact = {};
      std::uint32_t has_hit = 9;
      EXPECT_DONE(sunder_cast_ray(twins.c_scene, twins.c_id, ray.origin.data(),
                                  ray.direction.data(), ray.length, &contact, &has_hit));
      ASSERT_EQ(has_hit, expected->has_value() ? 1u : 0u);
      if (*expected) {
        EXPECT_EQ(contact.triangle, (*expected)->triangle);
        EXPECT_EQ(contact.distance, (*expected)->distance);
        EXPECT_EQ(contact.bone, (*expected)->bone);
      }
      const auto nearest = query.find_nearest(target);
      EXPECT_DONE(
          sunder_find_nearest(twins.c_scene, twins.c_id, target.data(), 1e9, &contact, &has_hit));
      ASSERT_EQ(has_hit, 1u);
      EXPECT_EQ(contact.distance, (*nearest)->distance);
      const Blade blade{ray.origin, target};
      const sunder_blade c_blade = blade_of(blade);
      std::vector<SurfaceContact> crossings;
      ASSERT_TRUE(query.find_blade_contacts(blade, crossings));
      std::uint32_t count = 99;
      EXPECT_DONE(
          sunder_find_blade_contacts(twins.c_scene, twins.c_id, &c_blade, &contact, 1, &count));
      ASSERT_EQ(count, crossings.size());
      if (count > 0) {
        EXPECT_EQ(contact.triangle, crossings[0].triangle);
      }
    }
  }
}

TEST(CTissue, tissue_follows_holds_and_colliders_as_in_the_library) {
  Twins twins(make_tube(24, 12, 6));
  EXPECT_TRUE(twins.scene->find(twins.id)->prepare_to_tear());
  EXPECT_DONE(sunder_prepare_to_tear(twins.c_scene, twins.c_id));
  twins.update();
  SoftBody& body = *twins.scene->find(twins.id)->body();
  std::uint32_t point = 0;
  EXPECT_DONE(sunder_get_point(twins.c_scene, twins.c_id, 0, 40, &point));
  EXPECT_EQ(point, twins.scene->find(twins.id)->particles()->vertex_points(0)[40]);
  const Vec3d target(0.3, 0.2, 0.1), impulse(0.01, 0, 0.02), gravity(0, -9.81, 0);
  std::uint64_t hold = 0;
  EXPECT_DONE(sunder_hold_point(twins.c_scene, twins.c_id, point, target.data(), 0.0, &hold));
  EXPECT_EQ(*body.hold_point(point, target), hold);
  EXPECT_DONE(sunder_add_impulse(twins.c_scene, twins.c_id, point, impulse.data()));
  EXPECT_TRUE(body.add_point_impulse(point, impulse));
  EXPECT_DONE(sunder_set_gravity(twins.c_scene, twins.c_id, gravity.data()));
  EXPECT_TRUE(body.set_gravity(gravity));
  sunder_material liver = sunder_default_material();
  EXPECT_DONE(sunder_find_material("liver", &liver));
  EXPECT_DONE(sunder_change_material(twins.c_scene, twins.c_id, 0, &liver));
  SoftMaterial expected = *find_material("liver");
  EXPECT_TRUE(body.change_material(0, expected));
  const sunder_collider collider = {SUNDER_COLLIDER_SPHERE, 0,  {0.2, 0, 0}, {0, 0.1, 0},
                                    {0, 0, 0, 1},           0.3};
  EXPECT_DONE(sunder_set_colliders(twins.c_scene, twins.c_id, &collider, 1));
  const std::array colliders = {
      Collider{Collider::Sphere{0.2}, {0, 0.1, 0}, Quatd::Identity(), 0.3}};
  EXPECT_TRUE(body.set_colliders(colliders));
  for (int i = 0; i < 10; ++i) {
    twins.update();
    twins.expect_same();
  }
  const Vec3d moved(0.1, 0.2, 0);
  EXPECT_DONE(sunder_move_hold(twins.c_scene, twins.c_id, hold, moved.data()));
  EXPECT_TRUE(body.move_hold(hold, moved));
  EXPECT_DONE(sunder_set_tension(twins.c_scene, twins.c_id, 3.0, 0));
  EXPECT_TRUE(body.set_tension({3.0, {}, false}));
  const double turn[4] = {0, 0, 0, 1};
  EXPECT_DONE(sunder_move_collider(twins.c_scene, twins.c_id, 0, moved.data(), turn));
  EXPECT_TRUE(body.move_collider(0, moved, Quatd::Identity()));
  for (int i = 0; i < 5; ++i) twins.update();
  twins.expect_same();
  EXPECT_DONE(sunder_release_hold(twins.c_scene, twins.c_id, hold));
  EXPECT_EQ(sunder_release_hold(twins.c_scene, twins.c_id, hold), SUNDER_NOT_FOUND);
  sunder_tissue_info info = {};
  info.struct_size = sizeof info;
  EXPECT_DONE(sunder_get_tissue(twins.c_scene, twins.c_id, &info));
  EXPECT_GT(info.particle_count, 0u);
  EXPECT_EQ(info.is_awake, 1u);
}

TEST(CTissue, tissue_tears_by_force_as_in_the_library) {
  Twins twins(make_tube(24, 12, 6));
  EXPECT_TRUE(twins.scene->find(twins.id)->prepare_to_tear());
  EXPECT_DONE(sunder_prepare_to_tear(twins.c_scene, twins.c_id));
  twins.update();
  CharacterInstance& instance = *twins.scene->find(twins.id);
  SoftMaterial weak = *find_material("skin");
  weak.strength = 1.05;
  sunder_material c_weak = sunder_default_material();
  EXPECT_DONE(sunder_find_material("skin", &c_weak));
  c_weak.strength = weak.strength;
  EXPECT_TRUE(instance.body()->change_material(0, weak));
  EXPECT_DONE(sunder_change_material(twins.c_scene, twins.c_id, 0, &c_weak));
  std::uint32_t point = 0;
  EXPECT_DONE(sunder_get_point(twins.c_scene, twins.c_id, 0, 140, &point));
  const sunder_posed_mesh before = posed_mesh(twins.c_scene, twins.c_id, 0);
  const Vec3d target = 2.0 * Eigen::Map<const Vec3f>(before.positions + 3 * 140).cast<double>();
  std::uint64_t hold = 0;
  EXPECT_DONE(sunder_hold_point(twins.c_scene, twins.c_id, point, target.data(), 1e5, &hold));
  EXPECT_TRUE(instance.body()->hold_point(point, target, {.stiffness = 1e5}));

  sunder_force_tearing_options options = sunder_default_force_tearing_options();
  options.length = 1.0;
  int tears = 0;
  for (int frame = 0; frame < 60; ++frame) {
    twins.update();
    const auto expected = instance.tear_overstretched({.length = 1.0});
    ASSERT_TRUE(expected);
    sunder_force_tearing found = {};
    found.struct_size = sizeof found;
    EXPECT_DONE(sunder_tear_overstretched(twins.c_scene, twins.c_id, &options, &found));
    EXPECT_EQ(found.has_torn, expected->has_torn ? 1u : 0u);
    EXPECT_EQ(found.is_from_tip, expected->is_from_tip ? 1u : 0u);
    EXPECT_EQ(found.vertices_added, expected->tear.vertices_added);
    EXPECT_EQ(found.greatest_stretch, expected->greatest_stretch);
    EXPECT_EQ(found.greatest_release, expected->greatest_release);
    EXPECT_EQ(found.length, expected->tear.length_posed);
    EXPECT_EQ(Vec3d(found.place), expected->place);
    EXPECT_EQ(Vec3d(found.direction), expected->direction);
    tears += found.has_torn != 0;
  }
  EXPECT_GT(tears, 1);
  twins.update();
  twins.expect_same();

  sunder_force_tearing found = {};
  EXPECT_EQ(sunder_tear_overstretched(twins.c_scene, twins.c_id, &options, &found),
            SUNDER_INVALID_STRUCT);
  found.struct_size = sizeof found;
  options.length = -1.0;
  EXPECT_EQ(sunder_tear_overstretched(twins.c_scene, twins.c_id, &options, &found),
            SUNDER_INVALID_ARGUMENT);
}

/// Fields and a perforation of a sheet, and how an asset of them by C fails or not.
struct AuthoredAsset {
  Character character = make_sheet(6);
  std::vector<float> values = std::vector<float>(character.meshes[0].vertex_count(), 0.5f);
  sunder_tissue_field field = {sizeof field, 0, SUNDER_FIELD_STIFFNESS,
                               static_cast<std::uint32_t>(values.size()), values.data()};
  std::array<sunder_surface_place, 2> places = {{{0, 0, {1, 0, 0}}, {0, 9, {0, 0.5, 0.5}}}};
  sunder_perforation perforation = {sizeof perforation, 2, places.data(), 0.3};
  sunder_asset_options options = sunder_default_asset_options();

  AuthoredAsset() {
    options.is_soft = 1;
    options.field_count = options.perforation_count = 1;
    options.fields = &field;
    options.perforations = &perforation;
    options.self_contact_thickness = 0.01;
  }
  sunder_status create() const {
    const sunder_character made = test::create(character);
    sunder_asset asset = 0;
    const sunder_status status = sunder_create_asset(made, &options, &asset);
    if (status == SUNDER_OK) {
      EXPECT_DONE(sunder_destroy_asset(asset));
    }
    EXPECT_DONE(sunder_destroy_character(made));
    return status;
  }
};

TEST(CTissue, fields_and_perforations_are_checked) {
  EXPECT_EQ(AuthoredAsset().create(), SUNDER_OK) << sunder_last_error();
  AuthoredAsset bad_value;
  bad_value.values[7] = 0;
  EXPECT_EQ(bad_value.create(), SUNDER_INVALID_ARGUMENT);
  EXPECT_NE(std::string(sunder_last_error()).find("vertex 7: the factor of stiffness is 0"),
            std::string::npos)
      << sunder_last_error();
  AuthoredAsset bad_mesh, bad_field, bad_count, bad_place, bad_strength;
  bad_mesh.field.mesh = 1;
  EXPECT_EQ(bad_mesh.create(), SUNDER_INDEX_OUT_OF_RANGE);
  bad_field.field.field = 5;
  EXPECT_EQ(bad_field.create(), SUNDER_INVALID_ARGUMENT);
  bad_count.field.value_count = 3;
  EXPECT_EQ(bad_count.create(), SUNDER_SIZE_MISMATCH);
  bad_place.places[1].triangle = 1000;
  EXPECT_EQ(bad_place.create(), SUNDER_INDEX_OUT_OF_RANGE);
  bad_strength.perforation.strength = 2;
  EXPECT_EQ(bad_strength.create(), SUNDER_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace sunder::test
