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

#include "support/rigs.h"
#include "support/shared_models.h"
#include "support/torn_invariants.h"

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

/// A bone and all below it.
std::vector<bool> subtree_of(const Skeleton& skeleton, std::uint32_t bone) {
  std::vector<bool> is_below(skeleton.bones.size(), false);
  is_below[bone] = true;
  for (std::uint32_t i = bone + 1; i < skeleton.bones.size(); ++i)
    if (skeleton.bones[i].parent != kNone && is_below[skeleton.bones[i].parent]) is_below[i] = true;
  return is_below;
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

/// The bones to aim at: those with most vertices of their own, at least twelve, that are not all of
/// the model's: some vertex is moved mostly by bones that are not below them.
std::vector<std::uint32_t> bones_to_aim_at(const Character& character) {
  const std::vector<std::uint32_t> counts = own_vertices(character);
  std::vector<std::uint32_t> bones;
  for (std::uint32_t bone = 0; bone < counts.size(); ++bone) {
    if (counts[bone] < 12) continue;
    const std::vector<bool> limb = subtree_of(character.skeleton, bone);
    std::uint32_t others = 0;
    for (std::uint32_t i = 0; i < counts.size(); ++i)
      if (!limb[i]) others += counts[i];
    if (others >= 12) bones.push_back(bone);
  }
  std::stable_sort(bones.begin(), bones.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return counts[a] > counts[b]; });
  if (bones.size() > kBonesPerFile) bones.resize(kBonesPerFile);
  return bones;
}

/// A limb, and its parent where it is near.
struct Judge {
  const Character& source;
  std::vector<bool> limb, limb_and_parent;

  Judge(const Character& character, std::uint32_t bone)
      : source(character), limb(subtree_of(character.skeleton, bone)), limb_and_parent(limb) {
    const std::vector<std::uint32_t> counts = own_vertices(character);
    std::uint32_t parent = character.skeleton.bones[bone].parent;
    while (parent != kNone && counts[parent] == 0) parent = character.skeleton.bones[parent].parent;
    if (parent != kNone) limb_and_parent[parent] = true;
  }

  /// One line per face of the source that an operation split and that is not of the limb.
  [[nodiscard]] std::vector<std::string> foreign_faces(const TornModel& model) const {
    std::vector<std::string> foreign;
    for (std::uint32_t m = 0; m < source.meshes.size(); ++m) {
      std::set<std::uint32_t> split;
      const Mesh& mesh = source.meshes[m];
      for (std::uint32_t t = mesh.triangle_count();
           t < model.character().meshes[m].triangle_count(); ++t)
        if (model.source_triangle(m, t) < mesh.triangle_count())
          split.insert(model.source_triangle(m, t));
      for (const std::uint32_t t : split) {
        double weight = 0;
        for (const std::uint32_t vertex : mesh.triangles[t])
          weight += weight_of(source, m, vertex, limb_and_parent) / 3;
        if (weight < 0.5)
          foreign.push_back(mesh.name + ": triangle " + std::to_string(t) + ": " +
                            std::to_string(weight));
      }
    }
    return foreign;
  }
};

/// The share of a piece's vertices of the source that are moved mostly by the limb.
double limb_share(const TornModel& model, const TornPiece& piece, const std::vector<bool>& limb) {
  double inside = 0, all = 0;
  for (const TornPiece::Triangles& of_mesh : piece.meshes) {
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
        judge_(source, bone) {}

  /// @return whether the operation was resolved; then it hit the limb and nothing else.
  bool slash(ViewSide from) { return hits(SlashOperation{{}, place(), from}); }
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
      return false;
    }
    const auto report = apply_operation(*model, *plain);
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return true;
    EXPECT_GT(report->runs, 0u);
    EXPECT_THAT(judge_.foreign_faces(*model), IsEmpty());
    EXPECT_THAT(test::broken_laws(*model), IsEmpty());
    if (std::holds_alternative<SeverOperation>(aimed)) expect_severed(*model, *report);
    return true;
  }

  /// A piece of the limb comes off, of the limb alone, and it is closed if the model was.
  void expect_severed(const TornModel& model, const TearReport& report) {
    double best = 0;
    for (const TornPiece& piece : report.pieces)
      best = std::max(best, limb_share(model, piece, judge_.limb));
    EXPECT_GE(best, 0.9) << report.pieces.size() << " pieces";
    if (count_topology(source_)->boundary_edges == 0) {
      EXPECT_EQ(report.open_sections, 0u);
      EXPECT_EQ(count_topology(model.character())->boundary_edges, 0u);
    }
  }

  const Character& source_;
  std::shared_ptr<const Character> character_;
  std::uint32_t bone_;
  double share_;
  Judge judge_;
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
      // Of two sides at a right angle, a bone points along one at most.
      count(aimed.slash(ViewSide::front) || aimed.slash(ViewSide::left));
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

}  // namespace
}  // namespace sunder
