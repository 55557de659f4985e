// Slashes, severs and punctures aimed by bone on every available rigged file: each hits that limb
// and nothing else. Judged from the influences in the file, not by what resolve() uses.
#include <sunder/aim/aim.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using testing::IsEmpty;

constexpr std::array<double, 3> kShares = {0.25, 0.5, 0.75};
constexpr std::size_t kBonesPerFile = 5;

/// Calls visit(mesh, vertex) for the vertices of the source that triangles use.
template <class Visit>
void for_each_used_vertex(const Character& character, Visit visit) {
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    std::vector<bool> is_used(mesh.vertex_count(), false);
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) is_used[vertex] = true;
    for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
      if (is_used[vertex]) visit(m, vertex);
  }
}

double weight_of(const Character& character, std::uint32_t mesh, std::uint32_t vertex,
                 const std::vector<bool>& bones) {
  const Mesh& of = character.meshes[mesh];
  double weight = 0;
  for (const Influence& influence : of.weights.of(vertex))
    if (bones[character.skins[of.skin].bones[influence.slot]])
      weight += static_cast<double>(influence.weight);
  return weight;
}

/// Per bone, the number of vertices that it moves more than all other bones together.
std::vector<std::uint32_t> own_vertices(const Character& character) {
  std::vector<std::uint32_t> counts(character.skeleton.bones.size(), 0);
  for_each_used_vertex(character, [&](std::uint32_t m, std::uint32_t vertex) {
    const Mesh& mesh = character.meshes[m];
    for (const Influence& influence : mesh.weights.of(vertex))
      if (influence.weight > 0.5f) ++counts[character.skins[mesh.skin].bones[influence.slot]];
  });
  return counts;
}

/// Per vertex of a mesh, the bone that moves it most.
std::vector<std::uint32_t> movers_of(const Character& character, std::uint32_t m) {
  const Mesh& mesh = character.meshes[m];
  std::vector<std::uint32_t> movers(mesh.vertex_count(), kNone);
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
    float most = 0;
    for (const Influence& influence : mesh.weights.of(vertex))
      if (influence.weight > most) {
        most = influence.weight;
        movers[vertex] = character.skins[mesh.skin].bones[influence.slot];
      }
  }
  return movers;
}

bool is_above(const Skeleton& skeleton, std::uint32_t bone, std::uint32_t other) {
  for (; other != kNone; other = skeleton.bones[other].parent)
    if (other == bone) return true;
  return false;
}

/// The parents of the bones as an animator sees them. A rig for inverse kinematics hangs a foot on
/// the root: where no face joins a bone's vertices with those of a bone above it, it counts as a
/// child of the bone, not below it, with which it shares most faces.
std::vector<std::uint32_t> anatomical_parents(const Character& character) {
  const auto& bones = character.skeleton.bones;
  std::vector<std::map<std::uint32_t, std::uint32_t>> shared(bones.size());
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const std::vector<std::uint32_t> movers = movers_of(character, m);
    for (const Triangle& triangle : character.meshes[m].triangles)
      for (const std::uint32_t a : triangle)
        for (const std::uint32_t b : triangle)
          if (movers[a] != movers[b]) ++shared[movers[a]][movers[b]];
  }
  std::vector<std::uint32_t> parents(bones.size());
  for (std::uint32_t bone = 0; bone < bones.size(); ++bone) {
    parents[bone] = bones[bone].parent;
    bool adjoins = shared[bone].empty(), has_parent = false;
    for (std::uint32_t above = bones[bone].parent; above != kNone; above = bones[above].parent) {
      adjoins = adjoins || shared[bone].count(above) != 0;
      has_parent = true;
    }
    if (adjoins || !has_parent) continue;
    std::uint32_t most = 0;
    for (const auto& [other, faces] : shared[bone])
      if (faces > most && !is_above(character.skeleton, bone, other)) {
        most = faces;
        parents[bone] = other;
      }
  }
  return parents;
}

/// Whether most bones that move something have no bone above them that does: a flat list, in which
/// limbs cannot be told from the skeleton.
bool is_flat_list(const Character& character) {
  const std::vector<std::uint32_t> counts = own_vertices(character);
  std::uint32_t all = 0, roots = 0;
  for (std::uint32_t bone = 0; bone < counts.size(); ++bone) {
    if (counts[bone] == 0) continue;
    ++all;
    std::uint32_t above = character.skeleton.bones[bone].parent;
    while (above != kNone && counts[above] == 0) above = character.skeleton.bones[above].parent;
    if (above == kNone) ++roots;
  }
  return roots > 1 && 2 * roots > all;
}

/// A bone and all below it, and parts of it that the file splits by material.
std::vector<bool> subtree_of(const Character& character, std::uint32_t top) {
  const auto& bones = character.skeleton.bones;
  const std::vector<std::uint32_t> parents = anatomical_parents(character);
  std::vector<bool> is_below(bones.size(), false);
  for (std::uint32_t bone = 0; bone < bones.size(); ++bone) {
    std::size_t steps = 0;
    for (std::uint32_t above = bone; above != kNone && steps <= bones.size();
         above = parents[above], ++steps)
      if (above == top || (bones[above].parent == bones[top].parent && bones[top].parent != kNone &&
                           bones[above].rest == bones[top].rest))
        is_below[bone] = true;
  }
  return is_below;
}

/// Whether the faces that a bone moves are smaller than the bone is long; a place on it means
/// nothing otherwise.
bool is_longer_than_its_faces(const Character& character, std::uint32_t bone) {
  const ModelPose bind = *bind_pose(character);
  double longest = 0;
  for (std::uint32_t i = 0; i < character.skeleton.bones.size(); ++i)
    if (character.skeleton.bones[i].parent == bone)
      longest = std::max(longest, (bind.model_from_bone[i].translation() -
                                   bind.model_from_bone[bone].translation())
                                      .norm());
  if (longest == 0) return true;  // the end of a chain is as long as what it moves
  double edges = 0, count = 0;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const std::vector<std::uint32_t> movers = movers_of(character, m);
    const auto positions = test::posed_positions(character, m, bind);
    for (const Triangle& triangle : character.meshes[m].triangles)
      for (int k = 0; k < 3; ++k) {
        if (movers[triangle[0]] != bone) continue;
        edges += (positions[triangle[k]] - positions[triangle[(k + 1) % 3]]).norm();
        count += 1;
      }
  }
  return longest * count > edges;
}

/// The bones to aim at: those with most vertices of their own, at least twelve, that are not all of
/// the model's: some vertex is moved mostly by bones that are not below them.
std::vector<std::uint32_t> bones_to_aim_at(const Character& character) {
  const std::vector<std::uint32_t> counts = own_vertices(character);
  std::vector<std::uint32_t> bones;
  for (std::uint32_t bone = 0; bone < counts.size(); ++bone) {
    if (counts[bone] < 12) continue;
    const std::vector<bool> limb = subtree_of(character, bone);
    std::uint32_t others = 0;
    for (std::uint32_t i = 0; i < counts.size(); ++i)
      if (!limb[i]) others += counts[i];
    if (others >= 12 && is_longer_than_its_faces(character, bone)) bones.push_back(bone);
  }
  std::stable_sort(bones.begin(), bones.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
  if (bones.size() > kBonesPerFile) bones.resize(kBonesPerFile);
  return bones;
}

/// Tells from the influences of the source whether an operation was of the limb.
struct Judge {
  const Character& source;
  std::vector<bool> limb;             ///< The bone and all below it.
  std::vector<bool> limb_and_parent;  ///< And the next bone above that moves something.
  std::vector<bool> limb_and_above;   ///< And all above it.

  Judge(const Character& character, std::uint32_t bone)
      : source(character),
        limb(subtree_of(character, bone)),
        limb_and_parent(limb),
        limb_and_above(limb) {
    const std::vector<std::uint32_t> counts = own_vertices(character),
                                     parents = anatomical_parents(character);
    std::uint32_t parent = parents[bone];
    while (parent != kNone && counts[parent] == 0) parent = parents[parent];
    if (parent != kNone) limb_and_parent[parent] = true;
    for (std::uint32_t above = parents[bone]; above != kNone && !limb_and_above[above];
         above = parents[above])
      limb_and_above[above] = true;
  }

  [[nodiscard]] double share(std::uint32_t mesh, std::uint32_t triangle,
                             const std::vector<bool>& bones) const {
    double weight = 0;
    for (const std::uint32_t vertex : source.meshes[mesh].triangles[triangle])
      weight += weight_of(source, mesh, vertex, bones) / 3;
    return weight;
  }

  /// Faces of the source that an operation split: of another limb, of the limb or its parent, all.
  struct Split {
    std::uint32_t of_others = 0, of_limb = 0, all = 0;
    std::set<std::string> movers;  ///< The bones that move most of those not of the limb.
  };
  [[nodiscard]] Split split_by(const TornModel& model) const {
    Split split;
    for (std::uint32_t m = 0; m < source.meshes.size(); ++m) {
      const Mesh &before = source.meshes[m], &after = model.character().meshes[m];
      std::set<std::uint32_t> faces;
      for (std::uint32_t t = before.triangle_count(); t < after.triangle_count(); ++t)
        if (model.source_triangle(m, t) < before.triangle_count())
          faces.insert(model.source_triangle(m, t));
      for (const std::uint32_t face : faces) {
        ++split.all;
        if (share(m, face, limb_and_above) < 0.5) ++split.of_others;
        if (share(m, face, limb_and_parent) >= 0.5)
          ++split.of_limb;
        else
          split.movers.insert(
              source.skeleton.bones[movers_of(source, m)[before.triangles[face][0]]].name);
      }
    }
    return split;
  }
};

/// The share of a piece's vertices of the source that are moved mostly by the limb.
double limb_share(const TornModel& model, const TornPiece& piece, const std::vector<bool>& limb) {
  double inside = 0, all = 0;
  const auto described = model.describe_piece(piece);
  if (!described) return 0.0;
  for (const PieceDescription::Triangles& of_mesh : described->meshes) {
    const Mesh& mesh = model.source().meshes[of_mesh.mesh];
    std::set<std::uint32_t> vertices;
    for (const std::uint32_t t : of_mesh.triangles)
      for (const std::uint32_t vertex : model.character().meshes[of_mesh.mesh].triangles[t])
        if (vertex < mesh.vertex_count()) vertices.insert(vertex);
    for (const std::uint32_t vertex : vertices) {
      all += 1;
      if (weight_of(model.source(), of_mesh.mesh, vertex, limb) > 0.5) inside += 1;
    }
  }
  return all > 0 ? inside / all : 0.0;
}

/// Counts over all files.
struct Tally {
  std::uint32_t files = 0, aimed = 0, hit = 0, refused = 0;
};

class AimedAt {
 public:
  AimedAt(const Character& source, std::shared_ptr<const Character> character, std::uint32_t bone,
          double share)
      : source_(source),
        character_(std::move(character)),
        bone_(bone),
        share_(share),
        judge_(source, bone),
        is_flat_list_(is_flat_list(source)) {}

  /// @return whether the operation was resolved; then it hit the limb and nothing else.
  bool slash() { return hits(SlashOperation{{}, place()}); }
  bool puncture(ViewSide from) {
    PunctureOperation puncture;
    puncture.place = place();
    puncture.from = from;
    return hits(puncture);
  }
  bool sever() {
    SeverOperation sever;
    sever.place = place();
    return hits(sever);
  }

 private:
  [[nodiscard]] LimbPlace place() const { return {source_.skeleton.bones[bone_].name, share_}; }

  /// If a refusal proposes a share, the limb has a section there.
  void expect_proposal_is_true(const TornModel& model, const AimedOperation& aimed,
                               const std::string& refusal) const {
    const std::string before = "; at ";
    const std::size_t at = refusal.find(before);
    if (!std::holds_alternative<SeverOperation>(aimed) || at == std::string::npos) return;
    SeverOperation proposed = std::get<SeverOperation>(aimed);
    proposed.place.at = std::stod(refusal.substr(at + before.size()));
    const auto plain = resolve(model, proposed);
    EXPECT_TRUE(plain) << refusal << "; then: " << plain.error().text();
  }

  bool hits(const AimedOperation& aimed) {
    auto model = TornModel::create(character_);
    EXPECT_TRUE(model);
    const std::uint64_t digest = model->digest();
    const auto plain = resolve(*model, aimed);
    EXPECT_EQ(model->digest(), digest);
    if (!plain) {
      if (std::getenv("SUNDER_AIM_VERBOSE") != nullptr)
        std::printf("    refused: %s\n", std::string(plain.error().text()).c_str());
      EXPECT_FALSE(plain.error().text().empty());
      EXPECT_TRUE(plain.error().code() == StatusCode::not_found ||
                  plain.error().code() == StatusCode::invalid_argument)
          << plain.error().text();
      expect_proposal_is_true(*model, aimed, std::string(plain.error().text()));
      return false;
    }
    const auto report = apply_operation(*model, *plain);
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return true;
    EXPECT_GT(report->runs, 0u);
    EXPECT_THAT(test::broken_laws(*model), IsEmpty());
    if (std::holds_alternative<SeverOperation>(aimed)) expect_closed(*model, *report);
    if (is_flat_list_) return true;
    SCOPED_TRACE(testing::Message() << "operation " << aimed.index());
    const Judge::Split split = judge_.split_by(*model);
    SCOPED_TRACE(testing::PrintToString(split.movers));
    EXPECT_LE(10 * split.of_others, split.all) << split.of_others << " of " << split.all;
    EXPECT_GE(2 * split.of_limb, split.all) << split.of_limb << " of " << split.all << " faces";
    if (std::holds_alternative<SeverOperation>(aimed)) expect_severed(*model, *report);
    return true;
  }

  /// A piece of the limb alone comes off.
  void expect_severed(const TornModel& model, const TearReport& report) {
    double best = 0;
    for (const TornPiece& piece : report.pieces)
      best = std::max(best, limb_share(model, piece, judge_.limb));
    EXPECT_GE(best, 0.8) << report.pieces.size() << " pieces";
  }

  /// The sections of a closed model are closed.
  void expect_closed(const TornModel& model, const TearReport& report) {
    if (count_topology(source_)->boundary_edges != 0) return;
    EXPECT_EQ(report.open_sections, 0u);
    EXPECT_EQ(count_topology(model.character())->boundary_edges, 0u);
  }

  const Character& source_;
  std::shared_ptr<const Character> character_;
  std::uint32_t bone_;
  double share_;
  Judge judge_;
  bool is_flat_list_;
};

void aim_at_all(const Character& source, const std::shared_ptr<const Character>& character,
                Tally& tally) {
  for (const std::uint32_t bone : bones_to_aim_at(source))
    for (const double share : kShares) {
      SCOPED_TRACE(source.skeleton.bones[bone].name + " at " + std::to_string(share));
      AimedAt aimed(source, character, bone, share);
      const auto count = [&](bool is_resolved) {
        ++tally.aimed;
        ++(is_resolved ? tally.hit : tally.refused);
      };
      count(aimed.sever());
      count(aimed.slash());
      // Of two sides at a right angle, a bone points along one at most.
      count(aimed.puncture(ViewSide::back) || aimed.puncture(ViewSide::left));
    }
}

TEST(AimedFiles, each_operation_hits_its_limb_and_nothing_else) {
  Tally tally;
  for (const auto& file : test::rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})) {
    SCOPED_TRACE(file.filename().string());
    const auto loaded = load_character(file);
    if (!loaded) continue;
    const Tally before = tally;
    aim_at_all(*loaded->character, loaded->character, tally);
    if (tally.aimed > before.aimed) ++tally.files;
    std::printf("%-32s %3u aimed, %3u refused\n", file.filename().string().c_str(),
                tally.aimed - before.aimed, tally.refused - before.refused);
  }
  std::printf("%u files, %u operations, %u refused\n", tally.files, tally.aimed, tally.refused);
  if (!test::shared_models().empty()) {
    EXPECT_GE(tally.files, 12u);
  }
  EXPECT_GT(tally.hit, 0u);
  EXPECT_LE(tally.refused, tally.aimed / 5);
}

/// Sum of the bones' weights over the vertices of the source that triangles still use.
double weight_left(const Character& source, const Character& torn, const std::vector<bool>& bones) {
  double sum = 0;
  for (std::uint32_t m = 0; m < source.meshes.size(); ++m) {
    std::set<std::uint32_t> used;
    for (const Triangle& triangle : torn.meshes[m].triangles)
      if (!is_retired(triangle)) used.insert(triangle.begin(), triangle.end());
    for (const std::uint32_t vertex : used)
      if (vertex < source.meshes[m].vertex_count()) sum += weight_of(source, m, vertex, bones);
  }
  return sum;
}

/// Severs a limb where it can be, and takes off all that comes free.
/// @return the share of the limb's weight that is left on the model; empty if it was refused.
std::optional<double> left_after_sever(const std::shared_ptr<const Character>& character,
                                       std::uint32_t bone) {
  auto model = TornModel::create(character);
  SeverOperation sever;
  sever.place = {character->skeleton.bones[bone].name, 0.0};
  const auto placed = at_nearest_share(*model, sever);
  if (!placed) return {};
  sever = std::get<SeverOperation>(*placed);
  const auto pieces = severed_pieces(*model, sever);
  const auto plain = resolve(*model, sever);
  EXPECT_TRUE(pieces && plain);
  if (!pieces || !plain) return {};
  EXPECT_TRUE(apply_operation(*model, *plain));
  for (const auto* const places : {&pieces->severed, &pieces->props})
    for (const PiecePlace& place : *places) {
      const auto report = apply_operation(*model, DetachOperation{sever.pose, place});
      EXPECT_TRUE(report) << report.error().text();
    }
  EXPECT_THAT(test::broken_laws(*model), IsEmpty());
  const Judge judge(*character, bone);
  return weight_left(*character, model->character(), judge.limb) /
         weight_left(*character, *character, judge.limb);
}

TEST(AimedFiles, a_sever_without_a_share_takes_off_most_of_the_limb) {
  std::uint32_t severed = 0, refused = 0;
  for (const auto& file : test::rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})) {
    SCOPED_TRACE(file.filename().string());
    const auto loaded = load_character(file);
    if (!loaded || is_flat_list(*loaded->character)) continue;
    for (const std::uint32_t bone : bones_to_aim_at(*loaded->character)) {
      SCOPED_TRACE(loaded->character->skeleton.bones[bone].name);
      const std::optional<double> left = left_after_sever(loaded->character, bone);
      ++(left ? severed : refused);
      if (left) {
        EXPECT_LE(*left, 0.6);  // by vertices, where the library counts faces and areas
      }
    }
  }
  std::printf("%u severed, %u refused\n", severed, refused);
  EXPECT_GT(severed, 3 * refused);
}

/// The mouth of this figure is a part of its own, inside a neck that the bone hardly moves.
TEST(AimedFiles, a_sever_that_would_miss_the_limb_is_refused_with_the_reason) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto loaded = load_character(test::shared_models() / "rigged/wuson.x");
  ASSERT_TRUE(loaded);
  const auto model = TornModel::create(loaded->character);
  SeverOperation sever;
  sever.place = {"Mouth", 0.25};
  const auto plain = resolve(*model, sever);
  ASSERT_FALSE(plain);
  EXPECT_EQ(plain.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(plain.error().text()), testing::HasSubstr("of what"));
}

/// Names are an oracle for the places of bones and for feet: without them a file is uncertain, or
/// faces the same way.
TEST(AimedFiles, face_the_same_way_without_the_names_of_their_bones) {
  std::size_t certain = 0;
  for (const std::filesystem::path& file :
       test::rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})) {
    const auto loaded = load_character(file);
    ASSERT_TRUE(loaded) << file;
    Character character = *loaded->character;
    const auto named = find_facing(character);
    for (Index bone = 0; bone < character.skeleton.bones.size(); ++bone)
      character.skeleton.bones[bone].name = "bone" + std::to_string(bone);
    const auto nameless = find_facing(character);
    ASSERT_TRUE(named && nameless) << file;
    if (!named->is_certain || !nameless->is_certain) continue;
    ++certain;
    EXPECT_EQ(named->direction, nameless->direction) << file;
  }
  if (certain == 0) GTEST_SKIP() << "no shared models";
  EXPECT_GE(certain, 5u);
}

}  // namespace
}  // namespace sunder
