#pragma once

#include <cstddef>
#include <cstdint>

// What this extension uses of Godot's C interface (GDExtension, Godot 4.2 and later), declared by
// us: names of functions, their parameters, and layouts of structs. With
// -DSUNDER_GODOT_HEADERS=FOLDER, interface_check.cpp compares it with Godot's own header.

namespace sunder::godot {

/// Numbers of Variant::Type.
enum class Type : std::int32_t {
  nil = 0,
  boolean = 1,
  integer = 2,
  real = 3,
  string = 4,
  vector3 = 9,
  transform = 18,
  string_name = 21,
  object = 24,
  dictionary = 27,
  array = 28,
  packed_int32 = 30,
  packed_float32 = 32,
  packed_vector2 = 35,
  packed_vector3 = 36,
  packed_color = 37,
};

using AnyFunction = void (*)();
using GetProcAddress = AnyFunction (*)(const char* name);

struct CallError {
  std::int32_t error;  ///< 0: none.
  std::int32_t argument;
  std::int32_t expected;
};

struct PropertyInfo {
  Type type;
  void* name;        ///< StringName.
  void* class_name;  ///< StringName.
  std::uint32_t hint;
  void* hint_string;  ///< String.
  std::uint32_t usage;
};

using MethodCall = void (*)(void* method, void* instance, const void* const* arguments,
                            std::int64_t count, void* returned, CallError* error);
using MethodPtrCall = void (*)(void* method, void* instance, const void* const* arguments,
                               void* returned);

struct MethodInfo {
  void* name;
  void* method_userdata;
  MethodCall call;
  MethodPtrCall ptrcall;
  std::uint32_t flags;
  std::uint8_t has_return_value;
  PropertyInfo* return_value;
  std::int32_t return_metadata;
  std::uint32_t argument_count;
  PropertyInfo* arguments;
  std::int32_t* argument_metadata;
  std::uint32_t default_argument_count;
  void** default_arguments;
};

/// Describes a class to classdb_register_extension_class2. Functions that are not used are null.
struct ClassInfo {
  std::uint8_t is_virtual;
  std::uint8_t is_abstract;
  std::uint8_t is_exposed;
  AnyFunction set, get, get_property_list, free_property_list, property_can_revert,
      property_get_revert, validate_property;
  void (*notification)(void* instance, std::int32_t what, std::uint8_t is_reversed);
  AnyFunction to_string, reference, unreference;
  void* (*create_instance)(void* class_userdata);
  void (*free_instance)(void* class_userdata, void* instance);
  AnyFunction recreate_instance, get_virtual, get_virtual_call_data, call_virtual_with_data,
      get_rid;
  void* class_userdata;
};

struct Initialization {
  std::int32_t minimum_level;  ///< 2: the scene.
  void* userdata;
  void (*initialize)(void* userdata, std::int32_t level);
  void (*deinitialize)(void* userdata, std::int32_t level);
};
inline constexpr std::int32_t kSceneLevel = 2;

inline constexpr std::int32_t kNotificationProcess = 17;

using FromType = void (*)(void* variant, void* value);
using ToType = void (*)(void* value, void* variant);

/// The functions of the host, by the names under which it gives them.
struct Host {
  void (*string_name_new_with_utf8_chars)(void* name, const char* text);
  void (*string_new_with_utf8_chars)(void* string, const char* text);
  std::int64_t (*string_to_utf8_chars)(const void* string, char* text, std::int64_t most);
  void (*variant_new_nil)(void* variant);
  void (*variant_new_copy)(void* variant, const void* source);
  void (*variant_destroy)(void* variant);
  Type (*variant_get_type)(const void* variant);
  void (*variant_call)(void* variant, const void* method, const void* const* arguments,
                       std::int64_t count, void* returned, CallError* error);
  void (*variant_get_indexed)(const void* variant, std::int64_t index, void* value,
                              std::uint8_t* is_valid, std::uint8_t* is_out_of_range);
  void (*variant_set_indexed)(void* variant, std::int64_t index, const void* value,
                              std::uint8_t* is_valid, std::uint8_t* is_out_of_range);
  FromType (*get_variant_from_type_constructor)(Type type);
  ToType (*get_variant_to_type_constructor)(Type type);
  void (*(*variant_get_ptr_constructor)(Type type,
                                        std::int32_t which))(void* value,
                                                             const void* const* arguments);
  void (*(*variant_get_ptr_destructor)(Type type))(void* value);
  std::int32_t* (*packed_int32_array_operator_index)(void* array, std::int64_t index);
  float* (*packed_float32_array_operator_index)(void* array, std::int64_t index);
  void* (*packed_vector2_array_operator_index)(void* array, std::int64_t index);
  void* (*packed_vector3_array_operator_index)(void* array, std::int64_t index);
  void* (*packed_color_array_operator_index)(void* array, std::int64_t index);
  void* (*classdb_construct_object)(const void* class_name);
  void (*object_set_instance)(void* object, const void* class_name, void* instance);
  std::uint64_t (*object_get_instance_id)(const void* object);
  void* (*object_get_instance_from_id)(std::uint64_t id);  ///< Null: it is gone.
  void (*classdb_register_extension_class2)(void* library, const void* name, const void* parent,
                                            const ClassInfo* info);
  void (*classdb_register_extension_class_method)(void* library, const void* class_name,
                                                  const MethodInfo* info);
  void (*classdb_register_extension_class_signal)(void* library, const void* class_name,
                                                  const void* name, const PropertyInfo* arguments,
                                                  std::int64_t count);
  void (*classdb_unregister_extension_class)(void* library, const void* class_name);
  void (*print_error)(const char* text, const char* function, const char* file, std::int32_t line,
                      std::uint8_t notifies_editor);
};

/// Calls visit(name, pointer to function) for each.
template <class HostType, class Visit>
void for_each_function(HostType& host, const Visit& visit) {
#define SUNDER_GODOT_FUNCTION(name) visit(#name, host.name)
  SUNDER_GODOT_FUNCTION(string_name_new_with_utf8_chars);
  SUNDER_GODOT_FUNCTION(string_new_with_utf8_chars);
  SUNDER_GODOT_FUNCTION(string_to_utf8_chars);
  SUNDER_GODOT_FUNCTION(variant_new_nil);
  SUNDER_GODOT_FUNCTION(variant_new_copy);
  SUNDER_GODOT_FUNCTION(variant_destroy);
  SUNDER_GODOT_FUNCTION(variant_get_type);
  SUNDER_GODOT_FUNCTION(variant_call);
  SUNDER_GODOT_FUNCTION(variant_get_indexed);
  SUNDER_GODOT_FUNCTION(variant_set_indexed);
  SUNDER_GODOT_FUNCTION(get_variant_from_type_constructor);
  SUNDER_GODOT_FUNCTION(get_variant_to_type_constructor);
  SUNDER_GODOT_FUNCTION(variant_get_ptr_constructor);
  SUNDER_GODOT_FUNCTION(variant_get_ptr_destructor);
  SUNDER_GODOT_FUNCTION(packed_int32_array_operator_index);
  SUNDER_GODOT_FUNCTION(packed_float32_array_operator_index);
  SUNDER_GODOT_FUNCTION(packed_vector2_array_operator_index);
  SUNDER_GODOT_FUNCTION(packed_vector3_array_operator_index);
  SUNDER_GODOT_FUNCTION(packed_color_array_operator_index);
  SUNDER_GODOT_FUNCTION(classdb_construct_object);
  SUNDER_GODOT_FUNCTION(object_set_instance);
  SUNDER_GODOT_FUNCTION(object_get_instance_id);
  SUNDER_GODOT_FUNCTION(object_get_instance_from_id);
  SUNDER_GODOT_FUNCTION(classdb_register_extension_class2);
  SUNDER_GODOT_FUNCTION(classdb_register_extension_class_method);
  SUNDER_GODOT_FUNCTION(classdb_register_extension_class_signal);
  SUNDER_GODOT_FUNCTION(classdb_unregister_extension_class);
  SUNDER_GODOT_FUNCTION(print_error);
#undef SUNDER_GODOT_FUNCTION
}

/// Those of the host that loaded this extension, from its initialisation on.
extern Host host;

/// @return the first name that the host does not know; null if it knows all.
[[nodiscard]] const char* load_host(GetProcAddress get_proc_address);

}  // namespace sunder::godot
