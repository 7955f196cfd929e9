#include "blactl/bla/identity.hpp"

#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"

#include "bla/texts.hpp"

#include <algorithm>

namespace blactl::bla {
namespace {

// 0x53 is the supply voltage class in thousands and a number of the suffix (table 3-12).
constexpr std::int64_t class_unit = 1000;

std::int64_t class_digits(std::int64_t hardware_version) {
  return hardware_version / class_unit;
}

std::int64_t suffix_digits(std::int64_t hardware_version) {
  return hardware_version % class_unit;
}

/// Keeps the candidates that agree, or all if none does. Returns whether any did.
template <class Agrees> bool narrow(std::vector<const Profile*>& candidates, Agrees agrees) {
  if (std::ranges::none_of(candidates, agrees)) {
    return false;
  }
  std::erase_if(candidates, [&](const Profile* profile) { return !agrees(profile); });
  return true;
}

/// The member's text if all candidates have the same; else empty.
std::string shared(const std::vector<const Profile*>& candidates, std::string Profile::* part) {
  const std::string& first = candidates.front()->*part;
  const bool same = std::ranges::all_of(
      candidates, [&](const Profile* profile) { return profile->*part == first; });
  return same ? first : "";
}

std::string list(const std::vector<const Profile*>& candidates) {
  std::string all;
  for (const Profile* profile : candidates) {
    all += (all.empty() ? "" : ", ") + profile->model;
  }
  return all;
}

std::string reading(Address address, const std::optional<std::int64_t>& value) {
  return address.name() + '=' + (value ? std::to_string(*value) : say<texts::number_unknown>());
}

/// Whether default and range are the same, so that it does not matter which model it is.
bool alike(const Parameter& a, const Parameter& b) {
  return a.default_raw == b.default_raw && a.min == b.min && a.max == b.max;
}

} // namespace

Identity::Identity(const Profiles& profiles, const Readings& readings)
    : profiles_(&profiles), readings_(readings) {
  if (!readings.model_number) {
    return;
  }
  for (const Profile& profile : profiles.all()) {
    if (profile.model_number == *readings.model_number) {
      candidates_.push_back(&profile);
    }
  }
  if (!readings.hardware_version || candidates_.empty()) {
    return;
  }
  const std::int64_t version = *readings.hardware_version;
  certain_ = narrow(candidates_,
                    [&](const Profile* profile) { return profile->hardware_version == version; });
  class_known_ = narrow(candidates_, [&](const Profile* profile) {
    return class_digits(profile->hardware_version) == class_digits(version);
  });
  suffix_known_ = narrow(candidates_, [&](const Profile* profile) {
    return suffix_digits(profile->hardware_version) == suffix_digits(version);
  });
}

Result<void> Identity::assume(const Profile& profile) {
  if (!candidates_.empty() && std::ranges::find(candidates_, &profile) == candidates_.end()) {
    return fail(Code::model_mismatch, say<texts::model_mismatch>(model(), profile.model),
                say<texts::model_mismatch_hint>());
  }
  assumed_ = &profile;
  return {};
}

const Profile* Identity::profile() const {
  if (candidates_.size() == 1 && class_known_) {
    return candidates_.front();
  }
  return assumed_;
}

std::string Identity::model() const {
  if (const Profile* known = profile()) {
    return known->model;
  }
  if (candidates_.empty()) {
    return {};
  }
  std::string series = shared(candidates_, &Profile::series);
  const std::string voltage_class = shared(candidates_, &Profile::voltage_class);
  if (series.empty() || voltage_class.empty() || !class_known_) {
    return series;
  }
  return series + '-' + voltage_class;
}

const Parameter* Identity::parameter(Address address) const {
  if (const Profile* known = profile()) {
    return known->find(address);
  }
  if (profiles_ == nullptr) {
    return nullptr;
  }
  if (candidates_.empty()) {
    return profiles_->find_of_unknown(address);
  }
  const Parameter* first = candidates_.front()->find(address);
  const bool agreed = std::ranges::all_of(candidates_, [&](const Profile* profile) {
    const Parameter* other = profile->find(address);
    return first == nullptr || other == nullptr ? other == first : alike(*other, *first);
  });
  return agreed ? first : profiles_->find(address);
}

bool Identity::has(const Parameter& parameter) const {
  return !readings_.firmware_version || parameter.exists_in(*readings_.firmware_version);
}

std::vector<const Parameter*> Identity::configuration() const {
  std::vector<const Parameter*> wanted;
  if (profiles_ == nullptr) {
    return wanted;
  }
  for (const Parameter& known : profiles_->registers()) {
    const Parameter* of_model = parameter(known.address);
    if (of_model != nullptr && of_model->is_setting() && has(*of_model)) {
      wanted.push_back(of_model);
    }
  }
  return wanted;
}

std::vector<const Parameter*> Identity::registers(std::span<const Address> addresses) const {
  std::vector<const Parameter*> found;
  for (const Address address : addresses) {
    const Parameter* known = parameter(address);
    if (known != nullptr && has(*known)) {
      found.push_back(known);
    }
  }
  return found;
}

Result<Values> Identity::factory_defaults() const {
  Values defaults;
  const auto kept = configuration();
  for (const Parameter* parameter : kept) {
    if (!parameter->default_raw) {
      return fail(Code::no_profile, say<texts::default_unknown>(parameter->name),
                  say<texts::model_unknown_hint>());
    }
    defaults[parameter->address] = *parameter->default_raw;
  }
  if (kept.empty()) {
    return fail(Code::no_profile,
                say<texts::model_unknown>(reading(address::model_number, readings_.model_number)),
                say<texts::model_unknown_hint>());
  }
  return defaults;
}

Result<void> Identity::may_write(Address address, std::int64_t raw) const {
  const Parameter* general = profiles_ == nullptr ? nullptr : profiles_->find(address);
  if (general == nullptr) {
    return fail(Code::unsupported, say<texts::parameter_reserved>(address.name()),
                say<texts::parameter_list>());
  }
  auto allowed = never_sent(*general, raw);
  allowed = allowed ? check_model(*general, raw) : allowed;
  allowed = allowed ? check_support(*general) : allowed;
  return allowed ? check_range(*candidates_.front()->find(address), raw) : allowed;
}

Result<void> Identity::check_pwm_input() const {
  const auto alike = [&](const Profile* profile) {
    return profile->pwm == candidates_.front()->pwm;
  };
  if (candidates_.empty() || !std::ranges::all_of(candidates_, alike)) {
    return {};
  }
  if (!candidates_.front()->pwm) {
    return fail(Code::unsupported, say<texts::no_pwm_input>(model()),
                say<texts::no_pwm_input_hint>(model()));
  }
  return readings_.firmware_version ? check_support(*candidates_.front()->find(address::pwm_mode))
                                    : Result<void>();
}

Result<void> Identity::check_takes(const Parameter& parameter,
                                   std::optional<std::int64_t> raw) const {
  const Parameter* own = this->parameter(parameter.address);
  if (own == nullptr) {
    return fail(Code::unsupported,
                say<texts::model_lacks>(model(), parameter.name, parameter.address.name()),
                say<texts::parameter_list>());
  }
  if (parameter.group != Group::pwm || candidates_.empty() ||
      std::ranges::any_of(candidates_, &Profile::pwm) || (raw && check_range(*own, *raw))) {
    return {};
  }
  return fail(Code::unsupported,
              say<texts::no_pwm_parameter>(model(), parameter.name, parameter.address.name()),
              say<texts::no_pwm_input_hint>(model()));
}

Result<void> Identity::check_model(const Parameter& parameter, std::int64_t raw) const {
  if (candidates_.empty()) {
    return fail(Code::no_profile,
                say<texts::model_unknown>(reading(address::model_number, readings_.model_number)),
                say<texts::model_unknown_hint>());
  }
  if (auto taken = check_takes(parameter, raw); !taken) {
    return taken;
  }
  const Parameter* first = candidates_.front()->find(parameter.address);
  const bool guessed = std::ranges::any_of(candidates_, [&](const Profile* profile) {
    const Parameter* other = profile->find(parameter.address);
    return first == nullptr || other == nullptr || !alike(*other, *first) ||
           (other->by_voltage_class && !class_known_) || (other->by_suffix && !suffix_known_);
  });
  if (guessed) {
    return fail(Code::no_profile,
                say<texts::model_not_certain>(
                    parameter.name, parameter.address.name(),
                    reading(address::hardware_version, readings_.hardware_version),
                    list(candidates_)),
                say<texts::model_unknown_hint>());
  }
  return {};
}

Result<void> Identity::check_support(const Parameter& parameter) const {
  if (!parameter.min_firmware) {
    return {};
  }
  const std::string address = parameter.address.name();
  const std::string needed = firmware_text(*parameter.min_firmware);
  if (!readings_.firmware_version) {
    return fail(Code::unsupported, say<texts::firmware_unknown>(parameter.name, address, needed),
                say<texts::firmware_unknown_hint>());
  }
  if (!parameter.exists_in(*readings_.firmware_version)) {
    return fail(Code::unsupported,
                say<texts::firmware_needed>(parameter.name, address, needed,
                                            firmware_text(*readings_.firmware_version)),
                say<texts::firmware_needed_hint>(model()));
  }
  return {};
}

} // namespace blactl::bla
