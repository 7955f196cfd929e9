// What goes where: data to stdout, everything else to stderr, whoever listens.

#include "catch.hpp"
#include "scene.hpp"
#include "tap.hpp"

#include <algorithm>

using namespace blactl::test;

namespace {

constexpr char escape = '\x1b';

const Arguments get_angle{"get", "-n", "11", "angle_limit_cw"};
const Arguments fails{"get", "-n", "55"};

Arguments with(const Arguments& arguments, const Arguments& more) {
  Arguments all = arguments;
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// English prose: three words in a row. Codes, names, units and commands do not look like that.
bool has_english(std::string_view text) {
  int words = 0;
  bool in_word = false;
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (letter && !in_word) {
      ++words;
    } else if (!letter && c != ' ') {
      words = 0;
    }
    in_word = letter;
    if (words >= 3) {
      return true;
    }
  }
  return false;
}

/// Without what is meant to be typed, which is the same in every language: from the command, or
/// the groups it takes, to the end of the quotation or line.
std::string without_commands(std::string text) {
  for (const char* command :
       {"sudo ip link", "sudo modprobe", "blactl sim", "blactl get", "blactl models", "blactl scan",
        "blactl set", "blactl --local-node-id", "blactl -i", "command status operation"}) {
    for (auto at = text.find(command); at != std::string::npos; at = text.find(command)) {
      text.erase(at, text.find_first_of("`)\n", at) - at);
    }
  }
  return text;
}

} // namespace

TEST_CASE("data is the same on a terminal and in a pipe, in every format") {
  for (const Arguments& format : {Arguments{}, {"--json"}, {"--csv"}}) {
    const Arguments arguments = with(get_angle, format);
    const Bench bench;
    const Result pipe = three_servos().run(bench, arguments);
    const Result terminal =
        three_servos().run(bench, arguments, {.terminal = true, .terminal_stdout = true});
    CHECK(pipe.status == 0);
    CHECK(terminal.out == pipe.out);
    CHECK(terminal.err.empty());
    CHECK_FALSE(contains(terminal.out, std::string(1, escape)));
  }
}

TEST_CASE("colour is for terminals, and as --color and NO_COLOR say") {
  const auto is_coloured = [](const Arguments& more, const Options& options) {
    const Result result = three_servos().run(with(fails, more), options);
    CHECK(result.status == 4);
    CHECK_FALSE(contains(result.out, std::string(1, escape)));
    return contains(result.err, std::string(1, escape));
  };
  const Options no_colour{.env = {{"NO_COLOR", "1"}}, .terminal = true};
  CHECK_FALSE(is_coloured({}, {}));
  CHECK(is_coloured({}, {.terminal = true}));
  CHECK_FALSE(is_coloured({}, no_colour));
  CHECK_FALSE(is_coloured({}, {.env = {{"TERM", "dumb"}}, .terminal = true}));
  CHECK(is_coloured({}, {.env = {{"NO_COLOR", ""}}, .terminal = true}));
  CHECK(is_coloured({"--color", "always"}, {}));
  CHECK(is_coloured({"--color", "always"}, no_colour));
  CHECK_FALSE(is_coloured({"--color", "never"}, {.terminal = true}));
}

TEST_CASE("a command line that is not understood is coloured as it says") {
  const auto is_coloured = [](const Arguments& arguments, const Options& options) {
    const Result result = run(arguments, options);
    CHECK(result.status == 2);
    return contains(result.err, std::string(1, escape));
  };
  CHECK(is_coloured({"get", "--frob"}, {.terminal = true}));
  CHECK_FALSE(is_coloured({"get", "--frob"}, {.env = {{"NO_COLOR", "1"}}, .terminal = true}));
  CHECK_FALSE(is_coloured({"get", "--frob", "--color", "never"}, {.terminal = true}));
  CHECK_FALSE(is_coloured({"gte", "--color=never"}, {.terminal = true}));
  CHECK(is_coloured({"--color", "always", "get", "--frob"}, {}));
}

TEST_CASE("why the system refuses is told in Japanese too") {
  const Result result = run({"-i", "replay:/nowhere/bus.log", "scan", "--lang", "ja"});
  CHECK(contains(result.err, "/nowhere/bus.log"));
  CHECK(contains(result.err, "ファイルまたはディレクトリがありません"));
}

TEST_CASE("output that cannot be written is a failure") {
  const Bench bench;
  for (const Arguments& command : {Arguments{"scan"},
                                   {"scan", "-j"},
                                   {"get", "--csv"},
                                   {"set", "-n", "11", "smoothing=off"}}) {
    const Result result = three_servos().run(bench, command, {.stdout_file = "/dev/full"});
    CHECK(result.status == 1);
    CHECK(codes(result) == std::vector<std::string>{"io"});
    CHECK(contains(result.err, "\n  free some space, or send the output elsewhere"));
  }
  for (const Arguments& command : {Arguments{"models"}, {"sim"}, {"--help"}}) {
    const Result result = bench.run(command, {.stdout_file = "/dev/full"});
    CHECK(result.status == 1);
    CHECK(codes(result) == std::vector<std::string>{"io"});
  }
}

TEST_CASE("a reader that leaves is no failure and no noise") {
  const Bench bench;
  for (const Arguments& command :
       {Arguments{"models", "-j"}, {"-qi", "sim:", "get"}, {"-qi", "sim:", "scan", "-j"}}) {
    const Result result = bench.run(command, {.leave_after = ""});
    CHECK(result.status == 0);
    CHECK(result.err.empty());
  }
}

TEST_CASE("--quiet leaves the errors") {
  const Bench bench;
  Background sim(bench, {"sim", "-q"});
  CHECK(sim.stop().err.empty());
  CHECK(codes(three_servos().run(with(fails, {"-q"}))) == std::vector<std::string>{"not_found"});
}

TEST_CASE("every failure prints a document, wherever the -j stands") {
  const std::vector<Arguments> lines{
      {"-j"},         {"-j", "--frob"},         {"--frob", "--json"},
      {"scna", "-j"}, {"get", "--frob", "-qj"}, {"-jn", "11", "get", "--frob"},
      {"set", "-j"},  {"get", "-j", "--csv"},   {"get", "--timeout", "never", "-j"},
  };
  for (const Arguments& line : lines) {
    const Result result = run(line);
    INFO(result.out);
    CHECK(result.status == 2);
    const auto document = ordered_json(result.out);
    CHECK(keys(document) == std::vector<std::string>{"schema", "command", "interface",
                                                     "exit_status", "nodes", "counts", "errors"});
    CHECK(document["schema"] == "blactl/1");
    CHECK(document["interface"].is_null());
    CHECK(document["exit_status"] == 2);
    CHECK(document["nodes"].empty());
    CHECK(keys(document["errors"][0]) ==
          std::vector<std::string>{"node_id", "code", "message", "hint"});
    CHECK(document["errors"][0]["code"] == "usage");
    const bool known = std::ranges::find(line, "get") != line.end();
    CHECK(document["command"].is_null() == (!known && line.front() != "set"));
  }
}

TEST_CASE("a document of a failure names the interface that was asked for") {
  const auto document = json(run({"-i", "can_does_not_exist", "scan", "-j"}).out);
  CHECK(document["interface"] == "can_does_not_exist");
  CHECK(document["exit_status"] == 3);
}

TEST_CASE("short options may share a dash") {
  CHECK(json(three_servos().run({"get", "-jqn", "11", "servo_id"}).out)["nodes"].size() == 1);
  CHECK(json(three_servos().run({"-jn12", "get", "servo_id"}).out)["nodes"][0]["node_id"] == 12);
}

TEST_CASE("--help and --version go to stdout and name what there is") {
  const Result help = run({"--help"});
  CHECK(help.status == 0);
  CHECK(help.err.empty());
  for (const char* there : {"scan",
                            "get",
                            "set",
                            "models",
                            "sim",
                            "--interface",
                            "--node",
                            "--local-node-id",
                            "--listen-only",
                            "--json",
                            "--csv",
                            "--quiet",
                            "--verbose",
                            "--color",
                            "--lang",
                            "--yes",
                            "--timeout",
                            "--retries",
                            "--while-driven",
                            "--profile-dir",
                            "--profile"}) {
    INFO(there);
    CHECK(contains(help.out, there));
  }
  for (const char* command :
       {"scan", "get", "set", "save", "erase", "restart", "wait", "trace", "models", "sim"}) {
    const Result own = run({command, "--help"});
    CHECK(own.status == 0);
    CHECK(contains(own.out, command));
  }
}

TEST_CASE("help speaks the language of --lang, fills the terminal and keeps to 80 columns else") {
  CHECK(contains(run({"--help", "--lang", "ja"}).out, "使い方: blactl"));
  CHECK(contains(run({"get", "--lang=ja", "-h"}).out, "パラメータの読出し"));
  CHECK(contains(run({"get", "-h"}, {.env = {{"LC_ALL", "ja_JP.UTF-8"}}}).out, "使い方"));
  const std::string plain = run({"--help"}).out;
  const std::string wide = run({"--help"}, {.terminal_stdout = true, .columns = 160}).out;
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  CHECK(lines(wide) < lines(plain));
}

TEST_CASE("--dump-cli has every command and option in both languages, and --help hides it") {
  const Result dump = run({"--dump-cli", "--lang", "ja"});
  CHECK(dump.status == 0);
  CHECK(dump.err.empty());
  CHECK(dump.out == run({"--dump-cli"}).out);
  const auto document = json(dump.out);
  CHECK(document["schema"] == "blactl-cli/1");
  CHECK(document["options"][0]["name"] == "--interface");
  CHECK(document["options"][0]["letter"] == "i");
  CHECK(document["options"][0]["kind"] == "interface");
  REQUIRE(document["interfaces"].size() == 7);
  CHECK(document["interfaces"][1]["name"] == "slcan");
  CHECK(document["interfaces"][1]["operand"] == "serial_port");
  REQUIRE(document["commands"].size() == 24);
  const auto get = document["commands"][2];
  CHECK(get["name"] == "get");
  CHECK(get["help_en"] == "read parameters");
  CHECK(get["help_ja"] == "パラメータの読出し");
  CHECK(get["arguments"][0]["repeat"] == "list");
  CHECK(get["options"][0]["words"].size() == 11);
  CHECK_FALSE(contains(run({"--help"}).out, "dump-cli"));
  CHECK(run({"--dump-cli"}, {.stdout_file = "/dev/full"}).status == 1);
}

TEST_CASE("everything that is said is said in Japanese too") {
  const Bench bench;
  const std::string bad = bench.file("bad.json", R"({"schema": "blactl-scenario/1", "x": 1})");
  const std::vector<Arguments> lines{
      {},
      {"scna"},
      {"get", "--frob"},
      {"set"},
      {"get", "-n"},
      {"get", "-n", ""},
      {"scan", "--listen", "x"},
      {"get", "--retries", "x"},
      {"get", "--color", "x"},
      {"get", "--csv", "-j"},
      {"set", "servo_id=3", "--csv"},
      {"get", "-i", "x:y"},
      {"get", "-i", "x", "--listen-only"},
      {"get", "-i", "x", "-n", "x"},
      {"get", "-i", "x", "--group", "x"},
      {"get", "-i", "x", "torqe_output"},
      {"get", "-i", "x", "0x10"},
      {"get", "-i", "x", "0x03"},
      {"get", "-i", "x", "--profile", "x"},
      {"set", "-i", "x", "0x49=1"},
      {"set", "-i", "x", "0x12=1"},
      {"set", "-i", "x", "current_angle=1deg"},
      {"set", "-i", "x", "angle_limit_cw=90"},
      {"set", "-i", "x", "angle_limit_cw=x"},
      {"set", "-i", "x", "angle_limit_cw=90.05deg"},
      {"set", "-i", "x", "angle_limit_cw=90rpm"},
      {"set", "-i", "x", "angle_limit_cw=-1deg"},
      {"set", "-i", "x", "torque_output=x"},
      {"set", "-i", "x", "torque_output=7"},
      {"set", "-i", "x", "servo_id"},
      {"set", "-i", "x", "servo_id=1", "servo_id=2"},
      {"set", "-i", "x", "static_node_id=127"},
      {"set", "-i", "x", "pwm_mode=speed", "pwm_output_range=1deg"},
      {"scan"},
      {"scan", "-i", "can_does_not_exist"},
      {"scan", "-i", "sim:" + bad},
      {"sim", "-i", "sim:x.json"},
      {"models", "x"},
  };
  for (Arguments line : lines) {
    line.insert(line.end(), {"--lang", "ja"});
    const Result result = bench.run(line);
    INFO(result.err);
    CHECK(result.status != 0);
    CHECK(is_fit_for_a_terminal(result.err));
    CHECK(std::ranges::any_of(result.err, [](char c) { return (c & 0x80) != 0; }));
    CHECK_FALSE(has_english(without_commands(result.err)));
  }
}

TEST_CASE("what servos and the bus make blactl say is said in Japanese too") {
  const Scene scene =
      three_servos()
          .servo("BLA21-12U-AB", 14, {{"faults", {{"mute", true}}}})
          .servo("BLA21-12U-AB", 15, {{"model_number", 99}})
          .servo("BLA21-12U-AB", 16, {{"hardware_version", 59050}})
          .servo("BLA21-12U-AB", 17, {{"firmware_version", 1010}})
          .servo("BLA15-06U-A0", 18, {{"model_number", 61}, {"hardware_version", 12050}})
          .servo("BLA21-12U-AB", 19, {{"serial_number", 1}})
          .servo("BLA21-12U-AB", 19, {{"serial_number", 2}})
          .servo("BLA21-12U-AB", 0, {{"servo_id", 30}})
          .foreign(40, {{"name", "node"}, {"commands", {{"servo_ids", {1}}}}});
  const std::vector<Arguments> lines{
      {"scan"},
      {"scan", "--expect", "99"},
      {"get", "-n", "11"},
      {"get", "-n", "11", "--changed", "--group", "pwm"},
      {"get", "-n", "14"},
      {"get", "-n", "40"},
      {"get", "-n", "55"},
      {"get", "-n", "servo:99"},
      {"get", "-n", "17", "angle_boost"},
      {"get", "-n", "11", "--profile", "BLA34-28U-AB"},
      {"set", "smoothing=off"},
      {"set", "-n", "11", "torque_output=off"},
      {"set", "-n", "11", "torque_output=off", "-y"},
      {"set", "-n", "11", "static_node_id=12"},
      {"set", "-n", "11", "pwm_output_range=1rpm"},
      {"set", "-n", "12", "pwm_neutral=1500us"},
      {"set", "-n", "12", "smoothing=off"},
      {"set", "-n", "15", "smoothing=off"},
      {"set", "-n", "16", "voltage_limit_high=20V"},
      {"set", "-n", "17", "angle_boost=1%"},
      {"set", "-n", "18", "overcurrent_limit=6.5A"},
      {"set", "-n", "19", "smoothing=off"},
  };
  const Bench bench;
  for (Arguments line : lines) {
    line.insert(line.end(), {"--lang", "ja"});
    const Result result = scene.run(bench, line);
    const std::string said = result.out + result.err;
    INFO(said);
    CHECK(is_fit_for_a_terminal(said));
    CHECK(std::ranges::any_of(said, [](char c) { return (c & 0x80) != 0; }));
    CHECK_FALSE(has_english(without_commands(said)));
  }
}

TEST_CASE("what becomes of servos that save, restart and are erased is said in Japanese too") {
  const auto fault = [](const char* name, const nlohmann::json& value) {
    return nlohmann::json{{"faults", {{name, value}}}};
  };
  const Scene scene =
      Scene()
          .servo("BLA21-12U-AB", 11)
          .servo("BLA21-12U-AB", 12, fault("refuse_opcodes", true))
          .servo("BLA21-12U-AB", 13, fault("stays", true))
          .servo("BLA21-12U-AB", 14, fault("never_returns", true))
          .servo("BLA21-12U-AB", 15, fault("ignore_opcodes", 9))
          .servo("BLA21-12U-AB", 16, fault("rom_write_fails", true))
          .servo("BLA21-12U-AB", 17, fault("mute", true))
          .servo("BLA21-12U-AB", 18, {{"servo_id", 4}})
          .servo("BLA21-12U-AB", 20,
                 {{"faults", {{"lose_opcode_answers", 1}, {"never_returns", true}}}})
          .servo("BLA21-12U-AB", 21, {{"model_number", 99}})
          .servo("BLA21-12U-AB", 22, {{"rom", {{"soft_start", "off"}}}})
          .foreign(40, {{"commands", {{"servo_ids", {4}}}}});
  const Scene armed = Scene().servo("BLA21-12U-AB", 11).foreign(40, {{"armed", true}});
  std::vector<Arguments> lines{{"wait", "-n", "11"},
                               {"wait", "-n", "44", "--wait", "1"},
                               {"wait", "-n", "17", "--wait", "1"},
                               {"save", "-y"},
                               {"save", "-n", "18,11", "-y"},
                               {"set", "-n", "16", "angle_limit_cw=90deg", "--save", "-y"},
                               {"set", "-n", "11", "static_node_id=30", "--save", "-y"},
                               {"erase", "-n", "11", "--save", "-y"},
                               {"erase", "-n", "11", "--keep-ids", "-y"},
                               {"erase", "-n", "11", "--keep-ids", "--save"},
                               {"erase", "-n", "11", "--save"},
                               {"save", "-n", "11", "--stagger", "x"},
                               {"restart", "-n", "11", "--wait", "x"}};
  for (const char* command : {"save", "restart", "erase"}) {
    for (const char* id :
         {"11", "12", "13", "14", "15", "17", "18", "20", "21", "22", "40", "44"}) {
      lines.push_back({command, "-n", id, "-y"});
    }
    lines.push_back({command, "-n", "11"});
    lines.push_back({command, "-n", "22"});
    lines.push_back({command, "-n", "11,14,12", "-y"});
  }
  const Bench bench;
  for (Arguments line : lines) {
    line.insert(line.end(), {"--lang", "ja"});
    for (const Scene* each : {&scene, &armed}) {
      const Result result = each->run(bench, line);
      const std::string said = result.out + result.err;
      INFO(said);
      CHECK(is_fit_for_a_terminal(said));
      CHECK(std::ranges::any_of(said, [](char c) { return (c & 0x80) != 0; }));
      CHECK_FALSE(has_english(without_commands(said)));
    }
  }
}

TEST_CASE("questions and conflicts are put in Japanese too") {
  const Bench bench;
  const Arguments japanese{"-i", "sim:", "--lang", "ja", "--color", "never"};
  const Background sim(bench, {"sim", "--lang", "ja"});
  const Arguments asking = with(japanese, {"set", "-n", "11", "torque_output=off"});
  Background first(bench, with(japanese, {"scan", "--listen", "15"}), {}, "");
  Background second(bench, asking, {.terminal = true}, "続けますか? [y/N] ");
  for (const Arguments& command : {Arguments{"get"}, {"--local-node-id", "11", "get"}}) {
    const Result result = bench.run(with(japanese, command));
    CHECK(result.status == 9);
    CHECK_FALSE(has_english(without_commands(result.err)));
  }
  const Result busy = bench.run({"sim", "--lang", "ja"});
  CHECK(busy.status == 9);
  CHECK_FALSE(has_english(without_commands(busy.err)));
  for (Background* asked : {&first, &second}) {
    const Result ended = asked->stop(SIGTERM);
    CHECK(ended.status == 143);
    CHECK(contains(ended.err, "[interrupted] SIGTERM により中断されました"));
    CHECK_FALSE(has_english(without_commands(ended.err)));
  }
}

TEST_CASE("the language changes what people read, never what scripts do") {
  const Bench bench;
  const Arguments get{"get", "-n", "11,55", "torque_output", "command_angle", "-j"};
  auto english = json(three_servos().run(bench, get).out);
  auto japanese = json(three_servos().run(bench, with(get, {"--lang", "ja"})).out);
  CHECK(japanese["errors"][0]["message"] != english["errors"][0]["message"]);
  CHECK(japanese["nodes"][0]["params"][0]["text"] == "on");
  for (auto* document : {&english, &japanese}) {
    for (auto& error : (*document)["errors"]) {
      error.erase("message");
      error.erase("hint");
    }
  }
  CHECK(japanese == english);
}

TEST_CASE("the language comes from the locale unless --lang names one") {
  const auto said = [](const Arguments& more, const std::string& name, const std::string& value) {
    return run(with({"scna"}, more), {.env = {{"LC_ALL", std::nullopt}, {name, value}}}).err;
  };
  CHECK(contains(said({}, "LANG", "ja_JP.UTF-8"), "コマンド 'scna' はありません"));
  CHECK(contains(said({}, "LC_MESSAGES", "ja_JP.UTF-8"), "コマンド 'scna' はありません"));
  CHECK(contains(said({}, "LANG", "de_DE.UTF-8"), "there is no command 'scna'"));
  CHECK(contains(said({"--lang", "en"}, "LANG", "ja_JP.UTF-8"), "there is no command 'scna'"));
  CHECK(contains(said({"--lang=ja"}, "LANG", "C"), "コマンド 'scna' はありません"));
}

TEST_CASE("what a foreign node is called never reaches the terminal raw") {
  const Bench bench;
  const Background sim(bench, {"sim"});
  blactl::sim::ForeignSetup setup;
  setup.node_id = 40;
  setup.name = std::string("\x1b]0;owned\x07\x1b[31m\xff\xc0\xaf\xe2\x80\xae\xc2\x9b\r\n\0x", 27);
  const Guest guest(bench, setup);
  for (const Arguments& command : {Arguments{"scan"},
                                   {"scan", "-j"},
                                   {"scan", "--csv"},
                                   {"get", "-n", "40"},
                                   {"get", "-n", "40", "-j"}}) {
    const Result result = bench.run(with({"-i", "sim:"}, command));
    const std::string all = result.out + result.err;
    INFO(all);
    CHECK(contains(all, "owned"));
    CHECK(is_fit_for_a_terminal(all));
    CHECK_FALSE(contains(all, "\xe2\x80\xae")); // reverses what follows
    CHECK_FALSE(contains(all, "\xc2\x9b"));     // CSI in one character
  }
}

TEST_CASE("what is typed never comes back raw") {
  const std::string evil = "\x1b[31m\xff\n";
  const Bench bench;
  for (const Arguments& line : std::vector<Arguments>{
           {evil},
           {"get", evil},
           {"get", "--" + evil},
           {"get", "-n", evil},
           {"get", "-n", "serial:" + evil},
           {"get", "-i", evil},
           {"get", "-i", "sim:" + evil},
           {"get", "-i", "sim:" + evil + ".json"},
           {"get", "-i", evil + ":"},
           {"get", "--group", evil},
           {"get", "--profile", evil},
           {"get", "--profile-dir", evil},
           {"get", "--timeout", evil},
           {"get", "--lang", evil},
           {"set", evil},
           {"set", evil + "=1"},
           {"set", "servo_id=" + evil},
           {"set", "torque_output=" + evil},
           {"models", evil},
           {"models", "BLA21", evil},
           {"sim", evil},
           {"sim", "--clock", evil},
           {"-i", "sim:/dev/null/" + evil, "sim"},
       }) {
    const Result text = bench.run(line);
    INFO(text.err);
    CHECK(text.status != 0);
    CHECK(is_fit_for_a_terminal(text.err));
    const Result document = bench.run(with({"-j"}, line));
    CHECK(is_fit_for_a_terminal(document.out));
    CHECK_NOTHROW(json(document.out));
  }
}

TEST_CASE("a closed standard output is a failure, and nothing is printed into another descriptor") {
  const Bench bench;
  const Background simulator(bench, {"sim"});
  const Result result = bench.run({"-i", "sim:", "get", "-n", "11"}, {.close_stdout = true});
  CHECK(result.status == 1);
  CHECK(codes(result) == std::vector<std::string>{"io"});
}
