// The family's file: registers of tables 3-1 to 3-11, bits of 4.12, releases of chapter 5.

#include "blactl/base/text.hpp"

#include "bla/profile_reader.hpp"
#include "bla/texts.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

namespace blactl::bla {
namespace {

// In the order of Unit, without its "none".
const std::initializer_list<std::string_view> unit_words{"deg",   "rpm", "%",    "A",       "V",
                                                         "us",    "ms",  "degC", "deg/rpm", "year",
                                                         "month", "day", "hour", "minute"};

Unit read_unit(json::Object& object) {
  const auto word = object.optional_word("unit", unit_words);
  const auto* const found = std::ranges::find(unit_words, word.value_or(""));
  return found == unit_words.end() ? Unit::none : static_cast<Unit>(found - unit_words.begin() + 1);
}

Width read_width(json::Object& object) {
  const std::string word =
      object.word("width", {"int8", "uint8", "int16", "uint16", "int32", "uint32"});
  Width width;
  width.is_signed = !word.starts_with('u');
  width.bits = word.ends_with("16") ? 16 : word.ends_with('8') ? 8 : 32;
  return width;
}

Access read_access(json::Object& object) {
  const std::string word = object.word("access", {"R", "W", "RW"});
  return word == "RW" ? Access::read_write : word == "W" ? Access::write : Access::read;
}

Group read_group(json::Object& object) {
  return find_group(
             object.word("group", {"command", "status", "operation", "fault", "config", "control",
                                   "pwm", "limit", "option", "product", "production"}))
      .value_or(Group::command);
}

std::string read_name(json::Object& object, std::string_view key, json::Faults& faults) {
  const json::Value* value = object.any(key);
  if (value == nullptr) {
    return {};
  }
  std::string name = json::as_string(*value, faults).value_or("x");
  const bool good =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
  if (name.empty() || !good) {
    faults.add(*value, say<texts::profile_bad_name>('"' + name + '"'));
  }
  return name;
}

std::vector<Choice> read_choices(json::Object& object, json::Faults& faults) {
  std::vector<Choice> choices;
  for (const json::Value* item : object.optional_array("choices")) {
    json::Object entry(*item, faults);
    Choice choice;
    choice.raw = entry.integer("raw");
    choice.word = read_name(entry, "word", faults);
    choice.text_en = read_text(entry, "text_en", faults);
    choice.text_ja = read_text(entry, "text_ja", faults);
    entry.finish();
    for (const Choice& other : choices) {
      if (other.raw == choice.raw || other.word == choice.word) {
        faults.add(*item, say<texts::profile_choice_twice>(other.word == choice.word
                                                               ? choice.word
                                                               : std::to_string(choice.raw)));
      }
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

/// Checks that range and default are given here or in the series files, but not in both.
void check_range_given(const json::Object& object, const Parameter& parameter,
                       json::Faults& faults) {
  const bool any = object.has("default") || object.has("min") || object.has("max");
  if (parameter.per_model && any) {
    faults.add(object.value(), say<texts::profile_range_per_model>());
  }
  // 0x49 has none; it is never written.
  const bool needed =
      parameter.writable() && !parameter.per_model && parameter.address != address::bootloader;
  if (needed && !(object.has("default") && object.has("min") && object.has("max"))) {
    faults.add(object.value(), say<texts::profile_writable_without_range>("default, min, max"));
  }
}

Address read_address(const json::Value& item, json::Faults& faults) {
  const std::string text = json::as_string(item, faults).value_or("0x00");
  const auto address = find_address(text);
  if (!address || address->name() != text) {
    faults.add(item, say<texts::profile_bad_address>('"' + text + '"'));
  }
  return address.value_or(Address{});
}

std::vector<Address> read_addresses(json::Object& object, std::string_view key,
                                    json::Faults& faults) {
  std::vector<Address> addresses;
  for (const json::Value* value : object.optional_array(key)) {
    addresses.push_back(read_address(*value, faults));
  }
  return addresses;
}

Parameter read_parameter(const json::Value& item, json::Faults& faults) {
  Parameter parameter;
  const auto address = find_address(item.key);
  if (!address || address->name() != item.key) {
    faults.add(item, say<texts::profile_bad_address>('"' + item.key + '"'));
  }
  parameter.address = address.value_or(Address{});
  json::Object object(item, faults);
  parameter.name = read_name(object, "name", faults);
  parameter.group = read_group(object);
  parameter.name_en = read_text(object, "name_en", faults);
  parameter.name_ja = read_text(object, "name_ja", faults);
  parameter.vendor_label = object.optional_string("vendor_label").value_or("");
  parameter.access = read_access(object);
  parameter.unit = read_unit(object);
  parameter.steps_per_unit = object.optional_word("scale", {"1", "0.1"}) == "0.1" ? 10 : 1;
  parameter.width = read_width(object);
  parameter.per_model = object.optional_boolean("per_model").value_or(false);
  read_range(object, parameter, faults);
  parameter.saved = object.boolean("saved");
  parameter.min_firmware = object.optional_integer("min_firmware", 0);
  parameter.can_be_inactive = object.optional_boolean("can_be_inactive").value_or(false);
  parameter.choices = read_choices(object, faults);
  parameter.section = object.optional_string("section").value_or("");
  parameter.meaning_en = object.optional_string("meaning_en").value_or("");
  parameter.meaning_ja = object.optional_string("meaning_ja").value_or("");
  parameter.see = read_addresses(object, "see", faults);
  object.finish();
  if (object.exists()) {
    check_range_given(object, parameter, faults);
  }
  return parameter;
}

FaultBit read_fault_bit(const json::Value& item, json::Faults& faults) {
  json::Object object(item, faults);
  FaultBit bit;
  const std::string reg = object.word("register", {"0x18", "0x19", "0x1A", "0x1B"});
  bit.reg = find_address(reg).value_or(address::fault_notice);
  bit.bit = static_cast<std::uint8_t>(object.integer("bit", 0, 31));
  const bool sums_up = bit.reg == address::fault_summary;
  const unsigned level = sums_up ? bit.bit % 8U : bit.reg.value() - address::fault_notice.value();
  if (level > std::to_underlying(Level::failure)) {
    faults.add(item, say<texts::profile_no_summary_bit>(bit.bit));
  }
  bit.level = static_cast<Level>(level);
  bit.group = object.word("group", {"hardware", "software", "communication", "other"});
  bit.code = sums_up ? std::string() : read_name(object, "code", faults);
  bit.pwm_only = object.optional_boolean("pwm_only").value_or(false);
  bit.latched = object.optional_boolean("latched").value_or(false);
  bit.output_off = object.optional_boolean("output_off").value_or(false);
  bit.vendor_only = object.optional_boolean("vendor_only").value_or(false);
  bit.text_en = read_text(object, "text_en", faults);
  bit.text_ja = read_text(object, "text_ja", faults);
  bit.condition_en = read_text(object, "condition_en", faults);
  bit.condition_ja = read_text(object, "condition_ja", faults);
  bit.action_en = read_text(object, "action_en", faults);
  bit.action_ja = read_text(object, "action_ja", faults);
  bit.values = read_addresses(object, "values", faults);
  if (object.has("or_values")) {
    bit.or_condition_en = read_text(object, "or_condition_en", faults);
    bit.or_condition_ja = read_text(object, "or_condition_ja", faults);
    bit.or_values = read_addresses(object, "or_values", faults);
  }
  object.finish();
  if (const auto group = fault_group(bit.bit); !bit.group.empty() && bit.group != group) {
    faults.add(item, say<texts::profile_bit_group>(bit.bit, group));
  }
  return bit;
}

void read_fault_bits(json::Object& root, Family& family, json::Faults& faults) {
  std::vector<FaultBit> bits;
  for (const json::Value* item : root.array("fault_bits")) {
    FaultBit bit = read_fault_bit(*item, faults);
    for (const FaultBit& other : bits) {
      if (other.reg == bit.reg && other.bit == bit.bit) {
        faults.add(*item, say<texts::profile_bit_twice>(bit.reg.name(), bit.bit));
      }
      if (other.code == bit.code && !bit.code.empty()) {
        faults.add(*item, say<texts::profile_code_twice>(bit.code));
      }
    }
    bits.push_back(std::move(bit));
  }
  for (FaultBit& bit : bits) {
    (bit.code.empty() ? family.summary_bits : family.fault_bits).push_back(std::move(bit));
  }
}

/// "2024-06".
bool is_month(std::string_view text) {
  const auto digits = [](std::string_view part) {
    return std::ranges::all_of(part, [](char c) { return c >= '0' && c <= '9'; });
  };
  return text.size() == 7 && text[4] == '-' && digits(text.substr(0, 4)) &&
         digits(text.substr(5)) && text.substr(5) >= "01" && text.substr(5) <= "12";
}

std::string read_month(json::Object& object, std::string_view key, json::Faults& faults) {
  const json::Value* value = object.optional_any(key);
  if (value == nullptr) {
    return {};
  }
  const auto month = json::as_string(*value, faults);
  if (month && !is_month(*month)) {
    faults.add(*value, say<texts::profile_bad_month>('"' + *month + '"'));
  }
  return month.value_or("");
}

FirmwareRelease read_release(const json::Value& item, json::Faults& faults) {
  json::Object object(item, faults);
  FirmwareRelease release;
  release.version = object.integer("version", 0, 65535);
  for (const json::Value* entry : object.array("shipments")) {
    json::Object shipment(*entry, faults);
    release.shipments.push_back({read_text(shipment, "models", faults),
                                 read_month(shipment, "from", faults),
                                 read_month(shipment, "until", faults)});
    shipment.finish();
  }
  release.changes_en = read_text(object, "changes_en", faults);
  release.changes_ja = read_text(object, "changes_ja", faults);
  object.finish();
  return release;
}

std::vector<FirmwareRelease> read_firmware(json::Object& root, json::Faults& faults) {
  std::vector<FirmwareRelease> releases;
  for (const json::Value* item : root.array("firmware")) {
    FirmwareRelease release = read_release(*item, faults);
    if (!releases.empty() && release.version <= releases.back().version) {
      faults.add(*item, say<texts::profile_releases_order>());
    }
    releases.push_back(std::move(release));
  }
  return releases;
}

} // namespace

void add_parameter(const json::Value& item, std::vector<Parameter>& known, json::Faults& faults) {
  Parameter parameter = read_parameter(item, faults);
  const auto twin = std::ranges::find(known, parameter.name, &Parameter::name);
  if (twin != known.end()) {
    faults.add(item, say<texts::profile_name_twice>(parameter.name, twin->address.name()));
  }
  const auto place = std::ranges::upper_bound(known, parameter.address, {}, &Parameter::address);
  known.insert(place, std::move(parameter));
}

Family read_family(json::Document& document) {
  json::Faults& faults = document.faults();
  json::Object root(document.root(), faults);
  read_head(root);
  static_cast<void>(root.optional_string("source"));
  Family family;
  json::Object parameters = root.object("parameters");
  for (const json::Value* item : parameters.members()) {
    add_parameter(*item, family.parameters, faults);
  }
  read_fault_bits(root, family, faults);
  family.firmware = read_firmware(root, faults);
  root.finish();
  return family;
}

} // namespace blactl::bla
