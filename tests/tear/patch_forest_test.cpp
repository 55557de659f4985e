// The bounds of surface patches hold in every pose, and queries that rely on them find the same as
// testing every face.
#include "tear/posed/patch_forest.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <bit>
#include <cstdlib>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/machine/say.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/surface_scans.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/internal/surface.h"
#include "tear/operation/cut.h"
#include "tear/operation/drill.h"
#include "tear/operation/ongoing_stroke.h"
#include "tear/path/faces_near_blades.h"
#include "tear/posed/hilbert_curve.h"
#include "tear/sheet/gap.h"
#include "tear/sheet/open_sheet.h"

namespace sunder::tear {
namespace {

using test::Random;

std::uint64_t count_of_cases(std::uint64_t usual) {
  return std::getenv("SUNDER_STRESS") != nullptr ? 40 * usual : usual;
}

/// A model with random tears.
class Torn {
 public:
  explicit Torn(Character of)
      : source(std::move(of)), character(source), editor(source, character) {
    stand_in(*bind_pose(source));
  }

  void stand_in(const ModelPose& wanted) {
    pose = wanted;
    ASSERT_TRUE(posed.begin(source, pose));
  }

  void operate(Random& random) {
    if (!has_area()) return;  // then a stroke has no target
    const auto model = TornModel::create(std::make_shared<const Character>(source));
    const Operation operation = test::random_operation(*model, random);
    const EditLog::Mark begin = editor.mark();
    editor.scratch().reset();
    editor.opened_edges.begin(true);
    OpenedBorders borders;
    Outcome outcome{{}, borders};
    if (const auto* tear = std::get_if<TearOperation>(&operation)) {
      stand_in(std::get<ModelPose>(tear->pose));
      OngoingStroke stroke;
      stroke.begin(tear->stroke.front(), tear->options);
      for (std::size_t i = 1; i < tear->stroke.size(); ++i)
        stroke.extend(tear->stroke[i], {editor, posed}, outcome);
      stroke.finish({editor, posed}, outcome);
    } else if (const auto* cut = std::get_if<CutOperation>(&operation)) {
      stand_in(std::get<ModelPose>(cut->pose));
      cut_surface(cut->cut, {editor, posed}, outcome);
    } else {
      const auto& drill = std::get<DrillOperation>(operation);
      stand_in(std::get<ModelPose>(drill.pose));
      drill_surface(drill.bore, {editor, posed}, outcome);
    }
    done.push_back(begin);
    undone.clear();
  }
  void undo() {
    if (done.empty()) return;
    editor.undo(done.back(), undone.emplace_back(), nullptr);
    done.pop_back();
    stand_in(pose);
  }
  void redo() {
    if (undone.empty()) return;
    done.push_back(editor.mark());
    editor.redo(undone.back(), nullptr);
    undone.pop_back();
    stand_in(pose);
  }
  /// One of all these.
  void change(Random& random) {
    switch (random.index(5)) {
      case 0: return undo();
      case 1: return redo();
      default: return operate(random);
    }
  }

  [[nodiscard]] bool has_area() const {
    return std::any_of(source.meshes.begin(), source.meshes.end(), [](const Mesh& mesh) {
      return std::any_of(
          mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& triangle) {
            const Vec3f a = mesh.positions[triangle[0]], b = mesh.positions[triangle[1]],
                        c = mesh.positions[triangle[2]];
            return (b - a).cross(c - a).norm() > 1e-4f;
          });
    });
  }

  Character source, character;
  SurfaceEditor editor;
  PosedPoints posed;
  ModelPose pose;
  std::vector<EditLog::Mark> done;
  std::vector<SurfaceEditor::Redo> undone;
};

Character some_forest_rig(Random& random) {
  Character character;
  switch (random.index(6)) {
    case 0: return test::make_sheet(1 + random.index(20));
    case 1: return test::make_two_tubes(3 + random.index(4), 5 + random.index(6));
    case 2: return test::make_soup(random);
    case 3: character = test::make_bumpy_ball(100 + random.index(500)); break;
    default: {
      const std::uint32_t rings = 3 + random.index(20),
                          // evaluated in this order by every compiler
          sides = 5 + random.index(20);
      character = test::make_tube(rings, sides, 2 + random.index(9));
    }
  }
  Mesh& mesh = character.meshes[0];
  if (random.index(2) == 0) {
    for (MorphTarget& target : mesh.morph_targets) target.position_deltas.clear();
    return character;
  }
  // More targets, one of which moves nothing and one only a part.
  for (const char* name : {"none", "some", "much"}) {
    MorphTarget target{name, std::vector<Vec3f>(mesh.vertex_count(), Vec3f::Zero()), {}, {}};
    if (target.name != "none")
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        if (target.name == "much" || v % 7 == 0)
          target.position_deltas[v] = (0.3 * random.direction()).cast<float>();
    mesh.morph_targets.push_back(target);
  }
  mesh.morph_targets.push_back({"empty", {}, {}, {}});
  character.rest_morph_weights.resize(mesh.first_morph_weight + mesh.morph_targets.size(), 0.0f);
  return character;
}

/// Bones collapsed, mirrored, sheared and far away; morph weights below 0 and above 1.
ModelPose wild_pose(const Character& character, Random& random) {
  ModelPose pose = test::random_pose(character, random, 3, 2);
  for (Affine3d& bone : pose.model_from_bone) {
    const auto entry = [&] { return random.uniform(-2, 2); };
    switch (random.index(8)) {
      case 0: bone.linear().setZero(); break;
      case 1: bone.linear().col(1).setZero(); break;
      case 2: bone.linear().col(2) *= -1; break;
      case 3:
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) bone.linear()(i, j) = entry();
        break;
      case 4:
        bone.translation() += Vec3d(random.direction() * std::pow(10.0, random.uniform(-3, 3)));
        break;
      default: break;
    }
  }
  if (random.index(3) == 0) {
    const Vec3d away = 1e6 * random.direction();
    for (Affine3d& bone : pose.model_from_bone) bone.translation() += away;
  }
  for (float& weight : pose.morph_weights) weight = static_cast<float>(random.uniform(-2, 3));
  return pose;
}

ModelPose some_pose(const Character& character, Random& random) {
  return random.index(2) == 0 ? wild_pose(character, random) : test::random_pose(character, random);
}

bool holds(const FrameBox& box, const Vec3d& point) {
  return (box.low.array() <= point.array()).all() && (point.array() <= box.high.array()).all();
}

bool holds(const Shadow& shadow, const Vec3d& point) {
  bool is_held = shadow.low <= point.x() && point.x() <= shadow.high;
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = shadow.normal[k].dot(Vec2d(point.y(), point.z()));
    is_held = is_held && shadow.from[k] <= at && at <= shadow.to[k];
  }
  return is_held;
}

/// Reports a live face that is not in exactly one patch, or a posed point outside a box that should
/// contain it.
std::vector<std::string> broken_bounds(Torn& torn, Random& random) {
  std::vector<std::string> broken;
  PatchForest& forest = torn.posed.forest();
  const Frame frame =
      torn.posed.frame_along(axes_along(random.direction(), random.direction()), torn.editor);
  const CharacterPose& pose = torn.posed.pose();
  std::vector<int> found(torn.editor.surface().triangle_count(), 0);
  std::vector<Mesh> meshes = torn.character.meshes;
  forest.stand_in(torn.editor, pose, frame);
  for (PatchForest::Covered* covered : forest.trees(torn.editor)) {
    const PatchTree& tree = *covered->tree;
    Mesh& mesh = meshes[covered->mesh];
    const MeshPose mesh_pose = forest.pose_of(mesh, pose);
    std::array<FrameBox, PatchTree::kPatchesPerGroup> patches;
    std::array<Shadow, PatchTree::kPatchesPerGroup> shadows;
    for (Index group = 0; group < tree.node_count(0); ++group) {
      const Index count = tree.compute_posed_patches(group, mesh_pose, patches);
      EXPECT_EQ(tree.compute_posed_patches(group, mesh_pose, shadows), count);
      for (Index i = 0; i < count; ++i) {
        std::vector<FrameBox> boxes = {patches[i]};
        for (Index level = 0, number = group; level < tree.level_count();
             ++level, number /= PatchTree::kFanOut)
          boxes.push_back(tree.posed_box(level, number, mesh_pose, forest.epoch(), covered->boxes));
        const auto check = [&](Index vertex, Index face) {
          const Vec3d at = frame.place_of(pose.position(mesh, vertex));
          for (std::size_t box = 0; box < boxes.size(); ++box)
            if (!holds(boxes[box], at))
              broken.push_back(test::say("face ", face, " outside of its box ", box));
          if (!holds(shadows[i], at))
            broken.push_back(test::say("face ", face, " outside of its shadow"));
        };
        for (const Index origin : tree.origins(PatchTree::kPatchesPerGroup * group + i)) {
          if (origin >= covered->end) continue;  // undone since
          torn.editor.origins.for_each_part(covered->mesh, origin, [&](Index face) {
            ++found[face];
            const Triangle vertices = mesh.triangles[torn.editor.surface().triangle(face).triangle];
            for (const Index vertex : vertices) check(vertex, face);
            for (int k = 0; k < 2; ++k) {
              const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
              check(append_interpolated_vertex(vertices, {1 - u - v, u, v}, mesh), face);
              remove_vertices_from(mesh.vertex_count() - 1, mesh);
            }
          });
        }
      }
    }
  }
  for (Index face = 0; face < found.size(); ++face)
    if (found[face] != (torn.editor.surface().has_repeated_point(face) ? 0 : 1))
      broken.push_back(test::say("face ", face, " found ", found[face], " times"));
  return broken;
}

/// Reports patches with vertices that are not on the side of a random plane on which the nodes and
/// patches are said to be. Adds the patches that are on one side to `known`.
std::vector<std::string> broken_sides(Torn& torn, Random& random, std::size_t& known) {
  std::vector<std::string> broken;
  PatchForest& forest = torn.posed.forest();
  const CharacterPose& pose = torn.posed.pose();
  const Surface& surface = torn.editor.surface();
  const Index point = random.index(surface.source_point_count());
  const Vec3d normal = random.direction();
  PlaneSide plane = {normal, 0};
  if (surface.point_corner[point] != kNone)
    plane.offset = dot(normal, Vec3d(torn.posed.position(torn.editor, point)));
  std::vector<Mesh> meshes = torn.character.meshes;
  for (PatchForest::Covered* covered : forest.trees(torn.editor)) {
    const PatchTree& tree = *covered->tree;
    Mesh& mesh = meshes[covered->mesh];
    torn.editor.scratch().reset();
    const PlaneDistances distances(plane, pose.palette(mesh.skin), 0, torn.editor.scratch());
    for (Index patch = 0; patch < tree.patch_count(); ++patch) {
      const Index group = patch / PatchTree::kPatchesPerGroup;
      std::uint8_t side = PlaneDistances::kAcross;  // the intersection of those of all nodes above
      for (Index level = 0, number = group; level < tree.level_count();
           ++level, number /= PatchTree::kFanOut)
        side &= tree.side_of(level, number, distances);
      const bool is_across =
          (tree.patches_across(group, distances) >> (patch % PatchTree::kPatchesPerGroup) & 1) != 0;
      known += is_across ? 0 : 1;
      std::uint8_t sides = 0;  // of the vertices of the patch
      const auto add = [&](Index vertex) {
        sides |= plane.contains(pose.position(mesh, vertex)) ? PlaneDistances::kInside
                                                             : PlaneDistances::kOutside;
      };
      for (const Index origin : tree.origins(patch))
        torn.editor.origins.for_each_part(covered->mesh, origin, [&](Index face) {
          const Triangle vertices = mesh.triangles[surface.triangle(face).triangle];
          for (const Index vertex : vertices) add(vertex);
          const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
          add(append_interpolated_vertex(vertices, {1 - u - v, u, v}, mesh));
          remove_vertices_from(mesh.vertex_count() - 1, mesh);
        });
      if ((sides & ~side) != 0 || (!is_across && sides == PlaneDistances::kAcross))
        broken.push_back(test::say("patch ", patch, " has vertices on sides ", int{sides}));
    }
  }
  return broken;
}

/// The half-spaces of a cell whose bits contradict the corners of a face.
int count_wrong_bits(const CellFace& face, const CellSides& sides) {
  const CellSides::OfFace of = sides.at(face.places);
  int wrong = 0;
  for (Index side = 0; side < sides.cell().size(); ++side)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto is_set = [&](const CellSides::Word* bits) {
        return (bits[side / CellSides::kBits] >> side % CellSides::kBits & 1) != 0;
      };
      const PlaneSide& plane = sides.cell()[side];
      const Vec3d& corner = sides.position(face.places[k]);
      if (is_set(of.outside[k]) == plane.contains(corner)) ++wrong;
      if (is_set(of.inside[k]) && !(plane.value(corner) > 0)) ++wrong;
      if (face.is_inside && !is_set(of.inside[k])) ++wrong;
    }
  return wrong;
}

TEST(PatchForest, hilbert_curve_goes_from_neighbour_to_neighbour) {
  std::map<std::uint64_t, std::array<std::uint32_t, 3>> cells;
  for (std::uint32_t x = 0; x < 16; ++x)
    for (std::uint32_t y = 0; y < 16; ++y)
      for (std::uint32_t z = 0; z < 16; ++z) cells[HilbertCurve::number_of({x, y, z})] = {x, y, z};
  ASSERT_EQ(cells.size(), 4096u);
  EXPECT_EQ(cells.rbegin()->first, 4095u);
  for (auto at = cells.begin(), next = std::next(at); next != cells.end(); ++at, ++next) {
    int steps = 0;
    for (std::size_t k = 0; k < 3; ++k)
      steps += std::abs(static_cast<int>(at->second[k]) - static_cast<int>(next->second[k]));
    ASSERT_EQ(steps, 1);
  }
}

/// @param known_sides  raised by the sides that are known.
void expect_bounds_hold(std::uint64_t seed, std::size_t& known_sides) {
  SCOPED_TRACE(seed);
  Random random(seed);
  Torn torn(some_forest_rig(random));
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 3; ++k) {
      torn.stand_in(some_pose(torn.source, random));
      ASSERT_THAT(broken_bounds(torn, random), testing::IsEmpty());
      ASSERT_THAT(broken_sides(torn, random, known_sides), testing::IsEmpty());
    }
    torn.change(random);
  }
}

TEST(PatchForest, holds_the_surface_in_every_pose) {
  std::size_t known_sides = 0;
  for (std::uint64_t seed = 0; seed < count_of_cases(60); ++seed)
    expect_bounds_hold(seed, known_sides);
  EXPECT_GT(known_sides, 2000u);
}

/// A tree keeps fillings that were undone, and a newer one has those that took their indices.
TEST(PatchForest, holds_fillings_made_after_others_were_undone) {
  std::size_t known_sides = 0;
  expect_bounds_hold(1747, known_sides);
}

bool is_same(const std::optional<SurfaceHit>& a, const std::optional<SurfaceHit>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->triangle == b->triangle && a->barycentric == b->barycentric &&
                a->position == b->position && a->progress_beyond == b->progress_beyond);
}

std::string say_hit(const std::optional<SurfaceHit>& hit) {
  return hit ? test::say(hit->triangle, " at ", hit->position.transpose()) : "nothing";
}

/// A live face, or kNone.
Index some_face(const SurfaceEditor& editor, Random& random) {
  for (int i = 0; i < 100; ++i) {
    const Index face = random.index(editor.surface().triangle_count());
    if (!editor.surface().has_repeated_point(face)) return face;
  }
  return kNone;
}

/// Blades that meet the surface anywhere: within faces, in points, on edges, along edges and faces.
Blade some_blade(Torn& torn, Index face, double size, Random& random) {
  std::array<Vec3d, 3> corners;
  for (Index k = 0; k < 3; ++k)
    corners[k] = torn.posed.position(torn.editor, torn.editor.surface().corner_point[3 * face + k]);
  Vec3d at = (corners[0] + corners[1] + corners[2]) / 3, along = random.direction();
  switch (random.index(6)) {
    case 0: at = corners[0]; break;
    case 1: at = 0.5 * (corners[0] + corners[1]); break;
    case 2: along = Vec3d::Unit(static_cast<int>(random.index(3))); break;
    case 3:
      along = corners[1] - corners[0];
      at = corners[random.index(3)];
      break;
    case 4:
      along = corners[1] + random.uniform(0, 1) * (corners[2] - corners[1]) - corners[0];
      break;
    default: break;
  }
  const double length = along.norm();
  if (!(length > 1e-12 * size)) along = random.direction();
  along *= size * random.uniform(0.01, 0.6) / along.norm();
  return {at - random.uniform(0, 1) * along, at + random.uniform(0, 1) * along + 1e-3 * along};
}

double size_of(Torn& torn) {
  Eigen::AlignedBox3d box;
  const Surface& surface = torn.editor.surface();
  for (Index corner = 0; corner < surface.corner_point.size(); ++corner)
    if (!surface.has_repeated_point(corner / 3))
      box.extend(Eigen::Vector3d(torn.posed.position(torn.editor, surface.corner_point[corner])));
  return box.isEmpty() ? 1.0 : std::max(1e-3, box.diagonal().norm());
}

TEST(PatchForest, finds_the_same_as_testing_every_face) {
  int hits = 0, contacts = 0, faces_in_cells = 0, faces_across_sheets = 0;
  for (std::uint64_t seed = 0; seed < count_of_cases(60); ++seed) {
    Random random(1000 + seed);
    Torn torn(some_forest_rig(random));
    for (int round = 0; round < 5; ++round) {
      torn.stand_in(random.index(3) == 0 ? wild_pose(torn.source, random)
                                         : test::random_pose(torn.source, random));
      const double size = size_of(torn);
      for (int i = 0; i < 30; ++i) {
        SCOPED_TRACE(test::say("seed ", seed, ", round ", round, ", query ", i));
        const Index face = some_face(torn.editor, random);
        if (face == kNone) break;
        const Blade blade = some_blade(torn, face, size, random);
        const auto expected = test::scan_for_hit(blade, torn.editor, torn.posed);
        const auto found = first_hit(blade, torn.editor, torn.posed);
        EXPECT_TRUE(is_same(found, expected))
            << say_hit(found) << " instead of " << say_hit(expected);
        const Workpiece work = {torn.editor, torn.posed};
        FacesNearBlades near(work);
        near.include(blade);
        near.include(some_blade(torn, face, size, random));
        near.collect();
        near.select(std::array{blade});
        const auto found_near = near.first_hit(blade);
        EXPECT_TRUE(is_same(found_near, expected))
            << say_hit(found_near) << " instead of " << say_hit(expected);
        hits += found ? 1 : 0;

        // A second blade that is rotated and moved relative to the first.
        const Vec3d along = blade.tip - blade.base,
                    aside = random.uniform(0.01, 1) * along.norm() * random.direction();
        const Vec3d turn = random.uniform(0, 0.6) * along.norm() * random.direction();
        const Blade to = {blade.base + aside, blade.tip + aside + turn};
        const Vec3d anchor = found ? found->position : Vec3d(0.5 * (blade.base + blade.tip));
        if (const auto plane = BladePlane::through(anchor, blade, to)) {
          const double progress = random.index(2) == 0 ? 0.0 : random.uniform(0, 1);
          const auto expected_contact =
              test::scan_for_contact(*plane, progress, torn.editor, torn.posed);
          const auto contact = first_contact(*plane, progress, torn.editor, torn.posed);
          EXPECT_TRUE(is_same(contact, expected_contact))
              << say_hit(contact) << " instead of " << say_hit(expected_contact);
          contacts += contact ? 1 : 0;
        }

        // A box, some sides of which may be missing.
        const Mat3d box = axes_along(along, random.direction());
        Cell cell;
        for (int k = 0; k < 3; ++k)
          for (const double sign : {-1.0, 1.0}) {
            if (random.index(6) == 0) continue;
            const Vec3d normal = sign * random.uniform(0.1, 10) * box.row(k).transpose();
            cell.push_back(
                {normal, normal.dot(blade.tip) - normal.norm() * size * random.uniform(0, 0.3)});
          }
        CellSides sides(cell, torn.editor, torn.posed);
        std::vector<Index> in_cell;
        for (const CellFace& found_face : faces_in_cell(sides)) {
          in_cell.push_back(found_face.face);
          EXPECT_EQ(count_wrong_bits(found_face, sides), 0);
        }
        EXPECT_EQ(in_cell, test::scan_for_faces_in(cell, torn.editor, torn.posed));
        faces_in_cells += in_cell.empty() ? 0 : 1;
        if (cell.empty()) continue;
        Sheet sheet{cell[0], {}};
        for (std::size_t k = 1; k < cell.size(); ++k) sheet.bounds.push_back({cell[k], kNone});
        const ScratchVector<Index> crossed = faces_across(sheet, torn.editor, torn.posed);
        const std::vector<Index> across(crossed.begin(), crossed.end());
        EXPECT_EQ(across, test::scan_for_faces_across(sheet, torn.editor, torn.posed));
        faces_across_sheets += across.empty() ? 0 : 1;
      }
      torn.change(random);
    }
  }
  EXPECT_GT(hits, 2000);
  EXPECT_GT(contacts, 1000);
  EXPECT_GT(faces_in_cells, 2000);
  EXPECT_GT(faces_across_sheets, 2000);
}

TEST(PatchForest, a_sweep_in_one_plane_begins_at_its_blade) {
  int entries = 0;
  for (std::uint64_t seed = 0; seed < count_of_cases(60); ++seed) {
    Random random(2000 + seed);
    Torn torn(some_forest_rig(random));
    torn.stand_in(test::random_pose(torn.source, random));
    const double size = size_of(torn);
    for (int i = 0; i < 30; ++i) {
      SCOPED_TRACE(test::say("seed ", seed, ", query ", i));
      const Index face = some_face(torn.editor, random);
      if (face == kNone) break;
      std::array<double, 3> part = {random.uniform(0, 1), random.uniform(0, 1),
                                    random.uniform(0, 1)};
      if (random.index(3) == 0) part[random.index(3)] = 0;  // on an edge
      Vec3d at = Vec3d::Zero();
      for (Index k = 0; k < 3; ++k)
        at += part[k] / (part[0] + part[1] + part[2]) *
              torn.posed.position(torn.editor, torn.editor.surface().corner_point[3 * face + k]);
      const Vec3d along = 0.4 * size * random.direction(),
                  aside = random.uniform(0.01, 1) * size * random.direction();
      const Blade from = {at - along, at + 0.1 * along}, to = {from.base + aside, from.tip + aside};
      const auto hit = first_hit(from, torn.editor, torn.posed);
      if (!hit) continue;
      const auto plane = BladePlane::through(hit->position, from, to);
      ASSERT_TRUE(plane);
      const auto contact = contact_at(*hit, *plane, torn.editor, torn.posed);
      if (!contact) continue;  // the sweep continues on another face
      const auto expected = test::scan_for_contact(*plane, 0, torn.editor, torn.posed);
      ASSERT_TRUE(expected);
      EXPECT_LT((contact->position - hit->position).norm(), 1e-6 * size);
      EXPECT_LT((contact->position - expected->position).norm(), 1e-6 * size);
      ++entries;
    }
  }
  EXPECT_GT(entries, 1000);
}

TEST(PatchForest, has_few_trees_of_caps) {
  Torn torn(test::make_tube(4, 6, 2));
  Random random(4);
  const Blade blade{{3, 1, 0.1}, {-3, 1, 0.1}};
  std::vector<std::size_t> tree_counts;
  std::size_t fillings = 0;
  for (int i = 0; i < 200; ++i) {
    const EditLog::Mark begin = torn.editor.mark();
    torn.editor.opened_edges.begin(true);
    OpenedBorders borders;
    Outcome outcome{{}, borders};
    cut_surface({{0, random.uniform(0.1, 1.9), 0}, {0, 1, 0}, {}, true}, {torn.editor, torn.posed},
                outcome);
    torn.done.push_back(begin);
    torn.stand_in(torn.pose);
    const auto hit = first_hit(blade, torn.editor, torn.posed);
    if (i % 10 == 0) {
      ASSERT_TRUE(is_same(hit, test::scan_for_hit(blade, torn.editor, torn.posed)));
    }
    fillings = torn.editor.fillings.of(0).size();
    ASSERT_LE(torn.posed.forest().filling_tree_count(0), std::bit_width(fillings));
    tree_counts.push_back(torn.posed.forest().filling_tree_count(0));
  }
  EXPECT_GT(fillings, 4000u);
  EXPECT_GT(*std::max_element(tree_counts.begin(), tree_counts.end()), 2u)
      << "nothing was put together";
  while (!torn.done.empty()) {
    torn.undo();
    const auto hit = first_hit(blade, torn.editor, torn.posed);
    if (torn.done.size() % 10 == 0) {
      ASSERT_TRUE(is_same(hit, test::scan_for_hit(blade, torn.editor, torn.posed)));
    }
    ASSERT_LE(torn.posed.forest().filling_tree_count(0),
              std::bit_width(torn.editor.fillings.of(0).size()));
  }
  EXPECT_EQ(torn.posed.forest().filling_tree_count(0), 0u);
  EXPECT_THAT(broken_bounds(torn, random), testing::IsEmpty());
}

TEST(PatchForest, bounds_a_bent_tube_closely) {
  Torn torn(test::make_tube(200, 200, 64));
  Random random(5);
  for (const double angle : {0.05, 0.2}) {
    torn.stand_in(test::random_pose(torn.source, random, angle, 1.05));
    const auto positions = test::posed_positions(torn.source, 0, torn.pose);
    const CharacterPose& pose = torn.posed.pose();
    PatchForest& forest = torn.posed.forest();
    forest.stand_in(torn.editor, pose, torn.posed.frame_along(Mat3d::Identity(), torn.editor));
    const PatchTree& tree = *forest.trees(torn.editor)[0]->tree;
    std::vector<double> ratios;
    std::array<FrameBox, PatchTree::kPatchesPerGroup> patches;
    for (Index group = 0; group < tree.node_count(0); ++group) {
      const Index count =
          tree.compute_posed_patches(group, forest.pose_of(torn.source.meshes[0], pose), patches);
      for (Index i = 0; i < count; ++i) {
        Eigen::AlignedBox3d truly;
        for (const Index origin : tree.origins(PatchTree::kPatchesPerGroup * group + i))
          for (const Index vertex : torn.source.meshes[0].triangles[origin])
            truly.extend(Eigen::Vector3d(positions[vertex]));
        ratios.push_back((patches[i].high - patches[i].low).norm() / truly.diagonal().norm());
      }
    }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_LT(ratios[ratios.size() / 2], 1.5) << angle;
    EXPECT_LT(ratios[ratios.size() * 9 / 10], 2) << angle;
  }
}

TEST(PatchForest, poses_few_points_for_an_entry) {
  Torn torn(test::make_tube(150, 150, 64));
  Random random(6);
  std::vector<std::size_t> known;
  for (int i = 0; i < 100; ++i) {
    const ModelPose pose = test::random_pose(torn.source, random, 0.05, 1.05);
    const Stroke stroke = test::random_stroke(torn.source, pose, random);
    torn.stand_in(pose);
    ASSERT_TRUE(first_hit(stroke[0], torn.editor, torn.posed));
    known.push_back(torn.posed.known_count());
  }
  std::sort(known.begin(), known.end());
  EXPECT_LT(known[50], 100u) << "of " << torn.editor.surface().point_count();
  EXPECT_LT(known.back(), torn.editor.surface().point_count() / 20);
}

}  // namespace
}  // namespace sunder::tear
