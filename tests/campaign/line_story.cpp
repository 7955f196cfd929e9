#include "line_story.hpp"

#include <fmt/format.h>

#include <sqlite3.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

namespace blactl::campaign {

using nlohmann::json;

bool Shift::is_cut() const {
  return (disturbance.kind == Disturbance::Kind::killed ||
          disturbance.kind == Disturbance::Kind::computer_off) &&
         disturbance.has_struck();
}

std::vector<GivenId> read_counters(const std::filesystem::path& file) {
  std::vector<GivenId> all;
  sqlite3* opened = nullptr;
  if (!std::filesystem::exists(file) ||
      sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK) {
    sqlite3_close(opened);
    return all;
  }
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, sqlite3_close);
  const auto take = [](void* to, int, char** cells, char**) {
    static_cast<std::vector<GivenId>*>(to)->push_back({.parameter = cells[0],
                                                       .lap = std::stoll(cells[1]),
                                                       .value = std::stoll(cells[2]),
                                                       .is_counted = cells[3][0] == '1',
                                                       .unique_id = cells[4]});
    return 0;
  };
  const int done = sqlite3_exec(opened,
                                "SELECT parameter, lap, value, counted, lower(hex(unique_id)) "
                                "FROM assignments",
                                take, &all, nullptr);
  if (done != SQLITE_OK) {
    throw std::runtime_error("the counters cannot be read");
  }
  return all;
}

bool Shift::includes(const nlohmann::json& record) const {
  const auto text = [](Time time) {
    const auto wall =
        std::chrono::floor<std::chrono::seconds>(sim::virtual_epoch + time.time_since_epoch());
    const auto day = std::chrono::floor<std::chrono::days>(wall);
    const std::chrono::hh_mm_ss clock(wall - day);
    const std::chrono::year_month_day date(day);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                       clock.hours().count(), clock.minutes().count(), clock.seconds().count());
  };
  const auto time = record["time"].get<std::string>();
  return time >= text(begin) && time <= text(end);
}

bool LineStory::has_power(std::int64_t serial, Time from, Time to) const {
  return std::ranges::any_of(powered.at(serial),
                             [&](const Span& span) { return span.from <= to && span.to >= from; });
}

Time begin_of(const ToldRecord& told) {
  const json& duration = told.record["duration_s"];
  const double seconds = duration.is_null() ? 0 : duration.get<double>();
  return told.at - std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000) + 1);
}

std::optional<json> label_in(const json& record) {
  if (record["label"].is_null()) {
    return std::nullopt;
  }
  json label = json::parse(record["label"].get<std::string>(), nullptr, false);
  return label.is_number() ? json{{"serial_number", label}} : label;
}

} // namespace blactl::campaign
