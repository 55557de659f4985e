#include "io/gltf_read/attributes.h"

#include <algorithm>
#include <cmath>

#include "core/internal/all_finite.h"
#include "core/internal/wall_material.h"
#include "io/gltf/cursor.h"
#include "io/gltf/refusal.h"
#include "io/gltf/unit_tolerance.h"

namespace sunder::gltf {
namespace {

std::string set_name(const char* prefix, std::size_t index) {
  return prefix + std::to_string(index);
}

template <class Vector>
std::uint32_t first_non_finite(const std::vector<Vector>& values) {
  if (all_finite(values)) return kNone;
  const auto found = std::find_if(values.begin(), values.end(),
                                  [](const Vector& value) { return !value.allFinite(); });
  return found == values.end() ? kNone : static_cast<std::uint32_t>(found - values.begin());
}

/// Scales a direction to unit length, if necessary. @return whether it changed.
template <class Direction>
bool make_unit(Direction&& direction, const Vec3f& if_zero) {
  // Nearly all directions are of unit length; most are seen to be without a square root.
  const double squared_length = direction.template cast<double>().squaredNorm();
  constexpr double kSurely = 1.9 * kUnitTolerance;
  if (std::abs(squared_length - 1.0) <= kSurely) return false;
  const float norm = squared_length > 0 ? static_cast<float>(std::sqrt(squared_length)) : 0.0f;
  if (std::abs(norm - 1.0f) <= static_cast<float>(kUnitTolerance)) return false;
  if (norm > 0.0f)
    direction = direction.template cast<double>().normalized().template cast<float>();
  else
    direction = if_zero;
  return true;
}

WeightFormat weight_format(ComponentType type) {
  if (type == ComponentType::u8) return WeightFormat::unorm8;
  return type == ComponentType::u16 ? WeightFormat::unorm16 : WeightFormat::float32;
}

}  // namespace

AttributeReader::AttributeReader(Reading& reading, const Cursor& primitive, std::string place)
    : reading_(reading),
      primitive_(primitive),
      attributes_(primitive.member("attributes")),
      place_(std::move(place)) {}

Accessor AttributeReader::open(const Cursor& at, const Mesh& mesh, std::uint32_t components) const {
  const Accessor accessor = reading_.accessors.open(at);
  if (accessor.is_matrix || accessor.components != components)
    refuse(StatusCode::malformed_file, accessor.index,
           "%s: expected %u numbers per vertex, found %u", at.pointer().c_str(), components,
           accessor.components);
  if (!mesh.positions.empty() && accessor.count != mesh.positions.size())
    refuse(StatusCode::size_mismatch, accessor.index, "%s: %u elements for %zu vertices",
           at.pointer().c_str(), accessor.count, mesh.positions.size());
  return accessor;
}

template <class Vector>
void AttributeReader::zero_non_finite(std::vector<Vector>& values, const char* what) {
  const std::uint32_t first = first_non_finite(values);
  if (first == kNone) return;
  std::uint32_t count = 0;
  for (Vector& value : values)
    if (!value.allFinite()) {
      value.setZero();
      ++count;
    }
  repaired_ = true;
  // The set is not dropped: materials refer to sets by number, and later ones would move up.
  reading_.notes.repaired(StatusCode::non_finite_value, first, place_,
                          std::string(what) + " were not finite and became zero (first: vertex " +
                              std::to_string(first) + ")",
                          count);
}

template <class Vector>
bool AttributeReader::drop_non_finite(std::vector<Vector>& values, const std::string& what) {
  const std::uint32_t first = first_non_finite(values);
  if (first == kNone) return false;
  values.clear();
  repaired_ = true;
  reading_.notes.dropped(StatusCode::non_finite_value, first, place_,
                         what + " are not finite (first: vertex " + std::to_string(first) + ")");
  return true;
}

void AttributeReader::read_streams(Mesh& mesh) {
  read_positions(mesh);
  read_normals(mesh);
  read_tangents(mesh);
  read_uv_sets(mesh);
  read_color_sets(mesh);
  for (const auto& item : attributes_.json().items()) {
    if (item.key().empty() || item.key().front() != '_') continue;
    const Cursor at(item.value(), attributes_.pointer() + "/" + item.key());
    if (item.key() == kTearSideFeatureAttribute)
      read_tear_side_feature(mesh, at);
    else
      read_custom(mesh, item.key(), at);
  }
}

/// The copy of the tear sides is used only if a tool dropped the attribute itself.
void AttributeReader::read_tear_side_feature(Mesh& mesh, const Cursor& at) {
  if (attributes_.find(kTearSideAttribute)) return;
  const Accessor accessor = reading_.accessors.open(at);
  if (!accessor.is_matrix && accessor.components == 1)
    return read_custom(mesh, kTearSideAttribute, at);
  reading_.notes.dropped(StatusCode::malformed_file, accessor.index, place_,
                         std::string("attribute ") + kTearSideFeatureAttribute +
                             " does not have one number per vertex");
}

void AttributeReader::read_positions(Mesh& mesh) {
  const Accessor accessor = open(attributes_.member("POSITION"), mesh, 3);
  mesh.positions = reading_.accessors.read_vectors<Vec3f>(accessor);
  if (const std::uint32_t vertex = first_non_finite(mesh.positions); vertex != kNone)
    refuse(StatusCode::non_finite_value, vertex,
           "/accessors/%u: the position of vertex %u is not finite", accessor.index, vertex);
}

void AttributeReader::read_normals(Mesh& mesh) {
  const auto at = attributes_.find("NORMAL");
  if (!at) return;
  mesh.normals = reading_.accessors.read_vectors<Vec3f>(open(*at, mesh, 3));
  if (drop_non_finite(mesh.normals, "normals")) return;
  std::uint32_t changed = 0;
  for (Vec3f& normal : mesh.normals) changed += make_unit(normal, Vec3f::UnitZ());
  if (changed == 0) return;
  repaired_ = true;
  reading_.notes.repaired(StatusCode::malformed_file, kNone, place_,
                          "normals were not of unit length and were normalised", changed);
}

void AttributeReader::read_tangents(Mesh& mesh) {
  const auto at = attributes_.find("TANGENT");
  if (!at) return;
  mesh.tangents = reading_.accessors.read_vectors<Vec4f>(open(*at, mesh, 4));
  if (drop_non_finite(mesh.tangents, "tangents")) return;
  std::uint32_t changed = 0;
  for (Vec4f& tangent : mesh.tangents) {
    bool is_changed = make_unit(tangent.head<3>(), Vec3f::UnitX());
    if (std::abs(tangent.w()) != 1.0f) {
      tangent.w() = tangent.w() < 0.0f ? -1.0f : 1.0f;
      is_changed = true;
    }
    changed += is_changed;
  }
  if (changed == 0) return;
  repaired_ = true;
  reading_.notes.repaired(
      StatusCode::malformed_file, kNone, place_,
      "tangents were not of unit length, or their sign not +-1, and were corrected", changed);
}

void AttributeReader::read_uv_sets(Mesh& mesh) {
  while (const auto at = attributes_.find(set_name("TEXCOORD_", mesh.uv_sets.size()).c_str())) {
    mesh.uv_sets.push_back(reading_.accessors.read_vectors<Vec2f>(open(*at, mesh, 2)));
    zero_non_finite(mesh.uv_sets.back(), "texture coordinates");
  }
  note_sets_beyond("TEXCOORD_", mesh.uv_sets.size());
}

void AttributeReader::read_color_sets(Mesh& mesh) {
  while (const auto at = attributes_.find(set_name("COLOR_", mesh.color_sets.size()).c_str())) {
    const std::uint32_t components = reading_.accessors.open(*at).components == 3 ? 3 : 4;
    const Accessor accessor = open(*at, mesh, components);
    color_components_.push_back(components);
    if (components == 4) {
      mesh.color_sets.push_back(reading_.accessors.read_vectors<Vec4f>(accessor));
    } else {
      auto& colors = mesh.color_sets.emplace_back();
      colors.reserve(accessor.count);
      for (const Vec3f& rgb : reading_.accessors.read_vectors<Vec3f>(accessor))
        colors.emplace_back(rgb.x(), rgb.y(), rgb.z(), 1.0f);
    }
    zero_non_finite(mesh.color_sets.back(), "colours");
    clamp_colors(mesh.color_sets.back());
  }
  note_sets_beyond("COLOR_", mesh.color_sets.size());
}

void AttributeReader::clamp_colors(std::vector<Vec4f>& colors) {
  std::uint32_t clamped = 0;
  for (Vec4f& color : colors) {
    const Vec4f inside = color.cwiseMax(0.0f).cwiseMin(1.0f);
    clamped += inside != color;
    color = inside;
  }
  if (clamped == 0) return;
  repaired_ = true;
  reading_.notes.repaired(StatusCode::malformed_file, kNone, place_,
                          "colours were outside 0 to 1 and were clamped", clamped);
}

void AttributeReader::note_sets_beyond(const char* prefix, std::size_t used) {
  const std::string start = prefix;
  std::size_t sets = 0;
  for (const auto& item : attributes_.json().items())
    sets += item.key().compare(0, start.size(), start) == 0;
  if (sets > used)
    reading_.notes.dropped(StatusCode::malformed_file, kNone, place_,
                           start + "n are not numbered 0, 1, 2 …; those after the gap were dropped",
                           static_cast<std::uint32_t>(sets - used));
}

void AttributeReader::read_custom(Mesh& mesh, const std::string& name, const Cursor& at) {
  const Accessor accessor = reading_.accessors.open(at);
  if (accessor.is_matrix || accessor.component_type == ComponentType::u32) {
    reading_.notes.dropped(StatusCode::unsupported_feature, accessor.index, place_,
                           "attribute " + name +
                               (accessor.is_matrix ? " holds matrices" : " holds 32-bit integers") +
                               "; it stays in the file but not on a torn mesh");
    return;
  }
  const bool is_label = (accessor.is_integer() && !accessor.normalized) ||
                        name == kTearSideAttribute || name == kWallMaterialAttribute;
  CustomAttribute attribute{name, accessor.components, !is_label, {}};
  attribute.values = reading_.accessors.read_floats(open(at, mesh, accessor.components));
  if (all_finite(attribute.values)) {
    if (name == kWallMaterialAttribute) forget_absent_materials(attribute.values);
    mesh.custom_attributes.push_back(std::move(attribute));
    return;
  }
  const auto bad = std::find_if(attribute.values.begin(), attribute.values.end(),
                                [](float value) { return !std::isfinite(value); });
  const auto vertex =
      static_cast<std::uint32_t>((bad - attribute.values.begin()) / accessor.components);
  repaired_ = true;
  reading_.notes.dropped(
      StatusCode::non_finite_value, vertex, place_,
      "attribute " + name + " is not finite (first: vertex " + std::to_string(vertex) + ")");
}

void AttributeReader::forget_absent_materials(std::vector<float>& indices) {
  const auto count = static_cast<float>(count_of(reading_.json(), "materials"));
  std::uint32_t absent = 0;
  for (float& index : indices) {
    if (index < count) continue;
    index = -1.0f;
    ++absent;
  }
  if (absent == 0) return;
  repaired_ = true;
  reading_.notes.repaired(StatusCode::index_out_of_range, kNone, place_,
                          "materials of walls that do not exist became those of the rim", absent);
}

std::vector<Vec3f> AttributeReader::read_deltas(const Cursor& target, const char* name,
                                                const Mesh& mesh) {
  const auto at = target.find(name);
  if (!at) return {};
  auto deltas = reading_.accessors.read_vectors<Vec3f>(open(*at, mesh, 3));
  drop_non_finite(deltas, std::string("morph target deltas of ") + name);
  return deltas;
}

void AttributeReader::read_morph_targets(Mesh& mesh, const std::vector<std::string>& names) {
  const auto targets = primitive_.find("targets");
  if (!targets) return;
  bool has_other = false;
  for (std::size_t i = 0; i < targets->size(); ++i) {
    const Cursor at = targets->element(i);
    mesh.morph_targets.push_back(
        {i < names.size() ? names[i] : std::string(), read_deltas(at, "POSITION", mesh),
         read_deltas(at, "NORMAL", mesh), read_deltas(at, "TANGENT", mesh)});
    for (const auto& item : at.json().items())
      has_other |= item.key() != "POSITION" && item.key() != "NORMAL" && item.key() != "TANGENT";
  }
  if (has_other)
    reading_.notes.dropped(StatusCode::unsupported_feature, kNone, place_,
                           "morph targets with attributes other than positions, normals and "
                           "tangents; these stay in the file but not on a torn mesh");
}

std::vector<InfluenceSet> AttributeReader::read_influences(const Mesh& mesh) {
  std::vector<InfluenceSet> sets;
  for (;;) {
    const auto joints = attributes_.find(set_name("JOINTS_", sets.size()).c_str());
    const auto weights = attributes_.find(set_name("WEIGHTS_", sets.size()).c_str());
    if (!joints && !weights) return sets;
    if (!joints || !weights)
      refuse(StatusCode::size_mismatch, static_cast<std::uint32_t>(sets.size()),
             "%s: JOINTS_%zu and WEIGHTS_%zu must both be present", attributes_.pointer().c_str(),
             sets.size(), sets.size());
    const Accessor slots = open(*joints, mesh, 4), values = open(*weights, mesh, 4);
    if (slots.normalized || slots.component_type == ComponentType::u32)
      refuse(StatusCode::malformed_file, slots.index,
             "%s: joints must be 8 or 16-bit unsigned integers", joints->pointer().c_str());
    if (values.is_integer() &&
        !(values.normalized && (values.component_type == ComponentType::u8 ||
                                values.component_type == ComponentType::u16)))
      refuse(StatusCode::malformed_file, values.index,
             "%s: weights must be floats or normalised unsigned 8 or 16-bit integers",
             weights->pointer().c_str());
    sets.push_back({reading_.accessors.read_unsigned(slots), reading_.accessors.read_floats(values),
                    weight_format(values.component_type)});
  }
}

}  // namespace sunder::gltf
