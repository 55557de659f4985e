#include <algorithm>
#include <utility>

#include "tools/messages/messages.h"
#include "tools/model/bone_names.h"
#include "tools/model/load_notes.h"
#include "tools/model/plain_operations.h"
#include "tools/model/robot_joints.h"
#include "tools/validate/validate.h"
#include "tools/written_weights/joint_limits_file.h"

namespace sunder::tools {
namespace {

constexpr std::uint32_t kPairTimesPerClip = 240;

/// Notes about weights: what the file stores is judged itself.
bool is_about_weights(const LoadNote& note) {
  for (const char* const text :
       {"weights", "joints named twice", "influences named joints", "vertices without weight"})
    if (note.text.find(text) != std::string::npos) return true;
  return false;
}

const FindingKind& kind_named(std::string_view code) {
  return *std::ranges::find(finding_kinds(), code, &FindingKind::code);
}

/// Findings for what loading the target repaired or dropped; a note where loading the source did
/// the same.
void add_load_notes(ValidatedPair& pair) {
  const bool stored = !pair.target.stored.empty();
  for (const LoadNote& note : pair.target.report.notes) {
    if (!is_change(note) || (stored && is_about_weights(note))) continue;
    const bool repaired = note.kind == LoadNote::Kind::repaired;
    const FindingKind& kind = kind_named(repaired ? "SUNDER_W_REPAIRED" : "SUNDER_W_DROPPED");
    const bool inherited =
        std::ranges::any_of(pair.source.report.notes, [&](const LoadNote& other) {
          return other.kind == note.kind && other.text == note.text && other.count >= note.count;
        });
    Finding finding;
    finding.code = kind.code;
    finding.severity = inherited ? Severity::note : kind.severity;
    finding.text = std::to_string(note.count) + ": " + note.place + ": " + note.text + "." +
                   (inherited ? " Inherited: the source has the same." : "");
    finding.advice = kind.advice;
    finding.value = note.count;
    finding.unit = kind.unit;
    finding.count = note.count;
    const auto after = std::ranges::find_if(pair.report.findings, [&](const Finding& other) {
      return other.severity < finding.severity;
    });
    pair.report.findings.insert(after, std::move(finding));
  }
  for (CodeVerdict& verdict : pair.report.verdicts)
    if (verdict.code == "SUNDER_W_REPAIRED" || verdict.code == "SUNDER_W_DROPPED") {
      const bool fails = std::ranges::any_of(pair.report.findings, [&](const Finding& finding) {
        return finding.code == verdict.code && finding.severity > Severity::note;
      });
      verdict = {verdict.code, fails ? Verdict::fail : Verdict::pass, {}};
    }
}

std::optional<LoadedCharacter> load(const std::filesystem::path& file, const ValidatePair& pair,
                                    ValidateFailure& failure) {
  LoadOptions options = load_options(pair.reading);
  options.keep_stored_influences = true;
  Result<LoadedCharacter> loaded = load_character(file, options);
  if (loaded) {
    warn_of_protection(file.string(), loaded->report, Messages(Verbosity::normal));
    return std::move(*loaded);
  }
  failure = {file.string(), loaded.error(), ExitCode::unreadable_input};
  return {};
}

/// Fills the options from the files that the command line names.
bool read_options(const ValidatePair& pair, const std::shared_ptr<const Character>& character,
                  std::vector<Operation>& operations, ValidationOptions& options, Budget& budget,
                  ValidateFailure& failure) {
  if (pair.operations) {
    Result<std::vector<Operation>> log = load_plain_operations(*pair.operations, character, budget);
    if (!log) failure = {pair.operations->string(), log.error(), ExitCode::usage};
    if (!log) return false;
    operations = std::move(*log);
    options.operations = operations;
  }
  if (pair.bone_names) {
    Result<std::vector<BoneNames>> names = read_bone_names(*pair.bone_names);
    if (!names) failure = {pair.bone_names->string(), names.error(), ExitCode::usage};
    if (!names) return false;
    options.bone_names = std::move(*names);
  }
  const bool has_own_limits = pair.limits == "none" && is_urdf(pair.source);
  if (pair.limits == "none" && !has_own_limits) return true;
  if (pair.limits == "clips") {
    options.limits_from = LimitsFrom::clips;
    return true;
  }
  const std::string file = has_own_limits ? pair.source.string() : pair.limits;
  Result<JointLimits> limits = read_joint_limits(file, *character);
  if (!limits) failure = {file, limits.error(), ExitCode::usage};
  if (!limits) return false;
  options.limits_from = LimitsFrom::given;
  options.limits = std::move(*limits);
  return true;
}

}  // namespace

std::optional<ValidatedPair> validate_pair(
    const ValidatePair& pair, const std::function<void(std::string_view, double)>& progress,
    Budget& budget, ValidateFailure& failure) {
  budget.begin(pair.target.string());
  auto source = load(pair.source, pair, failure);
  if (!source) return {};
  auto target = load(pair.target, pair, failure);
  if (!target) return {};
  ValidationOptions options;
  options.stored_source = source->stored;
  options.stored_target = target->stored;
  options.profile = pair.profile;
  options.error_deviation = pair.error_deviation;
  if (pair.over_time) options.times_per_clip = kPairTimesPerClip;
  options.progress = progress;
  std::vector<Operation> operations;
  if (!read_options(pair, source->character, operations, options, budget, failure)) return {};
  budget.begin(pair.target.string());
  Result<ValidationReport> report = validate_skin(source->character, target->character, options);
  if (!report) {
    failure = {pair.target.string(), report.error(), ExitCode::usage};
    return {};
  }
  ValidatedPair result{pair.source, pair.target, std::move(*source), std::move(*target),
                       std::move(*report)};
  add_load_notes(result);
  return result;
}

bool has_findings(const ValidationReport& report, Severity severity) {
  return std::ranges::any_of(report.findings,
                             [&](const Finding& finding) { return finding.severity >= severity; });
}

}  // namespace sunder::tools
