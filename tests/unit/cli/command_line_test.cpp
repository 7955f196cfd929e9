#include "catch.hpp"
#include "cli/command_line.hpp"
#include "cli/help.hpp"

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
  INFO((invocation ? "" : invocation.error().front().message));
  REQUIRE(invocation);
  return std::move(*invocation);
}

std::vector<Error> all_refused(const Arguments& arguments) {
  const auto invocation = parse(arguments);
  std::string line;
  for (const auto& argument : arguments) {
    line += argument + ' ';
  }
  INFO(line);
  REQUIRE_FALSE(invocation);
  for (const Error& error : invocation.error()) {
    CHECK(error.code == Code::usage);
    CHECK_FALSE(error.hint.empty());
  }
  return invocation.error();
}

Error refused(const Arguments& arguments) {
  const auto errors = all_refused(arguments);
  REQUIRE(errors.size() == 1);
  return errors.front();
}

// A command with an option of each kind, to see what arrives in its struct.
struct Inner {
  Duration pause{};
};

struct Sample {
  bool flag = false;
  Duration time = 3s;
  std::optional<Duration> maybe_time{};
  std::optional<std::uint64_t> number{};
  std::uint64_t word = 7;
  std::string text{};
  std::vector<std::string> groups{};
  std::optional<std::string> kinds{};
  Inner inner{};
  std::vector<std::string> items{};
};

constexpr std::string_view words[]{"red", "green"};

constexpr Option option_table[]{
    {.name = "--flag", .kind = Kind::flag, .help = {"", ""}, .store = into<&Sample::flag>},
    {.name = "--time",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {1ms, 1h},
     .help = {"", ""},
     .store = into<&Sample::time>},
    {.name = "--maybe-time",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {1ms, 1h},
     .help = {"", ""},
     .store = into<&Sample::maybe_time>},
    {.name = "--number",
     .value = "N",
     .kind = Kind::whole,
     .whole = {2, ~std::uint64_t{0}},
     .help = {"", ""},
     .store = into<&Sample::number>},
    {.name = "--word",
     .value = "W",
     .kind = Kind::word,
     .words = words,
     .help = {"", ""},
     .store = into<&Sample::word>},
    {.name = "--text",
     .value = "T",
     .kind = Kind::text,
     .help = {"", ""},
     .store = into<&Sample::text>},
    {.name = "--group",
     .value = "G",
     .kind = Kind::group,
     .repeat = Repeat::list,
     .help = {"", ""},
     .store = into<&Sample::groups>},
    {.name = "--kind",
     .value = "K",
     .kind = Kind::words,
     .repeat = Repeat::list,
     .words = words,
     .help = {"", ""},
     .store = into<&Sample::kinds>},
    {.name = "--pause",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {0s, 1h},
     .help = {"", ""},
     .store = into<&Sample::inner, &Inner::pause>},
};

constexpr Option argument_table[]{
    {.name = "ITEM",
     .kind = Kind::parameter,
     .repeat = Repeat::list,
     .required = true,
     .help = {"", ""},
     .store = into<&Sample::items>},
};

Report nothing(const Sample& /*options*/, Context& /*context*/) {
  return {};
}

constinit const Command sample_command{.name = "sample",
                                       .help = {"", ""},
                                       .options = option_table,
                                       .arguments = argument_table,
                                       .action = action<Sample, nothing>};

/// What `sample` gets from these arguments.
std::expected<Sample, std::vector<Error>> sample(Arguments arguments) {
  arguments.insert(arguments.begin(), "sample");
  const Command* const commands[]{&sample_command};
  const auto invocation = parse(arguments, commands);
  if (!invocation) {
    return std::unexpected(invocation.error());
  }
  return *static_cast<const Sample*>(invocation->options.get());
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
  CHECK(scan.command == &commands::scan);
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
    CHECK(get.command == &commands::get);
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

TEST_CASE("options and arguments arrive in the struct of their command") {
  const auto plain = sample({"a"});
  REQUIRE(plain);
  CHECK_FALSE(plain->flag);
  CHECK(plain->time == 3s);
  CHECK_FALSE(plain->maybe_time);
  CHECK_FALSE(plain->number);
  CHECK(plain->word == 7);
  CHECK(plain->items == Arguments{"a"});
  const auto full = sample({"--flag", "--time", "0.25", "--maybe-time=2", "a=-90deg", "--number",
                            "18446744073709551615", "--word", "green", "--text", "set", "--group",
                            "pwm", "scan", "--kind", "red", "--pause", "1.5"});
  REQUIRE(full);
  CHECK(full->flag);
  CHECK(full->time == 250ms);
  CHECK(full->maybe_time == 2s);
  CHECK(full->number == 18446744073709551615U);
  CHECK(full->word == 1);
  CHECK(full->text == "set");
  CHECK(full->groups == Arguments{"pwm"});
  CHECK(full->kinds == "red");
  CHECK(full->inner.pause == 1500ms);
  CHECK(full->items == Arguments{"a=-90deg", "scan"});
}

TEST_CASE("of an option given twice the last one holds, and lists add up") {
  const auto twice = sample({"--time", "1",      "--word", "red",   "--group", "pwm",      "a",
                             "--time", "2",      "--word", "green", "--group", "limit",    "b",
                             "--flag", "--flag", "--kind", "red",   "--kind",  "green,red"});
  REQUIRE(twice);
  CHECK(twice->time == 2s);
  CHECK(twice->word == 1);
  CHECK(twice->groups == Arguments{"pwm", "limit"});
  CHECK(twice->items == Arguments{"a", "b"});
  CHECK(twice->kinds == "red,green,red");
  CHECK(twice->flag);
  const Shared shared =
      parsed({"-i", "can0", "-n", "11", "scan", "-n", "12,20", "-i", "can1"}).shared;
  CHECK(shared.interface == "can1");
  CHECK(shared.nodes == "11,12,20");
}

TEST_CASE("all faults of a command line come at once") {
  const auto faults = sample({"--frob", "5", "--time", "x", "--number", "1", "--word", "grean",
                              "--kind", "red,blue", "--group", "g", "--group", "h", "-n", "0",
                              "--node=", "--flag=no", "--text"});
  REQUIRE_FALSE(faults);
  std::string messages;
  for (const Error& fault : faults.error()) {
    CHECK(fault.code == Code::usage);
    CHECK_FALSE(fault.hint.empty());
    messages += fault.message + '\n';
  }
  CHECK(messages == "--node: the value is empty\n"
                    "--text needs a value\n"
                    "unknown option: --frob\n"
                    "-n 0: node IDs are 1 to 127\n"
                    "--flag takes no value\n"
                    "--time x: not a number of seconds between 0.001 and 3600\n"
                    "--number 1: not a whole number between 2 and 18446744073709551615\n"
                    "--word grean: not one of red, green\n"
                    "there is no group 'g'\n"
                    "there is no group 'h'\n"
                    "--kind blue: not one of red, green\n"
                    "sample does not contact servos: it takes no --node\n");
  CHECK(all_refused({"set", "--csv", "--json", "--record", "-"}).size() == 4);
  // An unknown command may have meant the options of any.
  CHECK(all_refused({"scna", "--expect", "x", "--timeout", "x", "-n", "", "--frob"}).size() == 4);
}

TEST_CASE("a mistyped option or word is answered with the nearest one") {
  CHECK(contains(refused({"get", "--chnged"}).hint, "--changed"));
  CHECK(contains(refused({"get", "--lisen-only=1"}).hint, "--listen-only"));
  CHECK(contains(refused({"scan", "--color", "alwys"}).hint, "always"));
  CHECK(contains(refused({"get", "--frobnicate"}).hint, "blactl get --help"));
  CHECK(contains(refused({"scan", "--dump-clo"}).hint, "blactl scan --help")); // it is hidden
}

TEST_CASE("what follows an unknown option is taken for its value") {
  CHECK(contains(refused({"scan", "--fast", "3"}).message, "--fast"));
  CHECK(all_refused({"scan", "--fast", "--listen", "3", "3"}).size() == 2);
  CHECK(all_refused({"scan", "one", "two"}).size() == 2);
}

TEST_CASE("every command of the table is sound") {
  std::vector<std::span<const Option>> tables{shared_options()};
  for (const Command* command : all_commands()) {
    CHECK(find_command(command->name) == command);
    tables.push_back(command->options);
    tables.push_back(command->arguments);
  }
  for (const auto& table : tables) {
    for (const Option& option : table) {
      CAPTURE(option.name);
      const bool fits = [&] {
        switch (option.kind) {
        case Kind::flag:
          return option.store.takes == Takes::flag || option.store.takes == Takes::number;
        case Kind::seconds: return option.store.takes == Takes::duration;
        case Kind::whole:
        case Kind::word: return option.store.takes == Takes::number;
        default: return option.store.takes == Takes::text || option.store.takes == Takes::list;
        }
      }();
      CHECK(fits);
      CHECK(option.store.put != nullptr);
      CHECK(option.value.empty() == (option.kind == Kind::flag || option.name[0] != '-'));
      const bool has_words = option.kind == Kind::word || option.kind == Kind::words ||
                             option.kind == Kind::beginning || option.kind == Kind::suggested;
      CHECK(option.words.empty() != has_words);
      CHECK((option.kind != Kind::seconds || option.seconds.min < option.seconds.max));
      CHECK((option.kind != Kind::whole || option.whole.min < option.whole.max));
      CHECK_FALSE(std::string_view(option.help.en).empty());
      CHECK_FALSE(std::string_view(option.help.ja).empty());
    }
  }
  CHECK(find_command("gte") == nullptr);
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
  CHECK(parsed({"--record", "set", "get"}).command == &commands::get);
  CHECK(parsed({"--profile=set", "get"}).command == &commands::get);
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
  refused({"sim", "a", "b"});
  refused({"get", "--expect", "1"}); // of another command
}

TEST_CASE("one format at a time, and CSV only where there are tables") {
  CHECK(parsed({"get", "--json"}).shared.output.format == Format::json);
  CHECK(parsed({"-j", "get"}).shared.output.format == Format::json);
  CHECK(parsed({"get", "--csv"}).shared.output.format == Format::csv);
  CHECK(parsed({"scan", "--csv"}).shared.output.format == Format::csv);
  refused({"get", "--csv", "--json"});
  CHECK(contains(refused({"set", "--csv", "a=1"}).message, "set"));
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

TEST_CASE("help is asked for, whatever else is wrong or missing") {
  CHECK(parsed({"--help"}).shared.help);
  CHECK(parsed({"--help"}).command == nullptr);
  CHECK(parsed({"scan", "--help", "--frob", "-n"}).command == &commands::scan);
  CHECK(parsed({"set", "-h"}).shared.help);
  CHECK(parsed({"set", "-V"}).shared.version);
  CHECK(parsed({"--dump-cli"}).shared.dump_cli);
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
  CHECK(peek_command(Arguments{"-i", "scan", "get", "--fast"}) == &commands::get);
  CHECK(peek_command(Arguments{"--timeout", "x", "set"}) == &commands::set);
  CHECK(peek_command(Arguments{"gte"}) == nullptr);
  CHECK(peek_command(Arguments{}) == nullptr);
  CHECK(peek_command(Arguments{"-jn", "get"}) == nullptr); // the value of -n
}

TEST_CASE("the language is that of --lang, else of the locale") {
  const Variable all("LC_ALL", "");
  const Variable messages("LC_MESSAGES", "");
  const Variable lang("LANG", "ja_JP.UTF-8");
  CHECK(peek_language(Arguments{"scan"}) == Language::japanese);
  CHECK(peek_language(Arguments{"scan", "--lang", "en"}) == Language::english);
  CHECK(peek_language(Arguments{"--lang=ja"}) == Language::japanese);
  CHECK(peek_language(Arguments{"--lang=ja", "--lang", "en"}) == Language::english);
  CHECK(peek_language(Arguments{"--lang"}) == Language::japanese);
  const Variable other("LC_MESSAGES", "de_DE.UTF-8");
  CHECK(peek_language(Arguments{"scan"}) == Language::english);
  const Variable strongest("LC_ALL", "ja_JP");
  CHECK(peek_language(Arguments{"scan"}) == Language::japanese);
}
