// sunder-stress: seeded random and adversarial cases, the laws that they must keep, and for each
// case that breaks one the fewest steps that do.

#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <CLI/CLI.hpp>

#include "bench/stress/case_log.h"
#include "bench/stress/shrink.h"
#include "bench/stress/summary.h"
#include "bench/stress/trouble_tables.h"

namespace sunder::stress {
namespace {

struct Options {
  std::vector<std::string> families;
  std::uint64_t first = 0;
  RunLimits limits;
  std::string log, known, expected, plots;
  bool lists = false, summary = false, tables = false;
};

/// @return whether the program should go on.
bool parse(int count, char** arguments, Options& options, int& exit_code) {
  CLI::App app(
      "Tries seeded cases on the library and checks its laws. A case that breaks one is shrunk. "
      "Exit code 1: a law was broken.");
  app.add_option("--family", options.families, "Only these families (see --list)");
  app.add_option("--first", options.first, "Number of the first case");
  app.add_option("--cases", options.limits.cases,
                 "How many cases; without it, 5,000 or any "
                 "number within --seconds");
  app.add_option("--seconds", options.limits.seconds, "No case starts later");
  app.add_option("--workers", options.limits.workers, "Processes; default: one per core");
  app.add_option("--case-seconds", options.limits.seconds_of_case,
                 "A case that takes longer counts as a hang");
  app.add_option("--log", options.log,
                 "Appends a line of JSON per case; cases that it holds are not run again");
  app.add_option("--known", options.known,
                 "Runs only the cases of this file, with the steps that it names");
  app.add_option("--expect", options.expected,
                 "A log that another build wrote: its cases must have the same digests");
  app.add_option("--threads", threads_of_scenes, "Threads of each scene; default: 1 to 4 by seed");
  app.add_flag("--list", options.lists, "Lists the families");
  app.add_flag(
      "--tables", options.tables,
      "Prints errors and times against the size of the trouble, for docs/method/stability.md");
  app.add_option("--plots", options.plots, "Folder for the plots of --tables (SVG)")
      ->check(CLI::ExistingDirectory);
  app.add_flag("--summary", options.summary, "Ends with one JSON object");
  options.limits.workers = std::max(1u, std::thread::hardware_concurrency());
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error);
    return false;
  }
  if (options.limits.cases == 0 && options.limits.seconds <= 0) options.limits.cases = 5000;
  if (options.limits.workers < 1) options.limits.workers = 1;
  return true;
}

bool choose(const std::vector<std::string>& names, std::vector<const Family*>& chosen) {
  for (const std::string& name : names) {
    chosen.push_back(find_family(name));
    if (chosen.back() != nullptr) continue;
    std::fprintf(stderr, "sunder-stress: no family \"%s\"; see --list\n", name.c_str());
    return false;
  }
  if (names.empty())
    for (const Family& family : families()) chosen.push_back(&family);
  return true;
}

void print_failure(const Outcome& outcome, const Steps& steps) {
  std::printf("%s\n", to_line(outcome, steps).c_str());
  std::fflush(stdout);
}

int run_known(const Options& options) {
  const auto known = read_log(options.known);
  if (known.empty()) {
    std::fprintf(stderr, "sunder-stress: no case in \"%s\"\n", options.known.c_str());
    return 2;
  }
  int broken = 0;
  for (const auto& [named, steps] : known) {
    if (find_family(named.name.family) == nullptr) {
      std::fprintf(stderr, "sunder-stress: no family \"%s\"\n", named.name.family.c_str());
      return 2;
    }
    const Outcome outcome = run_apart(named.name, steps, options.limits.seconds_of_case);
    if (outcome.report.violations.empty()) continue;
    print_failure(outcome, steps);
    ++broken;
  }
  std::printf("%zu known cases, %d broken\n", known.size(), broken);
  return broken > 0 ? 1 : 0;
}

/// The digests of the cases of a log, by family and seed.
class Digests {
 public:
  explicit Digests(const std::string& log) {
    if (log.empty()) return;
    for (const auto& [outcome, steps] : read_log(log))
      of_case_[{outcome.name.family, outcome.name.seed}] = outcome.report.digest;
  }
  [[nodiscard]] std::size_t count() const { return of_case_.size(); }

  /// Adds a violation to a case with another digest.
  void compare(Outcome& outcome) {
    const auto at = of_case_.find({outcome.name.family, outcome.name.seed});
    if (at == of_case_.end()) return;
    ++compared;
    if (at->second != outcome.report.digest)
      outcome.report.violate("same bits in every build", "another digest than in the log");
  }
  std::uint64_t compared = 0;

 private:
  std::map<std::pair<std::string, std::uint64_t>, std::uint64_t> of_case_;
};

int run_new(const Options& options) {
  std::vector<const Family*> chosen;
  if (!choose(options.families, chosen)) return 2;
  Digests expected(options.expected);
  if (!options.expected.empty() && expected.count() == 0) {
    std::fprintf(stderr, "sunder-stress: no case in \"%s\"\n", options.expected.c_str());
    return 2;
  }
  Summary summary;
  std::set<std::tuple<std::string, std::uint64_t>> done;
  if (!options.log.empty())
    for (const auto& [outcome, steps] : read_log(options.log))
      if (find_family(outcome.name.family) != nullptr &&
          done.emplace(outcome.name.family, outcome.name.seed).second)
        summary.add(outcome);
  std::ofstream log;
  if (!options.log.empty()) {
    log.open(options.log, std::ios::app);
    if (!log) {
      std::fprintf(stderr, "sunder-stress: cannot write \"%s\"\n", options.log.c_str());
      return 2;
    }
  }
  std::vector<Outcome> failed;
  run_cases(
      chosen, options.first, options.limits,
      [&](const CaseName& name) {
        return done.contains({name.family, name.seed});
      },
      [&](Outcome outcome) {
        expected.compare(outcome);
        summary.add(outcome);
        if (log.is_open()) log << to_line(outcome) << std::endl;
        if (!outcome.report.violations.empty()) failed.push_back(outcome);
      });
  constexpr std::size_t kMostShrunk = 20;
  for (std::size_t i = 0; i < failed.size() && i < kMostShrunk; ++i)
    print_failure(failed[i], shrink(failed[i], options.limits.seconds_of_case));
  for (std::size_t i = kMostShrunk; i < failed.size(); ++i) print_failure(failed[i], {});
  summary.print_table();
  if (expected.count() > 0)
    std::printf("%llu digests compared\n", static_cast<unsigned long long>(expected.compared));
  if (options.summary) summary.print_json();
  return summary.is_clean() ? 0 : 1;
}

int run(int count, char** arguments) {
  Options options;
  int exit_code = 0;
  if (!parse(count, arguments, options, exit_code)) return exit_code;
  if (options.lists) {
    for (const Family& family : families())
      std::printf("%-12s %s\n", std::string(family.name).c_str(),
                  std::string(family.subject).c_str());
    return 0;
  }
  if (options.tables) {
    print_trouble_tables(options.plots);
    return 0;
  }
  return options.known.empty() ? run_new(options) : run_known(options);
}

}  // namespace
}  // namespace sunder::stress

int main(int count, char** arguments) { return sunder::stress::run(count, arguments); }
