// What happens to servos, and what other nodes do, just at the k-th frame of a command.

#include "campaign.hpp"
#include "chance.hpp"
#include "judge.hpp"
#include "sweep.hpp"
#include "told.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <set>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr std::int64_t first_servo = 240900001;
constexpr const char* much_later = "1000s";

/// Adds it to a scenario, at this time.
using AddAt = std::function<void(json& scenario, const std::string& at)>;

struct Happening {
  std::string name;
  AddAt add;
  bool is_over = true; ///< with the command: another node's order may have taken the servo's IDs
  bool is_undoable = false;  ///< whatever becomes of the command, `undo` puts the servos back
  bool is_made_good = false; ///< while RAM is written
};

AddAt event(const char* happens) {
  return [happens](json& scenario, const std::string& at) {
    scenario["events"].push_back({{"at", at}, {"servo", first_servo}, {"happens", happens}});
  };
}

/// `to`: a node ID; 0: that of the first servo as it begins.
AddAt order(json what, int to = 0) {
  return [what = std::move(what), to](json& scenario, const std::string& at) {
    json one = what;
    one["at"] = at;
    one["to"] = to != 0 ? to : std::max<int>(1, scenario["servos"][0]["node_id"]);
    scenario["foreign"].push_back(
        {{"kind", "node"}, {"node_id", 91}, {"orders", json::array({one})}});
  };
}

AddAt node(json what) {
  return [what = std::move(what)](json& scenario, const std::string& at) {
    json one = what;
    one.update({{"kind", "node"}, {"node_id", 91}, {"begins", at}});
    scenario["foreign"].push_back(one);
  };
}

AddAt comes(int node_id) {
  return [node_id](json& scenario, const std::string& at) {
    scenario["foreign"].push_back({{"kind", "node"}, {"node_id", node_id}, {"joins", at}});
  };
}

const std::vector<Happening>& happenings() {
  static const std::vector<Happening> all{
      {.name = "restart", .add = event("watchdog_error"), .is_made_good = true},
      {"restart without ROM", event("rom_error")},
      {"power off", event("power_off")},
      {"other writes", order({{"order", "write"}, {"address", 0x38}, {"value", 450}}), false},
      {"other writes to 125", order({{"order", "write"}, {"address", 0x38}, {"value", 450}}, 125),
       false},
      {"other writes the same", order({{"order", "write"}, {"address", 0x22}, {"value", 1}}),
       false},
      {.name = "other writes what it was judged by",
       .add = order({{"order", "write"}, {"address", 0x3F}, {"value", 20}}),
       .is_over = false},
      {.name = "other gives servo ID 7",
       .add = order({{"order", "write"}, {"address", 0x45}, {"value", 7}}),
       .is_over = false},
      {"other saves", order({{"order", "save"}}), false, true},
      {"other erases", order({{"order", "erase"}}), false},
      {"other restarts", order({{"order", "restart"}}), false},
      {"armed", node({{"armed", true}})},
      {"node comes to 30", comes(30), false},
      {"node comes to 11", comes(11), false},
      {"driven", node({{"commands", {{"servo_ids", json::array({255})}, {"rate", 50}}}})},
  };
  return all;
}

/// Just before each frame of the command, where nothing happens.
std::vector<Time> moments_of(const Record& record) {
  constexpr Duration before = 50us;
  std::set<Time> times;
  for (const OnWire& frame : record.frames()) {
    times.insert(frame.at - before);
  }
  return {times.begin(), times.end()};
}

/// Every n-th of them, and more of those close to what changes a servo, and after the last change,
/// where its end is judged.
std::vector<Time> chosen(const std::vector<Time>& moments, const Record& record, std::size_t n) {
  constexpr Duration close = 5ms;
  constexpr std::size_t denser = 8;
  const auto changes = record.changes();
  std::vector<Time> those;
  std::size_t passed = 0;
  for (const Time moment : moments) {
    const bool is_close = std::ranges::any_of(changes, [&](const OnWire& change) {
      return moment > change.at - close && moment < change.at + close;
    });
    const bool is_late = !changes.empty() && moment > changes.back().at;
    passed += is_close || is_late ? denser : 1;
    if (passed >= n) {
      those.push_back(moment);
      passed = 0;
    }
  }
  return those;
}

} // namespace

void Sweep::play_moments(const Case& one) {
  for (const Happening& happening : happenings()) {
    if (!options_.only.empty() && options_.only != happening.name) {
      continue;
    }
    const auto with = [&](const std::string& at) {
      Episode episode = episode_of(one);
      episode.faults.insert(happening.name);
      happening.add(episode.scenario, at);
      return episode;
    };
    Swept& swept = swept_[{one.name, happening.name}];
    std::vector<Time> moments;
    Time first_request{}, first_change{}, last_change{};
    {
      const Folder folder(folder_);
      const Episode quiet = with(much_later);
      World world(quiet.scenario, folder_);
      const Record record = begin(world, quiet, one, {}).outcome.record;
      moments = moments_of(record);
      swept.places = moments.size();
      moments = chosen(moments, record, options_.step);
      const auto asked = std::ranges::find_if(record.frames(), &OnWire::is_request);
      first_request = asked != record.frames().end() ? asked->at : first_request;
      if (const auto changes = record.changes(); !changes.empty()) {
        first_change = changes.front().at;
        last_change = changes.back().at;
      }
    }
    const bool is_made_good = one.is_written_again && happening.is_made_good;
    for (const Time moment : moments) {
      if (is_own_turn() && !is_over()) {
        const std::string at = fmt::format("{}us", (moment - Time{}).count());
        play_moment(one, with(at),
                    {.what = fmt::format("{} at {}", happening.name, at),
                     .must_converge = happening.is_over && one.is_repeatable,
                     .is_undone = happening.is_undoable && one.is_undoable,
                     .must_end_well = is_made_good && moment > first_change && moment < last_change,
                     .is_last = happening.name == one.ended_by && moment > first_request
                                    ? std::optional(moment)
                                    : std::nullopt},
                    swept);
      }
    }
  }
}

void Sweep::play_moment(const Case& one, const Episode& episode, const Moment& moment,
                        Swept& swept) {
  options_.begins();
  const Folder folder(folder_);
  World world(episode.scenario, folder_);
  const Step step = begin(world, episode, one, {});
  judged(one, moment.what, step, swept, [&] {
    judge(step);
    require(!moment.must_end_well || step.outcome.status == 0,
            "a restart while it writes is not made good");
    require(!moment.is_last || std::ranges::none_of(step.outcome.record.changes(),
                                                    [&](const OnWire& change) {
                                                      return change.at >
                                                             *moment.is_last + on_its_way;
                                                    }),
            "it was sent although what it was judged by is another now");
    const bool has_changed = !step.outcome.record.changes().empty();
    const bool is_undone_later = moment.is_undone_later && has_no_trials(step.before);
    if (has_changed && (moment.is_undone || is_undone_later)) {
      world.pass(4s);
      if (is_undone_later) {
        world.repair();
      }
      check_undo(world, step);
      if (one.command.broken != 0) { // its file names the new servo, as before the undo
        return;
      }
    }
    if (!moment.must_converge) {
      return;
    }
    world.pass(4s);
    world.repair();
    const Episode calm = calmed(episode);
    const Step again = take_step(world, calm, one.command);
    judge(again);
    require(again.outcome.status == 0, "does not converge: " + again.outcome.err);
  });
}

} // namespace blactl::campaign
