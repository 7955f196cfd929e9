#include "cli/command_line.hpp"

#include "cli/log_target.hpp"
#include "cli/option_values.hpp"
#include "cli/texts.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using Arguments = std::span<const std::string>;
using Commands = std::span<const Command* const>;

std::optional<std::string> environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? std::optional<std::string>(value) : std::nullopt;
}

bool looks_like_option(std::string_view argument) {
  return argument.size() > 1 && argument.front() == '-';
}

/// The shared option with this letter; null: none.
const Option* find_letter(char letter) {
  const auto found = std::ranges::find(shared_options(), letter, &Option::letter);
  return found != shared_options().end() ? &*found : nullptr;
}

/// The first option of this name ("--node") of any command; null: none.
const Option* find_option(std::string_view name, Commands commands) {
  const auto in = [&](std::span<const Option> options) {
    const auto found = std::ranges::find(options, name, &Option::name);
    return found != options.end() ? &*found : nullptr;
  };
  const Option* found = in(shared_options());
  for (const Command* command : commands) {
    found = found != nullptr ? found : in(command->options);
  }
  return found;
}

/// The flags of "-jqn": short options may share a dash; one that takes a value is the last.
std::string_view short_flags(std::string_view argument) {
  if (!looks_like_option(argument) || argument[1] == '-') {
    return {};
  }
  const auto letters = argument.substr(1);
  const auto end = std::ranges::find_if(letters, [](char letter) {
    const Option* option = find_letter(letter);
    return option == nullptr || option->kind != Kind::flag;
  });
  return {letters.begin(), end};
}

/// Whether the next argument is the value of this option: "--node", "-n", "-jn".
bool takes_next(std::string_view argument, Commands commands) {
  const Option* option = nullptr;
  if (argument.starts_with("--")) {
    option = find_option(argument, commands);
  } else if (const auto rest = argument.substr(1 + short_flags(argument).size());
             rest.size() == 1) {
    option = find_letter(rest.front());
  }
  return option != nullptr && option->kind != Kind::flag;
}

/// The index of the first argument that is neither an option nor the value of one.
std::size_t first_word(Arguments arguments, Commands commands) {
  std::size_t at = 0;
  while (at < arguments.size() && !arguments[at].empty() && arguments[at].front() == '-') {
    at += takes_next(arguments[at], commands) ? 2U : 1U;
  }
  return std::min(at, arguments.size());
}

Error unknown_command(std::string_view word, Commands commands) {
  std::vector<std::string_view> names;
  for (const Command* command : commands) {
    names.push_back(command->name);
  }
  return {Code::usage, say<texts::unknown_command>(printable(word)),
          did_you_mean(word, names, say<texts::see_help>()), std::nullopt};
}

/// The parser for one command. It only sorts the arguments; meanings and missing ones are checked
/// afterwards, so that all errors are found and not just the first.
class Parser {
 public:
  explicit Parser(const Command* command);

  std::expected<Invocation, std::vector<Error>> parse(Arguments arguments);

  /// The errors besides an unknown command: in the shared options, and options that no command has.
  std::vector<Error> faults_beside_unknown_command(Arguments arguments, Commands commands);

 private:
  struct Declared {
    const Option* option;
    const CLI::Option* given;
    void* options; ///< the struct to fill
    std::string see_help;
  };

  void declare(const Option& option, void* options, const std::string& see_help);
  /// Removes "--node=", for which the parser would take the next argument as value.
  std::vector<std::string> without_empty_values(Arguments arguments);
  void sort(std::vector<std::string> arguments);
  void refuse_unknown(Arguments arguments);
  void understand_given();
  void check_formats();
  void check_combinations();
  void check_recording();
  void complete();

  void refuse(std::string message, std::string hint) {
    faults_.push_back({Code::usage, std::move(message), std::move(hint), std::nullopt});
  }

  [[nodiscard]] std::string see_help() const {
    return result_.command == nullptr ? say<texts::see_help>()
                                      : say<texts::see_command_help>(result_.command->name);
  }

  CLI::App app_;
  std::vector<Declared> declared_;
  std::shared_ptr<void> options_;
  Invocation result_;
  std::vector<Error> faults_;
};

Parser::Parser(const Command* command) {
  result_.command = command;
  app_.set_help_flag();
  app_.allow_extras();
  for (const Option& option : shared_options()) {
    declare(option, &result_.shared, say<texts::see_help>());
  }
  if (command != nullptr) {
    options_ = command->action.make();
    for (const auto& options : {command->options, command->arguments}) {
      for (const Option& option : options) {
        declare(option, options_.get(), see_help());
      }
    }
  }
}

void Parser::declare(const Option& option, void* options, const std::string& see_help) {
  std::string names(option.name);
  if (option.letter != 0) {
    names = std::string{'-', option.letter, ','} + names;
  }
  CLI::Option* declared{};
  if (option.kind == Kind::flag) {
    declared = app_.add_flag(names);
  } else {
    declared = app_.add_option(names);
    declared->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (declared->get_positional() && option.repeat == Repeat::list) {
      declared->expected(-1);
    }
  }
  declared_.push_back({&option, declared, options, see_help});
}

std::vector<std::string> Parser::without_empty_values(Arguments arguments) {
  std::vector<std::string> rest;
  for (const std::string& argument : arguments) {
    const auto is_empty = [&](const Declared& each) {
      return each.option->kind != Kind::flag && argument == std::string(each.option->name) + "=";
    };
    const auto found = std::ranges::find_if(declared_, is_empty);
    if (found == declared_.end() || found->given->get_positional()) {
      rest.push_back(argument);
    } else {
      refuse(say<texts::empty_value>(found->option->name), found->see_help);
    }
  }
  return rest;
}

void Parser::sort(std::vector<std::string> arguments) {
  std::ranges::reverse(arguments);
  try {
    app_.parse(std::move(arguments));
  } catch (const CLI::ArgumentMismatch& error) {
    // "--node" of "--node: 1 required LIST missing": only ever the last argument
    const std::string text = error.what();
    refuse(say<texts::takes_one_value>(printable(text.substr(0, text.find(':')))), see_help());
  } catch (const CLI::ParseError& error) {
    refuse(say<texts::not_understood>(printable(error.what())), see_help());
  }
}

void Parser::refuse_unknown(Arguments arguments) {
  std::vector<std::string_view> known;
  for (const Declared& each : declared_) {
    if (!each.option->hidden && !each.given->get_positional()) {
      known.push_back(each.option->name);
    }
  }
  std::string before;
  for (const std::string& extra : app_.remaining()) {
    // the argument after an unknown option was probably its value
    const std::vector<std::string> pair{std::exchange(before, extra), extra};
    const bool was_value = looks_like_option(pair[0]) && !looks_like_option(extra) &&
                           std::ranges::search(arguments, pair).begin() != arguments.end();
    if (!was_value && extra != "--") {
      const std::string_view name = std::string_view(extra).substr(0, extra.find('='));
      refuse(looks_like_option(extra) ? say<texts::unknown_option>(printable(extra))
                                      : say<texts::unexpected_argument>(printable(extra)),
             extra.starts_with("--") ? did_you_mean(name, known, see_help()) : see_help());
    }
  }
}

void Parser::understand_given() {
  for (const auto& [option, given, options, see_help] : declared_) {
    const std::vector<std::string>& results = given->results();
    if (option->kind == Kind::flag && std::ranges::count(results, "true") != std::ssize(results)) {
      refuse(say<texts::takes_no_value>(option->name), see_help);
    } else if (!results.empty()) {
      option->store.put(options, understand(*option, results, see_help, faults_));
    } else if (option->required && result_.command != nullptr) {
      refuse(say<texts::argument_missing>(option->name), see_help);
    }
  }
}

void Parser::check_formats() {
  const Shared& shared = result_.shared;
  if (shared.json && shared.csv) {
    refuse(say<texts::json_and_csv>(), say<texts::see_help>());
  }
  if (shared.record == "-") {
    refuse(say<texts::record_needs_file>(), see_help());
  }
}

void Parser::check_combinations() {
  const Shared& shared = result_.shared;
  const Command* command = result_.command;
  check_formats();
  if (shared.csv && command != nullptr && !command->traits.tables) {
    refuse(say<texts::no_csv>(command->name), say<texts::no_csv_hint>());
  }
  if (shared.record && command != nullptr && !command->traits.session) {
    refuse(say<texts::nothing_to_record>(command->name), see_help());
  }
  if (shared.record) {
    check_recording();
  }
  if (shared.nodes && command != nullptr && !command->traits.session) {
    refuse(say<texts::no_nodes>(command->name), see_help());
  }
  if (command == nullptr) {
    refuse(say<texts::no_command>(), say<texts::see_help>());
  }
}

/// Files that other options read or write, and what is no log, must not be overwritten.
void Parser::check_recording() {
  const std::size_t known = faults_.size();
  for (const auto& [option, given, options, see_help] : declared_) {
    const bool is_other_file = option->kind == Kind::file && option->name != "--record";
    for (const std::string& file : is_other_file ? given->results() : std::vector<std::string>()) {
      std::error_code none;
      if (file == result_.shared.record ||
          std::filesystem::equivalent(file, *result_.shared.record, none)) {
        refuse(say<texts::records_over_file>(printable(file), option->name),
               say<texts::records_over_file_hint>());
      }
    }
  }
  const auto fit = check_target(*result_.shared.record, Content::log, "--record");
  if (!fit && faults_.size() == known) {
    faults_.push_back(fit.error());
  }
}

/// Completes options from the environment.
void Parser::complete() {
  Shared& shared = result_.shared;
  const auto from = [&](const char* variable, std::string_view option) {
    const auto value = environment(variable);
    if (value) {
      shared.from_environment.push_back({option, *value, variable});
    }
    return value;
  };
  if (shared.interface.empty()) {
    shared.interface = from("BLACTL_INTERFACE", "--interface").value_or("");
  }
  if (!shared.profile_dir) {
    shared.profile_dir = from("BLACTL_PROFILE_DIR", "--profile-dir");
  }
  shared.output.format = shared.json ? Format::json : shared.csv ? Format::csv : Format::text;
  result_.options = options_;
}

std::expected<Invocation, std::vector<Error>> Parser::parse(Arguments arguments) {
  sort(without_empty_values(arguments));
  refuse_unknown(arguments);
  understand_given();
  check_combinations();
  const bool asks_for_text =
      result_.shared.help || result_.shared.version || result_.shared.dump_cli;
  if (!faults_.empty() && !asks_for_text) {
    return std::unexpected(std::move(faults_));
  }
  complete();
  return std::move(result_);
}

std::vector<Error> Parser::faults_beside_unknown_command(Arguments arguments, Commands commands) {
  sort(without_empty_values(arguments));
  for (const std::string& extra : app_.remaining()) {
    const bool is_known = find_option(extra.substr(0, extra.find('=')), commands) != nullptr;
    if (extra.starts_with("--") && extra != "--" && !is_known) {
      refuse(say<texts::unknown_option>(printable(extra)), see_help());
    }
  }
  understand_given();
  check_formats();
  return std::move(faults_);
}

} // namespace

std::vector<std::string> spelled_out(std::span<const std::string> arguments) {
  std::vector<std::string> all(arguments.begin(), arguments.end());
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(first_word(all, all_commands()));
  if (all.empty()) {
    all.emplace_back("--help");
  } else if (at != all.end() && (*at == "help" || *at == "version")) {
    const std::string option = "--" + *at;
    all.erase(at);
    all.push_back(option);
  }
  return all;
}

const Command* peek_command(std::span<const std::string> arguments) {
  const std::size_t at = first_word(arguments, all_commands());
  return at < arguments.size() ? find_command(arguments[at]) : nullptr;
}

namespace {

/// The last value of an option, of a command line that may be wrong elsewhere; empty: none.
std::optional<std::string_view> peek_value(Arguments arguments, std::string_view option) {
  std::optional<std::string_view> last;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view argument = arguments[i];
    if (argument == option && i + 1 < arguments.size()) {
      last = arguments[++i];
    } else if (argument.starts_with(option) && argument.substr(option.size()).starts_with('=')) {
      last = argument.substr(option.size() + 1);
    }
  }
  return last;
}

Colour peek_colour(Arguments arguments) {
  const auto when = peek_value(arguments, "--color");
  return when == "never" ? Colour::never : when == "always" ? Colour::always : Colour::automatic;
}

} // namespace

Shared peek(std::span<const std::string> arguments) {
  Shared shared;
  shared.output.colour = peek_colour(arguments);
  const auto is_json = [](const std::string& argument) {
    return argument == "--json" || short_flags(argument).find('j') != std::string_view::npos;
  };
  if (std::ranges::any_of(arguments, is_json)) {
    shared.output.format = Format::json;
  }
  return shared;
}

Language peek_language(std::span<const std::string> arguments) {
  if (const auto named = peek_value(arguments, "--lang")) {
    return *named == "ja" ? Language::japanese : Language::english;
  }
  for (const char* name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    if (const auto locale = environment(name)) {
      return locale->starts_with("ja") ? Language::japanese : Language::english;
    }
  }
  return Language::english;
}

std::expected<Invocation, std::vector<Error>> parse(std::span<const std::string> arguments,
                                                    std::span<const Command* const> commands) {
  const std::size_t at = first_word(arguments, commands);
  if (at == arguments.size()) {
    return Parser(nullptr).parse(arguments);
  }
  std::vector<std::string> rest(arguments.begin(), arguments.end());
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(at));
  const auto command = std::ranges::find(commands, arguments[at], &Command::name);
  if (command == commands.end()) {
    auto faults = Parser(nullptr).faults_beside_unknown_command(rest, commands);
    faults.insert(faults.begin(), unknown_command(arguments[at], commands));
    return std::unexpected(std::move(faults));
  }
  return Parser(*command).parse(rest);
}

} // namespace blactl::cli
