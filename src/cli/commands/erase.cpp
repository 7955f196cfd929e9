// blactl erase: RAM to factory defaults.

#include "blactl/fleet/change/history.hpp"

#include "cli/change/change_servos.hpp"
#include "cli/commands.hpp"

namespace blactl::cli {
namespace {

struct EraseOptions {
  bool save = false;
  bool keep_ids = false;
  RestartTimes times{};
};

constexpr Option erase_options[]{
    {.name = "--save",
     .kind = Kind::flag,
     .help = {"then RAM to ROM", "続けて RAM を ROM に保存"},
     .store = into<&EraseOptions::save>},
    {.name = "--keep-ids",
     .kind = Kind::flag,
     .help = {"servo_id and static_node_id stay", "servo_id と static_node_id は変更しない"},
     .store = into<&EraseOptions::keep_ids>},
    restart_wait<&EraseOptions::times>,
    restart_stagger<&EraseOptions::times>,
};

Report execute(const EraseOptions& options, Context& context) {
  const auto restart = options.save ? std::optional(fleet::RestartKind::save) : std::nullopt;
  auto request = request_for_all(options.keep_ids ? fleet::erase_keeping_ids : "erase",
                                 {.erase = true, .keep_ids = options.keep_ids, .restart = restart});
  request.times = options.times;
  return change_servos(request, context);
}

} // namespace

constinit const Command commands::erase{
    .name = "erase",
    .traits = {.writes = true, .session = true},
    .help = {"RAM to factory defaults, IDs included (ROM only with --save)",
             "RAM を ID も含めて初期値に戻す (ROM は --save 指定時のみ)"},
    .options = erase_options,
    .action = action<EraseOptions, execute>,
};

} // namespace blactl::cli
