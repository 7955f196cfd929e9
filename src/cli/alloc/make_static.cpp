#include "cli/alloc/make_static.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/change/static_ids.hpp"

#include "cli/alloc/texts.hpp"
#include "cli/alloc/view.hpp"
#include "cli/texts.hpp"
#include "cli/writing_run.hpp"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

namespace blactl::cli {
namespace {

using dronecan::NodeId;
using fleet::StaticIds;
using fleet::UnitChange;
using state::AllocationStore;

/// One run. Each step may end it, with errors in the report.
class MakeStatic : WritingRun {
 public:
  MakeStatic(const AllocOptions& options, Context& context, AllocationStore& table, Report& report)
      : WritingRun(context, report), options_(options), table_(table) {}

  void run(std::vector<StaticIds::Wish> wishes) {
    wishes_ = std::move(wishes);
    if (!open("alloc --static", Recording::if_possible)) {
      return;
    }
    StaticIds ids(context_.session(), context_.known(), table_,
                  {.manner = manner(),
                   .while_driven = context_.shared().while_driven,
                   .stops_at_failure = true});
    if (find(ids) && prepare(ids) && confirm(ids)) {
      carry_out(ids);
    }
  }

 private:
  bool find(StaticIds& ids);
  bool wish_for(const StaticIds& ids, std::span<const NodeId> nodes);
  bool prepare(StaticIds& ids);
  bool confirm(StaticIds& ids);
  void carry_out(StaticIds& ids);
  void conclude(const UnitChange& unit);

  using WritingRun::stop;

  /// What ends a session ends the command; anything else is a refusal.
  bool stop(const std::vector<Error>& errors) {
    for (const Error& error : errors) {
      context_.signal() != 0 ? context_.broken(error, report_) : report_.fail(error);
    }
    return errors.empty();
  }

  const AllocOptions& options_;
  AllocationStore& table_;
  std::vector<StaticIds::Wish> wishes_;
};

/// The servos that are meant, and everybody else: whoever has an ID may stand in the way.
bool MakeStatic::find(StaticIds& ids) {
  const auto targets = context_.targets();
  if (!targets) {
    return stop(targets.error());
  }
  auto identification = context_.identification();
  identification.static_node_id = true;
  std::vector<NodeId> nodes;
  if (options_.assign.empty()) {
    auto selection = choose(*targets, identification);
    if (!selection || !stop(selection->errors)) {
      return false;
    }
    nodes = std::move(selection->ids);
  }
  fleet::Discovery discovery(context_.session(), context_.known(), identification);
  if (const auto found = discovery.find_all(fleet::bus_watch_time); !found) {
    return broken(found.error());
  }
  if (!hear()) {
    return false;
  }
  if (options_.assign.empty() && !wish_for(ids, nodes)) {
    return false;
  }
  if (const auto there = ids.let_in(wishes_); !there) {
    return broken(there.error());
  }
  return true;
}

bool MakeStatic::wish_for(const StaticIds& ids, std::span<const NodeId> nodes) {
  if (options_.id && nodes.size() != 1) {
    return stop({Code::usage, say<texts::alloc_several_for_id>(*options_.id, nodes.size()),
                 say<texts::alloc_several_for_id_hint>(), std::nullopt});
  }
  auto wishes = ids.as_they_are(nodes);
  if (!wishes) {
    return stop(wishes.error());
  }
  wishes_ = std::move(*wishes);
  if (options_.id) {
    wishes_.front().node_id = NodeId(static_cast<std::uint8_t>(*options_.id));
  }
  return true;
}

bool MakeStatic::prepare(StaticIds& ids) {
  if (!stop(ids.prepare(wishes_))) {
    return false;
  }
  for (const fleet::IdMove& move : ids.change().temporary()) {
    context_.reporter().note(say<texts::alloc_will_make_way>(move.from.value(), move.to.value()));
  }
  return true;
}

bool MakeStatic::confirm(StaticIds& ids) {
  tell_others();
  return WritingRun::confirm(ids.change().question());
}

void MakeStatic::carry_out(StaticIds& ids) {
  const Reporter& reporter = context_.reporter();
  reporter.note(say<texts::do_not_cut_supply>());
  const auto errors = ids.change().carry_out([&](const fleet::IdMove& move) {
    const UnixTime time(context_.session().wall());
    const auto printed = reporter.stream(reporter.format() == Format::json ? json_line(time, move)
                                                                           : text_line(time, move));
    if (!printed) {
      report_.fail(printed.error());
    }
  });
  tell_newcomers();
  (void)stop(errors);
  std::vector<dronecan::UniqueId> done;
  for (const UnitChange& unit : ids.change().units()) {
    conclude(unit);
    if (unit.is_done) {
      done.push_back(unit.unique_id);
    }
  }
  end_record(done);
  report_.counts = {{"made_static", done.size()}};
}

/// Servos whose turn did not come are as they were, and that is said.
void MakeStatic::conclude(const UnitChange& unit) {
  std::vector<Error> errors = unit.last ? unit.last->errors() : std::vector<Error>();
  if (!unit.is_done && errors.empty()) {
    errors.push_back({Code::state,
                      say<texts::alloc_not_begun>(hex(unit.unique_id), unit.now.value()),
                      say<texts::run_again_hint>(), unit.now.value()});
  }
  report_.targets.push_back({.errors = std::move(errors)});
}

} // namespace

Report make_static(const AllocOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface), .is_stream = true};
  auto wishes = parse_wishes(options.assign);
  if (!wishes) {
    std::ranges::copy(wishes.error(), std::back_inserter(report.errors));
  }
  if (const auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
  }
  if (!report.errors.empty()) {
    return report;
  }
  auto table = context.allocations(AllocationStore::Access::write);
  if (!table) {
    report.fail(table.error());
    return report;
  }
  MakeStatic(options, context, *table, report).run(std::move(*wishes));
  report.count_targets();
  return report;
}

} // namespace blactl::cli
