#pragma once

// As much of Unreal as samples/unreal needs, written anew for the tests: names and signatures as
// the public documentation of Unreal 5 has them.

#include <cstdint>
#include <initializer_list>
#include <vector>

using int32 = std::int32_t;
using uint32 = std::uint32_t;
using uint64 = std::uint64_t;

template <class T>
struct TStubVector {
  T X = 0, Y = 0, Z = 0;
  TStubVector() = default;
  template <class A, class B, class C>
  TStubVector(A x, B y, C z) : X(T(x)), Y(T(y)), Z(T(z)) {}
  template <class U>
  explicit TStubVector(const TStubVector<U>& of) : X(T(of.X)), Y(T(of.Y)), Z(T(of.Z)) {}
  static TStubVector Zero() { return {0, 0, 0}; }
  static TStubVector UnitZ() { return {0, 0, 1}; }
  friend TStubVector operator*(T by, const TStubVector& of) {
    return {by * of.X, by * of.Y, by * of.Z};
  }
  bool operator==(const TStubVector&) const = default;
};
using FVector = TStubVector<double>;
using FVector3d = TStubVector<double>;
using FVector3f = TStubVector<float>;
struct FVector2D {};
struct FColor {};

template <class T>
class TArray {
 public:
  TArray() = default;
  TArray(std::initializer_list<T> values) : values_(values) {}
  int32 Num() const { return int32(values_.size()); }
  void SetNum(int32 count) { values_.resize(std::size_t(count)); }
  void Init(const T& value, int32 count) { values_.assign(std::size_t(count), value); }
  int32 Add(const T& value) {
    values_.push_back(value);
    return Num() - 1;
  }
  T& operator[](int32 i) { return values_.at(std::size_t(i)); }
  const T& operator[](int32 i) const { return values_.at(std::size_t(i)); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  bool operator==(const TArray&) const = default;

 private:
  std::vector<T> values_;
};

namespace UE::Geometry {
struct FIndex3i {
  int A = -1, B = -1, C = -1;
  FIndex3i() = default;
  FIndex3i(int a, int b, int c) : A(a), B(b), C(c) {}
  bool operator==(const FIndex3i&) const = default;
};
}  // namespace UE::Geometry
