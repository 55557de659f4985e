#include "tools/plan/curve_file.h"

#include <sunder/tear/torn_model.h>

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "tools/messages/json_file.h"
#include "tools/model/name_advice.h"

namespace sunder::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Status malformed(const std::string& place, const char* expected) {
  return Status::failure(StatusCode::malformed_file, kNone, "'%.80s': expected %s", place.c_str(),
                         expected);
}

Status check_members(const Json& object, const std::string& place,
                     std::initializer_list<std::string_view> known) {
  for (const auto& [name, value] : object.items())
    if (std::find(known.begin(), known.end(), name) == known.end())
      return Status::failure(StatusCode::malformed_file, kNone, "'%.80s/%.80s' is not known",
                             place.c_str(), name.c_str());
  return {};
}

/// An array of three finite numbers.
std::optional<std::array<double, 3>> three_numbers(const Json& json) {
  if (!json.is_array() || json.size() != 3) return {};
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!json[i].is_number()) return {};
    numbers[i] = json[i].get<double>();
    if (!std::isfinite(numbers[i])) return {};
  }
  return numbers;
}

class CurveReader {
 public:
  CurveReader(const Character& character, SurfaceQuery& query)
      : character_(character), query_(query) {}

  Result<WoundTarget> read(const Json& json) {
    if (!json.contains("sunder_curve") || json["sunder_curve"] != 1)
      return malformed("/sunder_curve", "the version, 1");
    if (const Status status =
            check_members(json, "", {"sunder_curve", "places", "closed", "depth", "angle", "gape"});
        !status)
      return status;
    if (!json.contains("places") || !json["places"].is_array())
      return malformed("/places", "an array of places");
    for (const Json& place : json["places"])
      if (const Status status = read_place(place); !status) return status;
    if (json.contains("closed")) {
      if (!json["closed"].is_boolean()) return malformed("/closed", "true or false");
      target_.is_closed = json["closed"].get<bool>();
    }
    if (const Status status = read_profile(json, "depth", 1, target_.depth); !status) return status;
    if (const Status status = read_profile(json, "angle", kDegree, target_.angle); !status)
      return status;
    if (const Status status = read_profile(json, "gape", 1, target_.gape); !status) return status;
    return std::move(target_);
  }

 private:
  static Status read_profile(const Json& json, const char* name, double unit,
                             std::vector<double>& profile) {
    if (!json.contains(name)) return {};
    const std::string place = std::string("/") + name;
    const Json& value = json[name];
    profile.clear();
    if (value.is_number()) {
      profile.push_back(unit * value.get<double>());
      return {};
    }
    if (!value.is_array()) return malformed(place, "a number, or one per place");
    for (const Json& number : value) {
      if (!number.is_number()) return malformed(place, "a number, or one per place");
      profile.push_back(unit * number.get<double>());
    }
    return {};
  }

  Status read_place(const Json& json) {
    const std::string place = "/places/" + std::to_string(target_.places.size());
    if (!json.is_object()) return malformed(place, "an object");
    if (json.contains("point")) return read_point(json, place);
    if (const Status status = check_members(json, place, {"mesh", "triangle", "barycentric"});
        !status)
      return status;
    SurfaceAnchor anchor;
    if (json.contains("mesh"))
      if (const Status status = read_mesh(json["mesh"], place, anchor.mesh); !status) return status;
    if (!json.contains("triangle") || !json["triangle"].is_number_unsigned() ||
        json["triangle"].get<std::uint64_t>() >= kNone)
      return malformed(place + "/triangle", "the index of a triangle");
    anchor.birth.triangle = json["triangle"].get<std::uint32_t>();
    const auto shares = three_numbers(json.value("barycentric", Json()));
    if (!shares) return malformed(place + "/barycentric", "three numbers");
    anchor.birth.barycentric = *shares;
    target_.places.push_back(anchor);
    return {};
  }

  Status read_mesh(const Json& json, const std::string& place, std::uint32_t& mesh) const {
    if (json.is_number_unsigned() && json.get<std::uint64_t>() < kNone) {
      mesh = json.get<std::uint32_t>();
      return {};
    }
    if (!json.is_string()) return malformed(place + "/mesh", "the name or the index of a mesh");
    const std::string name = json.get<std::string>();
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < character_.meshes.size(); ++i) {
      names.push_back(character_.meshes[i].name);
      if (names.back() != name) continue;
      mesh = i;
      return {};
    }
    return Status::failure(StatusCode::not_found, kNone, "'%.80s/mesh': no mesh '%.80s'%.160s",
                           place.c_str(), name.c_str(), name_advice(name, "meshes", names).c_str());
  }

  Status read_point(const Json& json, const std::string& place) {
    if (const Status status = check_members(json, place, {"point"}); !status) return status;
    const auto point = three_numbers(json["point"]);
    if (!point) return malformed(place + "/point", "three numbers");
    const auto found = query_.find_nearest(Vec3d((*point)[0], (*point)[1], (*point)[2]));
    if (!found) return found.error();
    if (!found->has_value())
      return Status::failure(StatusCode::not_found, kNone, "'%.80s': the model has no surface",
                             place.c_str());
    target_.places.push_back((*found)->anchor);
    return {};
  }

  const Character& character_;
  SurfaceQuery& query_;
  WoundTarget target_;
};

}  // namespace

Result<WoundTarget> read_curve(const std::filesystem::path& file,
                               const std::shared_ptr<const Character>& character,
                               const ModelPose& pose) {
  const Result<Json> json = read_json_object(file);
  if (!json) return json.error();
  const Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  Result<SurfaceQuery> query = SurfaceQuery::create(*model);
  if (!query) return query.error();
  if (const Status status = query->set_pose(pose); !status) return status;
  return CurveReader(*character, *query).read(*json);
}

}  // namespace sunder::tools
