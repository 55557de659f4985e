#include "particles/motion/turn_of.h"

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

TEST(turn_of, is_the_polar_factor) {
  test::Random random(1);
  for (int i = 0; i < 3000; ++i) {
    Eigen::Matrix3d m;
    for (int k = 0; k < 9; ++k) m(k) = random.uniform(-1, 1);
    m *= std::pow(10, random.uniform(-6, 6));
    Mat3d turn = Mat3d::Constant(7);
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto values = svd.singularValues();
    const bool is_there = particles::turn_of(m, turn);
    if (m.determinant() <= 0) {
      EXPECT_FALSE(is_there);
      EXPECT_EQ(turn, Mat3d::Constant(7));
    } else if (values[2] > 1e-3 * values[0]) {
      ASSERT_TRUE(is_there);
      EXPECT_LT((turn - svd.matrixU() * svd.matrixV().transpose()).norm(), 1e-11);
    }
  }
}

TEST(turn_of, a_rotation_is_itself_and_nothing_has_none) {
  Mat3d turn;
  ASSERT_TRUE(particles::turn_of(Mat3d::Identity(), turn));
  EXPECT_LT((turn - Mat3d::Identity()).norm(), 1e-15);
  EXPECT_FALSE(particles::turn_of(Mat3d::Zero(), turn));
  EXPECT_FALSE(particles::turn_of(Vec3d(1, 1, 0).asDiagonal(), turn));
  EXPECT_FALSE(particles::turn_of(Vec3d(1, 1, -1).asDiagonal(), turn));
  EXPECT_FALSE(particles::turn_of(Mat3d::Constant(std::numeric_limits<double>::quiet_NaN()), turn));
}

}  // namespace
}  // namespace sunder
