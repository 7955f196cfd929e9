// blactl models: the profiles as an offline reference.

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"

#include "cli/commands.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {
namespace {

struct ModelsOptions {
  std::string model{};
  std::string parameter{};
};

constexpr Option argument_table[]{
    {.name = "MODEL",
     .kind = Kind::model,
     .help = {"a model or its beginning: BLA21-12U; all: every model",
              "機種名またはその先頭部分: BLA21-12U (all: 全機種)"},
     .store = into<&ModelsOptions::model>},
    {.name = "PARAM",
     .kind = Kind::parameter,
     .help = {"one parameter: a name or an address", "パラメータ 1 個 (名前またはアドレス)"},
     .store = into<&ModelsOptions::parameter>},
};

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
  json.key("code");
  bit.code.empty() ? json.value(nullptr) : json.value(bit.code);
  json.member("pwm_only", bit.pwm_only);
  json.member("latched", bit.latched);
  json.member("vendor_only", bit.vendor_only);
  json.member("text_en", bit.text_en);
  json.member("text_ja", bit.text_ja);
  json.member("condition_en", bit.condition_en);
  json.member("condition_ja", bit.condition_ja);
  json.member("action_en", bit.action_en);
  json.member("action_ja", bit.action_ja);
  json.end_object();
}

void write_release(JsonWriter& json, const bla::FirmwareRelease& release) {
  json.begin_object();
  json.member("version", release.version);
  json.key("shipments");
  json.begin_array();
  for (const bla::FirmwareRelease::Shipment& shipment : release.shipments) {
    json.begin_object();
    json.member("models", shipment.models);
    json.member("from", shipment.from);
    json.key("until");
    shipment.until.empty() ? json.value(nullptr) : json.value(shipment.until);
    json.end_object();
  }
  json.end_array();
  json.member("changes_en", release.changes_en);
  json.member("changes_ja", release.changes_ja);
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
  for (const auto& bits : {profiles.summary_bits(), profiles.fault_bits()}) {
    for (const bla::FaultBit& bit : bits) {
      write_fault_bit(json, bit);
    }
  }
  json.end_array();
  json.key("firmware");
  json.begin_array();
  for (const bla::FirmwareRelease& release : profiles.firmware()) {
    write_release(json, release);
  }
  json.end_array();
}

std::string pwm_text(const Profile& profile) {
  return profile.pwm ? say<texts::models_pwm>() : say<texts::models_no_pwm>();
}

std::string list_text(const std::vector<const Profile*>& models, const Page& page) {
  Table table(
      {say<texts::column_model>(), say<texts::column_voltage>(), say<texts::column_numbers>(), ""});
  for (const Profile* profile : models) {
    table.add({profile->model, profile->voltage_class,
               fmt::format("{} / {}", profile->model_number, profile->hardware_version),
               pwm_text(*profile)});
  }
  return table.text("", page);
}

std::string words_text(const Parameter& parameter) {
  std::string words;
  for (const bla::Choice& choice : parameter.choices) {
    if (choice.raw >= *parameter.min && choice.raw <= *parameter.max) {
      words += words.empty() ? "" : ", ";
      words += choice.word;
    }
  }
  return words;
}

/// What this model takes; why it takes nothing.
std::string range_text(const Parameter& parameter, const Profile& profile) {
  if (parameter.writable() && !profile.takes(parameter)) {
    return pwm_text(profile);
  }
  if (!parameter.min || !parameter.max) {
    return {};
  }
  return parameter.choices.empty()
             ? say<texts::range_text>(bla::value_text(parameter, *parameter.min),
                                      bla::display(parameter, *parameter.max))
             : words_text(parameter);
}

std::string default_text(const Parameter& parameter, const Profile& profile) {
  if (parameter.writable() && !profile.takes(parameter)) {
    return "-";
  }
  return parameter.default_raw ? bla::display(parameter, *parameter.default_raw) : std::string();
}

/// When this model was shipped with a release: "2021-10 .. 2022-04", "2024-06 ..".
std::string shipped_text(const bla::FirmwareRelease& release, const Profile& profile) {
  std::string times;
  for (const bla::FirmwareRelease::Shipment& shipment : release.shipments) {
    if (shipment.covers(profile.model)) {
      times += times.empty() ? "" : ", ";
      times += say<texts::range_text>(shipment.from, shipment.until);
      times.erase(times.find_last_not_of(' ') + 1);
    }
  }
  return times.empty() ? "-" : times;
}

/// What each firmware of this model brought (chapter 5).
std::string history_text(const Profile& profile, const bla::Profiles& profiles, const Page& page) {
  Table table(
      {say<texts::column_firmware>(), say<texts::column_shipped>(), say<texts::column_changes>()});
  for (const bla::FirmwareRelease* release : profiles.releases_of(profile)) {
    table.add({version_text(release->version), shipped_text(*release, profile),
               std::string(choose(release->changes_en, release->changes_ja))});
  }
  return table.text("  ", page);
}

std::string model_text(const Profile& profile, const bla::Profiles& profiles, const Page& page) {
  Table table({"", say<texts::column_parameter>(), say<texts::column_access>(),
               say<texts::column_default>(), say<texts::column_range>(),
               say<texts::column_meaning>()});
  for (const Parameter& parameter : profile.parameters) {
    table.add({parameter.address.name(), parameter.name, std::string(bla::name(parameter.access)),
               default_text(parameter, profile), range_text(parameter, profile),
               std::string(choose(parameter.name_en, parameter.name_ja))});
  }
  return fmt::format("{}  {}\n{}\n{}", profile.model, pwm_text(profile), table.text("  ", page),
                     history_text(profile, profiles, page));
}

/// What a register is, whatever the model.
std::string description(const Parameter& general) {
  std::string out = fmt::format("{}  {}  {}\n", general.address.name(), general.name,
                                choose(general.name_en, general.name_ja));
  const auto line = [&](const std::string& text) { out += "  " + text + "\n"; };
  line(fmt::format("{}, {}", bla::name(general.access),
                   general.saved ? say<texts::models_saved>() : say<texts::models_not_saved>()));
  if (const auto unit = bla::name(general.unit); !unit.empty()) {
    line(say<texts::models_unit>(unit, general.scale()));
  }
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
  if (const std::string remark = bla::remark(general); !remark.empty()) {
    line(remark);
  }
  return out;
}

/// The bits of a register: what they are called, when they are set, what to do.
std::string bits_text(std::span<const bla::FaultBit> bits, bla::Address address) {
  std::string out;
  for (const bla::FaultBit& bit : bits) {
    if (bit.reg != address) {
      continue;
    }
    out += "  " + say<texts::models_bit>(bit.bit, choose(bit.text_en, bit.text_ja));
    out += bit.code.empty() ? "" : fmt::format(" [{}]", bit.code);
    out += bit.latched ? ", " + say<texts::models_bit_latched>() : std::string();
    out += bit.pwm_only ? ", " + say<texts::models_bit_pwm_only>() : std::string();
    out += fmt::format("\n      {}\n      {}\n", choose(bit.condition_en, bit.condition_ja),
                       choose(bit.action_en, bit.action_ja));
  }
  return out;
}

/// One register: what it is, its bits, and its range by model.
std::string parameter_text(const Parameter& general, const std::vector<const Profile*>& models,
                           const bla::Profiles& profiles, const Page& page) {
  const std::string bits = bits_text(profiles.summary_bits(), general.address) +
                           bits_text(profiles.fault_bits(), general.address);
  if (!bits.empty()) { // they are the same for all models
    return description(general) + bits;
  }
  Table table(
      {say<texts::column_model>(), say<texts::column_default>(), say<texts::column_range>()});
  for (const Profile* profile : models) {
    if (const Parameter* parameter = profile->find(general.address)) {
      table.add(
          {profile->model, default_text(*parameter, *profile), range_text(*parameter, *profile)});
    }
  }
  return description(general) + table.text("  ", page);
}

/// What is asked for.
struct Asked {
  std::vector<const Profile*> models;
  const Parameter* only = nullptr; ///< null: all of their parameters
  bool listed = false;             ///< just which models there are
};

std::string text(const Asked& asked, const bla::Profiles& profiles, const Page& page) {
  if (asked.only != nullptr) {
    return parameter_text(*asked.only, asked.models, profiles, page);
  }
  if (asked.listed) {
    return list_text(asked.models, page);
  }
  std::string out;
  for (const Profile* profile : asked.models) {
    out += (out.empty() ? "" : "\n") + model_text(*profile, profiles, page);
  }
  return out;
}

bool is_all(std::string_view word) {
  return word.size() == 3 && std::ranges::equal(word, std::string_view("all"), [](char a, char b) {
           return a == b || a == b - 'a' + 'A';
         });
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
  if (word.empty() || is_all(word)) {
    return models;
  }
  auto chosen = profiles.matching(word);
  if (chosen.empty()) {
    return fail(Code::usage, say<texts::unknown_model>(printable(word)),
                say<texts::known_models>(known));
  }
  return chosen;
}

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
  }
  const Parameter* only = nullptr;
  if (!options.parameter.empty()) {
    if (const auto found = profiles.find(options.parameter)) {
      only = *found;
    } else {
      report.fail(found.error());
    }
  }
  if (!report.errors.empty()) {
    return report;
  }
  const Asked asked{*chosen, only, options.model.empty()};
  report.counts = {{"models", asked.models.size()}};
  report.json = [&profiles, asked](JsonWriter& json) {
    write_json(json, profiles, asked.models, asked.only);
  };
  report.text = [&profiles, asked](const Page& page) { return text(asked, profiles, page); };
  return report;
}

} // namespace

constinit const Command commands::models{
    .name = "models",
    .traits = {},
    .help = {"what the profiles know, without any servo", "プロファイルの内容を表示 (サーボ不要)"},
    .arguments = argument_table,
    .action = action<execute>,
};

} // namespace blactl::cli
