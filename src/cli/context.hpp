#pragma once
// What every command on a bus needs: the profiles, a session, and the servos it is about.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/identification.hpp"
#include "blactl/fleet/session.hpp"
#include "blactl/fleet/target.hpp"

#include "options.hpp"
#include "report.hpp"
#include "reporter.hpp"

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
  /// long as the context. Errors: interface, permission, no_local_node_id, bad_file, usage.
  [[nodiscard]] Result<fleet::Session*> open(fleet::Session::Hearing hearing);

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

  /// Says so if frames were dropped on the way to this process.
  void tell_losses() const;

  /// Ends a command whose session broke: what the report needs of it.
  void broken(const Error& error, Report& report) const;

 private:
  void search(Duration time, Report& report, bool failures_count);
  [[nodiscard]] std::vector<fleet::Member*> matching(const fleet::Targets& targets, Report& report);

  const Shared& shared_;
  const Reporter& reporter_;
  std::optional<bla::Profiles> profiles_;
  const bla::Profile* assumed_ = nullptr;
  std::unique_ptr<fleet::Session> session_;
};

} // namespace blactl::cli
