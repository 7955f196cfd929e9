#include "blactl/fleet/line/station.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/change.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "fleet/line/absence_watch.hpp"
#include "fleet/line/acceptance.hpp"
#include "fleet/line/acceptance_texts.hpp"
#include "fleet/line/presence.hpp"
#include "fleet/line/station_texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <string_view>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using dronecan::NodeId;
using state::LedgerRecord;

namespace {

/// Settings, and what a record tells beside them.
std::vector<const bla::Parameter*> registers_of_record(const Servo& servo) {
  auto registers = servo.identity.configuration();
  constexpr std::array more{at::current_temperature, at::current_voltage,  at::fault_summary,
                            at::fault_notice,        at::fault_warning,    at::fault_failure,
                            at::production_year,     at::production_month, at::production_day,
                            at::production_hour,     at::production_minute};
  std::ranges::copy(servo.identity.registers(more), std::back_inserter(registers));
  return registers;
}

/// Nobody restarts a servo at a station by a command.
Error at_station(Error error) {
  if (error.code == Code::rom_unread && error.node_id) {
    error.hint = say<texts::station_rom_unread_hint>(*error.node_id);
  }
  return error;
}

/// The label's serial number and that of the servo, where they differ.
void enter_label_mismatch(LedgerRecord& record, const Label& label) {
  if (label.serial_number && label.serial_number != record.serial_number) {
    record.parameter = "serial_number";
    record.expected = label.serial_number;
    record.actual = record.serial_number;
  }
}

/// The first setting that was read as something else.
std::optional<Error> first_wrong(const Snapshot& held, std::span<const bla::Assignment> settings,
                                 LedgerRecord& record) {
  for (const bla::Assignment& each : settings) {
    const auto actual = held.raw(each.parameter->address);
    if (actual != each.value.raw) {
      record.parameter = std::string(each.parameter->name);
      record.expected = each.value.raw;
      record.actual = actual;
      return compare(held, {{each.parameter->address, each.value.raw}});
    }
  }
  return std::nullopt;
}

/// Whether the unit may hold other settings since, by what was done to it then.
bool may_have_written(const LedgerRecord& record) {
  const bool was_killed =
      record.verdict == verdict::error && record.code == name(Code::interrupted);
  return was_killed || record.changed_count.value_or(0) > 0;
}

Error several(std::optional<std::uint8_t> id) {
  return {Code::several_servos, say<texts::station_several>(), say<texts::station_several_hint>(),
          id};
}

} // namespace

std::string_view name(StationStage stage) {
  switch (stage) {
  case StationStage::waiting: return "waiting";
  case StationStage::recognised: return "recognised";
  case StationStage::working: return "working";
  case StationStage::gone: return "gone";
  case StationStage::ended: return "ended";
  case StationStage::left: return "left";
  case StationStage::other: return "other";
  case StationStage::take_off: break;
  }
  return "take_off";
}

Station::Station(Session& session, const bla::Profiles& profiles, state::LedgerStore& ledger,
                 state::CounterStore& counters, Options options, StageHook entered)
    : session_(session), profiles_(profiles), ledger_(ledger), counters_(counters),
      options_(std::move(options)), entered_(std::move(entered)) {}

Station::~Station() = default;

Result<std::vector<LedgerRecord>> Station::end_interrupted() {
  auto begun = ledger_.begun(options_.common.station);
  if (!begun) {
    return begun;
  }
  for (LedgerRecord& record : *begun) {
    end(record, verdict::error, Error{Code::interrupted, {}}, session_.wall());
    record.reason = say<texts::station_was_killed>();
    const auto number = ledger_.end(record);
    if (!number) {
      return std::unexpected(number.error());
    }
    record.station_seq = *number;
  }
  return begun;
}

/// What the ledger says of a unit, by this recipe; any other has changed it since.
struct Station::Past {
  std::optional<std::int64_t> other_serial{}; ///< one of its unique ID has this number
  bool is_finished = false;
  std::optional<std::int64_t> servo_id{}, static_node_id{}; ///< with which it was finished
  std::int64_t attempts = 0;
  unsigned failed = 0; ///< since it was finished or scrapped

  [[nodiscard]] bool has_ids_of(const Label* label) const {
    return label == nullptr ||
           ((!label->servo_id || label->servo_id == servo_id) &&
            (!label->static_node_id || label->static_node_id == static_node_id));
  }
};

Result<Station::Past> Station::past_of(const Servo& servo) const {
  Past past;
  const state::LedgerQuery query{.unique_id = hex(*servo.unique_id)};
  const auto read = ledger_.each(query, [&](const LedgerRecord& record) {
    if (record.recipe != options_.common.recipe) {
      past.is_finished = past.is_finished && !may_have_written(record);
      return true;
    }
    if (has_other_serial(servo, record.serial_number)) {
      past.other_serial = record.serial_number;
    }
    const bool counts = record.verdict == verdict::pass || record.verdict == verdict::fail ||
                        record.verdict == verdict::error;
    past.attempts += counts ? 1 : 0;
    if (record.verdict == verdict::pass || record.verdict == verdict::scrap) {
      past.is_finished =
          record.verdict == verdict::pass && record.recipe_sha256 == options_.common.recipe_sha256;
      past.servo_id = record.servo_id;
      past.static_node_id = record.static_node_id;
      past.failed = 0;
    } else if (record.verdict == verdict::fail && record.code != name(Code::attempts)) {
      past.is_finished = false; // done anew, and not well
      ++past.failed;
    } else if (record.verdict == verdict::error) {
      past.is_finished = false; // begun anew, perhaps, and not ended
    }
    return true;
  });
  const auto begun = read ? ledger_.begun() : std::unexpected(read.error());
  if (!begun) {
    return std::unexpected(begun.error());
  }
  const bool is_begun =
      std::ranges::find(*begun, query.unique_id, &LedgerRecord::unique_id) != begun->end();
  past.is_finished = past.is_finished && !is_begun; // by another station
  return past;
}

/// The one servo, and what it says it is.
std::optional<Error> Station::identify(const Arrival& arrival, Servo& servo) const {
  const Roster& roster = session_.roster();
  const NodeId id = arrival.ids.front();
  if (arrival.ids.size() > 1 || is_asked() || roster.is_doubled(id)) {
    return several({});
  }
  servo = roster.member(id).servo();
  if (!roster.member(id).is_known() || !servo.is_servo || !servo.unique_id) {
    return unless_away(silent(roster, id), id);
  }
  return not_unique(roster, id);
}

/// Whether a servo of another unit, as far as known, is there, too.
bool Station::is_beside_another(NodeId id) const {
  const Member own = session_.roster().member(id);
  return std::ranges::any_of(servos_there(), [&](NodeId other) {
    return other != id &&
           !(own.info && session_.roster().member(other).is_unit(own.info->unique_id));
  });
}

/// An error of a servo that has left is that; one beside another servo is that of two.
Error Station::unless_away(Error error, NodeId id) const {
  if (error.code == Code::state && is_beside_another(id)) {
    return several(id.value());
  }
  const bool is_silence = error.code == Code::timeout || error.code == Code::not_found;
  const bool is_away = session_.roster().member(id).last_heard < session_.now() - away_time &&
                       (is_silence || error.code == Code::not_back || error.code == Code::mismatch);
  // it may be back as its answers are given up
  const bool was_away = watch_->was_away() && (is_silence || error.code == Code::state);
  return is_away || was_away ? Error{Code::not_back, say<texts::station_pulled>(),
                                     say<texts::station_pulled_hint>(), id.value()}
                             : error;
}

Result<LedgerRecord> Station::work_on(const Arrival& arrival, const Label* label) {
  LedgerRecord record = begun_record(options_.common, arrival.wall);
  record.node_id = arrival.has_asked ? 0 : arrival.ids.front().value();
  if (label != nullptr) {
    enter(record, *label);
  }
  Servo servo;
  auto wrong = identify(arrival, servo);
  enter(record, servo);
  if (!wrong) {
    wrong = check_unit(servo, options_.recipe, label, profiles_);
  }
  if (wrong) {
    if (wrong->code == Code::label_mismatch) {
      enter_label_mismatch(record, *label);
    }
    const std::string_view verdict = verdict_of(wrong->code);
    return commit(std::move(record), arrival.at, verdict, std::move(wrong));
  }
  const auto past = past_of(servo);
  if (!past) {
    return std::unexpected(past.error());
  }
  record.attempt = past->attempts + 1;
  if (past->other_serial) {
    return commit(std::move(record), arrival.at, verdict::fail,
                  Error{Code::duplicate_unique_id,
                        say<texts::station_other_serial>(*past->other_serial),
                        say<texts::unit_aside_hint>(), servo.id.value()});
  }
  if (past->is_finished && !options_.redo && past->has_ids_of(label)) {
    record.attempt = past->attempts;
    return commit(std::move(record), arrival.at, verdict::skip, std::nullopt);
  }
  wrong = past->failed >= options_.max_attempts
              ? std::optional(Error{Code::attempts, say<texts::station_attempts>(past->failed),
                                    say<texts::unit_aside_hint>(), servo.id.value()})
              : number_and_configure(servo, label, record);
  const std::string_view verdict = wrong ? verdict_of(wrong->code) : verdict::pass;
  return commit(std::move(record), arrival.at, verdict, std::move(wrong));
}

Result<LedgerRecord> Station::refuse_joined() {
  LedgerRecord record = begun_record(options_.common, session_.wall());
  const auto servos = servos_there();
  record.node_id = servos.empty() || is_asked(last_.end) ? 0 : servos.front().value();
  Visit before = last_;
  auto committed = commit(std::move(record), session_.now(), verdict::error, several({}));
  last_.unit = before.unit; // its result stands as long as it is there
  last_.nodes = std::move(before.nodes);
  return committed;
}

std::optional<Error> Station::number_and_configure(const Servo& servo, const Label* label,
                                                   LedgerRecord& record) {
  const auto wishes = ids_wished(options_.recipe, label);
  const auto ids =
      counters_.assign(*servo.unique_id, *options_.common.recipe, wishes, session_.wall());
  auto settings = ids ? settings_for(options_.recipe, wishes, *ids, profiles_)
                      : Result<std::vector<bla::Assignment>>(std::unexpected(ids.error()));
  if (!settings) {
    return settings.error();
  }
  if (auto wrong = configure(servo, std::move(*settings), record)) {
    return wrong;
  }
  // somebody may have scrapped it meanwhile
  const auto now =
      counters_.assign(*servo.unique_id, *options_.common.recipe, wishes, session_.wall());
  if (!now) {
    return now.error();
  }
  return *now == *ids ? std::nullopt
                      : std::optional(Error{Code::state, say<texts::station_ids_freed>(),
                                            say<texts::station_pulled_hint>(), servo.id.value()});
}

std::optional<Error> Station::configure(const Servo& servo, std::vector<bla::Assignment> settings,
                                        LedgerRecord& record) {
  Manner manner = options_.manner;
  manner.entered = [this](const Servo& /*servo*/, ChangeStage stage) {
    watch_->expect_restart(stage == ChangeStage::save || stage == ChangeStage::restart);
  };
  Change change(
      session_, profiles_,
      {.manner = std::move(manner), .knows_ids = true, .searched = session_.roster().last_heard()});
  const Goal goal{.id = servo.id,
                  .unique_id = servo.unique_id,
                  .wanted = {.assignments = settings, .restart = RestartKind::save},
                  .evidence = Evidence::restart};
  auto errors = change.prepare({goal});
  if (errors.empty() && change.overwrites_rom()) {
    return Error{Code::rom_unread, say<texts::station_rom_unread>(),
                 say<texts::station_rom_unread_hint>(servo.id.value()), servo.id.value()};
  }
  if (!errors.empty()) {
    return at_station(unless_away(std::move(errors.front()), servo.id));
  }
  if (const auto begun = ledger_.begin(record); !begun) {
    return begun.error();
  }
  go_to(StationStage::working);
  errors = change.carry_out();
  const GoalResult& result = change.results().front();
  enter(record, result);
  const NodeId id = result.change.node_id_after.value_or(servo.id);
  if (!errors.empty() || !result.is_done) {
    const auto& all = errors.empty() ? result.errors : errors;
    if (result.change.is_rom_unread && !all.empty()) {
      Error unread = all.front();
      unread.hint = say<texts::station_rom_unread_hint>(id.value());
      return unread;
    }
    return unless_away(all.empty()
                           ? Error{Code::state, say<texts::station_unproven>(), {}, id.value()}
                           : all.front(),
                       id);
  }
  return prove(servo, id, settings, record);
}

/// Reads everything once more: what is recorded was seen after the restart. What another node wrote
/// meanwhile is not the unit's fault.
std::optional<Error> Station::prove(const Servo& servo, NodeId id,
                                    std::span<const bla::Assignment> settings,
                                    LedgerRecord& record) {
  const Time began = session_.now();
  const std::array ids{id};
  auto read =
      take_snapshots(session_, profiles_, ids, options_.manner.identification, registers_of_record);
  if (read.broken) {
    return std::move(read.broken);
  }
  const Snapshot& held = read.servos.front();
  if (auto error = held.first_error()) {
    return unless_away(std::move(*error), id);
  }
  if (held.servo.unique_id != servo.unique_id) {
    return several(id.value());
  }
  enter(record, held, profiles_);
  if (const auto writer = session_.roster().setter_of(id, began)) {
    return Error{Code::state, say<texts::written_by_other>(id.value(), writer->value()),
                 say<texts::other_writer_hint>(), id.value()};
  }
  auto wrong = first_wrong(held, settings, record);
  wrong = wrong ? std::move(wrong) : check_rom(held);
  return wrong ? at_station(std::move(*wrong)) : check_faults(held.values(), profiles_, id);
}

Result<LedgerRecord> Station::commit(LedgerRecord record, Time began, std::string_view verdict,
                                     std::optional<Error> reason) {
  end(record, verdict, reason, session_.wall());
  const bool is_given = options_.common.reason.has_value();
  if (const auto remark = !is_given && options_.remark ? options_.remark() : std::nullopt) {
    record.reason = record.reason ? *record.reason + "; " + *remark : *remark;
  }
  record.duration_s = std::chrono::duration<double>(session_.now() - began).count();
  const auto number = ledger_.end(record);
  if (!number) {
    return std::unexpected(number.error());
  }
  record.station_seq = *number;
  reason_ = std::move(reason);
  remember(record);
  watch_.reset();
  go_to(StationStage::ended);
  return record;
}

} // namespace blactl::fleet
