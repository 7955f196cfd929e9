// The campaign in one process a job: episodes by seed, played on simulated servos, judged by their
// memory. Exit status 1 if something was found.

#include "campaign.hpp"
#include "line_runs.hpp"
#include "results.hpp"
#include "sweep.hpp"
#include "tries.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace blactl::campaign;
using nlohmann::json;

namespace {

struct Options {
  std::uint64_t seed = 1;
  std::uint64_t episodes = 1000;
  unsigned jobs = 1;
  bool verbose = false;
  bool frozen = false; ///< prints the episodes, a line each, for campaign.py
  bool until_found = false;
  std::string results{};
  std::size_t sweep = 0; ///< every n-th place; 0: no sweep
  std::string only{};    ///< one kind of disturbance
  std::uint64_t stories = 0;
  std::uint64_t lines = 0; ///< of production; with a sweep of them
};

/// Commands run in this process, and nothing of the caller may get into them.
void prepare(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const char* variable : {"BLACTL_STATE", "BLACTL_INTERFACE", "BLACTL_LANG", "NO_COLOR"}) {
    unsetenv(variable);
  }
  setenv("LC_ALL", "C.UTF-8", 1);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
}

std::uint64_t watched = 0;

/// An episode takes some milliseconds: one that takes a minute hangs.
void watch(std::uint64_t seed) {
  constexpr unsigned patience_s = 60;
  watched = seed;
  struct sigaction action{};
  action.sa_handler = [](int) { // NOLINT: the macro casts
    std::fprintf(stderr, "episode %llu: hangs\n", static_cast<unsigned long long>(watched));
    _exit(3);
  };
  sigaction(SIGALRM, &action, nullptr);
  alarm(patience_s);
}

void tell(const std::string& text) {
  std::fputs((text + "\n").c_str(), stdout);
  std::fflush(stdout);
}

/// Every `jobs`-th seed from that of this job.
json play(const Options& options, unsigned job, const std::filesystem::path& folder) {
  Campaign campaign(folder / "episode", tell, options.verbose);
  for (std::uint64_t i = job; i < options.episodes; i += options.jobs) {
    watch(options.seed + i);
    campaign.play(make_episode(options.seed + i));
    if (options.until_found && campaign.has_found()) {
      break;
    }
  }
  alarm(0);
  return to_json(campaign.counts());
}

json sweep(const Options& options, unsigned job, const std::filesystem::path& folder) {
  Sweep all(folder / "case",
            {.step = options.sweep,
             .only = options.only,
             .until_found = options.until_found,
             .job = job,
             .jobs = options.jobs,
             .begins = [] { watch(0); }},
            tell);
  all.play();
  return to_json(all.swept());
}

json tell_stories(const Options& options, unsigned job, const std::filesystem::path& folder) {
  Tries tries(folder / "story", tell);
  for (std::uint64_t i = job; i < options.stories; i += options.jobs) {
    watch(options.seed + i);
    tries.play(options.seed + i);
    if (options.until_found && tries.counts().lies > 0) {
      break;
    }
  }
  alarm(0);
  const Tries::Counts& counts = tries.counts();
  return {counts.stories, counts.undone, counts.lies};
}

json play_lines(const Options& options, unsigned job, const std::filesystem::path& folder) {
  LineRuns runs(folder / "line", tell, options.verbose);
  const LineRuns::Sweep each{.step = options.sweep,
                             .job = job,
                             .jobs = options.jobs,
                             .until_found = options.until_found,
                             .begins = [] { watch(0); }};
  for (std::uint64_t i = 0; i < options.lines; ++i) {
    if (options.until_found && runs.counts().lies > 0) {
      break;
    }
    if (options.sweep > 0) {
      runs.play_each(options.seed + i, each);
    } else if (i % options.jobs == job) {
      watch(options.seed + i);
      runs.play(options.seed + i);
    }
  }
  alarm(0);
  const LineRuns::Counts& counts = runs.counts();
  return {{"runs", counts.runs}, {"lies", counts.lies}, {"records", counts.records}};
}

/// In a process each, since commands use what a process has once; a crash gives null.
std::vector<json> in_jobs(const Options& options) {
  const auto work = [&](unsigned job, const std::filesystem::path& folder) {
    prepare(folder);
    json told = options.lines > 0     ? play_lines(options, job, folder)
                : options.stories > 0 ? tell_stories(options, job, folder)
                : options.sweep > 0   ? sweep(options, job, folder)
                                      : play(options, job, folder);
    std::filesystem::remove_all(folder);
    return told;
  };
  const std::filesystem::path memory = "/dev/shm";
  const std::string base =
      ((std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path()) /
       fmt::format("blactl-campaign-{}", getpid()))
          .string();
  if (options.jobs == 1) {
    return {work(0, base)};
  }
  std::vector<pid_t> children;
  for (unsigned job = 0; job < options.jobs; ++job) {
    const std::string folder = base + fmt::format("-{}", job);
    children.push_back(fork());
    if (children.back() == 0) {
      const json told = work(job, folder);
      std::ofstream(folder + ".json") << told.dump();
      _exit(0);
    }
  }
  std::vector<json> all;
  for (unsigned job = 0; job < options.jobs; ++job) {
    int status = 0;
    waitpid(children[job], &status, 0);
    const std::string file = base + fmt::format("-{}.json", job);
    all.push_back(status == 0 ? json::parse(std::ifstream(file)) : json());
    std::filesystem::remove(file);
  }
  return all;
}

std::pair<std::string, bool> judged_lines(const std::vector<json>& told) {
  std::uint64_t runs = 0, lies = 0;
  std::map<std::string, std::uint64_t> records;
  for (const json& one : told) {
    lies += one.is_null() ? 1 : one["lies"].get<std::uint64_t>();
    runs += one.is_null() ? 0 : one["runs"].get<std::uint64_t>();
    const json own = one.is_null() ? json::object() : one["records"];
    for (const auto& [verdict, count] : own.items()) {
      records[verdict] += count.get<std::uint64_t>();
    }
  }
  std::string text = fmt::format("{} runs of a line, {} wrong\n", runs, lies);
  for (const auto& [verdict, count] : records) {
    text += fmt::format("{:8} {}\n", count, verdict);
  }
  return {text, lies == 0};
}

/// What was found, as text, and whether that is nothing.
std::pair<std::string, bool> judged(const Options& options, const std::vector<json>& told) {
  if (options.lines > 0) {
    return judged_lines(told);
  }
  if (options.stories > 0) {
    std::uint64_t stories = 0, undone = 0, lies = 0;
    for (const json& one : told) {
      stories += one.is_null() ? 0 : one[0].get<std::uint64_t>();
      undone += one.is_null() ? 0 : one[1].get<std::uint64_t>();
      lies += one.is_null() ? 1 : one[2].get<std::uint64_t>();
    }
    return {fmt::format("{} stories, {} undone, {} wrong\n", stories, undone, lies), lies == 0};
  }
  if (options.sweep > 0) {
    SweptByKind all;
    bool crashed = false;
    for (const json& one : told) {
      crashed = crashed || one.is_null();
      add(all, swept_in(one));
    }
    return {summary(all), !crashed && lies_in(all) == 0};
  }
  Counts all;
  for (const json& one : told) {
    if (one.is_null()) {
      all.crashes += 1;
    } else {
      all += counts_in(one);
    }
  }
  return {summary(all, options.seed), all.lies + all.crashes + all.deaf == 0};
}

} // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Random episodes, everything that can go wrong, and what commands say of it");
  app.add_option("--seed", options.seed, "the first episode");
  app.add_option("--episodes", options.episodes, "how many");
  app.add_option("--jobs", options.jobs, "processes")->check(CLI::Range(1, 256));
  app.add_option("--results", options.results, "writes this Markdown file");
  app.add_option(
      "--sweep", options.sweep,
      "instead of episodes: every n-th frame, call and moment of each command, one by one");
  app.add_option("--only", options.only,
                 "of the sweep: one kind, as \"computer off\", or \"two of these\"");
  app.add_flag("--until-found", options.until_found, "ends with the first difference");
  app.add_flag("--verbose", options.verbose, "prints every command");
  app.add_flag("--frozen", options.frozen,
               "prints the episodes for campaign.py, before what goes wrong is aimed");
  app.add_option("--stories", options.stories,
                 "instead of episodes: so many commands that are tried several times and undone");
  app.add_option("--lines", options.lines,
                 "instead of episodes: so many production lines; with --sweep: one by one every "
                 "n-th frame, call and write of a line on which nothing else goes wrong");
  CLI11_PARSE(app, argc, argv);
  if (options.frozen) {
    for (std::uint64_t i = 0; i < options.episodes; ++i) {
      std::puts(frozen(make_episode(options.seed + i)).dump().c_str());
    }
    return 0;
  }
  const auto [text, is_good] = judged(options, in_jobs(options));
  std::fputs(text.c_str(), stdout);
  if (!options.results.empty()) {
    std::ofstream(options.results) << text;
  }
  return is_good ? 0 : 1;
}
