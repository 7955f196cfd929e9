#include "mixed_fleet.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace blactl::test {
namespace {

constexpr std::int64_t voltage_limit_low = 0x41, temperature_limit_low = 0x3F;

std::vector<std::string> all_models(const Bench& bench) {
  std::vector<std::string> names;
  const auto document = json(bench.run({"models", "--json"}).out);
  for (const auto& model : document["models"]) {
    names.push_back(model["model"]);
  }
  return names;
}

/// Another value than the default, spread over the range; that of a lower limit ends below that of
/// its upper one.
std::int64_t changed_value(const nlohmann::json& parameter, int serial) {
  const auto address = std::stoll(parameter["address"].get<std::string>(), nullptr, 16);
  const std::int64_t min = parameter["min"];
  const bool is_lower = address == voltage_limit_low || address == temperature_limit_low;
  const std::int64_t max = parameter["max"].get<std::int64_t>() - (is_lower ? 1 : 0);
  constexpr int steps = 100;
  const std::int64_t value =
      min + (max - min) * ((serial * 37 + address * 13) % (steps + 1)) / steps;
  const bool is_default = value == parameter["default"];
  return !is_default ? value : value < max ? value + 1 : value - 1;
}

} // namespace

MixedFleet::MixedFleet(int servos)
    : servos_(servos), models_(all_models(bench_)),
      sim_(bench_, {"sim", "--json", bench_.file("scenario.json", scenario())}, {.asks = true}) {
  for (const std::string& model : models_) {
    const auto document = json(bench_.run({"models", model, "--json"}).out);
    parameters_[model] = document["models"][0]["parameters"];
  }
}

std::string MixedFleet::scenario() const {
  nlohmann::json servos = nlohmann::json::array();
  for (int serial = 1; serial <= servos_; ++serial) {
    servos.push_back({{"model", models_[static_cast<std::size_t>(serial) % models_.size()]},
                      {"serial_number", serial},
                      {"node_id", serial},
                      {"servo_id", serial}});
  }
  return nlohmann::json({{"schema", "blactl-scenario/1"}, {"clock", "virtual"}, {"servos", servos}})
      .dump();
}

Result MixedFleet::run(Arguments arguments) const {
  arguments.insert(arguments.begin(), {"-i", "sim:"});
  return bench_.run(arguments, {.timeout = 250s});
}

const nlohmann::json& MixedFleet::parameters(int serial) const {
  return parameters_.at(models_[static_cast<std::size_t>(serial) % models_.size()]);
}

nlohmann::ordered_json MixedFleet::changed() const {
  const Result exported = run({"export"});
  REQUIRE(exported.status == 0);
  auto document = nlohmann::ordered_json::parse(exported.out);
  for (auto& entry : document["servos"]) {
    const int serial = entry["match"]["serial_number"];
    for (const auto& parameter : parameters(serial)) {
      const std::string name = parameter["name"];
      if (entry["set"].contains(name)) {
        entry["set"][name] = std::to_string(changed_value(parameter, serial)) + "raw";
      }
    }
    entry["set"]["servo_id"] = serial % servos_ + 1;
    entry["set"]["static_node_id"] = ((serial - 1) ^ 1) + 1;
  }
  return document;
}

std::string MixedFleet::file(const nlohmann::ordered_json& document) const {
  return bench_.file("fleet.json", document.dump(2));
}

std::string MixedFleet::path(std::string_view name) const {
  return bench_.folder() / name;
}

MixedFleet::States MixedFleet::look() {
  States states;
  events_ = json_lines(sim_.ask("dump", "\"dumped\""));
  for (const auto& event : events_) {
    if (event["event"] == "state") {
      states[event["serial_number"]] = event;
    }
  }
  REQUIRE(states.size() == static_cast<std::size_t>(servos_));
  return states;
}

std::ptrdiff_t MixedFleet::happened(std::string_view event) const {
  return std::ranges::count_if(events_,
                               [&](const nlohmann::json& each) { return each["event"] == event; });
}

void MixedFleet::set_voltage(std::string_view voltage) {
  std::string orders;
  for (int serial = 1; serial <= servos_; ++serial) {
    orders += std::to_string(serial) + " voltage=" + std::string(voltage) + "\n";
  }
  static_cast<void>(sim_.ask(orders + "dump", "\"dumped\""));
}

/// Time passes only while somebody listens; one who sends would leave a frame in the queue that
/// nobody acknowledges.
void MixedFleet::cycle_power() {
  set_voltage("0V");
  REQUIRE(run({"trace", "--duration", "1"}).status == 0);
  set_voltage("12V");
  REQUIRE(run({"trace", "--duration", "4"}).status == 0);
}

std::int64_t raw(const nlohmann::ordered_json& value) {
  return value.is_string() ? std::stoll(value.get<std::string>()) : value.get<std::int64_t>();
}

} // namespace blactl::test
