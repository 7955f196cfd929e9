#pragma once
// Finds and identifies servos: those selected by a command, all present ones, or those that come.

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

/// The longest silence of a BLA servo: it sends actuator.Status ten times a second.
inline constexpr Duration servo_search_time = std::chrono::milliseconds(250);

/// The node IDs selected for a command, ascending, and the errors for selected ones that are not
/// among them.
struct Selection {
  std::vector<dronecan::NodeId> ids;
  std::vector<Error> errors;
  std::vector<std::string> notes; ///< nodes that were left out although they look like servos
};

struct Arrival {
  Servo servo;
  bool is_there = false; ///< identified, operational, and responding at the end
};

struct Arrivals {
  std::vector<Arrival> servos; ///< selected ones that were heard
  std::vector<Error> errors;   ///< for missing ones; empty: all are there
  std::optional<Error> broken; ///< the error that ended the session early
};

/// One search on one session. The jobs it starts end with it.
class Discovery final : private Roster::Listener {
 public:
  /// Both references outlive this.
  Discovery(Session& session, const bla::Profiles& profiles, Identification::Options options);
  ~Discovery() override;
  Discovery(const Discovery&) = delete;
  Discovery(Discovery&&) = delete;
  Discovery& operator=(const Discovery&) = delete;
  Discovery& operator=(Discovery&&) = delete;

  /// The nodes behind -n. If the bus must be searched, this listens for `listen`, and identifies
  /// senders of actuator.Status. Errors: those that end a session. In Selection: not_found, and why
  /// a servo was not identified.
  [[nodiscard]] Result<Selection> select(const Targets& targets, Duration listen);

  /// The selection for a command that writes: without -n the only servo. Further errors: usage, if
  /// there are several.
  [[nodiscard]] Result<Selection> select_for_writing(const Targets& targets);

  /// Listens for `listen`, identifies every node and, if this process may send requests, looks for
  /// silent ones; those found are asked twice for their unique ID.
  [[nodiscard]] Result<void> find_all(Duration listen);

  /// Asks these nodes again for their unique ID: a second unit on an ID responds, too, a little
  /// later. Errors: those that end a session.
  [[nodiscard]] Result<void> look_for_twins(const std::vector<const Member*>& members);

  /// Waits until the selected servos are identified and operational, at most for `wait`.
  [[nodiscard]] Arrivals wait_for(const Targets& targets, Duration wait);

  /// The selected servos heard so far.
  [[nodiscard]] std::vector<Arrival> those_there(const Targets& targets) const;

  /// From now on every unit that appears or restarts is asked for its unique ID.
  void recognise();

  /// Nodes that were there, and did not respond to their last request.
  [[nodiscard]] const std::set<dronecan::NodeId>& gone() const { return gone_; }

  /// Those of the targets that were not heard. Errors: not_found; not_recorded; duplicate_node_id,
  /// where one may be among units that share an ID.
  [[nodiscard]] std::vector<Error> absent(const Targets& targets) const;

  /// The end of each identification; empty: success.
  [[nodiscard]] std::vector<std::optional<Error>> identifications() const;

 private:
  void choose(const Targets& targets, std::set<dronecan::NodeId> chosen);
  enum class Attention : std::uint8_t { none, unit, all };

  void on_new_unit(const Member& member) override;
  void attend(Attention attention);
  void identify(dronecan::NodeId id);
  void ask_again();
  void start(std::unique_ptr<dronecan::Job> job);
  [[nodiscard]] std::vector<const Member*> meant(const Targets& targets) const;
  [[nodiscard]] bool is_bystander(const Error& error) const;
  [[nodiscard]] Result<void> identify_servos();
  [[nodiscard]] Result<void> end_search();
  [[nodiscard]] Result<void> hear_servos(const Targets& targets, Duration listen);
  [[nodiscard]] std::vector<Error> unmet(const Targets& targets) const;
  [[nodiscard]] bool is_one_of_all(const Targets& targets, const Member& member) const;
  [[nodiscard]] bool was_meant(const Targets& targets, const Member& member) const;
  [[nodiscard]] bool is_gone(const Member& member) const;
  [[nodiscard]] std::vector<Error> not_there_yet(const Targets& targets, Code reason) const;
  [[nodiscard]] bool seems_ready(const Member& member) const;
  [[nodiscard]] bool is_ready(const Member& member) const;
  [[nodiscard]] bool all_there(const Targets& targets) const;
  [[nodiscard]] Result<bool> wait_until_there(const Targets& targets, Time deadline);
  [[nodiscard]] std::vector<Error> missing(const Targets& targets, Duration wait) const;

  Session& session_;
  const bla::Profiles& profiles_;
  Identification::Options options_;
  Attention attention_ = Attention::none;
  std::uint8_t cursor_ = 0; ///< for the probes

  /// Whether a search waits for its last answers: one that restarts again and again meanwhile is
  /// asked once more, and not for ever.
  bool is_ending_ = false;
  std::set<dronecan::NodeId> asked_late_{};
  std::vector<std::unique_ptr<IdentifyJob>> identifications_;
  std::vector<std::unique_ptr<dronecan::Job>> jobs_;
  std::set<dronecan::NodeId> gone_; ///< no response to the last request
};

/// Waits until the bus has been heard for bus_watch_time. Errors: those that end a session; state,
/// if frames were lost meanwhile.
[[nodiscard]] Result<void> hear_bus(Session& session);

} // namespace blactl::fleet
