// Who is on the bench of a station: servos that come, that stay, and that take the place of others.

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/discovery.hpp"
#include "blactl/fleet/change/allocation_service.hpp"
#include "blactl/fleet/change/let_in.hpp"
#include "blactl/fleet/line/line_record.hpp"
#include "blactl/fleet/line/station.hpp"

#include "fleet/line/absence_watch.hpp"
#include "fleet/line/presence.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace blactl::fleet {

using dronecan::NodeId;
using dronecan::UniqueId;

namespace {

using namespace std::chrono_literals;

/// How often a silent bus is looked at.
constexpr Duration look_period = 100ms;

/// A unit that was so often spoilt without having been off restarts by itself: it would never end.
constexpr unsigned most_spoilt_in_row = 3;

/// Who has not told by then who it is counts as another unit.
constexpr Duration longest_answer = 2s;

/// Whether a unit that has asked since then waits for its node ID now.
bool is_open(const Asking& asking, Time since, Time now) {
  return asking.last > asking.given && asking.last > now - request_period && asking.last > since;
}

} // namespace

/// Watches those that are there after the end of a visit, and asks whoever may be another unit.
class Station::Succession {
 public:
  /// The session outlives this.
  Succession(Session& session, Patience patience, const Visit& last)
      : session_(session), patience_(patience), unit_(last.unit), nodes_(last.nodes) {}

  /// From now on whoever asks for a node ID is lent one, and tells by that who it is.
  [[nodiscard]] Result<void> lend(const state::NodeIds& avoided) {
    if (lender_) {
      return {};
    }
    auto table = state::AllocationStore::unshared();
    if (!table) {
      return std::unexpected(table.error());
    }
    table_.emplace(std::move(*table));
    lender_.emplace(session_, *table_, AllocationService::Range{}, [](auto, const auto&) {});
    lender_->bus_is_known();
    lender_->avoid(avoided);
    return {};
  }

  /// Whether another unit has asked, and told all of its unique ID.
  [[nodiscard]] bool has_lent_to_another() const {
    return lender_ && std::ranges::any_of(lender_->units(),
                                          [this](const auto& unit) { return unit.first != unit_; });
  }

  /// Whether the last unit was heard since then, and may not be another one in its place.
  [[nodiscard]] bool has_last(Time since) const {
    return std::ranges::any_of(session_.roster().members(), [&](const auto& entry) {
      const auto& [id, member] = entry;
      const auto asked = asked_.find(id);
      return unit_ && member.is_unit(*unit_) && member.last_heard > since &&
             !session_.roster().is_doubled(id) &&
             (asked == asked_.end() || member.info_at >= asked->second);
    });
  }

  /// Whether it is there now, by its periods.
  [[nodiscard]] bool has_last() const {
    const bool sends_actuator_status =
        std::ranges::any_of(session_.roster().members(), [&](const auto& entry) {
          return unit_ && entry.second.is_unit(*unit_) && entry.second.sends_actuator_status();
        });
    return has_last(session_.now() - (sends_actuator_status ? away_time : bus_watch_time));
  }

  ~Succession() {
    for (UnitJob& job : jobs_) {
      session_.cancel(job);
    }
  }

  Succession(const Succession&) = delete;
  Succession& operator=(const Succession&) = delete;

  /// Whether one of these is another unit, or does not tell.
  [[nodiscard]] bool has_begun(const std::vector<NodeId>& servos) {
    return std::ranges::any_of(
        servos, [this](NodeId id) { return is_other(session_.roster().member(id)); });
  }

 private:
  /// A servo that stays on its supply while the cable is plugged into another one shows that by its
  /// silence alone.
  [[nodiscard]] bool is_other(const Member& member) {
    const auto [node, is_new] = nodes_.try_emplace(member.id);
    const bool was_away = unit_ && node->second.back_at != member.back_at;
    if (is_new || node->second.boots != member.boots || was_away) {
      node->second = {member.boots, member.back_at};
      asked_.insert_or_assign(member.id, session_.now());
      session_.start(jobs_.emplace_back(session_.records(), member.id, patience_));
    }
    const auto asked = asked_.find(member.id);
    if (session_.roster().is_doubled(member.id)) {
      return true;
    }
    if (asked == asked_.end()) {
      return false;
    }
    const bool has_told =
        member.info && member.info_boot == member.boots && member.info_at >= asked->second;
    return has_told ? member.info->unique_id != unit_
                    : session_.now() - asked->second > longest_answer;
  }

  Session& session_;
  Patience patience_;
  std::optional<UniqueId> unit_;
  std::map<NodeId, Visit::Node> nodes_;
  std::map<NodeId, Time> asked_;
  std::list<UnitJob> jobs_;
  std::optional<state::AllocationStore> table_;
  std::optional<AllocationService> lender_; ///< empty: nobody has asked
};

std::vector<NodeId> Station::servos_there() const {
  std::vector<NodeId> ids;
  for (const auto& [id, member] : session_.roster().members()) {
    if (may_be_bla_servo(member) && member.last_heard > session_.now() - away_time) {
      ids.push_back(id);
    }
  }
  return ids;
}

/// Whether a unit asks for a node ID now, and has since then: one that has left has asked before.
bool Station::is_asked(Time since) const {
  return std::ranges::any_of(session_.roster().requests(), [&](const auto& request) {
    return is_open(request.second, since, session_.now());
  });
}

/// A request tells the first bytes of a unit, and many begin alike: it may be of the last unit if
/// that has no static node ID, and was not heard under a node ID since.
bool Station::is_other_asking() const {
  const auto is_there_since = [this](Time asked) {
    return std::ranges::any_of(session_.roster().members(), [&](const auto& entry) {
      return entry.second.is_unit(*last_.unit) && entry.second.last_heard > asked;
    });
  };
  return std::ranges::any_of(session_.roster().requests(), [&](const auto& request) {
    const auto& [prefix, asking] = request;
    const bool may_be_last = last_.unit && last_.may_ask &&
                             dronecan::begins_with(*last_.unit, prefix) &&
                             !is_there_since(asking.last);
    return is_open(asking, last_.end, session_.now()) && !may_be_last;
  });
}

bool Station::is_any_doubled(const std::vector<NodeId>& ids) const {
  return std::ranges::any_of(ids, [this](NodeId id) { return session_.roster().is_doubled(id); });
}

bool Station::is_servo_there() const {
  return is_asked() || !servos_there().empty();
}

/// The node IDs that no unit is lent.
state::NodeIds Station::beside_bench() const {
  state::NodeIds others;
  for (std::uint8_t id = 1; id <= NodeId::max; ++id) {
    others.set(id, NodeId(id) < options_.first_bench_id || NodeId(id) > options_.last_bench_id);
  }
  return others;
}

/// Bench IDs are borrowed: no table keeps them.
Result<void> Station::let_in() {
  auto bench = state::AllocationStore::unshared();
  if (!bench) {
    return std::unexpected(bench.error());
  }
  const auto asked = fleet::let_in(session_, *bench, std::nullopt, beside_bench());
  return asked ? Result<void>() : std::unexpected(asked.error());
}

void Station::go_to(StationStage stage) {
  stage_ = stage;
  entered_(stage, std::nullopt);
}

/// What was heard before the visit is forgotten.
std::optional<std::int64_t> Station::serial_number() const {
  std::set<std::int64_t> numbers;
  for (const auto& [id, member] : session_.roster().members()) {
    if (const auto number = member.identity.readings().serial_number) {
      numbers.insert(*number);
    }
  }
  return numbers.size() == 1 ? std::optional(*numbers.begin()) : std::nullopt;
}

/// From now on the hook is told, too, that the servo has gone, and that it is back.
void Station::watch_absence() {
  watch_ = std::make_unique<AbsenceWatch>(session_, [this](bool is_away) {
    is_away ? entered_(StationStage::gone, serial_number()) : entered_(stage_, std::nullopt);
  });
}

/// While the last one is waited for to be taken off.
void Station::show_bench(bool is_last_there, bool is_occupied) {
  const auto stage = is_last_there ? StationStage::take_off
                     : is_occupied ? StationStage::other
                                   : StationStage::left;
  if (stage != stage_) {
    go_to(stage);
  }
}

Result<std::optional<Station::Arrival>> Station::wait_for_servo(Time deadline) {
  go_to(StationStage::waiting);
  for (;;) {
    const auto came = session_.live_until(deadline, [this] { return is_servo_there(); });
    if (!came || !*came) {
      return came ? Result<std::optional<Arrival>>() : std::unexpected(came.error());
    }
    go_to(StationStage::recognised);
    watch_absence();
    Arrival arrival{
        .has_asked = is_asked() || last_.has_let_in, .at = session_.now(), .wall = session_.wall()};
    // what was heard until now may be of another unit on the same node ID, or of an allocator that
    // was killed, perhaps the last run of this station, and answers nobody
    session_.records().forget_gone(session_.now() + Duration(1));
    Discovery discovery(session_, profiles_, options_.manner.identification);
    const auto heard = discovery.find_all(bus_watch_time);
    const auto let = heard && is_asked() ? let_in() : heard;
    const auto found = let ? discovery.find_all(bus_watch_time) : let;
    if (!found) {
      watch_.reset();
      return std::unexpected(found.error());
    }
    arrival.ids = servos_there();
    if (!arrival.ids.empty()) {
      return arrival;
    }
    watch_.reset();
    go_to(StationStage::waiting);
  }
}

void Station::remember(const state::LedgerRecord& record) {
  constexpr std::size_t size = std::tuple_size_v<UniqueId>;
  const auto unit = record.unique_id ? from_hex<size>(*record.unique_id) : std::nullopt;
  const bool is_spoilt = reason_ && reason_->code == Code::not_back;
  const bool is_same = unit && last_.unit == *unit;
  const unsigned spoilt = is_spoilt ? 1 + (is_same ? last_.spoilt : 0) : 0;
  last_ = {.may_ask = record.static_node_id.value_or(0) == 0,
           .are_several = reason_ && reason_->code == Code::several_servos,
           .is_to_be_repeated =
               reason_ && is_done_again(reason_->code) && spoilt < most_spoilt_in_row,
           .spoilt = spoilt,
           .end = session_.now()};
  if (unit) {
    last_.unit = *unit;
  }
  for (const NodeId id : servos_there()) {
    const Member member = session_.roster().member(id);
    if (!last_.unit || member.is_unit(*last_.unit)) { // another one has come beside it
      last_.nodes[id] = {member.boots, member.back_at};
    }
  }
}

/// To the next one; `has_asked`: it is not heard under its node ID yet.
Result<Station::Leaving> Station::give_way(bool has_asked) {
  go_to(StationStage::recognised);
  const auto came = has_asked ? session_.live_until(session_.now() + longest_answer,
                                                    [this] { return is_servo_there(); })
                              : Result<bool>(true);
  return came ? Result<Leaving>(Leaving::replaced) : std::unexpected(came.error());
}

Result<Station::Leaving> Station::wait_until_off(Time deadline) {
  watch_.reset();
  go_to(StationStage::take_off);
  Succession succession(session_, options_.manner.identification.patience, last_);
  Time heard = session_.now(), others_since = never;
  while (session_.now() - heard < off_time) {
    if (session_.now() >= deadline) {
      return Leaving::late;
    }
    if (const auto lived = session_.live_until(session_.now() + look_period); !lived) {
      return std::unexpected(lived.error());
    }
    const auto servos = servos_there();
    const bool is_there = !servos.empty() || is_asked(last_.end);
    heard = is_there || session_.away() ? session_.now() : heard;
    const bool has_lent = succession.has_lent_to_another();
    const bool is_other = succession.has_begun(servos) || is_other_asking() || has_lent;
    others_since = is_other ? std::min(others_since, session_.now()) : never;
    const bool is_last_there =
        !last_.is_to_be_repeated &&
        (last_.unit ? succession.has_last() : is_there && (!is_other || last_.are_several));
    if (is_other && !last_.are_several && !last_.is_to_be_repeated &&
        (succession.has_last(others_since) || is_any_doubled(servos))) {
      return is_any_doubled(servos) ? Leaving::doubled : Leaving::joined;
    }
    const bool is_next = last_.is_to_be_repeated ? is_there : is_other && !is_last_there;
    if (is_next && !last_.are_several) {
      return give_way(has_lent);
    }
    if (!session_.away()) {
      show_bench(is_last_there, is_there);
    }
    if (!last_.are_several && is_asked(last_.end)) {
      if (const auto lent = succession.lend(beside_bench()); !lent) { // to tell who it is
        return std::unexpected(lent.error());
      }
      last_.has_let_in = true;
    }
  }
  session_.records().forget_gone(session_.now() - off_time);
  last_ = {};
  return Leaving::gone;
}

} // namespace blactl::fleet
