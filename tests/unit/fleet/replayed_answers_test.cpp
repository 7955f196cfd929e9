#include "blactl/fleet/bus/replayed_answers.hpp"

#include "support.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;
using dronecan::Kind;

namespace {

constexpr bla::Address angle_limit_cw{0x38};

/// A recording that the test tells transfer by transfer. Node 11 is the servo, 127 who asks.
struct Recording {
  void hear(Kind kind, const dronecan::DataType& type, std::uint8_t source,
            std::uint8_t destination, const dronecan::Payload& payload,
            dronecan::TransferId id = 0) {
    const dronecan::Transfer transfer{.header = {.kind = kind,
                                                 .data_type_id = type.id,
                                                 .source = NodeId(source),
                                                 .destination = NodeId(destination)},
                                      .transfer_id = id,
                                      .payload = payload.bytes(),
                                      .at = now};
    roster.receive(transfer);
    archive.receive(transfer);
  }

  void hear_uptime(std::uint32_t seconds) {
    hear(Kind::message, dronecan::NodeStatus::type, 11, 0,
         dronecan::NodeStatus{.uptime_s = seconds}.encode());
  }

  void ask_for(std::string name, dronecan::TransferId id = 0, std::uint8_t client = 127,
               std::uint16_t index = 0) {
    hear(Kind::request, GetSet::type, client, 11,
         GetSet::Request{.index = index, .value = {}, .name = std::move(name)}.encode(), id);
  }

  void write(std::string name, std::int64_t raw, dronecan::TransferId id = 0) {
    hear(Kind::request, GetSet::type, 127, 11,
         GetSet::Request{.value = raw, .name = std::move(name)}.encode(), id);
  }

  void answer(GetSet::Value value, std::string name, dronecan::TransferId id = 0,
              std::uint8_t client = 127) {
    hear(Kind::response, GetSet::type, 11, client,
         GetSet::Response{.value = std::move(value), .name = std::move(name)}.encode(), id);
  }

  [[nodiscard]] Outcome read(bla::Address address = angle_limit_cw, std::uint8_t node = 11) const {
    return archive.answer(read_register(NodeId(node), address, {}));
  }

  /// What 0x38 held; empty: not recorded.
  [[nodiscard]] std::optional<std::int64_t> value() const {
    const auto found = register_value(read(), NodeId(11), angle_limit_cw, {});
    return found ? std::optional(*found) : std::nullopt;
  }

  [[nodiscard]] Outcome::Kind info() const {
    return archive.answer(ask(NodeId(11), GetNodeInfo::type, GetNodeInfo::Request{}.encode(), {}))
        .kind;
  }

  Time now{1h};
  Roster roster{dronecan::anonymous, profiles()};
  ReplayedAnswers archive{roster};
};

constexpr auto answered = Outcome::Kind::answered;
constexpr auto not_recorded = Outcome::Kind::not_recorded;

} // namespace

TEST_CASE("the last answer of each register is what a recording knows, whoever asked") {
  Recording recording;
  CHECK(recording.read().kind == not_recorded);
  recording.answer(std::int64_t{900}, "0x38");
  CHECK(recording.value() == 900);
  recording.now += 1s;
  recording.answer(std::int64_t{800}, "0x38", 5, 99);
  CHECK(recording.value() == 800);
  CHECK(recording.read().at == recording.now);
  CHECK(recording.read(bla::Address{0x39}).kind == not_recorded);
  CHECK(recording.read(angle_limit_cw, 12).kind == not_recorded);
}

TEST_CASE("the answer to a write tells the value after it; a write is never answered") {
  Recording recording;
  recording.hear(Kind::request, GetSet::type, 127, 11,
                 GetSet::Request{.value = std::int64_t{900}, .name = "0x38"}.encode());
  recording.answer(std::int64_t{899}, "0x38");
  CHECK(recording.value() == 899);
  CHECK(recording.archive.answer(write_register(NodeId(11), angle_limit_cw, 899, {})).kind ==
        not_recorded);
}

TEST_CASE("a failure without a name belongs to the question with its transfer ID") {
  Recording recording;
  recording.answer(std::int64_t{900}, "0x38");
  recording.ask_for("0x38", 4);
  recording.answer(GetSet::Empty{}, "", 3);      // nobody asked this
  recording.answer(GetSet::Empty{}, "", 4, 126); // somebody else did
  CHECK(recording.value() == 900);
  recording.answer(GetSet::Empty{}, "", 4);
  CHECK(recording.read().kind == answered);
  CHECK(register_value(recording.read(), NodeId(11), angle_limit_cw, {}).error().code ==
        Code::refused);
}

TEST_CASE("tools that ask by index are understood, too") {
  Recording recording;
  recording.ask_for("", 4, 127, 0x38);
  recording.answer(GetSet::Empty{}, "", 4);
  CHECK(recording.read().kind == answered);
  recording.ask_for("", 5, 127, 0x1038); // no register
  recording.answer(GetSet::Empty{}, "", 5);
  CHECK(recording.read(bla::Address{0x00}).kind == not_recorded);
}

TEST_CASE("a restart makes what was said before it history") {
  Recording recording;
  recording.hear_uptime(100);
  recording.answer(std::int64_t{900}, "0x38");
  recording.hear(Kind::response, GetNodeInfo::type, 11, 127,
                 GetNodeInfo::Response{.status = {.uptime_s = 100}}.encode());
  recording.now += 5s;
  recording.hear_uptime(105);
  CHECK(recording.value() == 900);
  CHECK(recording.info() == answered);
  recording.now += 5s;
  recording.hear_uptime(1);
  CHECK_FALSE(recording.value());
  CHECK(recording.info() == not_recorded);
  recording.answer(std::int64_t{1799}, "0x38");
  CHECK(recording.value() == 1799);
}

TEST_CASE("a write makes unknown what its register held, until it is answered") {
  Recording recording;
  recording.answer(std::int64_t{450}, "0x38");
  recording.answer(std::int64_t{-450}, "0x39");
  recording.write("0x38", 900, 7);
  CHECK_FALSE(recording.value());
  CHECK(recording.read(bla::Address{0x39}).kind == answered);
  SECTION("by its own answer") {
    recording.answer(std::int64_t{900}, "0x38", 7);
    CHECK(recording.value() == 900);
  }
  SECTION("or by a later read") {
    recording.ask_for("0x38", 8);
    recording.answer(std::int64_t{900}, "0x38", 8);
    CHECK(recording.value() == 900);
  }
  SECTION("but not by the answer to an earlier read") {
    Recording other;
    other.ask_for("0x38", 3, 126);
    other.write("0x38", 900, 3);
    other.answer(std::int64_t{450}, "0x38", 3, 126);
    CHECK_FALSE(other.value());
  }
}

TEST_CASE("ERASE makes unknown what it sets, and a restart all, from the moment they are sent") {
  constexpr bla::Address serial_number{0x51};
  Recording recording;
  recording.answer(std::int64_t{450}, "0x38");
  recording.answer(std::int64_t{0}, "0x00");
  recording.answer(std::int64_t{240900558}, "0x51");
  recording.hear(Kind::response, GetNodeInfo::type, 11, 127,
                 GetNodeInfo::Response{.status = {.uptime_s = 100}}.encode());
  const auto opcode = [&](std::uint8_t code) {
    recording.hear(Kind::request, dronecan::ExecuteOpcode::type, 127, 11,
                   dronecan::ExecuteOpcode::Request{.opcode = code}.encode());
  };
  const auto loses_settings = [&] {
    CHECK_FALSE(recording.value());
    CHECK(recording.read(bla::Address{0x00}).kind == not_recorded);
    CHECK(recording.read(serial_number).kind == answered);
    CHECK(recording.info() == answered);
  };
  const auto loses_all = [&] {
    CHECK_FALSE(recording.value());
    CHECK(recording.read(serial_number).kind == not_recorded);
    CHECK(recording.info() == not_recorded);
  };
  SECTION("ERASE") {
    opcode(dronecan::ExecuteOpcode::erase);
    loses_settings();
    recording.answer(std::int64_t{1799}, "0x38");
    CHECK(recording.value() == 1799);
  }
  SECTION("0x10") {
    recording.write("0x10", 1);
    loses_settings();
  }
  SECTION("SAVE") {
    opcode(dronecan::ExecuteOpcode::save);
    loses_all();
  }
  SECTION("0x12") {
    recording.write("0x12", 1);
    loses_all();
  }
  SECTION("RestartNode") {
    recording.hear(Kind::request, dronecan::RestartNode::type, 127, 11,
                   dronecan::RestartNode::Request{}.encode());
    loses_all();
    recording.answer(std::int64_t{1799}, "0x38");
    CHECK(recording.value() == 1799);
  }
}

TEST_CASE("other nodes, other services and nonsense leave no answer") {
  Recording recording;
  recording.answer(std::int64_t{900}, "some_parameter");
  recording.answer(std::int64_t{900}, "");
  recording.answer(std::int64_t{900}, "0x60");
  recording.hear(Kind::response, GetSet::type, 11, 127, dronecan::Payload{});
  recording.hear(Kind::response, GetNodeInfo::type, 11, 127, dronecan::Payload{});
  recording.hear(Kind::response, dronecan::RestartNode::type, 11, 127, dronecan::Payload{});
  for (unsigned address = 0; address < 0x60; ++address) {
    CHECK(recording.read(bla::Address(static_cast<std::uint8_t>(address))).kind == not_recorded);
  }
  CHECK(recording.info() == not_recorded);
  CHECK(recording.archive
            .answer(ask(NodeId(11), dronecan::RestartNode::type,
                        dronecan::RestartNode::Request{}.encode(), {}))
            .kind == not_recorded);
}
