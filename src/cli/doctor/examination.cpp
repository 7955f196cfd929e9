#include "cli/doctor/examination.hpp"

#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/ticker.hpp"
#include "blactl/state/state_folder.hpp"

#include "cli/doctor/motion.hpp"
#include "cli/doctor/texts.hpp"
#include "cli/interface/meant_link.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/output/progress_view.hpp"
#include "cli/repeat_interface.hpp"
#include "cli/stores.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

namespace blactl::cli {
namespace {

using bla::Level;
using fleet::Diagnosis;

void add(fleet::Diagnoses more, Examination& examination) {
  std::ranges::move(more, std::back_inserter(examination.diagnoses));
}

Diagnosis as_diagnosis(const Error& error, Level level) {
  // No file of a user is meant.
  const auto code = error.code == Code::bad_file ? "state_damaged" : name(error.code);
  return {.code = std::string(code), .level = level, .text = error.message, .fix = error.hint};
}

/// Checks that state can be stored on this machine, and that all of what is stored can be read.
void examine_state(const Context& context, Examination& examination) {
  const std::string_view interface = context.shared().interface;
  const std::string folder = stores_folder(interface);
  if (const auto writable = state::check_state_folder(folder); !writable) {
    examination.diagnoses.push_back(as_diagnosis(writable.error(), Level::warning));
  }
  if (names(interface, Behind::scenario)) {
    return; // it stores nothing
  }
  for (const Error& error : state::check_state_files(folder)) {
    examination.diagnoses.push_back(as_diagnosis(error, Level::failure));
  }
}

/// An adapter reports its status while it is open. It is asked last, when other nodes were heard.
Result<void> ask_status(Context& context) {
  constexpr Duration answer_time = std::chrono::milliseconds(250);
  can::Slcan* adapter = context.adapter();
  if (adapter == nullptr || !adapter->ask_status()) {
    return {};
  }
  const auto told = [adapter] { return adapter->answers().status.has_value(); };
  const auto lived = context.session().live_until(context.session().now() + answer_time, told);
  return lived ? Result<void>() : std::unexpected(lived.error());
}

void examine_bus(Duration time, Context& context, Examination& examination, Report& report) {
  fleet::Session& session = context.session();
  session.count(&examination.traffic);
  const auto targets = context.targets();
  if (!targets) {
    report.fail(targets.error());
    return;
  }
  fleet::Discovery discovery(session, context.known(), context.identification());
  const fleet::Ticker ticker(session, std::chrono::seconds(1), [&] {
    context.reporter().progress(say<texts::doctor_listens>(whole_seconds(time)));
  });
  auto found = discovery.find_all(time);
  if (found && fleet::awaits_status(session.roster(), examination.traffic)) {
    found = session.live_until(session.now() + std::chrono::milliseconds(2500));
  }
  auto findings = fleet::gather(session.roster(), *targets, context.known(),
                                fleet::heard_until(session), discovery.gone());
  const auto servos = found ? read_motion(context, findings, targets->given) : fleet::Snapshots{};
  if (servos.broken) {
    found = std::unexpected(*servos.broken);
  }
  if (targets->given && found) {
    examination.unjudged = unjudged_motions(servos, context, examination.traffic);
  }
  if (!found) {
    if (auto diagnosis = fleet::diagnose_end(found.error())) {
      examination.diagnoses.push_back(std::move(*diagnosis));
    } else {
      context.broken(found.error(), report);
    }
  } else {
    if (!context.is_fleet_file()) {
      add(fleet::diagnose_traffic(examination.traffic, session.silence()), examination);
    }
    for (Error& error : discovery.absent(*targets)) {
      report.fail(std::move(error));
    }
    if (const auto asked = ask_status(context); !asked) {
      context.broken(asked.error(), report);
    }
  }
  auto ends = discovery.identifications();
  if (!found) { // a node whose identification was cut short is not at fault
    std::erase_if(ends, [](const std::optional<Error>& error) {
      return error && error->code == Code::interrupted;
    });
  }
  add(fleet::diagnose_identifications(findings, ends), examination);
  const auto look = targets->given ? fleet::MotionLook::named : fleet::MotionLook::commanded;
  add(fleet::diagnose_nodes(findings, examination.traffic, servos.servos, look), examination);
  add(diagnose_motions(servos, targets->given, context, examination.traffic), examination);
  examination.are_named = targets->given;
  examination.nodes = std::move(findings);
  session.count(nullptr);
}

} // namespace

void examine(Duration time, Context& context, Examination& examination, Report& report) {
  examination.interface = printable(context.shared().interface);
  context.inquire();
  const auto opened = context.open(fleet::Session::Hearing::all);
  if (opened) {
    report.interface = examination.interface = context.session().interface();
    examine_bus(time, context, examination, report);
  } else {
    report.fail(opened.error());
  }
  if (const can::Slcan* adapter = context.adapter()) {
    examination.adapter = adapter->answers();
    add(fleet::diagnose_adapter(adapter->answers(), adapter->speech()), examination);
  }
  // only now has the controller had time to count errors
  examination.link = meant_link(context.shared().interface);
  if (examination.link) {
    add(fleet::diagnose_link(*examination.link), examination);
  }
  examine_state(context, examination);
  for (Diagnosis& diagnosis : examination.diagnoses) {
    repeat_interface(diagnosis.fix, context.shared());
  }
  std::ranges::stable_sort(examination.diagnoses, std::greater(), &Diagnosis::level);
  examination.is_whole = report.errors.empty();
}

} // namespace blactl::cli
