#pragma once

#include <sunder/core/math.h>
#include <sunder/core/status.h>
#include <sunder/particles/state_arrays.h>

#include <array>
#include <cmath>
#include <string_view>

namespace sunder::particles {

/// Writes values to StateArrays, or reads them back in the same order: one function describes a
/// type for both. The arrays may come from strangers: while reading, values that do not fit are
/// noted, and after the first fault arrays grow no more.
class Tape {
 public:
  static Tape writer(StateArrays& to) {
    Tape tape;
    tape.to_ = &to;
    return tape;
  }
  static Tape reader(const StateArrays& from) {
    Tape tape;
    tape.from_ = &from;
    return tape;
  }
  [[nodiscard]] bool is_reading() const { return from_ != nullptr; }
  /// The first fault; ok if everything was read and fitted.
  [[nodiscard]] const Status& status() const { return status_; }
  /// Notes a fault, of which only the first counts.
  void fail(StatusCode code, const char* what) {
    if (status_) status_ = Status::failure(code, kNone, "a recorded state of particles: %s", what);
  }
  void require(bool holds, const char* what) {
    if (!holds) fail(StatusCode::index_out_of_range, what);
  }
  /// Ends reading: everything must have been read.
  void end() {
    if (remaining() != 0) fail(StatusCode::size_mismatch, "there is more data than expected");
  }

  void operator()(std::uint32_t& value) { pass(&StateArrays::indices, indices_, value); }
  void operator()(std::uint64_t& value) { pass(&StateArrays::numbers, numbers_, value); }
  void operator()(float& value) { finite(&StateArrays::floats, floats_, value); }
  void operator()(double& value) { finite(&StateArrays::doubles, doubles_, value); }
  /// A float or double that may be infinite or no number.
  void any(float& value) { pass(&StateArrays::floats, floats_, value); }
  void any(double& value) { pass(&StateArrays::doubles, doubles_, value); }
  /// A number below `count`, in a type that holds few.
  template <class Small>
  void small(Small& value, std::uint32_t count) {
    auto index = static_cast<std::uint32_t>(value);
    (*this)(index);
    if (index >= count) fail(StatusCode::index_out_of_range, "a number of a kind is too large");
    value = static_cast<Small>(index < count ? index : 0);
  }
  void operator()(bool& value) { small(value, 2); }
  /// A finite number from `least` to `most`.
  template <class Scalar>
  void within(Scalar& value, double least, double most) {
    (*this)(value);
    const auto found = static_cast<double>(value);
    if (is_reading() && !(found >= least && found <= most))
      fail(StatusCode::invalid_argument, "a number is out of its range");
  }
  /// A matrix none of whose numbers is larger than `most`.
  template <class Scalar, int Rows, int Columns, int Options>
  void within(Eigen::Matrix<Scalar, Rows, Columns, Options>& matrix, double most) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) within(matrix.data()[i], -most, most);
  }
  template <class Scalar, int Rows, int Columns, int Options>
  void operator()(Eigen::Matrix<Scalar, Rows, Columns, Options>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) (*this)(matrix.data()[i]);
  }

  /// The size of an array, each of whose elements takes at least one value. @return what is read.
  std::size_t size(std::size_t now) {
    auto count = std::uint64_t{now};
    (*this)(count);
    if (!is_reading() || count <= remaining()) return static_cast<std::size_t>(count);
    fail(StatusCode::size_mismatch, "an array is larger than the data");
    return 0;
  }
  /// An array of values of the types above.
  template <class T>
  void all(std::vector<T>& values) {
    each(values, [&](T& value) { (*this)(value); });
  }
  /// An array whose elements `describe` passes, or those from `first` on: the array has those
  /// before. It grows with what is read, not by what a number claims, unless its elements are about
  /// as small as the numbers that are left for each.
  template <class T, class Describe>
  void each(std::vector<T>& values, Describe describe, std::size_t first = 0) {
    std::size_t count = size(values.size() - first);
    if (!is_reading()) {
      for (std::size_t i = first; i < values.size(); ++i) describe(values[i]);
      return;
    }
    values.resize(first);
    if (sizeof(T) <= kSmallBytes && values.capacity() < first + count)
      values.reserve(first + count);
    for (; count > 0 && status_; --count) describe(values.emplace_back());
  }

 private:
  static constexpr std::size_t kSmallBytes = 16;

  template <class T>
  void pass(std::vector<T> StateArrays::*array, std::size_t& at, T& value) {
    if (to_ != nullptr) {
      (to_->*array).push_back(value);
    } else if (at < (from_->*array).size()) {
      value = (from_->*array)[at++];
    } else {
      fail(StatusCode::size_mismatch, "the data ends too early");
      value = T();
    }
  }
  template <class T>
  void finite(std::vector<T> StateArrays::*array, std::size_t& at, T& value) {
    pass(array, at, value);
    if (!is_reading() || std::isfinite(value)) return;
    fail(StatusCode::non_finite_value, "a value is not finite");
    value = 0;
  }
  [[nodiscard]] std::size_t remaining() const {
    return from_->indices.size() - indices_ + from_->numbers.size() - numbers_ +
           from_->floats.size() - floats_ + from_->doubles.size() - doubles_;
  }

  StateArrays* to_ = nullptr;
  const StateArrays* from_ = nullptr;
  std::size_t indices_ = 0, numbers_ = 0, floats_ = 0, doubles_ = 0;
  Status status_;
};

}  // namespace sunder::particles
