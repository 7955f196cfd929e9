// blactl wait: until the servos are on the bus and operational.

#include "blactl/fleet/identification.hpp"
#include "blactl/fleet/texts.hpp"

#include "cli/commands.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/output/node_head.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <list>
#include <memory>

namespace blactl::cli {
namespace {

using fleet::Member;

bool is_operational(const Member& member) {
  return member.status && member.status->mode == dronecan::Mode::operational;
}

/// Identifies every servo that appears, until those that are meant are there.
class Wait {
 public:
  Wait(const fleet::Targets& targets, const bla::Profiles& profiles, Context& context)
      : targets_(targets), profiles_(profiles), context_(context) {}

  Result<bool> run(Duration wait) {
    fleet::Session& session = context_.session();
    const Time begin = session.now();
    // Without -n all that live must have had the time to be heard.
    const Time heard = targets_.need_search() ? begin + servo_search_time : begin;
    session.roster().on_new_unit([this](Member& member) { identify(member); });
    auto there = session.live_until(begin + wait, [&] {
      return session.now() >= heard && session.node().jobs() == 0 && all_there();
    });
    session.roster().on_new_unit({});
    if (there && !*there) {
      // What is being asked is not waited for any longer than it takes.
      if (auto ran = session.run(); !ran) {
        return std::unexpected(ran.error());
      }
    }
    return there;
  }

  /// Those that are meant and were heard.
  [[nodiscard]] std::vector<const Member*> meant() const {
    std::vector<const Member*> members;
    for (const auto& [id, member] : context_.session().roster().members()) {
      if (targets_.mean(member, profiles_) && context_.session().roster().heard(id)) {
        members.push_back(&member);
      }
    }
    return members;
  }

  [[nodiscard]] bool all_there() const {
    const auto members = meant();
    const auto& roster = context_.session().roster();
    const bool ids_heard =
        std::ranges::all_of(targets_.ids, [&](dronecan::NodeId id) { return roster.heard(id); });
    const bool selectors_met =
        std::ranges::all_of(targets_.selectors, [&](const fleet::Selector& selector) {
          return std::ranges::any_of(
              members, [&](const Member* member) { return selector.matches(*member, profiles_); });
        });
    return !members.empty() && ids_heard && selectors_met &&
           std::ranges::all_of(members, [](const Member* member) {
             return member->is_known() && is_operational(*member);
           });
  }

 private:
  void identify(Member& member) {
    jobs_.push_back(std::make_unique<fleet::IdentifyJob>(context_.session().roster(), member,
                                                         profiles_, context_.identification()));
    context_.session().start(*jobs_.back());
  }

  const fleet::Targets& targets_;
  const bla::Profiles& profiles_;
  Context& context_;
  std::list<std::unique_ptr<fleet::IdentifyJob>> jobs_;
};

/// One line a target: who is there, and who is not.
struct Arrival {
  Member member;
  bool is_there = false;
  Duration after{};
};

void write_json(JsonWriter& json, const std::vector<Arrival>& arrivals) {
  json.key("nodes");
  json.begin_array();
  for (const Arrival& arrival : arrivals) {
    json.begin_object();
    write_head(json, arrival.member);
    json.member("status", arrival.is_there ? "done" : "failed");
    json.member("node_id_after", arrival.member.id.value());
    json.key("duration_s");
    json.number(fmt::format("{:.3f}", std::chrono::duration<double>(arrival.after).count()));
    json.end_object();
  }
  json.end_array();
}

std::string text(const std::vector<Arrival>& arrivals) {
  std::string out;
  for (const Arrival& arrival : arrivals) {
    out += head_line(arrival.member) + "  " +
           (arrival.is_there ? say<texts::wait_there>() : say<texts::wait_not_ready>()) + '\n';
  }
  return out;
}

void judge(const Wait& wait, const fleet::Targets& targets, Duration time, Context& context,
           Report& report) {
  const auto& roster = context.session().roster();
  const auto seconds = fmt::format("{}", std::chrono::duration<double>(time).count());
  for (const Member* member : wait.meant()) {
    const bool ready = member->is_known() && is_operational(*member);
    report.statuses.push_back(ready ? 0 : exit_status(Code::timeout));
    if (!ready) {
      const std::uint8_t id = member->id.value();
      report.fail(
          member->is_known()
              ? Error{Code::timeout, say<texts::wait_not_operational>(id, seconds),
                      say<texts::opcode_refused_hint>(id), id}
              : Error{Code::timeout, say<texts::node_mute>(id), say<texts::no_answer_hint>(), id});
    }
  }
  const auto missing = [&](Error error) {
    report.statuses.push_back(exit_status(error.code));
    report.fail(std::move(error));
  };
  for (const dronecan::NodeId id : targets.ids) {
    if (!roster.heard(id)) {
      missing({Code::not_found, say<texts::wait_not_heard>(id.value(), seconds),
               say<texts::node_not_found_hint>(), id.value()});
    }
  }
  const auto profiles = context.profiles();
  for (const fleet::Selector& selector : targets.selectors) {
    if (std::ranges::none_of(wait.meant(), [&](const Member* member) {
          return selector.matches(*member, **profiles);
        })) {
      missing({Code::not_found, say<texts::nothing_matches>(printable(selector.text)),
               say<texts::node_not_found_hint>(), std::nullopt});
    }
  }
  if (report.statuses.empty()) {
    report.fail({Code::not_found, say<texts::no_servo_found>(), say<texts::no_servo_found_hint>(),
                 std::nullopt});
  }
}

} // namespace

Report execute(const WaitOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  const auto targets = context.targets();
  if (!profiles || !targets) {
    report.fail(profiles ? targets.error() : profiles.error());
    return report;
  }
  if (context.shared().listen_only) {
    report.fail({Code::usage, say<texts::listen_only_refused>("wait"),
                 say<texts::listen_only_hint>(), std::nullopt});
    return report;
  }
  if (auto refused = takes_no_frames(context.shared().interface)) {
    report.fail(std::move(*refused)); // what is recorded will not come any more
    return report;
  }
  if (auto session = context.open(fleet::Session::Hearing::answers); !session) {
    report.fail(session.error());
    return report;
  }
  report.interface = context.session().interface();
  const Time begin = context.session().now();
  Wait wait(*targets, **profiles, context);
  const auto there = wait.run(options.wait);
  auto arrivals = std::make_shared<std::vector<Arrival>>();
  for (const Member* member : wait.meant()) {
    arrivals->push_back(
        {*member, member->is_known() && is_operational(*member), context.session().now() - begin});
  }
  if (!there) {
    context.broken(there.error(), report);
  } else if (!*there) {
    judge(wait, *targets, options.wait, context, report);
  }
  report.counts = {{"nodes", arrivals->size()}};
  report.json = [arrivals](JsonWriter& json) { write_json(json, *arrivals); };
  report.text = [arrivals] { return text(*arrivals); };
  return report;
}

} // namespace blactl::cli
