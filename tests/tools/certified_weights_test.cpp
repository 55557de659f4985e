// --max-error: what is written is certified against the unpruned file, by files and by hand.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <tuple>

#include "skinning/internal/reference.h"
#include "support/machine/gltf_validator.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

/// The rounding of skinning and weights in float32, and the order of sums; share of the diagonal.
constexpr double kCertifiedRounding = 1e-6;

class CertifiedWeightsCommand : public CactusSuite {
 protected:
  /// A cut across the middle of a model, which rewrites what it meets.
  static std::string cut_in_the_middle(const Character& character) {
    const auto rest = rest_pose(character);
    EXPECT_TRUE(rest);
    Vec3d least = Vec3d::Constant(1e30), most = -least;
    for (Index m = 0; m < character.meshes.size(); ++m)
      for (const Vec3d& at : test::posed_positions(character, m, *rest)) {
        least = least.cwiseMin(at);
        most = most.cwiseMax(at);
      }
    const Vec3d middle = 0.5 * (least + most);
    const json cut = {
        {"op", "cut"},
        {"plane", {{"point", {middle.x(), middle.y(), middle.z()}}, {"normal", {0.3, 1, 0.1}}}}};
    return write("cut.json",
                 json({{"sunder_operations", 1}, {"operations", json::array({cut})}}).dump());
  }
};

struct FilePair {
  std::shared_ptr<const Character> plain, pruned;
  json certificate;
};

double diagonal_of(const Character& character) {
  const auto rest = rest_pose(character);
  return rest ? test::posed_diagonal(character, *rest) : 0.0;
}

/// The certificate of the vertices of two files with the same vertices, one by one.
double certified_between(const Character& plain, const Character& pruned, LimitsFrom from) {
  const auto bind = bind_pose(plain);
  const auto limits = from == LimitsFrom::clips
                          ? joint_limits_of_clips(plain, *bind, ValidationOptions{}.clip_margin)
                          : free_joint_limits(plain, *bind);
  const auto tree = JointTree::create(plain.skeleton, *bind, *limits);
  double largest = 0;
  for (Index m = 0; m < plain.meshes.size(); ++m) {
    Character both = plain;
    Mesh& mesh = both.meshes[m];
    const Index count = mesh.vertex_count();
    EXPECT_EQ(mesh.positions, pruned.meshes[m].positions);
    mesh.positions.insert(mesh.positions.end(), plain.meshes[m].positions.begin(),
                          plain.meshes[m].positions.end());
    for (Index v = 0; v < count; ++v) mesh.weights.append(pruned.meshes[m].weights.of(v));
    SkinDifferences rows;
    for (Index v = 0; v < count; ++v) {
      const VertexShare shares[] = {{count + v, 1.0}, {v, -1.0}};
      EXPECT_TRUE(append_difference(both, *bind, m, shares, rows));
    }
    const auto certificate = certify_deviation(*tree, rows);
    EXPECT_TRUE(certificate);
    EXPECT_TRUE(certificate->gaps.empty()) << plain.name << " mesh " << m;
    largest = std::max(largest, certificate->maximum);
  }
  return largest;
}

/// Vertices that move alike in one file do so in another one too, across all meshes.
void expect_coincident_weights_stay_equal(const Character& plain, const Character& pruned) {
  using Row = std::vector<std::pair<Index, float>>;
  const auto row_of = [](const Character& character, Index m, Index v) {
    Row row;
    const Mesh& mesh = character.meshes[m];
    for (const Influence& influence : mesh.weights.of(v))
      row.emplace_back(character.skins[mesh.skin].bones[influence.slot], influence.weight);
    std::ranges::sort(row);
    return row;
  };
  std::map<std::tuple<float, float, float, Index, Row>, Row> rows;
  std::size_t shared = 0, different = 0;
  for (Index m = 0; m < plain.meshes.size(); ++m)
    for (Index v = 0; v < plain.meshes[m].vertex_count(); ++v) {
      const Vec3f& at = plain.meshes[m].positions[v];
      const Row after = row_of(pruned, m, v);
      const auto [found, is_new] = rows.try_emplace(
          {at.x(), at.y(), at.z(), plain.meshes[m].skin, row_of(plain, m, v)}, after);
      shared += !is_new;
      different += found->second != after;
    }
  EXPECT_GT(shared, 0u) << "lips of the cut at least";
  EXPECT_EQ(different, 0u);
}

/// The largest distance between vertices of two files in poses of the first clip.
double farthest_in_clip(const Character& a, const Character& b) {
  double farthest = 0;
  for (int i = 0; i < 6 && !a.clips.empty(); ++i) {
    const double time = static_cast<double>(a.clips[0].duration) * i / 5;
    const auto pose = make_pose(a, ClipPose{std::uint32_t{0}, time});
    EXPECT_TRUE(pose);
    for (Index m = 0; m < a.meshes.size(); ++m) {
      std::vector<Affine3d> palette(a.skins[a.meshes[m].skin].bones.size());
      EXPECT_TRUE(compute_palette(a.skins[a.meshes[m].skin], *pose, palette));
      const std::vector<float> rest = a.rest_morph_weights;
      for (Index v = 0; v < a.meshes[m].vertex_count(); ++v)
        farthest = std::max(farthest, (deform_position_reference(a.meshes[m], v, palette, rest) -
                                       deform_position_reference(b.meshes[m], v, palette, rest))
                                          .norm());
    }
  }
  return farthest;
}

std::uint64_t sum_of(const json& histogram) {
  std::uint64_t sum = 0;
  for (const json& count : histogram) sum += count.get<std::uint64_t>();
  return sum;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

class CertifiedFiles : public CertifiedWeightsCommand,
                       public testing::WithParamInterface<const char*> {
 protected:
  static FilePair tear_twice(const std::string& file, double error, const std::string& limits) {
    FilePair pair;
    const auto source = load_character(file);
    if (!source) return pair;
    const std::string cut = cut_in_the_middle(*source->character);
    const CommandResult plain =
        run_sunder({"tear", file, "--ops", cut, "-o", path("plain.glb"), "--influences", "all"});
    EXPECT_LE(plain.exit_code, 1) << plain.err;
    const CommandResult pruned =
        run_sunder({"tear", file, "--ops", cut, "-o", path("pruned.glb"), "--max-error",
                    number(error) + "m", "--limits", limits, "--report", "-"});
    EXPECT_LE(pruned.exit_code, 1) << pruned.err;
    EXPECT_THAT(pruned.err, HasSubstr("no pose moves a vertex by more than"));
    const auto a = load_character(path("plain.glb")), b = load_character(path("pruned.glb"));
    EXPECT_TRUE(a && b);
    if (!a || !b) return pair;
    pair = {a->character, b->character,
            json::parse(pruned.out)["influences_written"]["certificate"]};
    return pair;
  }

  static void expect_certified(const FilePair& pair, double error, LimitsFrom limits) {
    const double tolerance = kCertifiedRounding * diagonal_of(*pair.plain);
    const double reported = pair.certificate["certified_maximum"].get<double>();
    EXPECT_LE(reported, error);
    EXPECT_NEAR(certified_between(*pair.plain, *pair.pruned, limits), reported, tolerance);
    EXPECT_LE(farthest_in_clip(*pair.plain, *pair.pruned), reported + tolerance);
    ValidationOptions options;
    options.limits_from = limits;
    const auto report = validate_skin(pair.plain, pair.pruned, options);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_TRUE(report->bracket.is_tested);
    EXPECT_LE(report->bracket.certified, error + tolerance);
    EXPECT_EQ(sum_of(pair.certificate["influences"]), pair.certificate["vertices"]);
    EXPECT_EQ(sum_of(pair.certificate["influences_before"]), pair.certificate["vertices"]);
    EXPECT_EQ(pair.certificate["vertices_uncertified"], 0);
  }
};

TEST_P(CertifiedFiles, are_within_the_maximum_error_in_every_pose) {
  std::string file = GetParam() == std::string("cactus")
                         ? model()
                         : (test::own_data() / "rigged" / GetParam()).string();
  if (std::string(GetParam()).starts_with("shared/")) {
    SUNDER_SKIP_WITHOUT_SHARED_MODELS();
    file = (test::shared_models() / "rigged" / (GetParam() + 7)).string();
  }
  const auto source = load_character(file);
  ASSERT_TRUE(source) << source.error().text();
  const double diagonal = diagonal_of(*source->character);
  const bool has_clips = !source->character->clips.empty();
  for (const double share : {1e-4, 1e-2})
    for (const bool of_clips : {false, true}) {
      if (of_clips && !has_clips) continue;
      SCOPED_TRACE(testing::Message() << share << (of_clips ? " clips" : " none"));
      const FilePair pair = tear_twice(file, share * diagonal, of_clips ? "clips" : "none");
      ASSERT_TRUE(pair.plain && pair.pruned);
      expect_certified(pair, share * diagonal, of_clips ? LimitsFrom::clips : LimitsFrom::none);
      expect_coincident_weights_stay_equal(*pair.plain, *pair.pruned);
      if (share == 1e-2) {
        EXPECT_GT(pair.certificate["vertices_changed"], 0);
      }
    }
}
INSTANTIATE_TEST_SUITE_P(Models, CertifiedFiles,
                         testing::Values("cactus", "many_bones.glb", "six_influences.glb",
                                         "two_clips.glb", "two_skins.glb", "shared/fox.glb",
                                         "shared/mannequiny.glb", "shared/cactoro.glb"),
                         [](const auto& of) {
                           std::string name = of.param;
                           for (char& c : name) c = std::isalnum(c) ? c : '_';
                           return name;
                         });

TEST_F(CertifiedWeightsCommand, a_larger_error_takes_fewer_influences_and_bytes) {
  const std::string operations = write("a.json", kOneTear);
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", operations, "-o", path("all.glb")}).exit_code, 0);
  const auto size = [](const std::string& name) {
    return static_cast<double>(std::filesystem::file_size(path(name)));
  };
  std::uint64_t before = UINT64_MAX, influences_before = UINT64_MAX, vertex_count = 0;
  for (const char* const error : {"0.00001mm", "0.1mm", "1mm", "5cm"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("less.glb"), "--max-error",
                    error, "--report", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json certificate = json::parse(result.out)["influences_written"]["certificate"];
    const auto bytes = certificate["bytes_written"].get<std::uint64_t>();
    std::uint64_t influences = 0;
    vertex_count = 0;
    for (const auto& [count, vertices] : certificate["influences"].items()) {
      influences += std::stoull(count) * vertices.get<std::uint64_t>();
      vertex_count += vertices.get<std::uint64_t>();
    }
    EXPECT_LE(bytes, before) << error;
    EXPECT_LT(influences, influences_before) << error;
    EXPECT_NEAR(size("all.glb") - size("less.glb"), certificate["bytes_saved"].get<double>(), 1000)
        << error << ": all but the JSON of the accessors";
    before = bytes;
    influences_before = influences;
    if (!test::has_gltf_validator()) continue;
    const test::ValidatorReport report = test::validate_glb(path("less.glb"));
    EXPECT_EQ(report.errors, 0) << report.output;
  }
  EXPECT_LE(before, 16 * vertex_count) << "bytes, where floats take 40";
}

TEST_F(CertifiedWeightsCommand, lengths_have_units) {
  const std::string operations = write("a.json", kOneTear);
  std::vector<std::byte> first;
  for (const char* const length : {"0.001m", "1mm", "0.1cm", "1000 um", "1e-3m"}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", operations, "-o", path("u.glb"), "--max-error", length});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    if (first.empty()) first = bytes("u.glb");
    EXPECT_EQ(bytes("u.glb"), first) << length;
  }
  for (const char* const bad : {"", "0.5", "mm", "-1mm", "-0", "nan", "inf", "1e999", "0.1km",
                                "1mmm", "0,1mm", "0x1", "1  mm"}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", operations, "-o", path("bad.glb"), "--max-error", bad});
    EXPECT_EQ(result.exit_code, 2) << bad;
    EXPECT_THAT(result.err, HasSubstr("--max-error")) << bad;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("bad.glb"));
  }
}

TEST_F(CertifiedWeightsCommand, excludes_what_it_chooses_itself) {
  const std::string operations = write("a.json", kOneTear);
  const std::vector<std::string> tear = {"tear",     model(), "--ops",
                                         operations, "-o",    path("no.glb")};
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"--max-error", "1mm", "--influences", "4"},
           {"--max-error", "1mm", "--weights-as", "u8"},
           {"--limits", "clips"},
           {"--max-error", "1mm", "--limits", path("no such.json")}}) {
    std::vector<std::string> arguments = tear;
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_NE(run_sunder(arguments).exit_code, 0) << more.front();
    EXPECT_FALSE(exists("no.glb"));
  }
  EXPECT_EQ(run_sunder({"transfer", model(), model(), "--dry-run", "--max-error", "1mm"}).exit_code,
            2);
}

TEST_F(CertifiedWeightsCommand, no_operation_gives_the_source_all_the_same) {
  const std::string none = write("none.json", R"({"sunder_operations": 1, "operations": []})");
  ASSERT_EQ(
      run_sunder({"tear", model(), "--ops", none, "-o", path("same.glb"), "--max-error", "1cm"})
          .exit_code,
      0);
  EXPECT_EQ(bytes("same.glb"), bytes("cactus.glb"));
}

/// Removes the node "Skeleton" above several roots from the scene of a GLB.
void part_roots(const std::filesystem::path& file) {
  const std::vector<std::byte> glb = test::read_bytes(file);
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  json document = json::parse(std::string(reinterpret_cast<const char*>(glb.data()) + 20, length));
  json& roots = document["scenes"][0]["nodes"];
  json parted = json::array();
  for (const json& root : roots) {
    const json& node = document["nodes"][root.get<std::size_t>()];
    if (node["name"] != "Skeleton") parted.push_back(root);
    for (const json& child : node.value("children", json::array()))
      if (node["name"] == "Skeleton") parted.push_back(child);
  }
  ASSERT_GT(parted.size(), roots.size());
  roots = parted;
  for (json& node : document["nodes"])
    if (node["name"] == "Skeleton") node.erase("children");
  std::string text = document.dump();
  ASSERT_LE(text.size(), length);
  text.resize(length, ' ');
  std::ofstream stream(file, std::ios::binary | std::ios::in);
  stream.seekp(20);
  stream << text;
}

/// Both bones are roots, which slide without a range: no change of a blend of them has a bound.
TEST_F(CertifiedWeightsCommand, vertices_without_certificate_keep_all_as_floats) {
  Character tube = test::make_tube(8, 8, 2);
  Bone& upper = tube.skeleton.bones[1];
  upper.rest.translation += tube.skeleton.bones[0].rest.translation;
  upper.parent = kNone;
  tube.clips.clear();
  ASSERT_TRUE(validate_character(tube));
  ASSERT_TRUE(save_glb(path("roots.glb"), tube));
  part_roots(path("roots.glb"));
  const std::string cut = cut_in_the_middle(tube);
  ASSERT_EQ(
      run_sunder({"tear", path("roots.glb"), "--ops", cut, "-o", path("plain.glb")}).exit_code, 0);
  const CommandResult result =
      run_sunder({"tear", path("roots.glb"), "--ops", cut, "-o", path("kept.glb"), "--max-error",
                  "5cm", "--report", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("without certificate"));
  const json certificate = json::parse(result.out)["influences_written"]["certificate"];
  EXPECT_EQ(certificate["meshes"][0]["format"], "float");
  EXPECT_EQ(certificate["certified_maximum"], 0.0);
  const auto plain = load_character(path("plain.glb")), kept = load_character(path("kept.glb"));
  ASSERT_TRUE(plain && kept);
  std::uint64_t blended = 0;
  const SkinWeights& weights = plain->character->meshes[0].weights;
  for (Index v = 0; v < weights.vertex_count(); ++v) blended += weights.of(v).size() > 1;
  // Weights that are whole 255ths need no change to be written as bytes.
  EXPECT_GT(certificate["vertices_uncertified"], 0u);
  EXPECT_LE(certificate["vertices_uncertified"], blended);
  EXPECT_EQ(kept->character->meshes[0].weights, weights);

  const CommandResult no_clips =
      run_sunder({"tear", path("roots.glb"), "--ops", cut, "-o", path("no.glb"), "--max-error",
                  "5cm", "--limits", "clips"});
  EXPECT_EQ(no_clips.exit_code, 2);
  EXPECT_THAT(no_clips.err, HasSubstr("no clips"));
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(CertifiedWeightsCommand, a_transfer_is_pruned_against_its_own_unpruned_result) {
  Character two = tools::make_cactus();
  for (Mesh& mesh : two.meshes) {
    SkinWeights weights;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto first = mesh.weights.of(v).first(1);
      const std::vector<Influence> alone = {{first[0].slot, 1.0f}};
      weights.append(alone);
    }
    mesh.weights = weights;
  }
  ASSERT_TRUE(save_glb(path("two.glb"), two));
  ASSERT_EQ(run_sunder({"transfer", model(), path("two.glb"), "-o", path("plain.glb")}).exit_code,
            0);
  const CommandResult result =
      run_sunder({"transfer", model(), path("two.glb"), "-o", path("pruned.glb"), "--max-error",
                  "2mm", "--limits", "clips", "--report", path("t.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("no pose moves a vertex by more than"));
  const json certificate = read_json("t.json")["certificate"];
  EXPECT_EQ(certificate["limits"], "clips");
  EXPECT_GT(certificate["vertices_changed"], 0);
  const auto plain = load_character(path("plain.glb")), pruned = load_character(path("pruned.glb"));
  ASSERT_TRUE(plain && pruned);
  const double certified =
      certified_between(*plain->character, *pruned->character, LimitsFrom::clips);
  EXPECT_LE(certified, 0.002 * (1 + kCertifiedRounding));
  EXPECT_NEAR(certified, certificate["certified_maximum"].get<double>(), 1e-6);
}

}  // namespace
}  // namespace sunder::command_test
