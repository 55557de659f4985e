#include "io/gltf_patch/document_rules.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <vector>

#include "io/gltf/glb.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();
/// The least number above zero, for "must be positive".
constexpr double kPositive = std::numeric_limits<double>::min();
/// Whole numbers beyond it are not exact in every reader.
constexpr double kLargestWhole = 9007199254740991.0;

enum class Form {
  text,
  uri,
  version,
  flag,
  number,   ///< In [least, greatest].
  whole,    ///< A number without fraction in [least, greatest].
  choice,   ///< One of `texts`.
  code,     ///< One of `codes`.
  index,    ///< Into the document's list `list`.
  indices,  ///< Different indices into `list`, one at least.
  numbers,  ///< `length` numbers in [least, greatest]; 0: any length above zero.
  object,   ///< With `members`.
  objects,  ///< One at least; an invalid one makes the list invalid.
  primitives,
  attributes,  ///< Names with accessors, one at least.
  targets,     ///< A list of such.
};

struct Rule {
  const char* name;
  Form form;
  bool required = false;
  double least = -kAny, greatest = kAny;
  const char* list = nullptr;
  std::span<const Rule> members = {};
  std::size_t length = 0;
  std::span<const char* const> texts = {};
  std::span<const int> codes = {};
};

constexpr bool kRequired = true;

// ---- Rules of objects inside the entries of lists

constexpr Rule text(const char* name, bool required = false) {
  return {.name = name, .form = Form::text, .required = required};
}
constexpr Rule share(const char* name) {
  return {.name = name, .form = Form::number, .least = 0, .greatest = 1};
}
constexpr Rule number(const char* name, double least = -kAny, bool required = false) {
  return {.name = name, .form = Form::number, .required = required, .least = least};
}
constexpr Rule whole(const char* name, double least = 0, bool required = false) {
  return {.name = name,
          .form = Form::whole,
          .required = required,
          .least = least,
          .greatest = kLargestWhole};
}
/// More sets of texture coordinates than any program has.
constexpr Rule set_of_coordinates() {
  return {.name = "texCoord", .form = Form::whole, .least = 0, .greatest = 15};
}
constexpr Rule index(const char* name, const char* list, bool required = false) {
  return {.name = name, .form = Form::index, .required = required, .list = list};
}
constexpr Rule numbers(const char* name, std::size_t length, double least = -kAny,
                       double greatest = kAny) {
  return {
      .name = name, .form = Form::numbers, .least = least, .greatest = greatest, .length = length};
}
constexpr Rule object(const char* name, std::span<const Rule> members, bool required = false) {
  return {.name = name, .form = Form::object, .required = required, .members = members};
}
constexpr Rule objects(const char* name, std::span<const Rule> members, bool required = false) {
  return {.name = name, .form = Form::objects, .required = required, .members = members};
}
constexpr Rule choice(const char* name, std::span<const char* const> texts, bool required = false) {
  return {.name = name, .form = Form::choice, .required = required, .texts = texts};
}
constexpr Rule code(const char* name, std::span<const int> codes, bool required = false) {
  return {.name = name, .form = Form::code, .required = required, .codes = codes};
}

constexpr int kIndexTypes[] = {5121, 5123, 5125};
constexpr int kComponentTypes[] = {5120, 5121, 5122, 5123, 5125, 5126};
constexpr const char* kKnownElementTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                              "MAT2",   "MAT3", "MAT4"};
constexpr Rule kSparseIndices[] = {index("bufferView", "bufferViews", kRequired),
                                   whole("byteOffset"),
                                   code("componentType", kIndexTypes, kRequired)};
constexpr Rule kSparseValues[] = {index("bufferView", "bufferViews", kRequired),
                                  whole("byteOffset")};
constexpr Rule kSparse[] = {whole("count", 1, kRequired),
                            object("indices", kSparseIndices, kRequired),
                            object("values", kSparseValues, kRequired)};

constexpr const char* kPaths[] = {"translation", "rotation", "scale", "weights"};
constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
constexpr Rule kTarget[] = {index("node", "nodes"), choice("path", kPaths, kRequired)};
constexpr Rule kChannel[] = {whole("sampler", 0, kRequired), object("target", kTarget, kRequired)};
constexpr Rule kKeys[] = {index("input", "accessors", kRequired),
                          choice("interpolation", kInterpolations),
                          index("output", "accessors", kRequired)};

constexpr Rule kOrthographic[] = {
    number("xmag", -kAny, kRequired), number("ymag", -kAny, kRequired),
    number("zfar", kPositive, kRequired), number("znear", 0, kRequired)};
constexpr Rule kPerspective[] = {number("aspectRatio", kPositive),
                                 number("yfov", kPositive, kRequired), number("zfar", kPositive),
                                 number("znear", kPositive, kRequired)};

constexpr Rule kTextureInfo[] = {index("index", "textures", kRequired), set_of_coordinates()};
constexpr Rule kNormalTexture[] = {index("index", "textures", kRequired), set_of_coordinates(),
                                   number("scale")};
constexpr Rule kOcclusionTexture[] = {index("index", "textures", kRequired), set_of_coordinates(),
                                      share("strength")};
constexpr Rule texture(const char* name) { return object(name, kTextureInfo); }
constexpr Rule kMetallicRoughness[] = {
    numbers("baseColorFactor", 4, 0, 1), texture("baseColorTexture"), share("metallicFactor"),
    share("roughnessFactor"), texture("metallicRoughnessTexture")};

// ---- Extensions

constexpr Rule kClearcoat[] = {
    share("clearcoatFactor"), texture("clearcoatTexture"), share("clearcoatRoughnessFactor"),
    texture("clearcoatRoughnessTexture"), object("clearcoatNormalTexture", kNormalTexture)};
constexpr Rule kIor[] = {number("ior", 0)};
constexpr Rule kSheen[] = {numbers("sheenColorFactor", 3, 0, 1), texture("sheenColorTexture"),
                           share("sheenRoughnessFactor"), texture("sheenRoughnessTexture")};
constexpr Rule kSpecular[] = {share("specularFactor"), texture("specularTexture"),
                              numbers("specularColorFactor", 3, 0),
                              texture("specularColorTexture")};
constexpr Rule kTransmission[] = {share("transmissionFactor"), texture("transmissionTexture")};
constexpr Rule kVolume[] = {number("thicknessFactor", 0), texture("thicknessTexture"),
                            number("attenuationDistance", kPositive),
                            numbers("attenuationColor", 3, 0, 1)};
constexpr Rule kEmissiveStrength[] = {number("emissiveStrength", 0)};
constexpr Rule kIridescence[] = {share("iridescenceFactor"),
                                 texture("iridescenceTexture"),
                                 number("iridescenceIor", 1),
                                 number("iridescenceThicknessMinimum", 0),
                                 number("iridescenceThicknessMaximum", 0),
                                 texture("iridescenceThicknessTexture")};
constexpr Rule kAnisotropy[] = {share("anisotropyStrength"), number("anisotropyRotation"),
                                texture("anisotropyTexture")};
constexpr Rule kDispersion[] = {number("dispersion", 0)};
constexpr Rule kSpecularGlossiness[] = {
    numbers("diffuseFactor", 4, 0, 1), texture("diffuseTexture"),
    numbers("specularFactor", 3, 0, 1), share("glossinessFactor"),
    texture("specularGlossinessTexture")};
constexpr Rule kTextureTransform[] = {numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                      set_of_coordinates()};
constexpr Rule kWebp[] = {index("source", "images")};
constexpr const char* kLightTypes[] = {"directional", "point", "spot"};
constexpr double kRightAngle = 1.5707963267948966;
constexpr Rule kSpot[] = {
    {.name = "innerConeAngle", .form = Form::number, .least = 0, .greatest = kRightAngle},
    {.name = "outerConeAngle", .form = Form::number, .least = kPositive, .greatest = kRightAngle}};
constexpr Rule kLight[] = {
    numbers("color", 3, 0, 1),  number("intensity", 0), choice("type", kLightTypes, kRequired),
    number("range", kPositive), object("spot", kSpot),  text("name")};
constexpr Rule kLights[] = {objects("lights", kLight, kRequired)};
constexpr Rule kNodeLight[] = {whole("light", 0, kRequired)};
constexpr Rule kVariant[] = {text("name", kRequired)};
constexpr Rule kVariants[] = {objects("variants", kVariant, kRequired)};
constexpr Rule kMapping[] = {
    index("material", "materials", kRequired),
    {.name = "variants", .form = Form::numbers, .required = true, .least = 0}};
constexpr Rule kMappings[] = {objects("mappings", kMapping, kRequired)};

/// A ratified extension, and the objects that may have it: an entry of a list ("materials"), or
/// "textureInfo", "primitives", "document".
struct Extension {
  std::string_view name, of;
  std::span<const Rule> members;
};
constexpr Extension kExtensions[] = {
    {"KHR_materials_unlit", "materials", {}},
    {"KHR_materials_clearcoat", "materials", kClearcoat},
    {"KHR_materials_ior", "materials", kIor},
    {"KHR_materials_sheen", "materials", kSheen},
    {"KHR_materials_specular", "materials", kSpecular},
    {"KHR_materials_transmission", "materials", kTransmission},
    {"KHR_materials_volume", "materials", kVolume},
    {"KHR_materials_emissive_strength", "materials", kEmissiveStrength},
    {"KHR_materials_iridescence", "materials", kIridescence},
    {"KHR_materials_anisotropy", "materials", kAnisotropy},
    {"KHR_materials_dispersion", "materials", kDispersion},
    {"KHR_materials_pbrSpecularGlossiness", "materials", kSpecularGlossiness},
    {"KHR_materials_variants", "document", kVariants},
    {"KHR_materials_variants", "primitives", kMappings},
    {"KHR_texture_transform", "textureInfo", kTextureTransform},
    {"EXT_texture_webp", "textures", kWebp},
    {"KHR_lights_punctual", "document", kLights},
    {"KHR_lights_punctual", "nodes", kNodeLight}};

// ---- Rules of the entries of lists

constexpr Rule kAccessor[] = {index("bufferView", "bufferViews"),
                              whole("byteOffset"),
                              code("componentType", kComponentTypes, kRequired),
                              {.name = "normalized", .form = Form::flag},
                              whole("count", 1, kRequired),
                              choice("type", kKnownElementTypes, kRequired),
                              numbers("max", 0),
                              numbers("min", 0),
                              object("sparse", kSparse),
                              text("name")};
constexpr Rule kAnimation[] = {objects("channels", kChannel, kRequired),
                               objects("samplers", kKeys, kRequired), text("name")};
constexpr Rule kBuffer[] = {whole("byteLength", 1, kRequired), text("name")};
constexpr int kViewTargets[] = {34962, 34963};
constexpr Rule kBufferView[] = {
    index("buffer", "buffers", kRequired),
    whole("byteOffset"),
    whole("byteLength", 1, kRequired),
    {.name = "byteStride", .form = Form::whole, .least = 4, .greatest = 252},
    code("target", kViewTargets),
    text("name")};
constexpr const char* kCameraTypes[] = {"perspective", "orthographic"};
constexpr Rule kCamera[] = {choice("type", kCameraTypes, kRequired),
                            object("orthographic", kOrthographic),
                            object("perspective", kPerspective), text("name")};
constexpr Rule kImage[] = {{.name = "uri", .form = Form::uri},
                           text("mimeType"),
                           index("bufferView", "bufferViews"),
                           text("name")};
constexpr const char* kAlphaModes[] = {"OPAQUE", "MASK", "BLEND"};
constexpr Rule kMaterial[] = {object("pbrMetallicRoughness", kMetallicRoughness),
                              object("normalTexture", kNormalTexture),
                              object("occlusionTexture", kOcclusionTexture),
                              texture("emissiveTexture"),
                              numbers("emissiveFactor", 3, 0, 1),
                              choice("alphaMode", kAlphaModes),
                              number("alphaCutoff", 0),
                              {.name = "doubleSided", .form = Form::flag},
                              text("name")};
constexpr int kModes[] = {0, 1, 2, 3, 4, 5, 6};
constexpr Rule kPrimitive[] = {{.name = "attributes", .form = Form::attributes, .required = true},
                               index("indices", "accessors"),
                               index("material", "materials"),
                               code("mode", kModes),
                               {.name = "targets", .form = Form::targets}};
constexpr Rule kMesh[] = {{.name = "primitives", .form = Form::primitives, .required = true},
                          numbers("weights", 0),
                          text("name")};
constexpr Rule kNode[] = {
    index("camera", "cameras"), {.name = "children", .form = Form::indices, .list = "nodes"},
    index("skin", "skins"),     numbers("matrix", 16),
    index("mesh", "meshes"),    numbers("rotation", 4),
    numbers("scale", 3),        numbers("translation", 3),
    numbers("weights", 0),      text("name")};
constexpr int kMagnifications[] = {9728, 9729};
constexpr int kMinifications[] = {9728, 9729, 9984, 9985, 9986, 9987};
constexpr int kWraps[] = {33071, 33648, 10497};
constexpr Rule kSampler[] = {code("magFilter", kMagnifications), code("minFilter", kMinifications),
                             code("wrapS", kWraps), code("wrapT", kWraps), text("name")};
constexpr Rule kScene[] = {{.name = "nodes", .form = Form::indices, .list = "nodes"}, text("name")};
// Joints may repeat here: repair_nodes() gives the second one a node of its own.
constexpr Rule kSkin[] = {index("inverseBindMatrices", "accessors"),
                          index("skeleton", "nodes"),
                          {.name = "joints", .form = Form::numbers, .required = true, .least = 0},
                          text("name")};
constexpr Rule kTexture[] = {index("sampler", "samplers"), index("source", "images"), text("name")};
constexpr Rule kAsset[] = {text("copyright"),
                           text("generator"),
                           {.name = "version", .form = Form::version, .required = true},
                           {.name = "minVersion", .form = Form::version}};

struct List {
  const char* name;
  std::span<const Rule> entry;
};
/// Lists come after those to which their entries refer, because a list that is not one is removed.
constexpr List kLists[] = {{"buffers", kBuffer},      {"bufferViews", kBufferView},
                           {"accessors", kAccessor},  {"images", kImage},
                           {"samplers", kSampler},    {"textures", kTexture},
                           {"materials", kMaterial},  {"cameras", kCamera},
                           {"meshes", kMesh},         {"skins", kSkin},
                           {"nodes", kNode},          {"scenes", kScene},
                           {"animations", kAnimation}};

class Enforcer {
 public:
  explicit Enforcer(Json& document) : document_(document) {}

  SchemaFaults run() {
    for (const List& list : kLists) enforce_list(list);
    Json& asset = document_["asset"];
    if (!is_object(asset, kAsset, "/asset", "asset")) asset = {{"version", "2.0"}};
    enforce(document_, {.name = "scene", .form = Form::index, .list = "scenes"}, "");
    enforce_extensions(document_, "", "document");
    collect_used_extensions();
    return std::move(faults_);
  }

 private:
  void enforce_list(const List& list) {
    const auto found = document_.find(list.name);
    if (found == document_.end()) return;
    const std::string pointer = std::string("/") + list.name;
    if (!found->is_array() || found->empty()) {
      faults_.add(pointer);
      document_.erase(list.name);
      return;
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
      Json& entry = (*found)[i];
      const bool is_valid =
          is_object(entry, list.entry, pointer + "/" + std::to_string(i), list.name) &&
          (list.entry.data() != kCamera || is_camera(entry));
      if (is_valid) continue;
      faults_.add(pointer + "/" + std::to_string(i));
      entry = empty_entry(list.name);
    }
  }

  /// A camera has the projection that its type names, and no other.
  static bool is_camera(const Json& camera) {
    const bool is_perspective = camera["type"] == "perspective";
    const char* const own = is_perspective ? "perspective" : "orthographic";
    if (!camera.contains(own) || camera.contains(is_perspective ? "orthographic" : "perspective"))
      return false;
    const Json& projection = camera[own];
    return !projection.contains("zfar") ||
           projection["zfar"].get<double>() > projection["znear"].get<double>();
  }

  /// Removes optional members that violate their rule. @return false if a required one does.
  bool is_object(Json& value, std::span<const Rule> rules, const std::string& pointer,
                 std::string_view kind) {
    if (!value.is_object()) return false;
    for (const Rule& rule : rules)
      if (!enforce(value, rule, pointer)) return false;
    enforce_extensions(value, pointer, kind);
    return true;
  }

  bool enforce(Json& value, const Rule& rule, const std::string& pointer) {
    const auto found = value.find(rule.name);
    if (found == value.end()) return !rule.required;
    const std::string place = pointer + "/" + rule.name;
    if (follows(*found, rule, place)) return true;
    faults_.add(place);
    if (rule.required) return false;
    value.erase(rule.name);
    return true;
  }

  bool follows(Json& value, const Rule& rule, const std::string& pointer) {
    switch (rule.form) {
      case Form::text: return value.is_string();
      case Form::uri: return is_uri(value);
      case Form::version: return is_version(value);
      case Form::flag: return value.is_boolean();
      case Form::number: return is_number(value, rule);
      case Form::whole: return is_whole(value, rule.least, rule.greatest, pointer);
      case Form::choice:
        return value.is_string() && std::any_of(rule.texts.begin(), rule.texts.end(),
                                                [&](const char* one) { return value == one; });
      case Form::code:
        return is_whole(value, 0, kLargestWhole, pointer) &&
               std::any_of(rule.codes.begin(), rule.codes.end(),
                           [&](int one) { return value == one; });
      case Form::index: return is_index(value, rule.list, pointer);
      case Form::indices: return are_indices(value, rule, pointer);
      case Form::numbers: return are_numbers(value, rule);
      case Form::object: return is_object(value, rule.members, pointer, kind_of(rule));
      case Form::objects: return are_objects(value, rule, pointer);
      case Form::primitives: return are_primitives(value, pointer);
      case Form::attributes: return are_attributes(value, pointer);
      case Form::targets: return are_targets(value, pointer);
    }
    return false;
  }

  static std::string_view kind_of(const Rule& rule) {
    const bool is_texture = !rule.members.empty() && rule.members[0].list != nullptr &&
                            std::string_view(rule.members[0].list) == "textures";
    return is_texture ? "textureInfo" : rule.name;
  }

  /// Data URIs, and relative or absolute references without characters that URIs do not have.
  static bool is_uri(const Json& value) {
    if (!value.is_string()) return false;
    const auto& uri = value.get_ref<const std::string&>();
    if (uri.empty()) return false;
    if (is_data_uri(uri)) return uri.find(";base64,") != std::string::npos;
    const std::size_t colon = uri.find(':');
    const bool has_bad_scheme =
        colon == 0 || (colon != std::string::npos &&
                       uri.substr(0, colon).find_first_of("/?#") == std::string::npos &&
                       std::isalpha(static_cast<unsigned char>(uri[0])) == 0);
    if (has_bad_scheme) return false;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      if (static_cast<unsigned char>(uri[i]) < 0x20) return false;
      if (uri[i] == '%' &&
          (i + 2 >= uri.size() || std::isxdigit(static_cast<unsigned char>(uri[i + 1])) == 0 ||
           std::isxdigit(static_cast<unsigned char>(uri[i + 2])) == 0))
        return false;
    }
    return uri.find_first_of("[]") == std::string::npos;
  }

  static bool is_version(const Json& value) {
    if (!value.is_string()) return false;
    const auto& version = value.get_ref<const std::string&>();
    return version.size() == 3 && version.substr(0, 2) == "2." &&
           std::isdigit(static_cast<unsigned char>(version[2])) != 0;
  }

  static bool is_number(const Json& value, const Rule& rule) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    return number >= rule.least && number <= rule.greatest && std::isfinite(number);
  }

  /// Whole numbers may not be written with a fraction, 4.0; such ones are written as they should.
  bool is_whole(Json& value, double least, double greatest, const std::string& pointer) {
    if (!value.is_number()) return false;
    const double number = value.get<double>();
    if (!(number >= least && number <= greatest) || number != std::floor(number)) return false;
    if (!value.is_number_integer()) {
      faults_.add(pointer);
      value = static_cast<std::uint64_t>(number);
    }
    return true;
  }

  bool is_index(Json& value, const char* list, const std::string& pointer) {
    const auto entries = document_.find(list);
    const std::size_t count =
        entries == document_.end() || !entries->is_array() ? 0 : entries->size();
    return count > 0 && is_whole(value, 0, static_cast<double>(count - 1), pointer);
  }

  bool are_indices(Json& value, const Rule& rule, const std::string& pointer) {
    if (!value.is_array() || value.empty()) return false;
    std::set<std::uint64_t> seen;
    Json kept = Json::array();
    for (Json& one : value)
      if (is_index(one, rule.list, pointer) && seen.insert(one.get<std::uint64_t>()).second)
        kept.push_back(one);
    if (kept.empty()) return false;
    if (kept.size() != value.size()) {
      faults_.add(pointer);
      value = std::move(kept);
    }
    return true;
  }

  static bool are_numbers(const Json& value, const Rule& rule) {
    if (!value.is_array() || value.empty()) return false;
    if (rule.length != 0 && value.size() != rule.length) return false;
    return std::all_of(value.begin(), value.end(),
                       [&](const Json& one) { return is_number(one, rule); });
  }

  bool are_objects(Json& value, const Rule& rule, const std::string& pointer) {
    if (!value.is_array() || value.empty()) return false;
    for (std::size_t i = 0; i < value.size(); ++i)
      if (!is_object(value[i], rule.members, pointer + "/" + std::to_string(i), rule.name))
        return false;
    return true;
  }

  bool are_primitives(Json& value, const std::string& pointer) {
    if (!value.is_array()) return false;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string place = pointer + "/" + std::to_string(i);
      if (is_object(value[i], kPrimitive, place, "primitives")) continue;
      faults_.add(place);
      value[i] = nullptr;
    }
    return true;
  }

  /// Attributes that the reader does not know may refer to nothing; these alone are removed.
  bool are_attributes(Json& value, const std::string& pointer) {
    if (!value.is_object()) return false;
    std::vector<std::string> invalid;
    for (auto& [name, accessor] : value.items())
      if (!is_index(accessor, "accessors", pointer + "/" + name)) invalid.push_back(name);
    for (const std::string& name : invalid) {
      faults_.add(pointer + "/" + name);
      value.erase(name);
    }
    return true;
  }

  bool are_targets(Json& value, const std::string& pointer) {
    if (!value.is_array() || value.empty()) return false;
    for (std::size_t i = 0; i < value.size(); ++i)
      if (!are_attributes(value[i], pointer + "/" + std::to_string(i))) return false;
    return true;
  }

  // ---- Extensions

  /// @param kind  of the object: the list whose entry it is, or "textureInfo" and the like.
  void enforce_extensions(Json& value, const std::string& pointer, std::string_view kind) {
    const auto found = value.find("extensions");
    if (found == value.end()) return;
    const std::string place = pointer + "/extensions";
    if (!found->is_object()) {
      faults_.add(place);
      value.erase("extensions");
      return;
    }
    std::vector<std::string> invalid;
    for (auto& [name, extension] : found->items()) {
      if (is_extension(extension, name, place + "/" + name, kind))
        used_.insert(name);
      else
        invalid.push_back(name);
    }
    for (const std::string& name : invalid) {
      faults_.add(place + "/" + name);
      found->erase(name);
    }
    if (!invalid.empty() && found->empty()) value.erase("extensions");
  }

  bool is_extension(Json& value, std::string_view name, const std::string& pointer,
                    std::string_view kind) {
    if (!value.is_object()) return false;
    bool is_known = false;
    for (const Extension& extension : kExtensions) {
      if (extension.name != name) continue;
      is_known = true;
      if (extension.of == kind) return is_object(value, extension.members, pointer, name);
    }
    return !is_known;
  }

  /// Every extension of the document must be declared, and every required one used.
  void collect_used_extensions() {
    enforce_names("extensionsRequired");
    enforce_names("extensionsUsed");
    if (const auto required = document_.find("extensionsRequired"); required != document_.end())
      for (const Json& name : *required) used_.insert(name.get<std::string>());
    std::set<std::string> declared;
    if (const auto names = document_.find("extensionsUsed"); names != document_.end())
      for (const Json& name : *names) declared.insert(name.get<std::string>());
    for (const std::string& name : used_) {
      if (declared.contains(name)) continue;
      faults_.add("/extensionsUsed");
      list_of(document_, "extensionsUsed").push_back(name);
    }
  }

  void enforce_names(const char* list) {
    const auto found = document_.find(list);
    if (found == document_.end()) return;
    Json kept = Json::array();
    std::set<std::string> seen;
    if (found->is_array())
      for (const Json& name : *found)
        if (name.is_string() && seen.insert(name.get<std::string>()).second) kept.push_back(name);
    if (!kept.empty() && kept.size() == found->size()) return;
    faults_.add(std::string("/") + list);
    if (kept.empty())
      document_.erase(list);
    else
      *found = std::move(kept);
  }

  Json& document_;
  SchemaFaults faults_;
  std::set<std::string> used_;
};

}  // namespace

Json empty_entry(std::string_view list) {
  if (list == "bufferViews") return {{"buffer", 0}, {"byteLength", 1}};
  if (list == "accessors") return {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
  if (list == "skins") return {{"joints", {0}}};
  if (list == "cameras")
    return {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}};
  return Json::object();
}

SchemaFaults enforce_schema(Json& document) { return Enforcer(document).run(); }

}  // namespace sunder::gltf
