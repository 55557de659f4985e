#include "io/assimp/fbx_nodes.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/assimp/failure.h"
#include "io/assimp/scene_tree.h"
#include "io/fbx/record.h"
#include "io/fbx/tracks.h"
#include "io/files/read_at.h"

namespace sunder::assimp_import {
namespace {

/// assimp gives each part of a model's transform a node of its own, with this in its name.
constexpr const char* kPartMark = "_$AssimpFbx$_";
constexpr const char* kGeometryName = "_geometry";

/// The nodes that assimp made of one model.
struct ModelNodes {
  aiNode* first = nullptr;  ///< Of the parts, outermost.
  aiNode* own = nullptr;    ///< Has the model's name and its meshes.
  aiNode* last = nullptr;   ///< Its children are the model's children.
  aiMatrix4x4 geometry;     ///< What moves the model's meshes, but not its children.
};

[[noreturn]] void fail_to_match(const std::string& where) {
  throw ImportFailure{Status::failure(
      StatusCode::internal_error, kNone,
      "the importer's nodes are not the models of the file, at '%.100s'", where.c_str())};
}

bool is_part_of(const aiNode& node, const std::string& model) {
  return to_string(node.mName).starts_with(model + kPartMark);
}

bool is_geometric(const aiNode& node) {
  return to_string(node.mName).find(std::string(kPartMark) + "Geometric") != std::string::npos;
}

ModelNodes match(aiNode* first, const std::string& name) {
  ModelNodes nodes{.first = first, .own = first, .last = first, .geometry = {}};
  while (to_string(nodes.own->mName) != name) {
    if (!is_part_of(*nodes.own, name) || nodes.own->mNumChildren != 1) fail_to_match(name);
    if (is_geometric(*nodes.own)) nodes.geometry = nodes.geometry * nodes.own->mTransformation;
    nodes.own = nodes.own->mChildren[0];
  }
  nodes.last = nodes.own;
  // The inverse of the geometry's transform, above the children.
  while (nodes.last->mNumChildren == 1 && is_part_of(*nodes.last->mChildren[0], name) &&
         is_geometric(*nodes.last->mChildren[0]))
    nodes.last = nodes.last->mChildren[0];
  return nodes;
}

/// assimp keeps the order of the file's connections, as `scene` does.
std::vector<ModelNodes> match_all(const aiNode& root, const fbx::Scene& scene) {
  std::vector<ModelNodes> all(scene.models.size());
  const auto match_children = [&](const aiNode& parent, const std::vector<std::uint32_t>& models) {
    if (parent.mNumChildren != models.size()) fail_to_match(to_string(parent.mName));
    for (std::size_t i = 0; i < models.size(); ++i)
      all[models[i]] = match(parent.mChildren[i], scene.models[models[i]].name);
  };
  match_children(root, scene.roots);
  for (std::size_t i = 0; i < all.size(); ++i)
    match_children(*all[i].last, scene.models[i].children);
  return all;
}

void forget_children(aiNode& node) {
  delete[] node.mChildren;
  node.mChildren = nullptr;
  node.mNumChildren = 0;
}

/// Deletes all nodes but the own ones of the models, which then stand alone.
void keep_own_nodes(aiNode& root, const std::vector<ModelNodes>& all) {
  forget_children(root);
  for (const ModelNodes& nodes : all) forget_children(*nodes.last);
  for (const ModelNodes& nodes : all) {
    if (nodes.own != nodes.last) {
      delete nodes.own->mChildren[0];
      forget_children(*nodes.own);
    }
    if (nodes.first != nodes.own) {
      forget_children(*nodes.own->mParent);
      delete nodes.first;
    }
    nodes.own->mParent = nullptr;
  }
}

aiMatrix4x4 matrix_of(const fbx::Place& place) {
  const Quatd& q = place.rotation;
  const auto vector = [](const Vec3d& v) {
    return aiVector3D(static_cast<float>(v.x()), static_cast<float>(v.y()),
                      static_cast<float>(v.z()));
  };
  return {vector(place.scale),
          aiQuaternion(static_cast<float>(q.w()), static_cast<float>(q.x()),
                       static_cast<float>(q.y()), static_cast<float>(q.z())),
          vector(place.translation)};
}

/// Hands the meshes of a node whose geometry has a transform of its own to a child with it.
/// @return the child; null if there is nothing to hand over.
aiNode* separate_geometry(const ModelNodes& nodes) {
  if (nodes.own->mNumMeshes == 0 || nodes.geometry.IsIdentity()) return nullptr;
  auto child = std::make_unique<aiNode>(to_string(nodes.own->mName) + kGeometryName);
  child->mTransformation = nodes.geometry;
  std::swap(child->mMeshes, nodes.own->mMeshes);
  std::swap(child->mNumMeshes, nodes.own->mNumMeshes);
  return child.release();
}

/// Joins the nodes by the parents of `tree`, and makes their names unique, so that channels reach
/// each of them.
/// @return the new names of nodes whose meshes went to a child, by the old ones.
std::map<std::string, std::string> rebuild(aiNode& root, const std::vector<ModelNodes>& all,
                                           const fbx::NodeTree& tree, Notes& notes) {
  std::map<std::string, std::string> moved;
  std::map<std::string, std::uint32_t> uses;
  std::vector<std::vector<aiNode*>> children(all.size());
  std::vector<aiNode*> roots;
  for (std::size_t i = 0; i < all.size(); ++i) {
    aiNode& own = *all[i].own;
    own.mTransformation = matrix_of(tree.rest[i]);
    const std::string name = to_string(own.mName);
    if (aiNode* const geometry = separate_geometry(all[i])) {
      children[i].push_back(geometry);
      moved.emplace(name, to_string(geometry->mName));
    }
    if (const std::uint32_t number = ++uses[name]; number > 1) {
      notes.inform("node '" + valid_utf8(name) + "'",
                   "several nodes have this name; a number was appended to the later ones");
      own.mName.Set(name + "_" + std::to_string(number));
    }
    (tree.parents[i] == kNone ? roots : children[tree.parents[i]]).push_back(&own);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!children[i].empty())
      all[i].own->addChildren(static_cast<unsigned>(children[i].size()), children[i].data());
  if (!roots.empty()) root.addChildren(static_cast<unsigned>(roots.size()), roots.data());
  return moved;
}

/// The keys of one part of a track. One that never changes has two, which keep the take's span.
template <class Key, class Value>
void write_keys(const fbx::Track& track, double ticks_per_second, const Value& value, Key*& keys,
                unsigned& count) {
  const std::size_t size = track.places.size();
  bool is_constant = true;
  for (std::size_t i = 1; i < size && is_constant; ++i)
    is_constant = value(track.places[i]) == value(track.places[0]);
  const std::size_t step = is_constant && size > 2 ? size - 1 : 1;
  keys = new Key[(size - 1) / step + 1];
  count = 0;
  for (std::size_t i = 0; i < size; i += step)
    keys[count++] = Key(track.seconds[i] * ticks_per_second, value(track.places[i]));
}

std::unique_ptr<aiNodeAnim> channel_of(const fbx::Track& track, const aiString& node,
                                       double ticks_per_second) {
  auto channel = std::make_unique<aiNodeAnim>();
  channel->mNodeName = node;
  const auto vector = [](const Vec3d& v) {
    return aiVector3D(static_cast<float>(v.x()), static_cast<float>(v.y()),
                      static_cast<float>(v.z()));
  };
  write_keys(
      track, ticks_per_second, [&](const auto& place) { return vector(place.translation); },
      channel->mPositionKeys, channel->mNumPositionKeys);
  write_keys(
      track, ticks_per_second, [&](const auto& place) { return vector(place.scale); },
      channel->mScalingKeys, channel->mNumScalingKeys);
  write_keys(
      track, ticks_per_second,
      [](const auto& place) {
        const Quatd& q = place.rotation;
        return aiQuaternion(static_cast<float>(q.w()), static_cast<float>(q.x()),
                            static_cast<float>(q.y()), static_cast<float>(q.z()));
      },
      channel->mRotationKeys, channel->mNumRotationKeys);
  return channel;
}

/// assimp's morph channels of a take, with the names of the nodes that have the meshes now.
void take_morphs(aiAnimation& from, aiAnimation& to,
                 const std::map<std::string, std::string>& moved) {
  std::swap(from.mMorphMeshChannels, to.mMorphMeshChannels);
  std::swap(from.mNumMorphMeshChannels, to.mNumMorphMeshChannels);
  for (unsigned i = 0; i < to.mNumMorphMeshChannels; ++i) {
    aiString& name = to.mMorphMeshChannels[i]->mName;
    const std::string text = to_string(name);
    const std::size_t end = std::min(text.size(), text.rfind('*'));
    if (const auto found = moved.find(text.substr(0, end)); found != moved.end())
      name.Set(found->second + text.substr(end));
  }
}

void replace_animations(aiScene& scene, const fbx::Scene& file, const fbx::NodeTree& tree,
                        const std::vector<ModelNodes>& all,
                        const std::map<std::string, std::string>& moved) {
  std::vector<std::unique_ptr<aiAnimation>> made;
  unsigned old = 0;  // assimp leaves out takes that drive nothing.
  for (const fbx::Take& take : file.takes) {
    const std::vector<fbx::Track> tracks = fbx::make_tracks(file, tree, take);
    auto animation = std::make_unique<aiAnimation>();
    animation->mName.Set(take.name);
    animation->mTicksPerSecond = 1.0;
    if (old < scene.mNumAnimations && to_string(scene.mAnimations[old]->mName) == take.name) {
      aiAnimation& of_assimp = *scene.mAnimations[old++];
      animation->mTicksPerSecond = of_assimp.mTicksPerSecond;
      take_morphs(of_assimp, *animation, moved);
    }
    if (tracks.empty() && animation->mNumMorphMeshChannels == 0) continue;
    const fbx::TakeSpan span = fbx::span_of(take);
    animation->mDuration =
        (span.stop - span.start) / fbx::kTicksPerSecond * animation->mTicksPerSecond;
    animation->mChannels = new aiNodeAnim*[tracks.size()]();
    for (const fbx::Track& track : tracks)
      animation->mChannels[animation->mNumChannels++] =
          channel_of(track, all[track.model].own->mName, animation->mTicksPerSecond).release();
    made.push_back(std::move(animation));
  }
  for (unsigned i = 0; i < scene.mNumAnimations; ++i) delete scene.mAnimations[i];
  delete[] scene.mAnimations;
  scene.mAnimations = new aiAnimation*[made.size()]();
  scene.mNumAnimations = 0;
  for (auto& animation : made) scene.mAnimations[scene.mNumAnimations++] = animation.release();
}

}  // namespace

void take_fbx_transforms(aiScene& scene, const ModelFile& model, Notes& notes) {
  std::vector<std::byte> bytes(model.file.bytes);
  bytes.resize(files::read_at(model.file.descriptor, bytes.data(), bytes.size(), 0));
  const fbx::Scene file = fbx::read_scene(fbx::read_records(bytes));
  const fbx::NodeTree tree = fbx::make_tree(file);
  const std::vector<ModelNodes> all = match_all(*scene.mRootNode, file);
  keep_own_nodes(*scene.mRootNode, all);
  const std::map<std::string, std::string> moved = rebuild(*scene.mRootNode, all, tree, notes);
  if (tree.sheared > 0)
    notes.repaired(StatusCode::unsupported_feature, "nodes",
                   "shear removed, which a node cannot have", tree.sheared);
  replace_animations(scene, file, tree, all, moved);
}

}  // namespace sunder::assimp_import
