// `models` as JSON (contract, section 5).

#include "blactl/bla/cross_check.hpp"

#include "cli/output/data_sheet.hpp"

namespace blactl::cli {

using bla::Parameter;
using bla::Profile;

namespace {

void write_addresses(JsonWriter& json, std::string_view key,
                     std::span<const bla::Address> addresses) {
  json.array(key, addresses, [&](bla::Address address) { json.value(address.name()); });
}

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
  json.objects("enumeration", parameter.choices, [&](const bla::Choice& choice) {
    json.member("raw", choice.raw);
    json.member("word", choice.word);
    json.member("text_en", choice.text_en);
    json.member("text_ja", choice.text_ja);
  });
  json.member("section", parameter.section);
  write_addresses(json, "see", parameter.see);
  json.member("meaning_en", parameter.meaning_en);
  json.member("meaning_ja", parameter.meaning_ja);
  json.end_object();
}

void write_model(JsonWriter& json, const Profile& profile, const Sheet& sheet) {
  json.member("model", profile.model);
  json.member("series", profile.series);
  json.member("voltage_class", profile.voltage_class);
  json.member("suffix", profile.suffix);
  json.member("pwm", profile.pwm);
  json.member("model_number", profile.model_number);
  json.member("hardware_version", profile.hardware_version);
  json.array("parameters", profile.parameters, [&](const Parameter& parameter) {
    if (sheet.takes(parameter)) {
      write_parameter(json, parameter);
    }
  });
}

void write_fault_bit(JsonWriter& json, const bla::FaultBit& bit) {
  json.begin_object();
  json.member("register", bit.reg.name());
  json.member("bit", bit.bit);
  json.member("level", bla::name(bit.level));
  json.member("group", bit.group);
  json.member("code", bit.code.empty() ? std::nullopt : std::optional(bit.code));
  json.member("pwm_only", bit.pwm_only);
  json.member("latched", bit.latched);
  json.member("vendor_only", bit.vendor_only);
  json.member("text_en", bit.text_en);
  json.member("text_ja", bit.text_ja);
  json.member("condition_en", bit.condition_en);
  json.member("condition_ja", bit.condition_ja);
  json.member("action_en", bit.action_en);
  json.member("action_ja", bit.action_ja);
  json.member("output_off", bit.output_off);
  json.end_object();
}

void write_release(JsonWriter& json, const bla::FirmwareRelease& release) {
  json.member("version", release.version);
  using Shipment = bla::FirmwareRelease::Shipment;
  json.objects("shipments", release.shipments, [&](const Shipment& shipment) {
    json.member("models", shipment.models);
    json.member("from", shipment.from);
    json.member("until", shipment.until.empty() ? std::nullopt : std::optional(shipment.until));
  });
  json.member("changes_en", release.changes_en);
  json.member("changes_ja", release.changes_ja);
}

void write_check(JsonWriter& json, const bla::CrossCheck& check) {
  json.member("code", check.code);
  json.member("kind", name(check.kind));
  write_addresses(json, "addresses", check.of);
  json.member("text_en", std::string_view(check.reason.en));
  json.member("text_ja", std::string_view(check.reason.ja));
}

} // namespace

void write_models(JsonWriter& json, const Sheet& sheet, const bla::Profiles& profiles) {
  json.objects("models", sheet.models,
               [&](const Profile* profile) { write_model(json, *profile, sheet); });
  json.key("fault_bits");
  json.begin_array();
  for (const auto& bits : {profiles.summary_bits(), profiles.fault_bits()}) {
    for (const bla::FaultBit& bit : bits) {
      write_fault_bit(json, bit);
    }
  }
  json.end_array();
  json.objects("firmware", profiles.firmware(),
               [&](const bla::FirmwareRelease& release) { write_release(json, release); });
  json.objects("cross_checks", bla::cross_checks(),
               [&](const bla::CrossCheck& check) { write_check(json, check); });
}

} // namespace blactl::cli
