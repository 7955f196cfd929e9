// blactl wait: until the servos are on the bus and operational.

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/ticker.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

struct WaitOptions {
  Duration wait = std::chrono::seconds(10);
};

constexpr Option wait_options[]{
    {.name = "--wait",
     .value = "SEC",
     .kind = Kind::seconds,
     .seconds = {std::chrono::milliseconds(1), std::chrono::hours(24)},
     .help = {"how long to wait (default 10)", "待つ時間 (省略時 10)"},
     .store = into<&WaitOptions::wait>},
};

using fleet::Arrival;

void write_json(JsonWriter& json, const std::vector<Arrival>& arrivals, Duration after) {
  json.objects("nodes", arrivals, [&](const Arrival& arrival) {
    write_head(json, arrival.servo);
    json.member("status", arrival.is_there ? "done" : "failed");
    json.member("node_id_after", arrival.servo.id.value());
    json.key("duration_s");
    json.number(fmt::format("{:.3f}", std::chrono::duration<double>(after).count()));
  });
}

std::string text(const std::vector<Arrival>& arrivals, const Page& page) {
  std::string out;
  for (const Arrival& arrival : arrivals) {
    out += head_line(arrival.servo) + "  " +
           (arrival.is_there ? page.paint(Tone::good, say<texts::wait_there>())
                             : page.paint(Tone::bad, say<texts::wait_not_ready>())) +
           '\n';
  }
  return out;
}

/// The reason why waiting is pointless: no frame may be sent, or a recording has no later frames.
std::optional<Error> refuse(const Context& context) {
  if (context.shared().listen_only) {
    return Error{Code::usage, say<texts::listen_only_refused>("wait"),
                 say<texts::listen_only_hint>(), std::nullopt};
  }
  return takes_no_frames(context.shared().interface);
}

Report execute(const WaitOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  const auto profiles = context.profiles();
  const auto targets = context.targets();
  if (!profiles || !targets) {
    report.fail(profiles ? targets.error() : profiles.error());
    return report;
  }
  if (auto refused = refuse(context)) {
    report.fail(std::move(*refused));
    return report;
  }
  if (auto session = context.open(fleet::Session::Hearing::answers); !session) {
    report.fail(session.error());
    return report;
  }
  report.interface = context.session().interface();
  const Time begin = context.session().now();
  fleet::Discovery discovery(context.session(), **profiles, context.identification());
  const fleet::Ticker ticker(context.session(), std::chrono::seconds(1), [&] {
    const auto there = discovery.those_there(*targets);
    context.reporter().progress(say<texts::progress_wait>(
        whole_seconds(context.session().now() - begin), whole_seconds(options.wait),
        std::ranges::count_if(there, &Arrival::is_there)));
  });
  auto waited = discovery.wait_for(*targets, options.wait);
  if (waited.broken) {
    context.broken(*waited.broken, report);
  }
  const Duration after = context.session().now() - begin;
  for (Error& error : waited.errors) {
    report.fail_target(std::move(error));
  }
  for (const Arrival& arrival : waited.servos) {
    if (arrival.is_there) {
      report.targets.emplace_back();
    }
  }
  const auto arrivals = std::make_shared<std::vector<Arrival>>(std::move(waited.servos));
  report.count_targets();
  report.json = [arrivals, after](JsonWriter& json) { write_json(json, *arrivals, after); };
  report.text = [arrivals](const Page& page) { return text(*arrivals, page); };
  return report;
}

} // namespace

constinit const Command commands::wait{
    .name = "wait",
    .traits = {.session = true},
    .help = {"until the servos are there and operational",
             "サーボがバス上で動作状態になるまで待つ"},
    .options = wait_options,
    .action = action<WaitOptions, execute>,
};

} // namespace blactl::cli
