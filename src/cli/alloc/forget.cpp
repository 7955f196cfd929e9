// blactl alloc --forget: units leave the allocation table.

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/change/table_entries.hpp"
#include "blactl/fleet/change/wanted_ids.hpp"

#include "cli/alloc/actions.hpp"
#include "cli/alloc/texts.hpp"
#include "cli/confirm.hpp"
#include "cli/stores.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::UniqueId;
using state::AllocationEntry;
using state::AllocationStore;
using Entries = std::vector<AllocationEntry>;

/// By unique IDs and their beginnings, which need no bus, and by what only the bus knows.
struct Forgotten {
  bool all = false, absent = false;
  std::vector<std::string> beginnings{};
  std::vector<fleet::WantedId> others{};

  [[nodiscard]] bool need_bus() const { return absent || !others.empty(); }

  [[nodiscard]] bool need_agreement() const { return absent || all; }
};

Forgotten parse(const std::vector<std::string>& texts, Report& report) {
  using Key = fleet::Selector::Key;
  Forgotten forgotten;
  for (const std::string& text : texts) {
    if (text == "all" || text == "absent") {
      (text == "all" ? forgotten.all : forgotten.absent) = true;
      continue;
    }
    auto whom = parse_unit(text);
    if (!whom) {
      report.fail(std::move(whom.error()));
    } else if (!whom->selectors.empty() && whom->selectors.front().key == Key::unique_id) {
      forgotten.beginnings.push_back(whom->selectors.front().value);
    } else {
      forgotten.others.push_back({.whom = std::move(*whom), .node_id = {}, .text = text});
    }
  }
  return forgotten;
}

/// One run.
class Forget {
 public:
  Forget(Forgotten what, Context& context, Report& report)
      : what_(std::move(what)), context_(context), report_(report) {}

  void run();

 private:
  [[nodiscard]] bool look_around();
  void find(const Entries& entries);
  void find_by_beginning(const std::string& digits, const Entries& entries);
  void mean(const UniqueId& unit, const Entries& entries);
  void drop(AllocationStore& store);

  Forgotten what_;
  Context& context_;
  Report& report_;
  std::set<UniqueId> meant_;
};

bool Forget::look_around() {
  const auto profiles = context_.profiles();
  const auto session = profiles ? context_.open(fleet::Session::Hearing::all)
                                : Result<fleet::Session*>(std::unexpected(profiles.error()));
  if (!session) {
    report_.fail(session.error());
    return false;
  }
  report_.interface = context_.session().interface();
  fleet::Discovery discovery(context_.session(), context_.known(), context_.identification());
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    context_.broken(found.error(), report_);
    return false;
  }
  return true;
}

void Forget::mean(const UniqueId& unit, const Entries& entries) {
  if (std::ranges::find(entries, unit, &AllocationEntry::unique_id) != entries.end()) {
    meant_.insert(unit);
  } else {
    report_.fail_target({Code::not_found, say<texts::alloc_not_in_table>(hex(unit)),
                         say<texts::alloc_not_in_table_hint>(), std::nullopt});
  }
}

void Forget::find_by_beginning(const std::string& digits, const Entries& entries) {
  std::set<UniqueId> units;
  for (const AllocationEntry& entry : entries) {
    if (hex(entry.unique_id).starts_with(digits)) {
      units.insert(entry.unique_id);
    }
  }
  if (units.empty()) {
    report_.fail_target({Code::not_found, say<texts::alloc_not_in_table>(digits),
                         say<texts::alloc_not_in_table_hint>(), std::nullopt});
  } else if (units.size() > 1) {
    report_.fail_target({Code::usage, say<texts::alloc_several_begin_so>(digits, units.size()),
                         say<texts::alloc_not_in_table_hint>(), std::nullopt});
  } else {
    meant_.merge(units);
  }
}

void Forget::find(const Entries& entries) {
  for (const std::string& digits : what_.beginnings) {
    find_by_beginning(digits, entries);
  }
  for (const fleet::WantedId& other : what_.others) {
    const auto unit = fleet::unit_meant(other, context_.session().roster(), context_.known());
    if (unit) {
      mean(*unit, entries);
    } else {
      report_.fail_target(unit.error());
    }
  }
  for (const AllocationEntry& entry : entries) {
    const bool is_absent =
        what_.absent && !fleet::may_be_on_bus(context_.session().roster(), entry);
    if (what_.all || is_absent) {
      meant_.insert(entry.unique_id);
    }
  }
}

void Forget::drop(AllocationStore& store) {
  std::string out;
  for (const UniqueId& unit : meant_) {
    const auto forgotten = store.forget(unit);
    if (!forgotten) {
      report_.fail(forgotten.error());
      break;
    }
    report_.targets.emplace_back();
    out += say<texts::alloc_forgotten>(hex(unit));
  }
  report_.text = [out = std::move(out)](const Page& /*page*/) { return out; };
}

void Forget::run() {
  if (what_.need_bus() && !look_around()) {
    return;
  }
  auto store = open_allocations(context_.shared().interface, AllocationStore::Access::write);
  const auto entries = store ? store->entries() : Result<Entries>(std::unexpected(store.error()));
  if (!entries) {
    report_.fail(entries.error());
    return;
  }
  find(*entries);
  if (what_.need_agreement() && !meant_.empty()) {
    const std::string question = what_.all
                                     ? say<texts::alloc_forget_all_question>(meant_.size())
                                     : say<texts::alloc_forget_absent_question>(meant_.size());
    if (auto agreed = confirm(question, context_); !agreed) {
      report_.fail(std::move(agreed.error()));
      return;
    }
  }
  drop(*store);
  report_.count_targets();
}

} // namespace

Report forget_units(const std::vector<std::string>& units, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  Forgotten what = parse(units, report);
  if (report.errors.empty()) {
    Forget(std::move(what), context, report).run();
  }
  return report;
}

} // namespace blactl::cli
