#include "bindings/godot/variant.h"

#include <cstring>

namespace sunder::godot {

Variant::Variant(const char* text) {
  Opaque<8> string;
  host.string_new_with_utf8_chars(&string, text);
  host.get_variant_from_type_constructor(Type::string)(&value_, &string);
  host.variant_get_ptr_destructor(Type::string)(&string);
}

Variant Variant::copy(const void* variant) {
  Variant result;
  host.variant_destroy(&result.value_);
  host.variant_new_copy(&result.value_, variant);
  return result;
}

Variant Variant::empty(Type type) {
  Opaque<16> value;
  host.variant_get_ptr_constructor(type, 0)(&value, nullptr);
  Variant result(type, &value);
  host.variant_get_ptr_destructor(type)(&value);
  return result;
}

Variant Variant::packed(Type type, const void* elements, std::size_t count, std::size_t size) {
  const Variant resized = empty(type);
  if (count == 0) return resized;
  // An array in a variant is shared, so this one changes.
  resized.call("resize", Variant(static_cast<std::int64_t>(count)));
  Opaque<16> array;
  host.get_variant_to_type_constructor(type)(&array, const_cast<void*>(resized.get()));
  std::memcpy(elements_of(type, &array), elements, count * size);
  Variant result(type, &array);
  host.variant_get_ptr_destructor(type)(&array);
  return result;
}

template <class Value>
Value Variant::plain(Type of) const {
  Value value = {};
  if (type() == of) host.get_variant_to_type_constructor(of)(&value, const_cast<void*>(get()));
  return value;
}

void* Variant::object() const { return plain<void*>(Type::object); }

bool Variant::is_nil() const {
  return type() == Type::object ? object() == nullptr : type() == Type::nil;
}

bool Variant::boolean() const { return plain<std::uint8_t>(Type::boolean) != 0; }

void Variant::assign_to(Type type, void* value) const {
  const auto destroy = host.variant_get_ptr_destructor(type);
  if (destroy != nullptr) destroy(value);  // what stands there is a value already
  host.get_variant_to_type_constructor(type)(value, const_cast<void*>(get()));
}

std::int64_t Variant::integer() const { return plain<std::int64_t>(Type::integer); }

double Variant::real() const {
  return type() == Type::integer ? static_cast<double>(integer()) : plain<double>(Type::real);
}

Vector3 Variant::vector3() const { return plain<Vector3>(Type::vector3); }

Transform Variant::transform() const { return plain<Transform>(Type::transform); }

std::string Variant::text() const {
  if (type() != Type::string && type() != Type::string_name) return {};
  Opaque<8> string;
  host.get_variant_to_type_constructor(Type::string)(&string, const_cast<void*>(get()));
  const std::int64_t size = host.string_to_utf8_chars(&string, nullptr, 0);
  std::string text(static_cast<std::size_t>(size), '\0');
  host.string_to_utf8_chars(&string, text.data(), size);
  host.variant_get_ptr_destructor(Type::string)(&string);
  return text;
}

Variant Variant::call_list(const Name& method, const void* const* arguments,
                           std::size_t count) const {
  Variant result;
  host.variant_destroy(&result.value_);
  CallError error = {};
  host.variant_call(const_cast<Opaque<24>*>(&value_), method.get(), arguments,
                    static_cast<std::int64_t>(count), &result.value_, &error);
  return result;
}

Variant Variant::at(std::int64_t index) const {
  Variant result;
  host.variant_destroy(&result.value_);
  std::uint8_t is_valid = 0, is_out_of_range = 0;
  host.variant_get_indexed(&value_, index, &result.value_, &is_valid, &is_out_of_range);
  return result;
}

void Variant::set(std::int64_t index, const Variant& value) {
  std::uint8_t is_valid = 0, is_out_of_range = 0;
  host.variant_set_indexed(&value_, index, value.get(), &is_valid, &is_out_of_range);
}

NodeReference::NodeReference(const Variant& node) {
  if (void* const object = node.object(); object != nullptr)
    id_ = host.object_get_instance_id(object);
}

Variant NodeReference::find() const {
  void* const object = id_ == 0 ? nullptr : host.object_get_instance_from_id(id_);
  return object == nullptr ? Variant() : Variant::object(object);
}

void* elements_of(Type type, void* array) {
  switch (type) {
    case Type::packed_int32: return host.packed_int32_array_operator_index(array, 0);
    case Type::packed_float32: return host.packed_float32_array_operator_index(array, 0);
    case Type::packed_vector2: return host.packed_vector2_array_operator_index(array, 0);
    case Type::packed_vector3: return host.packed_vector3_array_operator_index(array, 0);
    default: return host.packed_color_array_operator_index(array, 0);
  }
}

}  // namespace sunder::godot
