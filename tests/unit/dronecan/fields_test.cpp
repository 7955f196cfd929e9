#include "blactl/dronecan/fields.hpp"
#include "blactl/dronecan/standard_types.hpp"

#include "catch.hpp"
#include "fields.hpp"
#include "support.hpp"

#include <fstream>
#include <random>
#include <set>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

/// Builds the JSON that the vectors have: text as numbers, "nan" and "inf" as words.
class VectorSink final : public FieldSink {
 public:
  void begin_object() override { open(Json::object()); }

  void end_object() override { close(); }

  void begin_array() override { open(Json::array()); }

  void end_array() override { close(); }

  void key(std::string_view name) override { key_ = name; }

  void natural(std::uint64_t value, std::string_view word) override {
    put(value);
    if (!word.empty()) {
      words.emplace_back(word);
    }
  }

  void integer(std::int64_t value) override { put(value); }

  void truth(bool value) override { put(value); }

  void real(float value) override { put(from_float(value)); }

  void text(std::string_view bytes) override { put(from_text(std::string(bytes))); }

  void bytes(Bytes bytes) override { put(std::vector<std::uint8_t>(bytes.begin(), bytes.end())); }

  Json result;
  std::vector<std::string> words;

 private:
  void open(Json container) { stack_.emplace_back(std::move(key_), std::move(container)); }

  void close() {
    auto [key, container] = std::move(stack_.back());
    stack_.pop_back();
    key_ = std::move(key);
    put(std::move(container));
  }

  void put(Json value) {
    if (stack_.empty()) {
      result = std::move(value);
    } else if (stack_.back().second.is_array()) {
      stack_.back().second.push_back(std::move(value));
    } else {
      stack_.back().second[key_] = std::move(value);
    }
  }

  std::string key_;
  std::vector<std::pair<std::string, Json>> stack_;
};

Json read_fields(Kind kind, std::uint16_t id, std::string_view payload) {
  VectorSink sink;
  INFO(payload);
  REQUIRE(write_fields(sink, kind, id, unhex(payload)) == FieldsResult::complete);
  return sink.result;
}

FieldsResult result_of(Kind kind, std::uint16_t id, std::span<const std::uint8_t> payload) {
  VectorSink sink;
  return write_fields(sink, kind, id, payload);
}

FieldsResult result_of(Kind kind, std::uint16_t id, std::string_view payload) {
  return result_of(kind, id, unhex(payload));
}

Kind kind_of(const Json& vector) {
  const auto name = vector["kind"].get<std::string>();
  return name == "message" ? Kind::message : name == "request" ? Kind::request : Kind::response;
}

const Json& transfers() {
  static const auto json = Json::parse(std::ifstream(BLACTL_TEST_DATA "/vectors_public.json"));
  return json["transfers"];
}

using enum Kind;
using enum FieldsResult;

} // namespace

TEST_CASE("every payload of the vectors has the fields of its vector") {
  for (const auto& vector : transfers()) {
    INFO(vector["id"]);
    const auto payload = vector["payload"].get<std::string>();
    CHECK(read_fields(kind_of(vector), vector["dtid"], payload) == vector["fields"]);
  }
}

// The decoders of types.hpp and the fields are two readers of one wire: neither may accept what the
// other refuses.
TEST_CASE("a payload that was cut anywhere is too short, unless its type ends with an array") {
  for (const auto& vector : transfers()) {
    const auto kind = kind_of(vector);
    const std::uint16_t id = vector["dtid"];
    const auto payload = unhex(vector["payload"].get<std::string>());
    for (std::size_t size = 0; size < payload.size(); ++size) {
      INFO(vector["id"] << " " << size);
      const auto cut = Bytes(payload).first(size);
      const auto result = result_of(kind, id, cut);
      CHECK((result == complete) == find_codec(kind, id).decode(cut).has_value());
      CHECK(result != contradictory);
    }
  }
}

TEST_CASE("trailing bytes are ignored where the type has a fixed size") {
  CHECK(read_fields(message, NodeStatus::type.id, "D204000000070000FF")["uptime_sec"] == 1234);
  CHECK(read_fields(response, ExecuteOpcode::type.id, "00000000000080FFFF")["ok"] == true);
  CHECK(read_fields(request, GetNodeInfo::type.id, "00").empty());
}

TEST_CASE("a payload that contradicts itself has no fields") {
  // A union without such a member: tags 5 and 3.
  CHECK(result_of(request, GetSet::type.id, "0005") == contradictory);
  CHECK(result_of(response, GetSet::type.id, "00000300") == contradictory);
  // A string_value, a name, a unique_id and an array of commands beyond their limits.
  CHECK(result_of(request, GetSet::type.id, "000481") == contradictory);
  CHECK(result_of(request, GetSet::type.id, std::vector<std::uint8_t>(95)) == contradictory);
  CHECK(result_of(message, Allocation::type.id, std::vector<std::uint8_t>(18)) == contradictory);
  CHECK(result_of(message, ArrayCommand::type.id, std::vector<std::uint8_t>(64)) == contradictory);
  // A part of a command is a payload that ends too early.
  CHECK(result_of(message, ArrayCommand::type.id, std::vector<std::uint8_t>(6)) == too_short);
}

TEST_CASE("types without known fields are unknown, whatever their payload") {
  CHECK(result_of(message, 20001, "00") == unknown);
  CHECK(result_of(message, 11, "00") == unknown); // a service has it
  CHECK(result_of(request, 341, "00") == unknown);
}

TEST_CASE("enumerations bear their word") {
  VectorSink sink;
  CHECK(write_fields(sink, message, NodeStatus::type.id, unhex("010000009800")) == too_short);
  VectorSink node;
  CHECK(write_fields(node, message, NodeStatus::type.id, unhex("01000000B80000")) == complete);
  CHECK(node.words == std::vector<std::string>{"error", "offline"});
}

// Payloads made by pydronecan.
TEST_CASE("types that no BLA servo speaks are read, too") {
  CHECK(read_fields(message, 16370, "0000C03F74656D70") ==
        Json{{"value", 1.5}, {"key", from_text("temp")}});
  CHECK(read_fields(message, 16383, "43657363686F74") ==
        Json{{"level", {{"value", 2}}}, {"source", from_text("esc")}, {"text", from_text("hot")}});
  CHECK(read_fields(message, 1030, "0083FDF0000040") == Json{{"cmd", {-8192, 8191, 0, 1}}});
  CHECK(read_fields(message, 1030, "FFFC") == Json{{"cmd", {-1}}});
  CHECK(read_fields(message, 1031, "0000BFFFDFBFFC") == Json{{"rpm", {-131072, 131071, -5}}});
  CHECK(read_fields(message, 1034, "07000000404A00BDB05C1FEFDBA4") == Json{{"error_count", 7},
                                                                           {"voltage", 12.5},
                                                                           {"current", -1.25},
                                                                           {"temperature", 300.0},
                                                                           {"rpm", -4321},
                                                                           {"power_rating_pct", 55},
                                                                           {"esc_index", 9}});
  CHECK(read_fields(message, 1091, "34120045003804") ==
        Json{{"circuit_id", 0x1234}, {"voltage", 5.0}, {"current", 0.5}, {"error_flags", 4}});
  CHECK(read_fields(message, 1100, "FF") == Json{{"status", 255}});
  CHECK(read_fields(message, 4, "DEBC9A78563412") ==
        Json{{"previous_transmission_timestamp_usec", 0x123456789ABCDE}});
  CHECK(read_fields(message, 5, "66697265") == Json{{"reason_text", from_text("fire")}});
  CHECK(read_fields(request, 40, "09612F62") ==
        Json{{"source_node_id", 9}, {"image_file_remote_path", {{"path", from_text("a/b")}}}});
  CHECK(read_fields(response, 40, "0262757379") ==
        Json{{"error", 2}, {"optional_error_message", from_text("busy")}});
  const auto stats = read_fields(
      response, 4, "010000000000FFFFFFFFFFFF030000000000040000000000050000000000060000000000");
  CHECK(stats["transfers_rx"] == 0xFFFF'FFFF'FFFF);
  CHECK(stats["can_iface_stats"] ==
        Json::array({{{"frames_tx", 4}, {"frames_rx", 5}, {"errors", 6}}}));
}

TEST_CASE("reading fields is safe whatever the payload") {
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> payload(random() % 60);
    for (auto& byte : payload) {
      byte = static_cast<std::uint8_t>(random());
    }
    for (const auto& type : standard_types()) {
      if (i % 8 == 0 || type.service) {
        (void)result_of(type.service ? response : message, type.id, payload);
      }
    }
  }
  SUCCEED();
}

TEST_CASE("the standard types agree with those that blactl speaks") {
  for (const Kind kind : {message, request}) {
    for (std::uint16_t id = 0; id < 16384; ++id) {
      if (const auto* own = find_type(kind, id)) {
        const auto* standard = find_standard_type(kind, id);
        REQUIRE(standard != nullptr);
        CHECK(standard->name == own->name);
        CHECK(standard->signature == own->signature);
      }
    }
  }
  CHECK(find_standard_type(response, 11) == find_standard_type(request, 11));
  CHECK(find_standard_type(message, 20001) == nullptr);
  CHECK(find_standard_type(message, 0) == nullptr);
  std::set<std::string_view> names;
  for (const auto& type : standard_types()) {
    CHECK(names.insert(type.name).second);
  }
}
