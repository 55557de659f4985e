#include "support/models/refit_scene.h"

#include <algorithm>
#include <cmath>

namespace sunder::test {
namespace {

double joint_x(std::uint32_t slot, std::uint32_t slots) { return 2.0 * slot / slots - 1; }

/// Up to four bones whose middles are nearest, with some randomness.
std::vector<Influence> influences_at(double x, std::uint32_t slots, Random& random) {
  std::vector<Influence> influences;
  const double reach = 6.0 / slots;
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    const double away = (x - joint_x(slot, slots) - 1.0 / slots) / reach;
    influences.push_back(
        {slot, static_cast<float>(std::exp(-3 * away * away) * random.uniform(0.5, 1.5))});
  }
  std::sort(influences.begin(), influences.end(),
            [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  influences.resize(std::min<std::size_t>(influences.size(), 3 + random.index(2)));
  float sum = 0;
  for (const Influence& influence : influences) sum += influence.weight;
  for (Influence& influence : influences) influence.weight /= sum;
  return influences;
}

std::vector<Influence> barycentric_weights(const AnimationPoint& exact, std::size_t maximum) {
  std::vector<Influence> influences;
  for (const auto& term : exact.terms())
    influences.push_back({term.slot, static_cast<float>(term.q.w())});
  std::sort(influences.begin(), influences.end(),
            [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  if (maximum > 0) influences.resize(std::min(influences.size(), maximum));
  float sum = 0;
  for (const Influence& influence : influences) sum += influence.weight;
  for (Influence& influence : influences) influence.weight /= sum;
  return influences;
}

}  // namespace

std::vector<Affine3d> bent_chain(Random& random, std::uint32_t slots, double angle,
                                 const Vec3d& centre) {
  std::vector<Affine3d> palette(slots, Affine3d::Identity());
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    const Eigen::Vector3d axis = random.direction();
    const Eigen::AngleAxisd turn(random.uniform(-angle, angle), axis);
    const Eigen::Vector3d joint = centre + Vec3d(joint_x(slot, slots), 0, 0);
    Affine3d bend = Affine3d::Identity();
    bend.linear() = turn.toRotationMatrix();
    bend.translation() = joint - turn * joint;
    palette[slot] = slot == 0 ? bend : palette[slot - 1] * bend;
  }
  return palette;
}

Lip::Lip(Random& random, const RefitScene& wanted)
    : exact(wanted.points), barycentric(wanted.points) {
  for (std::uint32_t i = 0; i < wanted.poses; ++i)
    palettes.push_back(bent_chain(random, wanted.slots, wanted.angle, wanted.centre));
  moments.emplace_back(wanted.slots, wanted.centre);
  const double step = 1.8 / wanted.points;
  for (std::uint32_t i = 0; i < wanted.points; ++i) {
    const double u = random.uniform(0.1, 0.5), v = random.uniform(0.1, 0.4);
    Vec3d position = Vec3d::Zero();
    for (const double part : {u, v, 1 - u - v}) {
      const Vec3d away = wanted.face * random.direction();
      const Vec3d corner = Vec3d(-0.9 + step * i, 0.2, 0) + away;
      exact[i].add(part, wanted.centre + corner, influences_at(corner.x(), wanted.slots, random));
      position += part * corner;
    }
    barycentric[i] = barycentric_weights(exact[i], wanted.maximum_influences);
    points.push_back({&exact[i], wanted.centre + position, barycentric[i]});
    moments[0].want(exact[i]);
    if (i > 0) neighbours.push_back({i - 1, i, step});
    for (int k = 0; k < 2; ++k)
      neighbours.push_back({i, kNone, random.uniform(0.5, 1.0) * wanted.face});
  }
  for (const auto& palette : palettes) moments[0].add(palette);
}

Vec3d Lip::target(std::size_t point, std::size_t pose) const {
  double sum = 0;
  for (const auto& term : exact[point].terms()) sum += term.q.w();
  return exact[point].posed(palettes[pose]) / sum;
}

double Lip::mean_square(std::size_t point, std::span<const Influence> influences,
                        const Vec3d& position) const {
  double sum = 0, weight_sum = 0;
  for (const Influence& influence : influences) weight_sum += static_cast<double>(influence.weight);
  for (std::size_t pose = 0; pose < palettes.size(); ++pose) {
    // Differences from the exact position, so that no precision is lost far from the origin.
    const Vec3d wanted = target(point, pose);
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();
    for (const Influence& influence : influences)
      difference += static_cast<double>(influence.weight) / weight_sum *
                    (palettes[pose][influence.slot] * position - wanted);
    sum += difference.squaredNorm();
  }
  return sum / static_cast<double>(palettes.size());
}

}  // namespace sunder::test
