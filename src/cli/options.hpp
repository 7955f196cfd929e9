#pragma once
// The command line as plain structs. Only options.cpp knows the parser.

#include "blactl/base/error.hpp"
#include "blactl/base/text.hpp"
#include "blactl/fleet/registers.hpp"

#include "cli/output/reporter.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace blactl::cli {

/// Options that every command takes, before or after its name (contract, section 2).
struct Shared {
  std::string interface{}; ///< empty: the only CAN interface that is up
  std::optional<std::string> nodes{};
  std::optional<std::uint8_t> local_node_id{};
  bool listen_only = false;
  bool yes = false;
  bool while_driven = false;
  fleet::Patience patience{};
  std::optional<std::string> profile_dir{};
  std::optional<std::string> profile{};
  std::optional<std::string> record{};
  Reporter::Options output{};
};

struct ScanOptions {
  Duration listen = std::chrono::milliseconds(1200);
  std::optional<std::uint64_t> expect{};
};

struct GetOptions {
  std::vector<std::string> parameters{};
  std::vector<std::string> groups{};
  bool all = false;
  bool changed = false;
};

/// Where servos restart.
struct RestartTimes {
  std::optional<Duration> wait{}; ///< for a servo to come back; empty: as many as there are need
  Duration stagger{};             ///< between two servos
};

struct SetOptions {
  std::vector<std::string> assignments{};
  bool dry_run = false;
  bool save = false;
  RestartTimes times{};
};

struct SaveOptions {
  RestartTimes times{};
};

struct EraseOptions {
  bool save = false;
  bool keep_ids = false;
  RestartTimes times{};
};

struct RestartOptions {
  RestartTimes times{};
};

struct WaitOptions {
  Duration wait = std::chrono::seconds(10);
};

struct ModelsOptions {
  std::string model{};
  std::string parameter{};
};

struct TraceOptions {
  std::string file{};                 ///< a candump log, or "-"; empty: the interface
  std::optional<std::string> types{}; ///< names or numbers, comma-separated
  std::optional<std::string> kinds{}; ///< message, request, response
  std::optional<Duration> duration{};
  std::optional<std::uint64_t> count{};
  bool stats = false;
};

struct SimOptions {
  std::string scenario{};
  std::optional<std::string> facts{}; ///< a facts file; empty: servos behave as is likely
  std::optional<std::uint64_t> seed{};
  std::string clock{}; ///< "real", "virtual"; empty: as the scenario says
};

using CommandOptions =
    std::variant<ScanOptions, GetOptions, SetOptions, SaveOptions, EraseOptions, RestartOptions,
                 WaitOptions, TraceOptions, ModelsOptions, SimOptions>;

struct Invocation {
  Shared shared{};
  CommandOptions command{};
  std::string name{};      ///< "get"; empty: none
  std::string help_text{}; ///< not empty: print this and end
};

/// What can be told before anything is parsed: every failure of a command line with --json prints
/// a document.
[[nodiscard]] Shared peek(std::span<const std::string> arguments);
/// The command that is meant; empty: unknown.
[[nodiscard]] std::string peek_command(std::span<const std::string> arguments);
/// Whether a command of this name prints one object a line: then a document of one line ends it,
/// whatever went wrong.
[[nodiscard]] bool is_stream(std::string_view command);
[[nodiscard]] Language peek_language(std::span<const std::string> arguments);

/// Errors: usage, with the nearest command for a mistyped one.
[[nodiscard]] Result<Invocation> parse(std::span<const std::string> arguments);

} // namespace blactl::cli
