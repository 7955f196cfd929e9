#include "judge.hpp"

#include "claims.hpp"
#include "limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace blactl::campaign {
namespace {

using nlohmann::json;

std::string name(std::uint8_t address) {
  return fmt::format("{:#04x}", address);
}

bool saves(const Command& command) {
  const std::string& verb = command.verb();
  return command.has("--save") || verb == "save" || command.has("--static") ||
         ((verb == "apply" || verb == "undo") && !command.has("--no-save") &&
          !command.has("--dry-run")) ||
         verb == "replace" || verb == "characterize";
}

bool only_looks(const Command& command) {
  static const std::set<std::string> verbs{"get", "doctor", "faults", "export", "monitor"};
  return (verbs.contains(command.verb()) && !command.has("--identify")) ||
         command.has("--dry-run") || command.has("--list");
}

// The document.

void check_document(const Step& step) {
  const Outcome& outcome = step.outcome;
  const std::string& verb = step.command.verb();
  const bool finds = verb == "doctor" || verb == "faults";
  const bool compares = finds || (verb == "apply" && step.command.has("--dry-run"));
  require((outcome.status >= 0 && outcome.status <= 7) || outcome.status == 9 ||
              (outcome.status == 8 && compares),
          fmt::format("exit status {}", outcome.status));
  const json& document = outcome.document;
  require(document.is_object(), "no document");
  require(document["exit_status"] == outcome.status, "another exit status in the document");
  const json& errors = document["errors"];
  require(errors.empty() == (outcome.status == 0 || outcome.status == 8) || finds,
          fmt::format("exit status {}, {} errors", outcome.status, errors.size()));
  for (const json& error : errors) {
    require(error["code"] != "internal", "an exception");
    require(outcome.err.find("[" + error["code"].get<std::string>() + "]") != std::string::npos,
            "an error of the document is not on stderr");
  }
}

// What is told of one servo.

class Told {
 public:
  Told(const Step& step, std::int64_t serial, const json& node)
      : step_(step), serial_(serial), node_(node), status_(node.value("status", "")),
        is_saved_(node.contains("saved") && node["saved"] == true),
        is_verified_(node.value("verified_after_restart", false)), after_(step.after.at(serial)) {}

  void check() const {
    if (step_.command.has("--dry-run")) {
      require(!is_saved_, "a plan that has saved");
      return;
    }
    hold(!is_proven() || !after_.has_lost_rom() || !is_ram_known(),
         "proven, but its ROM could not be read");
    check_changes();
    if (status_ == "done") {
      check_done();
    }
    if (status_ == "unchanged") {
      hold(!is_saved_, "unchanged, but saved");
      hold(step_.rom_writes(serial_) == 0 || step_.has_other_writer(serial_),
           "unchanged, but ROM was written");
    }
    if (node_.contains("node_id_after") && !node_["node_id_after"].is_null() && is_reached() &&
        is_ram_known()) {
      hold(node_["node_id_after"] == after_.node_id, "it is at another node ID than told");
    }
    check_params();
  }

  /// Whether what was asked for is told to be so.
  [[nodiscard]] bool is_reached() const { return campaign::is_reached(node_); }

  [[nodiscard]] bool is_proven() const { return is_saved_ || is_verified_; }

 private:
  void hold(bool truth, const std::string& what) const {
    require(truth, fmt::format("{}: {}", serial_, what));
  }

  [[nodiscard]] bool is_ram_known() const { return !step_.changed_unheard(serial_); }

  void require_held(const char* memory, const Registers& registers, std::uint8_t address,
                    std::int64_t value) const {
    const auto found = registers.find(address);
    const std::int64_t held = found != registers.end() ? found->second : 0;
    hold(held == value,
         fmt::format("{} of {} holds {}, told was {}", memory, name(address), held, value));
  }

  void check_changes() const {
    if (!node_.contains("changes")) {
      return;
    }
    const bool is_whole = status_.empty() || is_reached(); // else every change stands for itself
    for (const json& change : node_["changes"]) {
      if (!is_held(change)) {
        hold(!is_whole || !is_saved_,
             fmt::format("saved, but a change is {}", change["status"].dump()));
        hold(!is_whole || status_.empty(), "reached, but not every change");
        continue;
      }
      const std::uint8_t address = address_in(change["address"]);
      const auto value = change["requested"].get<std::int64_t>();
      hold(change["after"] == value, "written, but not as requested");
      if (is_proven() || is_in_rom_without()) {
        if (!step_.is_written_unheard(serial_)) {
          require_held("ROM", after_.rom, address, value);
        }
      }
      if (is_ram_known()) {
        require_held("RAM", after_.ram, address, value);
      }
    }
  }

  /// What --save has not saved since ROM holds it is in ROM as well; undo goes back in RAM only
  /// where that was all.
  [[nodiscard]] bool is_in_rom_without() const {
    return saves(step_.command) && step_.outcome.status == 0 && !after_.has_lost_rom() &&
           !step_.command.has("--trust-ram") && step_.command.verb() != "undo";
  }

  void check_done() const {
    const std::string& verb = step_.command.verb();
    if (verb == "restart") {
      hold(!step_.restarts(serial_).empty(), "it was not restarted");
    }
    if (step_.has_other_writer(serial_) || after_.has_lost_rom()) {
      return;
    }
    if (verb == "restart" || verb == "save") {
      check_same_memories();
    }
    if (verb == "save") {
      check_saved();
    } else if (verb == "erase") {
      check_erased();
    }
  }

  void check_same_memories() const {
    if (!is_ram_known()) {
      return;
    }
    for (const auto& [address, value] : after_.rom) {
      require_held("RAM", after_.ram, address, value);
    }
  }

  /// ROM is what RAM was when the command first heard of the servo.
  void check_saved() const {
    const ServoState& before = step_.before.at(serial_);
    const Time first = step_.outcome.record.first_told_by(step_.node_ids(serial_));
    const auto restarts = step_.restarts(serial_);
    const Duration late = step_.hears_all() ? on_its_way : tolerance;
    const bool restarted =
        std::ranges::any_of(restarts, [&](Time at) { return at - late < first; });
    if (restarted && before.has_lost_rom()) {
      return;
    }
    for (const auto& [address, rom] : before.rom) {
      require_held("ROM", after_.rom, address, restarted ? rom : before.ram.at(address));
    }
  }

  /// What it held before then is in nobody's hands.
  [[nodiscard]] bool has_restarted_before_change() const {
    const auto ids = step_.node_ids(serial_);
    const auto changes = step_.outcome.record.changes();
    const auto first = std::ranges::find_if(
        changes, [&](const OnWire& each) { return ids.contains(each.destination()); });
    const auto restarts = step_.restarts(serial_);
    return first != changes.end() &&
           std::ranges::any_of(restarts, [&](Time at) { return at < first->at; });
  }

  void check_erased() const {
    const bool saved = saves(step_.command);
    if (!saved && !is_ram_known()) {
      return;
    }
    const bool keeps = step_.command.has("--keep-ids");
    for (const std::uint8_t address : {servo_id, static_node_id}) {
      const ServoState& before = step_.before.at(serial_);
      const std::int64_t held = keeps ? before.ram.at(address) : 0;
      const std::int64_t in_rom = before.rom.at(address);
      // one that broke off has left 0 in RAM: then what that run began with is brought back, or
      // ROM's, as by a restart
      const bool may_come_back = held == 0 || has_restarted_before_change();
      const std::int64_t now = after_.ram.at(address);
      const bool is_tried =
          step_.tried && held == 0 && now == step_.tried->at(serial_).ram.at(address);
      const bool is_brought_back = keeps && ((may_come_back && now == in_rom) || is_tried);
      const std::int64_t due = is_brought_back ? now : held;
      require_held("RAM", after_.ram, address, due);
      if (saved) {
        require_held("ROM", after_.rom, address, due);
      }
    }
    for (const auto& [address, limit] : limits().of(step_.model(serial_))) {
      require_held("RAM", after_.ram, address, limit.factory);
      if (saved) {
        require_held("ROM", after_.rom, address, limit.factory);
      }
    }
  }

  /// All values of one servo were true at one moment.
  void check_params() const {
    if (!node_.contains("params") || step_.outcome.status != 0 || step_.has_other_writer(serial_)) {
      return;
    }
    const ServoState& before = step_.before.at(serial_);
    const auto was_so = [&](const Registers& held) {
      return std::ranges::all_of(node_["params"], [&](const json& param) {
        const auto found = held.find(address_in(param["address"]));
        return found == held.end() || !after_.rom.contains(found->first) ||
               found->second == param["raw"].get<std::int64_t>();
      });
    };
    hold(was_so(before.ram) || was_so(after_.ram) || was_so(before.rom),
         "these values never stood in RAM together");
  }

  const Step& step_;
  std::int64_t serial_;
  const json& node_;
  std::string status_;
  bool is_saved_, is_verified_;
  const ServoState& after_;
};

// What was sent.

/// No value that the tables forbid, and nothing but what was asked for.
void check_writes(const Step& step) {
  for (const SentWrite& write : step.outcome.record.writes()) {
    require(!only_looks(step.command), "a command that only looks has written");
    if (step.command.verb() == "characterize") {
      continue; // it finds out what a servo does with such a value
    }
    for (const json& servo : step.episode.scenario["servos"]) {
      const auto serial = servo["serial_number"].get<std::int64_t>();
      const auto& known = limits().of(servo["model"].get<std::string>());
      const auto limit = known.find(write.address);
      if (step.node_ids(serial).contains(write.destination) && limit != known.end() &&
          !step.is_doubled(serial)) {
        require(write.value >= limit->second.min && write.value <= limit->second.max,
                fmt::format("{} = {} was sent to {}, {} to {} is allowed", name(write.address),
                            write.value, serial, limit->second.min, limit->second.max));
      }
    }
  }
}

/// Armed and driven end what is under way. Each write of characterize serves to move the servo.
void check_guard(const Step& step) {
  const Record& record = step.outcome.record;
  const bool is_bench = step.command.verb() == "characterize";
  const Duration late = step.hears_all() ? on_its_way : tolerance;
  for (const OnWire& frame : record.changes()) {
    require(frame.at - late < record.armed_at(),
            fmt::format("a change was sent to an armed vehicle {} us after that was heard",
                        (frame.at - record.armed_at()).count()));
    require(!(frame.is_order() || is_bench) || frame.at - late < record.driven_at(),
            fmt::format("an order was sent to a driven servo {} us after that was heard",
                        (frame.at - record.driven_at()).count()));
  }
}

/// A refusal has changed nothing.
void check_refusal(const Step& step) {
  const int status = step.outcome.status;
  const auto sent = step.outcome.record.changes();
  if ((status != 2 && status != 7) || sent.empty()) {
    return;
  }
  throw Lie(fmt::format("refused with {}, but {} changes were sent", status, sent.size()));
}

/// Whom the command does not mean, it leaves alone.
void check_others(const Step& step) {
  for (const auto& [serial, after] : step.after) {
    if (step.means(serial) && !only_looks(step.command)) {
      continue;
    }
    if (step.has_other_writer(serial) || step.command.verb() == "undo" || step.is_doubled(serial)) {
      continue;
    }
    require(step.rom_writes(serial) == 0,
            fmt::format("ROM of {} was written, which is not meant", serial));
    if (!step.restarts(serial).empty()) {
      continue;
    }
    for (const auto& [address, value] : after.rom) {
      require(after.ram.at(address) == step.before.at(serial).ram.at(address),
              fmt::format("{} of {} has changed, which is not meant", name(address), serial));
    }
  }
}

/// One a servo, two for one that makes way for others.
void check_rom_writes(const Step& step) {
  const Command& command = step.command;
  const bool moves = command.verb() == "undo" || command.verb() == "apply";
  const std::uint32_t most = saves(command) ? (moves ? 2 : 1) : 0;
  for (const auto& [serial, after] : step.after) {
    if (step.has_other_writer(serial)) {
      continue;
    }
    const std::uint32_t count = step.rom_writes(serial);
    require(count <= most, fmt::format("{}: {} ROM writes", serial, count));
  }
}

void check_success(const Step& step, bool all_reached, std::size_t told) {
  static const std::set<std::string> streams{"alloc", "command", "monitor"};
  if (step.outcome.status != 0 || only_looks(step.command) ||
      streams.contains(step.command.verb())) {
    return;
  }
  require(told > 0, "0, but of no servo");
  require(all_reached, "0, but not everything is done");
}

/// Two units of one unique ID, there all the time, are not changed.
void check_doubled(const Step& step, std::int64_t serial, const Told& told) {
  const auto stayed = [&](std::int64_t one) {
    return step.accidents(one).empty() && step.restarts(one).empty();
  };
  const bool was_quiet = stayed(serial) && std::ranges::all_of(step.copies(serial), stayed) &&
                         step.begin > Time{} + settled;
  if (!step.shows_doubled(serial) || !was_quiet || only_looks(step.command) ||
      step.episode.scenario.contains("wire") || step.episode.has("no_node_status")) {
    return;
  }
  require(!told.is_reached() || step.outcome.status != 0,
          fmt::format("0, but {} is one of two", serial));
}

/// A servo and another node on its ID, and nothing else: that is what commands say of it.
void check_conflict(const Step& step) {
  const bool is_plain = step.episode.has("node_on_id") && step.episode.faults.size() == 1;
  if (!is_plain || !step.outcome.document.contains("errors")) {
    return;
  }
  for (const json& error : step.outcome.document["errors"]) {
    require(error["code"] != "timeout", "told of a node that it does not answer, but two do");
  }
}

/// An ID is one unit's.
void check_allocation(const Step& step) {
  if (step.command.verb() != "alloc" || !step.command.has("--list") || step.outcome.status != 0) {
    return;
  }
  std::map<int, std::string> holders;
  for (const json& entry : step.outcome.document["entries"]) {
    const auto [known, is_new] =
        holders.emplace(entry["node_id"].get<int>(), entry["unique_id"].get<std::string>());
    require(is_new, "an ID is two units'");
  }
}

/// No unit gets the node ID of another that was heard there.
void check_given(const Step& step) {
  if (step.episode.has("allocator")) {
    return;
  }
  std::map<std::uint8_t, std::int64_t> holders;
  for (const auto& [serial, servo] : step.before) {
    if (servo.node_id != 0) {
      holders[servo.node_id] = serial;
    }
  }
  for (const sim::ServoEvent& event : step.events) {
    const std::uint8_t id = event.node_id.value();
    if (event.kind == sim::ServoEvent::Kind::restart) {
      holders.erase(id);
    }
    if (event.kind != sim::ServoEvent::Kind::allocated) {
      continue;
    }
    const auto held = holders.try_emplace(id, event.serial_number).first;
    const std::int64_t holder = held->second;
    held->second = event.serial_number;
    const bool is_other = holder != event.serial_number && step.copies(holder).empty();
    const bool is_heard = step.outcome.record.first_told_by({id}) + on_its_way < event.at;
    require(!is_other || !is_heard || !step.accidents(holder).empty(),
            fmt::format("{} was given to {}, but {} has it", id, event.serial_number, holder));
  }
}

} // namespace

void judge(const Step& step) {
  check_document(step);
  check_guard(step);
  check_refusal(step);
  check_writes(step);
  check_others(step);
  check_rom_writes(step);
  check_conflict(step);
  check_allocation(step);
  check_given(step);
  bool all_reached = true;
  const auto told = told_servos(step);
  for (const auto& [serial, node] : told) {
    const Told one(step, serial, *node);
    one.check();
    const std::string status = node->value("status", "");
    if (status != "extra" && status != "skipped") {
      all_reached = all_reached && one.is_reached();
      check_doubled(step, serial, one);
    }
  }
  check_success(step, all_reached, told.size());
  check_claims(step);
}

} // namespace blactl::campaign
