#include "world.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/sim/bus/private_bus.hpp"
#include "blactl/sim/scenario/scenario.hpp"

#include "buses.hpp"
#include "capture.hpp"
#include "cli/run.hpp"
#include "disk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <optional>
#include <span>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace blactl::campaign {
namespace {

constexpr std::uint8_t fault_warning = 0x1A;

const bla::Profiles& profiles() {
  static const bla::Profiles loaded = bla::Profiles::load({}).value();
  return loaded;
}

nlohmann::json document_in(const std::string& out) {
  auto whole = nlohmann::json::parse(out, nullptr, false);
  if (!whole.is_discarded()) {
    return whole;
  }
  const auto end = out.find_last_not_of('\n');
  const auto begin = end == std::string::npos ? end : out.rfind('\n', end);
  auto last = begin == std::string::npos
                  ? nlohmann::json()
                  : nlohmann::json::parse(out.substr(begin + 1), nullptr, false);
  return last.is_discarded() ? nlohmann::json() : last;
}

} // namespace

bool Command::has(std::string_view word) const {
  return std::ranges::find(words, word) != words.end();
}

std::string Command::text() const {
  std::string text = "blactl";
  for (const std::string& word : words) {
    text += " " + word;
  }
  return text;
}

std::string Command::file(bool has_ended) const {
  nlohmann::json written = fleet;
  if (broken != 0 && !has_ended) {
    written["servos"][0]["match"]["serial_number"] = broken;
  }
  return written.dump();
}

bool ServoState::has_lost_rom() const {
  const auto warnings = ram.find(fault_warning);
  return warnings != ram.end() && (warnings->second >> 15 & 1) != 0;
}

World::World(const nlohmann::json& scenario, std::filesystem::path folder)
    : scenario_(scenario), folder_(std::move(folder)) {
  power_on(scenario_, Time{});
}

World::~World() = default;

void World::power_on(const nlohmann::json& scenario, Time at) {
  auto parsed = sim::parse_scenario(scenario.dump(), "episode", profiles());
  if (!parsed) {
    throw std::invalid_argument(parsed.error().message);
  }
  simulator_ = std::make_shared<sim::Simulator>(
      *parsed, at, [this](const sim::ServoEvent& event) { events_.push_back(event); });
}

Outcome World::run(const Command& command, std::span<Disturbance> disturbances,
                   const Around& around) {
  Outcome outcome;
  std::vector<std::string> arguments{"-i", "sim:world", "--json"};
  arguments.insert(arguments.end(), command.words.begin(), command.words.end());
  write_file(command);
  std::filesystem::current_path(folder_);
  const auto opener = [&](const cli::OpenRequest& request) -> Result<cli::OpenBus> {
    std::unique_ptr<can::Bus> bus =
        std::make_unique<sim::PrivateBus>(std::string(request.text), simulator_);
    for (Disturbance& disturbance : disturbances) {
      bus = std::make_unique<DisturbedBus>(std::move(bus), disturbance);
    }
    bus = std::make_unique<Witness>(std::move(bus), outcome.record);
    return cli::OpenBus{.bus = around ? around(std::move(bus)) : std::move(bus),
                        .place = {.interface = "sim:world", .folder = folder_.string()}};
  };
  const auto of = [&](Disturbance::Kind kind) {
    const auto found = std::ranges::find(disturbances, kind, &Disturbance::kind);
    return found != disturbances.end() ? &*found : nullptr;
  };
  Disturbance* const cut = of(Disturbance::Kind::computer_off);
  std::optional<Disk> disk;
  if (cut != nullptr) {
    disk.emplace(*cut);
  }
  {
    const Capture capture;
    fail_calls(of(Disturbance::Kind::call_failed));
    outcome.status = cli::run(arguments, opener);
    fail_calls(nullptr);
    std::tie(outcome.out, outcome.err) = capture.taken();
  }
  if (disk && cut->has_struck()) {
    disk->come_back(Chance(cut->number, "disk"));
  }
  outcome.document = document_in(outcome.out);
  if (!command.fleet.is_null()) {
    std::ifstream file(folder_ / command.words.at(1));
    outcome.file.assign(std::istreambuf_iterator<char>(file), {});
  }
  return outcome;
}

/// One that `replace` is to change stays as it left it.
void World::write_file(const Command& command) const {
  if (command.fleet.is_null()) {
    return;
  }
  const auto path = folder_ / command.words.at(1);
  if (command.broken == 0 || !std::filesystem::exists(path)) {
    std::ofstream(path) << command.file(/*has_ended=*/false);
  }
}

void World::pass(Duration time) {
  simulator_->advance_to(simulator_->now() + time);
}

/// The registers of the scenario's own keys have no place in "rom".
nlohmann::json World::rom_of(const sim::Servo& servo) {
  nlohmann::json rom = nlohmann::json::object();
  for (const auto& [address, value] : state_of(servo).rom) {
    const std::string name = bla::Address(address).name();
    if (address != servo_id && address != static_node_id) {
      rom[name] = value;
    }
  }
  return rom;
}

void World::repair(const nlohmann::json& events) {
  nlohmann::json servos = nlohmann::json::array();
  for (const nlohmann::json& before : scenario_["servos"]) {
    const sim::Servo& servo =
        **std::ranges::find(simulator_->servos(), before["serial_number"].get<std::int64_t>(),
                            &sim::Servo::serial_number);
    servos.push_back({{"model", before["model"]},
                      {"serial_number", before["serial_number"]},
                      {"unique_id", hex(servo.unique_id())},
                      {"node_id", servo.registers().rom_value(bla::Address(static_node_id))},
                      {"servo_id", servo.registers().rom_value(bla::Address(servo_id))},
                      {"rom", rom_of(servo)}});
    if (before.contains("firmware_version")) {
      servos.back()["firmware_version"] = before["firmware_version"];
    }
  }
  scenario_ = {{"schema", scenario_["schema"]},
               {"clock", "virtual"},
               {"seed", scenario_["seed"]},
               {"servos", servos}};
  if (!events.is_null()) {
    scenario_["events"] = events;
  }
  power_on(scenario_, simulator_->now() + std::chrono::seconds(5));
}

ServoState World::state_of(const sim::Servo& servo) {
  constexpr unsigned end = 0x60;
  ServoState state{.unique_id = hex(servo.unique_id()),
                   .node_id = servo.node_id().value(),
                   .ram = {},
                   .rom = {},
                   .rom_writes = servo.rom_writes(),
                   .is_powered = servo.world().powers()};
  for (unsigned address = 0; address < end; ++address) {
    const auto number = static_cast<std::uint8_t>(address);
    const bla::Parameter* parameter = servo.registers().existing(bla::Address(number));
    if (parameter != nullptr && parameter->readable()) {
      state.ram.emplace(number, servo.registers().value(parameter->address));
    }
    if (parameter != nullptr && parameter->readable() && parameter->saved) {
      state.rom.emplace(number, servo.registers().rom_value(parameter->address));
    }
  }
  return state;
}

States World::states() {
  States all;
  for (sim::Servo* servo : simulator_->servos()) {
    servo->look(simulator_->now());
    all.emplace(servo->serial_number(), state_of(*servo));
  }
  return all;
}

std::vector<sim::ServoEvent> World::take_events() {
  return std::exchange(events_, {});
}

Time World::now() const {
  return simulator_->now();
}

} // namespace blactl::campaign
