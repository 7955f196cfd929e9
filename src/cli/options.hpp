#pragma once
// The options of every command, and those common to several commands.

#include "blactl/base/text.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/register_access.hpp"

#include "cli/command.hpp"
#include "cli/output/reporter.hpp"

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::cli {

/// An option that was set by an environment variable.
struct Origin {
  std::string_view option;
  std::string value;
  std::string_view variable;
};

/// Options that every command takes, before or after its name (contract, section 2).
struct Shared {
  std::string interface{}; ///< empty: the only CAN interface that is up
  std::optional<std::string> nodes{};
  std::optional<std::uint8_t> local_node_id{};
  bool listen_only = false;
  bool yes = false;
  bool while_driven = false;
  bool overwrite_rom = false;
  fleet::Patience patience{};
  std::optional<std::string> profile_dir{};
  std::optional<std::string> profile{};
  std::optional<std::string> record{};
  Reporter::Options output{};
  std::vector<Origin> from_environment{}; ///< for options that are not given
  bool json = false;
  bool csv = false;
  Language language{}; ///< only checked here: used before anything is parsed
  bool help = false;
  bool version = false;
  bool dump_cli = false;
};

/// The times of restarts.
struct RestartTimes {
  std::optional<Duration> wait{}; ///< for a servo to come back; empty: as long as needed
  Duration stagger{};             ///< between two servos
};

[[nodiscard]] std::span<const Option> shared_options();

/// --dry-run of a command that plans for several servos; `is_dry` is its flag.
template <auto is_dry>
inline constexpr Option dry_run_option{
    .name = "--dry-run",
    .kind = Kind::flag,
    .help = {"change nothing; exit status 8 when something would be done",
             "変更しない (処理の予定がある場合は終了ステータス 8)"},
    .store = into<is_dry>,
};

/// --wait and --stagger of a command that restarts servos; `times` is its RestartTimes.
template <auto times>
inline constexpr Option restart_wait{
    .name = "--wait",
    .value = "SEC",
    .kind = Kind::seconds,
    .seconds = {std::chrono::milliseconds(1), std::chrono::hours(1)},
    .help =
        {"how long a servo may take to come back (default 5, and 2 for each that asks for a "
         "node ID)",
         "サーボの復帰を待つ時間 (省略時 5 秒、ノード ID 割当て待ちのサーボ 1 台ごとに 2 秒追加)"},
    .store = into<times, &RestartTimes::wait>,
};

template <auto times>
inline constexpr Option restart_stagger{
    .name = "--stagger",
    .value = "SEC",
    .kind = Kind::seconds,
    .seconds = {Duration::zero(), std::chrono::hours(1)},
    .help = {"pause between two servos (default 0)", "サーボごとの間隔 (省略時 0)"},
    .store = into<times, &RestartTimes::stagger>,
};

} // namespace blactl::cli
