#include "catch.hpp"
#include "cli/options.hpp"

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::cli;
using namespace std::chrono_literals;

using Arguments = std::vector<std::string>;

namespace {

Invocation parsed(const Arguments& arguments) {
  auto invocation = parse(arguments);
  INFO((invocation ? "" : invocation.error().message));
  REQUIRE(invocation);
  return std::move(*invocation);
}

template <class Options> Options options(const Arguments& arguments) {
  const Invocation invocation = parsed(arguments);
  REQUIRE(std::holds_alternative<Options>(invocation.command));
  return std::get<Options>(invocation.command);
}

Error refused(const Arguments& arguments) {
  const auto invocation = parse(arguments);
  std::string line;
  for (const auto& argument : arguments) {
    line += argument + ' ';
  }
  INFO(line);
  REQUIRE_FALSE(invocation);
  CHECK(invocation.error().code == Code::usage);
  CHECK_FALSE(invocation.error().hint.empty());
  return invocation.error();
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

/// An environment variable for the time of a test; empty: unset.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) {
      before_ = before;
    }
    value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
  }

  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

} // namespace

TEST_CASE("a command alone has the defaults") {
  const Variable interface("BLACTL_INTERFACE", "");
  const Variable profiles("BLACTL_PROFILE_DIR", "");
  const Invocation scan = parsed({"scan"});
  CHECK(scan.name == "scan");
  CHECK(std::get<ScanOptions>(scan.command).listen == 1200ms);
  CHECK_FALSE(std::get<ScanOptions>(scan.command).expect);
  const Shared& shared = scan.shared;
  CHECK(shared.interface.empty());
  CHECK_FALSE(shared.nodes);
  CHECK_FALSE(shared.local_node_id);
  CHECK_FALSE(shared.listen_only);
  CHECK_FALSE(shared.yes);
  CHECK_FALSE(shared.while_driven);
  CHECK(shared.patience.timeout == 500ms);
  CHECK(shared.patience.retries == 2);
  CHECK_FALSE(shared.profile);
  CHECK_FALSE(shared.profile_dir);
  CHECK_FALSE(shared.record);
  CHECK(shared.output.format == Format::text);
  CHECK(shared.output.colour == Colour::automatic);
}

TEST_CASE("shared options stand before and after the command") {
  const Arguments shared{"-i",
                         "can0",
                         "-n",
                         "10-12",
                         "--local-node-id",
                         "50",
                         "--timeout",
                         "0.25",
                         "-y",
                         "-q",
                         "--retries",
                         "0",
                         "--color",
                         "never",
                         "--while-driven",
                         "--profile",
                         "BLA21-12U-AB",
                         "--profile-dir",
                         "/p",
                         "--record",
                         "x.log",
                         "--listen-only"};
  Arguments before = shared;
  before.insert(before.end(), {"get", "reverse"});
  Arguments after{"get", "reverse"};
  after.insert(after.end(), shared.begin(), shared.end());
  for (const Arguments& arguments : {before, after}) {
    const Invocation get = parsed(arguments);
    CHECK(std::get<GetOptions>(get.command).parameters == Arguments{"reverse"});
    CHECK(get.shared.interface == "can0");
    CHECK(get.shared.nodes == "10-12");
    CHECK(get.shared.local_node_id == 50);
    CHECK(get.shared.patience.timeout == 250ms);
    CHECK(get.shared.patience.retries == 0);
    CHECK(get.shared.yes);
    CHECK(get.shared.output.quiet);
    CHECK(get.shared.output.colour == Colour::never);
    CHECK(get.shared.while_driven);
    CHECK(get.shared.profile == "BLA21-12U-AB");
    CHECK(get.shared.profile_dir == "/p");
    CHECK(get.shared.record == "x.log");
    CHECK(get.shared.listen_only);
  }
}

TEST_CASE("the environment names interface and profiles where no option does") {
  const Variable interface("BLACTL_INTERFACE", "can7");
  const Variable profiles("BLACTL_PROFILE_DIR", "/profiles");
  CHECK(parsed({"scan"}).shared.interface == "can7");
  CHECK(parsed({"scan"}).shared.profile_dir == "/profiles");
  CHECK(parsed({"scan", "-i", "can1"}).shared.interface == "can1");
  CHECK(parsed({"scan", "--profile-dir", "/p"}).shared.profile_dir == "/p");
}

TEST_CASE("the options of each command") {
  const auto scan = options<ScanOptions>({"scan", "--listen", "3.5", "--expect", "12"});
  CHECK(scan.listen == 3500ms);
  CHECK(scan.expect == 12);
  const auto get =
      options<GetOptions>({"get", "--group", "pwm", "0x38", "--changed", "--group", "limit"});
  CHECK(get.parameters == Arguments{"0x38"});
  CHECK(get.groups == Arguments{"pwm", "limit"});
  CHECK(get.changed);
  CHECK_FALSE(get.all);
  const auto set = options<SetOptions>({"set", "0x38=-90deg", "reverse=on", "--dry-run"});
  CHECK(set.assignments == Arguments{"0x38=-90deg", "reverse=on"});
  CHECK(set.dry_run);
  const auto models = options<ModelsOptions>({"models", "BLA21-12U-AB", "reverse"});
  CHECK(models.model == "BLA21-12U-AB");
  CHECK(models.parameter == "reverse");
  const auto sim = options<SimOptions>(
      {"sim", "a.json", "--seed", "18446744073709551615", "--clock", "virtual"});
  CHECK(sim.scenario == "a.json");
  CHECK(sim.seed == 18446744073709551615U);
  CHECK(sim.clock == "virtual");
}

TEST_CASE("a parameter may be called like a command") {
  CHECK(options<GetOptions>({"get", "scan"}).parameters == Arguments{"scan"});
}

TEST_CASE("a mistyped command is answered with the nearest one") {
  const Error error = refused({"gte", "reverse"});
  CHECK(contains(error.message, "gte"));
  CHECK(contains(error.hint, "get"));
  CHECK(contains(refused({"-i", "can0", "--timeout", "1", "scna"}).hint, "scan"));
  CHECK(contains(refused({"frobnicate"}).hint, "--help"));
  CHECK_FALSE(contains(refused({"\x1b[2J"}).message, "\x1b"));
}

TEST_CASE("a value of an option is not taken for the command") {
  CHECK(parsed({"-n", "set", "get"}).name == "get");
  CHECK(parsed({"--profile=set", "get"}).name == "get");
  CHECK(parsed({"-n12", "get"}).shared.nodes == "12");
}

TEST_CASE("no command at all is refused") {
  refused({});
  refused({"-i", "can0"});
  refused({"--json"});
}

TEST_CASE("numbers are digits and nothing else") {
  for (const char* bad : {"nan", "inf", "1e3", "-1", "+1", "0x10", " 1", "1 ", "1,5", "", ".5",
                          "1.", "1..5", "1.1234567", "0", "0.0001", "61", "99999999", "abc"}) {
    refused({"scan", "--timeout", bad});
  }
  for (const char* bad :
       {"nan", "1e1", "-1", "+1", "0x1", " 1", "1.0", "", "101", "99999999999999999999"}) {
    refused({"scan", "--retries", bad});
  }
  for (const char* bad : {"0", "128", "256", "383", "-1", "1.5", "nan", ""}) {
    refused({"scan", "--local-node-id", bad});
  }
  refused({"scan", "--expect", "128"});
  refused({"scan", "--listen", "3601"});
  refused({"sim", "--seed", "18446744073709551616"});
  CHECK(parsed({"scan", "--timeout", "0.001"}).shared.patience.timeout == 1ms);
  CHECK(parsed({"scan", "--timeout", "60.000000"}).shared.patience.timeout == 60s);
  CHECK(parsed({"scan", "--local-node-id", "127"}).shared.local_node_id == 127);
}

TEST_CASE("an empty value is refused: an unset variable must not mean every servo") {
  for (const char* option : {"-i", "--interface", "-n", "--node", "--local-node-id", "--color",
                             "--lang", "--timeout", "--retries", "--profile-dir", "--profile"}) {
    refused({"get", option, ""});
    refused({option, "", "get"});
  }
  refused({"get", "--node="});
  refused({"scan", "--expect", ""});
  refused({"scan", "--listen", ""});
  refused({"sim", "--seed", ""});
}

TEST_CASE("words are of a list") {
  CHECK(contains(refused({"scan", "--color", "blue"}).message, "always"));
  CHECK(contains(refused({"scan", "--lang", "de"}).message, "ja"));
  CHECK(contains(refused({"sim", "--clock", "slow"}).message, "virtual"));
  CHECK(parsed({"scan", "--color", "always"}).shared.output.colour == Colour::always);
}

TEST_CASE("what is not understood is refused") {
  refused({"scan", "--fast"});
  refused({"scan", "extra"});
  refused({"get", "-n"});
  refused({"set"});
  refused({"models", "a", "b", "c"});
  refused({"scan", "-n", "1", "-n", "2"});
  refused({"get", "--expect", "1"}); // of another command
}

TEST_CASE("one format at a time, and CSV only where there are tables") {
  CHECK(parsed({"get", "--json"}).shared.output.format == Format::json);
  CHECK(parsed({"-j", "get"}).shared.output.format == Format::json);
  CHECK(parsed({"get", "--csv"}).shared.output.format == Format::csv);
  CHECK(parsed({"scan", "--csv"}).shared.output.format == Format::csv);
  refused({"get", "--csv", "--json"});
  refused({"set", "--csv", "a=1"});
  refused({"models", "--csv"});
}

TEST_CASE("only a session is recorded, and only to a file") {
  CHECK(contains(refused({"get", "--record", "-"}).message, "standard output"));
  CHECK(contains(refused({"models", "--record", "x.log"}).message, "models"));
  CHECK(contains(refused({"sim", "--record", "x.log"}).message, "sim"));
  refused({"get", "--record", ""});
}

TEST_CASE("verbosity counts") {
  CHECK(parsed({"scan"}).shared.output.verbosity == 0);
  CHECK(parsed({"scan", "-vv"}).shared.output.verbosity == 2);
}

TEST_CASE("help names the options, whatever else is wrong or missing") {
  CHECK(contains(parsed({"--help"}).help_text, "--while-driven"));
  CHECK(contains(parsed({"scan", "--help"}).help_text, "--expect"));
  CHECK(contains(parsed({"set", "-h"}).help_text, "--dry-run"));
}

TEST_CASE("--json is seen before anything is understood") {
  const auto is_json = [](const Arguments& arguments) {
    return peek(arguments).output.format == Format::json;
  };
  CHECK(is_json({"gte", "--json"}));
  CHECK(is_json({"-j", "gte"}));
  CHECK(is_json({"-qj"}));
  CHECK(is_json({"-jn", "12"}));
  CHECK(is_json({"-vjy"}));
  CHECK_FALSE(is_json({"-nj"})); // a node called j
  CHECK_FALSE(is_json({"get"}));
  CHECK_FALSE(is_json({"--jso"}));
  CHECK_FALSE(is_json({"-"}));
  CHECK_FALSE(is_json({""}));
  CHECK_FALSE(is_json({"json", "j"}));
}

TEST_CASE("the command is seen before anything is understood") {
  CHECK(peek_command(Arguments{"-i", "scan", "get", "--fast"}) == "get");
  CHECK(peek_command(Arguments{"--timeout", "x", "set"}) == "set");
  CHECK(peek_command(Arguments{"gte"}).empty());
  CHECK(peek_command(Arguments{}).empty());
  CHECK(peek_command(Arguments{"-jn", "get"}).empty()); // the value of -n
}

TEST_CASE("the language is that of --lang, else of the locale") {
  const Variable all("LC_ALL", "");
  const Variable messages("LC_MESSAGES", "");
  const Variable lang("LANG", "ja_JP.UTF-8");
  CHECK(peek_language(Arguments{"scan"}) == Language::japanese);
  CHECK(peek_language(Arguments{"scan", "--lang", "en"}) == Language::english);
  CHECK(peek_language(Arguments{"--lang=ja"}) == Language::japanese);
  CHECK(peek_language(Arguments{"--lang"}) == Language::japanese);
  const Variable other("LC_MESSAGES", "de_DE.UTF-8");
  CHECK(peek_language(Arguments{"scan"}) == Language::english);
  const Variable strongest("LC_ALL", "ja_JP");
  CHECK(peek_language(Arguments{"scan"}) == Language::japanese);
}
