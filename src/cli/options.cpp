#include "cli/options.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"

#include "cli/option_values.hpp"
#include "cli/texts.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

constexpr std::array<std::string_view, 10> commands{"scan",    "get",  "set",   "save",   "erase",
                                                    "restart", "wait", "trace", "models", "sim"};

/// Those that print tables of values.
constexpr std::array<std::string_view, 2> with_csv{"scan", "get"};

constexpr std::array<std::string_view, 2> streams{"trace", "sim"};

/// Options that take the next argument as their value: what a mistyped command is told apart from.
constexpr std::array<std::string_view, 22> with_value{
    "--interface", "--node",        "--local-node-id", "--color",  "--lang",   "--timeout",
    "--retries",   "--profile-dir", "--profile",       "--listen", "--expect", "--group",
    "--wait",      "--stagger",     "--record",        "--type",   "--kind",   "--duration",
    "--count",     "--facts",       "--seed",          "--clock"};

std::optional<std::string> environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? std::optional<std::string>(value) : std::nullopt;
}

/// "--node" of the parser's "--node: 1 required LIST missing".
std::string option_of(const CLI::Error& error) {
  const std::string text = error.what();
  return printable(text.substr(0, text.find(':')));
}

/// The parser and the structs that it fills.
class Parser {
 public:
  Parser() {
    app_.name("blactl");
    app_.require_subcommand(0, 1);
    app_.set_version_flag("--version", "blactl " BLACTL_VERSION);
    app_.get_formatter()->column_width(34);
    app_.footer("Exit status: 0 done, 1 failure, 2 refused before any write, 3 interface, 4 no "
                "answer,\n5 the servo refused, 6 mixed, 7 not confirmed, 8 found something, 9 "
                "conflict.");
    add_shared();
    add_scan();
    add_get();
    add_set();
    add_save();
    add_erase();
    add_restart();
    add_wait();
    add_trace();
    add_models();
    add_sim();
    for (CLI::App* command : app_.get_subcommands({})) {
      command->fallthrough();
      command->footer("Shared options, before or after the command: see blactl --help.");
    }
  }

  Result<Invocation> parse(std::span<const std::string> arguments);

 private:
  void add_shared();
  void add_output();
  void add_scan();
  void add_get();
  void add_set();
  void add_save();
  void add_erase();
  void add_restart();
  void add_wait();
  void add_times(CLI::App& command, RestartTimes& times);
  void add_trace();
  void add_models();
  void add_sim();
  Result<Invocation> take();

  /// A command and where its options are kept until they are complete.
  template <class Options> std::pair<CLI::App&, Options&> add(const char* name, const char* help) {
    CLI::App* command = app_.add_subcommand(name, help);
    auto options = std::make_shared<Options>();
    taken_[command] = [options] { return CommandOptions(*options); };
    return {*command, *options};
  }

  std::unexpected<Error> refuse(std::string message) {
    const auto chosen = app_.get_subcommands();
    return blactl::fail(Code::usage, std::move(message),
                        chosen.empty() ? say<texts::see_help>()
                                       : say<texts::see_command_help>(chosen.front()->get_name()));
  }

  CLI::App app_{"Configures and diagnoses Futaba BLA servos over DroneCAN"};
  OptionValues values_;
  Invocation result_;
  std::map<const CLI::App*, std::function<CommandOptions()>> taken_;
  std::optional<std::string> interface_;
  Language language_{};
  bool json_ = false, csv_ = false;
};

void Parser::add_shared() {
  Shared& shared = result_.shared;
  values_.text(app_, "-i,--interface",
               "can0, slcan:DEV, mcast:N, sim:, sim:SCENARIO.json, replay:FILE", "IFACE",
               interface_);
  values_.text(app_, "-n,--node", "servos: 12, 10-14,20, all, uid:…, serial:…, servo:…, model:…",
               "LIST", shared.nodes);
  values_.whole(
      app_, "--local-node-id", "own node ID (default 127, else 126)", "ID",
      [&shared](std::uint64_t id) { shared.local_node_id = static_cast<std::uint8_t>(id); }, 1,
      dronecan::NodeId::max);
  app_.add_flag("--listen-only", shared.listen_only, "send nothing, take no node ID");
  add_output();
  app_.add_flag("-y,--yes", shared.yes, "agree to questions beforehand");
  values_.seconds(app_, "--timeout", "for one request (default 0.5)", shared.patience.timeout,
                  std::chrono::milliseconds(1), std::chrono::minutes(1));
  constexpr std::uint64_t most_retries = 100;
  values_.whole(
      app_, "--retries", "of one request (default 2)", "N",
      [&shared](std::uint64_t count) { shared.patience.retries = static_cast<int>(count); }, 0,
      most_retries);
  app_.add_flag("--while-driven", shared.while_driven, "although another node drives the servo");
  values_.text(app_, "--profile-dir", "further model profiles", "DIR", shared.profile_dir);
  values_.text(app_, "--profile", "read as this model where no profile fits", "MODEL",
               shared.profile);
  values_.text(app_, "--record", "write every frame to a candump log", "FILE", shared.record);
}

void Parser::add_output() {
  Reporter::Options& output = result_.shared.output;
  app_.add_flag("-j,--json", json_, "output as one JSON document");
  app_.add_flag("--csv", csv_, "output as CSV (scan, get)");
  app_.add_flag("-q,--quiet", output.quiet, "no notes on stderr");
  app_.add_flag("-v,--verbose", output.verbosity, "details on stderr");
  values_.word<Colour>(
      app_, "--color", "auto, always, never", "WHEN", output.colour,
      {{"auto", Colour::automatic}, {"always", Colour::always}, {"never", Colour::never}});
  // Spoken before the parser is built; here it is only checked.
  values_.word<Language>(app_, "--lang", "en, ja", "LANG", language_,
                         {{"en", Language::english}, {"ja", Language::japanese}});
}

void Parser::add_scan() {
  auto [command, options] = add<ScanOptions>("scan", "find every node and identify BLA servos");
  values_.seconds(command, "--listen", "how long (default 1.2)", options.listen,
                  std::chrono::milliseconds(1), std::chrono::hours(1));
  values_.whole(
      command, "--expect", "fail unless so many servos are found", "N",
      [&expect = options.expect](std::uint64_t count) { expect = count; }, 0,
      dronecan::NodeId::max);
}

void Parser::add_get() {
  auto [command, options] = add<GetOptions>("get", "read parameters");
  command.add_option("PARAM", options.parameters, "names or addresses: angle_limit_cw, 0x38")
      ->type_name("");
  command
      .add_option("--group", options.groups,
                  "all of a group: command status operation fault config "
                  "control pwm limit option product production")
      ->type_name("G")
      ->allow_extra_args(false); // what follows the group is a parameter
  command.add_flag("--all", options.all, "every parameter (as without PARAM)");
  command.add_flag("--changed", options.changed, "only what differs from the model's default");
}

void Parser::add_set() {
  auto [command, options] = add<SetOptions>("set", "check against the profile, write, read back");
  command.add_option("PARAM=VALUE", options.assignments, "angle_limit_cw=90deg, 0x38=900")
      ->type_name("")
      ->required();
  command.add_flag("--save", options.save, "then RAM to ROM: restarts the servo, and reads again");
  command.add_flag("--dry-run", options.dry_run, "change nothing; 8 when something would change");
  add_times(command, options.times);
}

void Parser::add_times(CLI::App& command, RestartTimes& times) {
  values_.seconds(command, "--wait",
                  "for a servo to come back (default 5, and 2 for each that asks for a node ID)",
                  times.wait, std::chrono::milliseconds(1), std::chrono::hours(1));
  values_.seconds(command, "--stagger", "between two servos (default 0)", times.stagger,
                  Duration::zero(), std::chrono::hours(1));
}

void Parser::add_save() {
  auto [command, options] =
      add<SaveOptions>("save", "RAM to ROM: restarts the servo, and reads again");
  add_times(command, options.times);
}

void Parser::add_erase() {
  auto [command, options] =
      add<EraseOptions>("erase", "RAM to factory defaults, IDs included (ROM only with --save)");
  command.add_flag("--save", options.save, "then RAM to ROM");
  command.add_flag("--keep-ids", options.keep_ids, "servo_id and static_node_id stay");
  add_times(command, options.times);
}

void Parser::add_restart() {
  auto [command, options] = add<RestartOptions>("restart", "restart: RAM from ROM");
  add_times(command, options.times);
}

void Parser::add_wait() {
  auto [command, options] = add<WaitOptions>("wait", "until the servos are there and operational");
  values_.seconds(command, "--wait", "how long (default 10)", options.wait,
                  std::chrono::milliseconds(1), std::chrono::hours(24));
}

void Parser::add_trace() {
  auto [command, options] = add<TraceOptions>(
      "trace", "every DroneCAN transfer decoded, live or from a candump log; sends nothing");
  command.add_option("FILE", options.file, "a log of candump -l, or - (default: the interface)")
      ->type_name("");
  values_.text(command, "--type", "only these data types: NodeStatus, param.GetSet, 341", "T",
               options.types);
  values_.text(command, "--kind", "only message, request, response", "K", options.kinds);
  values_.seconds(command, "--duration", "how long; of a log its first seconds", options.duration,
                  std::chrono::milliseconds(1), std::chrono::hours(24));
  values_.whole(
      command, "--count", "end after so many transfers", "N",
      [&most = options.count](std::uint64_t count) { most = count; }, 1, ~std::uint64_t{0});
  command.add_flag("--stats", options.stats,
                   "instead of the transfers, who sends what how often, and the load of the bus");
}

void Parser::add_models() {
  auto [command, options] =
      add<ModelsOptions>("models", "what the profiles know, without any servo");
  command.add_option("MODEL", options.model, "a model or its beginning: BLA21-12U")->type_name("");
  command.add_option("PARAM", options.parameter, "one parameter")->type_name("");
}

void Parser::add_sim() {
  auto [command, options] = add<SimOptions>(
      "sim", "simulated servos: serves the sim: bus, or joins a real interface with -i");
  command.add_option("SCENARIO", options.scenario, "scenario file (default: three servos)")
      ->type_name("");
  values_.text(command, "--facts", "how servos behave, as measured by characterize", "FILE",
               options.facts);
  values_.whole(
      command, "--seed", "of everything random", "N",
      [&seed = options.seed](std::uint64_t number) { seed = number; }, 0, ~std::uint64_t{0});
  values_.word<std::string>(command, "--clock", "real, virtual", "CLOCK", options.clock,
                            {{"real", "real"}, {"virtual", "virtual"}});
}

Result<Invocation> Parser::parse(std::span<const std::string> arguments) {
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  try {
    app_.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    result_.help_text = app_.help();
    return result_;
  } catch (const CLI::CallForVersion&) {
    result_.help_text = app_.version() + '\n';
    return result_;
  } catch (const CLI::ExtrasError&) {
    return refuse(say<texts::unexpected_argument>(printable(app_.remaining(true).front())));
  } catch (const CLI::RequiredError&) {
    return refuse(say<texts::assignment_missing>());
  } catch (const CLI::ArgumentMismatch& error) {
    return refuse(say<texts::takes_one_value>(option_of(error)));
  } catch (const CLI::ParseError& error) {
    return refuse(say<texts::not_understood>(printable(error.what())));
  }
  return take();
}

/// Checks what was given and completes it from the environment.
Result<Invocation> Parser::take() {
  const auto chosen = app_.get_subcommands();
  result_.name = chosen.empty() ? "" : chosen.front()->get_name();
  if (json_ && csv_) {
    values_.failed(say<texts::json_and_csv>(), say<texts::see_help>());
  }
  if (csv_ && std::ranges::find(with_csv, result_.name) == with_csv.end()) {
    values_.failed(say<texts::no_csv>(result_.name), say<texts::see_help>());
  }
  if (auto checked = values_.check(); !checked) {
    return std::unexpected(checked.error());
  }
  if (result_.shared.record == "-") {
    return refuse(say<texts::record_needs_file>());
  }
  if (result_.shared.record && (result_.name == "models" || result_.name == "sim")) {
    return refuse(say<texts::nothing_to_record>(result_.name));
  }
  if (chosen.empty()) {
    return refuse(say<texts::no_command>());
  }
  Shared& shared = result_.shared;
  shared.interface = interface_ ? *interface_ : environment("BLACTL_INTERFACE").value_or("");
  if (!shared.profile_dir) {
    shared.profile_dir = environment("BLACTL_PROFILE_DIR");
  }
  shared.output.format = json_ ? Format::json : csv_ ? Format::csv : Format::text;
  result_.command = taken_.at(chosen.front())();
  return result_;
}

/// The flags of "-jqn": short options may share a dash, and one that takes a value ends them.
std::string_view short_flags(std::string_view argument) {
  const bool is_short = argument.size() > 1 && argument[0] == '-' && argument[1] != '-';
  return is_short ? argument.substr(1, argument.find_first_not_of("jqvyh", 1) - 1)
                  : std::string_view();
}

/// Whether the value of this option is the next argument: "--node", "-n", "-jn".
bool takes_next(std::string_view argument) {
  if (argument.starts_with("--")) {
    return std::ranges::find(with_value, argument) != with_value.end();
  }
  const std::string_view rest = argument.substr(1 + short_flags(argument).size());
  return rest == "i" || rest == "n";
}

/// The first argument that is neither an option nor the value of one.
std::optional<std::string> first_word(std::span<const std::string> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument.empty() || argument.front() != '-') {
      return argument;
    }
    if (takes_next(argument)) {
      ++i;
    }
  }
  return std::nullopt;
}

} // namespace

std::string peek_command(std::span<const std::string> arguments) {
  const auto word = first_word(arguments);
  return word && std::ranges::find(commands, *word) != commands.end() ? *word : std::string();
}

bool is_stream(std::string_view command) {
  return std::ranges::find(streams, command) != streams.end();
}

Shared peek(std::span<const std::string> arguments) {
  Shared shared;
  const auto is_json = [](const std::string& argument) {
    return argument == "--json" || short_flags(argument).find('j') != std::string_view::npos;
  };
  if (std::ranges::any_of(arguments, is_json)) {
    shared.output.format = Format::json;
  }
  return shared;
}

Language peek_language(std::span<const std::string> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--lang" && i + 1 < arguments.size()) {
      return arguments[i + 1] == "ja" ? Language::japanese : Language::english;
    }
    if (arguments[i].starts_with("--lang=")) {
      return arguments[i] == "--lang=ja" ? Language::japanese : Language::english;
    }
  }
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    if (const auto locale = environment(name)) {
      return locale->starts_with("ja") ? Language::japanese : Language::english;
    }
  }
  return Language::english;
}

Result<Invocation> parse(std::span<const std::string> arguments) {
  const auto word = first_word(arguments);
  if (word && std::ranges::find(commands, *word) == commands.end()) {
    std::string hint;
    for (const std::string_view name : nearest(*word, commands)) {
      hint += hint.empty() ? "" : ", ";
      hint += name;
    }
    return fail(Code::usage, say<texts::unknown_command>(printable(*word)),
                hint.empty() ? say<texts::see_help>() : say<texts::did_you_mean>(hint));
  }
  return Parser().parse(arguments);
}

} // namespace blactl::cli
