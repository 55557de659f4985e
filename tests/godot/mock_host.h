#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bindings/godot/interface.h"

/// A host like Godot, as far as the extension sees it: variants, packed arrays that are shared in
/// variants and copied when they are written, objects that are called by name, a class database. It
/// counts what lives.
namespace sunder::godot_test {

using godot::Type;

struct Object;

struct Vector {
  float x = 0, y = 0, z = 0;
};
struct Matrix {
  std::array<float, 9> basis = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<float, 3> origin = {0, 0, 0};
};

/// Elements of a packed array, by their bytes.
struct Packed {
  std::vector<std::byte> bytes;
};
/// What a variant of a packed array refers to; copies of the variant refer to the same.
struct PackedReference {
  std::shared_ptr<Packed> data = std::make_shared<Packed>();
};

struct Value;
using List = std::shared_ptr<std::vector<Value>>;

/// What a variant of an object has: a pointer that is not checked. It keeps an object that counts
/// its references; another may be gone.
class Reference {
 public:
  Reference() = default;
  explicit Reference(Object* object);
  Reference(const Reference& other);
  Reference& operator=(const Reference& other);
  ~Reference();
  [[nodiscard]] Object* get() const { return object_; }
  [[nodiscard]] bool is_stale() const;

 private:
  Reference(Object* object, std::uint64_t id, bool counts);
  Object* object_ = nullptr;
  std::uint64_t id_ = 0;
  bool counts_ = false;
};

struct Value {
  Type type = Type::nil;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Vector, Matrix, Reference,
               List, std::shared_ptr<PackedReference>>
      data;
};

using Arguments = std::vector<Value>;

struct Object {
  explicit Object(bool counts) : counts_references(counts), id(++last_id) { living[id] = this; }
  virtual ~Object() { living.erase(id); }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  /// @return nothing for a method that there is not, or for other arguments.
  virtual std::unique_ptr<Value> call(const std::string& method, const Arguments& arguments) = 0;

  bool counts_references;
  int references = 0;
  void* instance = nullptr;  ///< Of a class of the extension.
  const std::uint64_t id;
  static inline std::uint64_t last_id = 0;
  static inline std::map<std::uint64_t, Object*> living;  ///< By id.
};

// ---- Values.

Value nil();
Value of(std::int64_t number);
Value of(double number);
Value of(bool is);
Value of(const std::string& text);
Value of(const Vector& vector);
Value of(const Matrix& matrix);
Value of(Object* object);
Value list(std::size_t count);
std::size_t element_size(Type packed);

template <class Number>
Value packed(Type type, const std::vector<Number>& numbers) {
  auto reference = std::make_shared<PackedReference>();
  const auto* const first = reinterpret_cast<const std::byte*>(numbers.data());
  reference->data->bytes.assign(first, first + numbers.size() * sizeof(Number));
  return {type, reference};
}
template <class Number>
std::vector<Number> numbers(const Value& value) {
  const auto* const reference = std::get_if<std::shared_ptr<PackedReference>>(&value.data);
  if (reference == nullptr) return {};
  const std::vector<std::byte>& bytes = (*reference)->data->bytes;
  const auto* const first = reinterpret_cast<const Number*>(bytes.data());
  return {first, first + bytes.size() / sizeof(Number)};
}

// ---- The host.

/// A class that the extension registered.
struct RegisteredClass {
  std::string parent;
  godot::ClassInfo info = {};
  std::map<std::string, godot::MethodInfo> methods;
  std::map<std::string, std::vector<Type>> argument_types;
  std::map<std::string, std::size_t> signals;  ///< Number of arguments.
};

struct Host {
  std::map<std::string, RegisteredClass> classes;
  std::function<Object*(const std::string& class_name)> construct;
  std::vector<std::string> errors;
  int living_variants = 0, living_strings = 0, living_arrays = 0;
};
extern Host host;

/// What the host gives to the extension. `without`: a name that it does not know.
godot::GetProcAddress get_proc_address(const std::string& without = "");

/// Calls a method of the extension by variants, as scripts do, or by pointers, as typed scripts do.
Value call_method(const std::string& class_name, void* instance, const std::string& method,
                  const Arguments& arguments, godot::CallError* error = nullptr);
Value ptrcall_method(const std::string& class_name, void* instance, const std::string& method,
                     const Arguments& arguments, Type returned);

}  // namespace sunder::godot_test
