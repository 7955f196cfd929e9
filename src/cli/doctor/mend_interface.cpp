#include "cli/doctor/mend_interface.hpp"

#include "blactl/can/link_setup.hpp"
#include "blactl/state/interface_lock.hpp"

#include "cli/confirm.hpp"
#include "cli/doctor/texts.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/interface/meant_link.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {
namespace {

using fleet::Diagnosis;

/// The present problems, and the command with the same effect.
std::string question(const fleet::Diagnoses& wrong, const can::LinkSetup& setup) {
  std::string text = say<texts::doctor_fix_question>(printable(setup.name));
  for (const Diagnosis& diagnosis : wrong) {
    text += "  " + diagnosis.text + '\n';
  }
  text += say<texts::doctor_fix_as>(can::command(setup));
  return setup.goes_down ? text + say<texts::doctor_fix_interrupts>(printable(setup.name)) : text;
}

/// Without the rights the user is not asked.
Result<void> mend(const fleet::Diagnoses& wrong, const can::LinkSetup& setup, Context& context) {
  auto lock =
      state::InterfaceLock::acquire(lock_place(setup.name), state::InterfaceLock::Right::write);
  if (!lock) {
    return std::unexpected(lock.error());
  }
  if (auto may = can::may_set_up(setup); !may) {
    return may;
  }
  if (auto agreed = confirm(question(wrong, setup), context); !agreed) {
    return agreed;
  }
  return can::set_up(setup);
}

} // namespace

void mend_interface(Context& context, Examination& examination, Report& report) {
  const std::string& named = context.shared().interface;
  const auto link = meant_link(named);
  if (!may_be_link(named)) {
    context.reporter().note(say<texts::doctor_fix_nowhere>(printable(named)));
  }
  const auto setup = link ? fleet::mending(*link) : can::LinkSetup();
  if (setup.is_empty()) {
    return;
  }
  const auto before = fleet::diagnose_setup(*link);
  if (auto done = mend(before, setup, context); !done) {
    report.fail(std::move(done.error()));
  }
  const auto now = meant_link(link->name);
  const auto left = now ? fleet::diagnose_setup(*now) : before;
  std::ranges::copy_if(
      before, std::back_inserter(examination.fixed), [&](const Diagnosis& diagnosis) {
        return std::ranges::find(left, diagnosis.code, &Diagnosis::code) == left.end();
      });
}

} // namespace blactl::cli
