#include "tools/validate/validate.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <unistd.h>

#include "tools/messages/json_file.h"
#include "tools/messages/lines.h"
#include "tools/messages/messages.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/text_file.h"
#include "tools/page_parts/page_file.h"
#include "tools/validate/validate_page.h"
#include "tools/validation_page/write_page.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

/// One comparison of a run, with the files that it writes.
struct Job {
  ValidatePair pair;
  std::optional<std::filesystem::path> report, html;
};

TargetProfile profile_named(const std::string& name) {
  constexpr std::pair<const char*, TargetProfile> kProfiles[] = {
      {"unity4", TargetProfile::unity4},
      {"unreal8", TargetProfile::unreal8},
      {"gltf4", TargetProfile::gltf4},
      {"gltf8", TargetProfile::gltf8},
      {"webxr", TargetProfile::webxr}};
  for (const auto& [of, profile] : kProfiles)
    if (name == of) return profile;
  return TargetProfile::none;
}

/// Prints results and progress of jobs that run at the same time, whole lines at a time.
class Output {
 public:
  Output(const ValidateRequest& request, Severity fail_on) : request_(request), fail_on_(fail_on) {}

  void progress(const Job& job, std::string_view stage, double share) {
    if (!request_.as_json_lines) return;
    line({{"event", "stage"},
          {"target", job.pair.target.string()},
          {"stage", stage},
          {"share", share}});
  }
  void result(const Job& job, const ValidatedPair& pair) {
    if (!request_.as_json_lines) {
      const std::scoped_lock lock(mutex_);
      print(validation_text(pair, fail_on_, is_in_colour(STDOUT_FILENO)));
      return;
    }
    const auto count = [&](Severity severity) {
      return std::ranges::count(pair.report.findings, severity, &Finding::severity);
    };
    line({{"event", "result"},
          {"target", job.pair.target.string()},
          {"errors", count(Severity::error)},
          {"warnings", count(Severity::warning)},
          {"notes", count(Severity::note)}});
  }
  ExitCode failure(const Job& job, const ValidateFailure& failure) {
    if (request_.as_json_lines)
      line({{"event", "failure"},
            {"target", job.pair.target.string()},
            {"place", failure.place},
            {"text", failure_text(failure.place, failure.status)}});
    const std::scoped_lock lock(mutex_);
    return complain(failure.place, failure.status, failure.otherwise);
  }

 private:
  void line(const Json& json) {
    const std::scoped_lock lock(mutex_);
    print_json_line(json);
  }

  const ValidateRequest& request_;
  Severity fail_on_;
  std::mutex mutex_;
};

ExitCode run_job(const Job& job, Severity fail_on, Budget& budget, Output& output) {
  ValidateFailure failure;
  const auto pair = validate_pair(
      job.pair, [&](std::string_view stage, double share) { output.progress(job, stage, share); },
      budget, failure);
  const Budget::Writing writing(budget);
  if (!pair) return output.failure(job, failure);
  if (job.report)
    if (const Status status = write_text(*job.report, dump(validation_json(*pair))); !status)
      return output.failure(job, {job.report->string(), status, ExitCode::unreadable_input});
  if (job.html)
    if (const Status status = write_validation_page(*job.html, page_input(*pair)); !status)
      return output.failure(job, {job.html->string(), status, ExitCode::unreadable_input});
  output.result(job, *pair);
  return has_findings(pair->report, fail_on) ? ExitCode::findings : ExitCode::ok;
}

/// A member of a pair in a manifest that names a file; relative to the manifest.
std::optional<std::filesystem::path> file_of(const Json& pair, const char* name,
                                             const std::filesystem::path& folder) {
  const auto found = pair.find(name);
  if (found == pair.end() || !found->is_string()) return {};
  return folder / found->get<std::string>();
}

/// {"pairs": [{"source": …, "target": …, "ops": …, "bone_names": …, "profile": …, "limits": …,
/// "report": …, "html": …}]}
Status read_manifest(const std::filesystem::path& file, const ValidateRequest& request,
                     std::vector<Job>& jobs) {
  const Result<Json> json = read_json_object(file);
  if (!json) return json.error();
  const auto pairs = json->find("pairs");
  if (pairs == json->end() || !pairs->is_array())
    return Status::failure(StatusCode::malformed_file, kNone, "/pairs: expected an array");
  const std::filesystem::path folder = file.parent_path();
  for (const Json& pair : *pairs) {
    const auto index = static_cast<std::uint32_t>(jobs.size());
    const auto source = file_of(pair, "source", folder), target = file_of(pair, "target", folder);
    if (!pair.is_object() || !source || !target)
      return Status::failure(StatusCode::malformed_file, index,
                             "/pairs/%u: expected source and target", index);
    Job job{{*source, *target, file_of(pair, "ops", folder), file_of(pair, "bone_names", folder),
             profile_named(request.profile), request.limits, false, request.reading,
             request.error_deviation},
            file_of(pair, "report", folder),
            file_of(pair, "html", folder)};
    if (const auto profile = pair.find("profile"); profile != pair.end() && profile->is_string())
      job.pair.profile = profile_named(profile->get<std::string>());
    if (const auto limits = pair.find("limits"); limits != pair.end() && limits->is_string()) {
      job.pair.limits = limits->get<std::string>();
      if (job.pair.limits != "none" && job.pair.limits != "clips")
        job.pair.limits = (folder / job.pair.limits).string();
    }
    jobs.push_back(std::move(job));
  }
  return {};
}

/// Runs all jobs, some at a time. @return the greatest exit code.
ExitCode run_jobs(const std::vector<Job>& jobs, unsigned threads, Severity fail_on, Budget& budget,
                  Output& output) {
  std::atomic<std::size_t> next = 0;
  std::atomic<int> worst = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      const int code = static_cast<int>(run_job(jobs[i], fail_on, budget, output));
      int seen = worst.load();
      while (code > seen && !worst.compare_exchange_weak(seen, code)) {
      }
    }
  };
  std::vector<std::thread> others;
  for (unsigned i = 1; i < std::min<std::size_t>(threads, jobs.size()); ++i)
    others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  return static_cast<ExitCode>(worst.load());
}

/// The first output of a pair that would overwrite an input or the other output; empty if none
/// does.
std::string overwriting_output(const Job& job,
                               const std::optional<std::filesystem::path>& manifest) {
  std::vector<NamedFile> inputs = {{"SOURCE", job.pair.source}, {"TARGET", job.pair.target}},
                         outputs;
  if (manifest) inputs.push_back({"--manifest", *manifest});
  if (job.pair.operations) inputs.push_back({"--ops", *job.pair.operations});
  if (job.pair.bone_names) inputs.push_back({"--bone-names", *job.pair.bone_names});
  if (job.report) outputs.push_back({"--report", *job.report});
  if (job.html) outputs.push_back({"--html", *job.html});
  return overwriting(inputs, outputs);
}

}  // namespace

ExitCode run_validate(const ValidateRequest& request) {
  const Severity fail_on = request.fail_on == "note"      ? Severity::note
                           : request.fail_on == "warning" ? Severity::warning
                                                          : Severity::error;
  Budget budget(request.budget, (request.manifest ? *request.manifest : request.target).string());
  std::vector<Job> jobs;
  if (request.manifest) {
    if (const Status status = read_manifest(*request.manifest, request, jobs); !status)
      return complain(request.manifest->string(), status, ExitCode::usage);
    budget.allow_each(jobs.size());
  } else {
    jobs.push_back({{request.source, request.target, request.operations, request.bone_names,
                     profile_named(request.profile), request.limits, false, request.reading,
                     request.error_deviation},
                    request.report,
                    request.html});
  }
  for (Job& job : jobs) {
    if (const std::string fault = overwriting_output(job, request.manifest); !fault.empty()) {
      print_error("sunder: " + fault);
      return ExitCode::usage;
    }
    if (!job.html) continue;
    job.pair.over_time = true;
    if (const Status status = has_pages(); !status)
      return complain("--html", status, ExitCode::usage);
  }
  Output output(request, fail_on);
  return run_jobs(jobs, request.jobs, fail_on, budget, output);
}

}  // namespace sunder::tools
