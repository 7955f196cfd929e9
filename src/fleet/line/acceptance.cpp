#include "fleet/line/acceptance.hpp"

#include "blactl/bla/faults.hpp"

#include "fleet/files/texts.hpp"
#include "fleet/line/acceptance_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace blactl::fleet {

namespace at = bla::address;

namespace {

Error aside(const Servo& servo, Code code, std::string message, std::string hint) {
  return {code, std::move(message), std::move(hint), servo.id.value()};
}

/// On a line nobody chooses among servos: it is put aside, or made fit.
Error on_the_line(Error error) {
  if (error.code != Code::firmware_too_old) {
    error.hint = say<texts::unit_aside_hint>();
  }
  return error;
}

std::optional<Error> check_unit_label(const Servo& servo, const Label* label) {
  const auto number = servo.identity.readings().serial_number;
  if (label == nullptr || !label->serial_number || number == label->serial_number) {
    return std::nullopt;
  }
  if (!number) {
    return aside(servo, Code::timeout, say<texts::servo_silent_on>("serial_number"),
                 say<texts::unit_aside_hint>());
  }
  return aside(servo, Code::label_mismatch,
               say<texts::unit_other_label>(*number, *label->serial_number),
               say<texts::unit_other_label_hint>());
}

std::optional<std::int64_t> told_by(const Label* label, bla::Address address) {
  if (label == nullptr) {
    return std::nullopt;
  }
  return address == at::servo_id ? label->servo_id : label->static_node_id;
}

state::IdWish wish_of(const Counter& counter) {
  return {.parameter = std::string(counter.parameter->name),
          .first = counter.first,
          .last = counter.last,
          .step = counter.step,
          .begins_again = counter.begins_again};
}

} // namespace

std::optional<Error> check_unit(const Servo& servo, const Recipe& recipe, const Label* label,
                                const bla::Profiles& profiles) {
  if (auto wrong = check_fit(servo, recipe, profiles)) {
    return on_the_line(std::move(*wrong));
  }
  return check_unit_label(servo, label);
}

std::vector<state::IdWish> ids_wished(const Recipe& recipe, const Label* label) {
  std::vector<state::IdWish> wishes;
  for (const auto& [address, name] :
       {std::pair(at::servo_id, "servo_id"), std::pair(at::static_node_id, "static_node_id")}) {
    const auto counter = std::ranges::find(
        recipe.counters, address, [](const Counter& each) { return each.parameter->address; });
    if (const auto told = told_by(label, address)) {
      wishes.push_back({.parameter = name, .value = told});
    } else if (counter != recipe.counters.end()) {
      wishes.push_back(wish_of(*counter));
    }
  }
  return wishes;
}

Result<std::vector<bla::Assignment>> settings_for(const Recipe& recipe,
                                                  std::span<const state::IdWish> wishes,
                                                  std::span<const std::int64_t> ids,
                                                  const bla::Profiles& profiles) {
  const auto address = [](const bla::Assignment& assignment) {
    return assignment.parameter->address;
  };
  std::vector<bla::Assignment> set = recipe.set;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    auto id = bla::make_assignment(profiles, wishes[i].parameter, std::to_string(ids[i]));
    if (!id) {
      return std::unexpected(id.error());
    }
    std::erase_if(set, [&](const bla::Assignment& each) { return address(each) == address(*id); });
    set.push_back(std::move(*id));
  }
  std::ranges::sort(set, {}, address);
  return set;
}

std::string fault_bits(const bla::Values& values, const bla::Profiles& profiles) {
  std::string bits;
  for (const bla::Fault& fault : bla::faults(values, profiles)) {
    bits += fmt::format("{}{}.{}", bits.empty() ? "" : ";", fault.reg.name(), fault.bit);
  }
  return bits;
}

std::optional<Error> check_faults(const bla::Values& values, const bla::Profiles& profiles,
                                  dronecan::NodeId id) {
  auto faults = bla::faults(values, profiles);
  std::erase_if(faults, [](const bla::Fault& fault) { return fault.level == bla::Level::notice; });
  if (faults.empty()) {
    return std::nullopt;
  }
  return Error{Code::faults, say<texts::unit_faulty>(fault_bits(values, profiles)),
               say<texts::unit_faulty_hint>(id.value()), id.value()};
}

} // namespace blactl::fleet
