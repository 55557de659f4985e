#include "godot/mock_host.h"

#include <algorithm>
#include <cstring>

namespace sunder::godot_test {

Host host;

namespace {

std::string unknown_name;

// What stands in the memory of a variant, a string and an array is a pointer to ours.
template <class T>
T*& at(void* memory) {
  return *static_cast<T**>(memory);
}
template <class T>
T& in(const void* memory) {
  return **static_cast<T* const*>(memory);
}

void put_variant(void* memory, Value value) {
  at<Value>(memory) = new Value(std::move(value));
  ++host.living_variants;
}

void new_string(void* memory, const char* text) {
  at<std::string>(memory) = new std::string(text);
  ++host.living_strings;
}
void free_string(void* memory) {
  delete at<std::string>(memory);
  at<std::string>(memory) = nullptr;
  --host.living_strings;
}
std::int64_t string_to_utf8(const void* memory, char* text, std::int64_t most) {
  const auto& value = in<std::string>(memory);
  if (text != nullptr)
    std::memcpy(text, value.data(),
                std::min<std::size_t>(value.size(), static_cast<std::size_t>(most)));
  return static_cast<std::int64_t>(value.size());
}

void variant_nil(void* memory) { put_variant(memory, nil()); }
void variant_copy(void* memory, const void* source) { put_variant(memory, in<Value>(source)); }
void variant_free(void* memory) {
  delete at<Value>(memory);
  at<Value>(memory) = nullptr;
  --host.living_variants;
}
Type variant_type(const void* memory) { return in<Value>(memory).type; }

using PackedHandle = std::shared_ptr<Packed>;
using PackedPointer = std::shared_ptr<PackedReference>;

/// Methods of arrays.
std::unique_ptr<Value> call_array(Value& self, const std::string& method, const Arguments& list) {
  if (auto* const packed = std::get_if<PackedPointer>(&self.data)) {
    std::vector<std::byte>& bytes = (*packed)->data->bytes;
    const std::size_t size = element_size(self.type);
    if (method == "size")
      return std::make_unique<Value>(of(static_cast<std::int64_t>(bytes.size() / size)));
    if (method != "resize") return nullptr;
    (*packed)->data = std::make_shared<Packed>(*(*packed)->data);
    (*packed)->data->bytes.resize(static_cast<std::size_t>(std::get<std::int64_t>(list[0].data)) *
                                  size);
    return std::make_unique<Value>();
  }
  if (auto* const array = std::get_if<List>(&self.data); array != nullptr && method == "resize") {
    (*array)->resize(static_cast<std::size_t>(std::get<std::int64_t>(list[0].data)));
    return std::make_unique<Value>();
  }
  return nullptr;
}

void variant_call(void* memory, const void* method, const void* const* arguments,
                  std::int64_t count, void* returned, godot::CallError* error) {
  auto& self = in<Value>(memory);
  Arguments list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(in<Value>(arguments[i]));
  std::unique_ptr<Value> result;
  if (const auto* const object = std::get_if<Reference>(&self.data)) {
    if (object->is_stale())
      host.errors.push_back("a freed object is called: " + in<std::string>(method));
    else if (object->get() != nullptr)
      result = object->get()->call(in<std::string>(method), list);
  } else {
    result = call_array(self, in<std::string>(method), list);
  }
  error->error = result == nullptr ? 1 : 0;
  if (result == nullptr) host.errors.push_back("no method " + in<std::string>(method));
  put_variant(returned, result == nullptr ? nil() : *result);
}

void get_indexed(const void* memory, std::int64_t index, void* value, std::uint8_t* is_valid,
                 std::uint8_t* is_out_of_range) {
  const auto* const array = std::get_if<List>(&in<Value>(memory).data);
  *is_valid = array != nullptr;
  *is_out_of_range =
      array == nullptr || index < 0 || static_cast<std::size_t>(index) >= (*array)->size();
  put_variant(value, *is_out_of_range ? nil() : (**array)[static_cast<std::size_t>(index)]);
}

void set_indexed(void* memory, std::int64_t index, const void* value, std::uint8_t* is_valid,
                 std::uint8_t* is_out_of_range) {
  auto* const array = std::get_if<List>(&in<Value>(memory).data);
  *is_valid = array != nullptr;
  *is_out_of_range =
      array == nullptr || index < 0 || static_cast<std::size_t>(index) >= (*array)->size();
  if (!*is_out_of_range) (**array)[static_cast<std::size_t>(index)] = in<Value>(value);
}

// ---- Conversions.

template <Type type>
void from_type(void* memory, void* value) {
  Value result = nil();
  if constexpr (type == Type::boolean) result = of(*static_cast<const std::uint8_t*>(value) != 0);
  if constexpr (type == Type::integer) result = of(*static_cast<const std::int64_t*>(value));
  if constexpr (type == Type::real) result = of(*static_cast<const double*>(value));
  if constexpr (type == Type::string) result = of(in<std::string>(value));
  if constexpr (type == Type::vector3) result = of(*static_cast<const Vector*>(value));
  if constexpr (type == Type::transform) result = of(*static_cast<const Matrix*>(value));
  if constexpr (type == Type::object) result = of(*static_cast<Object* const*>(value));
  if constexpr (type == Type::array || type == Type::dictionary) result = {type, in<List>(value)};
  if constexpr (type >= Type::packed_int32) {
    auto reference = std::make_shared<PackedReference>();
    reference->data = in<PackedHandle>(value);
    result = {type, reference};
  }
  put_variant(memory, std::move(result));
}

template <Type type>
void to_type(void* value, void* memory) {
  const auto& from = in<Value>(memory);
  if constexpr (type == Type::boolean)
    *static_cast<std::uint8_t*>(value) = std::get<bool>(from.data);
  if constexpr (type == Type::integer)
    *static_cast<std::int64_t*>(value) = std::get<std::int64_t>(from.data);
  if constexpr (type == Type::real) *static_cast<double*>(value) = std::get<double>(from.data);
  if constexpr (type == Type::string) new_string(value, std::get<std::string>(from.data).c_str());
  if constexpr (type == Type::vector3) *static_cast<Vector*>(value) = std::get<Vector>(from.data);
  if constexpr (type == Type::transform) *static_cast<Matrix*>(value) = std::get<Matrix>(from.data);
  if constexpr (type == Type::object)
    *static_cast<Object**>(value) = std::get<Reference>(from.data).get();
  if constexpr (type >= Type::packed_int32) {
    at<PackedHandle>(value) = new PackedHandle(std::get<PackedPointer>(from.data)->data);
    ++host.living_arrays;
  }
}

template <Type type>
void construct(void* value, const void* const*) {
  if constexpr (type >= Type::packed_int32)
    at<PackedHandle>(value) = new PackedHandle(std::make_shared<Packed>());
  else
    at<List>(value) = new List(std::make_shared<std::vector<Value>>());
  ++host.living_arrays;
}

template <Type type>
void destroy(void* value) {
  if constexpr (type >= Type::packed_int32)
    delete at<PackedHandle>(value);
  else
    delete at<List>(value);
  --host.living_arrays;
}

/// Calls a template for the type that is asked for; null for others.
template <class Function>
Function* pick(Type type, std::initializer_list<std::pair<Type, Function*>> all) {
  for (const auto& [of, function] : all)
    if (of == type) return function;
  return nullptr;
}

#define SUNDER_TEST_ARRAYS(function)                                                    \
  {Type::array, function<Type::array>}, {Type::dictionary, function<Type::dictionary>}, \
      {Type::packed_int32, function<Type::packed_int32>},                               \
      {Type::packed_float32, function<Type::packed_float32>},                           \
      {Type::packed_vector2, function<Type::packed_vector2>},                           \
      {Type::packed_vector3, function<Type::packed_vector3>}, {                         \
    Type::packed_color, function<Type::packed_color>                                    \
  }
#define SUNDER_TEST_PLAIN(function)                                                             \
  {Type::boolean, function<Type::boolean>}, {Type::integer, function<Type::integer>},           \
      {Type::real, function<Type::real>}, {Type::string, function<Type::string>},               \
      {Type::vector3, function<Type::vector3>}, {Type::transform, function<Type::transform>}, { \
    Type::object, function<Type::object>                                                        \
  }

godot::FromType from_constructor(Type type) {
  return pick<void(void*, void*)>(type,
                                  {SUNDER_TEST_PLAIN(from_type), SUNDER_TEST_ARRAYS(from_type)});
}
godot::ToType to_constructor(Type type) {
  return pick<void(void*, void*)>(type, {SUNDER_TEST_PLAIN(to_type), SUNDER_TEST_ARRAYS(to_type)});
}
auto ptr_constructor(Type type, std::int32_t) {
  return pick<void(void*, const void* const*)>(type, {SUNDER_TEST_ARRAYS(construct)});
}
auto ptr_destructor(Type type) {
  return pick<void(void*)>(
      type,
      {{Type::string, free_string}, {Type::string_name, free_string}, SUNDER_TEST_ARRAYS(destroy)});
}

void* element(void* array, std::int64_t index, std::size_t size) {
  auto& handle = in<PackedHandle>(array);
  if (handle.use_count() > 1)
    handle = std::make_shared<Packed>(*handle);  // it is about to be written
  if (static_cast<std::size_t>(index) * size >= handle->bytes.size()) return nullptr;
  return handle->bytes.data() + static_cast<std::size_t>(index) * size;
}
std::int32_t* int32_element(void* array, std::int64_t index) {
  return static_cast<std::int32_t*>(element(array, index, 4));
}
float* float_element(void* array, std::int64_t index) {
  return static_cast<float*>(element(array, index, 4));
}
void* vector2_element(void* array, std::int64_t index) { return element(array, index, 8); }
void* vector3_element(void* array, std::int64_t index) { return element(array, index, 12); }
void* color_element(void* array, std::int64_t index) { return element(array, index, 16); }

// ---- Classes.

/// A node of a class of the extension.
void* construct_object(const void* name) { return host.construct(in<std::string>(name)); }

void set_instance(void* object, const void*, void* instance) {
  static_cast<Object*>(object)->instance = instance;
}

std::uint64_t instance_id(const void* object) { return static_cast<const Object*>(object)->id; }
void* instance_from_id(std::uint64_t id) {
  const auto found = Object::living.find(id);
  return found == Object::living.end() ? nullptr : found->second;
}

void register_class(void*, const void* name, const void* parent, const godot::ClassInfo* info) {
  RegisteredClass& of = host.classes[in<std::string>(name)];
  of.parent = in<std::string>(parent);
  of.info = *info;
}
void register_method(void*, const void* class_name, const godot::MethodInfo* info) {
  RegisteredClass& of = host.classes[in<std::string>(class_name)];
  const std::string& name = in<std::string>(info->name);
  of.methods[name] = *info;
  for (std::uint32_t i = 0; i < info->argument_count; ++i)
    of.argument_types[name].push_back(info->arguments[i].type);
}
void register_signal(void*, const void* class_name, const void* name, const godot::PropertyInfo*,
                     std::int64_t count) {
  host.classes[in<std::string>(class_name)].signals[in<std::string>(name)] =
      static_cast<std::size_t>(count);
}
void unregister_class(void*, const void* name) { host.classes.erase(in<std::string>(name)); }
void print_error(const char* text, const char*, const char*, std::int32_t, std::uint8_t) {
  host.errors.emplace_back(text);
}

godot::AnyFunction find(const char* name) {
  if (name == unknown_name) return nullptr;
  static const godot::Host functions = {
      new_string,       new_string,       string_to_utf8,   variant_nil,    variant_copy,
      variant_free,     variant_type,     variant_call,     get_indexed,    set_indexed,
      from_constructor, to_constructor,   ptr_constructor,  ptr_destructor, int32_element,
      float_element,    vector2_element,  vector3_element,  color_element,  construct_object,
      set_instance,     instance_id,      instance_from_id, register_class, register_method,
      register_signal,  unregister_class, print_error};
  godot::AnyFunction found = nullptr;
  godot::for_each_function(functions, [&](const char* known, auto function) {
    if (std::strcmp(known, name) == 0) found = reinterpret_cast<godot::AnyFunction>(function);
  });
  return found;
}

}  // namespace

// ---- Objects.

Reference::Reference(Object* object)
    : Reference(object, object == nullptr ? 0 : object->id,
                object != nullptr && object->counts_references) {}
Reference::Reference(Object* object, std::uint64_t id, bool counts)
    : object_(object), id_(id), counts_(counts) {
  if (counts_) ++object_->references;
}
Reference::Reference(const Reference& other) : Reference(other.object_, other.id_, other.counts_) {}
Reference& Reference::operator=(const Reference& other) {
  Reference kept(other);
  std::swap(object_, kept.object_);
  std::swap(id_, kept.id_);
  std::swap(counts_, kept.counts_);
  return *this;
}
Reference::~Reference() {
  if (counts_ && --object_->references == 0) delete object_;
}
bool Reference::is_stale() const { return object_ != nullptr && !Object::living.contains(id_); }

Value nil() { return {}; }
Value of(std::int64_t number) { return {Type::integer, number}; }
Value of(double number) { return {Type::real, number}; }
Value of(bool is) { return {Type::boolean, is}; }
Value of(const std::string& text) { return {Type::string, text}; }
Value of(const Vector& vector) { return {Type::vector3, vector}; }
Value of(const Matrix& matrix) { return {Type::transform, matrix}; }
Value of(Object* object) { return {Type::object, Reference(object)}; }
Value list(std::size_t count) { return {Type::array, std::make_shared<std::vector<Value>>(count)}; }

std::size_t element_size(Type packed) {
  switch (packed) {
    case Type::packed_vector2: return 8;
    case Type::packed_vector3: return 12;
    case Type::packed_color: return 16;
    default: return 4;
  }
}

godot::GetProcAddress get_proc_address(const std::string& without) {
  unknown_name = without;
  return find;
}

Value call_method(const std::string& class_name, void* instance, const std::string& method,
                  const Arguments& arguments, godot::CallError* error) {
  const godot::MethodInfo& info = host.classes.at(class_name).methods.at(method);
  std::vector<std::array<std::byte, 24>> variants(arguments.size());
  std::vector<const void*> pointers;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    put_variant(&variants[i], arguments[i]);
    pointers.push_back(&variants[i]);
  }
  std::array<std::byte, 24> returned;
  put_variant(&returned, nil());
  godot::CallError none = {};
  info.call(info.method_userdata, instance, pointers.data(),
            static_cast<std::int64_t>(arguments.size()), &returned,
            error != nullptr ? error : &none);
  Value result = in<Value>(&returned);
  variant_free(&returned);
  for (auto& variant : variants) variant_free(&variant);
  return result;
}

Value ptrcall_method(const std::string& class_name, void* instance, const std::string& method,
                     const Arguments& arguments, Type returned) {
  const godot::MethodInfo& info = host.classes.at(class_name).methods.at(method);
  std::vector<std::array<std::byte, 64>> values(arguments.size());
  std::vector<const void*> pointers;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    std::array<std::byte, 24> variant;
    put_variant(&variant, arguments[i]);
    to_constructor(arguments[i].type)(&values[i], &variant);
    variant_free(&variant);
    pointers.push_back(&values[i]);
  }
  alignas(8) std::array<std::byte, 64> result = {};
  if (returned == Type::string) new_string(&result, "what stood there");
  info.ptrcall(info.method_userdata, instance, pointers.data(), &result);
  std::array<std::byte, 24> variant;
  from_constructor(returned)(&variant, &result);
  Value value = in<Value>(&variant);
  variant_free(&variant);
  if (returned == Type::string) free_string(&result);
  for (std::size_t i = 0; i < arguments.size(); ++i)
    if (const auto free = ptr_destructor(arguments[i].type); free != nullptr) free(&values[i]);
  return value;
}

}  // namespace sunder::godot_test
