#include "step.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace blactl::campaign {

using nlohmann::json;

namespace {

/// From the order to the end of a ROM write.
constexpr Duration longest_save = std::chrono::seconds(1);

} // namespace

Duration time_in(const json& text) {
  if (text.is_number()) {
    return Duration(text.get<std::int64_t>());
  }
  const std::string word = text.get<std::string>();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const std::string_view unit = end;
  return unit == "s"    ? Duration(std::chrono::seconds(number))
         : unit == "ms" ? Duration(std::chrono::milliseconds(number))
                        : Duration(number);
}

const json& Step::setup(std::int64_t serial) const {
  return *std::ranges::find_if(episode.scenario["servos"], [&](const json& servo) {
    return servo["serial_number"].get<std::int64_t>() == serial;
  });
}

std::string Step::model(std::int64_t serial) const {
  return setup(serial)["model"];
}

std::set<std::uint8_t> Step::node_ids(std::int64_t serial) const {
  std::set<std::uint8_t> ids{before.at(serial).node_id, after.at(serial).node_id};
  for (const sim::ServoEvent& event : events) {
    if (event.serial_number == serial) {
      ids.insert(event.node_id.value());
    }
  }
  ids.erase(0);
  return ids;
}

std::vector<Time> Step::restarts(std::int64_t serial) const {
  std::vector<Time> times;
  for (const sim::ServoEvent& event : events) {
    if (event.serial_number == serial && event.kind == sim::ServoEvent::Kind::restart) {
      times.push_back(event.at);
    }
  }
  return times;
}

bool Step::means(std::int64_t serial) const {
  if (command.verb() == "doctor" || (command.verb() == "alloc" && !command.has("--static"))) {
    return false;
  }
  if (!command.fleet.is_null()) {
    return std::ranges::any_of(command.fleet["servos"], [&](const json& entry) {
      return entry["match"]["serial_number"].get<std::int64_t>() == serial;
    });
  }
  const auto at = std::ranges::find(command.words, "-n");
  const std::string target = at != command.words.end() ? *(at + 1) : "all";
  const auto names = [&](const std::string& word) {
    return ("," + target + ",").find("," + word + ",") != std::string::npos;
  };
  const auto ids = node_ids(serial);
  return target == "all" || names("serial:" + std::to_string(serial)) ||
         std::ranges::any_of(ids, [&](std::uint8_t id) { return names(std::to_string(id)); });
}

Duration Step::lateness(std::int64_t serial) const {
  const json& servo = setup(serial);
  return servo.contains("sending") && servo["sending"].contains("late_by")
             ? time_in(servo["sending"]["late_by"])
             : Duration::zero();
}

/// What happened to it by then is known: it was heard later, or must have been asked, as the last
/// change to any servo came later.
Time Step::known_until(std::int64_t serial) const {
  const Duration late = lateness(serial);
  const Time heard = outcome.record.last_told_by(node_ids(serial)) - tolerance - late;
  const auto changes = outcome.record.changes();
  const bool is_looked_at = !changes.empty() && hears_all() && late == Duration::zero();
  return is_looked_at ? std::max(heard, changes.back().at - on_its_way) : heard;
}

bool Step::changed_unheard(std::int64_t serial) const {
  const auto ids = node_ids(serial);
  const Time known = known_until(serial);
  const auto is_unheard = [&](Time at) { return at > known && at <= end + tolerance; };
  // an ID that goes from one to another: who was heard last under it is not certain
  const bool is_passed_on = std::ranges::any_of(after, [&](const auto& other) {
    const auto others = node_ids(other.first);
    return other.first != serial &&
           std::ranges::any_of(others, [&](std::uint8_t id) { return ids.contains(id); });
  });
  return std::ranges::any_of(restarts(serial), is_unheard) ||
         std::ranges::any_of(accidents(serial),
                             [&](Time at) {
                               return is_unheard(at) ||
                                      (is_passed_on && at > begin && at <= end + tolerance);
                             }) ||
         is_written_unheard(serial);
}

/// What a SAVE or an ERASE does takes a while.
bool Step::is_written_unheard(std::int64_t serial) const {
  const Time known = hears_all() ? known_until(serial) : begin;
  const auto orders = orders_of_others(serial, known - longest_save);
  return !orders_of_others(serial, known).empty() ||
         std::ranges::any_of(orders, [](const std::string& order) { return order != "write"; });
}

bool Step::hears_all() const {
  const json all = episode.scenario.value("events", json::array());
  return !episode.scenario.contains("wire") &&
         std::ranges::none_of(all, [](const json& event) { return event.contains("clients"); });
}

bool Step::has_other_writer(std::int64_t serial) const {
  return !orders_of_others(serial, begin - longest_save).empty();
}

bool Step::is_saved_by_other(std::int64_t serial) const {
  const auto orders = orders_of_others(serial, begin - longest_save);
  return std::ranges::any_of(orders, [](const std::string& order) { return order != "write"; });
}

std::set<std::string> Step::orders_of_others(std::int64_t serial, Time earliest) const {
  std::set<std::string> orders;
  if (!episode.scenario.contains("foreign")) {
    return orders;
  }
  const auto ids = node_ids(serial);
  for (const json& node : episode.scenario["foreign"]) {
    for (const json& order : node.value("orders", json::array())) {
      const Time at = Time{} + time_in(order["at"]);
      if (ids.contains(order["to"].get<std::uint8_t>()) && at > earliest && at < end + tolerance) {
        orders.insert(order["order"].get<std::string>());
      }
    }
  }
  return orders;
}

/// Another node has an ID that it had.
bool Step::shares_with_foreign(std::int64_t serial) const {
  const auto ids = node_ids(serial);
  const auto foreign = episode.scenario.value("foreign", json::array());
  return std::ranges::any_of(
      foreign, [&](const json& node) { return ids.contains(node["node_id"].get<std::uint8_t>()); });
}

bool Step::shares_node_id(std::int64_t serial) const {
  return shares_with_foreign(serial) || std::ranges::any_of(after, [&](const auto& other) {
           const std::uint8_t own = after.at(serial).node_id;
           const std::uint8_t own_before = before.at(serial).node_id;
           return other.first != serial &&
                  ((own != 0 && other.second.node_id == own) ||
                   (own_before != 0 && before.at(other.first).node_id == own_before));
         });
}

std::vector<std::int64_t> Step::copies(std::int64_t serial) const {
  std::vector<std::int64_t> copies;
  const ServoState& own = after.at(serial);
  for (const auto& [other, its] : after) {
    const bool both_answer = own.node_id != 0 && its.node_id != 0;
    if (other != serial && both_answer && its.unique_id == own.unique_id) {
      copies.push_back(other);
    }
  }
  return copies;
}

bool Step::is_doubled(std::int64_t serial) const {
  return shares_node_id(serial) || !copies(serial).empty();
}

bool Step::shows_doubled(std::int64_t serial) const {
  return shares_node_id(serial) || !std::ranges::all_of(copies(serial), [this](std::int64_t copy) {
           const bool is_mute = setup(copy).value("/faults/mute"_json_pointer, false);
           // two answers at once are not read
           return is_mute || shares_with_foreign(copy) || shares_node_id(copy);
         });
}

std::vector<Time> Step::accidents(std::int64_t serial) const {
  std::vector<Time> times;
  for (const json& event : episode.scenario.value("events", json::array())) {
    if (!event.contains("servo") || event["servo"].get<std::int64_t>() == serial) {
      times.push_back(Time{} + time_in(event["at"]));
    }
  }
  if (setup(serial).contains("faults")) {
    const auto restarted = restarts(serial);
    times.insert(times.end(), restarted.begin(), restarted.end());
  }
  return times;
}

bool has_no_trials(const States& servos) {
  return std::ranges::all_of(servos, [](const auto& servo) {
    return std::ranges::all_of(servo.second.rom, [&](const auto& held) {
      return servo.second.ram.at(held.first) == held.second;
    });
  });
}

} // namespace blactl::campaign
