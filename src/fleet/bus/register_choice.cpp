#include "blactl/fleet/bus/register_choice.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"
#include "blactl/bla/assignment.hpp"
#include "blactl/bla/value.hpp"
#include "blactl/fleet/bus/texts.hpp"

#include <algorithm>
#include <ranges>

namespace blactl::fleet {

using bla::Parameter;

namespace {

auto is_at(bla::Address address) {
  return [=](const Parameter* parameter) { return parameter->address == address; };
}

std::vector<std::string_view> group_names() {
  std::vector<std::string_view> names;
  for (const bla::Group group : bla::all_groups()) {
    names.push_back(bla::name(group));
  }
  return names;
}

std::vector<std::string_view> similar_groups(std::string_view word) {
  return nearest(word, group_names());
}

/// Errors: as Profiles::find(), with the group that may be meant; unsupported.
Result<const Parameter*> find_readable(const bla::Profiles& profiles, std::string_view name) {
  auto parameter = profiles.find(name);
  if (parameter && (*parameter)->address == bla::address::bootloader) {
    return fail(Code::unsupported, say<texts::bootloader_unread>(),
                say<texts::bootloader_unread_hint>());
  }
  if (parameter && !(*parameter)->readable()) {
    return fail(Code::unsupported, say<texts::write_only>((*parameter)->name),
                say<texts::write_only_hint>(bla::operation_command((*parameter)->address)));
  }
  if (!parameter && parameter.error().code == Code::unknown_parameter) {
    if (const auto groups = similar_groups(name); !groups.empty()) {
      parameter.error().hint += say<texts::or_a_group>(groups.front());
    }
  }
  return parameter;
}

/// Errors: usage, with the nearest or all names.
Result<bla::Group> parse_group(std::string_view word) {
  if (const auto group = bla::find_group(word)) {
    return *group;
  }
  const auto similar = similar_groups(word);
  std::string known;
  for (const std::string_view group : group_names()) {
    known += known.empty() ? "" : ", ";
    known += group;
  }
  return fail(Code::usage, say<texts::unknown_group>(printable(word)),
              similar.empty() ? say<texts::known_groups>(known)
                              : say<texts::did_you_mean>(similar.front()));
}

} // namespace

const Parameter* own_register(const Parameter& parameter, const Servo& servo) {
  const Parameter* own = servo.identity.parameter(parameter.address);
  return own != nullptr && servo.identity.has(*own) ? own : nullptr;
}

Error lacking(const Parameter& parameter, const Servo& servo) {
  const std::uint8_t id = servo.id.value();
  if (auto taken = servo.identity.check_takes(parameter); !taken) {
    return {taken.error().code, say<texts::about_node>(id, taken.error().message),
            taken.error().hint, id};
  }
  const auto firmware = servo.identity.readings().firmware_version.value_or(0);
  const std::string message = say<texts::firmware_lacks>(
      parameter.name, bla::firmware_text(parameter.min_firmware.value_or(0)),
      bla::firmware_text(firmware));
  return {Code::unsupported, say<texts::about_node>(id, message),
          say<texts::firmware_lacks_hint>(id), id};
}

Result<std::set<bla::Group>> parse_groups(std::string_view list) {
  std::set<bla::Group> groups;
  for (const auto part : std::views::split(list, ',')) {
    const auto group = parse_group(std::string_view(part.begin(), part.end()));
    if (!group) {
      return std::unexpected(group.error());
    }
    groups.insert(*group);
  }
  return groups;
}

std::expected<RegisterChoice, std::vector<Error>>
RegisterChoice::parse(const bla::Profiles& profiles, std::span<const std::string> names,
                      std::span<const std::string> groups) {
  RegisterChoice choice;
  choice.profiles_ = &profiles;
  std::vector<Error> faults;
  for (const std::string& name : names) {
    auto parameter = find_readable(profiles, name);
    if (parameter) {
      choice.named_.push_back(*parameter);
    } else {
      faults.push_back(std::move(parameter.error()));
    }
  }
  for (const std::string& list : groups) {
    auto named = parse_groups(list);
    if (named) {
      choice.groups_.merge(*named);
    } else {
      faults.push_back(std::move(named.error()));
    }
  }
  if (!faults.empty()) {
    return std::unexpected(std::move(faults));
  }
  return choice;
}

bool RegisterChoice::means(const Parameter& parameter) const {
  return is_everything() || groups_.contains(parameter.group) ||
         std::ranges::any_of(named_, is_at(parameter.address));
}

std::vector<const Parameter*> RegisterChoice::registers_of(const Servo& servo) const {
  std::vector<const Parameter*> wanted;
  const auto add = [&](const Parameter* parameter) {
    if (parameter != nullptr && std::ranges::none_of(wanted, is_at(parameter->address))) {
      wanted.push_back(parameter);
    }
  };
  for (const Parameter* parameter : named_) {
    add(own_register(*parameter, servo));
  }
  for (const Parameter& parameter : profiles_->registers()) {
    const Parameter* own = own_register(parameter, servo);
    if ((is_everything() || groups_.contains(parameter.group)) && own != nullptr &&
        own->readable()) {
      add(own);
    }
  }
  const auto depends = [](const Parameter* parameter) {
    return bla::unit_depends_on_mode(*parameter);
  };
  if (std::ranges::any_of(wanted, depends)) {
    add(servo.identity.parameter(bla::address::pwm_mode));
  }
  return wanted;
}

std::vector<Error> RegisterChoice::refusals(const Servo& servo) const {
  std::vector<Error> errors;
  for (const Parameter* parameter : named_) {
    if (servo.is_servo && own_register(*parameter, servo) == nullptr) {
      errors.push_back(lacking(*parameter, servo));
    }
  }
  return errors;
}

std::vector<Reading> RegisterChoice::asked_for(const Snapshot& snapshot) const {
  std::vector<Reading> chosen;
  std::ranges::copy_if(snapshot.readings, std::back_inserter(chosen),
                       [this](const Reading& reading) { return means(*reading.parameter); });
  return chosen;
}

} // namespace blactl::fleet
