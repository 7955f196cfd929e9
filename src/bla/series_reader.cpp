// A series file: the values in table 3-12 for the series, its voltage classes and suffixes.

#include "blactl/base/text.hpp"

#include "bla/profile_reader.hpp"
#include "bla/texts.hpp"

#include <algorithm>

namespace blactl::bla {
namespace {

/// Registers whose default and range a part of the file sets: copies of the family's.
using Overrides = std::vector<Parameter>;

/// A voltage class or a suffix.
struct Section {
  std::string name;
  bool pwm = false;
  Overrides overrides;
};

/// Series, voltage class and suffix make the model's name, with hyphens between them.
void check_name_part(const json::Value& place, const std::string& part, json::Faults& faults) {
  const bool good =
      part.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789") == std::string::npos;
  if (part.empty() || !good) {
    faults.add(place, say<texts::profile_bad_model_part>('"' + part + '"'));
  }
}

const Parameter* find(const std::vector<Parameter>& parameters, Address address) {
  const auto found = std::ranges::find(parameters, address, &Parameter::address);
  return found == parameters.end() ? nullptr : &*found;
}

std::optional<Parameter> read_override(const json::Value& item, const Family& family,
                                       json::Faults& faults) {
  const auto address = find_address(item.key);
  const Parameter* general =
      address && address->name() == item.key ? find(family.parameters, *address) : nullptr;
  if (general == nullptr) {
    faults.add(item, say<texts::profile_unknown_register>('"' + item.key + '"'));
    return std::nullopt;
  }
  if (*address == address::model_number || *address == address::hardware_version) {
    faults.add(item, say<texts::profile_set_by_model>(item.key));
    return std::nullopt;
  }
  Parameter parameter = *general;
  json::Object object(item, faults);
  read_range(object, parameter, faults);
  object.finish();
  const bool complete = object.has("default") && object.has("min") && object.has("max");
  if (object.exists() && general->writable() && !complete) {
    faults.add(item, say<texts::profile_writable_without_range>("default, min, max"));
  }
  if (general->writable() && !parameter.default_raw) {
    parameter.default_raw = 0; // the fault is already reported; the models do have this register
  }
  return parameter;
}

/// `own`: a register that the family lacks and that is described in full is added to it.
Overrides read_overrides(json::Object parameters, Family& family, bool own, json::Faults& faults) {
  Overrides overrides;
  for (const json::Value* item : parameters.members()) {
    const auto address = find_address(item->key);
    const bool known = address && find(family.parameters, *address) != nullptr;
    if (own && has_key(*item, "name") && !known) {
      add_parameter(*item, family.parameters, faults);
    } else if (auto parameter = read_override(*item, family, faults)) {
      overrides.push_back(std::move(*parameter));
    }
  }
  return overrides;
}

/// Voltage classes, or suffixes, which say whether there is a PWM input; `origin` marks what they
/// set.
std::vector<Section> read_sections(json::Object all, bool Parameter::* origin, Family& family,
                                   json::Faults& faults) {
  std::vector<Section> sections;
  for (const json::Value* item : all.members()) {
    check_name_part(*item, item->key, faults);
    json::Object object(*item, faults);
    const bool pwm = origin == &Parameter::by_suffix && object.boolean("pwm");
    sections.push_back(
        {item->key, pwm,
         read_overrides(object.optional_object("parameters"), family, false, faults)});
    object.finish();
    for (Parameter& parameter : sections.back().overrides) {
      parameter.*origin = true;
    }
  }
  return sections;
}

/// The section named by a model; an empty one if there is none.
const Section& named_section(json::Object& model, std::string_view key,
                             const std::vector<Section>& sections, std::string_view where,
                             json::Faults& faults) {
  static const Section none;
  const json::Value* value = model.any(key);
  const auto name = value == nullptr ? std::nullopt : json::as_string(*value, faults);
  if (!name) {
    return none;
  }
  const auto found = std::ranges::find(sections, *name, &Section::name);
  if (found == sections.end()) {
    faults.add(*value, say<texts::profile_no_such_section>('"' + *name + '"', where));
    return none;
  }
  return *found;
}

void apply(const Overrides& overrides, std::vector<Parameter>& parameters) {
  for (const Parameter& parameter : overrides) {
    *std::ranges::find(parameters, parameter.address, &Parameter::address) = parameter;
  }
}

void set_default(std::vector<Parameter>& parameters, Address address, std::int64_t value) {
  const auto found = std::ranges::find(parameters, address, &Parameter::address);
  if (found != parameters.end()) {
    found->default_raw = value;
  }
}

/// The values of the whole series, and its sections.
struct Parts {
  std::string series;
  std::int64_t model_number = 0;
  Overrides overrides;
  std::vector<Section> voltage_classes;
  std::vector<Section> suffixes;
};

Profile read_model(const json::Value& item, const Parts& parts, const Family& family,
                   json::Faults& faults) {
  json::Object object(item, faults);
  const Section& voltage_class =
      named_section(object, "voltage_class", parts.voltage_classes, "voltage_classes", faults);
  const Section& suffix = named_section(object, "suffix", parts.suffixes, "suffixes", faults);
  Profile profile;
  profile.series = parts.series;
  profile.voltage_class = voltage_class.name;
  profile.suffix = suffix.name;
  profile.model = parts.series + '-' + voltage_class.name + '-' + suffix.name;
  profile.pwm = suffix.pwm;
  profile.model_number = parts.model_number;
  profile.hardware_version = object.integer("hardware_version", 0, 65535);
  object.finish();
  profile.parameters = family.parameters;
  apply(parts.overrides, profile.parameters);
  apply(voltage_class.overrides, profile.parameters);
  apply(suffix.overrides, profile.parameters);
  set_default(profile.parameters, address::model_number, profile.model_number);
  set_default(profile.parameters, address::hardware_version, profile.hardware_version);
  for (const Parameter& parameter : profile.parameters) {
    if (parameter.per_model && !parameter.default_raw) {
      faults.add(item, say<texts::profile_register_missing>(profile.model, parameter.address.name(),
                                                            parameter.name));
    }
  }
  return profile;
}

std::string read_series_name(json::Object& root, json::Faults& faults) {
  const json::Value* value = root.any("series");
  const auto name = value == nullptr ? std::nullopt : json::as_string(*value, faults);
  if (name) {
    check_name_part(*value, *name, faults);
  }
  return name.value_or("");
}

} // namespace

Series read_series(json::Document& document, Family family) {
  json::Faults& faults = document.faults();
  json::Object root(document.root(), faults);
  read_head(root);
  Parts parts;
  parts.series = read_series_name(root, faults);
  parts.model_number = root.integer("model_number", 0, 255);
  Series series;
  series.number.raw = parts.model_number;
  series.number.word = parts.series;
  series.number.text_en = read_text(root, "text_en", faults);
  series.number.text_ja = read_text(root, "text_ja", faults);
  parts.overrides = read_overrides(root.optional_object("parameters"), family, true, faults);
  parts.voltage_classes =
      read_sections(root.object("voltage_classes"), &Parameter::by_voltage_class, family, faults);
  parts.suffixes = read_sections(root.object("suffixes"), &Parameter::by_suffix, family, faults);
  for (const json::Value* item : root.array("models")) {
    Profile profile = read_model(*item, parts, family, faults);
    if (std::ranges::any_of(series.models, [&](const Series::Model& other) {
          return other.profile.model == profile.model;
        })) {
      faults.add(*item, say<texts::profile_model_twice>(profile.model));
    }
    series.models.push_back({std::move(profile), item});
  }
  root.finish();
  return series;
}

} // namespace blactl::bla
