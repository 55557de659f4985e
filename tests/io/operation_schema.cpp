#include "io/operation_schema.h"

#include "core/operation/internal/view_sides.h"
#include "io/described_fields.h"

namespace sunder::test {
namespace {

using operation_log::default_json;
using operation_log::Json;
using operation_log::numbers_json;

Json ref(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

Json number_schema(const NumberRange& range) {
  Json schema = {{"type", "number"},
                 {range.is_above_least ? "exclusiveMinimum" : "minimum", range.least},
                 {"maximum", range.most}};
  if (range.or_else == nullptr) return schema;
  return {{"oneOf", {{{"const", 0}}, std::move(schema)}}};
}

Json numbers_schema(const NumberRange& range, int count) {
  return {
      {"type", "array"}, {"items", number_schema(range)}, {"minItems", count}, {"maxItems", count}};
}

Json integer_schema(std::uint32_t least, std::uint32_t most) {
  return {{"type", "integer"}, {"minimum", least}, {"maximum", most}};
}

Json words_schema(const auto& words) { return {{"enum", words}}; }

constexpr NumberRange kAny = {.field = "", .least = -1e9, .most = 1e9};
constexpr NumberRange kMatrixEntry = {.field = "", .least = -1e30, .most = 1e30};

template <Described T>
Json object_schema(const char* op = nullptr);

// schema_of(member, kind): what a log may have for a field.

Json schema_of(double, const NumberRange& range) { return number_schema(range); }
Json schema_of(double, const Degrees& kind) { return number_schema(kind.range); }
Json schema_of(double, const ChordTolerance&) { return number_schema(field::length_from_zero()); }
template <class Widths>
Json schema_of(double, const TearLength<Widths>& kind) {
  return std::is_const_v<Widths> ? number_schema(kind.range) : ref("length_or_widths");
}
Json schema_of(const AimedLength&, const NumberRange&) { return ref("aimed_length"); }
Json schema_of(bool) { return {{"type", "boolean"}}; }
template <class Enum>
requires std::is_enum_v<Enum> Json schema_of(Enum) { return words_schema(kNames<Enum>); }
Json schema_of(std::uint32_t, const Integer& kind) { return integer_schema(kind.least, kind.most); }
Json schema_of(std::uint32_t, const Material&) { return ref("name_or_index"); }
template <class... Kinds>
Json schema_of(const std::variant<Kinds...>&, const Name&) {
  return ref("name_or_index");
}
Json schema_of(const std::string&, const Name& kind) {
  Json schema = {{"type", "string"}};
  if (!kind.may_be_empty) schema["minLength"] = 1;
  return schema;
}
Json schema_of(const Vec3d&, const Point&) { return ref("point"); }
Json schema_of(const Vec3d&, const Direction&) { return ref("point"); }
Json schema_of(const Vec3f&) { return numbers_schema(kAny, 3); }
Json schema_of(const Quatf&) { return numbers_schema(kAny, 4); }
Json schema_of(const Affine3d&) { return numbers_schema(kMatrixEntry, 12); }
Json schema_of(float) { return number_schema(kAny); }
Json schema_of(const std::array<double, 3>&) { return numbers_schema(field::importance(), 3); }
Json schema_of(const View&) { return ref("view"); }
Json schema_of(const PoseSpec&) { return ref("pose"); }
Json schema_of(const WeightOptions&) { return ref("weights"); }
Json schema_of(const PiecePlace&) {
  return {{"oneOf", {object_schema<PieceOfTriangle>(), object_schema<PieceNear>()}}};
}
template <Described T>
Json schema_of(const T&) {
  return object_schema<T>();
}
template <class T>
Json schema_of(const std::optional<T>&, const auto&... kind) {
  return schema_of(T{}, kind...);
}
template <class T>
Json schema_of(const std::vector<T>&, const List& list) {
  Json schema = {{"type", "array"}};
  if constexpr (std::is_same_v<T, Vec3d>)
    schema["items"] = schema_of(T(Vec3d::Zero()), Point{});
  else
    schema["items"] = schema_of(T{});
  if (list.least > 0) schema["minItems"] = list.least;
  return schema;
}
template <class PoseChanges>
Json schema_of(const Stroke&, const Blades<PoseChanges>&) {
  Json blade = object_schema<Blade>(), first = blade;
  blade["properties"]["pose"] = ref("pose");
  return {{"type", "array"},
          {"prefixItems", Json::array({std::move(first)})},
          {"items", std::move(blade)},
          {"minItems", 2}};
}

/// Adds fields to the schema of an object.
struct SchemaFields {
  Json& object;

  void add(const Field& field, Json schema, const Json& value) const {
    Json described = {{"description", field.text}};
    described.update(schema);
    if (!value.is_null()) described["default"] = value;
    if (field.use == Use::required) object["required"].push_back(field.name);
    object["properties"][field.name] = std::move(described);
  }
  void operator()(const Field& field, const auto& member, const auto&... kind) const {
    add(field, schema_of(member, kind...), default_json(field, member, kind...));
  }
};

Json empty_object(const char* op) {
  Json schema = {{"type", "object"}, {"additionalProperties", false}};
  if (op == nullptr) return schema;
  schema["required"] = Json::array({"op"});
  schema["properties"]["op"] = {{"const", op}};
  return schema;
}

/// As SchemaFields, and the objects within.
struct ObjectFields : SchemaFields {
  void object(const Field& field, const auto& body) const {
    Json inner = empty_object(nullptr);
    const ObjectFields fields{{inner}};
    body(fields);
    add(field, std::move(inner), {});
  }
};

/// Rules over several fields.
void add_rules(Json&, const auto&) {}
void add_rules(Json& schema, const WeightOptions&) {
  schema["if"] = {{"required", {"policy"}},
                  {"properties", {{"policy", {{"const", name_of(WeightPolicy::exact)}}}}}};
  schema["then"] = {{"properties", {{"influences", {{"const", 0}}}}}};
}
void add_rules(Json& schema, const SeverOperation&) {
  schema["dependentRequired"] = {{"from", {"tilt"}}};
}
void add_rules(Json& schema, const WeightsOperation&) {
  const auto only_with = [](const char* field, WeightPolicy policy) -> Json {
    const Json weights = {{"required", {"policy"}},
                          {"properties", {{"policy", {{"const", name_of(policy)}}}}}};
    return {{"if", {{"required", {field}}}}, {"then", {{"properties", {{"weights", weights}}}}}};
  };
  schema["allOf"] = {only_with("pose", WeightPolicy::pose_exact),
                     only_with("refit", WeightPolicy::refit)};
}

template <Described T>
Json object_schema(const char* op) {
  Json schema = empty_object(op);
  const ObjectFields fields{{schema}};
  T of{};
  describe(fields, of);
  add_rules(schema, of);
  return schema;
}

Json pose_schema() {
  Json bones = {{"type", "object"},
                {"propertyNames", {{"minLength", 1}}},
                {"additionalProperties", object_schema<BonesPose::Bone>()}};
  Json of_bones = empty_object(nullptr);
  of_bones["required"] = Json::array({"bones"});
  of_bones["properties"]["bones"] = std::move(bones);
  return {{"oneOf",
           {words_schema(std::array{kPoseName<RestPose>, kPoseName<BindPose>}),
            object_schema<ClipPose>(), std::move(of_bones), object_schema<ModelPose>()}}};
}

Json length_schema(const NumberRange& metres, const NumberRange& widths) {
  Json in_widths = empty_object(nullptr);
  in_widths["required"] = Json::array({"widths"});
  in_widths["properties"]["widths"] = number_schema(widths);
  return {{"description", "Metres, or widths of the limb."},
          {"oneOf", {number_schema(metres), std::move(in_widths)}}};
}

Json view_schema() {
  std::vector<const char*> sides;
  for (const NamedSide& side : kViewSides) sides.push_back(side.name);
  Json of_bone = empty_object(nullptr);
  of_bone["required"] = Json::array({"bone"});
  of_bone["properties"]["bone"] = ref("point");
  return {{"description", "A side of the model, or a direction in its space or the bone's frame."},
          {"oneOf", {words_schema(sides), ref("point"), std::move(of_bone)}}};
}

/// Adds the operations of a variant.
template <class... Kinds>
void add_operations(Json& definitions, Json& references, const std::variant<Kinds...>*) {
  const auto add = [&](const char* op, Json schema) {
    const std::string name = std::string(op) + "_operation";
    definitions[name] = std::move(schema);
    references.push_back(ref(name));
  };
  (add(kOpName<Kinds>, object_schema<Kinds>(kOpName<Kinds>)), ...);
}

/// JSON in lines of at most 120 characters: a value is on one line if it fits.
void print_json(std::string& text, const Json& value, std::size_t indent, std::size_t used) {
  const std::string line = value.dump(-1, ' ');
  if (used + line.size() < 120 || !value.is_structured() || value.empty()) {
    text += line;
    return;
  }
  const std::string begin = "\n" + std::string(indent + 1, ' ');
  text += value.is_object() ? "{" : "[";
  bool is_first = true;
  for (const auto& [key, of] : value.items()) {
    text += (is_first ? "" : ",") + begin;
    is_first = false;
    const std::string name = value.is_object() ? Json(key).dump() + ": " : "";
    text += name;
    print_json(text, of, indent + 1, indent + 1 + name.size());
  }
  text += "\n" + std::string(indent, ' ') + (value.is_object() ? "}" : "]");
}

}  // namespace

std::string operation_schema() {
  Json definitions = {
      {"point", numbers_schema(field::kCoordinate, 3)},
      {"name_or_index", {{"oneOf", {{{"type", "string"}}, integer_schema(0, kNone - 1)}}}},
      {"pose", pose_schema()},
      {"weights", object_schema<WeightOptions>()},
      {"aimed_length", length_schema(field::length_above_zero(), field::kWidths)},
      {"length_or_widths", length_schema(field::length_from_zero(), field::kWidthsFromZero)},
      {"view", view_schema()}};
  Json operations = Json::array();
  add_operations(definitions, operations, static_cast<const Operation*>(nullptr));
  add_operations(definitions, operations, static_cast<const AimedOperation*>(nullptr));
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Sunder operation log, version 1"}};
  schema.update(empty_object(nullptr));
  schema["required"] = {"sunder_operations", "operations"};
  schema["properties"] = {
      {"sunder_operations", {{"const", 1}}},
      {"operations", {{"type", "array"}, {"items", {{"oneOf", std::move(operations)}}}}}};
  schema["$defs"] = std::move(definitions);
  std::string text;
  print_json(text, schema, 0, 0);
  return text + "\n";
}

}  // namespace sunder::test
