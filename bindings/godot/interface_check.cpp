// Compares bindings/godot/interface.h with Godot's own header, where the build is given one.

#include <cstddef>
#include <gdextension_interface.h>
#include <type_traits>

#include "bindings/godot/interface.h"

namespace sunder::godot {
namespace {

template <class T>
constexpr bool kIsNumber = std::is_integral_v<T> || std::is_enum_v<T>;

template <class Ours, class Theirs>
constexpr bool is_alike() {
  if constexpr (std::is_void_v<Ours> || std::is_void_v<Theirs>)
    return std::is_void_v<Ours> && std::is_void_v<Theirs>;
  else
    return sizeof(Ours) == sizeof(Theirs) && std::is_pointer_v<Ours> == std::is_pointer_v<Theirs> &&
           kIsNumber<Ours> == kIsNumber<Theirs>;
}
template <class Ours, class Theirs>
constexpr bool kIsAlike = is_alike<Ours, Theirs>();

/// Whether two pointers to functions can stand for each other: as many parameters, each of the same
/// kind and size.
template <class Ours, class Theirs>
struct IsAlike : std::false_type {};
template <class Returned, class... Parameters, class TheirReturned, class... TheirParameters>
requires(sizeof...(Parameters) ==
         sizeof...(TheirParameters)) struct IsAlike<Returned (*)(Parameters...),
                                                    TheirReturned (*)(TheirParameters...)>
    : std::bool_constant<kIsAlike<Returned, TheirReturned> &&
                         (kIsAlike<Parameters, TheirParameters> && ...)> {
};

#define SUNDER_SAME_FUNCTION(member, Theirs) \
  static_assert(IsAlike<decltype(Host::member), Theirs>::value, #member)
SUNDER_SAME_FUNCTION(string_name_new_with_utf8_chars,
                     GDExtensionInterfaceStringNameNewWithUtf8Chars);
SUNDER_SAME_FUNCTION(string_new_with_utf8_chars, GDExtensionInterfaceStringNewWithUtf8Chars);
SUNDER_SAME_FUNCTION(string_to_utf8_chars, GDExtensionInterfaceStringToUtf8Chars);
SUNDER_SAME_FUNCTION(variant_new_nil, GDExtensionInterfaceVariantNewNil);
SUNDER_SAME_FUNCTION(variant_new_copy, GDExtensionInterfaceVariantNewCopy);
SUNDER_SAME_FUNCTION(variant_destroy, GDExtensionInterfaceVariantDestroy);
SUNDER_SAME_FUNCTION(variant_get_type, GDExtensionInterfaceVariantGetType);
SUNDER_SAME_FUNCTION(variant_call, GDExtensionInterfaceVariantCall);
SUNDER_SAME_FUNCTION(variant_get_indexed, GDExtensionInterfaceVariantGetIndexed);
SUNDER_SAME_FUNCTION(variant_set_indexed, GDExtensionInterfaceVariantSetIndexed);
SUNDER_SAME_FUNCTION(classdb_construct_object, GDExtensionInterfaceClassdbConstructObject);
SUNDER_SAME_FUNCTION(object_set_instance, GDExtensionInterfaceObjectSetInstance);
SUNDER_SAME_FUNCTION(object_get_instance_id, GDExtensionInterfaceObjectGetInstanceId);
SUNDER_SAME_FUNCTION(object_get_instance_from_id, GDExtensionInterfaceObjectGetInstanceFromId);
SUNDER_SAME_FUNCTION(classdb_register_extension_class2,
                     GDExtensionInterfaceClassdbRegisterExtensionClass2);
SUNDER_SAME_FUNCTION(classdb_register_extension_class_method,
                     GDExtensionInterfaceClassdbRegisterExtensionClassMethod);
SUNDER_SAME_FUNCTION(classdb_register_extension_class_signal,
                     GDExtensionInterfaceClassdbRegisterExtensionClassSignal);
SUNDER_SAME_FUNCTION(classdb_unregister_extension_class,
                     GDExtensionInterfaceClassdbUnregisterExtensionClass);
SUNDER_SAME_FUNCTION(print_error, GDExtensionInterfacePrintError);

#define SUNDER_SAME_MEMBER(Ours, member, Theirs, their_member)            \
  static_assert(offsetof(Ours, member) == offsetof(Theirs, their_member), \
                #Theirs "::" #their_member)
static_assert(sizeof(ClassInfo) == sizeof(GDExtensionClassCreationInfo2));
SUNDER_SAME_MEMBER(ClassInfo, is_exposed, GDExtensionClassCreationInfo2, is_exposed);
SUNDER_SAME_MEMBER(ClassInfo, notification, GDExtensionClassCreationInfo2, notification_func);
SUNDER_SAME_MEMBER(ClassInfo, create_instance, GDExtensionClassCreationInfo2, create_instance_func);
SUNDER_SAME_MEMBER(ClassInfo, free_instance, GDExtensionClassCreationInfo2, free_instance_func);
SUNDER_SAME_MEMBER(ClassInfo, class_userdata, GDExtensionClassCreationInfo2, class_userdata);
static_assert(sizeof(MethodInfo) == sizeof(GDExtensionClassMethodInfo));
SUNDER_SAME_MEMBER(MethodInfo, ptrcall, GDExtensionClassMethodInfo, ptrcall_func);
SUNDER_SAME_MEMBER(MethodInfo, return_value, GDExtensionClassMethodInfo, return_value_info);
SUNDER_SAME_MEMBER(MethodInfo, argument_metadata, GDExtensionClassMethodInfo, arguments_metadata);
static_assert(sizeof(PropertyInfo) == sizeof(GDExtensionPropertyInfo));
SUNDER_SAME_MEMBER(PropertyInfo, usage, GDExtensionPropertyInfo, usage);
static_assert(sizeof(CallError) == sizeof(GDExtensionCallError));
static_assert(sizeof(Initialization) == sizeof(GDExtensionInitialization));
SUNDER_SAME_MEMBER(Initialization, deinitialize, GDExtensionInitialization, deinitialize);
static_assert(kSceneLevel == GDEXTENSION_INITIALIZATION_SCENE);

#define SUNDER_SAME_TYPE(ours, Theirs) static_assert(static_cast<int>(Type::ours) == Theirs, #ours)
SUNDER_SAME_TYPE(boolean, GDEXTENSION_VARIANT_TYPE_BOOL);
SUNDER_SAME_TYPE(integer, GDEXTENSION_VARIANT_TYPE_INT);
SUNDER_SAME_TYPE(real, GDEXTENSION_VARIANT_TYPE_FLOAT);
SUNDER_SAME_TYPE(string, GDEXTENSION_VARIANT_TYPE_STRING);
SUNDER_SAME_TYPE(vector3, GDEXTENSION_VARIANT_TYPE_VECTOR3);
SUNDER_SAME_TYPE(transform, GDEXTENSION_VARIANT_TYPE_TRANSFORM3D);
SUNDER_SAME_TYPE(string_name, GDEXTENSION_VARIANT_TYPE_STRING_NAME);
SUNDER_SAME_TYPE(object, GDEXTENSION_VARIANT_TYPE_OBJECT);
SUNDER_SAME_TYPE(dictionary, GDEXTENSION_VARIANT_TYPE_DICTIONARY);
SUNDER_SAME_TYPE(array, GDEXTENSION_VARIANT_TYPE_ARRAY);
SUNDER_SAME_TYPE(packed_int32, GDEXTENSION_VARIANT_TYPE_PACKED_INT32_ARRAY);
SUNDER_SAME_TYPE(packed_float32, GDEXTENSION_VARIANT_TYPE_PACKED_FLOAT32_ARRAY);
SUNDER_SAME_TYPE(packed_vector2, GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR2_ARRAY);
SUNDER_SAME_TYPE(packed_vector3, GDEXTENSION_VARIANT_TYPE_PACKED_VECTOR3_ARRAY);
SUNDER_SAME_TYPE(packed_color, GDEXTENSION_VARIANT_TYPE_PACKED_COLOR_ARRAY);

}  // namespace
}  // namespace sunder::godot
