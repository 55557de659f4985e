#include "support/models/planted_mistakes.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include <gtest/gtest.h>

namespace sunder::test {
namespace {

using Row = std::map<Index, double>;  // weight by slot

constexpr double kVisible = 0.03;  // L1 of weights

Row row_of(const Mesh& mesh, Index vertex) {
  Row row;
  for (const Influence& influence : mesh.weights.of(vertex))
    row[influence.slot] += static_cast<double>(influence.weight);
  return row;
}

double difference(const Row& a, const Row& b) {
  double sum = 0;
  for (const auto& [slot, weight] : a)
    sum += std::abs(weight - (b.contains(slot) ? b.at(slot) : 0.0));
  for (const auto& [slot, weight] : b) sum += a.contains(slot) ? 0.0 : weight;
  return sum;
}

/// Gives vertices other weights: rebuilds the arrays.
void set_rows(Mesh& mesh, const std::map<Index, Row>& rows) {
  SkinWeights weights;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    std::vector<Influence> influences(mesh.weights.of(v).begin(), mesh.weights.of(v).end());
    if (const auto row = rows.find(v); row != rows.end()) {
      double sum = 0;
      for (const auto& [slot, weight] : row->second) sum += weight;
      influences.clear();
      for (const auto& [slot, weight] : row->second)
        if (weight > 0) influences.push_back({slot, static_cast<float>(weight / sum)});
      std::ranges::stable_sort(influences, std::ranges::greater(), &Influence::weight);
    }
    weights.append(influences);
  }
  mesh.weights = std::move(weights);
}

struct Box {
  Vec3f least = Vec3f::Constant(1e30f), most = Vec3f::Constant(-1e30f);
  [[nodiscard]] double diagonal() const { return static_cast<double>((most - least).norm()); }
};

Box box_of(const Character& character) {
  Box box;
  for (const Mesh& mesh : character.meshes)
    for (const Vec3f& position : mesh.positions) {
      box.least = box.least.cwiseMin(position);
      box.most = box.most.cwiseMax(position);
    }
  return box;
}

/// Vertices of all meshes in the bind pose, model space.
std::vector<Vec3d> bind_places(const Character& model, const ModelPose& bind) {
  std::vector<Vec3d> places;
  for (const Mesh& mesh : model.meshes)
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Skin& skin = model.skins[mesh.skin];
      Vec3d posed = Vec3d::Zero();
      for (const Influence& influence : mesh.weights.of(v))
        posed += static_cast<double>(influence.weight) *
                 (bind.model_from_bone[skin.bones[influence.slot]] *
                  (skin.bone_from_bind[influence.slot].cast<double>() *
                   mesh.positions[v].cast<double>()));
      places.push_back(posed);
    }
  return places;
}

/// Cut in bind by a plane across the longest axis, in the middle, at a fifth of the way from one
/// row of vertices to the next.
TornModel cut_in_two(const Character& model) {
  auto torn = TornModel::create(std::make_shared<const Character>(model));
  const ModelPose bind = *bind_pose(model);
  const std::vector<Vec3d> places = bind_places(model, bind);
  Eigen::AlignedBox3d box;
  for (const Vec3d& place : places) box.extend(Eigen::Vector3d(place));
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const double middle = box.center()[axis];
  double below = box.min()[axis], above = box.max()[axis];
  for (const Vec3d& place : places) {
    if (place[axis] <= middle + 1e-4) below = std::max(below, place[axis]);
    if (place[axis] > middle + 1e-4) above = std::min(above, place[axis]);
  }
  PlaneCut cut;
  cut.normal = Vec3d::Zero();
  cut.normal[axis] = 1.0;
  cut.point = box.center();
  cut.point[axis] = below + 0.2 * (above - below);
  EXPECT_GT(torn->cut(bind, cut)->points_added, 0u);
  return std::move(*torn);
}

/// Every new vertex on an edge gets the weights that `reweigh` makes of its birth.
template <class Reweigh>
PlantedMistake at_new_vertices(const char* code, const Character& model, const Reweigh& reweigh) {
  const TornModel torn = cut_in_two(model);
  PlantedMistake planted{code, model, torn.character(), {}, {}, {}, {}, {}};
  for (Index m = 0; m < model.meshes.size(); ++m) {
    const Mesh& before = model.meshes[m];
    std::map<Index, Row> rows;
    for (Index v = before.vertex_count(); v < planted.target.meshes[m].vertex_count(); ++v) {
      const Birth birth = torn.birth(m, v);
      if (std::ranges::any_of(birth.barycentric, [](double b) { return b > 1 - 1e-3; })) continue;
      Birth mistaken = birth;
      reweigh(mistaken.barycentric);
      Row& row = rows[v];
      for (std::size_t k = 0; k < 3; ++k)
        for (const auto& [slot, weight] : row_of(before, before.triangles[birth.triangle][k]))
          if (mistaken.barycentric[k] > 0) row[slot] += mistaken.barycentric[k] * weight;
      planted.touched.insert({m, v});
      if (difference(row, row_of(planted.target.meshes[m], v)) > kVisible)
        planted.must.insert({m, v});
    }
    set_rows(planted.target.meshes[m], rows);
  }
  return planted;
}

PlantedMistake copy_end_point(const Character& model) {
  return at_new_vertices("SUNDER_W_COPIED", model, [](std::array<double, 3>& barycentric) {
    const auto largest = std::ranges::max_element(barycentric) - barycentric.begin();
    barycentric = {0, 0, 0};
    barycentric[static_cast<std::size_t>(largest)] = 1;
  });
}

PlantedMistake swap_t(const Character& model) {
  return at_new_vertices("SUNDER_W_SWAPPED", model, [](std::array<double, 3>& barycentric) {
    const auto least = std::ranges::min_element(barycentric) - barycentric.begin();
    std::swap(barycentric[static_cast<std::size_t>((least + 1) % 3)],
              barycentric[static_cast<std::size_t>((least + 2) % 3)]);
  });
}

/// Calls spoil(birth, source mesh, target mesh, vertex) for every new vertex on an edge; it returns
/// whether that must be found.
template <class Spoil>
PlantedMistake spoil_new_vertices(const char* code, const Character& model, const Spoil& spoil) {
  const TornModel torn = cut_in_two(model);
  PlantedMistake planted{code, model, torn.character(), {}, {}, {}, {}, {}};
  for (Index m = 0; m < model.meshes.size(); ++m) {
    Mesh& mesh = planted.target.meshes[m];
    for (Index v = model.meshes[m].vertex_count(); v < mesh.vertex_count(); ++v) {
      const Birth birth = torn.birth(m, v);
      if (std::ranges::any_of(birth.barycentric, [](double b) { return b > 1 - 1e-3; })) continue;
      planted.touched.insert({m, v});
      if (spoil(birth, model.meshes[m], mesh, v)) planted.must.insert({m, v});
    }
  }
  EXPECT_FALSE(planted.must.empty()) << code;
  return planted;
}

PlantedMistake copy_uv_of_far_end(const Character& model) {
  return spoil_new_vertices(
      "SUNDER_W_UV", model, [](const Birth& birth, const Mesh& before, Mesh& mesh, Index v) {
        std::size_t farthest = 0;
        for (std::size_t k = 1; k < 3; ++k) {
          const double part = birth.barycentric[k], least = birth.barycentric[farthest];
          if (part > 1e-3 && (least <= 1e-3 || part < least)) farthest = k;
        }
        const Vec2f right = mesh.uv_sets[0][v],
                    wrong = before.uv_sets[0][before.triangles[birth.triangle][farthest]];
        mesh.uv_sets[0][v] = wrong;
        return (right - wrong).cwiseAbs().maxCoeff() > 0.02f;
      });
}

PlantedMistake flip_normals(const Character& model) {
  return spoil_new_vertices("SUNDER_W_NORMALS", model,
                            [](const Birth&, const Mesh&, Mesh& mesh, Index v) {
                              mesh.normals[v] = -mesh.normals[v];
                              return true;
                            });
}

/// Five more bones that stand where the first one of each skin stands, with small weights that come
/// first at every vertex.
Character with_helpers(const Character& model) {
  Character result = model;
  std::vector<std::size_t> slots_before;
  for (std::size_t s = 0; s < result.skins.size(); ++s) {
    Skin& skin = result.skins[s];
    slots_before.push_back(skin.bones.size());
    for (int i = 0; i < 5; ++i) {
      Bone helper;
      helper.name = "helper_" + std::to_string(s) + "_" + std::to_string(i);
      helper.parent = skin.bones[0];
      skin.bones.push_back(static_cast<Index>(result.skeleton.bones.size()));
      skin.bone_from_bind.push_back(skin.bone_from_bind[0]);
      result.skeleton.bones.push_back(helper);
    }
  }
  for (Mesh& mesh : result.meshes) {
    SkinWeights weights;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      std::vector<Influence> influences;
      for (Index i = 0; i < 5; ++i)
        influences.push_back({static_cast<Index>(slots_before[mesh.skin]) + i,
                              0.0213f + 0.01f * static_cast<float>(i)});
      float rest = 1;
      for (const Influence& influence : influences) rest -= influence.weight;
      for (const Influence& influence : mesh.weights.of(v))
        influences.push_back({influence.slot, rest * influence.weight});
      weights.append(influences);
    }
    mesh.weights = std::move(weights);
  }
  return result;
}

PlantedMistake keep_first_four(const Character& model) {
  const Character source = with_helpers(model);
  PlantedMistake planted{"SUNDER_W_FIRST_KEPT", source, source, {}, {}, {}, {}, {}};
  for (Index m = 0; m < planted.target.meshes.size(); ++m) {
    Mesh& mesh = planted.target.meshes[m];
    std::map<Index, Row> rows;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      for (const Influence& influence : mesh.weights.of(v).first(4))
        rows[v][influence.slot] = static_cast<double>(influence.weight);
      planted.must.insert({m, v});
    }
    set_rows(mesh, rows);
  }
  planted.touched = planted.must;
  return planted;
}

PlantedMistake shrink_sums(const Character& model) {
  PlantedMistake planted{"SUNDER_W_SUM", model, model, {}, {}, {}, {}, {}};
  planted.stored_source = planted.stored_target = stored_as(model, WeightFormat::float32);
  for (Index m = 0; m < model.meshes.size(); ++m) {
    StoredInfluences& stored = planted.stored_target[m];
    for (Index v = 0; v < model.meshes[m].vertex_count(); v += 3) {
      for (Index i = 0; i < stored.per_vertex; ++i)
        stored.weights[v * stored.per_vertex + i] *= 0.98f;
      planted.must.insert({m, v});
    }
  }
  planted.touched = planted.must;
  return planted;
}

PlantedMistake round_one_by_one(const Character& model) {
  const Character source = with_helpers(model);
  PlantedMistake planted{"SUNDER_W_ROUNDING", source, source, {}, {}, {}, {}, {}};
  planted.stored_source = stored_as(source, WeightFormat::float32);
  planted.stored_target = planted.stored_source;
  for (Index m = 0; m < source.meshes.size(); ++m) {
    StoredInfluences& stored = planted.stored_target[m];
    stored.format = WeightFormat::unorm8;
    for (Index v = 0; v < source.meshes[m].vertex_count(); ++v) {
      long sum = 0;
      for (Index i = 0; i < stored.per_vertex; ++i) {
        float& weight = stored.weights[v * stored.per_vertex + i];
        const long units = std::lround(weight * 255.0f);
        sum += units;
        weight = static_cast<float>(units) / 255.0f;
      }
      if (sum != 255) planted.must.insert({m, v});
    }
  }
  planted.touched = planted.must;
  return planted;
}

PlantedMistake miss_byte_sums(const Character& model) {
  PlantedMistake planted{"SUNDER_W_SUM_INTEGER", model, model, {}, {}, {}, {}, {}};
  planted.stored_source = planted.stored_target = stored_as(model, WeightFormat::unorm8);
  for (Index m = 0; m < model.meshes.size(); ++m) {
    StoredInfluences& stored = planted.stored_target[m];
    for (Index v = 0; v < model.meshes[m].vertex_count(); v += 2) {
      float* const first = stored.weights.data() + v * stored.per_vertex;
      float& largest = *std::max_element(first, first + stored.per_vertex);
      const long units = std::lround(largest * 255.0f);
      largest = static_cast<float>(units + (v % 4 == 0 && units < 255 ? 1 : -1)) / 255.0f;
      planted.must.insert({m, v});
    }
  }
  planted.touched = planted.must;
  return planted;
}

/// Two slots of the first mesh's skin with much weight.
std::pair<Index, Index> two_slots(const Mesh& mesh) {
  std::map<Index, double> mass;
  for (const Influence& influence : mesh.weights.influences)
    mass[influence.slot] += static_cast<double>(influence.weight);
  Index first = kNone, second = kNone;
  for (const auto& [slot, weight] : mass)
    if (first == kNone || weight > mass[first]) first = slot;
  for (const auto& [slot, weight] : mass)
    if (slot != first && (second == kNone || weight > mass[second])) second = slot;
  return {std::min(first, second), std::max(first, second)};
}

/// Changes the rows of the first mesh. @param change  of a row; vertices that it alters are
/// touched.
template <class Change>
PlantedMistake in_first_mesh(const char* code, const Character& model, const Change& change) {
  PlantedMistake planted{code, model, model, {}, {}, {}, {}, {}};
  Mesh& mesh = planted.target.meshes[0];
  std::map<Index, Row> rows;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Row before = row_of(mesh, v);
    Row after = before;
    change(after);
    if (difference(before, after) == 0) continue;
    rows[v] = after;
    planted.touched.insert({0, v});
    if (difference(before, after) > kVisible) planted.must.insert({0, v});
  }
  set_rows(mesh, rows);
  return planted;
}

PlantedMistake swap_bones(const Character& model) {
  const auto [a, b] = two_slots(model.meshes[0]);
  return in_first_mesh("SUNDER_W_BONES_SWAPPED", model, [a = a, b = b](Row& row) {
    std::swap(row[a], row[b]);
    std::erase_if(row, [](const auto& entry) { return entry.second == 0; });
  });
}

PlantedMistake move_to_first(const Character& model) {
  const auto [a, b] = two_slots(model.meshes[0]);
  const Index moved = a == 0 ? b : a;
  return in_first_mesh("SUNDER_W_MOVED_TO_FIRST", model, [moved](Row& row) {
    if (!row.contains(moved)) return;
    row[0] += row[moved];
    row.erase(moved);
  });
}

/// A weighted bone that is not the first of its skin.
Index some_bone(const Character& model) {
  const auto [a, b] = two_slots(model.meshes[0]);
  return model.skins[model.meshes[0].skin].bones[b];
}

PlantedMistake unmap_bone(const Character& model) {
  PlantedMistake planted{"SUNDER_W_BONE_MISSING", model, model, {}, {}, {}, {}, {}};
  const Index bone = some_bone(model);
  planted.target.skeleton.bones[bone].name = "Qwz";
  for (Index m = 0; m < model.meshes.size(); ++m)
    for (Index v = 0; v < model.meshes[m].vertex_count(); ++v)
      for (const auto& [slot, weight] : row_of(model.meshes[m], v))
        if (model.skins[model.meshes[m].skin].bones[slot] == bone) planted.must.insert({m, v});
  planted.touched = planted.must;
  return planted;
}

/// The source is the torn model, the target has its lips as one.
PlantedMistake weld_lips(const Character& model) {
  const TornModel torn = cut_in_two(model);
  PlantedMistake planted{
      "SUNDER_W_LIP_WELDED", torn.character(), torn.character(), {}, {}, {}, {}, {}};
  for (Index m = 0; m < planted.target.meshes.size(); ++m) {
    Mesh& mesh = planted.target.meshes[m];
    std::map<std::array<float, 3>, Index> first;
    std::vector<Index> welded(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3f& p = mesh.positions[v];
      welded[v] = v;
      if (v < model.meshes[m].vertex_count()) continue;  // only what the cut made
      welded[v] = first.try_emplace({p.x(), p.y(), p.z()}, v).first->second;
      planted.touched.insert({m, welded[v]});
    }
    for (Triangle& triangle : mesh.triangles)
      for (Index& vertex : triangle) vertex = welded[vertex];
    std::erase_if(mesh.custom_attributes, [](const CustomAttribute& attribute) {
      return attribute.name == kTearSideAttribute;
    });
  }
  planted.must = planted.touched;
  return planted;
}

/// A half-edge with its triangle.
using HalfEdges = std::map<std::pair<Index, Index>, std::size_t>;

PlantedMistake leave_t_junction(const Character& model) {
  PlantedMistake planted{"SUNDER_W_T_JUNCTION", model, model, {}, {}, {}, {}, {}};
  Mesh& mesh = planted.target.meshes[0];
  HalfEdges half_edges;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      half_edges[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
  // The edge with the largest difference of weights: there the crack opens widest.
  std::pair<Index, Index> edge;
  double largest = -1;
  for (const auto& [of, t] : half_edges) {
    const double l1 = difference(row_of(mesh, of.first), row_of(mesh, of.second));
    if (l1 <= largest || !half_edges.contains({of.second, of.first})) continue;
    largest = l1;
    edge = of;
  }
  const Index a = edge.first, b = edge.second;
  const Index middle = mesh.vertex_count();
  Row row;
  for (const Index end : {a, b})
    for (const auto& [slot, weight] : row_of(mesh, end)) row[slot] += 0.5 * weight;
  mesh.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
  const auto append_mean = [&](auto& values) {
    if (!values.empty()) values.push_back(((values[a] + values[b]) * 0.5f).eval());
  };
  if (!mesh.normals.empty())
    mesh.normals.push_back((mesh.normals[a] + mesh.normals[b]).normalized());
  if (!mesh.tangents.empty()) mesh.tangents.push_back(Vec4f(mesh.tangents[a]));
  for (auto& set : mesh.uv_sets) append_mean(set);
  for (auto& set : mesh.color_sets) append_mean(set);
  for (MorphTarget& morph : mesh.morph_targets) {
    append_mean(morph.position_deltas);
    append_mean(morph.normal_deltas);
    append_mean(morph.tangent_deltas);
  }
  for (CustomAttribute& attribute : mesh.custom_attributes)
    for (std::uint32_t i = 0; i < attribute.components; ++i)
      attribute.values.push_back(attribute.values[a * attribute.components + i]);
  mesh.weights.append(std::vector<Influence>(mesh.weights.of(a).begin(), mesh.weights.of(a).end()));
  set_rows(mesh, {{middle, row}});
  const std::size_t t = half_edges[edge];
  Triangle second = mesh.triangles[t];
  std::ranges::replace(mesh.triangles[t], b, middle);
  std::ranges::replace(second, a, middle);
  mesh.triangles.push_back(second);
  mesh.triangle_submesh.push_back(mesh.triangle_submesh[t]);
  planted.must = planted.touched = {{0, middle}};
  return planted;
}

PlantedMistake lose_morphs(const Character& model) {
  Character source = model;
  const auto reach = static_cast<float>(0.05 * box_of(model).diagonal());
  source.rest_morph_weights.clear();
  for (Mesh& mesh : source.meshes) {
    mesh.morph_targets.assign(1, {"wave", {}, {}, {}});
    mesh.first_morph_weight = static_cast<Index>(source.rest_morph_weights.size());
    source.rest_morph_weights.push_back(0.0f);
    for (const Vec3f& position : mesh.positions)
      mesh.morph_targets[0].position_deltas.emplace_back(
          reach, 0.2f * reach * std::sin(position.y()), 0.0f);
  }
  for (Clip& clip : source.clips)
    std::erase_if(clip.channels, [](const Channel& channel) {
      return channel.target == ChannelTarget::morph_weights;
    });
  PlantedMistake planted{
      "SUNDER_W_MORPH_LOST", source, cut_in_two(source).character(), {}, {}, {}, {}, {}};
  for (Index m = 0; m < source.meshes.size(); ++m) {
    auto& deltas = planted.target.meshes[m].morph_targets[0].position_deltas;
    for (Index v = source.meshes[m].vertex_count(); v < deltas.size(); ++v) {
      deltas[v].setZero();
      planted.must.insert({m, v});
    }
  }
  planted.touched = planted.must;
  return planted;
}

PlantedMistake leave_bind_stale(const Character& model) {
  PlantedMistake planted{"SUNDER_W_BIND", model, model, {}, {}, {}, {}, {}};
  const Index bone = some_bone(model);
  Affine3f moved = Affine3f::Identity();
  moved.translate(Eigen::Vector3f::Constant(static_cast<float>(0.05 * box_of(model).diagonal())));
  for (Skin& skin : planted.target.skins)
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot)
      if (skin.bones[slot] == bone) skin.bone_from_bind[slot] = skin.bone_from_bind[slot] * moved;
  planted.bones = {bone};
  return planted;
}

PlantedMistake move_default_pose(const Character& model) {
  PlantedMistake planted{"SUNDER_W_DEFAULT_POSE", model, model, {}, {}, {}, {}, {}};
  const Index bone = some_bone(model);
  Quatf& rotation = planted.target.skeleton.bones[bone].rest.rotation;
  rotation = (rotation * Quatf(Eigen::AngleAxisf(0.4f, Eigen::Vector3f::UnitX()))).normalized();
  planted.bones = {bone};
  return planted;
}

PlantedMistake bleed(const Character& model) {
  PlantedMistake planted{"SUNDER_W_BLEED", model, model, {}, {}, {}, {}, {}};
  Mesh& mesh = planted.target.meshes[0];
  const auto [slot, other] = two_slots(mesh);
  // The five vertices that are farthest from all vertices which the bone governs.
  std::vector<Index> governed;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Row row = row_of(mesh, v);
    const auto most = std::ranges::max_element(row, {}, [](const auto& e) { return e.second; });
    if (row.contains(slot) && row.at(slot) >= most->second) governed.push_back(v);
  }
  std::vector<std::pair<float, Index>> by_distance;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    float least = 1e30f;
    for (const Index g : governed)
      least = std::min(least, (mesh.positions[v] - mesh.positions[g]).norm());
    by_distance.emplace_back(-least, v);
  }
  std::ranges::sort(by_distance);
  // Copies of a point get the same weights, as a careful tool would.
  std::map<Index, Row> rows;
  for (std::size_t i = 0; i < 5; ++i)
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      if (mesh.positions[v] == mesh.positions[by_distance[i].second]) {
        rows[v] = row_of(mesh, v);
        for (auto& [of, weight] : rows[v]) weight *= 0.8;
        rows[v][slot] += 0.2;
        planted.touched.insert({0, v});
      }
  set_rows(mesh, rows);
  // Copies of a point are reported once.
  std::set<std::array<float, 3>> places;
  for (const auto& [m, v] : planted.touched)
    if (const Vec3f& p = mesh.positions[v]; places.insert({p.x(), p.y(), p.z()}).second)
      planted.must.insert({m, v});
  return planted;
}

/// Reflects a transform in the plane x = 0.
Affine3f reflected(const Affine3f& transform) {
  Affine3f mirror = Affine3f::Identity();
  mirror.linear()(0, 0) = -1.0f;
  return mirror * transform * mirror;
}

/// The first mesh on the left with bones *_L, and its mirror image on the right with bones *_R, on
/// one skin of all bones.
Character make_two_sided(const Character& model) {
  Character result;
  result.name = model.name;
  const Box box = box_of(model);
  const float shift = -box.least.x() + 0.2f * static_cast<float>(box.diagonal());
  const Skin& skin = model.skins[model.meshes[0].skin];
  Skin both;
  both.name = "both";
  const ModelPose bind = *bind_pose(model);
  for (const bool right : {false, true})
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot) {
      Affine3f shifted = Affine3f::Identity();
      shifted.translate(Eigen::Vector3f(shift, 0, 0));
      Affine3f model_from_bone = shifted * bind.model_from_bone[skin.bones[slot]].cast<float>();
      Affine3f bone_from_bind = skin.bone_from_bind[slot] * shifted.inverse();
      if (right) {
        model_from_bone = reflected(model_from_bone);
        bone_from_bind = reflected(bone_from_bind);
      }
      Bone bone;
      bone.name = model.skeleton.bones[skin.bones[slot]].name + (right ? "_R" : "_L");
      bone.rest.translation = model_from_bone.translation();
      both.bones.push_back(static_cast<Index>(result.skeleton.bones.size()));
      both.bone_from_bind.push_back(bone_from_bind);
      result.skeleton.bones.push_back(bone);
    }
  result.skins = {both};
  for (const bool right : {false, true}) {
    Mesh mesh;
    mesh.name = right ? "right" : "left";
    for (const Vec3f& p : model.meshes[0].positions)
      mesh.positions.emplace_back((right ? -1.0f : 1.0f) * (p.x() + shift), p.y(), p.z());
    for (Triangle triangle : model.meshes[0].triangles) {
      if (right) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
    mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
    mesh.submeshes.resize(1);
    mesh.weights = model.meshes[0].weights;
    if (right)
      for (Influence& influence : mesh.weights.influences)
        influence.slot += static_cast<Index>(skin.bones.size());
    result.meshes.push_back(std::move(mesh));
  }
  return result;
}

PlantedMistake follow_other_side(const Character& model) {
  const Character source = make_two_sided(model);
  PlantedMistake planted{"SUNDER_W_WRONG_SIDE", source, source, {}, {}, {}, {}, {}};
  Mesh& mesh = planted.target.meshes[0];
  const auto per_side = static_cast<Index>(source.skins[0].bones.size() / 2);
  std::map<Index, Row> rows;
  for (Index v = 0; v < mesh.vertex_count(); v += 10) {
    for (const auto& [slot, weight] : row_of(mesh, v)) rows[v][slot + per_side] = weight;
    planted.must.insert({0, v});
  }
  set_rows(mesh, rows);
  planted.touched = planted.must;
  return planted;
}

PlantedMistake scale_by_100(const Character& model) {
  PlantedMistake planted{"SUNDER_W_SCALE", model, model, {}, {}, {}, {}, {}};
  for (Mesh& mesh : planted.target.meshes) {
    for (Vec3f& position : mesh.positions) position *= 100.0f;
    for (MorphTarget& morph : mesh.morph_targets)
      for (Vec3f& delta : morph.position_deltas) delta *= 100.0f;
  }
  for (Bone& bone : planted.target.skeleton.bones) bone.rest.translation *= 100.0f;
  for (Skin& skin : planted.target.skins)
    for (Affine3f& bind : skin.bone_from_bind) bind.translation() *= 100.0f;
  for (Clip& clip : planted.target.clips)
    for (Channel& channel : clip.channels)
      if (channel.target == ChannelTarget::translation)
        for (float& value : channel.values) value *= 100.0f;
  return planted;
}

template <class Integer>
void quantise_stored(const Character& character, Index m, StoredInfluences& stored) {
  const Mesh& mesh = character.meshes[m];
  std::vector<Integer> units;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    units.resize(influences.size());
    EXPECT_TRUE(quantise_weights(influences, std::span<Integer>(units)));
    for (std::size_t i = 0; i < units.size(); ++i)
      stored.weights[v * stored.per_vertex + i] =
          static_cast<float>(units[i]) / static_cast<float>(std::numeric_limits<Integer>::max());
  }
}

}  // namespace

std::vector<StoredInfluences> stored_as(const Character& character, WeightFormat format) {
  std::vector<StoredInfluences> all;
  for (Index m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    std::size_t most = 1;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      most = std::max(most, mesh.weights.of(v).size());
    StoredInfluences& stored = all.emplace_back();
    stored.format = format;
    stored.per_vertex = static_cast<Index>((most + 3) / 4 * 4);
    stored.slots.assign(mesh.vertex_count() * stored.per_vertex, 0);
    stored.weights.assign(mesh.vertex_count() * stored.per_vertex, 0.0f);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto influences = mesh.weights.of(v);
      for (std::size_t i = 0; i < influences.size(); ++i) {
        stored.slots[v * stored.per_vertex + i] = influences[i].slot;
        stored.weights[v * stored.per_vertex + i] = influences[i].weight;
      }
    }
    if (format == WeightFormat::unorm8) quantise_stored<std::uint8_t>(character, m, stored);
    if (format == WeightFormat::unorm16) quantise_stored<std::uint16_t>(character, m, stored);
  }
  return all;
}

PlantedMistake plant(Mistake mistake, const Character& model) {
  switch (mistake) {
    case Mistake::end_point_copied: return copy_end_point(model);
    case Mistake::t_swapped: return swap_t(model);
    case Mistake::first_four_kept: return keep_first_four(model);
    case Mistake::sums_of_98_percent: return shrink_sums(model);
    case Mistake::bytes_rounded_one_by_one: return round_one_by_one(model);
    case Mistake::byte_sums_off_by_one: return miss_byte_sums(model);
    case Mistake::bones_swapped: return swap_bones(model);
    case Mistake::bone_unmapped: return unmap_bone(model);
    case Mistake::weights_moved_to_first_bone: return move_to_first(model);
    case Mistake::lip_welded: return weld_lips(model);
    case Mistake::t_junction: return leave_t_junction(model);
    case Mistake::morph_lost: return lose_morphs(model);
    case Mistake::bind_stale: return leave_bind_stale(model);
    case Mistake::default_pose_moved: return move_default_pose(model);
    case Mistake::far_bone_bleeds: return bleed(model);
    case Mistake::left_follows_right: return follow_other_side(model);
    case Mistake::scaled_by_100: return scale_by_100(model);
    case Mistake::uv_of_one_end: return copy_uv_of_far_end(model);
    case Mistake::normals_flipped: return flip_normals(model);
  }
  return {};
}

}  // namespace sunder::test
