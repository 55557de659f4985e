#include "support/models/random_skin.h"

#include <algorithm>

namespace sunder::test {
namespace {

Vec3f random_vector(Random& random, double size) {
  const double x = random.uniform(-size, size), y = random.uniform(-size, size),
               z = random.uniform(-size, size);
  return Vec3d(x, y, z).cast<float>();
}

std::vector<Influence> random_influences(Random& random, const RandomSkin& wanted,
                                         std::uint32_t vertex) {
  const std::uint32_t spread = std::min(wanted.spread, wanted.slots);
  const auto middle = static_cast<std::uint32_t>(std::uint64_t{vertex} *
                                                 (wanted.slots - spread + 1) / wanted.vertices);
  std::vector<std::uint32_t> slots;
  for (std::uint32_t i = 0; i < spread; ++i) slots.push_back(middle + i);
  const std::uint32_t count = 1 + random.index(std::min(wanted.influences, spread));
  std::vector<Influence> influences;
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::swap(slots[i], slots[i + random.index(static_cast<std::uint32_t>(slots.size()) - i)]);
    influences.push_back({slots[i], static_cast<float>(random.uniform(0.05, 1))});
    sum += influences.back().weight;
  }
  for (Influence& influence : influences)
    influence.weight = static_cast<float>(influence.weight / sum);
  return influences;
}

}  // namespace

Mesh make_random_skin(Random& random, const RandomSkin& wanted) {
  Mesh mesh;
  mesh.name = "random";
  for (std::uint32_t v = 0; v < wanted.vertices; ++v) {
    mesh.positions.push_back(random_vector(random, 1));
    mesh.normals.push_back(random.direction().cast<float>());
    if (wanted.tangents) {
      const Vec3f tangent = random.direction().cast<float>();
      mesh.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(),
                                 random.index(2) == 0 ? 1.0f : -1.0f);
    }
    mesh.weights.append(random_influences(random, wanted, v));
  }
  mesh.morph_targets.resize(wanted.morph_targets);
  for (std::uint32_t j = 0; j < wanted.morph_targets; ++j) {
    MorphTarget& target = mesh.morph_targets[j];
    target.name = "target";
    for (std::uint32_t v = 0; v < wanted.vertices; ++v) {
      const bool moves =
          v * (j + 2) / std::max(1u, wanted.vertices) % 2 == 0;  // leaves long ranges unchanged
      target.position_deltas.push_back(moves ? random_vector(random, 0.1) : Vec3f(Vec3f::Zero()));
      if (j % 2 == 0)
        target.normal_deltas.push_back(moves ? random_vector(random, 0.1) : Vec3f(Vec3f::Zero()));
      if (wanted.tangents && j % 3 == 0)
        target.tangent_deltas.push_back(random_vector(random, 0.1));
    }
  }
  return mesh;
}

std::vector<Affine3d> random_palette(Random& random, std::uint32_t slots, double scale) {
  std::vector<Affine3d> palette(slots);
  for (Affine3d& matrix : palette) {
    matrix = Affine3d::Identity();
    const Vec3d axis = random.direction();
    matrix.linear() =
        Eigen::AngleAxisd(random.uniform(-3, 3), Eigen::Vector3d(axis)).toRotationMatrix();
    if (scale > 1.0 && random.index(3) != 0) {
      Mat3d stretch = Mat3d::Identity();
      for (int i = 0; i < 3; ++i) stretch(i, i) = random.uniform(1 / scale, scale);
      stretch(0, 1) = random.uniform(-0.3, 0.3);
      if (random.index(4) == 0) stretch.col(2) *= -1;
      matrix.linear() = matrix.linear() * stretch;
    }
    matrix.translation() = 0.5 * random.direction();
  }
  return palette;
}

std::vector<Affine3f> in_float(const std::vector<Affine3d>& palette) {
  std::vector<Affine3f> result;
  for (const Affine3d& matrix : palette) result.push_back(matrix.cast<float>());
  return result;
}

std::vector<Affine3d> in_double(const std::vector<Affine3f>& palette) {
  std::vector<Affine3d> result;
  for (const Affine3f& matrix : palette) result.push_back(matrix.cast<double>());
  return result;
}

}  // namespace sunder::test
