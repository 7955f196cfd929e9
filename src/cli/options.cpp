#include "options.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"

#include "texts.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <utility>

namespace blactl::cli {
namespace {

constexpr std::array<std::string_view, 5> commands{"scan", "get", "set", "models", "sim"};

/// Options that take the next argument as their value: what a mistyped command is told apart from.
constexpr std::array<std::string_view, 12> with_value{
    "--interface", "--node",        "--local-node-id", "--color",  "--lang",   "--timeout",
    "--retries",   "--profile-dir", "--profile",       "--listen", "--expect", "--group"};

std::string list(std::initializer_list<std::string_view> words) {
  std::string out;
  for (const std::string_view word : words) {
    out += out.empty() ? "" : ", ";
    out += word;
  }
  return out;
}

/// Collects what the parser hands over as text, and checks it afterwards: CLI11 would take "nan"
/// for a number and rounds silently.
class Values {
 public:
  std::string* add(CLI::App& app, const char* names, const char* help, const char* type) {
    auto& slot = slots_.emplace_back(std::make_unique<std::string>());
    const std::size_t name = std::string_view(names).find("--");
    app.add_option(names, *slot, help)
        ->type_name(type)
        ->each([this, names, name](const std::string& text) {
          // An unset variable of a script: -n "$NODE" must not mean every servo.
          if (text.empty()) {
            failed(say<texts::empty_value>(std::string_view(names).substr(name)));
          }
        });
    return slot.get();
  }

  /// Seconds with up to six decimals.
  void seconds(const char* option, const std::string& text, Duration& out, Duration min,
               Duration max) {
    const auto value = decimal_seconds(text);
    if (!value || *value < min || *value > max) {
      const auto in_seconds = [](Duration d) {
        return fmt::format("{}", std::chrono::duration<double>(d).count());
      };
      failed(say<texts::bad_seconds>(option, printable(text), in_seconds(min), in_seconds(max)));
      return;
    }
    out = *value;
  }

  template <class Number>
  void whole(const char* option, const std::string& text, Number& out, Number min, Number max) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (text.empty() || error != std::errc() || stop != end || value < min || value > max) {
      failed(say<texts::bad_number>(option, printable(text), min, max));
      return;
    }
    out = value;
  }

  template <class Choice>
  void word(const char* option, const std::string& text, Choice& out,
            std::initializer_list<std::pair<std::string_view, Choice>> choices) {
    std::string known;
    for (const auto& [name, value] : choices) {
      if (name == text) {
        out = value;
        return;
      }
      known += known.empty() ? "" : ", ";
      known += name;
    }
    failed(say<texts::bad_word>(option, printable(text), known));
  }

  void failed(std::string message) {
    if (!error_) {
      error_ = Error{Code::usage, std::move(message), say<texts::see_help>(), std::nullopt};
    }
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  static std::optional<Duration> decimal_seconds(std::string_view text) {
    constexpr std::size_t most_digits = 6;
    const auto point = text.find('.');
    const std::string_view whole = text.substr(0, point);
    std::string fraction(point == std::string_view::npos ? "" : text.substr(point + 1));
    const bool digits_only =
        (std::string(whole) + fraction).find_first_not_of("0123456789") == std::string::npos;
    if (whole.empty() || whole.size() > most_digits || fraction.size() > most_digits ||
        !digits_only || (point != std::string_view::npos && fraction.empty())) {
      return std::nullopt;
    }
    fraction.resize(most_digits, '0');
    return Duration(std::strtoll((std::string(whole) + fraction).c_str(), nullptr, 10));
  }

  std::vector<std::unique_ptr<std::string>> slots_;
  std::optional<Error> error_;
};

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
    add_models();
    add_sim();
    for (CLI::App* command : app_.get_subcommands({})) {
      command->fallthrough();
      command->footer("Shared options, before or after the command: see blactl --help.");
    }
  }

  Result<Invocation> parse(std::span<const std::string> arguments) {
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

 private:
  void add_shared();
  void add_scan();
  void add_get();
  void add_set();
  void add_models();
  void add_sim();
  Result<Invocation> take();
  void take_shared();

  std::unexpected<Error> refuse(std::string message) {
    const auto chosen = app_.get_subcommands();
    return blactl::fail(Code::usage, std::move(message),
                        chosen.empty() ? say<texts::see_help>()
                                       : say<texts::see_command_help>(chosen.front()->get_name()));
  }

  CLI::App app_{"Configures and diagnoses Futaba BLA servos over DroneCAN"};
  Values values_;
  Invocation result_;
  ScanOptions scan_;
  GetOptions get_;
  SetOptions set_;
  ModelsOptions models_;
  SimOptions sim_;
  std::string *interface_ = nullptr, *nodes_ = nullptr, *local_ = nullptr, *colour_ = nullptr,
              *lang_ = nullptr, *timeout_ = nullptr, *retries_ = nullptr, *profile_dir_ = nullptr,
              *profile_ = nullptr, *listen_ = nullptr, *expect_ = nullptr, *seed_ = nullptr;
  bool json_ = false, csv_ = false;
};

void Parser::add_shared() {
  Shared& shared = result_.shared;
  interface_ =
      values_.add(app_, "-i,--interface",
                  "can0, slcan:/dev/ttyUSB0, sim:, sim:SOCKET, sim:SCENARIO.json", "IFACE");
  nodes_ = values_.add(app_, "-n,--node",
                       "servos: 12, 10-14,20, all, uid:…, serial:…, servo:…, model:…", "LIST");
  local_ = values_.add(app_, "--local-node-id", "own node ID (default 127, else 126)", "ID");
  app_.add_flag("--listen-only", shared.listen_only, "send nothing, take no node ID");
  app_.add_flag("-j,--json", json_, "output as one JSON document");
  app_.add_flag("--csv", csv_, "output as CSV (scan, get)");
  app_.add_flag("-q,--quiet", shared.output.quiet, "no notes on stderr");
  app_.add_flag("-v,--verbose", shared.output.verbosity, "details on stderr");
  colour_ = values_.add(app_, "--color", "auto, always, never", "WHEN");
  lang_ = values_.add(app_, "--lang", "en, ja", "LANG");
  app_.add_flag("-y,--yes", shared.yes, "agree to questions beforehand");
  timeout_ = values_.add(app_, "--timeout", "for one request (default 0.5)", "SEC");
  retries_ = values_.add(app_, "--retries", "of one request (default 2)", "N");
  app_.add_flag("--while-driven", shared.while_driven, "although another node drives the servo");
  profile_dir_ = values_.add(app_, "--profile-dir", "further model profiles", "DIR");
  profile_ = values_.add(app_, "--profile", "read as this model where no profile fits", "MODEL");
}

void Parser::add_scan() {
  CLI::App* command = app_.add_subcommand("scan", "find every node and identify BLA servos");
  listen_ = values_.add(*command, "--listen", "how long (default 1.2)", "SEC");
  expect_ = values_.add(*command, "--expect", "fail unless so many servos are found", "N");
}

void Parser::add_get() {
  CLI::App* command = app_.add_subcommand("get", "read parameters");
  command->add_option("PARAM", get_.parameters, "names or addresses: angle_limit_cw, 0x38")
      ->type_name("");
  command
      ->add_option("--group", get_.groups,
                   "all of a group: command status operation fault config "
                   "control pwm limit option product production")
      ->type_name("G")
      ->allow_extra_args(false); // what follows the group is a parameter
  command->add_flag("--all", get_.all, "every parameter (as without PARAM)");
  command->add_flag("--changed", get_.changed, "only what differs from the model's default");
}

void Parser::add_set() {
  CLI::App* command =
      app_.add_subcommand("set", "check against the profile, write, read back (RAM only)");
  command->add_option("PARAM=VALUE", set_.assignments, "angle_limit_cw=90deg, 0x38=900")
      ->type_name("")
      ->required();
  command->add_flag("--dry-run", set_.dry_run, "change nothing; 8 when something would change");
}

void Parser::add_models() {
  CLI::App* command = app_.add_subcommand("models", "what the profiles know, without any servo");
  command->add_option("MODEL", models_.model, "a model or its beginning: BLA21-12U")->type_name("");
  command->add_option("PARAM", models_.parameter, "one parameter")->type_name("");
}

void Parser::add_sim() {
  CLI::App* command = app_.add_subcommand(
      "sim", "simulated servos: serves the sim: bus, or joins a real interface with -i");
  command->add_option("SCENARIO", sim_.scenario, "scenario file (default: three servos)")
      ->type_name("");
  seed_ = values_.add(*command, "--seed", "of everything random", "N");
  command->add_option("--clock", sim_.clock, "real, virtual")->type_name("CLOCK");
}

void Parser::take_shared() {
  Shared& shared = result_.shared;
  shared.interface =
      interface_->empty() ? environment("BLACTL_INTERFACE").value_or("") : *interface_;
  const auto optional = [](const std::string& text) {
    return text.empty() ? std::nullopt : std::optional(text);
  };
  shared.nodes = optional(*nodes_);
  shared.profile = optional(*profile_);
  shared.profile_dir =
      profile_dir_->empty() ? environment("BLACTL_PROFILE_DIR") : optional(*profile_dir_);
  if (!local_->empty()) {
    values_.whole<std::uint8_t>("--local-node-id", *local_, shared.local_node_id.emplace(), 1, 127);
  }
  if (!timeout_->empty()) {
    values_.seconds("--timeout", *timeout_, shared.patience.timeout, std::chrono::milliseconds(1),
                    std::chrono::minutes(1));
  }
  if (!retries_->empty()) {
    values_.whole("--retries", *retries_, shared.patience.retries, 0, 100);
  }
  if (!colour_->empty()) {
    values_.word(
        "--color", *colour_, shared.output.colour,
        {{"auto", Colour::automatic}, {"always", Colour::always}, {"never", Colour::never}});
  }
  if (!lang_->empty()) {
    Language spoken{};
    values_.word("--lang", *lang_, spoken, {{"en", Language::english}, {"ja", Language::japanese}});
  }
  if (json_ && csv_) {
    values_.failed(say<texts::json_and_csv>());
  }
  shared.output.format = json_ ? Format::json : csv_ ? Format::csv : Format::text;
}

Result<Invocation> Parser::take() {
  take_shared();
  const auto chosen = app_.get_subcommands();
  result_.name = chosen.empty() ? "" : chosen.front()->get_name();
  if (!listen_->empty()) {
    values_.seconds("--listen", *listen_, scan_.listen, std::chrono::milliseconds(1),
                    std::chrono::hours(1));
  }
  if (!expect_->empty()) {
    values_.whole<std::uint64_t>("--expect", *expect_, scan_.expect.emplace(), 0, 127);
  }
  if (!seed_->empty()) {
    values_.whole<std::uint64_t>("--seed", *seed_, sim_.seed.emplace(), 0, ~std::uint64_t{0});
  }
  if (!sim_.clock.empty() && sim_.clock != "real" && sim_.clock != "virtual") {
    values_.failed(
        say<texts::bad_word>("--clock", printable(sim_.clock), list({"real", "virtual"})));
  }
  if (result_.shared.output.format == Format::csv && result_.name != "scan" &&
      result_.name != "get") {
    values_.failed(say<texts::no_csv>(result_.name));
  }
  if (values_.error()) {
    return std::unexpected(*values_.error());
  }
  const std::array<CommandOptions, 5> options{scan_, get_, set_, models_, sim_};
  const auto at = std::ranges::find(commands, result_.name) - commands.begin();
  if (result_.name.empty()) {
    return fail(Code::usage, say<texts::no_command>(), say<texts::see_help>());
  }
  result_.command = options[static_cast<std::size_t>(at)];
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
