// blactl save: RAM to ROM.

#include "cli/change/change_servos.hpp"
#include "cli/commands.hpp"

namespace blactl::cli {
namespace {

struct SaveOptions {
  RestartTimes times{};
};

constexpr Option save_options[]{
    restart_wait<&SaveOptions::times>,
    restart_stagger<&SaveOptions::times>,
};

Report execute(const SaveOptions& options, Context& context) {
  auto request = request_for_all("save", {.restart = fleet::RestartKind::save});
  request.times = options.times;
  return change_servos(request, context);
}

} // namespace

constinit const Command commands::save{
    .name = "save",
    .traits = {.writes = true, .session = true},
    .help = {"RAM to ROM: restarts the servo, and reads again",
             "RAM を ROM に保存 (サーボの再起動後に再読出し)"},
    .options = save_options,
    .action = action<SaveOptions, execute>,
};

} // namespace blactl::cli
