// Blended matrices whose parts are not the identity at bind, because skins have matrices of their
// own.

#include "weights/certificate/blend_matrices.h"

#include <new>

#include <Eigen/LU>

#include "core/internal/ordered.h"
#include "weights/certificate/joint_path.h"
#include "weights/certificate/skin_rows.h"

namespace sunder {
namespace certificate {

std::span<const Mat3d> at_bind_of(const SkinBlends& blends, std::size_t point) {
  if (blends.at_bind.empty()) return {};
  const std::vector<std::uint32_t>& first = blends.points.first;
  return {blends.at_bind.data() + first[point], first[point + 1] - first[point]};
}

bool relative_to_bind(std::span<const SkinTerm> terms, std::span<const Mat3d> at_bind,
                      std::vector<Mat3d>& relative) {
  relative.clear();
  if (at_bind.empty()) return true;
  Mat3d blended = Mat3d::Zero();
  for (std::size_t i = 0; i < terms.size(); ++i) blended += terms[i].m * at_bind[i];
  const double size = norm(blended), volume = determinant(blended);
  if (!(std::abs(volume) > 1e-12 * size * size * size)) return false;
  const Mat3d inverse = blended.inverse();
  for (const Mat3d& matrix : at_bind) {
    relative.push_back(multiply(matrix, inverse));
    if (!(determinant(relative.back()) > 0)) return false;
  }
  return true;
}

Status check_blends(const JointTree::State& tree, const SkinBlends& blends) {
  if (const Status status = check_rows(tree, blends.points); !status) return status;
  const std::size_t matrices = blends.at_bind.size(), terms = blends.points.terms.size();
  if (matrices != 0 && matrices != terms)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu matrices at bind of %zu terms; there must be none or one per term",
                           matrices, terms);
  for (std::uint32_t point = 0; point + 1 < blends.points.first.size(); ++point)
    for (const Mat3d& matrix : at_bind_of(blends, point))
      if (!matrix.allFinite())
        return Status::failure(StatusCode::non_finite_value, point,
                               "point %u: a matrix at bind is not finite", point);
  return {};
}

namespace {

/// The linear part at bind of what moves the term of a bone.
Mat3d matrix_at_bind(const Skin& skin, const ModelPose& bind, std::span<const Influence> influences,
                     std::uint32_t bone) {
  Mat3d sum = Mat3d::Zero();
  double weight = 0;
  for (const Influence& influence : influences) {
    if (skin.bones[influence.slot] != bone) continue;
    const auto w = static_cast<double>(influence.weight);
    sum += w * multiply(Mat3d(bind.model_from_bone[bone].linear()),
                        Mat3d(skin.bone_from_bind[influence.slot].linear().cast<double>()));
    weight += w;
  }
  return sum / weight;
}

}  // namespace
}  // namespace certificate

Status append_blend(const Character& character, const ModelPose& bind, std::uint32_t mesh,
                    std::uint32_t vertex, SkinBlends& blends) {
  using namespace certificate;
  SkinDifferences& points = blends.points;
  if (blends.at_bind.size() != points.terms.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu matrices at bind of %zu terms; there must be one per term",
                           blends.at_bind.size(), points.terms.size());
  try {
    SkinDifferences row;
    const VertexShare share[] = {{vertex, 1.0}};
    if (const Status status = append_difference(character, bind, mesh, share, row); !status)
      return status;
    const Mesh& of = character.meshes[mesh];
    points.first.reserve(points.first.size() + 1);
    points.terms.reserve(points.terms.size() + row.terms.size());
    blends.at_bind.reserve(blends.at_bind.size() + row.terms.size());
    for (const SkinTerm& term : row.terms) {
      points.terms.push_back(term);
      blends.at_bind.push_back(
          matrix_at_bind(character.skins[of.skin], bind, of.weights.of(vertex), term.bone));
    }
    points.first.push_back(static_cast<std::uint32_t>(points.terms.size()));
    return {};
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
