#include "line.hpp"

#include "settings.hpp"
#include "step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <string>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

constexpr std::int64_t first_of_line = 250100001;
constexpr const char* model_of_line = "BLA21-12U-AB";

json whole_ms(Duration time) {
  return fmt::format("{}ms", std::chrono::duration_cast<std::chrono::milliseconds>(time).count());
}

std::string unique_id_of(std::int64_t serial) {
  return fmt::format("{:032x}", serial);
}

/// What no station can tell apart, and what fills the bus without end; units with one unique ID are
/// drawn by themselves.
const std::set<std::string>& left_out() {
  static const std::set<std::string> kinds{"babbler", "one_node_id", "one_unique_id", "node_on_id",
                                           "stays"};
  return kinds;
}

class LineDraft {
 public:
  explicit LineDraft(std::uint64_t seed) : chance_(seed, "line") { line_.episode.seed = seed; }

  [[nodiscard]] Line draw() {
    add_units();
    line_.recipe = recipe();
    line_.has_labels = chance_.comes(0.5);
    line_.has_count = chance_.comes(0.5);
    line_.has_scrap = chance_.comes(0.4);
    line_.is_done_anew = chance_.comes(0.2);
    add_visits();
    json& scenario = line_.episode.scenario;
    scenario["events"] = comings(line_.visits, scenario["servos"], Time{});
    if (chance_.comes(0.6)) {
      add_faults();
    }
    add_disturbances();
    return std::move(line_);
  }

 private:
  void add_units() {
    json servos = json::array();
    const auto count = chance_.whole(2, 5);
    for (std::int64_t i = 0; i <= count; ++i) { // the last one is the spare
      const std::int64_t serial = first_of_line + i;
      json servo{{"model", i < count && chance_.comes(0.07) ? "BLA34-12U-AB" : model_of_line},
                 {"serial_number", serial},
                 {"unique_id", unique_id_of(serial)},
                 {"node_id", chance_.comes(0.5)
                                 ? 0
                                 : chance_.one_of<std::int64_t>({1, 5, 11, 11, 12, 60, 124})}};
      if (i < count && chance_.comes(0.1)) {
        servo["firmware_version"] = 1300;
      }
      if (chance_.comes(0.3)) {
        servo["behaviour"]["first_node_status"] = chance_.one_of<std::string>({"300ms", "1s"});
      }
      if (i < count && chance_.comes(0.08)) { // a weak magnet, at first or until somebody mends it
        servo["ram"]["fault_warning"] = 16;
      }
      servos.push_back(std::move(servo));
    }
    if (chance_.comes(0.08)) {
      servos[1]["unique_id"] = servos[0]["unique_id"];
    }
    line_.spare = first_of_line + count;
    line_.episode.scenario = {{"schema", "blactl-scenario/1"},
                              {"clock", "virtual"},
                              {"seed", line_.episode.seed},
                              {"servos", std::move(servos)}};
  }

  [[nodiscard]] json counter(std::int64_t first) {
    const auto units = static_cast<std::int64_t>(line_.episode.scenario["servos"].size());
    const std::int64_t step = chance_.comes(0.2) ? 2 : 1;
    json counter{{"first", first}, {"last", first + (units + 1) * step}, {"step", step}};
    if (chance_.comes(0.3)) {
      counter["at_end"] = "again";
      counter["last"] = first + chance_.whole(1, 3) * step;
    } else if (chance_.comes(0.1)) {
      counter["last"] = first + step; // it ends
    }
    return counter;
  }

  [[nodiscard]] json recipe() {
    json set{{"servo_id", counter(1)}};
    if (chance_.comes(0.8)) {
      set["static_node_id"] = counter(11);
    }
    for (std::int64_t i = chance_.whole(1, 3); i > 0; --i) {
      auto it = settings().begin();
      std::advance(it, chance_.whole(0, std::ssize(settings()) - 1));
      auto value = it->second.values.begin();
      std::advance(value, chance_.whole(0, std::ssize(it->second.values) - 1));
      set[it->first] = value->first;
    }
    return {{"schema", "blactl-recipe/1"},
            {"name", "aileron"},
            {"model", model_of_line},
            {"firmware_min", 1400},
            {"set", std::move(set)}};
  }

  [[nodiscard]] std::string label_of(std::int64_t serial) {
    const std::int64_t told = chance_.comes(0.08) ? serial + 1 : serial; // two were swapped
    if (!chance_.comes(0.3)) {
      return std::to_string(told);
    }
    json label{{"serial_number", told}};
    const json counter = line_.recipe["set"]["servo_id"];
    if (chance_.comes(0.6)) {
      const std::int64_t steps =
          (counter["last"].get<std::int64_t>() - 1) / counter["step"].get<std::int64_t>();
      label["servo_id"] = 1 + chance_.whole(0, steps) * counter["step"].get<std::int64_t>();
    }
    return label.dump();
  }

  void visit(std::vector<std::int64_t> serials, Duration length) {
    const bool is_exchanged = chance_.comes(0.1); // before the station can see that it left
    now_ += is_exchanged ? std::chrono::milliseconds(chance_.whole(200, 2500))
                         : std::chrono::milliseconds(chance_.whole(4500, 8000));
    const std::int64_t serial = serials.front();
    line_.visits.push_back(
        {.serials = std::move(serials), .span = {now_, now_ + length}, .label = label_of(serial)});
    now_ += length;
  }

  [[nodiscard]] bool has_warning(std::int64_t serial) const {
    return line_.servo(serial).contains("ram");
  }

  void add_visits() {
    std::vector<std::int64_t> units;
    for (std::int64_t serial = first_of_line; serial < line_.spare; ++serial) {
      units.push_back(serial);
    }
    for (const std::int64_t serial : units) {
      if (chance_.comes(0.12)) {
        visit({serial}, std::chrono::milliseconds(chance_.whole(500, 9000)));
      }
      const std::int64_t other = chance_.one_of(units);
      if (other != serial && chance_.comes(0.1)) {
        visit({serial, other}, 12s);
      }
      visit({serial}, std::chrono::seconds(chance_.whole(16, 24)));
      for (int time = 0; time < 3 && has_warning(serial) && chance_.comes(0.7); ++time) {
        visit({serial}, 16s); // it fails again
      }
      if (chance_.comes(0.2)) {
        visit({chance_.comes(0.6) ? serial : chance_.one_of(units)}, 16s);
      }
    }
  }

  // What goes wrong.

  [[nodiscard]] const Visit& some_visit_of(std::int64_t serial) {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < line_.visits.size(); ++i) {
      if (serial == 0 ||
          std::ranges::find(line_.visits[i].serials, serial) != line_.visits[i].serials.end()) {
        all.push_back(i);
      }
    }
    return line_.visits[all.empty() ? 0 : chance_.one_of(all)];
  }

  void add_faults() {
    std::vector<std::string> kinds = fault_kinds();
    std::erase_if(kinds, [](const std::string& kind) { return left_out().contains(kind); });
    const auto count = chance_.comes(0.7) ? 1 : chance_.whole(2, 3);
    for (const std::string& kind : chance_.some_of(kinds, static_cast<std::size_t>(count))) {
      add_fault(kind);
    }
  }

  /// As the episodes have it, but its times are those of a visit.
  void add_fault(const std::string& kind) {
    json& scenario = line_.episode.scenario;
    json events = std::exchange(scenario["events"], json::array());
    json foreign = scenario.value("foreign", json::array());
    scenario["foreign"] = json::array();
    Chance own(line_.episode.seed, kind);
    plant(line_.episode, kind, own);
    const Visit* at = nullptr;
    for (json& event : scenario["events"]) {
      at = at == nullptr ? &some_visit_of(event.value("servo", std::int64_t{0})) : at;
      event["at"] = whole_ms(at->span.from - Time{} + time_in(event["at"]));
      events.push_back(event);
    }
    const Duration later = some_visit_of(0).span.from - Time{};
    for (json& node : scenario["foreign"]) {
      if (node.contains("begins")) {
        node["begins"] = whole_ms(later + time_in(node["begins"]));
      }
      for (json& order : node.value("orders", json::array()).empty() ? empty_ : node["orders"]) {
        order["at"] = whole_ms(later + time_in(order["at"]));
        order["to"] = chance_.one_of<std::int64_t>({order["to"].get<std::int64_t>(), 11, 12, 124});
      }
      foreign.push_back(node);
    }
    scenario["events"] = std::move(events);
    scenario["foreign"] = std::move(foreign);
  }

  void add_disturbances() {
    using Kind = Disturbance::Kind;
    const std::vector<Kind> kinds{Kind::request_lost, Kind::killed,         Kind::killed,
                                  Kind::frame_lost,   Kind::frame_doubled,  Kind::frame_corrupted,
                                  Kind::frame_late,   Kind::frame_of_other, Kind::call_failed,
                                  Kind::computer_off};
    double chance = 0.5;
    while (chance_.comes(chance) && line_.disturbances.size() < 4) {
      const auto most = chance_.one_of<std::int64_t>({30, 300, 300, 3000});
      line_.disturbances.push_back({.kind = chance_.one_of(kinds),
                                    .number = static_cast<std::size_t>(chance_.whole(1, most)),
                                    .lasts = chance_.comes(0.1)});
      chance = 0.4;
    }
  }

  Line line_;
  Chance chance_;
  Time now_{};
  json empty_ = json::array();
};

} // namespace

const json& Line::servo(std::int64_t serial) const {
  const json& servos = episode.scenario["servos"];
  return *std::ranges::find_if(servos,
                               [&](const json& servo) { return servo["serial_number"] == serial; });
}

bool Line::is_doublet(std::int64_t serial) const {
  return std::ranges::count(episode.scenario["servos"], servo(serial)["unique_id"],
                            [](const json& each) { return each["unique_id"]; }) > 1;
}

json comings(const std::vector<Visit>& visits, const json& servos, Time base) {
  json events = json::array();
  for (const json& servo : servos) {
    events.push_back({{"at", "0ms"}, {"servo", servo["serial_number"]}, {"happens", "power_off"}});
  }
  for (const Visit& visit : visits) {
    for (const std::int64_t serial : visit.serials) {
      events.push_back(
          {{"at", whole_ms(visit.span.from - base)}, {"servo", serial}, {"happens", "power_on"}});
      events.push_back(
          {{"at", whole_ms(visit.span.to - base)}, {"servo", serial}, {"happens", "power_off"}});
    }
  }
  return events;
}

std::vector<Span> powered(const json& events, std::int64_t serial, Time base) {
  std::vector<const json*> own;
  for (const json& event : events) {
    if (event.value("servo", std::int64_t{0}) == serial) {
      own.push_back(&event);
    }
  }
  std::ranges::stable_sort(own, {}, [](const json* event) { return time_in((*event)["at"]); });
  std::vector<Span> spans{{.from = base, .to = never}};
  bool is_plugged = true, is_supplied = true;
  for (const json* event : own) {
    const Time at = base + time_in((*event)["at"]);
    const std::string happens = event->value("happens", "");
    const json world = event->value("world", json::object());
    is_plugged = happens == "power_on" || world.value("plugged", "") == "on" ||
                 (is_plugged && happens != "power_off" && world.value("plugged", "") != "off");
    is_supplied = world.contains("voltage") ? world["voltage"] != "2V" : is_supplied;
    const bool had_power = spans.back().to == never;
    if (had_power && !(is_plugged && is_supplied)) {
      spans.back().to = at;
    } else if (!had_power && is_plugged && is_supplied) {
      spans.push_back({.from = at, .to = never});
    }
  }
  return spans;
}

Line make_line(std::uint64_t seed) {
  return LineDraft(seed).draw();
}

Line make_calm_line(std::uint64_t seed) {
  Line line{.episode = {.seed = seed, .scenario = {}, .steps = {}, .faults = {}},
            .recipe = {{"schema", "blactl-recipe/1"},
                       {"name", "aileron"},
                       {"model", model_of_line},
                       {"set",
                        {{"servo_id", {{"first", 1}, {"last", 4}}},
                         {"static_node_id", {{"first", 11}, {"last", 14}}},
                         {"angle_limit_cw", "90deg"}}}},
            .visits = {},
            .has_labels = seed % 2 == 0};
  json servos = json::array();
  Time now{5s};
  for (const std::int64_t node_id : {0, 11}) {
    const std::int64_t serial = first_of_line + std::ssize(servos);
    servos.push_back({{"model", model_of_line},
                      {"serial_number", serial},
                      {"unique_id", unique_id_of(serial)},
                      {"node_id", node_id}});
    line.visits.push_back(
        {.serials = {serial}, .span = {now, now + 18s}, .label = std::to_string(serial)});
    now += 23s;
  }
  line.episode.scenario = {{"schema", "blactl-scenario/1"},
                           {"clock", "virtual"},
                           {"seed", 1},
                           {"servos", servos},
                           {"events", comings(line.visits, servos, Time{})}};
  return line;
}

} // namespace blactl::campaign
