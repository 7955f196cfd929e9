#include "cli/output/data_sheet.hpp"

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/cross_check.hpp"
#include "blactl/bla/value.hpp"

#include "cli/models_texts.hpp"
#include "cli/output/node_head.hpp"
#include "cli/output/table.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace blactl::cli {

using bla::Parameter;
using bla::Profile;

namespace {

using Models = std::vector<const Profile*>;

/// A default and a range as shown, and the models that have them.
struct Variant {
  std::string initial, range;
  Models models{};
};

std::string pwm_text(const Profile& profile) {
  return profile.pwm ? say<texts::models_pwm>() : say<texts::models_no_pwm>();
}

std::string words_text(const Parameter& parameter) {
  std::string words;
  for (const bla::Choice& choice : parameter.choices) {
    if (choice.raw >= *parameter.min && choice.raw <= *parameter.max) {
      words += (words.empty() ? "" : ", ") + choice.word;
    }
  }
  return words;
}

std::string bounds_text(const Parameter& parameter, std::optional<std::int64_t> pwm_mode = {}) {
  std::string least = bla::value_text(parameter, *parameter.min, pwm_mode);
  std::string most = bla::value_text(parameter, *parameter.max, pwm_mode);
  if (least.ends_with(".0") && most.ends_with(".0")) { // shorter, but just as exact
    least.erase(least.size() - 2);
    most.erase(most.size() - 2);
  }
  const auto unit = bla::unit_text(parameter, pwm_mode);
  return say<texts::range_text>(least, most) + (unit.empty() ? "" : ' ' + std::string(unit));
}

/// The range for this model, or the reason why there is none.
std::string range_text(const Parameter& parameter, const Profile& profile) {
  if (parameter.writable() && !profile.takes(parameter)) {
    return pwm_text(profile);
  }
  if (!parameter.min || !parameter.max) {
    return {};
  }
  if (bla::unit_depends_on_mode(parameter)) {
    return bounds_text(parameter, bla::pwm_angle_mode) + ", " +
           bounds_text(parameter, bla::pwm_speed_mode);
  }
  return parameter.choices.empty() ? bounds_text(parameter) : words_text(parameter);
}

std::string default_text(const Parameter& parameter, const Profile& profile) {
  if (parameter.access != bla::Access::read_write) {
    return {}; // the tables give no setting there
  }
  return profile.takes(parameter) ? bla::default_text(parameter) : "-";
}

/// The period in which this model was shipped with a release: "2021-10 .. 2022-04", "2024-06 ..".
std::string shipped_text(const bla::FirmwareRelease& release, const Profile& profile) {
  std::string times;
  for (const bla::FirmwareRelease::Shipment& shipment : release.shipments) {
    if (shipment.covers(profile.model)) {
      times += (times.empty() ? "" : ", ") + say<texts::range_text>(shipment.from, shipment.until);
      times.erase(times.find_last_not_of(' ') + 1);
    }
  }
  return times.empty() ? "-" : times;
}

/// The changes in each firmware of this model (chapter 5).
std::string history_text(const Profile& profile, const bla::Profiles& profiles, const Page& page) {
  Table table(
      {say<texts::column_firmware>(), say<texts::column_shipped>(), say<texts::column_changes>()});
  for (const bla::FirmwareRelease* release : profiles.releases_of(profile)) {
    table.add({version_text(release->version), shipped_text(*release, profile),
               std::string(choose(release->changes_en, release->changes_ja))});
  }
  return table.text("  ", page);
}

/// "all models", "BLA15, BLA21-**U-A0": exactly these models, in the notation of the specification.
std::string names_of(Models models, const bla::Profiles& profiles) {
  if (models.size() == profiles.all().size()) {
    return say<texts::models_all>();
  }
  using Word = std::string (*)(const Profile&);
  constexpr std::array<Word, 4> words{
      [](const Profile& one) { return one.series; },
      [](const Profile& one) { return fmt::format("{}-**U-{}", one.series, one.suffix); },
      [](const Profile& one) { return fmt::format("{}-{}", one.series, one.voltage_class); },
      [](const Profile& one) { return one.model; }};
  std::string names;
  for (const Word word : words) {
    for (const Profile* model : Models(models)) {
      const std::string name = word(*model);
      const auto means = [&](const Profile& one) { return word(one) == name; };
      const auto ours = std::ranges::count_if(models, [&](auto* one) { return means(*one); });
      const auto all = std::ranges::count_if(profiles.all(), means);
      if (ours == all && (all > 1 || name == model->model)) {
        names += (names.empty() ? "" : ", ") + name;
        std::erase_if(models, [&](auto* one) { return means(*one); });
      }
    }
  }
  return names;
}

std::vector<Variant> variants_of(bla::Address address, const Models& models) {
  std::vector<Variant> variants;
  for (const Profile* profile : models) {
    const Parameter* parameter = profile->find(address);
    if (parameter == nullptr) {
      continue;
    }
    Variant one{default_text(*parameter, *profile), range_text(*parameter, *profile)};
    auto it = std::ranges::find_if(variants, [&](const Variant& other) {
      return other.initial == one.initial && other.range == one.range;
    });
    if (it == variants.end()) {
      it = variants.insert(it, std::move(one));
    }
    it->models.push_back(profile);
  }
  return variants;
}

std::string meaning(const Parameter& parameter) {
  return std::string(choose(parameter.meaning_en, parameter.meaning_ja));
}

std::string title(const Parameter& parameter) {
  return std::string(choose(parameter.name_en, parameter.name_ja));
}

using Row = std::vector<std::string>;

Table table_of(const std::vector<Row>& rows, std::size_t columns) {
  const auto cut = [&](const Row& row) {
    return Row(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(columns));
  };
  Table table(cut(rows.front()));
  for (const Row& row : std::span(rows).subspan(1)) {
    table.add(cut(row));
  }
  return table;
}

/// A header and rows from parameter_row(). In English the title, the last column, adds little to
/// the name: it is left out if there is no room for it.
std::string parameters_text(const std::vector<Row>& rows, const Page& page) {
  constexpr std::string_view indent = "  ";
  const Table whole = table_of(rows, rows.front().size());
  if (whole.fits(indent, page) || language() == Language::japanese) {
    return whole.text(indent, page);
  }
  return table_of(rows, rows.front().size() - 1).text(indent, page) + say<texts::models_no_title>();
}

Row parameter_header() {
  return {"",
          say<texts::column_parameter>(),
          say<texts::column_access>(),
          say<texts::column_default>(),
          say<texts::column_range>(),
          say<texts::column_meaning>()};
}

Row parameter_row(const Parameter& parameter, const std::string& initial,
                  const std::string& range) {
  return {parameter.address.name(),
          parameter.name,
          std::string(bla::name(parameter.access)),
          initial,
          range,
          title(parameter)};
}

/// One model: its registers and its firmware history.
std::string model_text(const Profile& profile, const Sheet& sheet, const bla::Profiles& profiles,
                       const Page& page) {
  std::vector<Row> rows{parameter_header()};
  for (const Parameter& parameter : profile.parameters) {
    if (sheet.takes(parameter)) {
      rows.push_back(parameter_row(parameter, default_text(parameter, profile),
                                   range_text(parameter, profile)));
    }
  }
  return fmt::format("{}  {}\n{}{}", profile.model, pwm_text(profile), parameters_text(rows, page),
                     sheet.is_whole() ? "\n" + history_text(profile, profiles, page) : "");
}

Row variant_row(const Variant& one, const bla::Profiles& profiles) {
  return {one.initial, one.range, names_of(one.models, profiles)};
}

/// Defaults and ranges with their models, without a header.
std::string variants_text(const std::vector<Variant>& variants, const bla::Profiles& profiles,
                          const Page& page) {
  Table table;
  for (const Variant& one : variants) {
    table.add(variant_row(one, profiles));
  }
  return table.text("        ", page);
}

/// Several models: the common values, and the differences.
std::string side_by_side(const Sheet& sheet, const bla::Profiles& profiles, const Page& page) {
  std::vector<Row> same{parameter_header()};
  std::string different;
  for (const Parameter& general : profiles.registers()) {
    const auto variants =
        sheet.takes(general) ? variants_of(general.address, sheet.models) : std::vector<Variant>{};
    if (variants.size() == 1 && variants.front().models.size() == sheet.models.size()) {
      same.push_back(parameter_row(general, variants.front().initial, variants.front().range));
    } else if (!variants.empty()) {
      different += fmt::format("  {}  {}\n", general.address.name(), general.name) +
                   variants_text(variants, profiles, page);
    }
  }
  std::string out = names_of(sheet.models, profiles) + '\n';
  const bool any_same = same.size() > 1;
  if (any_same) {
    out += say<texts::models_same>() + '\n' + parameters_text(same, page);
  }
  if (!different.empty()) {
    out += (any_same ? "\n" : "") + say<texts::models_differ>() + '\n' + different;
  }
  return out;
}

/// "RW: stored in ROM by save"; a read-only or write-only register is not stored.
std::string access_text(const Parameter& general) {
  const std::string access = std::string(bla::name(general.access)) + ": ";
  switch (general.access) {
  case bla::Access::read: return access + say<texts::models_read_only>();
  case bla::Access::write: return access + say<texts::models_write_only>();
  case bla::Access::read_write: break;
  }
  return access + (general.saved ? say<texts::models_saved>() : say<texts::models_not_saved>());
}

/// The line for units that are parts of a date.
std::string date_unit_line(bla::Unit unit) {
  switch (unit) {
  case bla::Unit::year: return say<texts::models_unit_year>();
  case bla::Unit::month: return say<texts::models_unit_month>();
  case bla::Unit::day: return say<texts::models_unit_day>();
  case bla::Unit::hour: return say<texts::models_unit_hour>();
  case bla::Unit::minute: return say<texts::models_unit_minute>();
  default: return {};
  }
}

std::string unit_line(const Parameter& general) {
  if (bla::unit_depends_on_mode(general)) {
    return say<texts::models_unit_by_mode>();
  }
  if (general.group == bla::Group::production) {
    return date_unit_line(general.unit);
  }
  const auto unit = bla::name(general.unit);
  return unit.empty() ? std::string() : say<texts::models_unit>(unit, general.scale());
}

/// The description of a register, independent of the model.
std::string description(const Parameter& general) {
  std::string out =
      fmt::format("{}  {}  {}\n", general.address.name(), general.name, title(general));
  const auto line = [&](const std::string& text) { out += text.empty() ? "" : "  " + text + "\n"; };
  line(meaning(general));
  line(bla::remark(general));
  line(access_text(general));
  line(unit_line(general));
  for (const bla::Choice& choice : general.choices) {
    line(fmt::format("{} ({}): {}", choice.word, choice.raw,
                     choose(choice.text_en, choice.text_ja)));
  }
  if (general.min_firmware) {
    line(say<texts::models_since>(version_text(*general.min_firmware)));
  }
  if (!general.vendor_label.empty()) {
    line(say<texts::models_vendor_label>(general.vendor_label));
  }
  if (!general.section.empty()) {
    line(say<texts::models_section>(general.section));
  }
  return out;
}

/// The bits of 0x18, which have one title and one action in common.
std::string summary_text(std::span<const bla::FaultBit> bits) {
  std::string out;
  for (const bla::FaultBit& bit : bits) {
    out += fmt::format("  bit {}: {}\n", bit.bit, choose(bit.condition_en, bit.condition_ja));
  }
  return out + fmt::format("  {}\n", choose(bits.front().action_en, bits.front().action_ja));
}

std::string bits_text(std::span<const bla::FaultBit> bits, bla::Address address) {
  std::string out;
  for (const bla::FaultBit& bit : bits) {
    if (bit.reg != address) {
      continue;
    }
    out += "  " + fmt::format("bit {}: {}", bit.bit, choose(bit.text_en, bit.text_ja));
    out += fmt::format(" [{}]", bit.code);
    out += bit.latched ? say<texts::models_bit_latched>() : std::string();
    out += bit.output_off ? say<texts::models_bit_output_off>() : std::string();
    out += bit.pwm_only ? say<texts::models_bit_pwm_only>() : std::string();
    out += fmt::format("\n      {}\n", choose(bit.condition_en, bit.condition_ja));
    if (!bit.or_values.empty()) {
      out += fmt::format("      {}\n", choose(bit.or_condition_en, bit.or_condition_ja));
    }
    out += fmt::format("      {}\n", choose(bit.action_en, bit.action_ja));
  }
  return out;
}

/// An order needs only its description. A read-only register may have neither default nor range.
std::string ranges_text(const Parameter& general, const Sheet& sheet, const bla::Profiles& profiles,
                        const Page& page) {
  if (general.access == bla::Access::write) {
    return {};
  }
  Table table(
      {say<texts::column_default>(), say<texts::column_range>(), say<texts::column_models>()});
  const auto variants = variants_of(general.address, sheet.models);
  for (const Variant& one : variants) {
    table.add(variant_row(one, profiles));
  }
  const bool tells = std::ranges::any_of(
      variants, [](const Variant& one) { return !one.initial.empty() || !one.range.empty(); });
  return tells ? '\n' + table.text("  ", page) : std::string();
}

std::string kind_text(bla::CheckKind kind) {
  switch (kind) {
  case bla::CheckKind::refusal: return say<texts::models_refusal>();
  case bla::CheckKind::question: return say<texts::models_question>();
  case bla::CheckKind::warning: break;
  }
  return say<texts::models_warning>();
}

/// The checks for a change of this register.
std::string checks_text(const Parameter& general) {
  std::string out;
  for (const bla::CrossCheck& check : bla::cross_checks()) {
    if (check.is_about(general.address)) {
      out += fmt::format("  {}: {}\n", kind_text(check.kind),
                         choose(check.reason.en, check.reason.ja));
    }
  }
  return out.empty() ? out : '\n' + say<texts::models_checks>() + '\n' + out;
}

std::string see_text(const Parameter& general, const bla::Profiles& profiles) {
  std::string names;
  for (const bla::Address address : general.see) {
    const Parameter* other = profiles.find(address);
    names += names.empty() ? "" : ", ";
    names += address.name() + (other != nullptr ? ' ' + other->name : std::string());
  }
  return names.empty() ? names : '\n' + say<texts::models_see>(names) + '\n';
}

/// One register: description, bits, range by model, checks.
std::string parameter_text(const Parameter& general, const Sheet& sheet,
                           const bla::Profiles& profiles, const Page& page) {
  const auto summary = profiles.summary_bits();
  const bool sums_up = !summary.empty() && summary.front().reg == general.address;
  const std::string bits =
      sums_up ? summary_text(summary) : bits_text(profiles.fault_bits(), general.address);
  // bits are the same for all models
  return description(general) +
         (bits.empty() ? ranges_text(general, sheet, profiles, page) : '\n' + bits) +
         checks_text(general) + see_text(general, profiles);
}

} // namespace

bool Sheet::takes(const Parameter& one) const {
  return parameter != nullptr ? one.address == parameter->address
                              : (groups.empty() || groups.contains(one.group)) &&
                                    (mentions.empty() || bla::mentions(one, mentions));
}

std::string list_text(const Sheet& sheet, const Page& page) {
  Table table(
      {say<texts::column_model>(), say<texts::column_voltage>(), say<texts::column_numbers>(), ""});
  for (const Profile* profile : sheet.models) {
    table.add(
        {profile->model, profile->voltage_class,
         fmt::format("{} / {}", profile->model_number, version_text(profile->hardware_version)),
         pwm_text(*profile)});
  }
  return table.text("", page);
}

std::string sheet_text(const Sheet& sheet, const bla::Profiles& profiles, const Page& page) {
  if (sheet.parameter != nullptr) {
    return parameter_text(*sheet.parameter, sheet, profiles, page);
  }
  return sheet.models.size() == 1 ? model_text(*sheet.models.front(), sheet, profiles, page)
                                  : side_by_side(sheet, profiles, page);
}

} // namespace blactl::cli
