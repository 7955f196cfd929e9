#include "blactl/base/hex.hpp"
#include "blactl/fleet/change/id_moves.hpp"

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>

using namespace blactl;
using namespace blactl::fleet;
using dronecan::NodeId;
using dronecan::UniqueId;
using state::NodeIds;
using Wish = state::AllocationStore::Wish;

namespace {

UniqueId uid(char name) {
  return {static_cast<std::uint8_t>(name)};
}

IdHolder unit(char name, std::uint8_t id, std::optional<std::int64_t> static_node_id) {
  return {uid(name), NodeId(id), static_node_id};
}

IdHolder unit(char name, std::uint8_t id) {
  return unit(name, id, id);
}

Wish wish(char name, std::uint8_t id) {
  return {uid(name), NodeId(id)};
}

NodeIds ids(const std::vector<std::size_t>& each) {
  NodeIds all;
  for (const std::size_t id : each) {
    all.set(id);
  }
  return all;
}

/// "a:10>125* b:12>13, a:125>11": two rounds, the first of two moves, one of them temporary.
std::string text(const IdRounds& rounds) {
  std::string out;
  for (const auto& round : rounds) {
    out += out.empty() ? "" : ",";
    for (const IdMove& move : round) {
      out += (out.empty() ? "" : " ") + std::string(1, static_cast<char>(move.unique_id[0])) + ":" +
             std::to_string(move.from.value()) + ">" + std::to_string(move.to.value()) +
             (move.is_temporary ? "*" : "");
    }
  }
  return out;
}

std::string moves(const std::vector<IdHolder>& units, const std::vector<Wish>& wishes,
                  const NodeIds& taken = {}) {
  const auto rounds = plan_id_moves(units, wishes, taken);
  REQUIRE(rounds);
  return text(*rounds);
}

std::vector<Error> errors(const std::vector<IdHolder>& units, const std::vector<Wish>& wishes,
                          const NodeIds& taken = {}) {
  const auto rounds = plan_id_moves(units, wishes, taken);
  REQUIRE_FALSE(rounds);
  for (const Error& error : rounds.error()) {
    CHECK_FALSE(error.message.empty());
    CHECK_FALSE(error.hint.empty());
  }
  return rounds.error();
}

std::vector<Code> codes(const std::vector<Error>& errors) {
  std::vector<Code> all;
  std::ranges::transform(errors, std::back_inserter(all), &Error::code);
  return all;
}

} // namespace

TEST_CASE("units that wish free IDs get them at once") {
  CHECK(moves({unit('a', 10), unit('b', 11)}, {wish('a', 20), wish('b', 21)}) == "a:10>20 b:11>21");
  CHECK(moves({unit('a', 10), unit('b', 11)}, {}).empty());
}

TEST_CASE("in a chain each waits until the one before has left") {
  CHECK(moves({unit('a', 10), unit('b', 11), unit('c', 12)},
              {wish('a', 11), wish('b', 12), wish('c', 13)}) == "c:12>13, b:11>12, a:10>11");
}

TEST_CASE("two that exchange their IDs need a third for a moment: the highest that is free") {
  const std::vector units{unit('a', 10), unit('b', 11)};
  const std::vector wishes{wish('a', 11), wish('b', 10)};
  CHECK(moves(units, wishes) == "a:10>125*, b:11>10, a:125>11");
  CHECK(moves(units, wishes, ids({125, 123})) == "a:10>124*, b:11>10, a:124>11");
  CHECK(moves({unit('a', 10), unit('b', 11), unit('c', 125), unit('d', 1, 124)}, wishes) ==
        "a:10>123*, b:11>10, a:123>11");
}

TEST_CASE("a unit that becomes dynamic leaves an ID that another one wishes, and that alone") {
  const std::vector units{unit('a', 10), unit('b', 11), unit('c', 12)};
  const std::vector dynamic{uid('c')};
  const auto planned = [&](const std::vector<IdHolder>& on_bus, const std::vector<Wish>& wishes) {
    const auto rounds = plan_id_moves(on_bus, wishes, {}, {}, dynamic);
    REQUIRE(rounds);
    return text(*rounds);
  };
  const std::vector cycle{wish('a', 11), wish('b', 12)};
  CHECK(planned(units, cycle) == "c:12>125, b:11>12, a:10>11");
  CHECK(plan_id_moves(units, cycle, {}, {}, dynamic)->front().front().is_dynamic);
  CHECK(planned(units, {wish('a', 20)}) == "a:10>20");
  CHECK(planned({unit('a', 10), unit('c', 30, 12)}, {wish('a', 12)}) == "c:30>125, a:10>12");
  CHECK(codes(errors(units, cycle)) == std::vector{Code::duplicate_node_id});
}

TEST_CASE("a temporary ID is none that somebody wishes") {
  CHECK(moves({unit('a', 10), unit('b', 11), unit('c', 12), unit('d', 13)},
              {wish('a', 11), wish('b', 10), wish('c', 125), wish('d', 12)}) ==
        "c:12>125 a:10>124*, b:11>10 d:13>12, a:124>11");
}

TEST_CASE("eight that pass their IDs on in a cycle take nine moves") {
  std::vector<IdHolder> units;
  std::vector<Wish> wishes;
  for (std::uint8_t i = 0; i < 8; ++i) {
    units.push_back(unit(static_cast<char>('a' + i), 10 + i));
    wishes.push_back(wish(static_cast<char>('a' + i), i == 7 ? 10 : 11 + i));
  }
  CHECK(moves(units, wishes) == "a:10>125*, h:17>10, g:16>17, f:15>16, e:14>15, d:13>14, c:12>13, "
                                "b:11>12, a:125>11");
}

TEST_CASE("cycles go side by side, or one after the other where only one ID is free") {
  const std::vector units{unit('a', 10), unit('b', 11), unit('c', 20), unit('d', 21)};
  const std::vector wishes{wish('a', 11), wish('b', 10), wish('c', 21), wish('d', 20)};
  CHECK(moves(units, wishes) == "a:10>125* c:20>124*, b:11>10 d:21>20, a:125>11 c:124>21");
  CHECK(moves(units, wishes, ~ids({10, 11, 20, 21, 99})) ==
        "a:10>99*, b:11>10, a:99>11, c:20>99*, d:21>20, c:99>21");
}

TEST_CASE("the end of a chain frees an ID for a cycle") {
  CHECK(moves({unit('a', 10), unit('b', 11), unit('c', 20)},
              {wish('a', 11), wish('b', 10), wish('c', 21)},
              ~ids({10, 11, 20, 21})) == "c:20>21, a:10>20*, b:11>10, a:20>11");
}

TEST_CASE("who has the ID that is wished does not move") {
  CHECK(moves({unit('a', 10)}, {wish('a', 10)}).empty());
  CHECK(moves({unit('a', 10, 0)}, {wish('a', 10)}) == "a:10>10");
  CHECK(moves({unit('a', 10, 11)}, {wish('a', 10)}) == "a:10>10");
  CHECK(moves({unit('a', 10, 11)}, {wish('a', 11)}) == "a:10>11");
  CHECK(moves({unit('a', 10, std::nullopt)}, {wish('a', 10)}) == "a:10>10");
}

TEST_CASE("a unit has its ID in ROM as well as that on the bus, a dynamic one that on the bus") {
  CHECK(moves({unit('a', 10), unit('b', 11, 12)}, {wish('a', 12), wish('b', 13)}) ==
        "b:11>13, a:10>12");
  CHECK(moves({unit('a', 10), unit('b', 11, 12)}, {wish('a', 11), wish('b', 12)}) ==
        "b:11>12, a:10>11");
  CHECK(moves({unit('a', 10, 0), unit('b', 11, 0)}, {wish('a', 11), wish('b', 12)}) ==
        "b:11>12, a:10>11");
}

TEST_CASE("a unit that a cut has left on the way to its temporary ID goes on to it") {
  const std::vector wishes{wish('a', 11), wish('b', 10)};
  SECTION("saved and not restarted") {
    CHECK(moves({unit('a', 10), unit('b', 11, 99)}, wishes, ~ids({10, 11, 99})) ==
          "b:11>99*, a:10>11, b:99>10");
    CHECK(moves({unit('a', 10), unit('b', 11, 125)}, wishes) == "b:11>125*, a:10>11, b:125>10");
  }
  SECTION("restarted") {
    CHECK(moves({unit('a', 125), unit('b', 11)}, wishes) == "b:11>10, a:125>11");
  }
  SECTION("the others done") {
    CHECK(moves({unit('a', 125), unit('b', 10)}, wishes) == "a:125>11");
  }
}

TEST_CASE("IDs that no unit can have for good are refused, 0 among them") {
  for (const std::uint8_t id : std::array<std::uint8_t, 3>{0, 126, 127}) {
    const auto found = errors({unit('a', 10)}, {wish('a', id)}, ids({0, 126, 127}));
    CHECK(codes(found) == std::vector{Code::out_of_range});
    CHECK(found[0].message.find(hex(uid('a'))) != std::string::npos);
  }
  CHECK(moves({unit('a', 10), unit('b', 11)}, {wish('a', 1), wish('b', 125)}) == "a:10>1 b:11>125");
  CHECK(moves({unit('a', 127, 126)}, {wish('a', 1)}) == "a:127>1");
}

TEST_CASE("a wish for a unit that is not there is refused") {
  const auto found = errors({unit('a', 10)}, {wish('b', 11)});
  CHECK(codes(found) == std::vector{Code::not_found});
  CHECK(found[0].message.find(hex(uid('b'))) != std::string::npos);
}

TEST_CASE("two wishes for one ID, or for one unit, are refused") {
  const std::vector units{unit('a', 10), unit('b', 11)};
  const auto one_id = errors(units, {wish('a', 20), wish('b', 20)});
  CHECK(codes(one_id) == std::vector{Code::usage});
  CHECK(one_id[0].message.find(hex(uid('a'))) != std::string::npos);
  CHECK(one_id[0].message.find(hex(uid('b'))) != std::string::npos);
  CHECK(codes(errors(units, {wish('a', 20), wish('a', 21)})) == std::vector{Code::usage});
  CHECK(codes(errors(units, {wish('a', 11), wish('b', 11)})) == std::vector{Code::usage});
}

TEST_CASE("an ID of a unit that stays is refused, and the unit named") {
  const IdHolder holder =
      GENERATE(unit('b', 11), unit('b', 11, 0), unit('b', 12, 11), unit('b', 11, std::nullopt));
  const auto found = errors({unit('a', 10), holder}, {wish('a', 11)});
  CHECK(codes(found) == std::vector{Code::duplicate_node_id});
  CHECK(found[0].node_id == 10);
  CHECK(found[0].message.find(hex(uid('b'))) != std::string::npos);
  CHECK(found[0].hint.find(hex(uid('b'))) != std::string::npos);
}

TEST_CASE("an ID that others have is refused") {
  const auto found = errors({unit('a', 10)}, {wish('a', 11)}, ids({11}));
  CHECK(codes(found) == std::vector{Code::duplicate_node_id});
  CHECK(found[0].node_id == 10);
}

TEST_CASE("a cycle without a free ID is refused, a chain needs none") {
  const std::vector units{unit('a', 10), unit('b', 11)};
  const NodeIds all_others = ~ids({10, 11});
  CHECK(codes(errors(units, {wish('a', 11), wish('b', 10)}, all_others)) ==
        std::vector{Code::table_full});
  CHECK(moves(units, {wish('a', 11), wish('b', 12)}, ~ids({10, 11, 12})) == "b:11>12, a:10>11");
}

TEST_CASE("all that is wrong is told at once") {
  CHECK(codes(errors({unit('a', 10), unit('b', 11), unit('c', 12), unit('d', 13)},
                     {wish('a', 11), wish('x', 126), wish('c', 30), wish('d', 30)}, ids({30}))) ==
        std::vector{Code::duplicate_node_id, Code::out_of_range, Code::not_found,
                    Code::duplicate_node_id, Code::duplicate_node_id, Code::usage});
}

namespace {

constexpr std::uint8_t last_id = 125;

/// Units as they truly are; their ROM is always known.
struct World {
  std::vector<IdHolder> units;
  std::vector<Wish> wishes;
  NodeIds others;

  IdHolder& at(const UniqueId& unique_id) {
    return *std::ranges::find(units, unique_id, &IdHolder::unique_id);
  }

  /// Nobody has, or gets with a restart, what another has.
  [[nodiscard]] bool is_safe() const {
    NodeIds held = others;
    for (const IdHolder& unit : units) {
      NodeIds its;
      its.set(unit.id.value());
      if (unit.static_node_id != 0) {
        its.set(static_cast<std::size_t>(*unit.static_node_id));
      }
      if ((held & its).any()) {
        return false;
      }
      held |= its;
    }
    return true;
  }

  /// Who was not wished for has what it had, one restarted with another ID in ROM has that.
  [[nodiscard]] bool is_as_wished(const World& before) const {
    return std::ranges::all_of(before.units, [&](const IdHolder& was) {
      const auto now = std::ranges::find(units, was.unique_id, &IdHolder::unique_id);
      const auto wish = std::ranges::find(wishes, was.unique_id, &Wish::unique_id);
      if (wish != wishes.end()) {
        return now->id == wish->node_id && now->static_node_id == wish->node_id.value();
      }
      return now->static_node_id == was.static_node_id &&
             (now->id == was.id || now->id.value() == was.static_node_id);
    });
  }

  /// Some units, or all, lose their supply for a moment; a dynamic one gets the ID that it had.
  void cut_power(std::mt19937_64& random) {
    const bool all = random() % 2 == 0;
    for (IdHolder& unit : units) {
      if (unit.static_node_id != 0 && (all || random() % 2 == 0)) {
        unit.id = NodeId(static_cast<std::uint8_t>(*unit.static_node_id));
      }
    }
  }
};

/// Node IDs in any order, each drawn once.
class Pool {
 public:
  explicit Pool(std::mt19937_64& random) : ids_(last_id) {
    std::iota(ids_.begin(), ids_.end(), std::uint8_t{1});
    std::ranges::shuffle(ids_, random);
  }

  [[nodiscard]] std::size_t size() const { return ids_.size(); }

  std::uint8_t draw() {
    const std::uint8_t id = ids_.back();
    ids_.pop_back();
    return id;
  }

 private:
  std::vector<std::uint8_t> ids_;
};

/// Units, others and wishes that do not contradict each other. Most wishes are for what another
/// has, so that there are many cycles and chains; often few IDs are free, or none.
World any_world(std::mt19937_64& random) {
  const auto below = [&](std::size_t limit) { return random() % limit; };
  Pool pool(random);
  World world;
  std::vector<char> wishing;
  std::vector<std::uint8_t> wishable;
  const std::size_t count = 1 + below(30), one_stays_of = 1 + below(8);
  const bool all_restarted = below(2) == 0; // since their ROM was written
  for (std::size_t i = 0; i < count; ++i) {
    const auto name = static_cast<char>('0' + i);
    const std::uint8_t id = pool.draw();
    const std::uint8_t rom = below(5) == 0 ? 0 : all_restarted || below(4) != 0 ? id : pool.draw();
    world.units.push_back(unit(name, id, rom));
    if (one_stays_of == 1 || below(one_stays_of) != 0) {
      wishing.push_back(name);
      wishable.push_back(id);
      if (rom != 0 && rom != id) {
        wishable.push_back(rom);
      }
    }
  }
  for (std::size_t extra = below(4); extra > 0; --extra) {
    wishable.push_back(pool.draw());
  }
  const std::size_t unused = below(2) == 0 ? pool.size() : below(3);
  while (pool.size() > unused) {
    world.others.set(pool.draw());
  }
  std::ranges::shuffle(wishable, random);
  std::ranges::shuffle(wishing, random);
  for (std::size_t i = 0; i < wishing.size(); ++i) {
    world.wishes.push_back(wish(wishing[i], wishable[i]));
  }
  return world;
}

/// Units that must move, and one for each cycle of them: by following who holds what.
std::size_t least_moves(const std::vector<IdHolder>& units, const std::vector<Wish>& wishes,
                        std::size_t& cycles) {
  std::map<std::int64_t, std::size_t> holder;
  std::map<std::size_t, std::size_t> waits_for;
  for (std::size_t i = 0; i < units.size(); ++i) {
    holder[units[i].id.value()] = i;
    holder[units[i].static_node_id.value_or(0)] = i;
  }
  holder.erase(0);
  std::size_t movers = 0;
  for (const Wish& wish : wishes) {
    const auto it = std::ranges::find(units, wish.unique_id, &IdHolder::unique_id);
    const auto index = static_cast<std::size_t>(it - units.begin());
    const std::int64_t id = wish.node_id.value();
    movers += it->id == wish.node_id && it->static_node_id == id ? 0U : 1U;
    if (holder.contains(id) && holder[id] != index) {
      waits_for[index] = holder[id];
    }
  }
  cycles = 0;
  for (const auto& [first, next] : waits_for) {
    std::size_t lowest = first, unit = next, steps = 0;
    while (unit != first && waits_for.contains(unit) && ++steps <= units.size()) {
      lowest = std::min(lowest, unit);
      unit = waits_for[unit];
    }
    cycles += unit == first && lowest == first ? 1U : 0U;
  }
  return movers + cycles;
}

std::size_t count(const IdRounds& rounds) {
  return std::accumulate(rounds.begin(), rounds.end(), std::size_t{0},
                         [](std::size_t sum, const auto& round) { return sum + round.size(); });
}

/// Each move is two steps, SAVE and restart; those of a round mingle. Ends after `steps` of them.
void carry_out(World& world, const IdRounds& rounds, std::size_t steps, std::mt19937_64& random) {
  for (const auto& round : rounds) {
    std::vector<IdMove> to_save = round, to_restart;
    while (!to_save.empty() || !to_restart.empty()) {
      if (steps-- == 0) {
        return;
      }
      const bool saves = to_restart.empty() || (!to_save.empty() && random() % 2 == 0);
      auto& from = saves ? to_save : to_restart;
      std::swap(from[random() % from.size()], from.back());
      const IdMove move = from.back();
      from.pop_back();
      if (saves) {
        REQUIRE(world.at(move.unique_id).id == move.from);
        world.at(move.unique_id).static_node_id = move.to.value();
        to_restart.push_back(move);
      } else {
        world.at(move.unique_id).id = move.to;
      }
      REQUIRE(world.is_safe());
    }
  }
}

/// Some do not tell their ROM, which then holds nothing that is not heard.
std::vector<IdHolder> as_told(const World& world, std::mt19937_64& random) {
  std::vector<IdHolder> told = world.units;
  for (IdHolder& unit : told) {
    const bool hides_nothing = unit.static_node_id == 0 || unit.static_node_id == unit.id.value();
    if (hides_nothing && random() % 8 == 0) {
      unit.static_node_id.reset();
    }
  }
  return told;
}

bool has_free_id(const World& world) {
  for (std::uint8_t id = 1; id <= last_id; ++id) {
    const bool is_held = std::ranges::any_of(world.units, [&](const IdHolder& unit) {
      return unit.id == NodeId(id) || unit.static_node_id == id;
    });
    if (!is_held && !world.others[id]) {
      return true;
    }
  }
  return false;
}

/// False: refused, and rightly so.
bool plan_is_right(const World& world, const std::vector<IdHolder>& told, IdRounds& rounds) {
  std::size_t cycles = 0;
  const std::size_t least = least_moves(told, world.wishes, cycles);
  const auto plan = plan_id_moves(told, world.wishes, world.others);
  if (!plan) {
    REQUIRE(codes(plan.error()) == std::vector{Code::table_full});
    REQUIRE(cycles > 0);
    REQUIRE_FALSE(has_free_id(world));
    return false;
  }
  REQUIRE(count(*plan) == least);
  REQUIRE(std::ranges::none_of(*plan, [](const auto& round) { return round.empty(); }));
  rounds = *plan;
  return true;
}

} // namespace

TEST_CASE("whatever is wished and wherever it is cut, no ID is doubled and a new plan ends it") {
  std::size_t carried_out = 0, refused = 0, with_cycles = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    const World before = any_world(random);
    REQUIRE(before.is_safe());
    World world = before;
    IdRounds rounds;
    if (!plan_is_right(world, as_told(world, random), rounds)) {
      ++refused;
      continue;
    }
    ++carried_out;
    with_cycles += text(rounds).find('*') != std::string::npos ? 1U : 0U;
    for (int cut = 0; cut < 3; ++cut) {
      carry_out(world, rounds, random() % (2 * count(rounds) + 1), random);
      if (random() % 2 == 0) {
        world.cut_power(random);
      }
      REQUIRE(world.is_safe());
      REQUIRE(plan_is_right(world, world.units, rounds));
    }
    carry_out(world, rounds, 2 * count(rounds), random);
    REQUIRE(world.is_as_wished(before));
    REQUIRE(plan_id_moves(world.units, world.wishes, world.others)->empty());
  }
  CHECK(carried_out > 1500);
  CHECK(refused > 20);
  CHECK(with_cycles > 500);
}

namespace {

constexpr std::size_t small = 4; ///< units, on node IDs 1 to 4

/// Where each unit is, or, as wishes, is to be; 0: it stays.
using Places = std::array<std::uint8_t, small>;

/// The length of the shortest way, found by trying all of them; empty: there is none. Units go to
/// any of the IDs up to `last` that none of them has.
std::optional<std::size_t> shortest(const Places& start, const Places& wishes, std::uint8_t last) {
  std::map<Places, std::size_t> distance{{start, 0}};
  for (std::deque<Places> queue{start}; !queue.empty(); queue.pop_front()) {
    const Places here = queue.front();
    bool is_end = true;
    for (std::size_t i = 0; i < small; ++i) {
      is_end = is_end && (wishes[i] == 0 || wishes[i] == here[i]);
    }
    if (is_end) {
      return distance[here];
    }
    for (std::size_t i = 0; i < small; ++i) {
      for (std::uint8_t id = 1; id <= last && wishes[i] != 0; ++id) {
        Places next = here;
        next[i] = id;
        if (std::ranges::count(here, id) == 0 && !distance.contains(next)) {
          distance[next] = distance[here] + 1;
          queue.push_back(next);
        }
      }
    }
  }
  return std::nullopt;
}

bool contradicts(const Places& start, const Places& wishes) {
  for (std::size_t i = 0; i < small; ++i) {
    for (std::size_t j = 0; j < small; ++j) {
      const std::uint8_t its = wishes[j] == 0 ? start[j] : wishes[j];
      if (i != j && wishes[i] != 0 && wishes[i] == its) {
        return true;
      }
    }
  }
  return false;
}

} // namespace

TEST_CASE("no shorter way exists, and a way is found wherever there is one") {
  const Places start{1, 2, 3, 4};
  std::size_t ways = 0, none = 0;
  for (std::uint8_t last = 4; last <= 6; ++last) {
    NodeIds others;
    for (std::size_t id = last + 1U; id <= last_id; ++id) {
      others.set(id);
    }
    std::size_t combinations = 1;
    for (std::size_t i = 0; i < small; ++i) {
      combinations *= last + 1U;
    }
    for (std::size_t number = 0; number < combinations; ++number) {
      Places wished{};
      std::vector<IdHolder> units;
      std::vector<Wish> wishes;
      for (std::size_t i = 0, rest = number; i < small; ++i, rest /= last + 1U) {
        wished[i] = static_cast<std::uint8_t>(rest % (last + 1U));
        units.push_back(unit(static_cast<char>('a' + i), start[i]));
        if (wished[i] != 0) {
          wishes.push_back(wish(static_cast<char>('a' + i), wished[i]));
        }
      }
      INFO("IDs to " << int{last} << ", wishes " << hex(wished));
      const auto plan = plan_id_moves(units, wishes, others);
      if (contradicts(start, wished)) {
        REQUIRE_FALSE(plan);
        continue;
      }
      const auto length = shortest(start, wished, last);
      REQUIRE(plan.has_value() == length.has_value());
      if (length) {
        REQUIRE(count(*plan) == *length);
      } else {
        REQUIRE(codes(plan.error()) == std::vector{Code::table_full});
      }
      ++(length ? ways : none);
    }
  }
  CHECK(ways > 500);
  CHECK(none > 10);
}
