#pragma once
// A station of a production line: one servo after the other is recognised, checked, numbered,
// configured, saved, proven and recorded (contract, sections 6 and 7, "provision").

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/session.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/files/label.hpp"
#include "blactl/fleet/files/recipe.hpp"
#include "blactl/state/allocation_store.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace blactl::fleet {

class AbsenceWatch;

/// What an operator can see of the work.
enum class StationStage : std::uint8_t {
  waiting,    ///< for a servo
  recognised, ///< something was heard: it is asked what it is
  working,    ///< it is written to: it must not be taken off
  gone,       ///< it fell silent before its end; the stage before follows if it is heard again
  ended,      ///< its record is in the ledger
  take_off,   ///< it is waited for that no servo is on the bus
  left,       ///< the finished one is not heard any more, nor another one
  other,      ///< it is not heard any more, but something else is: another one, or it restarts
};
[[nodiscard]] std::string_view name(StationStage stage);

class Station {
 public:
  struct Options {
    Recipe recipe{};
    state::LedgerRecord common{}; ///< what all records share: station, recipe, operator, …
    Manner manner{};              ///< without history and allocations: neither is kept of the line
    dronecan::NodeId first_bench_id{100}, last_bench_id{124}; ///< for units that ask for an ID
    unsigned max_attempts = 3;                                ///< that a unit may fail
    bool redo = false;                                        ///< finished units are done anew
    /// What a record has to tell beside its verdict, if nobody gave a reason; empty: nothing.
    std::function<std::optional<std::string>()> remark{};
  };

  /// `serial_number`: of the servo that is gone, as far as it is known.
  using StageHook =
      std::function<void(StationStage stage, std::optional<std::int64_t> serial_number)>;

  /// How the wait for the end of a visit ended.
  enum class Leaving : std::uint8_t {
    gone,     ///< no servo has been heard for 3 s
    replaced, ///< another unit is there, or the same one that has still to be done
    joined,   ///< another unit is there beside the last one: refuse_joined() comes next
    doubled,  ///< as joined, but under one node ID: the last one may not be among them
    late,     ///< the deadline came first
  };

  /// A servo, or several, as they came.
  struct Arrival {
    std::vector<dronecan::NodeId> ids{};
    bool has_asked = false; ///< for a node ID
    Time at{};
    WallTime wall{};
  };

  /// All references outlive this. `entered` is called for every stage.
  Station(Session& session, const bla::Profiles& profiles, state::LedgerStore& ledger,
          state::CounterStore& counters, Options options, StageHook entered);
  ~Station();
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;

  /// Ends what an earlier run of this station has begun and not ended: error, interrupted. Returns
  /// these records. Errors: those of the ledger.
  [[nodiscard]] Result<std::vector<state::LedgerRecord>> end_interrupted();

  /// Whether one is on the bus, or asks for a node ID.
  [[nodiscard]] bool is_servo_there() const;

  /// Waits until a servo is on the bus, or asks for a node ID. Empty: nobody came until then.
  /// Errors: those that end a session.
  [[nodiscard]] Result<std::optional<Arrival>> wait_for_servo(Time deadline);

  /// All work on it, from the checks to the record in the ledger; `label`: null if none is read.
  /// Returns the record, which is on the disk. Errors: it is not: those of the ledger.
  [[nodiscard]] Result<state::LedgerRecord> work_on(const Arrival& arrival, const Label* label);

  /// Why the last record is no pass; empty: it is, or its end is no error.
  [[nodiscard]] const std::optional<Error>& reason() const { return reason_; }

  /// Whether the last one is done again as soon as a servo is heard; else it has to be taken off.
  [[nodiscard]] bool is_repeating() const { return last_.is_to_be_repeated; }

  /// Waits until no servo has been heard for 3 s, or until another unit than the last one is there:
  /// whoever comes, restarts or was silent is asked who it is. After the wait was broken off by an
  /// error it may be called again. Errors: those that end a session.
  [[nodiscard]] Result<Leaving> wait_until_off(Time deadline);

  /// The record that several servos are there; all have to be taken off. Errors: as work_on().
  [[nodiscard]] Result<state::LedgerRecord> refuse_joined();

 private:
  struct Past;
  class Succession;

  /// The last visit, by which another unit in its place is told.
  struct Visit {
    std::optional<dronecan::UniqueId> unit{}; ///< empty: it has not told
    bool may_ask = false;                     ///< for a node ID, after a restart
    bool are_several = false;                 ///< all of them have to go
    bool is_to_be_repeated = false;           ///< as soon as a servo is there
    unsigned spoilt = 0;                      ///< so often in a row, without having been off
    bool has_let_in = false;                  ///< one that asked after its end
    Time end{};

    /// What was known of a node at the end.
    struct Node {
      std::uint32_t boots = 0;
      Time back_at{};
    };

    std::map<dronecan::NodeId, Node> nodes{};
  };

  void go_to(StationStage stage);
  void watch_absence();
  [[nodiscard]] std::optional<std::int64_t> serial_number() const;
  void show_bench(bool is_last_there, bool is_occupied);
  [[nodiscard]] bool is_asked(Time since = Time::min()) const;
  [[nodiscard]] bool is_other_asking() const;
  [[nodiscard]] bool is_any_doubled(const std::vector<dronecan::NodeId>& ids) const;
  [[nodiscard]] Result<Leaving> give_way(bool has_asked);
  void remember(const state::LedgerRecord& record);
  [[nodiscard]] std::vector<dronecan::NodeId> servos_there() const;
  [[nodiscard]] state::NodeIds beside_bench() const;
  [[nodiscard]] Result<void> let_in();
  [[nodiscard]] std::optional<Error> identify(const Arrival& arrival, Servo& servo) const;
  [[nodiscard]] Result<Past> past_of(const Servo& servo) const;
  [[nodiscard]] std::optional<Error> number_and_configure(const Servo& servo, const Label* label,
                                                          state::LedgerRecord& record);
  [[nodiscard]] std::optional<Error>
  configure(const Servo& servo, std::vector<bla::Assignment> settings, state::LedgerRecord& record);
  [[nodiscard]] std::optional<Error> prove(const Servo& servo, dronecan::NodeId id,
                                           std::span<const bla::Assignment> settings,
                                           state::LedgerRecord& record);
  [[nodiscard]] bool is_beside_another(dronecan::NodeId id) const;
  [[nodiscard]] Error unless_away(Error error, dronecan::NodeId id) const;
  [[nodiscard]] Result<state::LedgerRecord> commit(state::LedgerRecord record, Time began,
                                                   std::string_view verdict,
                                                   std::optional<Error> reason);

  Session& session_;
  const bla::Profiles& profiles_;
  state::LedgerStore& ledger_;
  state::CounterStore& counters_;
  Options options_;
  StageHook entered_;
  std::optional<Error> reason_;
  StationStage stage_{};
  std::unique_ptr<AbsenceWatch> watch_; ///< while a servo is not to be taken off
  Visit last_{};
};

} // namespace blactl::fleet
