// Every cell of the specification's tables against the profiles of the binary, and back: nothing in
// the profiles that no table has.

#include "blactl/bla/profile.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"
#include "unit/bla/csv.hpp"

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>

using namespace blactl;
using namespace blactl::bla;
using test::built_in;
using test::read_table;
using test::Row;

namespace {

std::string text(const std::optional<std::int64_t>& number) {
  return number ? std::to_string(*number) : "";
}

/// A unit as the tables have it: "0.1deg".
std::string table_unit(const Parameter& parameter) {
  switch (parameter.unit) {
  case Unit::year: return "year";
  case Unit::month: return "month";
  case Unit::day: return "day";
  case Unit::hour: return "hour";
  case Unit::minute: return "minute";
  default: break;
  }
  const std::string unit(name(parameter.unit));
  return parameter.steps_per_unit == 10 ? "0.1" + unit : unit;
}

/// The cast in "… Vendor cast uint16, …"; registers without one are whole 32-bit integers.
std::string table_width(const std::string& note) {
  const std::string before = "cast ";
  const std::size_t at = note.find(before);
  if (at == std::string::npos) {
    return "int32";
  }
  const std::string cast = note.substr(at + before.size());
  return cast.substr(0, cast.find_first_not_of("uint12368"));
}

std::string width(const Parameter& parameter) {
  return (parameter.width.is_signed ? "int" : "uint") + std::to_string(parameter.width.bits);
}

/// The width of a text on a terminal: Japanese characters, three bytes each, take two columns.
std::size_t columns(const std::string& text) {
  std::size_t width = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    width += byte >= 0xE0 ? 2 : byte < 0x80 ? 1 : 0;
  }
  return width;
}

Address address_of(const Row& row, const std::string& column = "address") {
  const auto address = find_address(row.at(column));
  REQUIRE(address);
  return *address;
}

} // namespace

TEST_CASE("profiles hold every register of tables 3-1 to 3-11 and no other") {
  const auto rows = read_table("parameters.csv", 96);
  std::size_t reserved = 0;
  std::size_t compared = 0;
  for (const Row& row : rows) {
    INFO(row.at("address"));
    const Parameter* general = built_in().find(address_of(row));
    if (row.at("name_en") == "Reserve") {
      CHECK(general == nullptr);
      ++reserved;
      continue;
    }
    REQUIRE(general != nullptr);
    for (const Profile& profile : built_in().all()) {
      INFO(profile.model);
      const Parameter* parameter = profile.find(general->address);
      REQUIRE(parameter != nullptr);
      CHECK(name(parameter->group) == row.at("group"));
      CHECK(parameter->name_en == row.at("name_en"));
      CHECK(parameter->name_ja == row.at("name_ja"));
      CHECK(parameter->vendor_label == row.at("vendor_label"));
      CHECK(name(parameter->access) == row.at("access"));
      CHECK(table_unit(*parameter) == row.at("unit"));
      CHECK(parameter->per_model == (row.at("per_model") == "yes"));
      CHECK(parameter->saved == (row.at("persisted") == "yes"));
      CHECK(text(parameter->min_firmware) == row.at("min_firmware"));
      CHECK(width(*parameter) == table_width(row.at("note")));
      if (!parameter->per_model) {
        CHECK(text(parameter->default_raw) == row.at("default"));
        CHECK(text(parameter->min) == row.at("min"));
        CHECK(text(parameter->max) == row.at("max"));
        CHECK_FALSE(parameter->by_voltage_class);
        CHECK_FALSE(parameter->by_suffix);
      }
      ++compared;
    }
  }
  CHECK(reserved == 37);
  CHECK(compared == 590);
  CHECK(built_in().registers().size() == 59);
  for (const Profile& profile : built_in().all()) {
    CHECK(profile.parameters.size() == 59);
    CHECK(std::ranges::is_sorted(profile.parameters, {}, &Parameter::address));
  }
}

TEST_CASE("the ten models of table 3-12 are there") {
  std::vector<std::string> models;
  for (const Profile& profile : built_in().all()) {
    models.push_back(profile.model);
    CHECK(profile.model == profile.series + '-' + profile.voltage_class + '-' + profile.suffix);
    CHECK(profile.pwm == (profile.suffix == "AB"));
  }
  CHECK(models == std::vector<std::string>{"BLA15-06U-A0", "BLA15-12U-A0", "BLA21-06U-A0",
                                           "BLA21-06U-AB", "BLA21-12U-A0", "BLA21-12U-AB",
                                           "BLA21-28U-A0", "BLA21-28U-AB", "BLA34-12U-AB",
                                           "BLA34-28U-AB"});
}

TEST_CASE("every model has the defaults and ranges of table 3-12") {
  const auto rows = read_table("model_parameters.csv", 86);
  std::size_t compared = 0;
  for (const Profile& profile : built_in().all()) {
    std::set<Address> seen;
    for (const Row& row : rows) {
      const bool means_it =
          row.at("series") == profile.series &&
          (row.at("variant") == "*" || row.at("variant") == profile.voltage_class) &&
          (row.at("suffix") == "*" || row.at("suffix") == profile.suffix);
      if (!means_it) {
        continue;
      }
      INFO(profile.model << ' ' << row.at("address"));
      const Parameter* parameter = profile.find(address_of(row));
      REQUIRE(parameter != nullptr);
      CHECK(parameter->per_model);
      CHECK(text(parameter->default_raw) == row.at("default"));
      CHECK(text(parameter->min) == row.at("min"));
      CHECK(text(parameter->max) == row.at("max"));
      CHECK(seen.insert(parameter->address).second);
      if (parameter->readable() && !parameter->writable()) {
        continue; // 0x50, 0x53 are no settings
      }
      CHECK(parameter->by_voltage_class == (row.at("variant") != "*"));
      ++compared;
    }
    CHECK(seen.size() == 20);
    CHECK(profile.find(address::model_number)->default_raw == profile.model_number);
    CHECK(profile.find(address::hardware_version)->default_raw == profile.hardware_version);
    for (const Parameter& parameter : profile.parameters) {
      CHECK(parameter.per_model == seen.contains(parameter.address));
    }
  }
  CHECK(compared == 180);
}

TEST_CASE("every row of table 3-12 describes some model") {
  for (const Row& row : read_table("model_parameters.csv", 86)) {
    INFO(row.at("series") << ' ' << row.at("variant") << ' ' << row.at("suffix"));
    CHECK(std::ranges::any_of(built_in().all(), [&](const Profile& profile) {
      return row.at("series") == profile.series &&
             (row.at("variant") == "*" || row.at("variant") == profile.voltage_class) &&
             (row.at("suffix") == "*" || row.at("suffix") == profile.suffix);
    }));
  }
}

TEST_CASE("enumerations have the values and texts of chapter 4") {
  std::set<std::pair<Address, std::int64_t>> known;
  for (const Row& row : read_table("enums.csv", 24)) {
    INFO(row.at("address") << ' ' << row.at("raw_value"));
    const Parameter* parameter = built_in().find(address_of(row));
    REQUIRE(parameter != nullptr);
    const Choice* choice = parameter->choice(std::stoll(row.at("raw_value")));
    REQUIRE(choice != nullptr);
    CHECK(choice->text_en == row.at("meaning_en"));
    CHECK(choice->text_ja == row.at("meaning_ja"));
    known.emplace(parameter->address, choice->raw);
  }
  std::size_t found = 0;
  for (const Parameter& parameter : built_in().registers()) {
    for (const Choice& choice : parameter.choices) {
      CHECK(known.contains({parameter.address, choice.raw}));
      ++found;
    }
  }
  CHECK(found == 24);
}

TEST_CASE("enumerations have the words that people type") {
  const auto words = [](std::uint8_t address) {
    std::string all;
    for (const Choice& choice : built_in().find(Address(address))->choices) {
      all += choice.word + '=' + std::to_string(choice.raw) + ' ';
    }
    return all;
  };
  CHECK(words(0x20) == "on=0 off=1 brake=2 ");
  for (std::uint8_t address = 0x21; address <= 0x25; ++address) {
    CHECK(words(address) == "off=0 on=1 ");
  }
  CHECK(words(0x26) == "hold=0 off=1 brake=2 ");
  CHECK(words(0x37) == "angle=0 speed=1 ");
  CHECK(words(0x50) == "BLA21=61 BLA15=62 BLA34=86 ");
}

TEST_CASE("fault bits are those of 4.12 and of the vendor's program, and no other") {
  const auto parameters = read_table("parameters.csv", 96);
  const auto name_of = [&](const std::string& address) {
    return std::ranges::find_if(parameters,
                                [&](const Row& row) { return row.at("address") == address; })
        ->at("name_en");
  };
  // "[0x08] >= [0x38]" reads "[0x08] Current Angle at or above [0x38] …" to people.
  const auto spelled_out = [&](const std::string& condition) {
    const std::string sign = condition.size() == 16 ? condition.substr(6, 4) : "";
    if (sign != " >= " && sign != " <= ") {
      return condition;
    }
    const std::string left = condition.substr(1, 4);
    const std::string right = condition.substr(11, 4);
    return '[' + left + "] " + name_of(left) + " at or " + (sign == " >= " ? "above" : "below") +
           " [" + right + "] " + name_of(right);
  };
  std::size_t found = 0;
  for (const Row& row : read_table("fault_bits.csv", 34)) {
    INFO(row.at("register") << ' ' << row.at("bit"));
    if (row.at("register") == "0x18") {
      continue; // below
    }
    const auto bit = std::ranges::find_if(built_in().fault_bits(), [&](const FaultBit& each) {
      return each.reg.name() == row.at("register") && std::to_string(each.bit) == row.at("bit");
    });
    REQUIRE(bit != built_in().fault_bits().end());
    CHECK(bit->group == row.at("group"));
    CHECK(bit->text_en == row.at("label_en"));
    CHECK(bit->text_ja == row.at("label_ja"));
    CHECK(bit->condition_en == spelled_out(row.at("condition_en")));
    CHECK(bit->condition_ja == row.at("condition_ja"));
    CHECK(bit->pwm_only == (row.at("pwm_only") == "yes"));
    CHECK(bit->latched == row.at("latched_note").starts_with("Reports the cause"));
    CHECK_FALSE(bit->vendor_only);
    ++found;
  }
  for (const Row& row : read_table("fault_bits_vendor_only.csv", 4)) {
    INFO(row.at("register") << ' ' << row.at("bit"));
    const auto bit = std::ranges::find_if(built_in().fault_bits(), [&](const FaultBit& each) {
      return each.reg.name() == row.at("register") && std::to_string(each.bit) == row.at("bit");
    });
    REQUIRE(bit != built_in().fault_bits().end());
    CHECK(bit->group == row.at("group"));
    // The same words, with the program's misspelling mended.
    const auto plain = [](std::string label) {
      if (const std::size_t at = label.find("Sencer"); at != std::string::npos) {
        label.replace(at, 6, "Sensor");
      }
      std::ranges::transform(label, label.begin(), [](unsigned char c) { return std::tolower(c); });
      return label;
    };
    CHECK(plain(bit->text_en) == plain(row.at("vendor_tool_label")));
    CHECK(bit->vendor_only);
    ++found;
  }
  CHECK(found == 26);
  CHECK(built_in().fault_bits().size() == 26);
}

namespace {

/// "Any bit 0-7 of 0x19 is 1 (there is notification level information about hardware)" reads
/// "0x19 has a notice about hardware (bits 0-7)" to people.
std::string in_short(const std::string& condition) {
  const std::regex form("Any bit (\\S+) of (\\S+) is 1 "
                        "\\(there is (\\S+) level information about (\\S+)\\)");
  std::smatch match;
  REQUIRE(std::regex_match(condition, match, form));
  const std::string level = match[3] == "notification" ? "notice" : match[3].str();
  const std::string group = match[4] == "other" ? "something else" : match[4].str();
  return match[2].str() + " has a " + level + " about " + group + " (bits " + match[1].str() + ')';
}

} // namespace

TEST_CASE("the bits of 0x18 follow from group and level") {
  std::size_t compared = 0;
  REQUIRE(built_in().summary_bits().size() == 12);
  for (const Row& row : read_table("fault_bits.csv", 34)) {
    if (row.at("register") != "0x18") {
      continue;
    }
    const FaultBit& own_bit = built_in().summary_bits()[compared];
    CHECK(own_bit.reg == address::fault_summary);
    CHECK(std::to_string(own_bit.bit) == row.at("bit"));
    CHECK(own_bit.code.empty());
    CHECK(own_bit.group == row.at("group"));
    CHECK(own_bit.text_en == row.at("label_en"));
    CHECK(own_bit.text_ja == row.at("label_ja"));
    CHECK(own_bit.condition_en == in_short(row.at("condition_en")));
    CHECK(own_bit.condition_ja == row.at("condition_ja"));
    const std::string level = row.at("label_en").substr(0, row.at("label_en").find(' '));
    for (const FaultBit& bit : built_in().fault_bits()) {
      const std::string own = bit.level == Level::notice    ? "Notification"
                              : bit.level == Level::warning ? "Warning"
                                                            : "Failure";
      const bool summed_up = own == level && bit.group == row.at("group");
      CHECK(summed_up == (std::to_string(summary_bit(bit.level, bit.bit)) == row.at("bit")));
    }
    ++compared;
  }
  CHECK(compared == 12);
}

TEST_CASE("fault bits have the codes that scripts read, in the order of levels and bits") {
  std::string codes;
  for (const FaultBit& bit : built_in().fault_bits()) {
    codes += std::string(name(bit.level)) + '.' + std::to_string(bit.bit) + '=' + bit.code + ' ';
    CHECK(bit.reg.value() == 0x19 + static_cast<int>(bit.level));
    // With an indent they fit in 80 columns.
    CHECK(columns(bit.action_en) <= 76);
    CHECK(columns(bit.action_ja) <= 76);
  }
  CHECK(codes == "notice.8=angle_limit_cw notice.9=angle_limit_ccw notice.10=speed_limit_cw "
                 "notice.11=speed_limit_ccw notice.12=torque_limit_cw notice.13=torque_limit_ccw "
                 "notice.20=pwm_missing notice.21=pwm_short notice.22=pwm_long "
                 "warning.4=angle_sensor_weak warning.5=angle_sensor_strong warning.6=memory "
                 "warning.8=temperature_high warning.9=temperature_low warning.10=voltage_high "
                 "warning.11=voltage_low warning.14=cpu_clock warning.15=rom_corrupt "
                 "failure.0=motor_driver failure.1=motor failure.4=angle_sensor_interface "
                 "failure.5=angle_sensor failure.8=clock failure.9=watchdog failure.10=rom "
                 "failure.11=ram ");
}

TEST_CASE("a model has had the releases from its first shipment to its last") {
  const auto versions = [](std::string_view model) {
    std::vector<std::int64_t> all;
    for (const FirmwareRelease* release :
         built_in().releases_of(*built_in().matching(model).front())) {
      all.push_back(release->version);
    }
    return all;
  };
  using Versions = std::vector<std::int64_t>;
  CHECK(versions("BLA21-12U-AB") == Versions{1100, 1200, 1300, 1400});
  CHECK(versions("BLA21-06U-A0") == Versions{1010, 1100, 1200, 1300, 1400});
  CHECK(versions("BLA15-12U-A0") == Versions{1200, 1300, 1400});
  CHECK(versions("BLA34-28U-AB") == Versions{1500});
}

TEST_CASE("the firmware history is that of chapter 5") {
  const auto rows = read_table("firmware_history.csv", 7);
  // "2021-10" is "2021/10" there, "2021-01" is "2021/1".
  const auto month = [](const std::string& text) {
    return text.empty() ? "" : text.substr(0, 4) + '/' + std::to_string(std::stoi(text.substr(5)));
  };
  const auto releases = built_in().firmware();
  REQUIRE(releases.size() == 6);
  for (std::size_t i = 0; i < releases.size(); ++i) {
    const FirmwareRelease& release = releases[i];
    INFO(release.version);
    CHECK(firmware_text(release.version) == rows[i].at("version"));
    CHECK(std::to_string(release.version) == rows[i].at("raw_value"));
    CHECK(release.changes_en == rows[i].at("changes"));
    std::string shipments;
    for (const auto& shipment : release.shipments) {
      shipments += (shipments.empty() ? "" : "; ") + shipment.models + " (" + month(shipment.from) +
                   '-' + month(shipment.until) + ')';
    }
    const std::string& expected = rows[i].at("models_period");
    CHECK(shipments == expected);
    CHECK_FALSE(release.changes_ja.empty());
  }
  // The seventh row is a placeholder of 0x52 in table 3-10, no release.
  CHECK(rows[6].at("version") == "(1.000)");
  CHECK(built_in().find(address::firmware_version)->default_raw == 1000);
}
