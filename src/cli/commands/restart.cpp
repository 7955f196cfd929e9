// blactl restart: RAM from ROM.

#include "cli/change/change_servos.hpp"
#include "cli/commands.hpp"

namespace blactl::cli {
namespace {

struct RestartOptions {
  RestartTimes times{};
};

constexpr Option restart_options[]{
    restart_wait<&RestartOptions::times>,
    restart_stagger<&RestartOptions::times>,
};

Report execute(const RestartOptions& options, Context& context) {
  auto request = request_for_all("restart", {.restart = fleet::RestartKind::restart});
  request.times = options.times;
  return change_servos(request, context);
}

} // namespace

constinit const Command commands::restart{
    .name = "restart",
    .traits = {.writes = true, .session = true},
    .help = {"restart: RAM from ROM", "再起動 (RAM は ROM の内容に戻る)"},
    .options = restart_options,
    .action = action<RestartOptions, execute>,
};

} // namespace blactl::cli
