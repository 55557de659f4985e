#include "tools/plan/plan_report.h"

#include <cmath>
#include <numbers>

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

const char* kind_name(PlanObstacle::Kind kind) {
  switch (kind) {
    case PlanObstacle::Kind::joint_limit: return "joint_limit";
    case PlanObstacle::Kind::joint_speed: return "joint_speed";
    case PlanObstacle::Kind::acceleration: return "acceleration";
    case PlanObstacle::Kind::collision: return "collision";
    case PlanObstacle::Kind::self_collision: return "self_collision";
    case PlanObstacle::Kind::wound: return "wound";
    case PlanObstacle::Kind::reach: break;
  }
  return "reach";
}

/// Infinity is null in JSON.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json value_json(const ValueMargin& margin) {
  return {{"name", margin.name},
          {"least", margin.least},
          {"greatest", margin.greatest},
          {"to_limits", number(margin.to_limits)},
          {"greatest_speed", margin.greatest_speed},
          {"speed_limit", margin.speed_limit > 0 ? Json(margin.speed_limit) : Json()},
          {"greatest_acceleration", margin.greatest_acceleration}};
}

Json error_json(double most, double mean) { return {{"most", most}, {"mean", mean}}; }

Json gape_json(const PlannedGape& gape) {
  Json json = {{"tension", gape.tension}, {"widest", gape.widest}};
  if (gape.tension_shares.empty()) return json;
  json["tension_shares"] = gape.tension_shares;
  json["gape_along"] = gape.gape_along;
  json["wanted_along"] = gape.wanted_along;
  json["most_error"] = gape.most_error;
  return json;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

}  // namespace

std::string obstacle_text(const PlanObstacle& obstacle) {
  const std::string name = obstacle.value;
  const double at = 100 * obstacle.at;
  switch (obstacle.kind) {
    case PlanObstacle::Kind::joint_limit:
      return printed("'%s' would have to leave its limits at %.0f %% of the curve", name.c_str(),
                     at);
    case PlanObstacle::Kind::joint_speed:
      return printed("'%s' is too slow at %.0f %% of the curve", name.c_str(), at);
    case PlanObstacle::Kind::acceleration:
      return printed("'%s' would have to accelerate too much at %.0f %% of the curve", name.c_str(),
                     at);
    case PlanObstacle::Kind::collision:
      return printed("link '%s' would be inside the model at %.0f %% of the curve", name.c_str(),
                     at);
    case PlanObstacle::Kind::self_collision:
      return printed("links '%s' and '%s' would be inside one another at %.0f %% of the curve",
                     name.c_str(), obstacle.other.c_str(), at);
    case PlanObstacle::Kind::wound:
      return printed(
          "joints follow the curve, but the tear leaves it at %.0f %%: the blade meets "
          "other parts of the surface, or the surface is not connected there",
          at);
    case PlanObstacle::Kind::reach: break;
  }
  return printed("%.0f %% of the curve is out of reach", at);
}

Vec3d place_of_base(const PlanRequest& request, const PlannedBase& base) {
  return request.robot.place.translation() + base.moved;
}

Json plan_json(const PlanRequest& request, const PlanReport& report,
               const std::optional<PlannedBase>& base) {
  Json json = {{"sunder_plan", 1},
               {"model", request.model.string()},
               {"curve", request.like.value_or(request.curve).string()},
               {"robot", (request.hand ? *request.hand : request.robot.robot).string()},
               {"pose", request.robot.pose},
               {"clip_speed", request.robot.clip_speed},
               {"curve_length", report.curve_length},
               {"tolerance", report.tolerance},
               {"is_reachable", report.is_reachable},
               {"reached_part", {report.first_share, report.last_share}}};
  Json& obstacles = json["obstacles"] = Json::array();
  for (const PlanObstacle& obstacle : report.obstacles)
    obstacles.push_back({{"kind", kind_name(obstacle.kind)},
                         {"value", obstacle.value.empty() ? Json() : Json(obstacle.value)},
                         {"other", obstacle.other.empty() ? Json() : Json(obstacle.other)},
                         {"at", obstacle.at}});
  if (base) {
    const Vec3d place = place_of_base(request, *base);
    json["base"] = {{"moved", {base->moved.x(), base->moved.y(), base->moved.z()}},
                    {"robot_place", {place.x(), place.y(), place.z()}}};
  }
  if (!report.is_reachable) return json;
  json["cut"] = {{"seconds", report.cut}, {"begins", report.cut_begins}, {"ends", report.cut_ends}};
  json["place_error"] = error_json(report.most_place_error, report.mean_place_error);
  json["depth_error"] = error_json(report.most_depth_error, report.mean_depth_error);
  json["angle_error"] =
      error_json(degrees(report.most_angle_error), degrees(report.mean_angle_error));
  json["least_clearance"] = number(report.least_clearance);
  json["least_self_clearance"] = number(report.least_self_clearance);
  json["lips"] = {{"hausdorff", number(report.hausdorff)},
                  {"mean_distance", number(report.mean_distance)},
                  {"hausdorff_in_clips", number(report.hausdorff_in_clips)}};
  if (report.gape) json["gape"] = gape_json(*report.gape);
  Json& values = json["values"] = Json::array();
  for (const ValueMargin& margin : report.values) values.push_back(value_json(margin));
  return json;
}

std::string plan_summary(const PlanReport& report) {
  std::string text =
      printed("curve       %.4g m, tolerance %.3g m\n", report.curve_length, report.tolerance);
  if (!report.is_reachable) {
    text += report.last_share > report.first_share
                ? printed("reachable   from %.0f %% to %.0f %% of the curve\n",
                          100 * report.first_share, 100 * report.last_share)
                : std::string("reachable   no part of the curve\n");
    return text;
  }
  text += printed("cut         %.4g s, from %.4g s on\n", report.cut, report.cut_begins);
  text +=
      printed("lips        at most %.3g m from the curve, %.3g m on average; in all clips %.3g m\n",
              report.hausdorff, report.mean_distance, report.hausdorff_in_clips);
  text += printed("depth       off by %.3g m at most, %.3g m on average\n", report.most_depth_error,
                  report.mean_depth_error);
  text += printed("angle       off by %.3g degrees at most, %.3g on average\n",
                  degrees(report.most_angle_error), degrees(report.mean_angle_error));
  if (report.gape)
    text += printed("gape        %.3g m under a tension of %.4g N/m\n", report.gape->widest,
                    report.gape->tension);
  if (report.gape && !report.gape->tension_shares.empty())
    text += printed("            off by %.3g m at most along the curve\n", report.gape->most_error);
  if (std::isfinite(report.least_clearance))
    text += printed("links       at least %.3g m from the model\n", report.least_clearance);
  if (std::isfinite(report.least_self_clearance))
    text += printed("links       at least %.3g m from one another\n", report.least_self_clearance);
  for (const ValueMargin& margin : report.values) {
    text += printed("%-11s %.4g to %.4g", margin.name.c_str(), margin.least, margin.greatest);
    if (std::isfinite(margin.to_limits)) text += printed(", %.3g to its limits", margin.to_limits);
    text += printed("; %.3g a second", margin.greatest_speed);
    if (margin.speed_limit > 0) text += printed(" of %.3g", margin.speed_limit);
    text += '\n';
  }
  return text;
}

}  // namespace sunder::tools
