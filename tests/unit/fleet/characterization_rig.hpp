#pragma once
// One simulated servo on the bench, to be characterized and interrupted: as a test wants it, or by
// chance.

#include "blactl/dronecan/allocator.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/change/carry_out.hpp"
#include "blactl/fleet/characterize/characterization.hpp"
#include "blactl/sim/scenario/facts.hpp"

#include "support.hpp"
#include "unit/state/processes.hpp"

#include <nlohmann/json.hpp>

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace blactl::fleet::test {

/// Writes to one register that never reach the servo: it holds what it held.
struct Deafness {
  std::string name;            ///< "0x38"
  int first = 0, last = 1'000; ///< the writes that it misses; the first is 1
  int written = 0;

  /// The last frame of such a write, which its name ends; what is only read fits into one frame.
  [[nodiscard]] bool misses(const can::Frame& frame) {
    const std::size_t size = frame.size;
    const bool is_end = size == 3 && (frame.data[2] & 0xC0U) == 0x40U;
    const bool is_one = is_end && !name.empty() && frame.data[0] == std::uint8_t(name[2]) &&
                        frame.data[1] == std::uint8_t(name[3]);
    return is_one && ++written >= first && written <= last;
  }
};

/// Passes frames on; the n-th of them, and perhaps a later one, brings a Ctrl-C.
class Interrupted final : public blactl::test::BusAround {
 public:
  explicit Interrupted(std::unique_ptr<sim::PrivateBus> bus)
      : Interrupted(bus->simulator(), std::move(bus)) {}

  [[nodiscard]] Result<bool> send(const can::Frame& frame) override {
    if (watched) {
      least = std::min(least, servo().shaft().angle);
      most = std::max(most, servo().shaft().angle);
    }
    can::Frame passed = frame;
    if (deafness.misses(frame)) {
      passed.data[1] = 0; // which its CRC tells
      spoilt = frame;
    }
    auto taken = BusAround::send(passed);
    if (taken && *taken && (++sent == at || sent == again)) {
      raise(SIGINT);
      signalled = now();
    }
    return taken;
  }

  [[nodiscard]] std::optional<can::BusEvent> receive() override {
    auto event = BusAround::receive();
    auto* echo = event ? std::get_if<can::Sent>(&*event) : nullptr;
    if (echo != nullptr && spoilt && echo->frame.id == spoilt->id && echo->frame.size == 3) {
      echo->frame = *std::exchange(spoilt, std::nullopt);
    }
    return event;
  }

  [[nodiscard]] const sim::Servo& servo() const { return *simulator_.servos().front(); }

  int sent = 0, at = -1, again = -1;
  bool watched = false; ///< where the shaft is, at each frame
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  std::int64_t most = std::numeric_limits<std::int64_t>::min();
  Time signalled{};
  Deafness deafness;
  std::optional<can::Frame> spoilt; ///< as it was, until its echo

 private:
  Interrupted(const sim::Simulator& simulator, std::unique_ptr<sim::PrivateBus>&& bus)
      : BusAround(std::move(bus)), simulator_(simulator) {}

  const sim::Simulator& simulator_;
};

inline constexpr std::uint8_t dynamic_id = 42;

/// Whoever asks.
class OneId final : public dronecan::AllocationTable {
 public:
  [[nodiscard]] bool serves(dronecan::Bytes) const override { return true; }

  [[nodiscard]] std::optional<NodeId> assign(const dronecan::UniqueId&, NodeId) override {
    return NodeId(dynamic_id);
  }
};

/// What a servo holds of what is to be given back.
struct Memory {
  std::map<bla::Address, std::int64_t> ram, rom;
};

inline std::string text(const Memory& memory) {
  std::string out;
  for (const auto& [address, raw] : memory.ram) {
    out += fmt::format("{}={} ", address.name(), raw);
  }
  for (const auto& [address, raw] : memory.rom) {
    out += fmt::format("rom {}={} ", address.name(), raw);
  }
  return out;
}

/// Where 0x00 rules it makes no difference whether 0x01 and 0x02 are 0 or not active.
inline Memory without_idle_commands(Memory memory) {
  for (const bla::Address address : {bla::address::command_speed, bla::address::command_torque}) {
    std::int64_t& raw = memory.ram[address];
    const bool rules = memory.ram.at(bla::address::command_angle) == bla::not_active;
    raw = !rules && raw == bla::not_active ? 0 : raw;
  }
  return memory;
}

/// One servo, BLA21-12U-AB at 11 unless `members` says otherwise, that has run for some time.
class Rig {
 public:
  explicit Rig(const std::string& members = "", const std::string& more = "") {
    const std::string model =
        members.find("\"model\"") == std::string::npos ? R"("model": "BLA21-12U-AB", )" : "";
    const std::string id =
        members.find("\"node_id\"") == std::string::npos ? R"("node_id": 11)" : "";
    const std::string comma = id.empty() || members.empty() ? "" : ", ";
    const auto scenario =
        sim::parse_scenario(fmt::format(R"({{"schema": "blactl-scenario/1", "clock": "virtual",
                        "servos": [{{{}{}{}{}}}]{}}})",
                                        model, id, comma, members, more),
                            "test.json", profiles());
    INFO((scenario ? "" : scenario.error().message));
    REQUIRE(scenario);
    auto interrupted =
        std::make_unique<Interrupted>(std::make_unique<sim::PrivateBus>("sim:", *scenario));
    bus = interrupted.get();
    auto opened = Session::open(std::move(interrupted), state::LocalNodeId::unshared({}),
                                Session::Hearing::all, profiles());
    REQUIRE(opened);
    session = std::move(*opened);
    OneId table;
    dronecan::Allocator allocator(session->node(), table);
    session->attach(allocator);
    REQUIRE(session->live_until(session->now() + 5s));
    session->detach(allocator);
  }

  [[nodiscard]] Memory memory() const {
    Memory memory;
    const sim::Memory& registers = bus->servo().registers();
    for (std::uint8_t value = 0; value <= 0x46; ++value) {
      const bla::Address address(value);
      const bla::Parameter* parameter = registers.existing(address);
      if (parameter != nullptr && (parameter->saved || parameter->group == bla::Group::command)) {
        memory.ram[address] = registers.value(address);
      }
      if (parameter != nullptr && parameter->saved) {
        memory.rom[address] = registers.rom_value(address);
      }
    }
    return memory;
  }

  /// What it holds, as the command looks at it before its question.
  [[nodiscard]] Snapshot look(std::uint8_t id = 11) const {
    const std::vector ids{NodeId(id)};
    auto snapshots = take_snapshots(*session, profiles(), ids, {}, registers_to_characterize);
    REQUIRE_FALSE(snapshots.broken);
    INFO((snapshots.servos[0].first_error() ? snapshots.servos[0].first_error()->message : ""));
    REQUIRE_FALSE(snapshots.servos[0].first_error());
    return snapshots.servos[0];
  }

  [[nodiscard]] Characterization measure(std::uint8_t id = 11) const {
    return characterize(*session, profiles(), look(id), {.may_allocate = true});
  }

  void set(const char* assignment) const {
    const Wanted wanted{.assignments = assignments({assignment})};
    auto plan = make_plan(
        wanted,
        take_snapshots(*session, profiles(), std::vector{NodeId(11)}, {},
                       [&](const Servo& servo) { return registers_needed(wanted, servo); })
            .servos[0],
        profiles());
    REQUIRE(plan);
    REQUIRE(carry_out(*session, profiles(), std::span(&*plan, 1), {}).servos[0].is_done());
  }

  Interrupted* bus = nullptr; ///< of the session
  std::unique_ptr<Session> session;
};

inline std::string words(const std::optional<FactValue>& value) {
  if (!value) {
    return "not measured";
  }
  const auto* flag = std::get_if<bool>(&*value);
  return flag == nullptr ? std::get<std::string>(*value) : *flag ? "true" : "false";
}

inline const Fact& fact(const Characterization& measured, std::string_view setting) {
  const auto it = std::ranges::find(measured.facts, setting, &Fact::setting);
  REQUIRE(it != measured.facts.end());
  return *it;
}

/// Finished, and everything as it was.
inline void check_done(const Characterization& measured) {
  INFO((measured.error ? measured.error->message : ""));
  INFO((measured.not_put_back ? measured.not_put_back->message : ""));
  CHECK(measured.is_done());
}

inline void check_same(const Rig& rig, const Memory& before) {
  CHECK(text(without_idle_commands(rig.memory())) == text(without_idle_commands(before)));
}

inline std::string literal(const std::string& value) {
  return value == "true" || value == "false" ? value : "\"" + value + "\"";
}

/// The keys of "behaviour" in a schema that is published, each with what it may be.
inline nlohmann::json behaviour_schema() {
  std::ifstream file(std::string(BLACTL_SCHEMAS) + "/scenario.schema.json");
  REQUIRE(file);
  return nlohmann::json::parse(file)["$defs"]["behaviour"]["properties"];
}

inline std::vector<std::string> values_of(const nlohmann::json& property) {
  if (property.contains("enum")) {
    return property["enum"];
  }
  if (property.contains("type")) {
    return {"true", "false"};
  }
  const std::string kind = property["allOf"][0]["$ref"];
  return kind.ends_with("missing_read") ? std::vector<std::string>{"fail", "zero"}
                                        : std::vector<std::string>{"30ms", "400ms"};
}

inline double milliseconds(const std::string& time) {
  return std::stod(time) / (time.ends_with("us") ? 1000 : 1);
}

/// One by chance: every setting, what RAM and ROM hold, a hand on its shaft.
struct RandomServo {
  std::map<std::string, std::string> behaviour;
  std::string members, scene;
};

class RandomServos {
 public:
  explicit RandomServos(unsigned seed) : chance_(seed) {}

  RandomServo next() {
    RandomServo servo;
    std::string is_like;
    for (const auto& [key, property] : schema_.items()) {
      // Half a second an answer is no bench.
      const std::string value = key == "answer_delay" ? "2ms" : one_of(values_of(property));
      servo.behaviour[key] = value;
      is_like += fmt::format(R"({}"{}": {})", is_like.empty() ? "" : ", ", key, literal(value));
    }
    const std::string model = one_of(models_), rom = some_memory(), ram = some_memory();
    servo.members = fmt::format(
        R"("model": "{}", "behaviour": {{{}}}, "rom": {{{}}}, "ram": {{{}}}, "servo_id": {})",
        model, is_like, rom, ram, number(3));
    servo.scene = one_of(scenes_);
    return servo;
  }

  std::size_t number(std::size_t below) {
    return std::uniform_int_distribution<std::size_t>(0, below - 1)(chance_);
  }

 private:
  std::string one_of(const std::vector<std::string>& all) { return all[number(all.size())]; }

  std::string some_memory() {
    std::string out;
    for (const auto& [name, values] : memory_) {
      if (number(2) == 0) {
        out += fmt::format(R"({}"{}": "{}")", out.empty() ? "" : ", ", name, one_of(values));
      }
    }
    return out;
  }

  std::mt19937 chance_;
  nlohmann::json schema_ = behaviour_schema();
  std::vector<std::string> models_{"BLA15-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
                                   "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"};
  std::vector<std::pair<std::string, std::vector<std::string>>> memory_{
      {"angle_limit_cw", {"0deg", "45.5deg", "179.9deg", "400deg"}},
      {"angle_limit_ccw", {"0deg", "-10deg", "-180deg"}},
      {"torque_output", {"on", "off", "brake"}},
      {"soft_start", {"on", "off"}},
      {"reverse", {"on", "off"}},
      {"timeout_action", {"hold", "off", "brake"}},
      {"timeout_time", {"1ms", "800ms", "60000ms"}},
      {"speed_torque_control", {"on", "off"}},
      {"speed_limit_cw", {"0rpm", "30rpm", "70rpm"}},
      {"torque_limit_cw", {"0%", "30%", "100%"}},
      {"origin", {"0deg", "-12.3deg"}},
      {"extended_angle", {"on", "off"}}};
  std::vector<std::string> scenes_{
      "", R"(, "events": [{"at": "2s", "servo": 240900001, "world": {"hand": "-75deg"}}])",
      R"(, "events": [{"at": "2s", "servo": 240900001, "world": {"hand": "30deg"}},
          {"at": "3s", "servo": 240900001, "world": {"hand": "free"}}])"};
};

/// With BLACTL_LONG_TESTS set, for nights.
inline int this_many(int usual, int at_night) {
  return std::getenv("BLACTL_LONG_TESTS") != nullptr ? at_night : usual;
}

} // namespace blactl::fleet::test
