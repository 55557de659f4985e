#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bindings/godot/interface.h"

namespace sunder::godot {

/// Memory of a value whose layout only the host knows.
template <std::size_t kBytes>
struct alignas(8) Opaque {
  std::array<std::byte, kBytes> bytes = {};
};

/// A StringName.
class Name {
 public:
  explicit Name(const char* text) { host.string_name_new_with_utf8_chars(&value_, text); }
  ~Name() { host.variant_get_ptr_destructor(Type::string_name)(&value_); }
  Name(const Name&) = delete;
  Name& operator=(const Name&) = delete;

  [[nodiscard]] void* get() { return &value_; }
  [[nodiscard]] const void* get() const { return &value_; }

 private:
  Opaque<8> value_;
};

struct Vector3 {
  float x = 0, y = 0, z = 0;
};

/// Rows of the basis, then the origin.
struct Transform {
  std::array<float, 9> basis = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<float, 3> origin = {0, 0, 0};
};

/// A value of any type. Of a build of Godot with single precision.
class Variant {
 public:
  Variant() { host.variant_new_nil(&value_); }
  explicit Variant(std::int64_t number) : Variant(Type::integer, &number) {}
  explicit Variant(double number) : Variant(Type::real, &number) {}
  explicit Variant(bool is) : Variant(std::uint8_t{is}) {}
  explicit Variant(Vector3 vector) : Variant(Type::vector3, &vector) {}
  explicit Variant(const char* text);
  Variant(const Variant& other) { host.variant_new_copy(&value_, &other.value_); }
  Variant(Variant&& other) noexcept : Variant() { std::swap(value_, other.value_); }
  Variant& operator=(Variant other) {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Variant() { host.variant_destroy(&value_); }

  /// A copy of one of the host's.
  [[nodiscard]] static Variant copy(const void* variant);
  [[nodiscard]] static Variant object(void* object) { return Variant(Type::object, &object); }
  /// An array of nothing.
  [[nodiscard]] static Variant empty(Type type);
  /// @param type  of a packed array; `count` elements of `size` bytes.
  [[nodiscard]] static Variant packed(Type type, const void* elements, std::size_t count,
                                      std::size_t size);
  template <class Element>
  [[nodiscard]] static Variant packed(Type type, const std::vector<Element>& elements,
                                      std::size_t width = 1) {
    return packed(type, elements.data(), elements.size() / width, width * sizeof(Element));
  }

  [[nodiscard]] Type type() const { return host.variant_get_type(&value_); }
  [[nodiscard]] bool is_nil() const;
  [[nodiscard]] void* get() { return &value_; }
  [[nodiscard]] const void* get() const { return &value_; }

  /// A copy of the value to which a pointer of the host leads.
  [[nodiscard]] static Variant from(Type type, const void* value) { return Variant(type, value); }
  /// To a value of that type, as the host wants it.
  void assign_to(Type type, void* value) const;

  // Zero, or nothing, of another type.
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::int64_t integer() const;
  [[nodiscard]] double real() const;
  [[nodiscard]] Vector3 vector3() const;
  [[nodiscard]] Transform transform() const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] void* object() const;
  /// The numbers of a packed array. @param width  numbers per element.
  template <class Number>
  [[nodiscard]] std::vector<Number> numbers(Type type, std::size_t width = 1) const {
    std::vector<Number> result;
    read_packed(type, width * sizeof(Number), [&](const void* data, std::size_t count) {
      const auto* const first = static_cast<const Number*>(data);
      result.assign(first, first + count * width);
    });
    return result;
  }

  /// Calls a method. @return nil if the host refuses the call.
  template <class... Arguments>
  Variant call(const Name& method, const Arguments&... arguments) const {
    const std::array<const void*, sizeof...(Arguments) + 1> list = {arguments.get()..., nullptr};
    return call_list(method, list.data(), sizeof...(Arguments));
  }
  template <class... Arguments>
  Variant call(const char* method, const Arguments&... arguments) const {
    return call(Name(method), arguments...);
  }

  [[nodiscard]] Variant at(std::int64_t index) const;
  void set(std::int64_t index, const Variant& value);

 private:
  explicit Variant(std::uint8_t is) : Variant(Type::boolean, &is) {}
  Variant(Type type, const void* value) {
    host.get_variant_from_type_constructor(type)(&value_, const_cast<void*>(value));
  }
  [[nodiscard]] Variant call_list(const Name& method, const void* const* arguments,
                                  std::size_t count) const;
  template <class Value>
  [[nodiscard]] Value plain(Type type) const;
  template <class Read>
  void read_packed(Type type, std::size_t size, const Read& read) const;

  Opaque<24> value_;
};

/// A node that others may free at any time. A variant of a node is no longer valid then, and calls
/// by it are not checked in exported games, so it is looked up before each use.
class NodeReference {
 public:
  NodeReference() = default;
  explicit NodeReference(const Variant& node);

  /// Nil if the node is gone. Valid until scripts run.
  [[nodiscard]] Variant find() const;

 private:
  std::uint64_t id_ = 0;
};

/// The first element of a packed array that is not empty.
[[nodiscard]] void* elements_of(Type type, void* array);

template <class Read>
void Variant::read_packed(Type of, std::size_t, const Read& read) const {
  if (type() != of) return;
  const auto count = static_cast<std::size_t>(call("size").integer());
  if (count == 0) return;
  Opaque<16> array;
  host.get_variant_to_type_constructor(of)(&array, const_cast<Opaque<24>*>(&value_));
  read(elements_of(of, &array), count);
  host.variant_get_ptr_destructor(of)(&array);
}

}  // namespace sunder::godot
