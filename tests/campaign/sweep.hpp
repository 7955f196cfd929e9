#pragma once
// Every single fault before random ones: for each changing command the k-th frame, the k-th system
// call and the k-th write to a database, once and from then on; and a sample of pairs.

#include "disturbance.hpp"
#include "episode.hpp"
#include "step.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::campaign {

/// Of one command and one kind of disturbance.
struct Swept {
  std::size_t places = 0; ///< frames or calls of the command when nothing goes wrong
  std::size_t runs = 0;
  std::size_t good = 0; ///< ended with 0
  std::size_t lies = 0; ///< false words, and what did not converge
};

/// By command and kind.
using SweptByKind = std::map<std::pair<std::string, std::string>, Swept>;

/// The runs of another job.
void add(SweptByKind& all, const SweptByKind& more);

class Sweep {
 public:
  struct Options {
    std::size_t step = 1; ///< every n-th place
    std::string only{};   ///< one kind of disturbance, or pairs of them; empty: all
    bool until_found = false;
    unsigned job = 0, jobs = 1;
    std::function<void()> begins; ///< called before each run
  };

  /// `tell`: receives every difference.
  Sweep(std::filesystem::path folder, Options options, std::function<void(const std::string&)> tell)
      : folder_(std::move(folder)), options_(std::move(options)), tell_(std::move(tell)) {}

  /// Plays those whose turn it is: of `jobs` jobs this is number `job`.
  void play();

  [[nodiscard]] const SweptByKind& swept() const { return swept_; }

 private:
  /// A command, what was done before it, and whether the same memories follow from it whenever it
  /// is repeated.
  struct Case {
    std::string name;
    std::vector<Command> before;
    Command command;
    bool is_repeatable = true;
    bool is_undoable = false;      ///< `undo` brings back all that was before
    bool is_written_again = false; ///< what a restart in the middle has dropped
    bool takes_back = false;       ///< each servo is as it was before all of it
    std::string ended_by{};        ///< after this happening nothing more may be sent
    std::vector<int> node_ids{11, 12, 13};
    nlohmann::json first = nlohmann::json::object(); ///< what is special about the first servo
    nlohmann::json orders = nlohmann::json::array(); ///< of another tool
  };

  struct Calm {
    States first; ///< before everything
    States goal;
    std::size_t places = 0;
    std::size_t requests = 0;
    int status = 0;
  };

  [[nodiscard]] static std::vector<Case> cases();
  [[nodiscard]] static Episode episode_of(const std::vector<int>& node_ids);
  [[nodiscard]] static Episode episode_of(const Case& one);
  [[nodiscard]] static Step begin(World& world, const Episode& episode, const Case& one,
                                  std::span<Disturbance> disturbances);
  static void check(World& world, const Case& one, std::span<const Disturbance> disturbances,
                    const Step& step, const Calm& calm);
  [[nodiscard]] Calm play_calm(const Case& one, Disturbance::Kind kind) const;

  /// What is done after a command was killed, before `undo` brings back what was before it.
  enum class AfterKill : std::uint8_t { nothing, undo, repeated, killed_again };

  [[nodiscard]] static AfterKill
  follows_kill(const Case& one, std::span<const Disturbance> disturbances, const Step& step);
  [[nodiscard]] static bool is_killed_again(World& world, const Step& tried, Disturbance kill);
  static void check_undo(World& world, const Step& changed);
  static void check_stores(World& world, const Step& cut, bool is_undoable);
  void play_each(const Case& one, Disturbance::Kind kind);
  void play_pairs(const Case& one);

  /// Commands that must be refused: each after `before`.
  struct Refused {
    Episode episode;
    std::vector<Command> before{};
    std::vector<Command> commands{};
    bool are_told_apart = true; ///< no serial number is that of two servos
    int status = 0;             ///< that it must end with; 0: any but this
  };

  /// What `-n` takes, and the serial numbers of those that it means; none: it is an error.
  struct Meant {
    std::string target;
    std::set<std::int64_t> serials;
  };

  [[nodiscard]] static std::vector<Meant> selections();
  void play_selection(const Meant& meant, Swept& swept);
  [[nodiscard]] static std::vector<Refused> refused();
  void play_quiet();
  void play_refused(const Refused& world, const Command& command, Swept& swept);
  void play_faults(const Case& one);
  void play_moments(const Case& one);

  struct Moment {
    std::string what;
    bool must_converge = false;
    bool is_undone = false;
    bool is_undone_later = false; ///< once everything that went wrong has ended
    bool must_end_well = false;
    std::optional<Time> is_last{}; ///< of a change: what it was judged by is another then
  };

  void play_moment(const Case& one, const Episode& episode, const Moment& moment, Swept& swept);
  void judged(const Case& one, const std::string& what, const Step& step, Swept& swept,
              const std::function<void()>& check);
  void disturb(const Case& one, std::vector<Disturbance> disturbances, const Calm& calm,
               Swept& swept);

  [[nodiscard]] bool is_over() const { return options_.until_found && has_found_; }

  [[nodiscard]] bool is_own_turn() { return turn_++ % options_.jobs == options_.job; }

  std::filesystem::path folder_;
  Options options_;
  std::function<void(const std::string&)> tell_;
  std::size_t turn_ = 0;
  bool has_found_ = false;
  SweptByKind swept_;
};

} // namespace blactl::campaign
