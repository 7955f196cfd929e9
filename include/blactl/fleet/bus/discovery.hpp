#pragma once
// Finds and identifies servos: those that a command means, all that are there, those that come.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// How long a BLA servo may stay unheard: it sends actuator.Status ten times a second.
inline constexpr Duration servo_search_time = std::chrono::milliseconds(250);

/// The node IDs that a command is about, ascending, and why others that it names are not among
/// them.
struct Selection {
  std::vector<dronecan::NodeId> ids;
  std::vector<Error> errors;
  std::vector<std::string> notes; ///< what was left out though it looks like a servo
};

/// One servo that was waited for.
struct Arrival {
  Servo servo;
  bool is_there = false; ///< identified, operational, and answered in the end
};

struct Arrivals {
  std::vector<Arrival> servos; ///< those that are meant and were heard
  std::vector<Error> errors;   ///< of those that are not there; empty: all are
  std::optional<Error> broken; ///< why the session ended before
};

/// One search on one session. The jobs that it starts end with it.
class Discovery final : private Roster::Listener {
 public:
  /// Both references outlive this.
  Discovery(Session& session, const bla::Profiles& profiles, Identification::Options options);
  ~Discovery() override;
  Discovery(const Discovery&) = delete;
  Discovery(Discovery&&) = delete;
  Discovery& operator=(const Discovery&) = delete;
  Discovery& operator=(Discovery&&) = delete;

  /// The nodes behind -n. Where the bus must be searched it is listened to for `listen`, and what
  /// sends actuator.Status is identified.
  /// Errors: those that end a session. In Selection: not_found, and why a servo was not identified.
  [[nodiscard]] Result<Selection> select(const Targets& targets, Duration listen);

  /// The same for a command that writes: without -n the one servo there is. Further errors: usage,
  /// where there are several.
  [[nodiscard]] Result<Selection> select_for_writing(const Targets& targets);

  /// Listens for `listen`, identifies every node and, if this process may ask, looks for silent
  /// ones; asks those found for their unique ID twice.
  [[nodiscard]] Result<void> find_all(Duration listen);

  /// Asks these nodes once more who they are: a second unit on an ID answers too, somewhat later.
  /// Errors: those that end a session.
  [[nodiscard]] Result<void> look_for_twins(const std::vector<const Member*>& members);

  /// Lives until those that are meant are identified and operational, `wait` at most.
  [[nodiscard]] Arrivals wait_for(const Targets& targets, Duration wait);

  /// Those that are meant and were heard so far.
  [[nodiscard]] std::vector<Arrival> those_there(const Targets& targets) const;

  /// From now on every unit that appears or restarts is asked for its unique ID.
  void recognise();

  /// Those that were there, and did not answer when they were asked last.
  [[nodiscard]] const std::set<dronecan::NodeId>& gone() const { return gone_; }

  /// How each identification that was begun ended; empty: well.
  [[nodiscard]] std::vector<std::optional<Error>> identifications() const;

 private:
  enum class Attention : std::uint8_t { none, unit, all };

  void on_new_unit(const Member& member) override;
  void attend(Attention attention);
  void identify(dronecan::NodeId id);
  void start(std::unique_ptr<dronecan::Job> job);
  [[nodiscard]] std::vector<const Member*> meant(const Targets& targets) const;
  [[nodiscard]] bool is_bystander(const Error& error) const;
  [[nodiscard]] bool is_met(const Selector& selector) const;
  [[nodiscard]] bool is_one_of_all(const Targets& targets, const Member& member) const;
  [[nodiscard]] bool is_gone(const Member& member) const;
  [[nodiscard]] std::vector<Error> not_there_yet(const Targets& targets) const;
  [[nodiscard]] bool seems_ready(const Member& member) const;
  [[nodiscard]] bool is_ready(const Member& member) const;
  [[nodiscard]] bool all_there(const Targets& targets) const;
  [[nodiscard]] Result<bool> wait_until_there(const Targets& targets, Time deadline);
  [[nodiscard]] std::vector<Error> missing(const Targets& targets, Duration wait) const;

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  Attention attention_ = Attention::none;
  std::uint8_t cursor_ = 0; ///< of the probes
  std::vector<std::unique_ptr<IdentifyJob>> identifications_;
  std::vector<std::unique_ptr<dronecan::Job>> jobs_;
  std::set<dronecan::NodeId> gone_; ///< did not answer when they were asked last
};

/// Lives until the bus has been heard for bus_watch_time. Errors: those that end a session; state,
/// if frames were lost meanwhile.
[[nodiscard]] Result<void> hear_bus(Session& session);

} // namespace blactl::fleet
