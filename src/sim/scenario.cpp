#include "blactl/sim/scenario.hpp"

#include "blactl/base/json_reader.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/sim/random.hpp"
#include "blactl/sim/texts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>
#include <span>

namespace blactl::sim {
namespace {

constexpr std::string_view schema = "blactl-scenario/1";

constexpr std::string_view default_text = R"({
  "schema": "blactl-scenario/1",
  "servos": [
    {"model": "BLA21-12U-AB", "node_id": 11, "servo_id": 1},
    {"model": "BLA15-06U-A0", "node_id": 12, "servo_id": 2},
    {"model": "BLA34-28U-AB", "node_id": 13, "servo_id": 3}
  ]
})";

constexpr std::int64_t first_serial_number = 240'900'001;
constexpr std::int64_t max_node_id = dronecan::NodeId::max;
constexpr std::int64_t max_servo_id = 254;
constexpr std::int64_t max_uint16 = std::numeric_limits<std::uint16_t>::max();
constexpr std::int64_t max_uint32 = std::numeric_limits<std::uint32_t>::max();
constexpr Duration max_answer_delay = std::chrono::seconds(10);

/// The newest firmware that chapter 5 lists for the series of `profile`; 0 if it lists none.
std::int64_t newest_firmware(const bla::Profiles& profiles, const bla::Profile& profile) {
  std::int64_t newest = 0;
  for (const bla::FirmwareRelease& release : profiles.firmware()) {
    const bool shipped =
        std::ranges::any_of(release.shipments, [&](const bla::FirmwareRelease::Shipment& shipment) {
          return shipment.models.starts_with(profile.series);
        });
    newest = shipped ? std::max(newest, release.version) : newest;
  }
  return newest;
}

std::string default_name(std::string_view series) {
  std::string name = "jp.co.futaba.";
  for (const char letter : series) {
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  return name;
}

dronecan::UniqueId unique_id_from(std::uint64_t number) {
  Random random(number);
  dronecan::UniqueId id{};
  for (std::uint8_t& byte : id) {
    byte = static_cast<std::uint8_t>(random.next());
  }
  return id;
}

std::optional<dronecan::UniqueId> parse_unique_id(std::string_view text) {
  dronecan::UniqueId id{};
  if (text.size() != 2 * id.size()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < id.size(); ++i) {
    const char* at = text.data() + 2 * i;
    const auto [end, error] = std::from_chars(at, at + 2, id[i], 16);
    if (error != std::errc{} || end != at + 2) {
      return std::nullopt;
    }
  }
  return id;
}

/// As somebody would have typed it on the command line. Empty and a fault if it is neither.
std::optional<std::string> typed_text(const json::Value& value, json::Faults& faults) {
  switch (value.kind) {
  case json::Kind::integer: return std::to_string(value.integer);
  case json::Kind::real:
  case json::Kind::string: return value.text;
  default: faults.add(value, say<texts::scenario_value_kind>()); return std::nullopt;
  }
}

/// Reads one scenario; faults go to the document's list.
class Reader {
 public:
  Reader(const bla::Profiles& profiles, json::Faults& faults)
      : profiles_(profiles), faults_(faults) {}

  Scenario scenario(json::Object root);

 private:
  ServoSetup servo(const json::Value& value, std::size_t index);
  const bla::Profile* model(json::Object& object);
  void numbers(json::Object& object, std::size_t index, ServoSetup& servo);
  void ram(json::Object object, ServoSetup& servo);
  void ram_value(const json::Value& value, ServoSetup& servo);
  const bla::Parameter* ram_parameter(const json::Value& value, const bla::Profile& profile);
  void pwm_modes(const ServoSetup& servo);
  void behaviour(json::Object object, Behaviour& into);
  ForeignSetup foreign(const json::Value& value);
  CommanderSetup commander(json::Object& object);
  dronecan::UniqueId unique_id(json::Object& object, std::uint64_t fallback);
  std::string node_name(json::Object& object, std::string fallback);
  Duration delay(const json::Value& value);

  /// A value of 0x36 in a unit that is right with one value of 0x37 only.
  struct InPwmMode {
    const json::Value* where;
    std::int64_t mode;
  };

  const bla::Profiles& profiles_;
  json::Faults& faults_;
  std::vector<InPwmMode> in_pwm_mode_; ///< of the servo that is being read
};

Scenario Reader::scenario(json::Object root) {
  Scenario scenario;
  (void)root.word("schema", {schema});
  const auto clock = root.optional_word("clock", {"real", "virtual"});
  scenario.clock = clock == "virtual" ? Clock::simulated : Clock::real;
  scenario.seed = static_cast<std::uint64_t>(root.optional_integer("seed", 0).value_or(1));
  std::size_t index = 0;
  for (const json::Value* item : root.optional_array("servos")) {
    scenario.servos.push_back(servo(*item, index++));
  }
  for (const json::Value* item : root.optional_array("foreign")) {
    scenario.foreign.push_back(foreign(*item));
  }
  root.finish();
  return scenario;
}

ServoSetup Reader::servo(const json::Value& value, std::size_t index) {
  ServoSetup servo;
  json::Object object(value, faults_);
  servo.profile = model(object);
  numbers(object, index, servo);
  servo.unique_id = unique_id(object, static_cast<std::uint64_t>(servo.serial_number));
  servo.name =
      node_name(object, default_name(servo.profile != nullptr ? servo.profile->series : ""));
  if (const json::Value* typed = object.optional_any("answer_delay")) {
    servo.answer_delay = delay(*typed);
  }
  ram(object.optional_object("ram"), servo);
  behaviour(object.optional_object("behaviour"), servo.behaviour);
  if (json::Object faults = object.optional_object("faults"); faults.exists()) {
    servo.faults.lose_responses = static_cast<std::uint32_t>(
        faults.optional_integer("lose_responses", 0, max_uint32).value_or(0));
    servo.faults.mute = faults.optional_boolean("mute").value_or(false);
    faults.finish();
  }
  object.finish();
  return servo;
}

const bla::Profile* Reader::model(json::Object& object) {
  const std::string wanted = object.string("model");
  const auto found = std::ranges::find(profiles_.all(), wanted, &bla::Profile::model);
  if (found != profiles_.all().end()) {
    return &*found;
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

/// Keys that are integers; what the model says if they are left out.
void Reader::numbers(json::Object& object, std::size_t index, ServoSetup& servo) {
  const bla::Profile unknown;
  const bla::Profile& model = servo.profile != nullptr ? *servo.profile : unknown;
  const auto number = [&](std::string_view key, std::int64_t max, std::int64_t fallback) {
    return object.optional_integer(key, 0, max).value_or(fallback);
  };
  servo.node_id = static_cast<std::uint8_t>(number("node_id", max_node_id, 0));
  servo.serial_number =
      number("serial_number", max_uint32, first_serial_number + static_cast<std::int64_t>(index));
  servo.servo_id = number("servo_id", max_servo_id, 0);
  servo.firmware_version =
      number("firmware_version", max_uint16, newest_firmware(profiles_, model));
  servo.model_number =
      number("model_number", std::numeric_limits<std::uint8_t>::max(), model.model_number);
  servo.hardware_version = number("hardware_version", max_uint16, model.hardware_version);
}

void Reader::ram(json::Object object, ServoSetup& servo) {
  if (!object.exists() || servo.profile == nullptr) {
    if (object.exists()) {
      (void)object.members(); // without a model nothing can be said about them
    }
    return;
  }
  in_pwm_mode_.clear();
  for (const json::Value* member : object.members()) {
    ram_value(*member, servo);
  }
  pwm_modes(servo);
}

void Reader::ram_value(const json::Value& value, ServoSetup& servo) {
  const bla::Parameter* parameter = ram_parameter(value, *servo.profile);
  const auto text = typed_text(value, faults_);
  if (parameter == nullptr || !text) {
    return;
  }
  const auto named = bla::find_address(value.key) ? bla::NamedBy::address : bla::NamedBy::name;
  const auto typed = bla::parse_value(*parameter, named, *text);
  if (!typed) {
    faults_.add(value, typed.error().message);
    return;
  }
  if (const auto fits = bla::check_range(*parameter, typed->raw); !fits) {
    faults_.add(value, fits.error().message);
    return;
  }
  servo.ram.emplace_back(parameter->address, typed->raw);
  if (typed->pwm_mode) {
    in_pwm_mode_.push_back({&value, *typed->pwm_mode});
  }
}

/// The register that a key of "ram" means; null and a fault if it cannot be set there.
const bla::Parameter* Reader::ram_parameter(const json::Value& value, const bla::Profile& profile) {
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
  const bla::Parameter* parameter = profile.find(address);
  if (parameter == nullptr) {
    faults_.add(value, say<texts::scenario_not_in_model>((*found)->name, profile.model));
  }
  return parameter;
}

void Reader::pwm_modes(const ServoSetup& servo) {
  const bla::Parameter* mode = servo.profile->find(bla::address::pwm_mode);
  std::int64_t actual = mode != nullptr ? mode->default_raw.value_or(0) : 0;
  for (const auto& [address, raw] : servo.ram) {
    if (address == bla::address::pwm_mode) {
      actual = raw;
    }
  }
  for (const InPwmMode& value : in_pwm_mode_) {
    if (value.mode != actual) {
      faults_.add(*value.where, say<texts::scenario_pwm_mode>(value.mode, actual));
    }
  }
}

void Reader::behaviour(json::Object object, Behaviour& into) {
  if (!object.exists()) {
    return;
  }
  const auto reads = [&](std::string_view key) {
    return object.optional_word(key, {"fail", "zero"}) == "zero" ? MissingRead::zero
                                                                 : MissingRead::fail;
  };
  const auto flag = [&](std::string_view key, bool fallback) {
    return object.optional_boolean(key).value_or(fallback);
  };
  const bool clamps = object.optional_word("out_of_range", {"refuse", "clamp"}) == "clamp";
  into.out_of_range = clamps ? OutOfRange::clamp : OutOfRange::refuse;
  into.reserved_reads = reads("reserved_reads");
  into.gated_reads = reads("gated_reads");
  into.write_only_reads = reads("write_only_reads");
  into.index_only_access = flag("index_only_access", into.index_only_access);
  into.failure_with_name = flag("failure_with_name", into.failure_with_name);
  into.ignores_disabled_commands =
      flag("ignores_disabled_commands", into.ignores_disabled_commands);
  object.finish();
}

ForeignSetup Reader::foreign(const json::Value& value) {
  ForeignSetup node;
  json::Object object(value, faults_);
  (void)object.word("kind", {"node"});
  node.node_id = static_cast<std::uint8_t>(object.integer("node_id", 1, max_node_id));
  node.name = node_name(object, "org.example.node");
  // Beyond every serial number, so that no servo has the same.
  node.unique_id = unique_id(object, (std::uint64_t{1} << 32U) + node.node_id);
  node.serves_get_set = object.optional_boolean("serves_get_set").value_or(false);
  if (json::Object commands = object.optional_object("commands"); commands.exists()) {
    node.commands = commander(commands);
  }
  node.armed = object.optional_boolean("armed");
  object.finish();
  return node;
}

CommanderSetup Reader::commander(json::Object& object) {
  constexpr std::size_t max_commands = 15;
  constexpr double max_float16 = 65504;
  constexpr double max_rate_hz = 1000;
  CommanderSetup commander;
  const auto ids = object.array("servo_ids");
  for (const json::Value* item : ids) {
    const auto id = json::as_integer(*item, faults_, 0, max_servo_id + 1); // 255: every servo
    commander.servo_ids.push_back(static_cast<std::uint8_t>(id.value_or(0)));
  }
  if (object.exists() && (ids.empty() || ids.size() > max_commands)) {
    faults_.add(object.value(), say<texts::scenario_servo_ids>());
  }
  commander.type = static_cast<std::uint8_t>(
      object.optional_integer("type", 0, std::numeric_limits<std::uint8_t>::max()).value_or(1));
  commander.value =
      static_cast<float>(object.optional_number("value", -max_float16, max_float16).value_or(0));
  const double rate = object.optional_number("rate", 1, max_rate_hz).value_or(50);
  commander.period = Duration(static_cast<Duration::rep>(1e6 / rate));
  object.finish();
  return commander;
}

dronecan::UniqueId Reader::unique_id(json::Object& object, std::uint64_t fallback) {
  const auto text = object.optional_string("unique_id");
  if (!text) {
    return unique_id_from(fallback);
  }
  const auto id = parse_unique_id(*text);
  if (!id) {
    faults_.add(*object.optional_any("unique_id"), say<texts::scenario_unique_id>());
  }
  return id.value_or(dronecan::UniqueId{});
}

std::string Reader::node_name(json::Object& object, std::string fallback) {
  constexpr std::size_t max_name = 80;
  auto name = object.optional_string("name");
  if (name && (name->empty() || name->size() > max_name)) {
    faults_.add(*object.optional_any("name"), say<texts::scenario_node_name>());
  }
  return name ? *std::move(name) : std::move(fallback);
}

/// By the value grammar, as if it were a register that counts microseconds.
Duration Reader::delay(const json::Value& value) {
  bla::Parameter time;
  time.name = "answer_delay";
  time.unit = bla::Unit::microsecond;
  const auto text = typed_text(value, faults_);
  if (!text) {
    return {};
  }
  const auto typed = bla::parse_value(time, bla::NamedBy::name, *text);
  if (!typed) {
    faults_.add(value, typed.error().message);
    return {};
  }
  const Duration delay(typed->raw);
  if (delay < Duration::zero() || delay > max_answer_delay) {
    faults_.add(value, say<texts::scenario_delay>());
  }
  return delay;
}

Result<Scenario> from_document(Result<json::Document> document, const bla::Profiles& profiles) {
  if (!document) {
    return std::unexpected(document.error());
  }
  json::Faults& faults = document->faults();
  Scenario scenario = Reader(profiles, faults).scenario(json::Object(document->root(), faults));
  if (const auto fine = faults.result(); !fine) {
    return std::unexpected(fine.error());
  }
  return scenario;
}

} // namespace

Result<Scenario> read_scenario(const std::filesystem::path& file, const bla::Profiles& profiles) {
  return from_document(json::parse_file(file), profiles);
}

Result<Scenario> parse_scenario(std::string_view text, std::string file,
                                const bla::Profiles& profiles) {
  return from_document(json::parse(text, std::move(file)), profiles);
}

Result<Scenario> default_scenario(const bla::Profiles& profiles) {
  return parse_scenario(default_text, "sim:", profiles);
}

} // namespace blactl::sim
