// blactl scan: the nodes on the bus.

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/target_texts.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/characterize/findings.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/output/scan_view.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

struct ScanOptions {
  Duration listen = std::chrono::milliseconds(1200);
  std::optional<std::uint64_t> expect{};
};

constexpr Option scan_options[]{
    {.name = "--listen",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::hours(1)},
     .help = {"how long to listen (default 1.2)", "受信する時間 (省略時 1.2)"},
     .store = into<&ScanOptions::listen>},
    {.name = "--expect",
     .value = "N",
     .kind = Kind::whole,
     .whole = {0, dronecan::NodeId::max},
     .help = {"fail unless this many servos are found", "検出台数がこれより少なければ失敗とする"},
     .store = into<&ScanOptions::expect>},
};

using fleet::Conflict;
using fleet::Findings;

bool is_listed(const Findings& findings, std::uint8_t id) {
  return std::ranges::any_of(
      findings.nodes, [&](const fleet::Finding& node) { return node.servo.id.value() == id; });
}

/// The errors of the nodes that could not be identified.
void take_failures(const fleet::Discovery& discovery, const Findings& findings, Report& report) {
  for (auto& error : discovery.identifications()) {
    const bool is_meant = !error || !error->node_id || is_listed(findings, *error->node_id);
    if (!is_meant) { // excluded by -n
      continue;
    }
    // A recording of other nodes' traffic may only show that a node exists: that is not a failure
    // of this command.
    const bool failed = error && error->code != Code::not_recorded;
    report.targets.push_back(failed ? Target{.errors = {std::move(*error)}} : Target{});
  }
}

std::uint64_t count_servos(const Findings& findings) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(findings.nodes, [](const fleet::Finding& node) {
        return node.servo.is_servo && !node.is_offline;
      }));
}

/// Errors that make a scan fail: conflicts, too few servos, no nodes. `listed`: the selection of
/// -n.
void judge(const ScanOptions& options, const Findings& findings,
           const std::optional<std::string>& listed, Report& report) {
  const std::uint64_t servos = count_servos(findings);
  for (const Conflict& conflict : findings.conflicts) {
    const bool of_one_id = conflict.nodes.size() == 1;
    report.fail({conflict.code, conflict.text, conflict.hint,
                 of_one_id ? std::optional(conflict.nodes.front().value()) : std::nullopt});
  }
  const auto& members = findings.roster->members();
  const bool somebody = std::ranges::any_of(
      members, [&](const auto& member) { return findings.roster->heard(member.first); });
  const bool may_be_shared = !findings.roster->doubled().empty(); // the wanted node
  if (findings.nodes.empty() && somebody && !may_be_shared) {
    report.fail({Code::not_found,
                 say<texts::nothing_matches_list>(report.interface, printable(listed.value_or(""))),
                 fleet::not_found_hint(*findings.roster), std::nullopt});
  } else if (findings.nodes.empty() && !somebody) {
    report.fail({Code::not_found, say<texts::nobody_there>(report.interface),
                 findings.roster->pending().empty() ? say<texts::nobody_there_hint>()
                                                    : fleet::not_found_hint(*findings.roster),
                 std::nullopt});
  } else if (options.expect && servos < *options.expect) {
    report.fail({Code::not_found, say<texts::expected_more>(servos, *options.expect),
                 say<texts::expected_more_hint>(), std::nullopt});
  }
}

Report execute(const ScanOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  const auto targets = context.targets();
  if (!targets) {
    report.fail(targets.error());
    return report;
  }
  if (auto session = context.open(fleet::Session::Hearing::all); !session) {
    report.fail(session.error());
    return report;
  }
  report.interface = context.session().interface();

  fleet::Discovery discovery(context.session(), **profiles, context.identification());
  const Time begin = context.session().now();
  const fleet::Ticker ticker(context.session(), std::chrono::seconds(2), [&] {
    context.reporter().progress(say<texts::progress_scan>(
        whole_seconds(context.session().now() - begin), whole_seconds(options.listen),
        context.session().roster().members().size()));
  });
  const auto found = discovery.find_all(options.listen);
  const auto findings = std::make_shared<Findings>(
      fleet::gather(context.session().roster(), *targets, **profiles,
                    fleet::heard_until(context.session()), discovery.gone()));
  take_failures(discovery, *findings, report);
  if (const auto ambiguous = targets->ambiguity(context.session().roster(), **profiles);
      found && ambiguous) {
    report.fail(*ambiguous);
  }
  report.counts = {{"servos", count_servos(*findings)}};
  report.count_targets(findings->nodes.size());
  if (found) {
    judge(options, *findings, context.shared().nodes, report);
  } else {
    context.broken(found.error(), report);
  }
  report.json = [findings](JsonWriter& json) { write_json(json, *findings); };
  report.csv = [findings] { return csv(*findings); };
  report.text = [findings](const Page& page) { return text(*findings, page); };
  return report;
}

} // namespace

constinit const Command commands::scan{
    .name = "scan",
    .traits = {.tables = true, .session = true, .recordings = true},
    .help = {"find every node and identify BLA servos", "全ノードを検索し、BLA サーボを識別"},
    .options = scan_options,
    .action = action<ScanOptions, execute>,
};

} // namespace blactl::cli
