#include "io/fbx/scene.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sunder::fbx {
namespace {

constexpr int kMaximumModelDepth = 1024;
constexpr std::uint32_t kMostModels = 1'000'000;

struct Link {
  std::int64_t source = 0;
  std::string property;
};

/// The property that a curve node drives.
struct Target {
  std::int64_t model_id = 0;
  Animated animated = Animated::translation;
};

/// The part of a name before the class, as binary files join them; text files put the class first.
std::string plain_name(const std::string& stored) {
  if (const std::size_t end = stored.find('\0'); end != std::string::npos)
    return stored.substr(0, end);
  const std::size_t colons = stored.find("::");
  return colons == std::string::npos ? stored : stored.substr(colons + 2);
}

/// The properties of an object, with those of its class's template behind them.
class Properties {
 public:
  Properties(const Record& object, const Record* defaults)
      : own_(object.child("Properties70")), defaults_(defaults) {}

  [[nodiscard]] const Record* find(std::string_view name) const {
    for (const Record* const list : {own_, defaults_}) {
      if (list == nullptr) continue;
      for (const Record& one : list->children)
        if (one.values.size() > 4 && one.values.front().text == name) return &one;
    }
    return nullptr;
  }
  [[nodiscard]] double number(std::string_view name, double otherwise) const {
    const Record* const found = find(name);
    const double value = found != nullptr ? found->values[4].number() : otherwise;
    return std::isfinite(value) ? value : otherwise;
  }
  [[nodiscard]] Vec3d vector(std::string_view name, const Vec3d& otherwise) const {
    const Record* const found = find(name);
    if (found == nullptr || found->values.size() < 7) return otherwise;
    const Vec3d value(found->values[4].number(), found->values[5].number(),
                      found->values[6].number());
    return value.allFinite() ? value : otherwise;
  }

 private:
  const Record* own_;
  const Record* defaults_;
};

Stack read_stack(const Properties& of) {
  Stack stack;
  const Vec3d zero = Vec3d::Zero();
  stack.translation = of.vector("Lcl Translation", zero);
  stack.rotation = of.vector("Lcl Rotation", zero);
  stack.scaling = of.vector("Lcl Scaling", Vec3d::Ones());
  stack.pre_rotation = of.vector("PreRotation", zero);
  stack.post_rotation = of.vector("PostRotation", zero);
  stack.rotation_offset = of.vector("RotationOffset", zero);
  stack.rotation_pivot = of.vector("RotationPivot", zero);
  stack.scaling_offset = of.vector("ScalingOffset", zero);
  stack.scaling_pivot = of.vector("ScalingPivot", zero);
  stack.rotation_order = static_cast<int>(std::clamp(of.number("RotationOrder", 0.0), 0.0, 6.0));
  if (stack.rotation_order == 6) stack.rotation_order = 0;  // Its angles are those of xyz.
  const double inherit = of.number("InheritType", 0.0);
  stack.inherit = inherit == 1.0   ? Inherit::all
                  : inherit == 2.0 ? Inherit::no_scale
                                   : Inherit::scale_by_axes;
  return stack;
}

class SceneReader {
 public:
  explicit SceneReader(const Record& document) {
    if (const Record* const objects = document.child("Objects"))
      for (const Record& one : objects->children)
        if (!one.values.empty()) objects_[one.values.front().integer] = &one;
    if (const Record* const connections = document.child("Connections"))
      for (const Record& one : connections->children)
        if (one.values.size() >= 3)
          into_[one.values[2].integer].push_back(
              {one.values[1].integer, one.values.size() > 3 ? one.values[3].text : ""});
    if (const Record* const definitions = document.child("Definitions"))
      for (const Record& type : definitions->children)
        if (!type.values.empty())
          if (const Record* const one = type.child("PropertyTemplate"))
            templates_.emplace(type.values.front().text, one->child("Properties70"));
    if (const Record* const objects = document.child("Objects")) read(*objects);
  }

  Scene take() { return std::move(scene_); }

 private:
  [[nodiscard]] const Record* object(std::int64_t id, std::string_view name) const {
    const auto found = objects_.find(id);
    return found != objects_.end() && found->second->name == name ? found->second : nullptr;
  }
  [[nodiscard]] const std::vector<Link>& links_to(std::int64_t id) const {
    static const std::vector<Link> none;
    const auto found = into_.find(id);
    return found == into_.end() ? none : found->second;
  }
  [[nodiscard]] Properties properties_of(const Record& one) const {
    const auto found = templates_.find(one.name);
    return {one, found == templates_.end() ? nullptr : found->second};
  }

  void read(const Record& objects) {
    add_models(0, kNone, 1);
    for (const Record& one : objects.children)
      if (one.name == "AnimationStack" && !one.values.empty()) add_take(one);
  }

  void add_models(std::int64_t parent_id, std::uint32_t parent, int depth) {
    if (depth > kMaximumModelDepth) throw std::runtime_error("FBX models nested too deep");
    for (const Link& link : links_to(parent_id)) {
      const Record* const record = object(link.source, "Model");
      if (record == nullptr || !link.property.empty()) continue;
      const auto index = static_cast<std::uint32_t>(scene_.models.size());
      if (index >= kMostModels) throw std::runtime_error("too many FBX models");
      models_of_id_[link.source].push_back(index);  // Several if it has several parents.
      Model model;
      model.name = record->values.size() > 1 ? plain_name(record->values[1].text) : "";
      model.rest = read_stack(properties_of(*record));
      model.parent = parent;
      scene_.models.push_back(std::move(model));
      (parent == kNone ? scene_.roots : scene_.models[parent].children).push_back(index);
      add_models(link.source, index, depth + 1);
    }
  }

  void add_take(const Record& record) {
    Take take;
    take.name = record.values.size() > 1 ? plain_name(record.values[1].text) : "";
    const Properties properties = properties_of(record);
    take.start = properties.number("LocalStart", 0.0);
    take.stop = properties.number("LocalStop", 0.0);
    for (const Link& link : links_to(record.values.front().integer)) {
      const Record* const layer = object(link.source, "AnimationLayer");
      if (layer != nullptr) add_layer(*layer, take);
    }
    scene_.takes.push_back(std::move(take));
  }

  void add_layer(const Record& record, Take& take) {
    const Properties properties = properties_of(record);
    Layer layer;
    layer.weight = std::clamp(properties.number("Weight", 100.0) / 100.0, 0.0, 1.0);
    // 0 adds, 1 replaces, 2 replaces where the layer has curves, which is all that a layer can do
    // here.
    layer.replaces = properties.number("BlendMode", 0.0) != 0.0;
    layer.adds_angles = properties.number("RotationAccumulationMode", 0.0) != 0.0;
    layer.adds_scales = properties.number("ScaleAccumulationMode", 0.0) != 0.0;
    const bool is_mute = properties.number("Mute", 0.0) != 0.0;
    for (const Link& link : links_to(record.values.front().integer))
      if (const Record* const node = object(link.source, "AnimationCurveNode"); node && !is_mute)
        add_curve_node(*node, link.source, layer);
    take.layers.push_back(std::move(layer));
  }

  void add_curve_node(const Record& record, std::int64_t id, Layer& layer) {
    if (targets_.empty()) find_targets();
    const auto target = targets_.find(id);
    if (target == targets_.end()) return;
    CurveNode node;
    node.animated = target->second.animated;
    const Properties properties = properties_of(record);
    constexpr std::array kNames = {"d|X", "d|Y", "d|Z"};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (properties.find(kNames[axis]) != nullptr)
        node.constants[axis] = properties.number(kNames[axis], 0.0);
    for (const Link& link : links_to(id)) {
      const Record* const curve = object(link.source, "AnimationCurve");
      const auto axis = std::find(kNames.begin(), kNames.end(), link.property) - kNames.begin();
      if (curve == nullptr || axis == 3) continue;
      Curve read(*curve);
      if (!read.is_empty()) node.curves[static_cast<std::size_t>(axis)] = std::move(read);
    }
    const bool has_curve = std::any_of(node.curves.begin(), node.curves.end(),
                                       [](const auto& curve) { return curve.has_value(); });
    if (!has_curve) return;
    for (const std::uint32_t model : models_of_id_.at(target->second.model_id)) {
      node.model = model;
      layer.nodes.push_back(node);
    }
  }

  void find_targets() {
    const std::map<std::string, Animated> kProperties = {{"Lcl Translation", Animated::translation},
                                                         {"Lcl Rotation", Animated::rotation},
                                                         {"Lcl Scaling", Animated::scaling}};
    for (const auto& [id, unused] : models_of_id_)
      for (const Link& link : links_to(id))
        if (const auto found = kProperties.find(link.property); found != kProperties.end())
          targets_.emplace(link.source, Target{id, found->second});
  }

  std::unordered_map<std::int64_t, const Record*> objects_;
  std::unordered_map<std::int64_t, std::vector<Link>> into_;  ///< By target, in the file's order.
  std::map<std::string, const Record*, std::less<>> templates_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> models_of_id_;
  std::unordered_map<std::int64_t, Target> targets_;  ///< Of curve nodes.
  Scene scene_;
};

}  // namespace

Scene read_scene(const Record& document) { return SceneReader(document).take(); }

}  // namespace sunder::fbx
