// Compares imported models, loaded and posed by our code, with assimp's own scene evaluated by the
// definition: the whole chain of units, axes, binds, weights, keys and welding. FBX:
// fbx_clips_test.cpp.

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include "io/assimp_text_models.h"
#include "skinning/internal/reference.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;
using Corners = std::vector<Vec3d>;  ///< Three per triangle, model space.

constexpr double kRest = -1.0;

// ---- assimp's scene, evaluated by its own definition

template <class Key>
std::pair<unsigned, double> locate(const Key* keys, unsigned count, double ticks) {
  unsigned next = 0;
  while (next < count && keys[next].mTime <= ticks) ++next;
  if (next == 0) return {0, 0.0};
  if (next == count) return {count - 1, 0.0};
  return {next - 1, (ticks - keys[next - 1].mTime) / (keys[next].mTime - keys[next - 1].mTime)};
}

aiVector3D sample(const aiVectorKey* keys, unsigned count, double ticks) {
  const auto [at, factor] = locate(keys, count, ticks);
  if (factor == 0.0) return keys[at].mValue;
  return keys[at].mValue + (keys[at + 1].mValue - keys[at].mValue) * static_cast<float>(factor);
}

aiQuaternion sample(const aiQuatKey* keys, unsigned count, double ticks) {
  const auto [at, factor] = locate(keys, count, ticks);
  aiQuaternion result = keys[at].mValue;
  if (factor != 0.0)
    aiQuaternion::Interpolate(result, keys[at].mValue, keys[at + 1].mValue,
                              static_cast<float>(factor));
  return result.Normalize();
}

Corners assimp_corners(const aiScene& scene, unsigned clip, double seconds) {
  std::map<std::string, const aiNodeAnim*> channel_of;
  double ticks = 0.0;
  if (seconds != kRest) {
    const aiAnimation& animation = *scene.mAnimations[clip];
    ticks = seconds * (animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0);
    for (unsigned i = 0; i < animation.mNumChannels; ++i)
      channel_of.emplace(animation.mChannels[i]->mNodeName.C_Str(), animation.mChannels[i]);
  }
  std::map<std::string, aiMatrix4x4> model_from_node;
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> order;
  const std::function<void(const aiNode*, const aiMatrix4x4&)> visit =
      [&](const aiNode* node, const aiMatrix4x4& model_from_parent) {
        aiMatrix4x4 local = node->mTransformation;
        if (const auto found = channel_of.find(node->mName.C_Str()); found != channel_of.end()) {
          const aiNodeAnim& channel = *found->second;
          local = aiMatrix4x4(sample(channel.mScalingKeys, channel.mNumScalingKeys, ticks),
                              sample(channel.mRotationKeys, channel.mNumRotationKeys, ticks),
                              sample(channel.mPositionKeys, channel.mNumPositionKeys, ticks));
        }
        const aiMatrix4x4 model_from_this = model_from_parent * local;
        model_from_node.emplace(node->mName.C_Str(), model_from_this);
        order.emplace_back(node, model_from_this);
        for (unsigned i = 0; i < node->mNumChildren; ++i)
          visit(node->mChildren[i], model_from_this);
      };
  visit(scene.mRootNode, aiMatrix4x4());

  Corners corners;
  for (const auto& [node, model_from_mesh] : order) {
    for (unsigned m = 0; m < node->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene.mMeshes[node->mMeshes[m]];
      std::vector<Vec3d> posed(mesh.mNumVertices, Vec3d::Zero());
      std::vector<double> sums(mesh.mNumVertices, 0.0);
      const auto add = [&](unsigned vertex, const aiMatrix4x4& matrix, double weight) {
        const aiVector3D p = matrix * mesh.mVertices[vertex];
        posed[vertex] += weight * Vec3d(static_cast<double>(p.x), static_cast<double>(p.y),
                                        static_cast<double>(p.z));
        sums[vertex] += weight;
      };
      for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const aiMatrix4x4 matrix = model_from_node[bone.mName.C_Str()] * bone.mOffsetMatrix;
        for (unsigned k = 0; k < bone.mNumWeights; ++k)
          add(bone.mWeights[k].mVertexId, matrix, static_cast<double>(bone.mWeights[k].mWeight));
      }
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        if (mesh.mNumBones == 0) add(v, model_from_mesh, 1.0);
        posed[v] /= sums[v];
      }
      for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        if (mesh.mFaces[f].mNumIndices == 3)
          for (unsigned k = 0; k < 3; ++k) corners.push_back(posed[mesh.mFaces[f].mIndices[k]]);
    }
  }
  return corners;
}

// ---- our result

Corners our_corners(const Character& character, std::size_t clip, double seconds) {
  Pose pose = *local_rest_pose(character);
  if (seconds != kRest) {
    EXPECT_TRUE(sample_clip(character.clips[clip], seconds, pose));
  }
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  Corners corners;
  for (const Mesh& mesh : character.meshes) {
    std::vector<Affine3d> palette(character.skins[mesh.skin].bones.size());
    EXPECT_TRUE(compute_palette(character.skins[mesh.skin], model_pose, palette));
    std::vector<Vec3d> posed(mesh.vertex_count());
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      posed[v] = deform_position_reference(mesh, v, palette, pose.morph_weights);
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) corners.push_back(posed[vertex]);
  }
  return corners;
}

/// Largest distance between corners of the two, relative to assimp's size. `model_from_scene` is
/// the part that assimp does not apply.
void expect_same(const Corners& ours, const Corners& theirs, const Affine3d& model_from_scene,
                 double tolerance, const std::string& what) {
  ASSERT_EQ(ours.size(), theirs.size()) << what;
  Eigen::AlignedBox3d box;
  double largest = 0.0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Vec3d expected = model_from_scene * theirs[i];
    box.extend(Eigen::Vector3d(expected));
    largest = std::max(largest, (ours[i] - expected).norm());
  }
  EXPECT_LE(largest, tolerance * box.diagonal().norm())
      << what << ": size " << box.diagonal().transpose();
}

void compare(const fs::path& file, const Affine3d& model_from_scene, double tolerance) {
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << file << loaded.error().text();
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  ASSERT_NE(scene, nullptr);
  const Character& character = *loaded->character;
  expect_same(our_corners(character, 0, kRest), assimp_corners(*scene, 0, kRest), model_from_scene,
              tolerance, file.filename().string() + " at rest");
  ASSERT_EQ(character.clips.size(), scene->mNumAnimations) << file;
  for (unsigned clip = 0; clip < scene->mNumAnimations; ++clip) {
    const double duration = static_cast<double>(character.clips[clip].duration);
    for (const double part : {0.0, 0.21, 0.5, 0.83, 1.0}) {
      const std::string what = file.filename().string() + ", clip " + character.clips[clip].name +
                               " at " + std::to_string(part * duration);
      expect_same(our_corners(character, clip, part * duration),
                  assimp_corners(*scene, clip, part * duration), model_from_scene, tolerance, what);
    }
  }
}

TEST(AssimpPoses, ColladaArrivesInMetresWithYUp) {
  const test::TemporaryFolder folder;
  const auto loaded =
      load_character(folder.write("sail.dae", std::string_view(test::kSixBoneCollada)));
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Corners corners = our_corners(*loaded->character, 0, kRest);
  ASSERT_EQ(corners.size(), 3u);
  EXPECT_LT((corners[0] - Vec3d(0, 0, 0)).norm(), 1e-6);
  EXPECT_LT((corners[1] - Vec3d(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((corners[2] - Vec3d(0, 1, 0)).norm(), 1e-6);  // The file's z, 100 centimetres.
}

/// One triangle, its corners on the joints "low", "middle" and "high", shown by nodes with
/// skeletons of their own. A skeleton is three joints with the same sids, moved by (x, 0, 0).
std::string skin_on_skeletons(const std::vector<int>& places, bool has_ids, bool has_skeletons) {
  const auto matrix = [](double x, double y) {
    return "<matrix>1 0 0 " + std::to_string(x) + " 0 1 0 " + std::to_string(y) +
           " 0 0 1 0 0 0 0 1</matrix>";
  };
  const std::string sids[] = {"low", "middle", "high"};
  std::string nodes, binds;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto joint = [&](std::size_t k, double x, double y) {
      const std::string id = "s" + std::to_string(i) + "_" + sids[k];
      return "<node id='" + id + "' sid='" + sids[k] + "' name='" + sids[k] + "' type='JOINT'>" +
             matrix(x, y);
    };
    nodes += joint(0, places[i], 0) + joint(1, 0, 1) + joint(2, 0, 1) + "</node></node></node>";
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string skeleton =
        has_skeletons ? "<skeleton>#s" + std::to_string(i) + "_low</skeleton>" : "";
    nodes += "<node id='shown" + std::to_string(i) + "'><instance_controller url='#ctl'>" +
             skeleton + "</instance_controller></node>";
  }
  for (int k = 0; k < 3; ++k) binds += "1 0 0 0 0 1 0 " + std::to_string(-k) + " 0 0 1 0 0 0 0 1 ";
  const std::string joints = has_ids ? "<IDREF_array id='jn-a' count='3'>s1_low s1_middle "
                                       "s1_high</IDREF_array>"
                                     : "<Name_array id='jn-a' count='3'>low middle "
                                       "high</Name_array>";
  return R"(<?xml version='1.0'?>
<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id='geo'><mesh>
<source id='pos'><float_array id='pos-a' count='9'>0 0 0 1 1 0 0 2 0</float_array><technique_common><accessor source='#pos-a' count='3' stride='3'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common></source>
<vertices id='vert'><input semantic='POSITION' source='#pos'/></vertices>
<triangles count='1'><input semantic='VERTEX' source='#vert' offset='0'/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_controllers><controller id='ctl'><skin source='#geo'><bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>
<source id='jn'>)" +
         joints +
         R"(<technique_common><accessor source='#jn-a' count='3' stride='1'><param name='JOINT' type='name'/></accessor></technique_common></source>
<source id='ib'><float_array id='ib-a' count='48'>)" +
         binds +
         R"(</float_array><technique_common><accessor source='#ib-a' count='3' stride='16'><param name='TRANSFORM' type='float4x4'/></accessor></technique_common></source>
<source id='w'><float_array id='w-a' count='1'>1</float_array><technique_common><accessor source='#w-a' count='1' stride='1'><param name='WEIGHT' type='float'/></accessor></technique_common></source>
<joints><input semantic='JOINT' source='#jn'/><input semantic='INV_BIND_MATRIX' source='#ib'/></joints>
<vertex_weights count='3'><input semantic='JOINT' source='#jn' offset='0'/><input semantic='WEIGHT' source='#w' offset='1'/><vcount>1 1 1</vcount><v>0 0 1 0 2 0</v></vertex_weights>
</skin></controller></library_controllers>
<library_visual_scenes><visual_scene id='scene'>)" +
         nodes +
         R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url='#scene'/></scene>
</COLLADA>
)";
}

TEST(AssimpPoses, a_skin_of_a_collada_file_is_on_the_skeleton_that_its_instance_names) {
  const test::TemporaryFolder folder;
  const auto corners_of = [&](const std::string& text) {
    const auto loaded = load_character(folder.write("skins.dae", std::string_view(text)));
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded ? our_corners(*loaded->character, 0, kRest) : Corners();
  };
  const Corners shown = corners_of(skin_on_skeletons({0, 10, -4}, false, true));
  ASSERT_EQ(shown.size(), 9u);
  const std::vector<double> places = {0, 10, -4};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((shown[3 * i + k] - Vec3d(places[i] + (k == 1 ? 1 : 0), double(k), 0)).norm(), 1e-6)
          << "instance " << i << ", corner " << k;
  // Ids are those of one skeleton, wherever the skeletons are said to be.
  const Corners by_id = corners_of(skin_on_skeletons({0, 10}, true, true));
  ASSERT_GE(by_id.size(), 3u);
  for (const Vec3d& corner : by_id) EXPECT_GE(corner.x(), 10 - 1e-6);
  // Without skeletons, the first sids of the scene.
  const Corners anywhere = corners_of(skin_on_skeletons({-4, 10}, false, false));
  ASSERT_GE(anywhere.size(), 3u);
  for (const Vec3d& corner : anywhere) EXPECT_LE(corner.x(), -3 + 1e-6);
}

/// The conformance test of the sids: its first chain of joints has the right ids and no sids.
TEST(AssimpPoses, joints_of_a_collada_file_are_found_by_sids_before_ids) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const fs::path file = test::shared_models().parent_path() / "strangers/cts_search_sid_first.dae";
  if (!fs::exists(file)) GTEST_SKIP() << "needs the folder strangers next to the shared models";
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& character = *loaded->character;
  ASSERT_EQ(character.meshes.size(), 1u);
  const Skin& skin = character.skins[character.meshes[0].skin];
  // The chain with sids begins at the second node of that name.
  for (const std::uint32_t bone : skin.bones) {
    std::uint32_t root = bone;
    while (character.skeleton.bones[root].parent != kNone &&
           character.skeleton.bones[root].name != "joint1_2")
      root = character.skeleton.bones[root].parent;
    EXPECT_EQ(character.skeleton.bones[root].name, "joint1_2")
        << character.skeleton.bones[bone].name;
  }
}

/// Our own models and, if they are there, the shared ones.
TEST(AssimpPoses, RiggedModels) {
  const fs::path own = test::own_data() / "rigged";
  compare(own / "strip.x", Affine3d::Identity(), 1e-6);
  compare(own / "sail.dae", Affine3d::Identity(), 1e-6);
  if (test::shared_models().empty()) return;
  const fs::path rigged = test::shared_models() / "rigged";
  compare(rigged / "cesium_man.dae", Affine3d::Identity(), 2e-6);
  compare(rigged / "wuson.x", Affine3d::Identity(), 2e-6);
  compare(rigged / "minetest_character.b3d", Affine3d::Identity(), 2e-6);
}

TEST(AssimpPoses, AssimpsOwnModels) {
  const fs::path models = test::assimp_models();
  if (models.empty()) GTEST_SKIP() << "needs Debian's assimp-testmodels";
  for (const char* name :
       {"Collada/duck.dae", "Collada/box_nested_animation.dae",
        "Collada/anims_with_full_rotations_between_keys.DAE", "X/BCN_Epileptic.X", "X/test.x",
        "B3D/WusonBlitz.b3d", "MD5/SimpleCube.md5mesh", "3DS/RotatingCube.3DS", "OBJ/spider.obj",
        "PLY/Wuson.ply", "STL/Spider_ascii.stl"})
    compare(models / name, Affine3d::Identity(), 5e-6);
}

}  // namespace
}  // namespace sunder
