// The public test vectors: transfers made by pydronecan, sequences of frames with what a receiver
// by the specification delivers, and float16 pairs. Their "meta" explains the format.

#include "catch.hpp"
#include "fields.hpp"
#include "support.hpp"

#include <bit>
#include <cmath>
#include <fstream>
#include <set>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

const Json& vectors() {
  static const auto json = Json::parse(std::ifstream(BLACTL_TEST_DATA "/vectors_public.json"));
  return json;
}

std::string string(const Json& json, const char* key) {
  return json[key].get<std::string>();
}

std::uint64_t number(const std::string& hexadecimal) {
  return std::stoull(hexadecimal, nullptr, 16);
}

Kind to_kind(const Json& json) {
  const auto name = json.get<std::string>();
  return name == "message" ? Kind::message : name == "request" ? Kind::request : Kind::response;
}

NodeId to_node(const Json& json) {
  return NodeId(json.is_null() ? std::uint8_t{0} : json.get<std::uint8_t>());
}

Header to_header(const Json& json, std::uint16_t data_type_id) {
  return {.kind = to_kind(json["kind"]),
          .priority = json["priority"],
          .data_type_id = data_type_id,
          .source = to_node(json["src"]),
          .destination = to_node(json["dst"])};
}

Header to_header(const Json& vector) {
  auto header = to_header(vector, vector["dtid"].get<std::uint16_t>());
  header.discriminator = vector["discriminator"].is_null()
                             ? std::uint16_t{0}
                             : vector["discriminator"].get<std::uint16_t>();
  return header;
}

can::Frame to_frame(const Json& json) {
  auto result =
      frame(static_cast<std::uint32_t>(number(string(json, "id"))), unhex(string(json, "data")));
  result.extended = json.value("extended", true);
  return result;
}

std::vector<can::Frame> to_frames(const Json& list) {
  std::vector<can::Frame> frames;
  for (const auto& each : list) {
    frames.push_back(to_frame(each));
  }
  return frames;
}

/// Microseconds since the sequence began.
Duration to_time(const Json& frame) {
  return Duration(std::llround(frame["t"].get<double>() * 1e6));
}

/// What a receiver delivered or should have, as one line.
std::string line(std::string_view type, const Header& header, TransferId id,
                 std::string_view payload) {
  return fmt::format("{} {} {}->{} tid {} prio {} {}", type, static_cast<int>(header.kind),
                     header.source.value(), header.destination.value(), id, header.priority,
                     payload);
}

std::vector<std::string> expected_lines(const Json& expected) {
  std::vector<std::string> lines;
  for (const auto& each : expected) {
    lines.push_back(
        line(string(each, "type"), to_header(each, 0), each["tid"], string(each, "payload")));
  }
  return lines;
}

std::vector<std::string> heard_lines(const Ear& ear) {
  std::vector<std::string> lines;
  for (const auto& each : ear.heard) {
    const auto* type = find_type(each.header.kind, each.header.data_type_id);
    lines.push_back(
        line(type != nullptr ? type->name : "?", each.header, each.transfer_id, each.payload));
  }
  return lines;
}

void play(const Json& sequence, Ear& ear) {
  for (const auto& each : sequence["frames"]) {
    ear.hear(to_frame(each), to_time(each));
  }
}

bool decodes(const Ear::Heard& heard) {
  const auto& codec = find_codec(heard.header.kind, heard.header.data_type_id);
  return codec.decode(unhex(heard.payload)).has_value();
}

} // namespace

TEST_CASE("the vectors are all there") {
  REQUIRE(vectors()["transfers"].size() == 209);
  REQUIRE(vectors()["sequences"].size() == 83);
  REQUIRE(vectors()["float16"].size() == 44);
}

TEST_CASE("every type of a vector is known by its name and signature") {
  for (const auto& vector : vectors()["transfers"]) {
    const auto* type = find_type(to_kind(vector["kind"]), vector["dtid"]);
    REQUIRE(type != nullptr);
    CHECK(type->name == string(vector, "type"));
    CHECK(type->signature == number(string(vector, "signature")));
  }
}

TEST_CASE("fields become the payload and the frames of each vector") {
  // Two vectors have NaNs of other bits than the one that is sent; they are for decoding.
  const std::set<std::string> other_nan{"T308", "T326"};
  for (const auto& vector : vectors()["transfers"]) {
    INFO(string(vector, "id") << " " << string(vector, "group"));
    const auto header = to_header(vector);
    const auto& codec = find_codec(header.kind, header.data_type_id);
    const auto encoded = codec.encode(vector["fields"]);
    auto payload = unhex(string(vector, "payload"));
    if (other_nan.contains(string(vector, "id"))) {
      CHECK(hex(encoded.bytes()) != hex(payload));
      CHECK(codec.decode(encoded.bytes()) == vector["fields"]);
    } else {
      CHECK(hex(encoded.bytes()) == hex(payload));
    }
    const auto frames =
        segment(header, vector["tid"], number(string(vector, "signature")), payload);
    CHECK(texts(frames) == texts(to_frames(vector["frames"])));
  }
}

TEST_CASE("the frames of each vector become its transfer and its fields") {
  for (const auto& vector : vectors()["transfers"]) {
    INFO(string(vector, "id") << " " << string(vector, "group"));
    Ear ear;
    ear.hear(to_frames(vector["frames"]));
    CHECK(ear.errors.empty());
    REQUIRE(ear.heard.size() == 1);
    const auto& heard = ear.heard.front();
    CHECK(heard.header == to_header(vector));
    CHECK(heard.transfer_id == vector["tid"].get<TransferId>());
    CHECK(heard.payload == string(vector, "payload"));
    CHECK(heard.crc_checked);
    const auto& codec = find_codec(heard.header.kind, heard.header.data_type_id);
    CHECK(codec.decode(unhex(heard.payload)) == vector["fields"]);
  }
}

TEST_CASE("a receiver delivers of each sequence what the specification says") {
  for (const auto& sequence : vectors()["sequences"]) {
    INFO(string(sequence, "id") << " " << string(sequence, "what"));
    Ear ear(to_node(sequence["receiver"]));
    play(sequence, ear);
    const auto& expected = sequence["expected"];
    REQUIRE(heard_lines(ear) == expected_lines(expected));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CHECK(decodes(ear.heard[i]) == expected[i]["decodes"].get<bool>());
    }
  }
}

TEST_CASE("a sequence has one complaint for each transfer that was lost") {
  using enum ReceiveError;
  // What is to be said of each category; {}: nothing is lost, or it was not for us.
  const std::map<std::string, std::vector<ReceiveError>> complaints{
      {"wrong toggle", {toggle}},
      {"crc error", {crc}},
      {"missing start", {missing_start}},
      {"missing middle", {toggle}},
      {"missing end", {transfer_id}},
      {"truncated", {truncated}},
      {"interleaved nodes", {}},
      {"interleaved types", {}},
      {"interleaved tids", {transfer_id}},
      {"duplicate frames", {}},
      {"duplicate transfer", {transfer_id}},
      {"tid wrap", {}},
      {"tid jump", {}},
      {"abandoned", {transfer_id}},
      {"restart same tid", {transfer_id}},
      {"priority change", {}},
      {"single frame with toggle", {toggle}},
      {"anonymous", {}},
      {"other addressee", {}},
      {"service with source 0", {}},
      {"alien frames", {}},
      {"short payload", {}},
      {"long payload", {}},
      {"middle only", {missing_start}},
      {"recovery", {missing_start, transfer_id}}, // its last frame, then the others
  };
  for (const auto& sequence : vectors()["sequences"]) {
    const auto category = string(sequence, "category");
    if (category == "stale" || string(sequence, "what").ends_with("2.5 s apart")) {
      continue; // lost or not by the length of the pause: receiver_test
    }
    INFO(string(sequence, "id") << " " << string(sequence, "what"));
    Ear ear(to_node(sequence["receiver"]));
    play(sequence, ear);
    CHECK(ear.errors == complaints.at(category));
  }
}

TEST_CASE("float16 is converted as the DroneCAN libraries do") {
  for (const auto& vector : vectors()["float16"]) {
    INFO(string(vector, "id"));
    const auto f32 =
        std::bit_cast<float>(static_cast<std::uint32_t>(number(string(vector, "f32"))));
    const auto f16 = static_cast<std::uint16_t>(number(string(vector, "f16")));
    CHECK(to_float16(f32) == f16);
    CHECK(from_float(from_float16(f16)) == vector["back"]);
    CHECK(std::signbit(from_float16(f16)) == std::signbit(to_float(vector["back"])));
  }
}

TEST_CASE("a float16 field saturates as the vectors demand") {
  std::size_t saturated = 0;
  for (const auto& vector : vectors()["float16"]) {
    if (vector.contains("saturated")) {
      INFO(string(vector, "id"));
      const ActuatorStatus status{.position = std::bit_cast<float>(
                                      static_cast<std::uint32_t>(number(string(vector, "f32"))))};
      const auto bytes = status.encode();
      const auto f16 = static_cast<std::uint16_t>(number(string(vector, "saturated")));
      CHECK(Bytes(bytes.bytes())[1] == (f16 & 0xFF));
      CHECK(Bytes(bytes.bytes())[2] == f16 >> 8);
      ++saturated;
    }
  }
  CHECK(saturated == 4);
}
