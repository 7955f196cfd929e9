#pragma once
// What every command on a bus needs: the profiles, a session, and the servos it is about.

#include "blactl/bla/profile.hpp"
#include "blactl/can/recorder.hpp"
#include "blactl/can/replay.hpp"
#include "blactl/fleet/identification.hpp"
#include "blactl/fleet/session.hpp"
#include "blactl/fleet/target.hpp"
#include "blactl/state/interface_lock.hpp"

#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/output/reporter.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// How long a BLA servo may stay unheard: it sends actuator.Status ten times a second.
inline constexpr Duration servo_search_time = std::chrono::milliseconds(250);
/// How long to listen until who commands, says armed or shares an ID has been heard.
inline constexpr Duration bus_watch_time = std::chrono::milliseconds(1100);

class Context {
 public:
  Context(const Shared& shared, const Reporter& reporter) : shared_(shared), reporter_(reporter) {}

  [[nodiscard]] const Shared& shared() const { return shared_; }

  [[nodiscard]] const Reporter& reporter() const { return reporter_; }

  /// Reads the profiles once. Errors: bad_file.
  [[nodiscard]] Result<const bla::Profiles*> profiles();

  /// The model behind --profile; null without it. Errors: usage, bad_file.
  [[nodiscard]] Result<const bla::Profile*> assumed_profile();

  /// What -n says. Errors: usage.
  [[nodiscard]] Result<fleet::Targets> targets() const;

  /// Opens the interface with a node ID of our own (none with --listen-only). The session lives as
  /// long as the context. Errors: interface, permission, no_local_node_id, bad_file, usage, io.
  [[nodiscard]] Result<fleet::Session*> open(fleet::Session::Hearing hearing);

  /// The same, to write to servos: one process of this machine at a time. Further errors: usage
  /// (--listen-only; `command` is named), busy.
  [[nodiscard]] Result<fleet::Session*> open_for_writing(std::string_view command);

  /// Whether this process may give node IDs: nobody else of this machine does.
  [[nodiscard]] bool may_allocate();

  [[nodiscard]] fleet::Session& session() { return *session_; }

  /// The signal that ended the session, also while it was opened; 0: none.
  [[nodiscard]] int signal() const { return session_ ? session_->signal() : 0; }

  [[nodiscard]] fleet::Identification::Options identification() const;

  /// The servos behind -n, in ascending order of node ID. Where the bus must be searched, it is
  /// listened to for `search` and what sends actuator.Status is identified.
  /// Servos that failed to identify themselves become errors of `report` where they are meant for
  /// certain. An empty list has left its error (not_found) in `report`.
  [[nodiscard]] std::vector<fleet::Member*> select(const fleet::Targets& targets, Duration search,
                                                   Report& report);

  /// The same for a command that writes: without -n the one servo there is.
  /// Empty: an error is in `report`.
  [[nodiscard]] std::vector<fleet::Member*> select_for_writing(const fleet::Targets& targets,
                                                               Report& report);

  /// Hears the bus for as long as it takes to know who drives, is armed or shares an ID. False: an
  /// error is in `report`.
  [[nodiscard]] bool hear_bus(Report& report);

  /// The bus, or with --record a recorder around it. The file is made last: what stops the command
  /// before leaves one that is there as it was. Errors: usage, io.
  [[nodiscard]] Result<std::unique_ptr<can::Bus>> recorded(std::unique_ptr<can::Bus> bus);

  /// A recording that ended early is a failure of the command. The bus is still there.
  void check_recording(Report& report) const;

  /// Says so if frames were dropped on the way to this process, or lines of a log passed over. A
  /// recording that ended early is a failure of the command.
  void tell_losses(Report& report) const;

  /// Ends a command whose session broke: what the report needs of it.
  void broken(const Error& error, Report& report) const;

 private:
  void search(Duration time, Report& report, bool failures_count);
  [[nodiscard]] std::vector<fleet::Member*> matching(const fleet::Targets& targets, Report& report);

  const Shared& shared_;
  const Reporter& reporter_;
  std::optional<bla::Profiles> profiles_;
  const bla::Profile* assumed_ = nullptr;
  std::string lock_name_; ///< of the interface; empty: no other process can reach it
  std::string lock_folder_;
  std::optional<state::InterfaceLock> writing_, allocating_;
  std::unique_ptr<fleet::Session> session_;
  Time opened_{};
  const can::ReplayBus* log_ = nullptr;     ///< the session's bus, with -i replay:
  const can::Recorder* recorder_ = nullptr; ///< around the session's bus, with --record
};

} // namespace blactl::cli
