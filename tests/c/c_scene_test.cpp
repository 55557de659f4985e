// What C programs see has the bits that C++ programs see.

#include <sunder/io/operation_log.h>
#include <sunder/scene/scene.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/detached_piece.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "c/c_objects.h"
#include "support/machine/allocation_count.h"
#include "support/models/random_operations.h"

namespace sunder::test {
namespace {

/// The same instance by C and by C++, soft, with a clip that plays.
class Twins {
 public:
  explicit Twins(const Character& character, bool is_soft = true) {
    CharacterAssetOptions options;
    if (is_soft) options.soft.emplace();
    asset = *CharacterAsset::create(std::make_shared<const Character>(character), options);
    SceneOptions one_thread;
    one_thread.threads = 1;
    scene.emplace(*Scene::create(one_thread));
    id = *scene->spawn(asset);

    c_character = create(character);
    sunder_asset_options c_options = sunder_default_asset_options();
    c_options.is_soft = is_soft ? 1 : 0;
    EXPECT_DONE(sunder_create_asset(c_character, &c_options, &c_asset));
    sunder_scene_options of_scene = sunder_default_scene_options();
    of_scene.threads = 1;
    EXPECT_DONE(sunder_create_scene(&of_scene, &c_scene));
    EXPECT_DONE(sunder_spawn(c_scene, c_asset, nullptr, &c_id));
    if (character.clips.empty()) return;
    EXPECT_TRUE(scene->play(id, 0));
    EXPECT_DONE(sunder_play(c_scene, c_id, 0, nullptr, nullptr));
  }
  ~Twins() {
    EXPECT_DONE(sunder_destroy_scene(c_scene));
    EXPECT_DONE(sunder_destroy_asset(c_asset));
    EXPECT_DONE(sunder_destroy_character(c_character));
  }

  void update(double seconds = 1.0 / 64) {
    EXPECT_TRUE(scene->update(seconds));
    EXPECT_DONE(sunder_update(c_scene, seconds));
  }

  /// All that is drawn, and the torn model.
  void expect_same() {
    for (std::uint32_t m = 0; m < asset->character()->meshes.size(); ++m) {
      const PosedMesh expected = scene->mesh(id, m);
      const sunder_posed_mesh posed = posed_mesh(c_scene, c_id, m);
      ASSERT_EQ(posed.vertex_count, expected.positions.size());
      EXPECT_EQ(0, std::memcmp(posed.positions, expected.positions.data(),
                               expected.positions.size_bytes()));
      EXPECT_EQ(posed.normals == nullptr, expected.normals.empty());
      if (posed.normals != nullptr) {
        EXPECT_EQ(
            0, std::memcmp(posed.normals, expected.normals.data(), expected.normals.size_bytes()));
      }
      ASSERT_EQ(posed.triangle_write_count, expected.triangle_writes.size());
      for (std::uint32_t i = 0; i < posed.triangle_write_count; ++i) {
        EXPECT_EQ(posed.triangle_writes[i].place, expected.triangle_writes[i].place);
        EXPECT_EQ(0, std::memcmp(posed.triangle_writes[i].vertices,
                                 expected.triangle_writes[i].triangle.data(), 12));
      }
    }
    std::uint64_t digest = 1;
    EXPECT_DONE(sunder_get_digest(c_scene, c_id, &digest));
    const TornModel* const model = scene->find(id)->model();
    EXPECT_EQ(digest, model == nullptr ? 0 : model->digest());
  }

  /// The results of the last update.
  void expect_same_results() {
    const sunder_result* results = nullptr;
    std::uint32_t count = 0;
    EXPECT_DONE(sunder_get_results(c_scene, &results, &count));
    const auto expected = scene->results();
    ASSERT_EQ(count, expected.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(results[i].command, expected[i].command);
      EXPECT_EQ(results[i].instance, c_id);
      EXPECT_EQ(results[i].status, static_cast<int>(expected[i].status.code()));
      EXPECT_EQ(std::string(results[i].error), expected[i].status.text());
      EXPECT_EQ(results[i].faces_crossed, expected[i].report.faces_crossed);
      EXPECT_EQ(results[i].length, expected[i].report.length_posed);
      EXPECT_EQ(results[i].has_piece, expected[i].piece != nullptr ? 1u : 0u);
    }
  }

  std::shared_ptr<const CharacterAsset> asset;
  std::optional<Scene> scene;
  InstanceId id;
  sunder_character c_character = 0;
  sunder_asset c_asset = 0;
  sunder_scene c_scene = 0;
  sunder_instance c_id = 0;
};

/// Submits one command of a random kind to both.
void submit_random(Twins& twins, Random& random) {
  const Character& character = twins.scene->find(twins.id)->character();
  const ModelPose& pose = twins.scene->find(twins.id)->pose();
  const Stroke stroke = random_stroke(character, pose, random, 0.3, 2 + random.index(4));
  SceneCommand command;
  switch (random.index(6)) {
    case 0: {
      PlaneCut cut;
      cut.point = stroke[0].tip;
      cut.normal = random.direction();
      cut.caps = random.index(2) == 0;
      if (random.index(2) == 0) cut.sections = {stroke[1].tip};
      if (random.index(2) == 0) cut.first_hit = SectionRay{stroke[0].base, {1, 0, 0}};
      sunder_cut c_cut = sunder_default_cut();
      for (int i = 0; i < 3; ++i) {
        c_cut.point[i] = cut.point[i];
        c_cut.normal[i] = cut.normal[i];
        c_cut.ray_origin[i] = stroke[0].base[i];
      }
      c_cut.has_caps = cut.caps ? 1 : 0;
      c_cut.sections = stroke[1].tip.data();
      c_cut.section_count = static_cast<std::uint32_t>(cut.sections.size());
      c_cut.has_first_hit = cut.first_hit ? 1 : 0;
      EXPECT_DONE(sunder_submit_cut(twins.c_scene, twins.c_id, &c_cut, 0, nullptr));
      command = cut;
      break;
    }
    case 1: {
      Bore bore;
      bore.origin = stroke[0].base;
      bore.direction = stroke[0].tip - stroke[0].base;
      bore.radius = 0.02;
      bore.depth = 0.1;
      bore.wall = random.index(2) == 0;
      sunder_bore c_bore = sunder_default_bore();
      for (int i = 0; i < 3; ++i) {
        c_bore.origin[i] = bore.origin[i];
        c_bore.direction[i] = bore.direction[i];
      }
      c_bore.radius = bore.radius;
      c_bore.depth = bore.depth;
      c_bore.has_wall = bore.wall ? 1 : 0;
      EXPECT_DONE(sunder_submit_drill(twins.c_scene, twins.c_id, &c_bore, 0, nullptr));
      command = bore;
      break;
    }
    case 2:
      EXPECT_DONE(sunder_submit_undo(twins.c_scene, twins.c_id, nullptr));
      command = UndoCommand();
      break;
    case 3:
      EXPECT_DONE(sunder_submit_redo(twins.c_scene, twins.c_id, nullptr));
      command = RedoCommand();
      break;
    default: {
      TearCommand tear{stroke, {}};
      tear.options.width = random.index(2) == 0 ? 0.01 : 0.0;
      tear.options.wall_depth = random.index(2) == 0 ? 0.02 : 0.0;
      if (random.index(3) == 0) tear.options.weights = {WeightPolicy::pose_exact, 3};
      sunder_tear_options options = sunder_default_tear_options();
      options.width = tear.options.width;
      options.wall_depth = tear.options.wall_depth;
      if (tear.options.weights) {
        options.weight_policy = SUNDER_WEIGHTS_POSE_EXACT;
        options.maximum_influences = 3;
      }
      const auto blades = blades_of(stroke);
      EXPECT_DONE(sunder_submit_tear(twins.c_scene, twins.c_id, blades.data(),
                                     static_cast<std::uint32_t>(blades.size()), &options, 0,
                                     nullptr));
      command = tear;
    }
  }
  ASSERT_TRUE(twins.scene->submit(twins.id, command));
}

TEST(CScene, random_commands_have_the_bits_of_the_library) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Twins twins(seed % 3 == 0 ? rich_character() : make_tube(24, 12, 6));
    twins.update();
    for (int frame = 0; frame < 20; ++frame) {
      submit_random(twins, random);
      twins.update();
      twins.expect_same_results();
      twins.expect_same();
    }
  }
}

TEST(CScene, a_stroke_over_frames_has_the_bits_of_the_library) {
  Random random(3);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  const Stroke stroke =
      random_stroke(*twins.asset->character(), twins.scene->find(twins.id)->pose(), random, 0.4, 8);
  sunder_tear_options options = sunder_default_tear_options();
  options.width = 0.01;
  sunder_stroke_sampling sampling = sunder_default_stroke_sampling();
  sampling.minimum_distance = 1e-4;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const sunder_blade blade = blade_of(stroke[i]);
    const double seconds = static_cast<double>(i) / 64;
    if (i == 0) {
      EXPECT_DONE(sunder_submit_begin_stroke(twins.c_scene, twins.c_id, &blade, &options, &sampling,
                                             nullptr));
      ASSERT_TRUE(
          twins.scene->submit(twins.id, BeginStrokeCommand{stroke[i], {.width = 0.01}, {1e-4, 0}}));
    } else {
      EXPECT_DONE(sunder_submit_extend_stroke(twins.c_scene, twins.c_id, &blade, seconds, nullptr));
      ASSERT_TRUE(twins.scene->submit(twins.id, ExtendStrokeCommand{stroke[i], seconds}));
    }
    twins.update();
    twins.expect_same_results();
    twins.expect_same();
  }
  sunder_command number = 0;
  EXPECT_DONE(sunder_submit_end_stroke(twins.c_scene, twins.c_id, &number));
  EXPECT_EQ(*twins.scene->submit(twins.id, EndStrokeCommand()), number);
  twins.update();
  twins.expect_same();
  std::uint32_t undo = 0, redo = 9;
  EXPECT_DONE(sunder_get_undo_counts(twins.c_scene, twins.c_id, &undo, &redo));
  EXPECT_EQ(undo, 1u);
  EXPECT_EQ(redo, 0u);
}

TEST(CScene, a_mirror_of_what_changed_is_the_whole) {
  Random random(5);
  Twins twins(make_tube(24, 12, 6));
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles;
  std::uint64_t seen = 0;
  for (int frame = 0; frame < 30; ++frame) {
    if (frame > 0 && frame % 3 == 0) submit_random(twins, random);
    twins.update();
    const sunder_posed_mesh part = posed_mesh(twins.c_scene, twins.c_id, 0, seen);
    positions.resize(3 * part.vertex_count);
    for (std::uint32_t i = 0; i < part.dirty_vertex_count; ++i)
      std::copy_n(part.positions + 3 * part.dirty_vertices[i].first,
                  3 * part.dirty_vertices[i].count,
                  positions.begin() + 3 * part.dirty_vertices[i].first);
    if (part.initial_triangle_count > 0)
      triangles.assign(part.initial_triangles,
                       part.initial_triangles + 3 * part.initial_triangle_count);
    triangles.resize(3 * part.triangle_capacity);
    for (std::uint32_t i = 0; i < part.triangle_write_count; ++i)
      std::copy_n(part.triangle_writes[i].vertices, 3,
                  triangles.begin() + 3 * part.triangle_writes[i].place);
    seen = part.epoch;
    const sunder_posed_mesh whole = posed_mesh(twins.c_scene, twins.c_id, 0);
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(), whole.positions));
    ASSERT_GT(whole.range_count, 0u);
    // What is drawn are the triangles of the torn mesh.
    sunder_mesh torn = {};
    EXPECT_DONE(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn));
    std::vector<std::array<std::uint32_t, 3>> drawn, expected;
    for (std::uint32_t r = 0; r < whole.range_count; ++r)
      for (std::uint32_t i = 0; i < whole.ranges[r].triangle_count; ++i) {
        const std::uint32_t* const at = &triangles[3 * (whole.ranges[r].first_triangle + i)];
        if (at[0] != at[1] || at[1] != at[2]) drawn.push_back({at[0], at[1], at[2]});
      }
    for (std::uint32_t i = 0; i < torn.triangle_count; ++i) {
      const std::uint32_t* const at = torn.triangles + 3 * i;
      if (at[0] != at[1] || at[1] != at[2]) expected.push_back({at[0], at[1], at[2]});
    }
    std::sort(drawn.begin(), drawn.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(drawn, expected);
  }
}

TEST(CScene, a_log_makes_the_same_model_again) {
  Random random(8);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  for (int i = 0; i < 8; ++i) {
    submit_random(twins, random);
    twins.update();
  }
  sunder_bytes json = 0;
  EXPECT_DONE(sunder_get_log(twins.c_scene, twins.c_id, &json));
  const std::string log = take_bytes(json);
  sunder_instance second = 0;
  EXPECT_DONE(sunder_spawn(twins.c_scene, twins.c_asset, nullptr, &second));
  std::uint32_t count = 0, undo = 0, redo = 0;
  EXPECT_DONE(sunder_apply_log(twins.c_scene, second, log.data(), log.size(), &count));
  EXPECT_DONE(sunder_get_undo_counts(twins.c_scene, twins.c_id, &undo, &redo));
  EXPECT_EQ(count, undo);
  EXPECT_GT(count, 0u);
  std::uint64_t first_digest = 0, second_digest = 1;
  EXPECT_DONE(sunder_get_digest(twins.c_scene, twins.c_id, &first_digest));
  EXPECT_DONE(sunder_get_digest(twins.c_scene, second, &second_digest));
  EXPECT_EQ(first_digest, second_digest);

  // It stops at the first operation that fails, and says which.
  const std::string bad =
      R"({"sunder_operations": 1, "operations": [{"op": "undo"}, {"op": "redo", "count": 7}]})";
  EXPECT_EQ(sunder_apply_log(twins.c_scene, second, bad.data(), bad.size(), &count),
            SUNDER_NOT_FOUND);
  EXPECT_EQ(count, 1u);
  EXPECT_EQ(sunder_last_error_index(), 1u);
  EXPECT_EQ(sunder_apply_log(twins.c_scene, second, "[]", 2, &count), SUNDER_MALFORMED_FILE);
}

TEST(CScene, a_torn_instance_is_written_as_by_the_library) {
  const Character character = rich_character();
  const auto glb = save_glb(character);
  const auto loaded = load_glb(*glb);
  sunder_character handle = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_load_glb(glb->data(), glb->size(), nullptr, &handle));
  EXPECT_DONE(sunder_create_asset(handle, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(nullptr, &scene));
  EXPECT_DONE(sunder_spawn(scene, asset, nullptr, &id));
  auto model = *TornModel::create(loaded->character);
  Random random(2);
  std::vector<Operation> operations = {random_operation(model, random),
                                       random_operation(model, random)};
  for (const Operation& one : operations) ASSERT_TRUE(apply_operation(model, one));
  const std::string log = *format_operations(operations);
  EXPECT_DONE(sunder_apply_log(scene, id, log.data(), log.size(), nullptr));
  sunder_bytes bytes = 0;
  EXPECT_DONE(sunder_save_instance(scene, id, nullptr, &bytes));
  const auto expected = save_glb(model.character(), *loaded);
  ASSERT_TRUE(expected);
  EXPECT_EQ(take_bytes(bytes),
            std::string(reinterpret_cast<const char*>(expected->data()), expected->size()));
  // Objects live on while others need them, whichever is destroyed first.
  EXPECT_DONE(sunder_destroy_character(handle));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_update(scene, 0.1));
  EXPECT_DONE(sunder_save_instance(scene, id, nullptr, &bytes));
  EXPECT_DONE(sunder_destroy_bytes(bytes));
  EXPECT_DONE(sunder_destroy_scene(scene));
}

TEST(CScene, a_snapshot_goes_on_with_the_same_bits) {
  Random random(4);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  for (int i = 0; i < 4; ++i) {
    submit_random(twins, random);
    twins.update();
  }
  sunder_bytes snapshot = 0;
  EXPECT_DONE(sunder_save_scene(twins.c_scene, &snapshot));
  const std::string bytes = take_bytes(snapshot);
  sunder_scene other = 0;
  EXPECT_DONE(sunder_create_scene(nullptr, &other));
  EXPECT_EQ(sunder_restore_scene(other, bytes.data(), bytes.size(), nullptr, 0, nullptr),
            SUNDER_NOT_FOUND);
  EXPECT_DONE(sunder_restore_scene(other, bytes.data(), bytes.size(), &twins.c_asset, 1, nullptr));
  for (int i = 0; i < 10; ++i) {
    twins.update();
    EXPECT_DONE(sunder_update(other, 1.0 / 64));
    const sunder_posed_mesh expected = posed_mesh(twins.c_scene, twins.c_id, 0);
    const sunder_posed_mesh posed = posed_mesh(other, twins.c_id, 0);
    ASSERT_EQ(posed.vertex_count, expected.vertex_count);
    EXPECT_EQ(0, std::memcmp(posed.positions, expected.positions, 12u * posed.vertex_count));
  }
  std::string cut_off = bytes.substr(0, bytes.size() - 5);
  EXPECT_NE(sunder_restore_scene(other, cut_off.data(), cut_off.size(), &twins.c_asset, 1, nullptr),
            SUNDER_OK);
  sunder_restore_options limits = sunder_default_restore_options();
  limits.memory = 1000;
  EXPECT_EQ(sunder_restore_scene(other, bytes.data(), bytes.size(), &twins.c_asset, 1, &limits),
            SUNDER_LIMIT_EXCEEDED);
  EXPECT_DONE(sunder_destroy_scene(other));
}

TEST(CScene, a_piece_comes_off) {
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

TEST(CScene, contacts_are_those_of_the_library) {
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

TEST(CScene, tissue_follows_holds_and_colliders_as_in_the_library) {
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

TEST(CScene, layers_and_poses_are_those_of_the_library) {
  Twins twins(make_tube(24, 12, 6), false);
  sunder_layer_options options = sunder_default_layer_options();
  options.kind = SUNDER_LAYER_ADDITIVE;
  options.weight = 0.5f;
  options.speed = 2.0;
  options.mask_bone = 2;
  sunder_layer layer = 0;
  EXPECT_DONE(sunder_play(twins.c_scene, twins.c_id, 0, &options, &layer));
  LayerOptions expected;
  expected.kind = LayerKind::additive;
  expected.weight = 0.5f;
  expected.speed = 2.0;
  expected.mask =
      std::make_shared<const BoneMask>(*subtree_mask(twins.asset->character()->skeleton, 2));
  const auto id = twins.scene->play(twins.id, 0, expected);
  ASSERT_TRUE(id);
  for (int i = 0; i < 5; ++i) twins.update();
  twins.expect_same();
  EXPECT_DONE(sunder_fade_layer(twins.c_scene, twins.c_id, layer, 1.0f, 0.1));
  EXPECT_TRUE(twins.scene->player(twins.id)->fade(*id, 1.0f, 0.1));
  EXPECT_DONE(sunder_seek_layer(twins.c_scene, twins.c_id, layer, 0.7));
  EXPECT_TRUE(twins.scene->player(twins.id)->seek(*id, 0.7));
  for (int i = 0; i < 5; ++i) twins.update();
  twins.expect_same();
  sunder_layer_state state = {};
  state.struct_size = sizeof state;
  EXPECT_DONE(sunder_get_layer(twins.c_scene, twins.c_id, layer, &state));
  EXPECT_EQ(state.time, twins.scene->player(twins.id)->layer(*id)->time);
  EXPECT_DONE(sunder_stop_layer(twins.c_scene, twins.c_id, layer, 0.0));
  twins.update();
  EXPECT_EQ(sunder_get_layer(twins.c_scene, twins.c_id, layer, &state), SUNDER_NOT_FOUND);
  EXPECT_TRUE(twins.scene->player(twins.id)->stop(*id));

  Random random(1);
  const ModelPose pose = random_pose(*twins.asset->character(), random);
  EXPECT_DONE(sunder_set_matrices(twins.c_scene, twins.c_id, pose.model_from_bone[0].data(), 6,
                                  pose.morph_weights.data()));
  EXPECT_TRUE(twins.scene->set_pose(twins.id, pose));
  twins.update();
  twins.expect_same();
  const double* matrices = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_pose(twins.c_scene, twins.c_id, &matrices, &count));
  EXPECT_EQ(count, 6u);
  EXPECT_EQ(0, std::memcmp(matrices, pose.model_from_bone[0].data(), 6 * 96));
  EXPECT_EQ(sunder_set_matrices(twins.c_scene, twins.c_id, matrices, 5, nullptr),
            SUNDER_SIZE_MISMATCH);
}

void run_backwards(void* context, std::uint32_t count, sunder_task task, const void* work) {
  ++*static_cast<int*>(context);
  for (std::uint32_t i = count; i-- > 0;) task(work, i);
}
void run_now(void* context, void (*task)(void*), void* data) {
  ++*static_cast<int*>(context);
  task(data);
}

TEST(CScene, hooks_are_called) {
  int parallel = 0, background = 0;
  sunder_scene_options options = sunder_default_scene_options();
  options.parallel_for = run_backwards;
  options.parallel_context = &parallel;
  options.parallel_threads = 4;
  options.background = run_now;
  options.background_context = &background;
  options.background_updates = 1;
  const sunder_character character = create(make_tube(40, 30, 6));
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_create_asset(character, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(&options, &scene));
  for (int i = 0; i < 40; ++i) {
    EXPECT_DONE(sunder_spawn(scene, asset, nullptr, &id));
    EXPECT_DONE(sunder_play(scene, id, 0, nullptr, nullptr));
  }
  EXPECT_DONE(sunder_update(scene, 0.1));
  sunder_cut cut = sunder_default_cut();
  EXPECT_DONE(sunder_submit_cut(scene, id, &cut, SUNDER_IN_BACKGROUND, nullptr));
  for (int i = 0; i < 4; ++i) EXPECT_DONE(sunder_update(scene, 0.1));
  EXPECT_GT(parallel, 0);
  EXPECT_GT(background, 0);
  std::uint64_t digest = 0;
  EXPECT_DONE(sunder_get_digest(scene, id, &digest));
  EXPECT_NE(digest, 0u);
  EXPECT_DONE(sunder_destroy_scene(scene));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CScene, a_full_model_of_fixed_capacity_says_so) {
  const sunder_character character = create(make_tube(24, 12, 6));
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_create_asset(character, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(nullptr, &scene));
  sunder_spawn_options options = sunder_default_spawn_options();
  options.vertices = 2;
  options.triangles = 2;
  options.operations = 1;
  EXPECT_DONE(sunder_spawn(scene, asset, &options, &id));
  sunder_cut cut = sunder_default_cut();
  EXPECT_DONE(sunder_submit_cut(scene, id, &cut, 0, nullptr));
  EXPECT_DONE(sunder_update(scene, 0.1));
  const sunder_result* results = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_results(scene, &results, &count));
  ASSERT_EQ(count, 1u);
  EXPECT_EQ(results[0].status, SUNDER_CAPACITY_EXCEEDED);
  EXPECT_DONE(sunder_destroy_scene(scene));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CScene, a_warm_frame_does_not_allocate) {
  Random random(1);
  Twins twins(make_tube(24, 12, 6));
  for (int i = 0; i < 4; ++i) {
    twins.update();
    submit_random(twins, random);
  }
  const auto frame = [&] {
    EXPECT_EQ(sunder_update(twins.c_scene, 1.0 / 64), SUNDER_OK);
    const sunder_result* results = nullptr;
    std::uint32_t count = 0;
    EXPECT_EQ(sunder_get_results(twins.c_scene, &results, &count), SUNDER_OK);
    sunder_posed_mesh mesh = {};
    mesh.struct_size = sizeof mesh;
    EXPECT_EQ(sunder_get_posed_mesh(twins.c_scene, twins.c_id, 0, 0, &mesh), SUNDER_OK);
    sunder_mesh torn = {};
    EXPECT_EQ(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn), SUNDER_OK);
    const sunder_instance* drawn = nullptr;
    EXPECT_EQ(sunder_get_drawn(twins.c_scene, &drawn, &count), SUNDER_OK);
    EXPECT_EQ(count, 1u);
  };
  for (int i = 0; i < 120; ++i) frame();
  const std::uint64_t before = allocation_count();
  for (int i = 0; i < 20; ++i) frame();
  EXPECT_EQ(allocation_count(), before);
}

TEST(CScene, without_memory_calls_fail_and_change_nothing) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP() << "the sanitizer has operator new";
  const Character character = rich_character();
  const CArrays arrays(character);
  int failed = 0;
  const auto starve = [&](const auto& call) {
    for (std::uint64_t count = 0;; count = count < 40 ? count + 1 : count * 5 / 4) {
      const sunder_status status = [&] {
        const FailingAllocations failing(count);
        return call();
      }();
      if (status == SUNDER_OK) return;
      EXPECT_EQ(status, SUNDER_LIMIT_EXCEEDED) << sunder_last_error();
      ++failed;
    }
  };
  sunder_character handle = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  sunder_bytes bytes = 0;
  starve([&] { return sunder_create_character(&arrays.data, &handle); });
  starve([&] { return sunder_create_asset(handle, nullptr, &asset); });
  sunder_scene_options options = sunder_default_scene_options();
  options.threads = 1;
  starve([&] { return sunder_create_scene(&options, &scene); });
  starve([&] { return sunder_spawn(scene, asset, nullptr, &id); });
  sunder_cut cut = sunder_default_cut();
  starve([&] { return sunder_submit_cut(scene, id, &cut, 0, nullptr); });
  starve([&] { return sunder_update(scene, 0.1); });
  starve([&] { return sunder_save_scene(scene, &bytes); });
  EXPECT_GT(failed, 50);
  EXPECT_DONE(sunder_destroy_scene(scene));
}

TEST(CScene, vertices_are_posed_into_memory_of_the_program) {
  Twins twins(make_tube(24, 12, 6), false);
  twins.update();
  const std::uint32_t vertices = posed_mesh(twins.c_scene, twins.c_id, 0).vertex_count;
  std::vector<float> buffer(8 * vertices, -1.0f);
  sunder_vertex_target target = sunder_default_vertex_target();
  target.vertex_count = vertices;
  target.positions = buffer.data();
  target.normals = buffer.data() + 4;
  target.position_stride = target.normal_stride = 32;
  EXPECT_DONE(sunder_set_vertex_target(twins.c_scene, twins.c_id, 0, &target));
  twins.update();
  const PosedMesh expected = twins.scene->mesh(twins.id, 0);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    EXPECT_EQ(0, std::memcmp(&buffer[8 * v], expected.positions[v].data(), 12));
    EXPECT_EQ(0, std::memcmp(&buffer[8 * v + 4], expected.normals[v].data(), 12));
    EXPECT_EQ(buffer[8 * v + 3], -1.0f);
  }
}

}  // namespace
}  // namespace sunder::test
