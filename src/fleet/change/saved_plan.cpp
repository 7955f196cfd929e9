#include "blactl/fleet/change/saved_plan.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_reader.hpp"
#include "blactl/bla/config_sha256.hpp"
#include "blactl/bla/value.hpp"

#include "fleet/change/texts.hpp"
#include "fleet/files/settings_reader.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace blactl::fleet {
namespace {

class PlanReader {
 public:
  PlanReader(const bla::Profiles& profiles, json::Faults& faults)
      : profiles_(profiles), faults_(faults) {}

  SavedPlan read(const json::Value& root) {
    plan_.fleet.file = faults_.file();
    json::Object object(root, faults_);
    (void)object.word("schema", {"blactl/1"});
    (void)object.word("command", {"apply"});
    (void)object.any("interface");
    (void)object.integer("exit_status", 0, 0xFF);
    (void)object.object("counts");
    if (!object.array("errors").empty()) {
      faults_.add(root, say<texts::plan_not_finished>());
    }
    for (const json::Value* node : object.array("nodes")) {
      read_node(*node);
    }
    object.finish();
    return std::move(plan_);
  }

 private:
  void read_node(const json::Value& value) {
    json::Object node(value, faults_);
    FleetEntry entry{.name = text_or_null(node, "name"), .match = {}, .set = {}, .about = {}};
    const json::Value* unique_id = node.any("unique_id");
    for (const char* told :
         {"node_id", "serial_number", "servo_id", "hardware_version", "status"}) {
      (void)node.any(told); // for people
    }
    const auto changes = node.array("changes");
    const json::Value* model = node.any("model");
    const json::Value* firmware = node.any("firmware_version");
    if (!node.has("action")) { // no entry, or not selected
      node.finish();
      return;
    }
    SavedStep step{.need = read_need(node), .saves = node.boolean("saves")};
    step.settings_sha256 = node.optional_string("config_sha256").value_or(std::string());
    if (model != nullptr && firmware != nullptr) {
      step.model = json::as_string(*model, faults_).value_or(std::string());
      step.firmware_version = json::as_integer(*firmware, faults_).value_or(0);
    }
    (void)node.boolean("saved");
    const bool was_proven = node.boolean("verified_after_restart");
    for (const char* told : {"node_id_after", "duration_s", "warnings"}) {
      (void)node.optional_any(told);
    }
    node.finish();
    plan_.trusts_ram =
        plan_.trusts_ram || (step.need == Need::nothing && step.saves && !was_proven);
    take_unique_id(value, unique_id, entry);
    for (const json::Value* change : changes) {
      read_change(*change, entry, step);
    }
    std::ranges::sort(entry.set, {},
                      [](const bla::Assignment& each) { return each.parameter->address; });
    plan_.fleet.servos.push_back(std::move(entry));
    plan_.steps.push_back(std::move(step));
    lines_.push_back(value.line);
  }

  std::string text_or_null(json::Object& node, std::string_view key) {
    const json::Value* value = node.any(key);
    if (value == nullptr || value->kind == json::Kind::null) {
      return {};
    }
    return json::as_string(*value, faults_).value_or(std::string());
  }

  static Need read_need(json::Object& node) {
    constexpr std::array all{Need::nothing, Need::prove, Need::save, Need::write};
    const std::string word = node.word(
        "action", {name(Need::nothing), name(Need::prove), name(Need::save), name(Need::write)});
    const auto* const found =
        std::ranges::find_if(all, [&](Need need) { return name(need) == word; });
    return found != all.end() ? *found : Need::nothing;
  }

  void take_unique_id(const json::Value& node, const json::Value* value, FleetEntry& entry) {
    if (value == nullptr) {
      return;
    }
    entry.match.unique_id = value->kind == json::Kind::string
                                ? from_hex<std::tuple_size_v<dronecan::UniqueId>>(value->text)
                                : std::nullopt;
    if (!entry.match.unique_id) {
      faults_.add(*value, say<texts::plan_no_unique_id>());
      return;
    }
    const auto same = std::ranges::find_if(plan_.fleet.servos, [&](const FleetEntry& each) {
      return each.match.unique_id == entry.match.unique_id;
    });
    if (same != plan_.fleet.servos.end()) {
      const auto first = static_cast<std::size_t>(same - plan_.fleet.servos.begin());
      faults_.add(node, say<texts::plan_servo_twice>(lines_[first]));
    }
  }

  void read_change(const json::Value& value, FleetEntry& entry, SavedStep& step) {
    json::Object change(value, faults_);
    const std::string address = change.string("address");
    const std::int64_t requested = change.integer("requested");
    const std::int64_t before = change.integer("before");
    const std::string name = change.string("name");
    for (const char* told : {"after", "status"}) {
      (void)change.any(told);
    }
    change.finish();
    if (address.empty()) {
      return; // already reported
    }
    auto assignment = bla::make_assignment(profiles_, address, std::to_string(requested) + "raw");
    if (!assignment) {
      faults_.add(value, fault_text(assignment.error()));
    } else if (!assignment->parameter->is_setting()) {
      faults_.add(value, say<texts::plan_no_setting>(printable(address)));
    } else if (assignment->parameter->name != name) {
      faults_.add(value,
                  say<texts::plan_other_name>(printable(address), assignment->parameter->name));
    } else if (!step.before.try_emplace(assignment->parameter->address, before).second) {
      faults_.add(value, say<texts::plan_set_twice>(assignment->parameter->name));
    } else {
      entry.set.push_back(std::move(*assignment));
    }
  }

  const bla::Profiles& profiles_;
  json::Faults& faults_;
  SavedPlan plan_{};
  std::vector<std::size_t> lines_; ///< of the servos
};

std::string need_changed(Need now) {
  return now == Need::nothing || now == Need::save ? say<texts::plan_rom_proven>()
                                                   : say<texts::plan_rom_not_proven>();
}

/// Empty: nothing.
std::string what_changed(const SavedStep& step, const GoalResult& result) {
  const bla::Identity& identity = result.servo().identity;
  std::string out;
  if (identity.model() != step.model ||
      identity.readings().firmware_version != step.firmware_version) {
    out = say<texts::plan_other_unit>(printable(step.model), step.firmware_version);
  }
  for (const RegisterChange& change : result.change.changes) {
    const auto before = bla::find(step.before, change.parameter->address);
    if (before == change.before) {
      continue;
    }
    const auto shown = [&](std::optional<std::int64_t> raw) {
      return raw ? bla::display(*change.parameter, *raw, result.change.mode_before) : "?";
    };
    out += (out.empty() ? "" : ", ") +
           say<texts::plan_register>(change.parameter->name, shown(before), shown(change.before));
  }
  if (!out.empty()) {
    return out;
  }
  if (!step.settings_sha256.empty() && step.settings_sha256 != settings_sha256(result)) {
    return say<texts::plan_other_settings>();
  }
  return result.need != step.need ? need_changed(result.need) : out;
}

} // namespace

std::string settings_sha256(const GoalResult& result) {
  bla::Values settings = result.change.before;
  std::erase_if(settings,
                [&](const auto& held) { return !result.servo().identity.is_setting(held.first); });
  return bla::config_sha256(settings);
}

Result<SavedPlan> read_saved_plan(const std::filesystem::path& file,
                                  const bla::Profiles& profiles) {
  auto document = json::parse_file(file);
  if (!document) {
    return std::unexpected(document.error());
  }
  SavedPlan plan = PlanReader(profiles, document->faults()).read(document->root());
  if (const auto fine = document->faults().result(); !fine) {
    return std::unexpected(fine.error());
  }
  return plan;
}

std::vector<Error> stale(const SavedPlan& plan, std::span<const GoalResult> results) {
  std::vector<Error> errors;
  for (const GoalResult& result : results) {
    const auto entry = std::ranges::find_if(plan.fleet.servos, [&](const FleetEntry& each) {
      return each.match.unique_id == result.servo().unique_id;
    });
    const std::uint8_t id = result.servo().id.value();
    const std::string changed =
        entry != plan.fleet.servos.end() ? what_changed(plan.step(*entry), result) : std::string();
    if (!changed.empty()) {
      errors.push_back({Code::stale_plan, say<texts::plan_is_stale>(id, changed),
                        say<texts::plan_is_stale_hint>(), id});
    }
  }
  return errors;
}

} // namespace blactl::fleet
