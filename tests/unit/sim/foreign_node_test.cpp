#include "blactl/can/frame_bits.hpp"
#include "blactl/dronecan/standard_types.hpp"
#include "blactl/sim/bus/simulator.hpp"
#include "blactl/sim/scenario/foreign_node.hpp"
#include "blactl/sim/servo/servo.hpp"

#include "unit/sim/support.hpp"

#include <cmath>
#include <map>
#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using dronecan::GetSet;
using testing::scenario;

namespace {

ForeignSetup setup(std::string_view members) {
  return scenario(fmt::format(R"("foreign": [{{{}}}])", members)).foreign.front();
}

/// One foreign node on the bench, node 30.
struct Rig {
  explicit Rig(std::string_view members)
      : node(setup(fmt::format(R"("node_id": 30, {})", members)), Time{}), bench(node) {}

  /// The transfers that it sends within `duration`, reassembled with the CRC of their types.
  std::vector<std::pair<std::uint16_t, std::vector<std::uint8_t>>> hear(Duration duration) {
    std::vector<std::pair<std::uint16_t, std::vector<std::uint8_t>>> messages;
    std::size_t errors = 0;
    dronecan::Receiver receiver(
        8, dronecan::anonymous,
        {[&](const dronecan::Transfer& transfer) {
           CHECK(transfer.crc_checked);
           messages.emplace_back(transfer.header.data_type_id,
                                 std::vector(transfer.payload.begin(), transfer.payload.end()));
         },
         [&](dronecan::ReceiveError, std::uint32_t, Time) { ++errors; },
         [](dronecan::Kind kind, std::uint16_t type_id) -> std::optional<std::uint64_t> {
           const auto* type = dronecan::find_standard_type(kind, type_id);
           return type != nullptr ? std::optional(type->signature) : std::nullopt;
         }});
    for (const can::Frame& frame : bench.run(duration)) {
      receiver.receive(frame, bench.now());
    }
    CHECK(errors == 0);
    return messages;
  }

  std::map<std::uint16_t, std::size_t> count(Duration duration) {
    std::map<std::uint16_t, std::size_t> counts;
    for (const auto& [type, payload] : hear(duration)) {
      ++counts[type];
    }
    return counts;
  }

  /// Empty: it does not answer.
  std::optional<GetSet::Response> get_set(std::uint16_t index, GetSet::Value value,
                                          std::string name) {
    id = static_cast<dronecan::TransferId>((id + 1) % dronecan::transfer_id_modulus);
    bench.deliver(testing::request(
        GetSet::type, GetSet::Request{index, std::move(value), std::move(name)}, 30, id));
    std::optional<GetSet::Response> answer;
    dronecan::Receiver receiver(
        2, dronecan::NodeId(127),
        {[&](const dronecan::Transfer& transfer) {
           if (transfer.header.kind == dronecan::Kind::response) {
             answer = GetSet::Response::decode(transfer.payload);
           }
         },
         {},
         [](dronecan::Kind, std::uint16_t) { return std::optional(GetSet::type.signature); }});
    for (const can::Frame& frame : bench.run(0ms)) {
      receiver.receive(frame, bench.now());
    }
    return answer;
  }

  ForeignNode node;
  testing::Bench bench;
  dronecan::TransferId id = 0;
};

/// A listener that keeps all frames.
class Log final : public Medium::Listener {
 public:
  void heard(const can::Frame& frame, Time) override { frames.push_back(frame); }

  void sent(const can::Frame&, Time) override {}

  void bus_off(Time) override {}

  std::vector<can::Frame> frames;
};

std::set<unsigned> sources(const Log& log, std::uint16_t type) {
  std::set<unsigned> found;
  for (const can::Frame& frame : log.frames) {
    const auto header = dronecan::decode_id(frame.id);
    if (header && header->kind == dronecan::Kind::message && header->data_type_id == type) {
      found.insert(header->source.value());
    }
  }
  return found;
}

} // namespace

TEST_CASE("every kind of foreign node sends NodeStatus and has a name of its kind") {
  for (const std::string kind : {"node", "gnss", "esc", "autopilot", "babbler"}) {
    INFO(kind);
    Rig rig(fmt::format(R"("kind": "{}")", kind));
    CHECK(rig.count(1900ms)[dronecan::NodeStatus::type.id] == 2);
    CHECK(setup(fmt::format(R"("kind": "{}", "node_id": 1)", kind)).name == "org.example." + kind);
  }
}

TEST_CASE("a plain node sends NodeStatus only") {
  Rig rig(R"("kind": "node")");
  CHECK(rig.count(10s).size() == 1);
}

TEST_CASE("a satellite receiver sends Fix2 of 62 bytes five times a second, and Auxiliary") {
  Rig rig(R"("kind": "gnss")");
  std::map<std::uint16_t, std::size_t> counts;
  for (const auto& [type, payload] : rig.hear(10s)) {
    ++counts[type];
    if (type == 1063) {
      CHECK(payload.size() == 62);
      CHECK((payload[47] & 0x3F) == 6); // elements of the covariance
    } else if (type == 1061) {
      CHECK(payload.size() == 16);
    }
  }
  CHECK(counts[1063] == 50);
  CHECK(counts[1061] == 10);
  CHECK(Rig(R"("kind": "gnss", "rate": 20)").count(10s)[1063] == 200);
}

TEST_CASE("a speed controller sends esc.Status with its index") {
  Rig rig(R"("kind": "esc", "index": 5, "rate": 10)");
  std::size_t heard = 0;
  for (const auto& [type, payload] : rig.hear(2s)) {
    if (type == 1034) {
      ++heard;
      REQUIRE(payload.size() == 14);
      CHECK(payload[13] >> 2U == 5);
      CHECK(dronecan::from_float16(static_cast<std::uint16_t>(payload[4] | payload[5] << 8U)) ==
            24.0F);
    }
  }
  CHECK(heard == 20);
  CHECK(Rig(R"("kind": "esc")").count(1s)[1034] == 50);
}

TEST_CASE("a speed controller lists parameters of every kind by index, up to an empty name") {
  Rig rig(R"("kind": "esc", "index": 3)");
  std::set<std::size_t> kinds;
  std::vector<std::string> names;
  for (std::uint16_t index = 0;; ++index) {
    const auto answer = rig.get_set(index, {}, "");
    REQUIRE(answer);
    if (answer->name.empty()) {
      CHECK(*answer == GetSet::Response{});
      break;
    }
    kinds.insert(answer->value.index());
    names.push_back(answer->name);
    CHECK(answer->value.index() == answer->default_value.index());
    CHECK(rig.get_set(0, {}, answer->name) == answer);
  }
  CHECK(kinds == std::set<std::size_t>{1, 2, 3, 4}); // integer, real, boolean, string
  CHECK(names.size() == 5);
  CHECK(rig.get_set(0, {}, "esc_index")->value == GetSet::Value(std::int64_t{3}));
  CHECK(rig.get_set(0, {}, "0x38") == GetSet::Response{});
}

TEST_CASE("a speed controller takes values of the right kind and range, and keeps the old else") {
  Rig rig(R"("kind": "esc")");
  const auto written = [&](GetSet::Value value, std::string name) {
    return rig.get_set(0, std::move(value), std::move(name))->value;
  };
  CHECK(written(std::int64_t{7}, "esc_index") == GetSet::Value(std::int64_t{7}));
  CHECK(written(std::int64_t{32}, "esc_index") == GetSet::Value(std::int64_t{7}));
  CHECK(written(7.0F, "esc_index") == GetSet::Value(std::int64_t{7}));
  CHECK(written(920.0F, "motor_kv") == GetSet::Value(920.0F));
  CHECK(written(-1.0F, "motor_kv") == GetSet::Value(920.0F));
  CHECK(written(std::nanf(""), "motor_kv") == GetSet::Value(920.0F));
  CHECK(written(true, "direction_reversed") == GetSet::Value(true));
  CHECK(written(std::string("left"), "label") == GetSet::Value(std::string("left")));
  CHECK(rig.get_set(4, {}, "")->value == GetSet::Value(std::string("left")));
}

TEST_CASE("a speed controller that is told not to serves no GetSet") {
  CHECK_FALSE(Rig(R"("kind": "esc", "serves_get_set": false)").get_set(0, {}, ""));
}

TEST_CASE("an autopilot is disarmed unless told otherwise, and commands what it is told to") {
  Rig rig(R"("kind": "autopilot", "commands": {"servo_ids": [1, 2], "rate": 50})");
  std::size_t commands = 0;
  for (const auto& [type, payload] : rig.hear(1900ms)) {
    if (type == dronecan::ArmingStatus::type.id) {
      CHECK(payload == std::vector<std::uint8_t>{0});
    }
    commands += type == dronecan::ArrayCommand::type.id ? 1U : 0U;
  }
  CHECK(commands == 96);
  Rig armed(R"("kind": "autopilot", "armed": true)");
  CHECK(armed.hear(0ms).at(1).second == std::vector<std::uint8_t>{255});
}

TEST_CASE("a node that is armed later tells so at once") {
  Rig rig(R"("kind": "autopilot", "armed": true, "begins": "300ms")");
  const auto is_armed = [](const auto& message) {
    return message.first == dronecan::ArmingStatus::type.id && message.second.front() == 255;
  };
  CHECK(std::ranges::none_of(rig.hear(299ms), is_armed));
  CHECK(std::ranges::any_of(rig.hear(2ms), is_armed));
}

TEST_CASE("an autopilot that allocates gives every servo an ID of its own, from 125 down") {
  std::string servos;
  for (int i = 0; i < 8; ++i) {
    servos += R"({"model": "BLA21-12U-AB"}, )";
  }
  Simulator simulator(
      scenario(fmt::format(R"("servos": [{} {{"model": "BLA21-12U-AB", "node_id": 124}}],
          "foreign": [{{"kind": "autopilot", "node_id": 10, "allocates": true}}])",
                           servos)),
      Time{});
  simulator.advance_to(Time{} + 60s);
  std::set<unsigned> ids;
  for (const Servo* servo : simulator.servos()) {
    ids.insert(servo->node_id().value());
  }
  CHECK(ids == std::set<unsigned>{117, 118, 119, 120, 121, 122, 123, 124, 125});
}

TEST_CASE("an autopilot that allocates gives a unit its ID again, and none without being told to") {
  const char* text = R"("servos": [{{"model": "BLA21-12U-AB"}}, {{"model": "BLA21-12U-AB"}}],
      "foreign": [{{"kind": "autopilot", "node_id": 10, "allocates": {}}}],
      "events": [{{"at": "20s", "servo": 240900001, "world": {{"plugged": "off"}}}},
                 {{"at": "20s", "servo": 240900002, "world": {{"plugged": "off"}}}},
                 {{"at": "21s", "servo": 240900002, "world": {{"plugged": "on"}}}},
                 {{"at": "31s", "servo": 240900001, "world": {{"plugged": "on"}}}}])";
  Simulator simulator(scenario(fmt::format(fmt::runtime(text), "true")), Time{});
  simulator.advance_to(Time{} + 19s);
  const auto first = simulator.servos()[0]->node_id();
  const auto second = simulator.servos()[1]->node_id();
  CHECK(first.is_unicast());
  CHECK(second.is_unicast());
  simulator.advance_to(Time{} + 45s);
  CHECK(simulator.servos()[0]->node_id() == first);
  CHECK(simulator.servos()[1]->node_id() == second);

  Simulator without(scenario(fmt::format(fmt::runtime(text), "false")), Time{});
  without.advance_to(Time{} + 19s);
  CHECK_FALSE(without.servos()[0]->node_id().is_unicast());
}

TEST_CASE("an autopilot that allocates answers the part that comes next, within 500 ms") {
  Rig rig(R"("kind": "autopilot", "allocates": true)");
  rig.bench.run(100ms);
  // Unique ID 00..0F in parts of 6, 6 and 4 bytes.
  const auto answers = [&](const char* request) {
    rig.bench.deliver({testing::frame(request)});
    std::string hex;
    for (const can::Frame& one : rig.bench.run(0ms)) {
      CHECK(one.id == (30U << 24U | 1U << 8U | 30U));
      hex += testing::text(one).substr(9);
    }
    return hex;
  };
  const char* first = "18000100#01000102030405C0";
  const char* second = "18000100#00060708090A0BC0";
  const char* third = "18000100#000C0D0E0FC0";
  CHECK(answers(second).empty());
  CHECK(answers(third).empty());
  CHECK(answers(first) == "00000102030405C0");
  CHECK(answers(first).empty()); // another servo, in the middle of this exchange
  rig.bench.run(501ms);
  CHECK(answers(second).empty());
  CHECK(answers(first) == "00000102030405C1");
  rig.bench.run(500ms);
  CHECK_FALSE(answers(second).empty());
  CHECK(answers(third).substr(4, 2) == "FA"); // 125
}

TEST_CASE("an autopilot gives no ID under which somebody was heard, and none when all are taken") {
  Rig rig(R"("kind": "autopilot", "allocates": true)");
  for (unsigned id = 2; id <= 125; ++id) {
    rig.bench.deliver({testing::frame(fmt::format("140155{:02X}#00000000000000C0", id))});
  }
  dronecan::UniqueId unique_id{};
  dronecan::TransferId transfer = 0;
  const auto ask = [&] {
    rig.bench.run(1s);
    std::uint8_t given = 0;
    dronecan::Receiver receiver(2, dronecan::anonymous,
                                {[&](const dronecan::Transfer& heard) {
                                   if (heard.header.data_type_id == dronecan::Allocation::type.id) {
                                     given = dronecan::Allocation::decode(heard.payload)->node_id;
                                   }
                                 },
                                 {},
                                 [](dronecan::Kind, std::uint16_t) {
                                   return std::optional(dronecan::Allocation::type.signature);
                                 }});
    for (const std::uint8_t from : std::initializer_list<std::uint8_t>{0, 6, 12}) {
      dronecan::Allocation part;
      part.first_part_of_unique_id = from == 0;
      part.size = from == 12 ? 4 : 6;
      std::copy_n(unique_id.begin() + from, part.size, part.unique_id.begin());
      const dronecan::Header header{dronecan::Kind::message, 24, dronecan::Allocation::type.id,
                                    dronecan::anonymous,     {}, 0};
      rig.bench.deliver(dronecan::segment(header, transfer, dronecan::Allocation::type.signature,
                                          part.encode().bytes()));
      transfer = static_cast<dronecan::TransferId>((transfer + 1) % dronecan::transfer_id_modulus);
      for (const can::Frame& one : rig.bench.run(0ms)) {
        receiver.receive(one, rig.bench.now());
      }
    }
    return given;
  };
  CHECK(ask() == 1);
  unique_id[15] = 1;
  CHECK(ask() == 0);
  unique_id[15] = 0;
  CHECK(ask() == 1);
}

TEST_CASE("a servo gets an ID while two autopilots answer alike", "[requirement-33]") {
  for (int seed = 1; seed <= 10; ++seed) {
    INFO(seed);
    Simulator simulator(scenario(fmt::format(
                            R"("seed": {}, "servos": [{{"model": "BLA21-12U-AB"}}], "foreign": [
        {{"kind": "autopilot", "node_id": 10, "allocates": true}},
        {{"kind": "autopilot", "node_id": 20, "allocates": true}}])",
                            seed)),
                        Time{});
    simulator.advance_to(Time{} + 10s);
    CHECK(simulator.servos().front()->node_id().is_unicast());
  }
}

TEST_CASE("two autopilots that allocate do not give way to each other") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB"}], "foreign": [
      {"kind": "autopilot", "node_id": 10, "allocates": true},
      {"kind": "autopilot", "node_id": 20, "allocates": true}])"),
                      Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 20s);
  CHECK(sources(log, dronecan::Allocation::type.id) == std::set<unsigned>{0, 10, 20});
}

TEST_CASE("a babbler takes the share of the bus that it is told to") {
  for (const double load : {0.1, 0.5, 0.9}) {
    INFO(load);
    Simulator simulator(scenario(fmt::format(
                            R"("foreign": [{{"kind": "babbler", "node_id": 9, "load": {}}},
                                           {{"kind": "node", "node_id": 10}}])",
                            load)),
                        Time{});
    simulator.advance_to(Time{} + 10s);
    const double share =
        std::chrono::duration<double>(simulator.medium().counters().busy).count() / 10;
    CHECK(share == Approx(load).margin(0.002));
  }
}

TEST_CASE("a babbler of priority 0 leaves nobody else the bus") {
  Simulator simulator(scenario(R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}],
      "foreign": [{"kind": "babbler", "node_id": 9, "priority": 0, "load": 1}])"),
                      Time{});
  Log log;
  (void)simulator.attach(log, 10);
  simulator.advance_to(Time{} + 3s);
  CHECK(log.frames.size() > 10'000);
  CHECK(sources(log, dronecan::ActuatorStatus::type.id).empty());
}

TEST_CASE("a babbler of no load says nothing but that it lives") {
  Rig rig(R"("kind": "babbler", "load": 0)");
  CHECK(rig.count(5s).size() == 1);
  Rig low(R"("kind": "babbler", "priority": 31)");
  bool found = false;
  for (const can::Frame& frame : low.bench.run(1ms)) {
    found = found || frame.id == (31U << 24U | 16370U << 8U | 30U);
  }
  CHECK(found);
}
