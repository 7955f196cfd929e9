#include "fleet/characterize/test_bench.hpp"

#include "blactl/bla/value.hpp"
#include "blactl/dronecan/types.hpp"
#include "blactl/fleet/bus/array_command.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/guard.hpp"

#include "fleet/characterize/jobs.hpp"
#include "fleet/characterize/soft_start.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using bla::Values;

namespace {

using namespace std::chrono_literals;

constexpr std::int64_t torque_output_on = 0, torque_output_off = 1; // 4.13

/// NodeStatus comes once a second (2.2).
constexpr Duration longest_until_status = 1200ms;

} // namespace

TestBench::TestBench(Session& session, const bla::Profiles& profiles, const Snapshot& before,
                     const BenchManner& manner, std::vector<Neighbour> neighbours)
    : session_(session), profiles_(profiles), manner_(manner), neighbours_(std::move(neighbours)),
      servo_(before.servo), start_watch_(before.servo.unique_id.value_or(dronecan::UniqueId{})),
      before_(before.values()), bystanders_(session.roster()), begin_(before.servo.since),
      met_at_(session.now()), in_ram_since_(begin_) {
  for (const auto& [address, limit] : soft_start_limits) {
    if (const auto raw = bla::find(before_, address)) {
      hidden_[address] = *raw;
      before_.erase(address);
    }
  }
  session_.attach(start_watch_);
}

TestBench::~TestBench() {
  session_.detach(start_watch_);
}

void TestBench::tell(const Text& stage) const {
  if (manner_.progress) {
    manner_.progress(std::string(choose(stage.en, stage.ja)));
  }
}

/// The job lives until it has ended. A first signal ends whatever may be ended, and the
/// measurements.
Result<void> TestBench::run(dronecan::Job& job) {
  if (!session_.node().is_running(job)) {
    session_.start(job);
  }
  const auto lived = session_.live_until(never, [&] { return !session_.node().is_running(job); });
  if (!lived) {
    return std::unexpected(lived.error());
  }
  return session_.signal() != 0 && !puts_back_ ? std::unexpected(interrupted_by(session_.signal()))
                                               : Result<void>();
}

Result<Reply> TestBench::ask(const dronecan::Request& request) {
  Question question(request, puts_back_);
  const auto ran = run(question);
  return ran ? Result<Reply>(question.reply()) : std::unexpected(ran.error());
}

Result<void> TestBench::pause(Duration time) {
  return session_.live_until(session_.now() + time);
}

Result<Reply> TestBench::read_once(Address address) {
  return ask(read_register(servo_.id, address, {manner_.identification.patience.timeout, 0}));
}

Result<std::int64_t> TestBench::read(Address address) {
  const bla::Parameter* parameter = servo_.identity.parameter(address);
  const auto reply = ask(read_register(servo_.id, address, manner_.identification.patience));
  if (!reply) {
    return std::unexpected(reply.error());
  }
  const dronecan::Outcome outcome{reply->kind, reply->payload, reply->at, reply->asked};
  auto raw = register_value(outcome, servo_.id, address,
                            parameter != nullptr ? parameter->width : bla::Width{});
  if (raw) {
    known_[address] = *raw;
  }
  return raw;
}

Result<Values> TestBench::read_all() {
  Values values;
  auto registers = servo_.identity.configuration();
  std::ranges::copy(servo_.identity.registers(bla::command_registers),
                    std::back_inserter(registers));
  for (const bla::Parameter* parameter : registers) {
    const auto raw = read(parameter->address);
    if (!raw) {
      return std::unexpected(raw.error());
    }
    values[parameter->address] = *raw;
  }
  return values;
}

Result<void> TestBench::prove_run() {
  RunProof proof(roster(), servo_, servo_.since, manner_.identification.patience);
  if (auto ran = run(proof); !ran) {
    return ran;
  }
  if (proof.error()) {
    return std::unexpected(*proof.error());
  }
  return proof.verdict() == RunProof::Verdict::ran_on ? Result<void>()
                                                      : std::unexpected(restarted_by_itself());
}

Error TestBench::restarted_by_itself() const {
  const std::uint8_t id = servo_.id.value();
  if (auto saved = saved_by_other()) {
    return std::move(*saved);
  }
  return {Code::state, say<texts::bench_restarted>(id), say<texts::bench_restarted_hint>(), id};
}

/// Its SAVE keeps what RAM held at that moment.
std::optional<Error> TestBench::saved_by_other() const {
  const std::uint8_t id = servo_.id.value();
  const auto by = roster().saver_of(servo_.id, begin_);
  return by ? std::optional(Error{Code::state, say<texts::bench_saved_by_other>(id, by->value()),
                                  say<texts::bench_saved_by_other_hint>(id), id})
            : std::nullopt;
}

/// Checks the conditions that forbid writing, before every change, putting back too: a servo
/// that another node drives is left as it is.
std::optional<Error> TestBench::forbidden() const {
  if (auto why = guard().forbids(servo_, session_.now())) {
    return why;
  }
  return roster().member(servo_.id).boots != servo_.boot ? std::optional(restarted_by_itself())
                                                         : std::nullopt;
}

Result<Values> TestBench::rest() {
  const auto output = read(at::torque_output);
  if (!output) {
    return std::unexpected(output.error());
  }
  // Written even if off: a command ends a soft start, and shows the real value of 0x00.
  const auto off =
      set(at::torque_output, *output == torque_output_on ? torque_output_off : *output);
  auto values = off ? read_all() : std::unexpected(off.error());
  if (!values) {
    return values;
  }
  is_starting_softly_ = has_started_ = false;
  (*values)[at::torque_output] = *output;
  for (const auto& [address, raw] : std::exchange(hidden_, {})) {
    before_[address] = (*values)[address];
  }
  return values;
}

void TestBench::learn_commands(const Values& now) {
  for (const Address address : bla::command_registers) {
    const auto raw = bla::find(now, address);
    const bool moves = address != at::command_angle && raw != 0 && raw != bla::not_active;
    if (raw && !moves) {
      before_[address] = *raw;
    } else { // it stays at rest
      before_.erase(address);
    }
  }
}

std::optional<Error> TestBench::differs_from(const Values& now, const Values& expected) const {
  const std::uint8_t id = servo_.id.value();
  for (const auto& [address, raw] : expected) {
    const auto found = bla::find(now, address);
    const bla::Parameter* parameter = servo_.identity.parameter(address);
    if (parameter != nullptr && parameter->is_setting() && found != raw) {
      return Error{Code::state,
                   say<texts::bench_changed>(id, parameter->name,
                                             found ? bla::display(*parameter, *found) : "?",
                                             bla::display(*parameter, raw)),
                   say<texts::run_again_hint>(), id};
    }
  }
  return std::nullopt;
}

/// Another unit that has taken its place shows by its NodeStatus only up to a second later.
Result<void> TestBench::meet() {
  const Member member = roster().member(servo_.id);
  const Time now = session_.now();
  if (member.back_at <= met_at_ && now - member.last_heard <= longest_pause) {
    return {};
  }
  const auto told = read(at::serial_number);
  if (!told) {
    return std::unexpected(told.error());
  }
  met_at_ = now;
  const std::uint8_t id = servo_.id.value();
  return *told == servo_.identity.readings().serial_number
             ? Result<void>()
             : std::unexpected(Error{Code::state, say<texts::another_servo>(id),
                                     say<texts::run_again_hint>(), id});
}

/// One request a try, each after meet(): a repetition could reach another unit.
Result<Reply> TestBench::send_write(Address address, std::int64_t raw) {
  const Patience once{manner_.identification.patience.timeout, 0};
  for (int tries = 0;; ++tries) {
    if (auto met = meet(); !met) {
      return std::unexpected(std::move(met.error()));
    }
    if (auto why = forbidden()) {
      return std::unexpected(std::move(*why));
    }
    auto reply = ask(guard().guarded(write_register(servo_.id, address, raw, once), servo_));
    const bool is_lost = reply && reply->kind == dronecan::Outcome::Kind::timed_out;
    if (!is_lost || tries == manner_.identification.patience.retries) {
      return reply;
    }
  }
}

Result<std::int64_t> TestBench::write(Address address, std::int64_t raw) {
  if (auto why = forbidden()) {
    return std::unexpected(std::move(*why));
  }
  if (auto allowed = servo_.identity.may_write(address, raw); !allowed) {
    return std::unexpected(allowed.error());
  }
  has_changed_ = true;
  if (servo_.identity.is_setting(address) && address != at::torque_output) {
    touched_.insert(address);
  }
  const auto reply = send_write(address, raw);
  // a read is authoritative, whatever the response said
  return reply ? read(address) : std::unexpected(reply.error());
}

Result<void> TestBench::set(Address address, std::int64_t raw) {
  const auto held = write(address, raw);
  return held == raw ? Result<void>()
                     : std::unexpected(held ? not_taken(address, raw, *held) : held.error());
}

Error TestBench::not_taken(Address address, std::int64_t raw, std::int64_t held) const {
  const bla::Parameter& parameter = *servo_.identity.parameter(address);
  const std::uint8_t id = servo_.id.value();
  return {Code::refused,
          say<texts::bench_set_refused>(id, parameter.name, bla::display(parameter, raw),
                                        bla::display(parameter, held)),
          say<texts::not_taken_hint>(id), id};
}

Result<Reply> TestBench::write_timeout_time(std::int64_t raw) {
  if (auto why = forbidden()) {
    return std::unexpected(std::move(*why));
  }
  has_changed_ = true;
  touched_.insert(at::timeout_time);
  return ask(write_register(servo_.id, at::timeout_time, raw,
                            {manner_.identification.patience.timeout, 0}));
}

Result<void> TestBench::command(std::int64_t servo_id, Address address, std::int64_t raw) {
  constexpr Duration until_taken = 50ms;
  if (auto why = forbidden()) {
    return std::unexpected(std::move(*why));
  }
  if (const auto other = bystanders_.obeys(roster(), servo_, servo_id)) {
    const std::uint8_t id = servo_.id.value();
    return std::unexpected(Error{Code::duplicate_servo_id,
                                 say<texts::bench_bystander>(id, other->value(), servo_id),
                                 say<texts::bench_bystander_hint>(), id});
  }
  has_changed_ = true;
  known_[address] = raw; // unless it is deaf: the worst is what is to be put back
  session_.node().broadcast(
      dronecan::ArrayCommand::type, dronecan::priority_medium,
      array_command(static_cast<std::uint8_t>(servo_id), address, raw).encode());
  return pause(until_taken);
}

Result<void> TestBench::settle() {
  for (const Address address : std::exchange(touched_, {})) {
    const auto raw = held(address);
    if (auto given = raw ? set(address, *raw) : Result<void>(); !given) {
      return given;
    }
  }
  touched_.clear(); // by setting them
  return {};
}

Result<void> TestBench::recognise(dronecan::NodeId id) {
  IdentifyJob identify(session_.records(), id, profiles_, manner_.identification);
  if (auto ran = run(identify); !ran) {
    return ran;
  }
  if (identify.identification().error()) {
    return std::unexpected(*identify.identification().error());
  }
  const Servo& found = identify.identification().servo();
  if (found.unique_id != servo_.unique_id) {
    return std::unexpected(Error{Code::state, say<texts::another_servo>(id.value()),
                                 say<texts::run_again_hint>(), id.value()});
  }
  servo_ = found;
  met_at_ = session_.now();
  return {};
}

std::optional<Error> TestBench::refuse_restart(RestartKind kind) const {
  if (auto why = forbidden()) {
    return why;
  }
  const auto writer = roster().writer_to(servo_.id, in_ram_since_);
  if (kind == RestartKind::save && writer) { // the writer's values are not those in ROM
    const std::uint8_t id = servo_.id.value();
    return Error{Code::state, say<texts::other_writer>(id, writer->value()),
                 say<texts::other_writer_hint>(), id};
  }
  return std::nullopt;
}

/// Until the servo is back; meanwhile these registers are requested.
Result<dronecan::NodeId> TestBench::leave_and_return(RestartKind kind,
                                                     const std::vector<Address>& at_once) {
  const Patience& patience = manner_.identification.patience;
  restart_.emplace(roster(), servo_,
                   SaveRestartJob::Options{.kind = kind,
                                           .come_back = longest_start,
                                           .patience = patience,
                                           .may_be_driven = manner_.while_driven});
  start_watch_.expect(servo_.id, [this] { return restart_->is_sent(); });
  EarlyReads early(
      servo_.id, servo_.identity.registers(at_once), [this] { return start_watch_.is_back(); },
      patience.timeout);
  session_.start(early);
  auto ran = run(*restart_);
  if (ran && start_watch_.is_back()) {
    ran = run(early);
  } else {
    session_.cancel(early);
  }
  at_once_ = early.values();
  if (!ran) {
    return std::unexpected(ran.error());
  }
  if (restart_->error()) {
    return std::unexpected(*restart_->error());
  }
  if (restart_->is_unproven()) { // nothing was sent
    auto why = refuse_restart(kind);
    return std::unexpected(why ? std::move(*why) : restarted_by_itself());
  }
  return *restart_->returned();
}

Result<Start> TestBench::restart(RestartKind kind, const std::vector<Address>& at_once) {
  if (auto why = refuse_restart(kind)) {
    return std::unexpected(std::move(*why));
  }
  has_changed_ = has_started_ = true;
  touched_.clear();
  known_.clear();
  const auto id = leave_and_return(kind, at_once);
  if (!id) {
    return std::unexpected(id.error());
  }
  // The first response already shows that a servo is back; its own messages are to be heard, too.
  const auto heard = session_.live_until(session_.now() + longest_until_status, [&] {
    return start_watch_.start_of(*id).first_status.has_value();
  });
  const auto known = heard ? recognise(*id) : std::unexpected(heard.error());
  if (!known) {
    return std::unexpected(known.error());
  }
  in_ram_since_ = restart_->sent_at();
  Start start = start_watch_.start_of(servo_.id);
  start.asked = in_ram_since_;
  return start;
}

} // namespace blactl::fleet
