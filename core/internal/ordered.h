#pragma once

#include <sunder/core/math.h>

#include <cmath>
#include <cstddef>
#include <utility>

namespace sunder {

// Sums of products in one written order: from the first coefficient to the last, ((a0 b0 + a1 b1) +
// a2 b2) + …, matrices column by column. Eigen's own dot(), norm(), products and inverses add in an
// order that depends on the compiler's vector instructions, so their last bit differs between
// machines. Code whose results are stored or reported uses these functions instead. Sums,
// differences, multiples and cross products of Eigen have only one order and are used directly.

namespace ordered {

template <class A>
inline constexpr int kRows = A::RowsAtCompileTime;
template <class A>
inline constexpr int kColumns = A::ColsAtCompileTime;
template <class A>
inline constexpr int kSize = A::SizeAtCompileTime;

/// A matrix of fixed size, whose layout does not depend on compiler flags.
template <class Scalar, int rows, int columns>
using Matrix = Eigen::Matrix<Scalar, rows, columns,
                             rows == 1 && columns != 1 ? Eigen::RowMajor | Eigen::DontAlign
                                                       : Eigen::DontAlign>;

/// Coefficient `i`, column by column.
template <class A>
EIGEN_STRONG_INLINE typename A::Scalar at(const A& a, std::size_t i) {
  static_assert(kSize<A> != Eigen::Dynamic, "the order is written for fixed sizes");
  const auto index = static_cast<Eigen::Index>(i);
  return a.coeff(index % kRows<A>, index / kRows<A>);
}

/// term(0) + term(1) + …, from the left.
template <std::size_t... I, class Term>
EIGEN_STRONG_INLINE auto add(std::index_sequence<I...>, const Term& term) {
  return (... + term(I));
}

/// Evaluates an expression that is read several times, unless reading it is cheap.
template <class A, int times>
using Nested = typename Eigen::internal::nested_eval<A, times>::type;

}  // namespace ordered

template <class A, class B>
EIGEN_STRONG_INLINE typename A::Scalar dot(const Eigen::MatrixBase<A>& a,
                                           const Eigen::MatrixBase<B>& b) {
  static_assert(ordered::kSize<A> == ordered::kSize<B>);
  return ordered::add(std::make_index_sequence<ordered::kSize<A>>(), [&](std::size_t i) {
    return ordered::at(a.derived(), i) * ordered::at(b.derived(), i);
  });
}

template <class A>
EIGEN_STRONG_INLINE typename A::Scalar squared_norm(const Eigen::MatrixBase<A>& a) {
  return ordered::add(std::make_index_sequence<ordered::kSize<A>>(), [&](std::size_t i) {
    const typename A::Scalar value = ordered::at(a.derived(), i);
    return value * value;
  });
}

/// Frobenius norm of a matrix.
template <class A>
EIGEN_STRONG_INLINE typename A::Scalar norm(const Eigen::MatrixBase<A>& a) {
  return std::sqrt(squared_norm(a));
}

/// Zero stays zero.
template <class A>
EIGEN_STRONG_INLINE auto normalized(const Eigen::MatrixBase<A>& a) {
  using Values = ordered::Matrix<typename A::Scalar, ordered::kRows<A>, ordered::kColumns<A>>;
  const Values values = a;
  const typename A::Scalar square = squared_norm(values);
  return square > 0 ? Values(values / std::sqrt(square)) : values;
}

template <class A>
EIGEN_STRONG_INLINE typename A::Scalar trace(const Eigen::MatrixBase<A>& a) {
  return ordered::add(std::make_index_sequence<ordered::kRows<A>>(), [&](std::size_t i) {
    return a.derived().coeff(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i));
  });
}

/// Matrix times matrix or column.
template <class A, class B>
EIGEN_STRONG_INLINE auto multiply(const Eigen::MatrixBase<A>& left,
                                  const Eigen::MatrixBase<B>& right) {
  static_assert(ordered::kColumns<A> == ordered::kRows<B>);
  const ordered::Nested<A, ordered::kColumns<B>> a(left.derived());
  const ordered::Nested<B, ordered::kRows<A>> b(right.derived());
  ordered::Matrix<typename A::Scalar, ordered::kRows<A>, ordered::kColumns<B>> product;
  for (Eigen::Index column = 0; column < ordered::kColumns<B>; ++column)
    for (Eigen::Index row = 0; row < ordered::kRows<A>; ++row)
      product.coeffRef(row, column) =
          ordered::add(std::make_index_sequence<ordered::kColumns<A>>(), [&](std::size_t i) {
            const auto k = static_cast<Eigen::Index>(i);
            return a.coeff(row, k) * b.coeff(k, column);
          });
  return product;
}

/// Point of an affine 3 x 4 matrix: the linear part's sum, then the translation.
template <class A, class B>
EIGEN_STRONG_INLINE auto transform(const Eigen::MatrixBase<A>& affine,
                                   const Eigen::MatrixBase<B>& point) {
  static_assert(ordered::kColumns<A> == 4 && ordered::kSize<B> == 3);
  const ordered::Nested<A, 1> a(affine.derived());
  const ordered::Nested<B, ordered::kRows<A>> p(point.derived());
  ordered::Matrix<typename A::Scalar, ordered::kRows<A>, 1> image;
  for (Eigen::Index row = 0; row < ordered::kRows<A>; ++row)
    image.coeffRef(row) = a.coeff(row, 0) * p.coeff(0) + a.coeff(row, 1) * p.coeff(1) +
                          a.coeff(row, 2) * p.coeff(2) + a.coeff(row, 3);
  return image;
}

template <class Scalar, int options, class B>
EIGEN_STRONG_INLINE auto transform(
    const Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options>& affine,
    const Eigen::MatrixBase<B>& point) {
  return transform(affine.matrix(), point);
}

template <class Scalar, int options>
Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options> multiply(
    const Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options>& left,
    const Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options>& right) {
  Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options> product;
  product.matrix().template leftCols<3>() = multiply(left.linear(), right.linear());
  product.matrix().col(3) = transform(left, right.matrix().col(3));
  return product;
}

/// Determinant of a 3 x 3 matrix, expanded along its first row.
template <class A>
typename A::Scalar determinant(const Eigen::MatrixBase<A>& matrix) {
  static_assert(ordered::kRows<A> == 3 && ordered::kColumns<A> == 3);
  const ordered::Nested<A, 3> m(matrix.derived());
  return m.coeff(0, 0) * (m.coeff(1, 1) * m.coeff(2, 2) - m.coeff(1, 2) * m.coeff(2, 1)) -
         m.coeff(0, 1) * (m.coeff(1, 0) * m.coeff(2, 2) - m.coeff(1, 2) * m.coeff(2, 0)) +
         m.coeff(0, 2) * (m.coeff(1, 0) * m.coeff(2, 1) - m.coeff(1, 1) * m.coeff(2, 0));
}

/// Inverse of a 3 x 3 matrix, by its cofactors. Not finite if the matrix is singular.
template <class A>
auto inverse(const Eigen::MatrixBase<A>& matrix) {
  static_assert(ordered::kRows<A> == 3 && ordered::kColumns<A> == 3);
  using Scalar = typename A::Scalar;
  const ordered::Nested<A, 4> m(matrix.derived());
  const auto cofactor = [&](Eigen::Index row, Eigen::Index column) {
    const Eigen::Index row1 = (row + 1) % 3, row2 = (row + 2) % 3, column1 = (column + 1) % 3,
                       column2 = (column + 2) % 3;
    return m.coeff(row1, column1) * m.coeff(row2, column2) -
           m.coeff(row1, column2) * m.coeff(row2, column1);
  };
  const Scalar one_over_determinant =
      Scalar(1) / (cofactor(0, 0) * m.coeff(0, 0) + cofactor(1, 0) * m.coeff(1, 0) +
                   cofactor(2, 0) * m.coeff(2, 0));
  ordered::Matrix<Scalar, 3, 3> result;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 3; ++column)
      result.coeffRef(row, column) = cofactor(column, row) * one_over_determinant;
  return result;
}

template <class Scalar, int options>
Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options> inverse(
    const Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options>& affine) {
  const ordered::Matrix<Scalar, 3, 3> linear = inverse(affine.linear());
  Eigen::Transform<Scalar, 3, Eigen::AffineCompact, options> result;
  result.matrix().template leftCols<3>() = linear;
  result.matrix().col(3) = -multiply(linear, affine.matrix().col(3));
  return result;
}

template <class A>
typename A::Scalar norm(const Eigen::QuaternionBase<A>& quaternion) {
  return norm(quaternion.coeffs());
}

template <class A>
auto normalized(const Eigen::QuaternionBase<A>& quaternion) {
  return Eigen::Quaternion<typename A::Scalar, Eigen::DontAlign>(normalized(quaternion.coeffs()));
}

/// Hamilton product: rotates by `b` first, then by `a`.
template <class A, class B>
auto multiply(const Eigen::QuaternionBase<A>& a, const Eigen::QuaternionBase<B>& b) {
  return Eigen::Quaternion<typename A::Scalar, Eigen::DontAlign>(
      a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
      a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
      a.w() * b.y() + a.y() * b.w() + a.z() * b.x() - a.x() * b.z(),
      a.w() * b.z() + a.z() * b.w() + a.x() * b.y() - a.y() * b.x());
}

}  // namespace sunder
