#pragma once
// One servo on the bench: it is asked, written to, restarted, and given back what it held.

#include "blactl/bla/profile.hpp"
#include "blactl/fleet/change/restart_job.hpp"
#include "blactl/fleet/characterize/characterization.hpp"

#include "fleet/characterize/ear.hpp"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace blactl::fleet {

/// How long a start may take, with the allocation of a node ID and the longest ROM write.
inline constexpr Duration longest_start = std::chrono::seconds(15);

/// What came of one question, kept.
struct Reply {
  dronecan::Outcome::Kind kind = dronecan::Outcome::Kind::start;
  std::vector<std::uint8_t> payload{};
  Time asked{}, at{};

  [[nodiscard]] bool answered() const { return kind == dronecan::Outcome::Kind::answered; }
};

/// Every error of its functions ends the measuring: those that end a session; what guards every
/// change (duplicate_node_id, armed, driven, state: it restarted by itself); timeout and refused
/// where the servo must answer. Whatever it writes it remembers before, for put_back().
class TestBench {
 public:
  /// All references outlive this. `before`: what the servo held.
  TestBench(Session& session, const bla::Profiles& profiles, const Snapshot& before,
            const BenchManner& manner);
  ~TestBench();
  TestBench(const TestBench&) = delete;
  TestBench(TestBench&&) = delete;
  TestBench& operator=(const TestBench&) = delete;
  TestBench& operator=(TestBench&&) = delete;

  [[nodiscard]] const Servo& servo() const { return servo_; }

  [[nodiscard]] const bla::Profiles& profiles() const { return profiles_; }

  [[nodiscard]] const Roster& roster() const { return session_.roster(); }

  [[nodiscard]] const Ear& ear() const { return ear_; }

  /// What it held before; of what a soft start may hide only once rest() has looked.
  [[nodiscard]] std::optional<std::int64_t> held(bla::Address address) const {
    return bla::find(before_, address);
  }

  /// Says what is done now.
  void tell(const Text& stage) const;

  // Questions.

  [[nodiscard]] Result<Reply> ask(const dronecan::Request& request);
  [[nodiscard]] Result<void> pause(Duration time);
  [[nodiscard]] Result<std::int64_t> read(bla::Address address);

  /// Once, whatever comes of it.
  [[nodiscard]] Result<Reply> read_once(bla::Address address);

  /// That the servo ran on since it was identified.
  [[nodiscard]] Result<void> prove_run();

  // Changes.

  /// The output off, or as off as it is: nothing moves, no soft start goes on. Then all that it
  /// holds, of the output what it was.
  [[nodiscard]] Result<bla::Values> rest();

  /// What of the commands was read at rest for the first time is what it was commanded: a servo
  /// need not tell it before.
  void learn_commands(const bla::Values& now);

  /// Errors: state, naming the first setting that is another.
  [[nodiscard]] std::optional<Error> differs_from(const bla::Values& now,
                                                  const bla::Values& expected) const;

  [[nodiscard]] const bla::Values& before() const { return before_; }

  /// Writes what the model allows; what the register holds afterwards.
  [[nodiscard]] Result<std::int64_t> write(bla::Address address, std::int64_t raw);

  /// The same, where it must take the value. Errors also: refused.
  [[nodiscard]] Result<void> set(bla::Address address, std::int64_t raw);

  /// Writes once what may be out of range: of 0x27 alone.
  [[nodiscard]] Result<Reply> write_timeout_time(std::int64_t raw);

  /// One command by ArrayCommand to this servo alone; the output must be off.
  [[nodiscard]] Result<void> command_angle(std::int64_t decideg);

  /// What the last measurement set gets back its value, the output apart.
  [[nodiscard]] Result<void> settle();

  /// Restarts or saves, waits until it is back and recognises it. As soon as it is back it is asked
  /// for these registers.
  [[nodiscard]] Result<Start> restart(RestartKind kind,
                                      const std::vector<bla::Address>& at_once = {});

  /// What rest() has read just after a start.
  void learn_rom(const bla::Values& rom) { rom_ = rom; }

  /// Those registers, as far as they were answered.
  [[nodiscard]] const bla::Values& at_once() const { return at_once_; }

  // The end.

  [[nodiscard]] bool has_changed() const { return has_changed_; }

  /// The servo holds again what it held, and does what it was commanded. Errors also: what it could
  /// not be given back; what one setting does not take keeps it from no other.
  [[nodiscard]] Result<void> put_back();

 private:
  [[nodiscard]] Result<void> run(dronecan::Job& job);
  [[nodiscard]] std::optional<Error> forbidden() const;

  /// What was changed is put back also while somebody drives the servo.
  [[nodiscard]] bool may_be_driven() const { return manner_.while_driven || puts_back_; }

  [[nodiscard]] Guard guard() const { return {roster(), may_be_driven()}; }

  [[nodiscard]] Error restarted_by_itself() const;
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
  Servo servo_;
  Ear ear_;
  bla::Values before_;             ///< what it shall hold in the end
  bla::Values rom_;                ///< what ROM holds, once it is known
  bla::Values hidden_;             ///< of it what a soft start may have hidden
  bla::Values known_;              ///< what was read last
  std::set<bla::Address> touched_; ///< since settle()
  bla::Values at_once_;
  std::optional<RestartJob> restart_; ///< the last one: the ear goes by it
  bool has_changed_ = false;
  bool puts_back_ = false;
  bool is_starting_softly_ = false; ///< as far as is known, since it was put back
  std::optional<Error> refused_;    ///< what it did not take first, while it was put back
};

} // namespace blactl::fleet
