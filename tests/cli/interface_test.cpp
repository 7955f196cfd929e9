// What is refused before, and while, an interface is opened.

#include "catch.hpp"
#include "scene.hpp"

#include <filesystem>
#include <fstream>

using namespace blactl::test;

namespace {

struct Refusal {
  Arguments arguments;
  std::string code;
  std::string message; ///< a part of it
  std::string hint;    ///< a part of it
};

/// The commands in it repeat the interface that was typed.
std::string hint_of(const Refusal& refusal) {
  constexpr std::string_view program = "`blactl ";
  std::string hint = refusal.hint;
  const bool is_typed =
      refusal.arguments.size() > 1 && refusal.arguments[1] == "can_does_not_exist";
  const auto at = is_typed ? hint.find(program) : std::string::npos;
  return at != std::string::npos ? hint.insert(at + program.size(), "-i can_does_not_exist ")
                                 : hint;
}

/// The refusal as a person and as a script see it.
void check_refusal(const Refusal& refusal, int status) {
  std::string line = "blactl";
  for (const auto& argument : refusal.arguments) {
    line += " " + argument;
  }
  INFO(line);
  const Bench bench;
  const Result text = bench.run(refusal.arguments);
  CHECK(text.status == status);
  CHECK(text.out.empty());
  CHECK(codes(text) == std::vector{refusal.code});
  CHECK(contains(text.err, refusal.message));
  CHECK(contains(text.err, "\n  " + hint_of(refusal)));

  Arguments arguments = refusal.arguments;
  arguments.insert(arguments.begin(), "-j");
  const Result document = bench.run(arguments);
  CHECK(document.status == status);
  const auto errors = json(document.out)["errors"];
  REQUIRE(errors.size() == 1);
  CHECK(errors[0]["code"] == refusal.code);
  CHECK(contains(errors[0]["message"].get<std::string>(), refusal.message));
  CHECK(contains(errors[0]["hint"].get<std::string>(), hint_of(refusal)));
  CHECK(json(document.out)["exit_status"] == status);
}

bool machine_has_can() {
  constexpr int arphrd_can = 280;
  for (const auto& link : std::filesystem::directory_iterator("/sys/class/net")) {
    int type = 0;
    std::ifstream(link.path() / "type") >> type;
    if (type == arphrd_can) {
      return true;
    }
  }
  return false;
}

} // namespace

TEST_CASE("a bus-off is told with what ends it on this kind of interface") {
  const Bench bench;
  const std::string scenario =
      bench.file("s.json", R"({"schema":"blactl-scenario/1","clock":"virtual","servos":[],)"
                           R"("events":[{"at":"100ms","clients":"bus_off"}]})");
  const Result result = bench.run({"-i", "sim:" + scenario, "scan"});
  CHECK(result.status == 3);
  CHECK(codes(result) == std::vector<std::string>{"bus_off"});
  CHECK(contains(result.err, "`clients bus_off`; run the command again"));
  CHECK_FALSE(contains(result.err, "ip link"));
}

TEST_CASE("a command line that is not understood is refused with the way on") {
  const std::vector<Refusal> refusals{
      {{"-q"}, "usage", "no command given", "see blactl --help"},
      {{"scna"}, "usage", "there is no command 'scna'", "did you mean scan?"},
      {{"frobnicate"}, "usage", "there is no command 'frobnicate'", "see blactl --help"},
      {{"get", "--frob"}, "usage", "unknown option: --frob", "see blactl get --help"},
      {{"set"}, "usage", "PARAM=VALUE is missing", "see blactl set --help"},
      {{"get", "-n"}, "usage", "--node needs a value", "see blactl get --help"},
      {{"get", "--chnged"}, "usage", "unknown option: --chnged", "did you mean --changed?"},
      {{"get", "--color", "alway"}, "usage", "--color alway: not one of", "did you mean always?"},
      {{"get", "--changed=no"}, "usage", "--changed takes no value", "see blactl get --help"},
      {{"-i", "/dev/ttyUSB0", "scan"},
       "usage",
       "-i /dev/ttyUSB0: the kind of interface is missing",
       "did you mean -i slcan:/dev/ttyUSB0?"},
      {{"-i", "ttyACM1", "scan"},
       "usage",
       "-i ttyACM1: the kind",
       "did you mean -i slcan:/dev/ttyACM1?"},
      {{"-i", "slcan", "scan"}, "usage", "-i slcan: the kind", "did you mean -i slcan:/dev/"},
      {{"-i", "sim", "scan"}, "usage", "-i sim: the kind", "did you mean -i sim:?"},
      {{"-i", "a.json", "scan"}, "usage", "-i a.json: the kind", "did you mean -i sim:a.json?"},
      {{"-i", "bus.log", "scan"},
       "usage",
       "-i bus.log: the kind",
       "did you mean -i replay:bus.log?"},
      {{"-i", "b.asc", "scan"}, "usage", "-i b.asc: the kind", "did you mean -i replay:b.asc?"},
      {{"-i", "b.trc", "scan"}, "usage", "-i b.trc: the kind", "did you mean -i replay:b.trc?"},
      {{"get", "-n", ""}, "usage", "--node: the value is empty", "see blactl --help"},
      {{"models", "-n", "12"},
       "usage",
       "models does not contact servos: it takes no --node",
       "see"},
      {{"-i", "", "scan"}, "usage", "--interface: the value is empty", "see blactl --help"},
      {{"scan", "--listen", "nan"},
       "usage",
       "--listen nan: not a number of seconds between",
       "see"},
      {{"scan", "--expect", "-1"},
       "usage",
       "--expect -1: not a whole number between 0 and 127",
       ""},
      {{"get", "--retries", "1e3"}, "usage", "--retries 1e3: not a whole number", "see"},
      {{"get", "--timeout", "0"}, "usage", "--timeout 0: not a number of seconds", "see"},
      {{"get", "--local-node-id", "128"}, "usage", "--local-node-id 128: not a whole", "see"},
      {{"get", "--color", "blue"}, "usage", "--color blue: not one of auto, always, never", "see"},
      {{"get", "--lang", "fr"}, "usage", "--lang fr: not one of en, ja", "see"},
      {{"sim", "--clock", "sun"}, "usage", "--clock sun: not one of real, virtual", "see"},
      {{"-i", "nosuch:1", "scan"},
       "usage",
       "-i nosuch:1: no such kind of interface",
       "for example -i can0"},
      {{"sim", "-i", "sim:some.json"},
       "usage",
       "a scenario is an argument of sim",
       "blactl sim some.json"},
  };
  for (Refusal refusal : refusals) {
    check_refusal(refusal, 2);
  }
}

TEST_CASE("all faults of a command line come at once") {
  const Arguments line{"get", "--frob", "--timeout", "x", "-n", "0", "--group", "g", "-i", "sim"};
  const Result text = run(line);
  CHECK(text.status == 2);
  CHECK(text.out.empty());
  CHECK(codes(text) == std::vector<std::string>(5, "usage"));
  Arguments with_json = line;
  with_json.emplace_back("-j");
  const auto document = json(run(with_json).out);
  CHECK(document["exit_status"] == 2);
  REQUIRE(document["errors"].size() == 5);
  for (const auto& error : document["errors"]) {
    CHECK(contains(text.err, error["message"].get<std::string>()));
    CHECK(contains(text.err, error["hint"].get<std::string>()));
  }
}

TEST_CASE("of an option given twice the last one holds, and -n adds up") {
  const auto nodes = json(three_servos()
                              .run({"-n", "11", "get", "-n", "12", "servo_id", "--timeout", "9",
                                    "--timeout", "1", "-j"})
                              .out)["nodes"];
  REQUIRE(nodes.size() == 2);
  CHECK(nodes[0]["node_id"] == 11);
  CHECK(nodes[1]["node_id"] == 12);
}

TEST_CASE("--csv is refused where there is no table, and beside --json") {
  for (const Arguments& command : {Arguments{"set", "servo_id=3"}, {"models"}, {"sim"}}) {
    Arguments arguments = command;
    arguments.emplace_back("--csv");
    const Result result = run(arguments);
    CHECK(result.status == 2);
    CHECK(contains(result.err,
                   "[usage] " + command.front() + " has no CSV output\n  use --json instead"));
  }
  const Result both = run({"get", "--csv", "-j"});
  CHECK(both.status == 2);
  CHECK(json(both.out)["errors"][0]["message"] == "--json and --csv exclude each other");
}

// The interface does not exist: whatever opened it would end with 3.
TEST_CASE("what every model would refuse opens no interface") {
  const std::vector<Refusal> refusals{
      {{"set", "0x60=1"},
       "unknown_parameter",
       "0x60: there is no such parameter",
       "`blactl get` lists"},
      {{"set", "torqe_output=on"},
       "unknown_parameter",
       "torqe_output",
       "did you mean torque_output?"},
      {{"set", "Limit Angle CW=90deg"},
       "unknown_parameter",
       "Limit Angle CW",
       "did you mean angle_limit_cw?"},
      {{"get", "current_torqe"},
       "unknown_parameter",
       "current_torqe",
       "did you mean current_torque?"},
      {{"set", "0x03=1"}, "unsupported", "0x03 is a reserved address", "`blactl get` lists"},
      {{"get", "0x04"}, "unsupported", "0x04 is a reserved address", "`blactl get` lists"},
      {{"set", "0x49=1"}, "unsupported", "0x49 starts the boot loader", "`blactl get` lists"},
      {{"set", "bootloader=1"}, "unsupported", "0x49 starts the boot loader", "`blactl get` lists"},
      {{"set", "0x10=1"},
       "unsupported",
       "initialize (0x10) is an operation, not a setting",
       "use `blactl erase`"},
      {{"set", "reboot=1"},
       "unsupported",
       "reboot (0x11) is an operation, not a setting",
       "use `blactl restart`"},
      {{"set", "0x12=1"},
       "unsupported",
       "write_rom (0x12) is an operation, not a setting",
       "use `blactl save`"},
      {{"get", "0x10"}, "unsupported", "initialize can only be written", "it is an operation"},
      {{"get", "0x49"},
       "unsupported",
       "bootloader (0x49) is neither read nor written",
       "the specification forbids it"},
      {{"set", "current_angle=1deg"},
       "read_only",
       "current_angle (0x08) can only be read",
       "`blactl get current_angle`"},
      {{"set", "serial_number=1"},
       "read_only",
       "serial_number (0x51) can only be read",
       "`blactl get serial_number`"},
      {{"set", "angle_limit_cw=-1deg"},
       "out_of_range",
       "angle_limit_cw=-1.0deg: outside of the range 0.0deg to 36000000.0deg",
       "type a value from 0.0deg to 36000000.0deg"},
      {{"set", "0x3C=101"},
       "out_of_range",
       "torque_limit_cw=101%: outside of the range 0% to 100%",
       "type a value from 0% to 100%"},
      {{"set", "torque_output=5"},
       "out_of_range",
       "this parameter takes on (0), off (1) or brake",
       "for example torque_output=on"},
      {{"set", "static_node_id=126"},
       "out_of_range",
       "126 and 127 belong to tools",
       "type an ID from 1 to 125"},
      {{"set", "0x46=127"}, "out_of_range", "126 and 127 belong to tools", "type an ID from 1"},
      {{"set", "command_angle=555555555raw"}, "out_of_range", "command_angle=555555555raw", "type"},
      {{"set", "servo_id=99999999999999999999"}, "out_of_range", "larger than any register", "for"},
      {{"set", "angle_limit_cw=90"},
       "usage",
       "angle_limit_cw=90: the unit is missing",
       "type angle_limit_cw=90deg (900raw) or angle_limit_cw=90raw (9.0deg)"},
      {{"set", "0x38=90.5"},
       "usage",
       "angle_limit_cw=90.5: the unit is missing",
       "type angle_limit_cw=90.5deg"},
      {{"set", "angle_limit_cw=90.05deg"},
       "usage",
       "the register counts in steps of 0.1deg",
       "type angle_limit_cw=90.0deg or angle_limit_cw=90.1deg"},
      {{"set", "angle_limit_cw=60rpm"}, "usage", "the unit rpm does not fit", "for example"},
      {{"set", "servo_id=3deg"}, "usage", "this parameter has no unit", "for example servo_id="},
      {{"set", "torque_output=yes"}, "usage", "torque_output=yes: unknown word", "for example"},
      {{"set", "servo_id"}, "usage", "servo_id: not of the form PARAM=VALUE", "for example"},
      {{"set", "angle_limit_cw=1deg", "0x38=10"},
       "usage",
       "angle_limit_cw is given twice",
       "name each parameter once"},
      {{"set", "pwm_output_range=70deg", "pwm_mode=speed"},
       "usage",
       "the unit is rpm",
       "type pwm_output_range=70rpm, or pwm_mode=angle pwm_output_range=70.0deg"},
      {{"get", "--group", "motor"},
       "usage",
       "there is no group 'motor'",
       "the groups are command, status, operation, fault, config, control, pwm, limit, option, "
       "product, production"},
      {{"get", "-n", "0"}, "usage", "-n 0: node IDs are 1 to 127", "see who is there: blactl scan"},
      {{"get", "-n", "128"},
       "usage",
       "-n 128: node IDs are 1 to 127",
       "see who is there: blactl scan"},
      {{"get", "-n", "14-10"}, "usage", "-n 14-10: the range goes downwards", "type -n 10-14"},
      {{"get", "-n", "11,"}, "usage", "not a node ID", "for example -n 12"},
      {{"get", "-n", "uid:1g"}, "usage", "-n uid:1g: not a node ID", "for example -n 12"},
      {{"scan", "-n", "colour:red"}, "usage", "-n colour:red: not a node ID", "for example"},
      {{"get", "--profile", "BLA99"}, "usage", "there is no model 'BLA99'", "the models are BLA15"},
      {{"get", "--profile", "BLA21"}, "usage", "'BLA21' means several models", "the models are"},
      {{"get", "--listen-only"}, "usage", "get must send", "leave --listen-only out"},
      {{"set", "servo_id=3", "--listen-only"}, "usage", "set must send", "leave --listen-only"},
      {{"scan", "--profile-dir", "/nonexistent"},
       "bad_file",
       "cannot read the profiles in /nonexistent",
       "check --profile-dir or BLACTL_PROFILE_DIR"},
  };
  for (Refusal refusal : refusals) {
    refusal.arguments.insert(refusal.arguments.begin(), {"-i", "can_does_not_exist"});
    check_refusal(refusal, 2);
  }
}

TEST_CASE("numbers are written one way only") {
  for (const char* value : {"+3", "1e2", "0x10", "1,5", "90 deg", " 90deg", "90.deg", ".5deg",
                            "90DEG", "--9deg", "", "-", "raw", "NaNdeg", "９０deg"}) {
    check_refusal({{"-i", "can_does_not_exist", "set", std::string("angle_limit_cw=") + value},
                   "usage",
                   "",
                   ""},
                  2);
  }
}

TEST_CASE("an interface that does not exist is exit 3, by every command that needs one") {
  for (const Arguments& command : {Arguments{"scan"}, {"get"}, {"set", "servo_id=3"}, {"sim"}}) {
    Arguments arguments{"-i", "can_does_not_exist"};
    arguments.insert(arguments.end(), command.begin(), command.end());
    const Result result = run(arguments);
    INFO(result.err);
    CHECK(result.status == 3);
    CHECK(result.out.empty());
    CHECK(contains(result.err, "can_does_not_exist"));
    CHECK(contains(result.err, "sim:"));
  }
}

TEST_CASE("a machine without CAN is told how to bring an interface up, or to do without",
          "[machine-without-can][may-skip]") {
  if (machine_has_can()) {
    WARN("skipped: this machine has a CAN interface");
    return;
  }
  check_refusal({{"scan"}, "interface", "no CAN interface is up", "for example: sudo ip link set"},
                3);
}

TEST_CASE("a simulator that is not there is exit 3 with the command that starts one") {
  const Bench bench;
  check_refusal({{"-i", "sim:" + (bench.folder() / "nobody").string(), "scan"},
                 "interface",
                 "no simulator serves",
                 "start `blactl sim` in another terminal"},
                3);
}

TEST_CASE("-i sim: without a simulator is a private fresh one, and says so") {
  const Result quiet = run({"-q", "-i", "sim:", "get", "-n", "11", "servo_id"});
  CHECK(quiet.status == 0);
  CHECK(quiet.err.empty());
  const Result verbose = run({"-i", "sim:", "get", "-n", "11", "servo_id"});
  CHECK(verbose.out == quiet.out);
  CHECK(contains(verbose.err, "no simulator is running"));
}

TEST_CASE("the interface comes from BLACTL_INTERFACE unless -i names one") {
  const Bench bench;
  const std::string scene = "sim:" + three_servos().write(bench);
  const Options options{.env = {{"BLACTL_INTERFACE", scene}}};
  CHECK(json(bench.run({"get", "servo_id", "-j"}, options).out)["interface"] == scene);
  CHECK(bench.run({"-i", "can_does_not_exist", "get"}, options).status == 3);
}

TEST_CASE("every fault of a scenario file is told with file, line, pointer and reason") {
  const Bench bench;
  const std::string file = bench.file("bad.json", R"({
  "schema": "blactl-scenario/1",
  "servos": [
    {"model": "BLA99-12U-AB"},
    {"model": "BLA21-12U-AB", "node_id": 200, "ram": {"angle_limit_cw": 90}}
  ],
  "surprise": 1
})");
  for (const Arguments& command : {Arguments{"-i", "sim:" + file, "scan"}, {"sim", file}}) {
    const Result result = bench.run(command);
    CHECK(result.status == 2);
    CHECK(codes(result) == std::vector<std::string>{"bad_file"});
    CHECK(contains(result.err, file + ":4: /servos/0/model: no model is called"));
    CHECK(contains(result.err, file + ":5: /servos/1/node_id: 200 is more than 127"));
    CHECK(contains(result.err, file + ":5: /servos/1/ram/angle_limit_cw: "));
    CHECK(contains(result.err, file + ":7: /surprise: this key is not known"));
    CHECK(contains(result.err, "\n  correct the file and try again"));
  }
  const Result missing = bench.run({"-i", "sim:" + file + ".json", "scan"});
  CHECK(missing.status == 2);
  CHECK(contains(missing.err, "\n  check the file's name and permissions"));
}

TEST_CASE("a faulty profile is told with file, line, pointer and reason") {
  const Bench bench;
  const std::string file = bench.file("BLA77.json", "{\n  \"schema\": \"blactl-profile/1\",\n"
                                                    "  \"family\": \"BLA\",\n  \"series\": 7\n}\n");
  const Result result = bench.run({"models", "--profile-dir", bench.folder()});
  CHECK(result.status == 2);
  CHECK(codes(result) == std::vector<std::string>{"bad_file"});
  CHECK(contains(result.err, file + ":4: /series: must be a string, not an integer"));
  const Result environment =
      bench.run({"models"}, {.env = {{"BLACTL_PROFILE_DIR", bench.folder().string()}}});
  CHECK(environment.status == 2);
}

TEST_CASE("a profile that replaces a built-in one is announced") {
  const Bench bench;
  std::filesystem::copy(std::filesystem::path(BLACTL_PROFILES) / "BLA34.json", bench.folder());
  const Result result = bench.run({"models", "BLA34", "--profile-dir", bench.folder()});
  CHECK(result.status == 0);
  CHECK(contains(result.err, "BLA34-12U-AB replaces the built-in profile"));
}

TEST_CASE("where another node has 127 the command goes on with 126, and one note says so",
          "[requirement-14]") {
  const Scene scene = three_servos().foreign(127);
  const std::string note = "blactl: own node ID 126: 127 is used by another node\n";
  const Result scan = scene.run({"scan"});
  CHECK(scan.status == 0);
  CHECK(scan.err == note);
  CHECK(contains(scan.out, "\n127 "));
  const Result set = scene.run({"set", "-n", "11", "angle_dead_band=0.3deg"});
  CHECK(set.status == 0);
  CHECK(set.err == note);
  const Result japanese = scene.run({"scan", "--lang", "ja"});
  CHECK(contains(japanese.err, "自ノード ID 126: 127 は別のノードが使用中"));
}

TEST_CASE("a servo that has a tool's ID is a servo like others") {
  for (const int id : {126, 127}) {
    const Scene scene = Scene().servo("BLA21-12U-AB", id, {{"servo_id", 4}});
    const auto found = json(scene.run({"scan", "--json"}).out);
    REQUIRE(found["nodes"].size() == 1);
    CHECK(found["nodes"][0]["node_id"] == id);
    CHECK(found["nodes"][0]["servo_id"] == 4);
    const Result get = scene.run({"get", "-n", std::to_string(id), "servo_id"});
    CHECK(get.status == 0);
    CHECK(get.err.empty()); // its ID was left to it from the beginning
  }
}

TEST_CASE("where others have both IDs of tools a command ends with 9") {
  const Result result = three_servos().foreign(127).foreign(126).run({"scan"});
  CHECK(result.status == 9);
  CHECK(codes(result) == std::vector<std::string>{"no_local_node_id"});
  CHECK(contains(result.err, "127 is used by another node, 126 is used by another node"));
  CHECK(contains(result.err, "\n  give a free node ID: --local-node-id ID"));
  CHECK(contains(result.err, "blactl --local-node-id ID set -n 126 static_node_id=N --save"));
}

TEST_CASE("an ID of ours that somebody has is not spoken with") {
  const Scene scene = three_servos();
  const Result taken = scene.run({"scan", "--local-node-id", "11"});
  CHECK(taken.status == 9);
  CHECK(contains(taken.err, "node ID 11 is used by another node"));
  CHECK(scene.run({"get", "-n", "11", "--local-node-id", "50", "servo_id"}).status == 0);
}

TEST_CASE("nobody acknowledges on a bus without any node") {
  const Result result = Scene().run({"scan"});
  CHECK(result.status == 3);
  CHECK(codes(result) == std::vector<std::string>{"no_acknowledge"});
  CHECK(contains(result.err, "\n  is a servo in the scenario "));
}

TEST_CASE("where nobody was heard the hint fits the kind of interface") {
  const Bench bench;
  const std::string log = bench.file("other.log", "(1.000000) can0 123#0102\n");
  const std::string listed = bench.file("empty.json", R"({"schema": "blactl-scenario/1"})");
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"-i", "replay:" + log, "scan"}, "\n  " + log + " holds nothing that a DroneCAN node said"},
      {{"-i", "sim:" + listed, "scan", "--listen-only"},
       "\n  is a servo in the scenario " + listed},
      {{"-i", "sim:" + listed, "get"}, "\n  is a servo in the scenario " + listed},
  };
  for (const auto& [arguments, hint] : cases) {
    const Result result = bench.run(arguments);
    INFO(result.err);
    CHECK(contains(result.err, hint));
    CHECK_FALSE(contains(result.err, "bit rate"));
  }
  const Background sim(bench, {"sim", listed});
  CHECK(contains(bench.run({"-i", "sim:", "scan"}).err, "type dump there"));
}

TEST_CASE("an interface without a name is refused") {
  check_refusal({{"-i", "socketcan:", "scan"},
                 "usage",
                 "-i socketcan:: the name of the interface is missing",
                 "for example -i can0"},
                2);
}

TEST_CASE("a hint repeats the -i that was typed, and none of the environment") {
  const Bench bench;
  const std::string interface = "sim:" + three_servos().write(bench);
  const Result typed = bench.run({"-i", interface, "get", "-n", "55"});
  CHECK(contains(typed.err, "see who is there: blactl -i " + interface + " scan"));
  const Result as_json = bench.run({"-i", interface, "get", "-n", "55", "-j"});
  CHECK(contains(as_json.out, "blactl -i " + interface + " scan"));
  const Result set = bench.run({"get", "-n", "55"}, {.env = {{"BLACTL_INTERFACE", interface}}});
  CHECK(contains(set.err, "see who is there: blactl scan"));
}
