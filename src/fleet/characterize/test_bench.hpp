#pragma once
// One servo on the bench: reads, writes, restarts, and the restoring of its settings.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/bus/bystanders.hpp"
#include "blactl/fleet/change/save_restart_job.hpp"
#include "blactl/fleet/change/survey.hpp"
#include "blactl/fleet/characterize/characterization.hpp"

#include "fleet/characterize/start_watch.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// The longest start, with the allocation of a node ID and the longest ROM write.
inline constexpr Duration longest_start = std::chrono::seconds(15);

/// The result of one request, kept.
struct Reply {
  dronecan::Outcome::Kind kind = dronecan::Outcome::Kind::start;
  std::vector<std::uint8_t> payload{};
  Time asked{}, at{};

  [[nodiscard]] bool answered() const { return kind == dronecan::Outcome::Kind::answered; }
};

/// Every error of its functions ends the characterization: those that end a session; guards of
/// every change (duplicate_node_id, armed, driven, state: it restarted by itself); timeout and
/// refused where the servo must respond. Before a write it records the old value, for put_back().
class TestBench {
 public:
  /// All references outlive this. `before`: the servo's initial values; `neighbours`: the others on
  /// the bus.
  TestBench(Session& session, const bla::Profiles& profiles, const Snapshot& before,
            const BenchManner& manner, std::vector<Neighbour> neighbours);
  ~TestBench();
  TestBench(const TestBench&) = delete;
  TestBench(TestBench&&) = delete;
  TestBench& operator=(const TestBench&) = delete;
  TestBench& operator=(TestBench&&) = delete;

  [[nodiscard]] const Servo& servo() const { return servo_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return profiles_; }

  [[nodiscard]] const Roster& roster() const { return session_.roster(); }

  [[nodiscard]] const StartWatch& start_watch() const { return start_watch_; }

  [[nodiscard]] const std::vector<Neighbour>& neighbours() const { return neighbours_; }

  /// The initial value; those that a soft start may hide only after rest().
  [[nodiscard]] std::optional<std::int64_t> held(bla::Address address) const {
    return bla::find(before_, address);
  }

  void tell(const Text& stage) const;

  // Reads.

  [[nodiscard]] Result<Reply> ask(const dronecan::Request& request);
  [[nodiscard]] Result<void> pause(Duration time);
  [[nodiscard]] Result<std::int64_t> read(bla::Address address);

  /// Reads once, whatever the result.
  [[nodiscard]] Result<Reply> read_once(bla::Address address);

  /// Proves that the servo has not restarted since it was identified.
  [[nodiscard]] Result<void> prove_run();

  // Changes.

  /// Switches the output off, unless it already is or brakes: nothing moves, no soft start goes on.
  /// Then reads all settings; the output has its initial value in the result.
  [[nodiscard]] Result<bla::Values> rest();

  /// Takes commands that were first readable at rest as the initial ones: a servo need not show
  /// them before.
  void learn_commands(const bla::Values& now);

  /// Errors: state, naming the first setting that differs.
  [[nodiscard]] std::optional<Error> differs_from(const bla::Values& now,
                                                  const bla::Values& expected) const;

  [[nodiscard]] const bla::Values& before() const { return before_; }

  /// Checks that it is still the same unit, by its serial number, if it was silent in between.
  /// Errors: state; as read().
  [[nodiscard]] Result<void> meet();

  /// Writes a value that the model allows, and returns the register's value afterwards.
  [[nodiscard]] Result<std::int64_t> write(bla::Address address, std::int64_t raw);

  /// Writes a value that must be accepted. Errors also: refused.
  [[nodiscard]] Result<void> set(bla::Address address, std::int64_t raw);

  /// Writes once, possibly out of range: to 0x27 only.
  [[nodiscard]] Result<Reply> write_timeout_time(std::int64_t raw);

  /// Sends one ArrayCommand, possibly out of range, to a servo ID that no other unit has; the
  /// output must be off.
  [[nodiscard]] Result<void> command(std::int64_t servo_id, bla::Address address, std::int64_t raw);

  /// Restores the settings of the last measurement, except the output.
  [[nodiscard]] Result<void> settle();

  /// Restarts or saves, waits until the servo is back and recognises it. As soon as it is back
  /// these registers are read.
  [[nodiscard]] Result<Start> restart(RestartKind kind,
                                      const std::vector<bla::Address>& at_once = {});

  /// Takes the values that rest() has read just after a start.
  void learn_rom(const bla::Values& rom) { rom_ = rom; }

  /// Those registers, as far as they were read.
  [[nodiscard]] const bla::Values& at_once() const { return at_once_; }

  // The end.

  [[nodiscard]] bool has_changed() const { return has_changed_; }

  [[nodiscard]] bool was_saved_by_other() const { return saved_by_other().has_value(); }

  /// Restores the initial settings and the command. Errors also: what could not be restored; one
  /// refused setting does not prevent the others.
  [[nodiscard]] Result<void> put_back();

 private:
  [[nodiscard]] Result<void> run(dronecan::Job& job);
  [[nodiscard]] Result<Reply> send_write(bla::Address address, std::int64_t raw);
  [[nodiscard]] std::optional<Error> forbidden() const;

  [[nodiscard]] Guard guard() const { return {roster(), manner_.while_driven}; }

  [[nodiscard]] Error restarted_by_itself() const;
  [[nodiscard]] std::optional<Error> saved_by_other() const;
  [[nodiscard]] std::optional<Error> refuse_restart(RestartKind kind) const;
  [[nodiscard]] Result<dronecan::NodeId> leave_and_return(RestartKind kind,
                                                          const std::vector<bla::Address>& at_once);
  [[nodiscard]] Result<bla::Values> read_all();
  [[nodiscard]] Result<void> recognise(dronecan::NodeId id);
  [[nodiscard]] Result<void> find_servo();
  [[nodiscard]] Result<void> give_back();
  [[nodiscard]] Result<void> give_back_all(const bla::Values& now);
  [[nodiscard]] Result<void> give_back_standstill();
  [[nodiscard]] Result<void> give_back_settings(const bla::Values& now);
  [[nodiscard]] Result<void> give_back_output();
  [[nodiscard]] Result<void> give_back_command();
  [[nodiscard]] Result<void> give_back_start();
  [[nodiscard]] Result<void> give_back_after_start();
  [[nodiscard]] Result<void> give_back_angle();
  [[nodiscard]] bool hides(bla::Address address, std::int64_t told) const;
  [[nodiscard]] Error not_taken(bla::Address address, std::int64_t raw, std::int64_t held) const;
  [[nodiscard]] bool was_never_commanded() const;
  [[nodiscard]] std::optional<bla::Address> commanded() const;
  [[nodiscard]] bool is_of_another(std::int64_t node_id) const;
  [[nodiscard]] bool is_as_before(const bla::Values& now) const;
  [[nodiscard]] Result<void> try_set(bla::Address address, std::int64_t raw);
  void note_refusal(Error error);
  [[nodiscard]] Result<void> prove_given(const bla::Values& now) const;
  [[nodiscard]] const bla::Parameter* motion() const;
  [[nodiscard]] bool is_put_back(bla::Address address, std::int64_t raw) const;
  [[nodiscard]] std::string put_back_hint(const std::vector<const bla::Parameter*>& left) const;
  [[nodiscard]] Error not_put_back(const Error& reason) const;

  Session& session_;
  const bla::Profiles& profiles_;
  const BenchManner& manner_;
  std::vector<Neighbour> neighbours_;
  Servo servo_;
  StartWatch start_watch_;
  bla::Values before_;             ///< to be restored at the end
  bla::Values rom_;                ///< values in ROM, once known
  bla::Values hidden_;             ///< the initial values that a soft start may have hidden
  bla::Values known_;              ///< last read
  std::set<bla::Address> touched_; ///< since settle()
  Bystanders bystanders_;          ///< since the beginning
  bla::Values at_once_;
  std::optional<SaveRestartJob> restart_; ///< the last one, used by start_watch_
  bool has_changed_ = false;
  Time begin_;        ///< of the bench
  Time met_at_;       ///< last known to be the same unit
  Time in_ram_since_; ///< what others wrote before was lost in a restart
  bool puts_back_ = false;
  bool has_started_ = false;        ///< since rest(): 0x00 need not show what is held
  bool is_starting_softly_ = false; ///< as far as known, since the restore
  std::optional<Error> refused_;    ///< the first refusal during the restore
};

} // namespace blactl::fleet
