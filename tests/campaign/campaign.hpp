#pragma once
// Episodes, played and judged, and what came of them.

#include "episode.hpp"
#include "step.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace blactl::campaign {

/// What became of commands, by kind of fault where it was alone.
struct Ends {
  std::uint64_t good = 0;                        ///< 0
  std::map<std::string, std::uint64_t> needless; ///< of a good command, not 0: how it ended
};

struct Counts {
  std::uint64_t episodes = 0, runs = 0, repeated = 0;
  std::uint64_t servo_seconds = 0;             ///< of simulated time, over all servos
  std::map<std::string, std::uint64_t> ends;   ///< exit status with its errors
  std::map<std::string, std::uint64_t> faults; ///< episodes in which that kind was switched on
  std::map<std::string, Ends> alone;           ///< by kind of fault; "": none
  std::uint64_t lies = 0, stuck = 0;           ///< false words; commands that did not converge
  std::uint64_t alarms = 0, deaf = 0; ///< servos made to lie, on every 100th seed; not noticed
  std::uint64_t crashes = 0;          ///< jobs that did not end by themselves

  Counts& operator+=(const Counts& other);
};

/// A folder for the files of one world, which commands take for the user's own; it ends with this.
class Folder {
 public:
  explicit Folder(std::filesystem::path path);
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

 private:
  std::filesystem::path path_;
};

/// One command, and what happened meanwhile.
[[nodiscard]] Step take_step(World& world, const Episode& episode, const Command& command,
                             std::span<Disturbance> disturbances = {});

class Campaign {
 public:
  /// `folder`: for files of the episodes. `tell`: receives every difference, and with `is_verbose`
  /// every command.
  Campaign(std::filesystem::path folder, std::function<void(const std::string&)> tell,
           bool is_verbose)
      : folder_(std::move(folder)), tell_(std::move(tell)), is_verbose_(is_verbose) {}

  void play(const Episode& episode);

  [[nodiscard]] const Counts& counts() const { return counts_; }

  [[nodiscard]] bool has_found() const { return counts_.lies > 0; }

 private:
  [[nodiscard]] Step run(World& world, const Episode& episode, const Command& command);
  [[nodiscard]] Step run_and_answer(World& world, const Episode& calm, const Command& command);
  [[nodiscard]] std::vector<Time> rehearse(const Episode& episode);
  void count(const Step& step, bool must_succeed);
  void list(World& world, const Episode& episode);
  void repeat(World& world, const Episode& episode, const Step& former);
  void test_alarm(const Step& step);
  void differ(const Episode& episode, const Step& step, const std::string& what);

  std::filesystem::path folder_;
  std::function<void(const std::string&)> tell_;
  bool is_verbose_;
  Counts counts_;
};

} // namespace blactl::campaign
