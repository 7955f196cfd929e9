#include "blactl/fleet/characterize/characterization.hpp"

#include "blactl/base/json_writer.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/former_ids.hpp"
#include "blactl/fleet/change/guard.hpp"
#include "blactl/fleet/change/plan.hpp"
#include "blactl/fleet/change/survey.hpp"

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;

namespace {

/// A present command of speed or torque, which no restart can bring back.
std::optional<Error> refuse_motion(const Servo& servo, const bla::Values& now) {
  const std::uint8_t id = servo.id.value();
  for (const Address address : {at::command_speed, at::command_torque}) {
    const auto raw = bla::find(now, address);
    const bla::Parameter* parameter = servo.identity.parameter(address);
    if (parameter != nullptr && raw && *raw != 0 && *raw != bla::not_active) {
      return Error{Code::cross_check, say<texts::bench_moves>(id, bla::display(*parameter, *raw)),
                   say<texts::bench_moves_hint>(id), id};
    }
  }
  return std::nullopt;
}

/// What an earlier one that was killed has left in RAM. `in_ram`: the newest change first.
std::optional<Error> refuse_leftover(const Servo& servo,
                                     std::span<const state::SnapshotEntry> in_ram) {
  if (in_ram.empty() || in_ram.front().command != characterizing) {
    return std::nullopt;
  }
  const std::uint8_t id = servo.id.value();
  return Error{Code::state, say<texts::bench_left>(id), say<texts::bench_left_hint>(id), id};
}

/// RAM is to be restored at the end: its contents must be known, and be the same as before.
Result<void> measure_at_rest(TestBench& bench, Notes& notes) {
  bench.tell(texts::bench_stage_settings);
  const auto now = bench.rest();
  if (!now) {
    return std::unexpected(now.error());
  }
  if (auto difference = bench.differs_from(*now, bench.before())) {
    return std::unexpected(std::move(*difference));
  }
  bench.learn_commands(*now);
  if (auto moves = refuse_motion(bench.servo(), *now)) { // hidden before
    moves->code = Code::state;
    return std::unexpected(std::move(*moves));
  }
  for (const Measurement measure : measurements_at_rest()) {
    auto measured = measure(bench, notes);
    measured = measured ? bench.settle() : measured;
    if (!measured) {
      return measured;
    }
  }
  return bench.prove_run();
}

Result<void> measure_all(TestBench& bench, Notes& notes) {
  bench.tell(texts::bench_stage_answers);
  for (const Measurement measure : measurements_of_answers()) {
    if (auto measured = measure(bench, notes); !measured) {
      return measured;
    }
  }
  const auto measured = measure_at_rest(bench, notes);
  return measured ? measure_starts(bench, notes) : measured;
}

void write_about(JsonWriter& json, const Characterization& measured, WallTime now,
                 std::string_view tool_version) {
  const bla::Readings& readings = measured.servo.identity.readings();
  json.key("about");
  json.begin_object();
  json.member("model", measured.servo.identity.model());
  const auto number = [&](std::string_view key, const std::optional<std::int64_t>& raw) {
    if (raw) {
      json.member(key, *raw);
    }
  };
  number("serial_number", readings.serial_number);
  number("firmware_version", readings.firmware_version);
  number("hardware_version", readings.hardware_version);
  if (const auto& info = measured.info) {
    json.member("name", printable(info->name));
    json.member("software", fmt::format("{}.{}", info->software_major, info->software_minor));
    json.member("hardware", fmt::format("{}.{}", info->hardware_major, info->hardware_minor));
  }
  json.member("time", rfc3339(now));
  json.member("tool_version", tool_version);
  json.end_object();
}

/// Until everything is put back, undo can do so. Returns the reason why nothing must be changed.
std::optional<Error> record(const Session& session, const Snapshot& before,
                            const BenchManner& manner) {
  if (manner.history == nullptr) {
    return std::nullopt;
  }
  const Plan all{.before = before, .may_change_all = true};
  const auto kept = manner.history->keep(std::span(&all, 1), session);
  return kept || !manner.not_recorded ? std::nullopt : manner.not_recorded(kept.error());
}

/// `in_ram`: the changes in RAM only that it holds again.
void take_back(const Session& session, const Servo& servo, std::vector<state::SnapshotEntry> in_ram,
               const BenchManner& manner) {
  if (manner.history == nullptr) {
    return;
  }
  const auto unique_id = servo.unique_id.value_or(dronecan::UniqueId{});
  auto taken = manner.history->take_back(std::span(&unique_id, 1));
  if (taken) {
    taken = manner.history->renew(std::move(in_ram), session);
  }
  if (!taken && manner.end_not_recorded) {
    manner.end_not_recorded(taken.error());
  }
}

/// What could not be put back is in RAM only, after the last restart.
void keep_as_left(const Session& session, const Servo& servo,
                  std::vector<state::SnapshotEntry> in_ram, const BenchManner& manner) {
  if (manner.history == nullptr) {
    return;
  }
  const auto unique_id = servo.unique_id.value_or(dronecan::UniqueId{});
  const auto kept = manner.history->renew_own(unique_id, std::move(in_ram), session);
  if (!kept && manner.end_not_recorded) {
    manner.end_not_recorded(kept.error());
  }
}

/// Another node's SAVE has made permanent what RAM held then: undo is to put ROM back, too.
void keep_as_saved(const Session& session, const Servo& servo, const BenchManner& manner) {
  const ChangeResult saved{
      .servo = servo, .was_sent = true, .may_have_changed = true, .may_have_saved = true};
  const auto kept = manner.history != nullptr
                        ? manner.history->conclude(std::span(&saved, 1), session)
                        : Result<void>();
  if (!kept && manner.end_not_recorded) {
    manner.end_not_recorded(kept.error());
  }
}

} // namespace

Result<std::vector<const bla::Parameter*>> registers_to_characterize(const Servo& servo) {
  if (servo.identity.profile() == nullptr) {
    return fail(Code::no_profile, say<texts::only_readable>());
  }
  auto registers = servo.identity.configuration();
  std::ranges::copy(servo.identity.registers(bla::command_registers),
                    std::back_inserter(registers));
  return registers;
}

std::optional<Error> refuse_to_characterize(const Session& session, const Snapshot& before,
                                            bool while_driven) {
  if (auto error = before.first_error()) {
    return error;
  }
  if (auto moves = refuse_motion(before.servo, before.values())) {
    return moves;
  }
  // a restart is what moves it most
  const Plan plan{.before = before, .restart = RestartKind::restart};
  return forbidden(session.roster(), session.now(), plan, while_driven);
}

std::string question_to_characterize(const Snapshot& before) {
  const std::uint8_t id = before.servo.id.value();
  std::string question = say<texts::bench_question>(id, restarts_measured);
  const auto angle = before.raw(at::command_angle);
  const bla::Parameter* parameter = before.servo.identity.parameter(at::command_angle);
  if (angle && *angle != bla::not_active && parameter != nullptr &&
      before.raw(at::torque_output) == 0) {
    question += say<texts::bench_question_angle>(bla::display(*parameter, *angle));
  }
  return question;
}

Characterization characterize(Session& session, const bla::Profiles& profiles,
                              const Snapshot& before, const BenchManner& manner) {
  const Servo& servo = before.servo;
  auto others = neighbours(session, profiles, manner.identification, Unidentified::asked, servo.id);
  if (!others) {
    return {.servo = servo, .error = std::move(others.error())};
  }
  auto in_ram = manner.history != nullptr ? manner.history->unsaved(servo, session, &before)
                                          : std::vector<state::SnapshotEntry>();
  auto refused = refuse_leftover(servo, in_ram);
  refused = refused ? refused : record(session, before, manner);
  if (refused) {
    return {.servo = servo, .error = std::move(refused)};
  }
  FormerIds ids(session, {{servo.unique_id.value_or(dronecan::UniqueId{}), servo.id}},
                manner.allocations);
  dronecan::Allocator allocator(session.node(), ids);
  const bool allocates = manner.may_allocate && session.roster().allocators().empty();
  if (allocates) {
    session.attach(allocator);
  }
  Discovery recogniser(session, profiles, manner.identification);
  recogniser.recognise();
  session.set_grace(put_back_time);
  Notes notes;
  TestBench bench(session, profiles, before, manner, std::move(*others));
  const auto ended = measure_all(bench, notes);
  if (!ended && bench.has_changed() && manner.putting_back) {
    manner.putting_back();
  }
  const auto given = bench.put_back();
  session.detach(allocator);
  Characterization measured = std::move(notes).result();
  measured.servo = bench.servo();
  measured.was_put_back = bench.has_changed() && given.has_value();
  if (!ended) {
    measured.error = ended.error();
  }
  if (!given) {
    measured.not_put_back = given.error();
  }
  if (bench.was_saved_by_other()) {
    keep_as_saved(session, servo, manner);
  } else if (given) {
    take_back(session, servo, std::move(in_ram), manner);
  } else {
    keep_as_left(session, servo, std::move(in_ram), manner);
  }
  return measured;
}

std::string facts_file(const Characterization& measured, WallTime now,
                       std::string_view tool_version) {
  std::string text;
  JsonWriter json(text, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("schema", "blactl-facts/1");
  json.key("behaviour");
  json.begin_object();
  for (const Fact& fact : measured.facts) {
    if (fact.value) {
      json.key(fact.setting);
      std::visit([&](const auto& value) { json.value(value); }, *fact.value);
    }
  }
  json.end_object();
  write_about(json, measured, now, tool_version);
  json.end_object();
  return text + '\n';
}

} // namespace blactl::fleet
