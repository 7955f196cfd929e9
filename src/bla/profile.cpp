#include "blactl/bla/profile.hpp"

#include "blactl/base/letter_case.hpp"
#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"

#include "bla/texts.hpp"
#include "bla/words.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

namespace blactl::bla {
namespace {

constexpr std::array<std::string_view, 3> level_names{"notice", "warning", "failure"};

/// A parameter's name in the form used by the profiles.
std::string as_name(std::string_view text) {
  std::string name = lower(text);
  std::ranges::replace(name, '-', '_');
  return name;
}

/// A label of the vendor's program or of the specification, made comparable with what people type:
/// "Limit Angle CW", "limit_angle_cw".
std::string as_label(std::string_view text) {
  std::string label = as_name(text);
  std::ranges::replace(label, ' ', '_');
  return label;
}

/// "angle_limit_cw or angle_limit_ccw", for a word that is not a parameter's name.
std::string suggestions(std::string_view typed, std::span<const Parameter> registers) {
  const std::string wanted = as_label(typed);
  std::vector<std::string> found;
  for (const Parameter& parameter : registers) {
    for (const std::string& label :
         {parameter.vendor_label, parameter.name_en, parameter.name_ja}) {
      if (!wanted.empty() && as_label(label) == wanted &&
          (found.empty() || found.back() != parameter.name)) {
        found.push_back(parameter.name);
      }
    }
  }
  if (found.empty()) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : registers) {
      names.push_back(parameter.name);
    }
    const auto similar = nearest(wanted, names);
    found.assign(similar.begin(), similar.end());
  }
  return either(found);
}

const Parameter* find_address_in(std::span<const Parameter> parameters, Address address) {
  const auto found = std::ranges::lower_bound(parameters, address, {}, &Parameter::address);
  return found == parameters.end() || found->address != address ? nullptr : &*found;
}

} // namespace

std::string_view name(Level level) {
  return level_names[std::to_underlying(level)];
}

std::string_view fault_group(std::uint8_t bit) {
  constexpr std::array<std::string_view, 4> groups{"hardware", "software", "communication",
                                                   "other"};
  return groups.at(bit / 8U);
}

std::uint8_t summary_bit(Level level, std::uint8_t bit) {
  return static_cast<std::uint8_t>(bit / 8 * 8 + std::to_underlying(level));
}

std::string firmware_text(std::int64_t version) {
  return fmt::format("{}.{:03}", version / 1000, version % 1000);
}

bool FirmwareRelease::Shipment::covers(std::string_view model) const {
  if (model.size() > models.size() || model.size() + 1 < models.size()) {
    return false;
  }
  return std::ranges::equal(
      model, std::string_view(models).substr(0, model.size()),
      [](char letter, char wanted) { return wanted == '*' || wanted == letter; });
}

const Parameter* Profile::find(Address address) const {
  return find_address_in(parameters, address);
}

const FaultBit* Profiles::fault_bit(Address reg, std::uint8_t bit) const {
  const auto& bits = reg == address::fault_summary ? summary_bits_ : fault_bits_;
  const auto it = std::ranges::find_if(
      bits, [&](const FaultBit& known) { return known.reg == reg && known.bit == bit; });
  return it != bits.end() ? &*it : nullptr;
}

std::vector<const FirmwareRelease*> Profiles::releases_of(const Profile& profile) const {
  const auto shipped = [&](const FirmwareRelease& release) {
    return std::ranges::any_of(release.shipments, [&](const FirmwareRelease::Shipment& shipment) {
      return shipment.covers(profile.model);
    });
  };
  std::vector<const FirmwareRelease*> releases;
  std::size_t kept = 0;
  for (const FirmwareRelease& release : firmware_) {
    const bool is_shipped = shipped(release);
    if (is_shipped || !releases.empty()) {
      releases.push_back(&release);
    }
    kept = is_shipped ? releases.size() : kept;
  }
  releases.resize(kept); // later releases are those of other models
  return releases;
}

std::vector<const Profile*> Profiles::matching(std::string_view text) const {
  const std::string wanted = lower(text);
  std::vector<const Profile*> models;
  for (const Profile& profile : profiles_) {
    const std::string model = lower(profile.model);
    // Labels end with one more digit: BLA21-12U-AB2.
    const bool label = wanted.size() == model.size() + 1 && wanted.starts_with(model) &&
                       wanted.back() >= '0' && wanted.back() <= '9';
    if (label || (!wanted.empty() && model.starts_with(wanted))) {
      models.push_back(&profile);
    }
  }
  return models;
}

const Parameter* Profiles::find(Address address) const {
  return find_address_in(registers_, address);
}

const Parameter* Profiles::find_of_unknown(Address address) const {
  return find_address_in(registers_of_unknown_, address);
}

Result<const Parameter*> Profiles::find(std::string_view text) const {
  if (const auto address = find_address(text)) {
    if (const Parameter* parameter = find(*address)) {
      return parameter;
    }
    return fail(Code::unsupported, say<texts::parameter_reserved>(address->name()),
                say<texts::parameter_list>());
  }
  const auto found = std::ranges::find(registers_, as_name(text), &Parameter::name);
  if (found != registers_.end()) {
    return &*found;
  }
  const std::string similar = suggestions(text, registers_);
  return fail(Code::unknown_parameter, say<texts::parameter_unknown>(printable(text)),
              similar.empty() ? say<texts::parameter_list>() : say<texts::did_you_mean>(similar));
}

} // namespace blactl::bla
