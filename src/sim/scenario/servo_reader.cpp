#include "sim/scenario/servo_reader.hpp"

#include "blactl/bla/value.hpp"

#include "sim/scenario/firmware_history.hpp"
#include "sim/scenario/member.hpp"
#include "sim/scenario/member_tables.hpp"
#include "sim/scenario/scenario_values.hpp"
#include "sim/scenario/texts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace blactl::sim {
namespace {

constexpr std::int64_t first_serial_number = 240'900'001;
constexpr std::int64_t max_servo_id = 254;
constexpr std::int64_t max_uint8 = std::numeric_limits<std::uint8_t>::max();
constexpr std::int64_t max_uint16 = std::numeric_limits<std::uint16_t>::max();
constexpr std::int64_t max_uint32 = std::numeric_limits<std::uint32_t>::max();

constexpr Member<ServoSetup> numbers[]{
    {"node_id", integer<&ServoSetup::node_id, 0, dronecan::NodeId::max>},
    {"serial_number", integer<&ServoSetup::serial_number, 0, max_uint32>},
    {"servo_id", integer<&ServoSetup::servo_id, 0, max_servo_id>},
    {"firmware_version", integer<&ServoSetup::firmware_version, 0, max_uint16>},
    {"model_number", integer<&ServoSetup::model_number, 0, max_uint8>},
    {"hardware_version", integer<&ServoSetup::hardware_version, 0, max_uint16>},
};

/// The newest firmware that chapter 5 lists for a model; 0 if it lists none.
std::int64_t newest_firmware(const bla::Profiles& profiles, const bla::Profile& profile) {
  const auto versions = shipped_firmware(profiles, profile.model);
  return versions.empty() ? 0 : versions.back();
}

std::string default_name(std::string_view series) {
  std::string name = "jp.co.futaba.";
  for (const char letter : series) {
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return name;
}

/// The number that `values` assign to a register, the last one if repeated; else `fallback`.
std::int64_t given(const std::vector<std::pair<bla::Address, std::int64_t>>& values,
                   bla::Address address, std::int64_t fallback) {
  for (const auto& [where, raw] : values) {
    fallback = where == address ? raw : fallback;
  }
  return fallback;
}

} // namespace

ServoSetup ServoReader::read(const json::Value& value, std::size_t index) {
  ServoSetup servo;
  json::Object object(value, faults_);
  const std::string label = object.string("model");
  servo.profile = model(object, label);
  servo.serial_number = first_serial_number + static_cast<std::int64_t>(index);
  if (servo.profile != nullptr) {
    servo.firmware_version = newest_firmware(profiles_, *servo.profile);
    servo.model_number = servo.profile->model_number;
    servo.hardware_version = servo.profile->hardware_version;
  }
  read_members(object, numbers, servo, faults_);
  check_firmware(object, label, servo);
  servo.unique_id =
      read_unique_id(object, static_cast<std::uint64_t>(servo.serial_number), faults_);
  servo.name = read_node_name(
      object, default_name(servo.profile != nullptr ? servo.profile->series : ""), faults_);
  servo.rom = registers(object.optional_object("rom"), Memory::rom, servo);
  servo.ram = registers(object.optional_object("ram"), Memory::ram, servo);
  servo.behaviour = usual_;
  read_whole(object.optional_object("behaviour"), behaviour_members, servo.behaviour, faults_);
  up_to_seconds<&Behaviour::answer_delay, 10>(object, "answer_delay", servo.behaviour, faults_);
  read_whole(object.optional_object("faults"), servo_fault_members, servo.faults, faults_);
  read_whole(object.optional_object("sending"), sending_members, servo.sending, faults_);
  object.finish();
  return servo;
}

/// `wanted` is a full model or a label of one, not just the beginning of its name.
const bla::Profile* ServoReader::model(json::Object& object, const std::string& wanted) {
  for (const bla::Profile* profile : profiles_.matching(wanted)) {
    if (wanted.size() >= profile->model.size()) {
      return profile;
    }
  }
  if (const json::Value* value = object.optional_any("model");
      value != nullptr && value->kind == json::Kind::string) {
    std::string models;
    for (const bla::Profile& profile : profiles_.all()) {
      models += (models.empty() ? "" : ", ") + profile.model;
    }
    faults_.add(*value, say<texts::scenario_model_unknown>(wanted, models));
  }
  return nullptr;
}

/// Requirement 184. Only a warning: the unit may have been updated, or the firmware may be newer
/// than the specification.
void ServoReader::check_firmware(json::Object& object, const std::string& label,
                                 const ServoSetup& servo) {
  const json::Value* where = object.optional_any("firmware_version");
  if (servo.profile == nullptr || where == nullptr) {
    return;
  }
  // The letters are taken from the profile, the last digit from the label.
  const std::string model = servo.profile->model + label.substr(servo.profile->model.size());
  const auto versions = shipped_firmware(profiles_, model);
  if (versions.empty() || std::ranges::find(versions, servo.firmware_version) != versions.end()) {
    return;
  }
  std::string known;
  for (const std::int64_t version : versions) {
    known += (known.empty() ? "" : ", ") + bla::firmware_text(version);
  }
  warnings_.push_back(fmt::format(
      "{}:{}: {}: {}", printable(faults_.file()), where->line, where->pointer(),
      say<texts::scenario_firmware>(model, bla::firmware_text(servo.firmware_version), known)));
}

ServoReader::Values ServoReader::registers(json::Object object, Memory memory,
                                           const ServoSetup& servo) {
  Values values;
  if (!object.exists()) {
    return values;
  }
  const auto members = object.members(); // without a model they cannot be checked
  if (servo.profile == nullptr) {
    return values;
  }
  in_pwm_mode_.clear();
  for (const json::Value* member : members) {
    const bla::Parameter* meant = parameter(*member, memory, *servo.profile);
    if (const auto raw = meant != nullptr ? register_value(*member, *meant) : std::nullopt) {
      values.emplace_back(meant->address, *raw);
    }
  }
  // If this memory does not set 0x37, RAM takes it from ROM, and ROM from the factory.
  const bla::Parameter* mode = servo.profile->find(bla::address::pwm_mode);
  const std::int64_t factory = mode != nullptr ? mode->default_raw.value_or(0) : 0;
  check_pwm_modes(
      given(values, bla::address::pwm_mode, given(servo.rom, bla::address::pwm_mode, factory)));
  return values;
}

std::optional<std::int64_t> ServoReader::register_value(const json::Value& value,
                                                        const bla::Parameter& parameter) {
  const auto text = typed_text(value, faults_);
  if (!text) {
    return std::nullopt;
  }
  const auto named = bla::find_address(value.key) ? bla::NamedBy::address : bla::NamedBy::name;
  const auto typed = bla::parse_value(parameter, named, *text);
  if (!typed) {
    faults_.add(value, typed.error().message);
    return std::nullopt;
  }
  if (const auto fits = bla::check_range(parameter, typed->raw); !fits) {
    faults_.add(value, fits.error().message);
    return std::nullopt;
  }
  if (typed->pwm_mode) {
    in_pwm_mode_.push_back({&value, *typed->pwm_mode});
  }
  return typed->raw;
}

/// The register named by a key of "ram" or "rom"; null, with an error, if it cannot be set there.
const bla::Parameter* ServoReader::parameter(const json::Value& value, Memory memory,
                                             const bla::Profile& profile) {
  const auto found = profiles_.find(value.key);
  if (!found) {
    faults_.add(value, found.error().message);
    return nullptr;
  }
  using namespace bla::address;
  constexpr std::array keys{
      std::pair{servo_id, "servo_id"},
      std::pair{static_node_id, "node_id"},
      std::pair{model_number, "model_number"},
      std::pair{serial_number, "serial_number"},
      std::pair{firmware_version, "firmware_version"},
      std::pair{hardware_version, "hardware_version"},
  };
  const bla::Address address = (*found)->address;
  if (const auto own = std::ranges::find(keys, address, [](const auto& key) { return key.first; });
      own != keys.end()) {
    faults_.add(value, say<texts::scenario_own_key>((*found)->name, own->second));
    return nullptr;
  }
  constexpr bla::Address fault_summary{0x18}; // derived from the other three
  if (!(*found)->readable() || address == fault_summary) {
    faults_.add(value, say<texts::scenario_no_memory>((*found)->name));
    return nullptr;
  }
  if (memory == Memory::rom && !(*found)->saved) {
    faults_.add(value, say<texts::scenario_not_in_rom>((*found)->name));
    return nullptr;
  }
  const bla::Parameter* meant = profile.find(address);
  if (meant == nullptr) {
    faults_.add(value, say<texts::scenario_not_in_model>((*found)->name, profile.model));
  }
  return meant;
}

void ServoReader::check_pwm_modes(std::int64_t actual) {
  for (const InPwmMode& value : in_pwm_mode_) {
    if (value.mode != actual) {
      faults_.add(*value.where, say<texts::scenario_pwm_mode>(value.mode, actual));
    }
  }
}

} // namespace blactl::sim
