#pragma once
// What every command on a bus needs: the profiles, a session, and the servos it is about.

#include "blactl/bla/profile.hpp"
#include "blactl/can/paced_replay.hpp"
#include "blactl/can/recorder.hpp"
#include "blactl/can/replay.hpp"
#include "blactl/can/slcan.hpp"
#include "blactl/fleet/bus/identification.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/bus/target.hpp"
#include "blactl/fleet/change/history.hpp"
#include "blactl/state/allocation_store.hpp"
#include "blactl/state/interface_lock.hpp"
#include "blactl/state/snapshot_store.hpp"

#include "cli/options.hpp"
#include "cli/output/report.hpp"
#include "cli/output/reporter.hpp"
#include "cli/output/request_details.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {
struct FleetFile;
} // namespace blactl::fleet

namespace blactl::cli {

class Context {
 public:
  Context(const Shared& shared, const Reporter& reporter)
      : shared_(shared), reporter_(reporter), record_(shared.record) {}

  [[nodiscard]] const Shared& shared() const { return shared_; }

  [[nodiscard]] const Reporter& reporter() const { return reporter_; }

  /// Reads the profiles once. Errors: bad_file.
  [[nodiscard]] Result<const bla::Profiles*> profiles();

  /// The same, once profiles() went well.
  [[nodiscard]] const bla::Profiles& known() const { return *profiles_; }

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

  /// The same, to allocate node IDs, and to hear everybody. Further errors: busy.
  [[nodiscard]] Result<fleet::Session*> open_for_allocation();

  /// Whether this process may give node IDs: nobody else of this machine does.
  [[nodiscard]] bool may_allocate() { return lock_allocation().has_value(); }

  /// The allocation table for the interface: that of this user; simulated servos, which would fill
  /// it, have one of their own, and those of a private simulation one in memory. Errors: as
  /// AllocationStore::open().
  [[nodiscard]] Result<state::AllocationStore> allocations(state::Access access) const;

  /// The record of what `command` changes, kept where the allocation table is. What to do where
  /// there is none is for the caller to judge. Errors: as SnapshotStore::open().
  [[nodiscard]] Result<fleet::History> history(std::string_view command,
                                               state::Access access) const;

  /// The changes that were recorded. Errors: as SnapshotStore::open().
  [[nodiscard]] Result<state::SnapshotStore> snapshots(state::Access access) const;

  [[nodiscard]] fleet::Session& session() { return *session_; }

  /// The signal that ended the session, also while it was opened, or a question before; 0: none.
  [[nodiscard]] int signal() const { return session_ ? session_->signal() : signal_; }

  /// Lives until `descriptor` (where a person answers a question) can be read, with a session or
  /// before there is one. Errors: interrupted, and those of the session.
  [[nodiscard]] Result<void> wait_for_input(int descriptor);

  [[nodiscard]] fleet::Identification::Options identification() const;

  /// Every frame of the session goes to this file, as with --record. To be called before open().
  void record_to(std::string file) { record_ = std::move(file); }

  /// An adapter is asked what it is while it is opened. To be called before open().
  void inquire() { inquires_ = true; }

  /// An interface that goes away while the session lives is waited for (Session::away()). To be
  /// called before open().
  void wait_for_return() { waits_for_return_ = true; }

  /// A log is played at its own pace. To be called before open().
  void play_at_pace() { plays_at_pace_ = true; }

  /// The log behind the session, where it is played so; null: it is none.
  [[nodiscard]] can::PacedReplay* pace() const { return session_ ? pace_ : nullptr; }

  /// Behind -i is a fleet file: it tells of servos, and of no bus.
  [[nodiscard]] bool is_fleet_file() const;

  /// The adapter behind the session; null: none, or no session.
  [[nodiscard]] can::Slcan* adapter() const { return session_ ? adapter_ : nullptr; }

  /// The bus, or with --record a recorder around it. The file is made last: what stops the command
  /// before leaves one that is there as it was. Errors: usage, io.
  [[nodiscard]] Result<std::unique_ptr<can::Bus>> recorded(std::unique_ptr<can::Bus> bus);

  /// A recording that ended early is a failure of the command. The bus is still there.
  void check_recording(Report& report) const;

  /// Says so if frames were dropped on the way to this process, or lines of a log passed over. A
  /// recording that ended early is a failure of the command, and so is an interface that is away.
  void tell_losses(Report& report) const;

  /// On a fleet file: what it does not tell has another reason than on a log, and a node ID that
  /// only stands for a servo here is told to nobody as one.
  void explain_file(Report& report) const;

  /// Where nothing at all was heard: says what of the interface may be the reason.
  void explain_silence(Report& report) const;

  /// Ends a command whose session broke: what the report needs of it.
  void broken(const Error& error, Report& report) const;

 private:
  /// A node ID of our own for this bus; none where nothing is sent. Errors: no_local_node_id.
  [[nodiscard]] Result<std::optional<state::LocalNodeId>> take_node_id(bool listens);
  [[nodiscard]] state::LocalNodeId::Candidates own_ids() const;
  [[nodiscard]] Result<void> lock_allocation();
  [[nodiscard]] Result<void> recall(const fleet::FleetFile& fleet);
  void tell(const state::LocalNodeId& local) const;
  void tell_lock(const std::string& path) const;

  const Shared& shared_;
  const Reporter& reporter_;
  std::optional<std::string> record_; ///< the file for all frames
  std::optional<bla::Profiles> profiles_;
  const bla::Profile* assumed_ = nullptr;
  state::LockPlace place_; ///< of the interface
  std::optional<state::InterfaceLock> writing_, allocating_;
  RequestDetails requests_{reporter_};
  int signal_ = 0; ///< that came before there was a session
  std::unique_ptr<fleet::Session> session_;
  bool inquires_ = false;
  bool waits_for_return_ = false;
  bool plays_at_pace_ = false;
  can::Slcan* adapter_ = nullptr;           ///< the session's bus, with -i slcan:
  const can::ReplayBus* log_ = nullptr;     ///< the session's bus, with -i replay:
  can::PacedReplay* pace_ = nullptr;        ///< around it, with play_at_pace()
  const can::Recorder* recorder_ = nullptr; ///< around the session's bus, with --record
};

} // namespace blactl::cli
