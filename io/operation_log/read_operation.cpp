#include "io/operation_log/read_operation.h"

#include <string>
#include <utility>

#include "core/operation/internal/describe_aimed.h"
#include "io/operation_log/read_fields.h"

namespace sunder::operation_log {

void check_read(const Place& place, const Blade& blade) {
  if (blade.base == blade.tip) place.malformed("base and tip of a blade must differ");
}

void check_read(const Place& place, const WeightOptions& options) {
  if (options.policy == WeightPolicy::exact && options.maximum_influences != 0)
    place.at("influences")
        .malformed("the policy 'exact' keeps all influences: leave this out or set it to 0");
}

void check_read(const Place& place, const JointLimit& limit) {
  if (limit.lower > limit.upper) place.malformed("'lower' is above 'upper'");
}

void check_read(const Place& place, const SeverOperation&) {
  if (place.has("from") && !place.has("tilt"))
    place.at("from").malformed("without a tilt the direction has no meaning");
}

void read_value(const Place& place, const Field&, Stroke& stroke,
                const Blades<std::vector<TearOperation::PoseChange>>& kind) {
  const std::size_t count = read_array(place, "an array of blades").size();
  if (count < 2) place.malformed("a stroke needs at least two blades");
  stroke.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Place blade = place.at(i);
    read_fields(blade, stroke.emplace_back(), {"pose"});
    if (!blade.has("pose")) continue;
    if (i == 0)
      blade.at("pose").malformed(
          "the first blade cannot have a pose; give it as the operation's 'pose'");
    kind.pose_changes->push_back({i, read_pose(blade.at("pose"))});
  }
}

void read_value(const Place& place, const Field&, PiecePlace& piece) {
  if (!place.value.is_object()) place.expected("an object");
  if (place.has("near"))
    read_fields(place, piece.emplace<PieceNear>());
  else
    read_fields(place, piece.emplace<PieceOfTriangle>());
}

namespace {

/// Of a log: an operation takes up to a hundred times the memory of its text.
constexpr std::size_t kMaximumOperations = 1'000'000;

std::string read_kind(const Place& place) {
  if (!place.value.is_object()) place.expected("an object");
  return read_name(place.at("op"));
}

template <class T>
T read_one(const Place& place) {
  T operation;
  read_fields(place, operation, {"op"});
  return operation;
}

/// The operations of a variant by their names.
template <class Operations>
struct Kinds;
template <class... Kind>
struct Kinds<std::variant<Kind...>> {
  using Operations = std::variant<Kind...>;

  static bool has(const std::string& name) { return ((name == kOpName<Kind>) || ...); }
  /// Empty if there is none of that name.
  static std::optional<Operations> read(const Place& place, const std::string& name) {
    std::optional<Operations> operation;
    static_cast<void>(
        ((name == kOpName<Kind> && (operation.emplace(read_one<Kind>(place)), true)) || ...));
    return operation;
  }
  /// "tear, cut, or undo"
  static std::string listed() {
    std::string text;
    std::size_t left = sizeof...(Kind);
    ((text += std::string(text.empty() ? ""
                          : left == 1  ? " or "
                                       : ", ") +
              kOpName<Kind>,
      --left),
     ...);
    return text;
  }
};

Operation read_operation(const Place& place) {
  const std::string name = read_kind(place);
  if (auto operation = Kinds<Operation>::read(place, name)) return std::move(*operation);
  if (Kinds<AimedOperation>::has(name))
    place.at("op").fail(
        StatusCode::unsupported_feature,
        "'" + name + "' needs a model to be resolved; only plain operations are read here");
  place.at("op").fail(StatusCode::unsupported_feature,
                      "unknown operation '" + name + "'; expected " + Kinds<Operation>::listed());
}

LoggedOperation read_logged_operation(const Place& place) {
  if (auto aimed = Kinds<AimedOperation>::read(place, read_kind(place))) return std::move(*aimed);
  return read_operation(place);
}

/// Reads all entries of a log. @param read  reads one.
template <class Read>
auto read_entries(const Json& log, const Character* model, Read read) {
  const Place root{log, "", kNone, model};
  if (!log.is_object()) root.expected("an object");
  // The version is checked first, so that a log of another version is reported as such.
  const Place version = root.at("sunder_operations");
  if (!version.value.is_number_integer()) version.expected("the version, an integer");
  if (version.value != 1)
    version.fail(StatusCode::unsupported_feature,
                 "version " + version.value.dump() + "; this build reads version 1");
  root.check_fields({"sunder_operations", "operations"});

  const Place list = root.at("operations");
  std::vector<decltype(read(list))> entries;
  if (const std::size_t count = read_array(list, "an array").size(); count > kMaximumOperations)
    list.fail(StatusCode::limit_exceeded, std::to_string(count) + " operations; the limit is " +
                                              std::to_string(kMaximumOperations));
  entries.reserve(list.value.size());
  for (std::size_t i = 0; i < list.value.size(); ++i) {
    Place one = list.at(i);
    one.operation = static_cast<std::uint32_t>(i);
    entries.push_back(read(one));
  }
  return entries;
}

}  // namespace

std::vector<Operation> read_log(const Json& log, const Character* model) {
  return read_entries(log, model, read_operation);
}

std::vector<LoggedOperation> read_aimed_log(const Json& log, const Character* model) {
  return read_entries(log, model, read_logged_operation);
}

}  // namespace sunder::operation_log
