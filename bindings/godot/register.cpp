// The entry of the extension: registers TearableSkeleton3D with the host.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings/godot/tearable_skeleton.h"

#if defined(_WIN32)
#define SUNDER_GODOT_EXPORT __declspec(dllexport)
#else
#define SUNDER_GODOT_EXPORT [[gnu::visibility("default")]]
#endif

namespace sunder::godot {
namespace {

void* library = nullptr;

void* create_instance(void*) {
  const Name parent(TearableSkeleton::kParent), name(TearableSkeleton::kName);
  void* const object = host.classdb_construct_object(parent.get());
  host.object_set_instance(object, name.get(), new TearableSkeleton(object));
  return object;
}

void free_instance(void*, void* instance) { delete static_cast<TearableSkeleton*>(instance); }

void notify(void* instance, std::int32_t what, std::uint8_t) {
  static_cast<TearableSkeleton*>(instance)->notify(what);
}

/// A method: its arguments arrive as variants, in either way of calling.
using Arguments = std::vector<Variant>;
struct Method {
  const char* name;
  std::vector<std::pair<const char*, Type>> arguments;
  Type returned;
  Variant (*call)(TearableSkeleton& node, const Arguments& arguments);
};

/// Those of tears over several frames.
std::vector<Method> methods_of_strokes() {
  return {{"begin_stroke",
           {{"base", Type::vector3},
            {"tip", Type::vector3},
            {"width", Type::real},
            {"wall_depth", Type::real}},
           Type::boolean,
           [](TearableSkeleton& node, const Arguments& a) {
             return Variant(
                 node.begin_stroke(a[0].vector3(), a[1].vector3(), a[2].real(), a[3].real()));
           }},
          {"extend_stroke",
           {{"base", Type::vector3}, {"tip", Type::vector3}, {"seconds", Type::real}},
           Type::boolean,
           [](TearableSkeleton& node, const Arguments& a) {
             return Variant(node.extend_stroke(a[0].vector3(), a[1].vector3(), a[2].real()));
           }},
          {"end_stroke", {}, Type::boolean, [](TearableSkeleton& node, const Arguments&) {
             return Variant(node.end_stroke());
           }}};
}

/// The methods of the node, in the memory that the host refers to.
const std::vector<Method>& methods() {
  static const std::vector<Method> all = [] {
    std::vector<Method> list = {
        {"attach",
         {{"mesh_instance", Type::object}},
         Type::boolean,
         [](TearableSkeleton& node, const Arguments& a) { return Variant(node.attach(a[0])); }},
        {"tear",
         {{"bases", Type::packed_vector3},
          {"tips", Type::packed_vector3},
          {"width", Type::real},
          {"wall_depth", Type::real}},
         Type::boolean,
         [](TearableSkeleton& node, const Arguments& a) {
           return Variant(node.tear(a[0], a[1], a[2].real(), a[3].real()));
         }},
        {"cut",
         {{"point", Type::vector3}, {"normal", Type::vector3}, {"caps", Type::boolean}},
         Type::boolean,
         [](TearableSkeleton& node, const Arguments& a) {
           return Variant(node.cut(a[0].vector3(), a[1].vector3(), a[2].boolean()));
         }},
        {"undo",
         {},
         Type::boolean,
         [](TearableSkeleton& node, const Arguments&) { return Variant(node.undo()); }},
        {"set_wound_material",
         {{"material", Type::object}},
         Type::nil,
         [](TearableSkeleton& node, const Arguments& a) {
           node.set_wound_material(a[0]);
           return Variant();
         }},
        {"get_log",
         {},
         Type::string,
         [](TearableSkeleton& node, const Arguments&) { return Variant(node.get_log().c_str()); }},
        {"get_error", {}, Type::string, [](TearableSkeleton& node, const Arguments&) {
           return Variant(node.get_error().c_str());
         }}};
    const std::vector<Method> strokes = methods_of_strokes();
    list.insert(list.end(), strokes.begin(), strokes.end());
    return list;
  }();
  return all;
}

void call(void* userdata, void* instance, const void* const* arguments, std::int64_t count,
          void* returned, CallError* error) {
  constexpr std::int32_t kTooMany = 3, kTooFew = 4;
  const Method& method = *static_cast<const Method*>(userdata);
  const auto wanted = static_cast<std::int64_t>(method.arguments.size());
  if (count != wanted) {
    *error = {count > wanted ? kTooMany : kTooFew, static_cast<std::int32_t>(wanted),
              static_cast<std::int32_t>(wanted)};
    return;
  }
  Arguments list;
  for (std::int64_t i = 0; i < count; ++i) list.push_back(Variant::copy(arguments[i]));
  const Variant result = method.call(*static_cast<TearableSkeleton*>(instance), list);
  host.variant_destroy(returned);
  host.variant_new_copy(returned, result.get());
  *error = {};
}

void ptrcall(void* userdata, void* instance, const void* const* arguments, void* returned) {
  const Method& method = *static_cast<const Method*>(userdata);
  Arguments list;
  for (std::size_t i = 0; i < method.arguments.size(); ++i)
    list.push_back(Variant::from(method.arguments[i].second, arguments[i]));
  const Variant result = method.call(*static_cast<TearableSkeleton*>(instance), list);
  if (method.returned != Type::nil) result.assign_to(method.returned, returned);
}

/// Names and types of arguments, in the memory of the host while it reads them.
class Properties {
 public:
  explicit Properties(const std::vector<std::pair<const char*, Type>>& list) : none_("") {
    host.string_new_with_utf8_chars(&no_hint_, "");
    names_.reserve(list.size());
    constexpr std::uint32_t kDefaultUsage = 6;  // stored, and shown in the editor
    for (const auto& [name, type] : list) {
      names_.push_back(std::make_unique<Name>(name));
      infos_.push_back({type, names_.back()->get(), none_.get(), 0, &no_hint_, kDefaultUsage});
    }
    metadata_.assign(list.size(), 0);
  }
  ~Properties() { host.variant_get_ptr_destructor(Type::string)(&no_hint_); }
  Properties(const Properties&) = delete;
  Properties& operator=(const Properties&) = delete;

  [[nodiscard]] PropertyInfo* infos() { return infos_.data(); }
  [[nodiscard]] std::int32_t* metadata() { return metadata_.data(); }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(infos_.size()); }

 private:
  Name none_;
  Opaque<8> no_hint_;
  std::vector<std::unique_ptr<Name>> names_;
  std::vector<PropertyInfo> infos_;
  std::vector<std::int32_t> metadata_;
};

void register_method(const Name& class_name, const Method& method) {
  Name name(method.name);
  Properties arguments(method.arguments), returned({{"", method.returned}});
  MethodInfo info = {};
  info.name = name.get();
  info.method_userdata = const_cast<Method*>(&method);
  info.call = call;
  info.ptrcall = ptrcall;
  info.flags = 1;  // a plain method
  info.has_return_value = method.returned != Type::nil ? 1 : 0;
  info.return_value = returned.infos();
  info.argument_count = arguments.count();
  info.arguments = arguments.infos();
  info.argument_metadata = arguments.metadata();
  host.classdb_register_extension_class_method(library, class_name.get(), &info);
}

void initialize(void*, std::int32_t level) {
  if (level != kSceneLevel) return;
  const Name name(TearableSkeleton::kName), parent(TearableSkeleton::kParent);
  ClassInfo info = {};
  info.is_exposed = 1;
  info.notification = notify;
  info.create_instance = create_instance;
  info.free_instance = free_instance;
  host.classdb_register_extension_class2(library, name.get(), parent.get(), &info);
  for (const Method& method : methods()) register_method(name, method);
  const std::vector<std::pair<const char*, std::vector<std::pair<const char*, Type>>>> signals = {
      {"torn", {{"faces_crossed", Type::integer}, {"length", Type::real}}},
      {"failed", {{"text", Type::string}}}};
  for (const auto& [signal, list] : signals) {
    const Name signal_name(signal);
    Properties arguments(list);
    host.classdb_register_extension_class_signal(library, name.get(), signal_name.get(),
                                                 arguments.infos(), arguments.count());
  }
}

void deinitialize(void*, std::int32_t level) {
  if (level != kSceneLevel) return;
  const Name name(TearableSkeleton::kName);
  host.classdb_unregister_extension_class(library, name.get());
}

}  // namespace
}  // namespace sunder::godot

extern "C" SUNDER_GODOT_EXPORT std::uint8_t sunder_godot_init(
    sunder::godot::GetProcAddress get_proc_address, void* library,
    sunder::godot::Initialization* initialization) {
  using namespace sunder::godot;
  if (const char* const missing = load_host(get_proc_address); missing != nullptr) {
    const std::string text =
        std::string("Sunder needs Godot 4.2 or later: there is no function ") + missing;
    if (host.print_error != nullptr)
      host.print_error(text.c_str(), "sunder_godot_init", "register.cpp", 0, 0);
    return 0;
  }
  sunder::godot::library = library;
  *initialization = {kSceneLevel, nullptr, initialize, deinitialize};
  return 1;
}
