#include "blactl/fleet/line/line_record.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/rfc3339.hpp"
#include "blactl/base/sha256.hpp"
#include "blactl/bla/explain.hpp"

#include "fleet/line/acceptance.hpp"

#include <fmt/format.h>

#include <sys/random.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;
using state::LedgerRecord;

namespace {

/// 128 random bits: unique among the records of all machines.
std::string new_record_id() {
  std::array<std::uint8_t, 16> bytes{};
  std::size_t filled = 0;
  while (filled < bytes.size()) { // up to 256 bytes never fail but for a signal
    const auto got = getrandom(&bytes.at(filled), bytes.size() - filled, 0);
    filled += got > 0 ? static_cast<std::size_t>(got) : 0U;
  }
  return hex(bytes);
}

void enter_first_wrong(LedgerRecord& record, const std::vector<RegisterChange>& changes) {
  const auto wrong = std::ranges::find_if(changes, [](const RegisterChange& change) {
    return change.status == ChangeStatus::mismatch || change.status == ChangeStatus::failed;
  });
  if (wrong != changes.end()) {
    record.parameter = std::string(wrong->parameter->name);
    record.expected = wrong->requested;
    record.actual = wrong->after;
  }
}

std::int64_t changed_in(const std::vector<RegisterChange>& changes) {
  return std::ranges::count_if(
      changes, [](const RegisterChange& change) { return change.status == ChangeStatus::written; });
}

std::string text_of(std::optional<std::int64_t> number) {
  return number ? std::to_string(*number) : std::string();
}

} // namespace

std::string_view verdict_of(Code code) {
  switch (code) {
  case Code::model_mismatch:
  case Code::no_profile:
  case Code::firmware_too_old:
  case Code::label_mismatch:
  case Code::unsupported:
  case Code::out_of_range:
  case Code::read_only:
  case Code::rom_unread:
  case Code::faults:
  case Code::mismatch:
  case Code::refused:
  case Code::attempts:
  case Code::timeout:
  case Code::duplicate_unique_id: return verdict::fail;
  default: return verdict::error;
  }
}

bool is_done_again(Code code) {
  return code == Code::not_back || code == Code::interface || code == Code::bus_off ||
         code == Code::no_acknowledge;
}

LedgerRecord begun_record(const LedgerRecord& common, WallTime now) {
  LedgerRecord record = common;
  record.record_id = new_record_id();
  record.time = record.start_time = rfc3339(now);
  return record;
}

void enter(LedgerRecord& record, const Servo& servo) {
  const bla::Readings& readings = servo.identity.readings();
  record.unique_id = servo.unique_id ? std::optional(hex(*servo.unique_id)) : std::nullopt;
  record.serial_number = readings.serial_number;
  const std::string model = servo.identity.model();
  record.model = model.empty() ? std::nullopt : std::optional(model);
  record.firmware_version = readings.firmware_version;
  record.hardware_version = readings.hardware_version;
  record.servo_id = servo.servo_id;
  record.static_node_id = servo.static_node_id;
  if (const bla::Profile* profile = servo.identity.profile()) {
    record.profile_sha256 = digest(*profile);
  }
}

void enter(LedgerRecord& record, const Label& label) {
  record.label = label.text;
  record.work_order = label.work_order ? label.work_order : record.work_order;
  record.operator_name = label.operator_name ? label.operator_name : record.operator_name;
}

void enter(LedgerRecord& record, const GoalResult& result) {
  record.changed_count = changed_in(result.change.changes);
  if (const auto id = result.change.node_id_after) {
    record.node_id_after = id->value();
  }
  enter_first_wrong(record, result.change.changes);
}

void enter(LedgerRecord& record, const Snapshot& held, const bla::Profiles& profiles) {
  const bla::Values values = held.values();
  record.node_id_after = held.servo.id.value();
  record.servo_id = held.raw(at::servo_id);
  record.static_node_id = held.raw(at::static_node_id);
  record.production_date = bla::production_time(values);
  record.config_sha256 = digest(held);
  record.temperature_c = held.raw(at::current_temperature);
  if (const auto voltage = held.raw(at::current_voltage)) {
    constexpr double volts = 0.1; // table 3-2
    record.voltage_v = static_cast<double>(*voltage) * volts;
  }
  record.faults = fault_bits(values, profiles);
}

void end(LedgerRecord& record, std::string_view verdict, const std::optional<Error>& error,
         WallTime now) {
  record.verdict = std::string(verdict);
  record.code = error ? std::optional(std::string(name(error->code))) : std::nullopt;
  record.time = rfc3339(now);
  if (error && !error->message.empty() && !record.reason) {
    record.reason = error->message;
  }
}

std::string digest(const Snapshot& held) {
  std::string text;
  for (const auto& [address, raw] : held.values()) {
    const bla::Parameter* parameter = held.servo.identity.parameter(address);
    if (parameter != nullptr && parameter->is_setting()) {
      text += fmt::format("{}={}\n", address.name(), raw);
    }
  }
  return sha256(text);
}

std::string digest(const bla::Profile& profile) {
  std::string text =
      fmt::format("{} {} {}\n", profile.model, profile.model_number, profile.hardware_version);
  for (const bla::Parameter& each : profile.parameters) {
    text += fmt::format("{} {} {} {} {} {} {} {}\n", each.address.name(), each.name,
                        each.writable() ? "W" : "R", each.is_setting() ? "saved" : "",
                        text_of(each.default_raw), text_of(each.min), text_of(each.max),
                        text_of(each.min_firmware));
  }
  return sha256(text);
}

} // namespace blactl::fleet
