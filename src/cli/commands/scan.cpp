// blactl scan: who is on the bus.

#include "blactl/fleet/identification.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/commands.hpp"
#include "cli/scan_findings.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::Member;

/// IDs that are asked at a time, and how long for: 125 of them fit into the time of listening.
constexpr int probes_at_a_time = 8;
constexpr Duration probe_timeout = std::chrono::milliseconds(60);

/// Listens and asks. The jobs refer to each other's roster and end with this object.
class Search {
 public:
  Search(Context& context, const bla::Profiles& profiles) : context_(context), profiles_(profiles) {
    options_ = context.identification();
    options_.static_node_id = true;
  }

  Result<void> run(Duration listen) {
    fleet::Session& session = context_.session();
    if (!context_.shared().listen_only) {
      session.roster().on_new_unit([this](Member& member) { identify(member); });
      for (int i = 0; i < probes_at_a_time; ++i) {
        start(std::make_unique<fleet::ProbeJob>(session.roster(), cursor_, probe_timeout));
      }
    }
    if (auto lived = session.live_until(session.now() + listen); !lived) {
      return lived;
    }
    if (auto ran = session.run(); !ran) {
      return ran;
    }
    for (auto& [id, member] : session.roster().members()) {
      if (member.is_known() && member.is_servo) {
        start(std::make_unique<fleet::DoubleCheckJob>(session.roster(), member, options_.patience));
      }
    }
    return session.run();
  }

  /// The errors of the nodes that could not be identified, and how many nodes there are.
  void conclude(Report& report) const {
    for (const auto& job : identifications_) {
      const auto& error = job->identification().error();
      // Who was heard is all that a recording of others may hold: no failure of this command.
      const bool failed = error && error->code != Code::not_recorded;
      report.statuses.push_back(failed ? exit_status(error->code) : 0);
      if (failed) {
        report.fail(*error);
      }
    }
  }

 private:
  void identify(Member& member) {
    identifications_.push_back(std::make_unique<fleet::IdentifyJob>(context_.session().roster(),
                                                                    member, profiles_, options_));
    context_.session().start(*identifications_.back());
  }

  void start(std::unique_ptr<dronecan::Job> job) {
    jobs_.push_back(std::move(job));
    context_.session().start(*jobs_.back());
  }

  Context& context_;
  const bla::Profiles& profiles_;
  fleet::Identification::Options options_;
  std::uint8_t cursor_ = 0;
  std::vector<std::unique_ptr<fleet::IdentifyJob>> identifications_;
  std::vector<std::unique_ptr<dronecan::Job>> jobs_;
};

/// What makes a scan fail although it ran: conflicts, too few servos, nobody there.
/// `listed`: what -n said.
void judge(const ScanOptions& options, const Findings& findings,
           const std::optional<std::string>& listed, Report& report) {
  const auto servos = static_cast<std::uint64_t>(
      std::ranges::count_if(findings.nodes, [](const Member* member) { return member->is_servo; }));
  report.counts = {{"nodes", findings.nodes.size()}, {"servos", servos}};
  std::vector<Error> found;
  found.reserve(findings.conflicts.size() + 1);
  for (const Conflict& conflict : findings.conflicts) {
    found.push_back({conflict.code, conflict.text,
                     conflict.code == Code::duplicate_servo_id
                         ? say<texts::doubled_servo_id_hint>(conflict.nodes.back().value())
                         : say<texts::conflict_hint>(),
                     conflict.nodes.size() == 1 ? std::optional(conflict.nodes.front().value())
                                                : std::nullopt});
  }
  const auto& members = findings.roster->members();
  const bool somebody = std::ranges::any_of(
      members, [&](const auto& member) { return findings.roster->heard(member.first); });
  if (findings.nodes.empty() && somebody) {
    found.push_back(
        {Code::not_found,
         say<texts::nothing_matches_list>(report.interface, printable(listed.value_or(""))),
         say<texts::node_not_found_hint>(), std::nullopt});
  } else if (findings.nodes.empty()) {
    found.push_back({Code::not_found, say<texts::nobody_there>(report.interface),
                     say<texts::nobody_there_hint>(), std::nullopt});
  } else if (options.expect && servos < *options.expect) {
    found.push_back({Code::not_found, say<texts::expected_more>(servos, *options.expect),
                     say<texts::expected_more_hint>(), std::nullopt});
  }
  if (!found.empty()) {
    report.statuses.clear();
    report.errors.insert(report.errors.begin(), found.begin(), found.end());
  }
}

} // namespace

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

  Search search(context, **profiles);
  const auto ran = search.run(options.listen);
  search.conclude(report);
  auto findings =
      std::make_shared<Findings>(gather(context.session().roster(), *targets, **profiles));
  if (ran) {
    judge(options, *findings, context.shared().nodes, report);
  } else {
    context.broken(ran.error(), report);
  }
  report.json = [findings](JsonWriter& json) { write_json(json, *findings); };
  report.csv = [findings] { return csv(*findings); };
  report.text = [findings] { return text(*findings); };
  return report;
}

} // namespace blactl::cli
