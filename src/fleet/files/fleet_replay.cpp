#include "blactl/fleet/files/fleet_replay.hpp"

#include "blactl/base/text.hpp"

#include "fleet/files/texts.hpp"

#include <array>
#include <bitset>
#include <charconv>
#include <optional>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;

namespace {

/// The last ID for servos; higher ones are for tools.
constexpr std::uint8_t last_servo_id = 125;

/// The model in an entry; null: none, or a part of its name.
const bla::Profile* model_of(const FleetEntry& entry, const bla::Profiles& profiles) {
  const auto models = profiles.matching(entry.about.model.value_or(entry.match.model));
  return models.size() == 1 ? models.front() : nullptr;
}

void add(bla::Values& values, bla::Address address, const std::optional<std::int64_t>& raw) {
  if (raw) {
    values.emplace(address, *raw);
  }
}

/// "2025-06-22 15:30", as written by bla::production_time(); other texts are ignored.
void add_production(bla::Values& values, std::string_view date) {
  namespace at = bla::address;

  struct Part {
    bla::Address address;
    std::size_t first, size;
  };

  constexpr std::array parts{Part{at::production_year, 0, 4}, Part{at::production_month, 5, 2},
                             Part{at::production_day, 8, 2}, Part{at::production_hour, 11, 2},
                             Part{at::production_minute, 14, 2}};
  for (const Part& part : parts) {
    const std::string_view text = date.size() >= part.first + part.size
                                      ? date.substr(part.first, part.size)
                                      : std::string_view();
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (text.empty() || error != std::errc() || end != text.data() + text.size()) {
      return;
    }
    values.emplace(part.address, number);
  }
}

bla::Values values_of(const FleetEntry& entry, const bla::Profile* model) {
  namespace at = bla::address;
  bla::Values values;
  for (const bla::Assignment& assignment : entry.set) {
    values.emplace(assignment.parameter->address, assignment.value.raw);
  }
  add(values, at::servo_id, entry.match.servo_id);
  add(values, at::model_number,
      model != nullptr ? std::optional(model->model_number) : std::nullopt);
  add(values, at::serial_number, entry.match.serial_number);
  add(values, at::firmware_version, entry.about.firmware_version);
  add(values, at::hardware_version, entry.about.hardware_version);
  add_production(values, entry.about.production_date.value_or(std::string()));
  return values;
}

Result<RecordedServo> servo_of(const FleetEntry& entry, const bla::Profiles& profiles,
                               const bla::Profile* assumed) {
  namespace at = bla::address;
  const bla::Profile* model = model_of(entry, profiles);
  RecordedServo recorded{.servo = {}, .values = values_of(entry, model)};
  const auto value = [&](bla::Address address) { return bla::find(recorded.values, address); };
  Servo& servo = recorded.servo;
  servo.unique_id = entry.match.unique_id;
  servo.is_servo = true;
  servo.servo_id = value(at::servo_id);
  servo.static_node_id = value(at::static_node_id);
  servo.identity = bla::Identity(profiles, {.model_number = value(at::model_number),
                                            .serial_number = value(at::serial_number),
                                            .firmware_version = value(at::firmware_version),
                                            .hardware_version = value(at::hardware_version)});
  for (const bla::Profile* said : {assumed, model}) { // the hardware version may be missing
    if (const auto agreed = said != nullptr ? servo.identity.assume(*said) : Result<void>();
        !agreed) {
      return std::unexpected(agreed.error());
    }
  }
  return recorded;
}

std::optional<NodeId> told_id(const FleetEntry& entry) {
  if (entry.match.node_id) {
    return entry.match.node_id;
  }
  const auto fixed = entry.wish(bla::address::static_node_id).value_or(0);
  return fixed != 0 ? std::optional(NodeId(static_cast<std::uint8_t>(fixed))) : std::nullopt;
}

/// Assigns a unique ID to every entry.
class Places {
 public:
  /// False: another entry already has it.
  [[nodiscard]] bool take(NodeId id) {
    const bool is_free = !taken_[id.value()];
    taken_.set(id.value());
    return is_free;
  }

  [[nodiscard]] std::optional<NodeId> take_any() {
    for (std::uint8_t id = 1; id <= last_servo_id; ++id) {
      if (take(NodeId(id))) {
        return NodeId(id);
      }
    }
    return std::nullopt;
  }

 private:
  std::bitset<NodeId::max + 1> taken_;
};

} // namespace

Result<FleetRecording> recording_of(const FleetFile& file, const bla::Profiles& profiles,
                                    const bla::Profile* assumed) {
  FleetRecording recording;
  Places places;
  std::vector<RecordedServo> elsewhere;
  for (const FleetEntry& entry : file.servos) {
    if (!entry.match.means_one()) {
      recording.of_many.push_back(&entry);
      continue;
    }
    auto servo = servo_of(entry, profiles, assumed);
    if (!servo) {
      return std::unexpected(servo.error());
    }
    if (const auto id = told_id(entry); id && places.take(*id)) {
      servo->servo.id = *id;
      recording.servos.push_back(std::move(*servo));
    } else {
      recording.without_id.push_back(&entry);
      elsewhere.push_back(std::move(*servo));
    }
  }
  for (RecordedServo& servo : elsewhere) { // after all those with an ID
    const auto id = places.take_any();
    if (!id) {
      return fail(Code::bad_file, say<texts::fleet_too_many>(printable(file.file)),
                  say<texts::fleet_too_many_hint>());
    }
    servo.servo.id = *id;
    servo.servo.id_is_known = false;
    recording.servos.push_back(std::move(servo));
  }
  return recording;
}

} // namespace blactl::fleet
