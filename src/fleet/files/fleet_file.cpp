#include "blactl/fleet/files/fleet_file.hpp"

#include "blactl/base/hex.hpp"
#include "blactl/base/json_reader.hpp"

#include "fleet/files/settings_reader.hpp"
#include "fleet/files/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::fleet {

using bla::Assignment;
using dronecan::NodeId;

namespace {

/// An entry and its place in the file.
struct Read {
  FleetEntry entry;
  const json::Value* where = nullptr;
  std::vector<Setting> set; ///< entry.set, with its places
};

class Reader {
 public:
  Reader(const bla::Profiles& profiles, json::Faults& faults)
      : profiles_(profiles), faults_(faults) {}

  std::vector<FleetEntry> read(const json::Value& root) {
    json::Object object(root, faults_);
    (void)object.optional_string("$schema"); // for editors
    (void)object.word("schema", {fleet_schema});
    if (json::Object common = object.optional_object("common"); common.exists()) {
      common_ = read_settings(common.members(), profiles_, faults_);
    }
    for (const json::Value* item : object.array("servos")) {
      read_entry(*item);
    }
    object.finish();
    check_pairs();
    std::vector<FleetEntry> entries;
    entries.reserve(entries_.size());
    for (Read& each : entries_) {
      entries.push_back(std::move(each.entry));
    }
    return entries;
  }

 private:
  void read_entry(const json::Value& value) {
    json::Object object(value, faults_);
    Read read{.entry = {}, .where = &value, .set = {}};
    read.entry.name = object.string("name");
    if (json::Object match = object.object("match"); match.exists()) {
      read.entry.match = read_match(match);
    }
    if (json::Object set = object.optional_object("set"); set.exists()) {
      read.set = read_settings(set.members(), profiles_, faults_);
    }
    if (json::Object about = object.optional_object("about"); about.exists()) {
      read.entry.about = read_about(about);
    }
    object.finish();
    if (!object.exists()) {
      return;
    }
    add_common(read);
    check(read);
    entries_.push_back(std::move(read));
  }

  Match read_match(json::Object& object) {
    Match match;
    if (const auto digits = object.optional_string("unique_id")) {
      match.unique_id = from_hex<std::tuple_size_v<dronecan::UniqueId>>(*digits);
      if (!match.unique_id) {
        faults_.add(object.value(), say<texts::fleet_no_unique_id>());
      }
    }
    constexpr std::int64_t most_of_32_bits = 0xFFFFFFFF;
    constexpr std::int64_t most_of_8_bits = 0xFF;
    match.serial_number = object.optional_integer("serial_number", 0, most_of_32_bits);
    match.servo_id = object.optional_integer("servo_id", 0, most_of_8_bits);
    if (const auto id = object.optional_integer("node_id", 1, NodeId::max)) {
      match.node_id = NodeId(static_cast<std::uint8_t>(*id));
    }
    match.model = object.optional_string("model").value_or(std::string());
    object.finish();
    if (object.has("model") && profiles_.matching(match.model).empty()) {
      faults_.add(object.value(), say<texts::fleet_no_model>(printable(match.model)));
    }
    if (object.value().items.empty()) {
      faults_.add(object.value(), say<texts::fleet_empty_match>());
    }
    return match;
  }

  static About read_about(json::Object& object) {
    About about;
    about.model = object.optional_string("model");
    about.firmware_version = object.optional_integer("firmware_version");
    about.hardware_version = object.optional_integer("hardware_version");
    about.production_date = object.optional_string("production_date");
    about.time = object.optional_string("time");
    about.tool_version = object.optional_string("tool_version");
    object.finish();
    return about;
  }

  /// The entry's own values take precedence over common ones.
  void add_common(Read& read) const {
    for (const Setting& setting : common_) {
      if (find(read.set, setting.assignment.parameter->address) == nullptr) {
        read.set.push_back(setting);
      }
    }
    std::ranges::sort(read.set, {},
                      [](const Setting& setting) { return setting.assignment.parameter->address; });
    std::ranges::transform(read.set, std::back_inserter(read.entry.set), &Setting::assignment);
  }

  void check(const Read& read) {
    if (read.entry.name.empty() && read.where->kind == json::Kind::object) {
      faults_.add(*read.where, say<texts::fleet_no_name>());
    }
    if (!read.entry.match.model.empty()) {
      check_model(read.set, profiles_.matching(read.entry.match.model), faults_);
    }
    check_pwm(read.set, profiles_, faults_);
    const Match& match = read.entry.match;
    if (!match.means_one()) {
      check_ids_of_many(read);
    } else if (!match.unique_id && !match.serial_number) {
      check_found_again(read);
    }
  }

  void check_ids_of_many(const Read& read) {
    for (const bla::Address address : {bla::address::servo_id, bla::address::static_node_id}) {
      const Setting* id = find(read.set, address);
      if (id != nullptr && id->assignment.value.raw != 0) {
        faults_.add(*id->where, say<texts::fleet_id_of_many>(id->assignment.parameter->name));
      }
    }
  }

  /// On a second run such an entry would match no servo, or another one.
  void check_found_again(const Read& read) {
    const Match& match = read.entry.match;
    const auto check = [&](bla::Address address, std::optional<std::int64_t> matched) {
      const Setting* id = find(read.set, address);
      if (id != nullptr && matched && id->assignment.value.raw != *matched) {
        faults_.add(*id->where, say<texts::fleet_not_found_again>(id->assignment.parameter->name));
      }
    };
    check(bla::address::servo_id, match.servo_id);
    check(bla::address::static_node_id,
          match.node_id ? std::optional<std::int64_t>(match.node_id->value()) : std::nullopt);
  }

  /// Checks for conflicts between two entries.
  void check_pairs() {
    for (std::size_t second = 0; second < entries_.size(); ++second) {
      for (std::size_t first = 0; first < second && !faults_.are_many(); ++first) {
        check_pair(entries_[first], entries_[second]);
      }
    }
  }

  void check_pair(const Read& first, const Read& second) {
    const FleetEntry& one = first.entry;
    const FleetEntry& other = second.entry;
    if (!one.name.empty() && one.name == other.name) {
      faults_.add(*second.where, say<texts::fleet_name_twice>(first.where->line));
    }
    if (mean_the_same(one.match, other.match)) {
      faults_.add(*second.where, say<texts::fleet_servo_twice>(first.where->line));
    }
    for (const bla::Address address : {bla::address::servo_id, bla::address::static_node_id}) {
      const Setting* id = find(second.set, address);
      if (id != nullptr && id->assignment.value.raw != 0 &&
          one.wish(address) == id->assignment.value.raw) {
        faults_.add(*second.where,
                    say<texts::fleet_id_twice>(id->assignment.parameter->name,
                                               id->assignment.value.raw, first.where->line));
      }
    }
  }

  /// At least one key is equal, and none differs. Other pairs that match one servo show on the bus.
  static bool mean_the_same(const Match& one, const Match& other) {
    bool same = false;
    bool differ = false;
    const auto compare = [&](const auto& left, const auto& right) {
      same = same || (left && right && *left == *right);
      differ = differ || (left && right && *left != *right);
    };
    compare(one.unique_id, other.unique_id);
    compare(one.serial_number, other.serial_number);
    compare(one.servo_id, other.servo_id);
    compare(one.node_id, other.node_id);
    const bool are_models = !one.means_one() && !other.means_one() && !one.model.empty();
    return !differ && (same || (are_models && one.model == other.model));
  }

  const bla::Profiles& profiles_;
  json::Faults& faults_;
  std::vector<Setting> common_;
  std::vector<Read> entries_;
};

Result<FleetFile> read_document(Result<json::Document> document, const bla::Profiles& profiles) {
  return document ? read_fleet_file(*document, profiles) : std::unexpected(document.error());
}

} // namespace

bool Match::means(const Servo& servo, const bla::Profiles& profiles) const {
  const auto agrees = [](const auto& wanted, const auto& told) {
    return !wanted || told == wanted;
  };
  const auto models = profiles.matching(model);
  return servo.is_servo && agrees(unique_id, servo.unique_id) &&
         agrees(serial_number, servo.identity.readings().serial_number) &&
         agrees(servo_id, servo.servo_id) &&
         (!node_id || (servo.id_is_known && servo.id == *node_id)) &&
         (model.empty() || std::ranges::find(models, servo.identity.profile()) != models.end());
}

std::optional<std::int64_t> FleetEntry::wish(bla::Address address) const {
  const auto it = std::ranges::find_if(
      set, [&](const Assignment& assignment) { return assignment.parameter->address == address; });
  return it != set.end() ? std::optional(it->value.raw) : std::nullopt;
}

std::optional<std::int64_t> FleetEntry::pwm_mode() const {
  if (const auto mode = wish(bla::address::pwm_mode)) {
    return mode;
  }
  const auto by_unit = std::ranges::find_if(
      set, [](const Assignment& assignment) { return assignment.value.pwm_mode.has_value(); });
  return by_unit != set.end() ? by_unit->value.pwm_mode : std::nullopt;
}

Result<const FleetEntry*> find_entry(const FleetFile& file, std::string_view name) {
  const auto found = std::ranges::find(file.servos, name, &FleetEntry::name);
  if (found != file.servos.end()) {
    return &*found;
  }
  std::string names;
  for (const FleetEntry& entry : file.servos) {
    names += (names.empty() ? "" : ", ") + printable(entry.name);
  }
  return fail(Code::usage, say<texts::fleet_no_entry>(printable(file.file), printable(name)),
              say<texts::fleet_no_entry_hint>(names));
}

Result<FleetFile> parse_fleet_file(std::string_view text, std::string file,
                                   const bla::Profiles& profiles) {
  return read_document(json::parse(text, std::move(file)), profiles);
}

Result<FleetFile> read_fleet_file(const std::filesystem::path& file,
                                  const bla::Profiles& profiles) {
  return read_document(json::parse_file(file), profiles);
}

Result<FleetFile> read_fleet_file(json::Document& document, const bla::Profiles& profiles) {
  FleetFile file{document.faults().file(),
                 Reader(profiles, document.faults()).read(document.root())};
  if (const auto fine = document.faults().result(); !fine) {
    return std::unexpected(fine.error());
  }
  return file;
}

} // namespace blactl::fleet
