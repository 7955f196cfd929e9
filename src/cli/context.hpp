#pragma once
// The common needs of commands on a bus: the profiles, a session, and the selected servos.

#include "blactl/bla/profile.hpp"
#include "blactl/can/paced_replay.hpp"
#include "blactl/can/recorder.hpp"
#include "blactl/can/replay.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/state/interface_lock.hpp"

#include "cli/interface/bus_factory.hpp"
#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/output/reporter.hpp"
#include "cli/output/request_details.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {
struct FleetFile;
} // namespace blactl::fleet

namespace blactl::cli {

class Context {
 public:
  Context(const Shared& shared, const Reporter& reporter, BusOpener opener)
      : shared_(shared), reporter_(reporter), opener_(std::move(opener)),
        wishes_{.record = shared.record} {}

  [[nodiscard]] const Shared& shared() const { return shared_; }

  [[nodiscard]] const Reporter& reporter() const { return reporter_; }

  /// Reads the profiles on the first call. Errors: bad_file.
  [[nodiscard]] Result<const bla::Profiles*> profiles();

  /// The profiles, after a successful profiles().
  [[nodiscard]] const bla::Profiles& known() const { return *profiles_; }

  /// The model from --profile; null without it. Errors: usage, bad_file.
  [[nodiscard]] Result<const bla::Profile*> assumed_profile();

  /// The selection of -n. Errors: usage.
  [[nodiscard]] Result<fleet::Targets> targets() const;

  /// Opens the interface with our own node ID (none with --listen-only). The session lives as long
  /// as the context. Errors: interface, permission, no_local_node_id, bad_file, usage, io.
  [[nodiscard]] Result<fleet::Session*> open(fleet::Session::Hearing hearing);

  /// Opens the interface to write to servos: one process of this machine at a time. Further errors:
  /// usage (--listen-only; `command` is named), busy.
  [[nodiscard]] Result<fleet::Session*> open_for_writing(std::string_view command);

  /// Opens the interface to allocate node IDs, and to receive from all nodes. Further errors: busy.
  [[nodiscard]] Result<fleet::Session*> open_for_allocation();

  /// The bus of -i, without a session. Errors: as open_bus().
  [[nodiscard]] Result<OpenBus> open_bare();

  /// Whether this process may allocate node IDs: no other on this machine does.
  [[nodiscard]] bool may_allocate() { return lock_allocation().has_value(); }

  [[nodiscard]] fleet::Session& session() { return *session_; }

  /// The signal that ended the session, its opening, or an earlier question; 0: none.
  [[nodiscard]] int signal() const { return session_ ? session_->signal() : signal_; }

  /// Waits until `descriptor` (for the user's answer) is readable, with or without a session.
  /// Errors: interrupted, and those of the session.
  [[nodiscard]] Result<void> wait_for_input(int descriptor);

  [[nodiscard]] fleet::Identification::Options identification() const;

  /// Records every frame of the session in this file, as --record does. Call before open().
  void record_to(std::string file) { wishes_.record = std::move(file); }

  /// Where every frame of the session is recorded; null: nowhere.
  [[nodiscard]] can::Recorder* recorder() const { return session_ ? layers_.recorder : nullptr; }

  /// Asks an adapter for its identification when it is opened. Call before open().
  void inquire() { wishes_.inquires = true; }

  /// Waits for an interface that goes away during the session to return (Session::away()). Call
  /// before open().
  void wait_for_return() { wishes_.waits_for_return = true; }

  /// Plays a log at its own pace. Call before open().
  void play_at_pace() { wishes_.plays_at_pace = true; }

  /// The log behind the session, if played at its pace; else null.
  [[nodiscard]] can::PacedReplay* pace() const { return session_ ? layers_.pace : nullptr; }

  /// Whether -i names a fleet file: it has data of servos, but no bus.
  [[nodiscard]] bool is_fleet_file() const;

  /// The adapter behind the session; null: none, or no session.
  [[nodiscard]] can::Slcan* adapter() const { return session_ ? layers_.adapter : nullptr; }

  /// The bus, or with --record a recorder around it. The file is created last, so that earlier
  /// errors leave an existing file untouched. Errors: usage, io.
  [[nodiscard]] Result<std::unique_ptr<can::Bus>> recorded(std::unique_ptr<can::Bus> bus);

  /// Fails the command if the recording ended early. The bus must still exist.
  void check_recording(Report& report) const;

  /// Notes frames dropped on the way to this process, and lines of a log that were skipped. Fails
  /// the command if a recording ended early or the interface is away.
  void tell_losses(Report& report) const;

  /// On a fleet file: adapts errors, as data are missing for other reasons than in a log, and hides
  /// node IDs that were only assigned here for lack of one.
  void explain_file(Report& report) const;

  /// If nothing at all was heard: explains it by the state of the interface.
  void explain_silence(Report& report) const;

  /// Completes the report of a command whose session broke.
  void broken(const Error& error, Report& report) const;

  /// Completes the report of a stream that goes on until a signal: that one is no error.
  void ended(const Error& error, Report& report) const;

 private:
  /// What a command wants of the bus beside the interface itself.
  struct Wishes {
    std::optional<std::string> record{}; ///< the file for all frames
    bool inquires = false;
    bool waits_for_return = false;
    bool plays_at_pace = false;
  };

  /// The layers of the session's bus, if it has them.
  struct Layers {
    can::Slcan* adapter = nullptr;       ///< with -i slcan:
    const can::ReplayBus* log = nullptr; ///< with -i replay:
    can::PacedReplay* pace = nullptr;    ///< around it, with play_at_pace()
    can::Recorder* recorder = nullptr;   ///< around all, with --record
  };

  struct Locks {
    state::LockPlace place{}; ///< of the interface
    std::optional<state::InterfaceLock> writing{}, allocating{};
  };

  /// Our own node ID for this bus; none if nothing is sent. Errors: no_local_node_id.
  [[nodiscard]] Result<std::optional<state::LocalNodeId>> take_node_id(bool listens);
  [[nodiscard]] state::LocalNodeId::Candidates own_ids() const;
  [[nodiscard]] Result<void> lock_allocation();
  [[nodiscard]] Result<void> recall(const fleet::FleetFile& fleet);
  void tell(const state::LocalNodeId& local) const;
  void tell_lock(const std::string& path) const;

  const Shared& shared_;
  const Reporter& reporter_;
  BusOpener opener_;
  Wishes wishes_;
  std::optional<Result<bla::Profiles>> loaded_{}; ///< from a folder
  const bla::Profiles* profiles_ = nullptr;
  const bla::Profile* assumed_ = nullptr;
  Locks locks_;
  RequestDetails requests_{reporter_};
  int signal_ = 0; ///< received before there was a session
  std::unique_ptr<fleet::Session> session_;
  Layers layers_;
};

} // namespace blactl::cli
