// Normals, texture coordinates and morph displacements of vertices between those of the source.

#include <sunder/validation/validation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "validation/shared_character.h"

namespace sunder::test {
namespace {

constexpr std::array kCodes = {"SUNDER_W_NORMALS", "SUNDER_W_TANGENTS", "SUNDER_W_UV",
                               "SUNDER_W_MORPH_LOST"};

const Finding* find_code(const ValidationReport& report, std::string_view code) {
  const auto found = std::ranges::find(report.findings, code, &Finding::code);
  return found == report.findings.end() ? nullptr : &*found;
}

std::string attribute_alarms(const ValidationReport& report) {
  std::string text;
  for (const char* const code : kCodes)
    if (const Finding* const finding = find_code(report, code))
      text += std::string(code) + ": " + finding->text + "\n";
  return text;
}

template <class Value>
void append_mean(std::vector<Value>& values, Index a, Index b) {
  if (!values.empty()) values.push_back(Value(0.5f * (values[a] + values[b])));
}

/// Appends the middle of two vertices with all attributes.
Index append_middle(Mesh& mesh, Index a, Index b) {
  append_mean(mesh.positions, a, b);
  append_mean(mesh.normals, a, b);
  if (!mesh.normals.empty()) mesh.normals.back().normalize();
  for (auto& uv : mesh.uv_sets) append_mean(uv, a, b);
  for (MorphTarget& morph : mesh.morph_targets) append_mean(morph.position_deltas, a, b);
  std::map<Index, float> weights;
  for (const Index end : {a, b})
    for (const Influence& influence : mesh.weights.of(end))
      weights[influence.slot] += 0.5f * influence.weight;
  std::vector<Influence> influences;
  for (const auto& [slot, weight] : weights) influences.push_back({slot, weight});
  std::ranges::stable_sort(influences, std::ranges::greater(), &Influence::weight);
  mesh.weights.append(influences);
  return mesh.vertex_count() - 1;
}

/// Every triangle split into four. Seams and hard edges stay.
Character subdivided_with_attributes(const Character& character) {
  Character result = character;
  for (Mesh& mesh : result.meshes) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), kNone);
      if (is_new) at->second = append_middle(mesh, a, b);
      return at->second;
    };
    const std::vector<Triangle> before = mesh.triangles;
    const std::vector<Index> submesh = mesh.triangle_submesh;
    mesh.triangles.clear();
    mesh.triangle_submesh.clear();
    for (std::size_t t = 0; t < before.size(); ++t) {
      const auto [a, b, c] = before[t];
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& part :
           {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
        mesh.triangles.push_back(part);
        mesh.triangle_submesh.push_back(submesh[t]);
      }
    }
  }
  return result;
}

/// Of the vertices in each cell of a grid one stays, with all its attributes, for all of them.
Character thinned_out(const Character& character, float cell) {
  Character result = character;
  for (Mesh& mesh : result.meshes) {
    std::map<std::array<int, 3>, Index> kept;
    const auto keeper = [&](Index v) {
      const Vec3f p = mesh.positions[v] / cell;
      return kept
          .try_emplace({static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())),
                        static_cast<int>(std::floor(p.z()))},
                       v)
          .first->second;
    };
    std::vector<Triangle> triangles;
    std::vector<Index> submesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [a, b, c] = mesh.triangles[t];
      const Triangle face = {keeper(a), keeper(b), keeper(c)};
      if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
      triangles.push_back(face);
      submesh.push_back(mesh.triangle_submesh[t]);
    }
    mesh.triangles = std::move(triangles);
    mesh.triangle_submesh = std::move(submesh);
  }
  return result;
}

/// Models with seams, hard edges, two meshes, and a surface that is bent everywhere.
std::vector<Character> some_models() {
  std::vector<Character> models = {make_sheet(8), make_tube(12, 10, 3), make_two_tubes(8, 9),
                                   make_bumpy_ball(600)};
  return models;
}

TEST(Attributes, of_finer_and_coarser_copies_give_no_alarm) {
  for (const Character& model : some_models()) {
    const Character finer = subdivided_with_attributes(model);
    for (const Character& copy :
         {finer, subdivided_with_attributes(finer), thinned_out(model, 0.3f)}) {
      const auto report = validate_skin(share(model), share(copy));
      ASSERT_TRUE(report) << report.error().text();
      EXPECT_EQ(attribute_alarms(*report), "") << model.name;
    }
  }
}

/// Calls spoil(mesh, vertex) for every vertex of the tube's side that the source does not have, and
/// expects that exactly these are found.
template <class Spoil>
void expect_found(const char* code, const Spoil& spoil) {
  const Character source = make_tube(12, 10, 3);
  Character target = subdivided_with_attributes(source);
  Mesh& mesh = target.meshes[0];
  std::vector<bool> is_spoiled(mesh.vertex_count(), false);
  for (Index t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.triangle_submesh[t] == 0)
      for (const Index v : mesh.triangles[t])
        if (v >= source.meshes[0].vertex_count() && !is_spoiled[v]) {
          spoil(mesh, v);
          is_spoiled[v] = true;
        }
  const auto report = validate_skin(share(source), share(target));
  ASSERT_TRUE(report) << report.error().text();
  const Finding* const finding = find_code(*report, code);
  ASSERT_NE(finding, nullptr) << code;
  EXPECT_EQ(finding->severity, Severity::warning);
  EXPECT_EQ(finding->count, static_cast<std::uint64_t>(std::ranges::count(is_spoiled, true)))
      << finding->text;
  for (const FindingPlace& place : finding->places) EXPECT_TRUE(is_spoiled[place.vertex]);
}

TEST(Attributes, that_are_wrong_between_vertices_of_the_source_are_found) {
  expect_found("SUNDER_W_NORMALS", [](Mesh& mesh, Index v) { mesh.normals[v] = -mesh.normals[v]; });
  expect_found("SUNDER_W_UV",
               [](Mesh& mesh, Index v) { mesh.uv_sets[0][v] += Vec2f(0.0f, 0.02f); });
  expect_found("SUNDER_W_MORPH_LOST",
               [](Mesh& mesh, Index v) { mesh.morph_targets[0].position_deltas[v].setZero(); });
  expect_found("SUNDER_W_MORPH_LOST",
               [](Mesh& mesh, Index v) { mesh.morph_targets[0].position_deltas[v] *= 2.0f; });
}

TEST(Attributes, below_the_threshold_give_no_alarm) {
  const Character source = make_tube(12, 10, 3);
  Character target = subdivided_with_attributes(source);
  Mesh& mesh = target.meshes[0];
  for (Index v = source.meshes[0].vertex_count(); v < mesh.vertex_count(); ++v) {
    mesh.uv_sets[0][v] += Vec2f(0.009f, -0.009f);
    mesh.normals[v] =
        Vec3f(Eigen::AngleAxisf(0.45f, Eigen::Vector3f(mesh.normals[v].unitOrthogonal())) *
              Eigen::Vector3f(mesh.normals[v]));
    mesh.morph_targets[0].position_deltas[v] *= 1.4f;
  }
  const auto report = validate_skin(share(source), share(target));
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(attribute_alarms(*report), "");
}

}  // namespace
}  // namespace sunder::test
