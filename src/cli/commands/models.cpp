// blactl models: the profiles as an offline reference.

#include "blactl/bla/value.hpp"

#include "cli/commands.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {
namespace {

using bla::Parameter;
using bla::Profile;

void write_parameter(JsonWriter& json, const Parameter& parameter) {
  json.begin_object();
  json.member("address", parameter.address.name());
  json.member("name", parameter.name);
  json.member("name_en", parameter.name_en);
  json.member("name_ja", parameter.name_ja);
  json.member("vendor_label", parameter.vendor_label);
  json.member("group", bla::name(parameter.group));
  json.member("access", bla::name(parameter.access));
  json.member("unit", bla::name(parameter.unit));
  json.key("scale");
  json.number(parameter.scale());
  json.member("default", parameter.default_raw);
  json.member("min", parameter.min);
  json.member("max", parameter.max);
  json.member("saved", parameter.saved);
  json.member("min_firmware", parameter.min_firmware);
  json.key("enumeration");
  json.begin_array();
  for (const bla::Choice& choice : parameter.choices) {
    json.begin_object();
    json.member("raw", choice.raw);
    json.member("word", choice.word);
    json.member("text_en", choice.text_en);
    json.member("text_ja", choice.text_ja);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

void write_model(JsonWriter& json, const Profile& profile, const Parameter* only) {
  json.begin_object();
  json.member("model", profile.model);
  json.member("series", profile.series);
  json.member("voltage_class", profile.voltage_class);
  json.member("suffix", profile.suffix);
  json.member("pwm", profile.pwm);
  json.member("model_number", profile.model_number);
  json.member("hardware_version", profile.hardware_version);
  json.key("parameters");
  json.begin_array();
  for (const Parameter& parameter : profile.parameters) {
    if (only == nullptr || parameter.address == only->address) {
      write_parameter(json, parameter);
    }
  }
  json.end_array();
  json.end_object();
}

void write_fault_bit(JsonWriter& json, const bla::FaultBit& bit) {
  json.begin_object();
  json.member("register", bit.reg.name());
  json.member("bit", bit.bit);
  json.member("level", bla::name(bit.level));
  json.member("group", bit.group);
  json.member("code", bit.code);
  json.member("pwm_only", bit.pwm_only);
  json.member("text_en", bit.text_en);
  json.member("text_ja", bit.text_ja);
  json.member("condition_en", bit.condition_en);
  json.member("condition_ja", bit.condition_ja);
  json.member("action_en", bit.action_en);
  json.member("action_ja", bit.action_ja);
  json.end_object();
}

void write_json(JsonWriter& json, const bla::Profiles& profiles,
                const std::vector<const Profile*>& models, const Parameter* only) {
  json.key("models");
  json.begin_array();
  for (const Profile* profile : models) {
    write_model(json, *profile, only);
  }
  json.end_array();
  json.key("fault_bits");
  json.begin_array();
  for (const bla::FaultBit& bit : profiles.fault_bits()) {
    write_fault_bit(json, bit);
  }
  json.end_array();
}

std::string list_text(const std::vector<const Profile*>& models) {
  Table table(
      {say<texts::column_model>(), say<texts::column_voltage>(), say<texts::column_numbers>(), ""});
  for (const Profile* profile : models) {
    table.add({profile->model, profile->voltage_class,
               fmt::format("{} / {}", profile->model_number, profile->hardware_version),
               profile->pwm ? say<texts::models_pwm>() : say<texts::models_no_pwm>()});
  }
  return table.text();
}

std::string range_text(const Parameter& parameter) {
  if (!parameter.min || !parameter.max) {
    return {};
  }
  if (!parameter.choices.empty()) {
    std::string words;
    for (const bla::Choice& choice : parameter.choices) {
      if (choice.raw >= *parameter.min && choice.raw <= *parameter.max) {
        words += words.empty() ? "" : ", ";
        words += choice.word;
      }
    }
    return words;
  }
  return say<texts::range_text>(bla::value_text(parameter, *parameter.min),
                                bla::display(parameter, *parameter.max));
}

std::string default_text(const Parameter& parameter) {
  return parameter.default_raw ? bla::display(parameter, *parameter.default_raw) : std::string();
}

std::string model_text(const Profile& profile) {
  Table table({"", say<texts::column_parameter>(), say<texts::column_access>(),
               say<texts::column_default>(), say<texts::column_range>(),
               say<texts::column_meaning>()});
  for (const Parameter& parameter : profile.parameters) {
    table.add({parameter.address.name(), parameter.name, std::string(bla::name(parameter.access)),
               default_text(parameter), range_text(parameter),
               std::string(choose(parameter.name_en, parameter.name_ja))});
  }
  const std::string pwm = profile.pwm ? say<texts::models_pwm>() : say<texts::models_no_pwm>();
  return fmt::format("{}  {}\n{}", profile.model, pwm, table.text("  "));
}

/// One register: what it is, and its range by model.
std::string parameter_text(const Parameter& general, const std::vector<const Profile*>& models) {
  std::string out = fmt::format("{}  {}  {}\n", general.address.name(), general.name,
                                choose(general.name_en, general.name_ja));
  const auto line = [&](const std::string& text) { out += "  " + text + "\n"; };
  line(fmt::format("{}, {}", bla::name(general.access),
                   general.saved ? say<texts::models_saved>() : say<texts::models_not_saved>()));
  if (!general.vendor_label.empty()) {
    line(say<texts::models_vendor_label>(general.vendor_label));
  }
  if (general.min_firmware) {
    line(say<texts::models_since>(version_text(*general.min_firmware)));
  }
  for (const bla::Choice& choice : general.choices) {
    line(fmt::format("{} ({}): {}", choice.word, choice.raw,
                     choose(choice.text_en, choice.text_ja)));
  }
  Table table(
      {say<texts::column_model>(), say<texts::column_default>(), say<texts::column_range>()});
  for (const Profile* profile : models) {
    if (const Parameter* parameter = profile->find(general.address)) {
      table.add({profile->model, default_text(*parameter), range_text(*parameter)});
    }
  }
  return out + table.text("  ");
}

std::string text(const std::vector<const Profile*>& models, const Parameter* only, bool listed) {
  if (only != nullptr) {
    return parameter_text(*only, models);
  }
  if (listed) {
    return list_text(models);
  }
  std::string out;
  for (const Profile* profile : models) {
    out += (out.empty() ? "" : "\n") + model_text(*profile);
  }
  return out;
}

/// The models that the first argument means; all of them without one.
Result<std::vector<const Profile*>> choose_models(const std::string& word,
                                                  const bla::Profiles& profiles) {
  std::vector<const Profile*> models;
  std::string known;
  for (const Profile& profile : profiles.all()) {
    models.push_back(&profile);
    known += (known.empty() ? "" : ", ") + profile.model;
  }
  if (word.empty() || word == "all") {
    return models;
  }
  auto chosen = profiles.matching(word);
  if (chosen.empty()) {
    return fail(Code::usage, say<texts::unknown_model>(printable(word)),
                say<texts::known_models>(known));
  }
  return chosen;
}

} // namespace

Report execute(const ModelsOptions& options, Context& context) {
  Report report;
  const auto loaded = context.profiles();
  if (!loaded) {
    report.fail(loaded.error());
    return report;
  }
  const bla::Profiles& profiles = **loaded;
  const auto chosen = choose_models(options.model, profiles);
  if (!chosen) {
    report.fail(chosen.error());
    return report;
  }
  const Parameter* only = nullptr;
  if (!options.parameter.empty()) {
    const auto found = profiles.find(options.parameter);
    if (!found) {
      report.fail(found.error());
      return report;
    }
    only = *found;
  }
  const bool listed = options.model.empty();
  report.counts = {{"models", chosen->size()}};
  report.json = [&profiles, models = *chosen, only](JsonWriter& json) {
    write_json(json, profiles, models, only);
  };
  report.text = [models = *chosen, only, listed] { return text(models, only, listed); };
  return report;
}

} // namespace blactl::cli
