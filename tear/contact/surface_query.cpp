#include <cmath>
#include <new>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "tear/contact/anchor.h"
#include "tear/contact/describe_contact.h"
#include "tear/contact/searches.h"
#include "tear/model/model_access.h"

namespace sunder {
namespace {

/// The figures by which a changed model is recognised.
struct Revision {
  const void* editor = nullptr;
  std::uint64_t newest_operation = 0;
  Index points = 0, triangles = 0, changes = 0;

  bool operator==(const Revision&) const = default;
};

Revision revision_of(const TornModel& model) {
  const auto& state = tear::ModelAccess::state_of(model);
  const tear::Surface& surface = state.editor.surface();
  return {&state.editor, model.newest_operation(), surface.point_count(), surface.triangle_count(),
          state.editor.log.numbers_since({})};
}

Status check_point(const Vec3d& point, const char* what) {
  if (!point.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "%s is not finite", what);
  if (point.cwiseAbs().maxCoeff() > tear::kFarthestMetres)
    return Status::failure(StatusCode::invalid_argument, kNone, "%s lies beyond 1e60", what);
  return {};
}

/// A distance may be infinite, a radius may not.
Status check_length(double length, double most, const char* what) {
  if (std::isnan(length))
    return Status::failure(StatusCode::non_finite_value, kNone, "%s is not a number", what);
  if (length < 0 || length > most)
    return Status::failure(StatusCode::invalid_argument, kNone, "%s is %g; it must be from 0 to %g",
                           what, length, most);
  return {};
}

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

Status check_ray(const Ray& ray) {
  if (Status status = check_point(ray.origin, "the origin of the ray"); !status) return status;
  if (Status status = check_point(ray.direction, "the direction of the ray"); !status)
    return status;
  if (!(norm(ray.direction) > tear::kShortestDirection))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the direction of the ray has no length");
  return check_length(ray.length, kAnyDistance, "the length of the ray");
}

Status check_capsule(const Capsule& capsule) {
  if (Status status = check_point(capsule.base, "the base of the capsule"); !status) return status;
  if (Status status = check_point(capsule.tip, "the tip of the capsule"); !status) return status;
  return check_length(capsule.radius, tear::kLongestMetres, "the radius of the capsule");
}

}  // namespace

struct SurfaceQuery::State {
  const TornModel* model = nullptr;
  std::shared_ptr<const Character> source;  ///< Of the trees.
  std::shared_ptr<const TornAsset> asset;   ///< Keeps them.
  tear::PosedPoints posed;
  std::optional<tear::PosedSurface> surface;
  Revision revision;
  bool interpolates_normals = false;
  std::vector<tear::FoundPlace> found;

  [[nodiscard]] Status check() const {
    if (!surface)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "the query has no pose; call set_pose() first");
    if (revision == revision_of(*model)) return {};
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the model changed since set_pose(); call it again");
  }

  Status set_pose(const ModelPose& pose, const ContactOptions& options) {
    if (Status status = model->unpack(); !status) return status;
    auto& of_model = tear::ModelAccess::state_of(*model);
    if (Status status = CharacterPose::check(of_model.character, pose); !status) return status;
    const Result<double> reach = tear::PosedSurface::reach_of(options, of_model.character);
    if (!reach) return reach.error();
    surface.reset();  // nothing fails from here on, unless memory runs out
    if (source != of_model.source || revision.editor != &of_model.editor) {
      use_trees();
    }
    if (Status status = posed.begin(of_model.character, pose); !status) return status;
    interpolates_normals = options.interpolates_normals;
    surface.emplace(of_model.editor, posed).set_options(options, *reach);
    revision = revision_of(*model);
    return {};
  }

  /// Starts with the trees of the model's asset. Only walls and caps get trees of the query.
  void use_trees() {
    posed = tear::PosedPoints();
    source = tear::ModelAccess::state_of(*model).source;
    asset = tear::ModelAccess::asset_of(*model);
    posed.forest().share(tear::ModelAccess::trees_of(*model));
    revision = {};
  }

  /// Runs a search, whose memory may not suffice.
  template <class Search>
  auto run(const Status& of_input, Search search) -> Result<decltype(search())> {
    if (!of_input) return of_input;
    if (Status status = check(); !status) return status;
    try {
      return search();
    } catch (const std::bad_alloc&) {
      return out_of_memory();
    }
  }

  [[nodiscard]] SurfaceContact describe(const tear::FoundPlace& at) {
    return tear::describe_place(at.face, at.barycentric, interpolates_normals, *surface);
  }
  [[nodiscard]] SurfaceContact describe_nearest(const Vec3d& from, double radius,
                                                const tear::FoundPlace& at);
};

SurfaceContact SurfaceQuery::State::describe_nearest(const Vec3d& from, double radius,
                                                     const tear::FoundPlace& at) {
  SurfaceContact contact = describe(at);
  contact.distance = std::sqrt(at.squared_distance);
  const bool is_below = dot(tear::outward_at(at, *surface), Vec3d(from - contact.place)) < 0;
  contact.depth = is_below ? radius + contact.distance : radius - contact.distance;
  return contact;
}

SurfaceQuery::SurfaceQuery(std::unique_ptr<State> state) : state_(std::move(state)) {}
SurfaceQuery::SurfaceQuery(SurfaceQuery&&) noexcept = default;
SurfaceQuery& SurfaceQuery::operator=(SurfaceQuery&&) noexcept = default;
SurfaceQuery::~SurfaceQuery() = default;

Result<SurfaceQuery> SurfaceQuery::create(const TornModel& model) {
  try {
    auto state = std::make_unique<State>();
    state->model = &model;
    if (Status status = model.unpack(); !status) return status;
    auto& of_model = tear::ModelAccess::state_of(model);
    state->use_trees();
    state->revision.editor = &of_model.editor;
    (void)state->posed.forest().trees(of_model.editor);
    return SurfaceQuery(std::move(state));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status SurfaceQuery::set_pose(const ModelPose& pose, const ContactOptions& options) {
  try {
    return state_->set_pose(pose, options);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<std::optional<SurfaceContact>> SurfaceQuery::cast_ray(const Ray& ray) {
  State& state = *state_;
  return state.run(check_ray(ray), [&]() -> std::optional<SurfaceContact> {
    const Vec3d way = normalized(ray.direction);
    const auto found = tear::first_on_line(ray.origin, way, ray.length, *state.surface);
    if (!found) return std::nullopt;
    SurfaceContact contact = state.describe(*found);
    contact.distance = found->along;
    contact.enters = found->enters;
    return contact;
  });
}

Status SurfaceQuery::find_blade_contacts(const Blade& blade,
                                         std::vector<SurfaceContact>& contacts) {
  State& state = *state_;
  const Vec3d way = blade.tip - blade.base;
  const auto done = state.run(validate_blade(blade, 0), [&] {
    tear::all_on_segment(blade.base, way, *state.surface, state.found);
    contacts.reserve(state.found.size());
    contacts.clear();
    for (const tear::FoundPlace& at : state.found) {
      SurfaceContact contact = state.describe(at);
      contact.distance = at.along * norm(way);
      contact.depth = dot(contact.normal, Vec3d(contact.place - blade.tip));
      contact.enters = at.enters;
      contacts.push_back(contact);
    }
    return true;
  });
  return done.error();
}

Result<std::optional<CapsuleContact>> SurfaceQuery::find_capsule_contact(const Capsule& capsule) {
  State& state = *state_;
  return state.run(check_capsule(capsule), [&]() -> std::optional<CapsuleContact> {
    const auto found = tear::nearest_to_segment(capsule.base, capsule.tip,
                                                capsule.radius * capsule.radius, *state.surface);
    if (!found) return std::nullopt;
    const Vec3d way = capsule.tip - capsule.base;
    CapsuleContact contact;
    contact.nearest =
        state.describe_nearest(capsule.base + found->along * way, capsule.radius, *found);
    contact.deepest = contact.nearest;
    // An axis that does not cross the surface is on one side of it.
    const bool is_above = contact.nearest.distance > 0 && contact.nearest.depth <= capsule.radius;
    if (way.isZero(0) || is_above) return contact;
    // From the end of the axis no place is farther than the axis is long and the contact away.
    const double reach = norm(way) + contact.nearest.distance;
    const double most = reach * reach * (1 + tear::kBoxSizes);
    for (const Vec3d& end : {capsule.base, capsule.tip}) {
      const auto of_end = tear::nearest_to_segment(end, end, most, *state.surface);
      if (!of_end) continue;
      const SurfaceContact at_end = state.describe_nearest(end, capsule.radius, *of_end);
      const bool is_below = at_end.depth > capsule.radius;
      if (is_below && at_end.depth > contact.deepest.depth) contact.deepest = at_end;
    }
    return contact;
  });
}

Result<std::optional<SurfaceContact>> SurfaceQuery::find_nearest(const Vec3d& point,
                                                                 double most_distance) {
  State& state = *state_;
  Status status = check_point(point, "the point");
  if (status) status = check_length(most_distance, kAnyDistance, "the distance");
  return state.run(status, [&]() -> std::optional<SurfaceContact> {
    const auto found =
        tear::nearest_to_segment(point, point, most_distance * most_distance, *state.surface);
    if (!found) return std::nullopt;
    return state.describe_nearest(point, 0, *found);
  });
}

Result<std::optional<SurfaceContact>> SurfaceQuery::locate(const SurfaceAnchor& anchor) {
  State& state = *state_;
  if (Status status = state.check(); !status) return status;
  const tear::SurfaceEditor& editor = state.surface->editor();
  if (Status status = tear::check_anchor(anchor, editor); !status) return status;
  return state.run({}, [&]() -> std::optional<SurfaceContact> {
    const auto found = tear::find_part(anchor, editor);
    if (!found) return std::nullopt;
    return state.describe(*found);
  });
}

std::size_t SurfaceQuery::memory_bytes() const {
  return sizeof(State) + state_->posed.bytes() +
         state_->found.capacity() * sizeof(tear::FoundPlace);
}

}  // namespace sunder
