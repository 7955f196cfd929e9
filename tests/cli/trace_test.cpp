#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include "catch.hpp"
#include "gzip.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

using namespace blactl::test;
namespace can = blactl::can;

namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;

const Json& vectors() {
  static const auto json = Json::parse(std::ifstream(BLACTL_TEST_DATA "/vectors_public.json"));
  return json;
}

constexpr double log_begins = 1'700'000'000;

std::string log_line(const Json& frame, double at, std::string_view interface = "can0") {
  auto id = frame["id"].get<std::string>();
  if (!frame.value("extended", true)) {
    id = id.substr(id.size() - 3);
  }
  return fmt::format("({:.6f}) {} {}#{}\n", at, interface, id, frame["data"].get<std::string>());
}

std::string text_of(const Json& bytes) {
  std::string text;
  for (const auto& byte : bytes) {
    text += static_cast<char>(byte.get<int>());
  }
  return text;
}

std::string hex_of(const Json& bytes) {
  std::string text;
  for (const auto& byte : bytes) {
    text += fmt::format("{:02x}", byte.get<int>());
  }
  return text;
}

/// The fields of a vector as trace shows them: text and hex for its arrays of bytes, null for what
/// JSON has no number.
Json as_shown(const Json& fields) {
  const std::set<std::string> texts{"name", "string_value"};
  const std::set<std::string> bytes{"unique_id", "certificate_of_authenticity"};
  if (fields.is_string()) {
    return nullptr;
  }
  Json shown = fields;
  for (auto it = shown.begin(); it != shown.end(); ++it) {
    if (fields.is_object() && texts.contains(it.key())) {
      *it = text_of(*it);
    } else if (fields.is_object() && bytes.contains(it.key())) {
      *it = hex_of(*it);
    } else if (it->is_structured() || it->is_string()) {
      *it = as_shown(*it);
    }
  }
  return shown;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c;
  });
  return text;
}

/// What came out of a trace as JSON: transfers, errors, and the last object.
struct Traced {
  std::vector<Json> transfers;
  std::vector<Json> errors;
  Json end;

  [[nodiscard]] Names error_words() const {
    Names words;
    for (const auto& error : errors) {
      words.push_back(error["error"]);
    }
    return words;
  }
};

Traced traced(const Result& result) {
  INFO(result.err);
  Traced found;
  auto lines = json_lines(result.out);
  REQUIRE_FALSE(lines.empty());
  found.end = std::move(lines.back());
  lines.pop_back();
  for (auto& line : lines) {
    (line.contains("error") ? found.errors : found.transfers).push_back(std::move(line));
  }
  CHECK(found.end["schema"] == "blactl/1");
  CHECK(found.end["command"] == "trace");
  CHECK(found.end["exit_status"] == result.status);
  return found;
}

Traced trace_log(const Bench& bench, std::string_view log, Arguments more = {}) {
  Arguments arguments{"trace", bench.file("x.log", log), "-j"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Result result = bench.run(arguments);
  CHECK(result.status == 0);
  return traced(result);
}

std::string summary(const Json& type, const Json& kind, const Json& source, const Json& destination,
                    const Json& transfer_id, const Json& priority, const std::string& payload) {
  return type.dump() + kind.dump() + source.dump() + destination.dump() + transfer_id.dump() +
         priority.dump() + payload;
}

Names expected_transfers(const Json& sequence) {
  Names lines;
  for (const auto& each : sequence["expected"]) {
    if (each["decodes"].get<bool>()) {
      lines.push_back(summary(each["type"], each["kind"], each["src"], each["dst"], each["tid"],
                              each["priority"], lower(each["payload"])));
    }
  }
  return lines;
}

Names shown_transfers(const Traced& trace) {
  Names lines;
  for (const auto& each : trace.transfers) {
    lines.push_back(summary(each["type"], each["kind"], each["source"], each["destination"],
                            each["transfer_id"], each["priority"], each["payload"]));
  }
  return lines;
}

/// What trace has to say of a sequence besides its transfers.
Names expected_errors(const Json& sequence) {
  static const std::map<std::string, Names> by_category{
      {"wrong toggle", {"toggle"}},
      {"crc error", {"crc"}},
      {"missing start", {"missing_start"}},
      {"missing middle", {"toggle"}},
      {"missing end", {"transfer_id"}},
      {"truncated", {"truncated"}},
      {"interleaved nodes", {}},
      {"interleaved types", {}},
      {"interleaved tids", {"transfer_id"}},
      {"duplicate frames", {}},
      {"duplicate transfer", {"transfer_id"}},
      {"tid wrap", {}},
      {"tid jump", {}},
      {"abandoned", {"transfer_id"}},
      {"restart same tid", {"transfer_id"}},
      {"priority change", {}},
      {"single frame with toggle", {"toggle"}},
      {"anonymous", {}},
      {"other addressee", {}},
      {"service with source 0", {}},
      {"alien frames", {}},
      {"short payload", {"short"}},
      {"long payload", {}},
      {"middle only", {"missing_start"}},
      {"recovery", {"missing_start", "transfer_id"}},
  };
  const auto category = sequence["category"].get<std::string>();
  const auto what = sequence["what"].get<std::string>();
  if (category == "stale") {
    return what.starts_with("a pause of 1.5 s") ? Names{} : Names{"timeout"};
  }
  return what.ends_with("2.5 s apart") ? Names{} : by_category.at(category);
}

/// A NodeStatus of node 42 with this transfer ID.
std::string status_line(int transfer_id, std::string_view time, std::string_view interface = "can0",
                        std::string_view node = "2A") {
  return fmt::format("({}) {} 140155{}#D20400000007{:02X}{:02X}\n", time, interface, node, 0,
                     0xC0 | transfer_id);
}

can::Frame frame_of(std::uint32_t id, const std::vector<std::uint8_t>& bytes) {
  can::Frame frame{.id = id, .size = static_cast<std::uint8_t>(bytes.size())};
  std::ranges::copy(bytes, frame.data.begin());
  return frame;
}

} // namespace

TEST_CASE("every transfer of the vectors comes out of a log as the file says") {
  std::string log;
  double at = log_begins;
  std::vector<double> begins;
  for (const auto& vector : vectors()["transfers"]) {
    begins.push_back(at);
    for (const auto& frame : vector["frames"]) {
      log += log_line(frame, at);
      at += 0.001;
    }
    at += 3; // no transfer ID repeats the one of a vector before
  }
  const Bench bench;
  const auto trace = trace_log(bench, log);
  CHECK(trace.errors.empty());
  REQUIRE(trace.transfers.size() == vectors()["transfers"].size());
  for (std::size_t i = 0; i < trace.transfers.size(); ++i) {
    const auto& vector = vectors()["transfers"][i];
    const auto& shown = trace.transfers[i];
    INFO(vector["id"] << ' ' << shown.dump());
    CHECK(shown["kind"] == vector["kind"]);
    CHECK(shown["type"] == vector["type"]);
    CHECK(shown["data_type_id"] == vector["dtid"]);
    CHECK(shown["priority"] == vector["priority"]);
    CHECK(shown["source"] == (vector["src"].is_null() ? Json(0) : vector["src"]));
    CHECK(shown["destination"] == vector["dst"]);
    CHECK(shown["transfer_id"] == vector["tid"]);
    CHECK(shown["payload"] == lower(vector["payload"]));
    CHECK(shown["fields"] == as_shown(vector["fields"]));
    CHECK(std::abs(shown["time"].get<double>() - begins[i]) < 2e-6);
    CHECK_FALSE(shown.contains("crc_checked"));
  }
  CHECK(trace.end["counts"]["transfers"] == 209);
}

TEST_CASE("every sequence of the vectors comes out of replay: as the file says") {
  const Bench bench;
  for (const auto& sequence : vectors()["sequences"]) {
    INFO(sequence["id"] << ' ' << sequence["what"]);
    std::string log;
    for (const auto& frame : sequence["frames"]) {
      log += log_line(frame, log_begins + frame["t"].get<double>());
    }
    const Result result = bench.run({"-i", "replay:" + bench.file("s.log", log), "trace", "-j"});
    CHECK(result.status == 0);
    const auto trace = traced(result);
    CHECK(trace.error_words() == expected_errors(sequence));
    if (sequence["what"] == "a response to node 125") {
      // trace hears what is meant for others.
      REQUIRE(trace.transfers.size() == 1);
      CHECK(trace.transfers[0]["destination"] == 125);
    } else {
      CHECK(shown_transfers(trace) == expected_transfers(sequence));
    }
  }
}

TEST_CASE("a line of trace has the keys of the contract in their order") {
  const Bench bench;
  const Result result =
      bench.run({"trace", "-j", bench.file("x.log", status_line(0, "1436509052.249713"))});
  const auto line = result.out.substr(0, result.out.find('\n'));
  CHECK(line == R"({"time":1436509052.249713,"interface":"can0","kind":"message",)"
                R"("type":"uavcan.protocol.NodeStatus","data_type_id":341,"priority":20,)"
                R"("source":42,"destination":null,"transfer_id":0,"payload":"d2040000000700",)"
                R"("fields":{"uptime_sec":1234,"health":0,"mode":0,"sub_mode":0,)"
                R"("vendor_specific_status_code":7}})");
  const Result error = bench.run(
      {"trace", "-j", bench.file("x.log", "(1436509052.249713) can0 1403F32A#00BD1160\n")});
  CHECK(error.out.substr(0, error.out.find('\n')) ==
        R"({"time":1436509052.249713,"interface":"can0","error":"missing_start",)"
        R"("can_id":335803178,"data_type_id":1011,"source":42,"destination":null})");
  CHECK(keys(ordered_json(result.out.substr(line.size() + 1))) ==
        Names{"schema", "command", "interface", "exit_status", "counts", "errors"});
}

TEST_CASE("a repeated transfer ID within 2 s is an error, also of a single frame") {
  const Bench bench;
  const auto trace = trace_log(
      bench, status_line(3, "1436509052.000000") + status_line(3, "1436509052.000150") +
                 status_line(3, "1436509054.000000") + status_line(3, "1436509054.000001"));
  CHECK(trace.transfers.size() == 2);
  CHECK(trace.error_words() == Names{"transfer_id", "transfer_id"});
  CHECK(trace.errors[0]["time"] == 1436509052.000150);
}

TEST_CASE("the interfaces of a log do not mix") {
  // The frames of one transfer on two interfaces, one by one; repeated transfer IDs on a third.
  const Bench bench;
  std::string log;
  const char* frames[] = {"1403F32A#1F76030038FF7F80", "1403F32A#00BD1160"};
  for (const char* frame : frames) {
    for (const char* interface : {"can0", "vcan1"}) {
      log += fmt::format("(1436509052.000000) {} {}\n", interface, frame);
    }
  }
  log += fmt::format("(1436509052.100000) can2 {}\n", frames[0]);
  const auto trace = trace_log(bench, log);
  REQUIRE(trace.transfers.size() == 2);
  CHECK(trace.transfers[0]["interface"] == "can0");
  CHECK(trace.transfers[1]["interface"] == "vcan1");
  CHECK(trace.transfers[0]["fields"]["position"] == 0.5);
  CHECK(trace.transfers[0]["fields"]["force"].is_null());
  CHECK(trace.error_words() == Names{"timeout"}); // what the log's end left unfinished
  CHECK(trace.errors[0]["interface"] == "can2");
}

TEST_CASE("types that nobody knows are shown by their number, and of several frames unchecked") {
  const Bench bench;
  const auto trace = trace_log(bench, "(1.000000) can0 144E200B#01C0\n"
                                      "(1.100000) can0 144E200B#AAAA010203040581\n"
                                      "(1.200000) can0 144E200B#0607080961\n");
  REQUIRE(trace.transfers.size() == 2);
  CHECK(trace.errors.empty());
  for (const auto& shown : trace.transfers) {
    CHECK(shown["type"].is_null());
    CHECK(shown["fields"].is_null());
    CHECK(shown["data_type_id"] == 20000);
  }
  CHECK_FALSE(trace.transfers[0].contains("crc_checked"));
  CHECK(trace.transfers[1]["crc_checked"] == false);
  CHECK(trace.transfers[1]["payload"] == "010203040506070809");
}

TEST_CASE("a payload that contradicts its type has no fields") {
  const Bench bench;
  const auto trace = trace_log(bench, "(1.000000) can0 1E0B8AFF#0005C0\n"); // no such union member
  REQUIRE(trace.transfers.size() == 1);
  CHECK(trace.transfers[0]["type"] == "uavcan.protocol.param.GetSet");
  CHECK(trace.transfers[0]["fields"].is_null());
}

TEST_CASE("foreign text is JSON for a reader and harmless for a terminal") {
  // A name with an escape sequence, a C1 control and broken UTF-8.
  const Bench bench;
  const std::string log = bench.file("x.log", "(1.000000) \x1b[31m 1E0B8AFF#00001B5BC29BFFC0\n");
  const Result document = bench.run({"trace", "-j", log});
  CHECK(is_fit_for_a_terminal(document.out));
  CHECK_FALSE(contains(document.out, "\xc2\x9b"));
  const auto shown = traced(document).transfers.at(0);
  CHECK(shown["fields"]["name"] == "\x1b[\xc2\x9b\uFFFD");
  CHECK(shown["interface"] == "\x1b[31m");
  const Result text = bench.run({"trace", log});
  CHECK(is_fit_for_a_terminal(text.out));
  CHECK(contains(text.out, R"(name="\x1b[\xc2\x9b\xff")"));
}

TEST_CASE("text is a line a transfer, with words, registers and units") {
  const Bench bench;
  const Result result = bench.run(
      {"trace", bench.file("x.log", status_line(1, "1436509052.249713") +
                                        // ask for 0x38,
                                        "(1436509053.000000) can0 1E0B8AFF#000030783338C2\n"
                                        "(1436509053.200000) can0 1403F32A#00BD1160\n")});
  CHECK(result.status == 0);
  CHECK(contains(result.out, "    0.000000  can0   42 > *    NodeStatus               1  "
                             "uptime_sec=1234 health=ok mode=operational"));
  CHECK(contains(result.out, "127 > 10   GetSet.Request           2  0x38 angle_limit_cw ?\n"));
  CHECK(contains(result.out, "!!  missing_start: its first frame was not heard (1403F32A)\n"));
}

TEST_CASE("a number that the register cannot hold is shown as it came, not cut") {
  namespace dronecan = blactl::dronecan;
  const auto frames = dronecan::segment(
      {.kind = dronecan::Kind::response,
       .priority = 30,
       .data_type_id = dronecan::GetSet::type.id,
       .source = dronecan::NodeId(11),
       .destination = dronecan::NodeId(127)},
      1, dronecan::GetSet::type.signature,
      dronecan::GetSet::Response{.value = std::int64_t{999}, .name = "0x50"}.encode().bytes());
  std::string log;
  for (const can::Frame& frame : frames) {
    log += fmt::format("(1436509052.000000) can0 {:08X}#{:02X}\n", frame.id,
                       fmt::join(frame.payload(), ""));
  }
  const Bench bench;
  CHECK(contains(bench.run({"trace", bench.file("x.log", log)}).out, "0x50 model_number = 999\n"));
}

TEST_CASE("--type, --kind and -n choose, and what they do not choose is not an error either") {
  std::string log;
  double at = log_begins;
  for (const auto& vector : vectors()["transfers"]) {
    for (const auto& frame : vector["frames"]) {
      log += log_line(frame, at);
    }
    at += 3;
  }
  log += "(1800000000.000000) can0 1403F32A#00BD1160\n";
  const Bench bench;
  const auto shown = [&](const Arguments& more) {
    const auto trace = trace_log(bench, log, more);
    return std::pair(trace.transfers.size(), trace.errors.size());
  };
  const auto of = [](const auto& wanted) {
    return static_cast<std::size_t>(std::ranges::count_if(vectors()["transfers"], wanted));
  };
  const auto is = [](const char* key, const Json& value) {
    return [key, value](const Json& vector) { return vector[key] == value; };
  };
  using Shown = std::pair<std::size_t, std::size_t>;
  CHECK(shown({"--type", "NodeStatus"}) == Shown(of(is("dtid", 341)), 0));
  CHECK(shown({"--type", "nodestatus"}) == Shown(of(is("dtid", 341)), 0));
  CHECK(shown({"--type", "ACTUATOR.status"}) == Shown(of(is("dtid", 1011)), 1));
  CHECK(shown({"--type", "341"}) == Shown(of(is("dtid", 341)), 0));
  CHECK(shown({"--type", "actuator.Status"}) == Shown(of(is("dtid", 1011)), 1));
  CHECK(shown({"--type", "uavcan.protocol.param.GetSet"}) == Shown(of(is("dtid", 11)), 0));
  // A number means messages and services, a name just its own.
  CHECK(shown({"--type", "1"}) == Shown(of(is("dtid", 1)), 0));
  CHECK(shown({"--type", "Allocation,NodeStatus"}) ==
        Shown(of(is("dtid", 341)) + of([](const Json& vector) {
                return vector["dtid"] == 1 && vector["kind"] == "message";
              }),
              0));
  CHECK(shown({"--kind", "request"}) == Shown(of(is("kind", "request")), 0));
  CHECK(shown({"--kind", "message,response"}) ==
        Shown(of(is("kind", "message")) + of(is("kind", "response")), 1));
  CHECK(
      shown({"-n", "42"}) ==
      Shown(of([](const Json& vector) { return vector["src"] == 42 || vector["dst"] == 42; }), 1));
  CHECK(shown({"-n", "1-41"}).second == 0);
}

TEST_CASE("what cannot be chosen is refused before anything is opened") {
  const auto refused = [](const Arguments& arguments, std::string_view said) {
    Arguments all{"-i", "nosuchcan0", "trace"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Result result = run(all);
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(result.out.empty());
    CHECK(codes(result) == Names{"usage"});
    CHECK(contains(result.err, said));
  };
  refused({"--type", "NodStatus"}, "did you mean NodeStatus");
  refused({"--type", "70000"}, "there is no data type '70000'");
  refused({"--type", "341,"}, "there is no data type ''");
  refused({"--kind", "reqest"}, "not one of message, request, response");
  refused({"-n", "serial:240900558"}, "trace takes node IDs only");
  refused({"-n", "all"}, "trace takes node IDs only");
  refused({"--count", "0"}, "--count 0");
  refused({"--duration", "0"}, "--duration 0");
  refused({"--csv"}, "no CSV output");
  const Result document = run({"trace", "--type", "NodStatus", "-j"});
  REQUIRE(json_lines(document.out).size() == 1);
  CHECK(json(document.out)["errors"][0]["code"] == "usage");
  CHECK(json_lines(run({"trace", "--frob", "-j"}).out).at(0)["command"] == "trace");
}

TEST_CASE("--count and --duration end a log early") {
  const Bench bench;
  std::string log;
  for (int i = 0; i < 20; ++i) {
    log += status_line(i, fmt::format("14365090{:02}.000000", 10 + i));
  }
  CHECK(trace_log(bench, log, {"--count", "5"}).transfers.size() == 5);
  CHECK(trace_log(bench, log, {"--duration", "4.5"}).transfers.size() == 5);
  CHECK(trace_log(bench, log, {"--count", "99"}).transfers.size() == 20);
}

TEST_CASE("a log without a frame is a bad file, one that is not there too") {
  const Bench bench;
  const Result empty = bench.run({"trace", bench.file("x.log", "")});
  CHECK(empty.status == 2);
  CHECK(codes(empty) == Names{"bad_file"});
  const Result prose = bench.run({"trace", "-j", bench.file("x.log", "dear diary\n")});
  CHECK(prose.status == 2);
  CHECK(json(prose.out)["errors"][0]["code"] == "bad_file");
  CHECK(json(prose.out)["counts"]["bad_lines"] == 1);
  const Result missing = bench.run({"trace", "no.log"});
  CHECK(missing.status == 2);
  CHECK(codes(missing) == Names{"bad_file"});
  CHECK(bench.run({"-i", "replay:no.log", "trace"}).status == 3);
}

TEST_CASE("lines that are no frames are passed over, and told") {
  const Bench bench;
  const std::string log = bench.file("x.log", "dear diary\n" + status_line(0, "1.000000") + "x\n");
  const Result result = bench.run({"trace", log});
  CHECK(result.status == 0);
  CHECK(std::ranges::count(result.out, '\n') == 1);
  CHECK(contains(result.err, "not frames: 2, the first is line 1"));
}

TEST_CASE("a pipe is shown while it is filled") {
  const Bench bench;
  const Result result = bench.run(
      {"trace", "-j", "-"}, {.stdin_text = status_line(0, "1.000000"),
                             .answers = {{R"("transfer_id":0)", status_line(1, "2.000000")},
                                         {R"("transfer_id":1)", status_line(2, "3.000000")}}});
  CHECK(result.status == 0);
  CHECK(traced(result).transfers.size() == 3);
}

TEST_CASE("a pipe that nobody fills is left with Ctrl-C") {
  const Bench bench;
  Background trace(bench, {"trace", "-j", "-"},
                   {.stdin_text = status_line(0, "1.000000"), .answers = {{"never said", ""}}},
                   "NodeStatus");
  const Result result = trace.stop(SIGINT);
  CHECK(result.status == 130);
  CHECK(traced(result).transfers.size() == 1);
}

TEST_CASE("trace of a bus shows what its servos send, and sends nothing itself") {
  const Bench bench;
  const auto trace = traced(three_servos().run(bench, {"trace", "-j", "--duration", "2"}));
  CHECK(trace.errors.empty());
  CHECK(trace.end["exit_status"] == 0);
  CHECK(trace.end["counts"]["lost"] == 0);
  std::map<std::pair<int, std::string>, int> heard;
  for (const auto& shown : trace.transfers) {
    ++heard[{shown["source"].get<int>(), shown["type"].get<std::string>()}];
  }
  for (const int node : {11, 12, 13}) {
    CHECK(heard[{node, "uavcan.protocol.NodeStatus"}] == 2);
    CHECK(heard[{node, "uavcan.equipment.actuator.Status"}] >= 19);
  }
  CHECK(heard.size() == 6);
}

TEST_CASE("a trace that is recorded replays to the same transfers") {
  const Bench bench;
  const std::string log = bench.file("t.log", "");
  const Result live = three_servos().run(bench, {"trace", "-j", "--count", "20", "--record", log});
  CHECK(live.status == 0);
  const auto replayed = bench.run({"-i", "replay:" + log, "trace", "-j", "--count", "20"});
  REQUIRE(traced(live).transfers.size() == 20);
  const auto named = [](const Result& result) {
    std::vector<std::string> names;
    for (const Json& transfer : traced(result).transfers) {
      names.push_back(transfer["type"].dump() + transfer["source"].dump() +
                      transfer["transfer_id"].dump() + transfer["fields"].dump());
    }
    return names;
  };
  CHECK(named(replayed) == named(live));
}

TEST_CASE("a trace that cannot be recorded is not begun, a log is not recorded again") {
  const Bench bench;
  const Result nowhere =
      three_servos().run(bench, {"trace", "--count", "1", "--record", "/no/where.log"});
  CHECK(nowhere.status != 0);
  CHECK(nowhere.out.empty());
  const Result copied = bench.run({"trace", bench.file("x.log", status_line(0, "1.000000")),
                                   "--record", bench.file("y.log", "")});
  CHECK(copied.status == 2);
}

TEST_CASE("trace of a bus ends after --count transfers that were chosen") {
  const auto trace = traced(
      three_servos().run({"trace", "-j", "--count", "3", "--type", "NodeStatus", "-n", "12"}));
  CHECK(trace.transfers.size() == 3);
  for (const auto& shown : trace.transfers) {
    CHECK(shown["source"] == 12);
    CHECK(shown["data_type_id"] == 341);
  }
}

TEST_CASE("trace of a bus ends with Ctrl-C, and the last object says so") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  for (const int signal : {SIGINT, SIGTERM}) {
    Background trace(bench, {"-i", "sim:", "trace", "-j"}, {}, "NodeStatus");
    const Result result = trace.stop(signal);
    CHECK(result.status == 128 + signal);
    CHECK(traced(result).transfers.size() >= 1);
    CHECK(result.err.empty());
  }
}

TEST_CASE("broken transfers on the bus are shown for what they are") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  Background trace(bench, {"-i", "sim:", "trace", "-j"}, {}, "NodeStatus");
  const auto bus = join(bench);
  const auto send = [&](std::uint32_t id, const std::vector<std::uint8_t>& bytes) {
    REQUIRE(bus->send(frame_of(id, bytes)).value_or(false));
  };
  send(0x1403F32A, {0x1F, 0x76, 3, 0, 0x38, 0xFF, 0x7F, 0x81});
  send(0x1403F32A, {0, 0xBD, 0x12, 0x61}); // one bit is wrong
  trace.expect(R"("error":"crc")");
  send(0x1403F32A, {0x1F, 0x76, 3, 0, 0x38, 0xFF, 0x7F, 0x82});
  trace.expect(R"("error":"timeout")"); // though nothing more comes from it
  send(0x1401552A, {1, 2, 0xDF});
  trace.expect(R"("error":"short")");
  const auto words = traced(trace.stop(SIGINT)).error_words();
  CHECK(words == Names{"crc", "timeout", "short"});
}

TEST_CASE("a reader that leaves ends a trace without a word") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  for (const Arguments& format : {Arguments{}, {"-j"}}) {
    Arguments arguments{"-i", "sim:", "trace"};
    arguments.insert(arguments.end(), format.begin(), format.end());
    const Result result = bench.run(arguments, {.leave_after = "NodeStatus"});
    CHECK(result.status == 0);
    CHECK(result.err.empty());
  }
}

TEST_CASE("a trace that cannot be written fails once") {
  const Bench bench;
  const std::string log = bench.file("x.log", status_line(0, "1.000000"));
  for (const Arguments& arguments : {Arguments{"trace", log}, {"trace", "-j", log}}) {
    const Result result = bench.run(arguments, {.stdout_file = "/dev/full"});
    CHECK(result.status == 1);
    CHECK(codes(result) == Names{"io"});
  }
}

namespace {

std::string three_statuses() {
  return status_line(0, "1.000000") + status_line(1, "2.000000") + status_line(2, "3.000000");
}

} // namespace

TEST_CASE("a log that gzip has packed is traced like any other, from a file and a pipe") {
  const Bench bench;
  const std::string log = three_statuses();
  const std::string packed = gzipped(log);
  const Result plain = bench.run({"trace", bench.file("x.log", log)});
  const std::string file = bench.file("x.bin", packed); // the name says nothing
  CHECK(bench.run({"trace", file}).out == plain.out);
  CHECK(bench.run({"-i", "replay:" + file, "trace"}).out == plain.out);
  CHECK(bench.run({"trace", "-"}, {.stdin_text = packed}).out == plain.out);
  const Result scanned = bench.run({"-i", "replay:" + file, "scan"});
  CHECK(scanned.out == bench.run({"-i", "replay:" + bench.file("y.log", log), "scan"}).out);
}

TEST_CASE("a packed log that is cut off shows what it holds, and is a bad file") {
  const Bench bench;
  const std::string packed = gzipped(three_statuses());
  const std::string file = bench.file("x.log.gz", packed.substr(0, packed.size() - 6));
  const Result result = bench.run({"trace", file});
  CHECK(result.status == 2);
  CHECK(std::ranges::count(result.out, '\n') == 3);
  CHECK(codes(result) == Names{"bad_file"});
  CHECK(contains(result.err, "x.log.gz is cut off: its gzip data ends too early; lines read "
                             "before: 3"));
  const auto stats = json(bench.run({"trace", "--stats", "-j", file}).out);
  CHECK(stats["types"][0]["count"] == 3);
  CHECK(stats["errors"][0]["code"] == "bad_file");
  CHECK(contains(bench.run({"trace", file, "--lang", "ja"}).err, "途中で切れています"));
  const Result scanned = bench.run({"-i", "replay:" + file, "scan"});
  CHECK(scanned.status == 2);
  CHECK(codes(scanned) == Names{"bad_file"});
}

TEST_CASE("what trace says to people is said in Japanese too") {
  const Bench bench;
  const std::string log = bench.file("x.log", "x\n(1.000000) can0 1403F32A#00BD1160\n");
  const Result text = bench.run({"trace", log, "--lang", "ja"});
  CHECK(contains(text.out, "missing_start: 先頭のフレームを受信していません"));
  CHECK(contains(bench.run({"trace", log, "--stats", "--lang", "ja"}).out, "ジッタ"));
  CHECK(contains(bench.run({"trace", "--type", "x", "--lang", "ja"}).err,
                 "データ型 'x' はありません"));
  CHECK(contains(bench.run({"trace", "-n", "all", "--lang", "ja"}).err, "ノード ID のみ"));
}

TEST_CASE("people read the time since the first frame, with --absolute the time of day") {
  const Bench bench;
  const std::string log =
      bench.file("x.log", "(1436509052.249713) can0 1401557F#0011223344556601\n"
                          "(1436509053.500000) can0 1401557F#0011223344556602\n");
  const Result relative = bench.run({"trace", log});
  CHECK(relative.out.starts_with("    0.000000  can0 "));
  CHECK(contains(relative.out, "\n    1.250287  can0 "));
  const Result absolute = bench.run({"trace", log, "--absolute"}, {.env = {{"TZ", "UTC"}}});
  CHECK(absolute.out.starts_with("2015-07-10 06:17:32.249713  can0 "));
}

TEST_CASE("types that end alike are told apart, and every fault of the arguments is told") {
  const Scene scene = three_servos().foreign(30, {{"kind", "esc"}, {"index", 0}});
  const Result result = scene.run({"trace", "--duration", "1.2"});
  CHECK(contains(result.out, "  actuator.Status  "));
  CHECK(contains(result.out, "  esc.Status  "));
  const Result faults = run({"trace", "-", "--type", "NodStatus,Fooo,gps.Fixx", "-n", "serial:5"});
  CHECK(faults.status == 2);
  CHECK(codes(faults) == std::vector<std::string>{"usage", "usage", "usage", "usage"});
  CHECK(contains(faults.err, "did you mean NodeStatus?"));
}
