#include "cli/commands.hpp"

#include <algorithm>
#include <array>

namespace blactl::cli {

std::string_view name(Kind kind) {
  switch (kind) {
  case Kind::flag: return "flag";
  case Kind::seconds: return "seconds";
  case Kind::whole: return "whole";
  case Kind::word: return "word";
  case Kind::text: return "text";
  case Kind::parameter: return "parameter";
  case Kind::assignment: return "assignment";
  case Kind::group: return "group";
  case Kind::model: return "model";
  case Kind::model_or_parameter: return "model_or_parameter";
  case Kind::nodes: return "nodes";
  case Kind::interface: return "interface";
  case Kind::file: return "file";
  case Kind::folder: return "folder";
  case Kind::words: return "words";
  case Kind::beginning: return "beginning";
  case Kind::suggested: return "suggested";
  case Kind::data_types: return "data_types";
  case Kind::entry: return "entry";
  }
  return {};
}

std::span<const Command* const> all_commands() {
  using namespace commands;
  static constexpr std::array<const Command*, 24> all{
      &scan,   &alloc,      &get,           &set,   &save,   &erase,        &restart, &wait,
      &faults, &pwm_config, &export_servos, &diff,  &apply,  &replace,      &undo,    &provision,
      &ledger, &monitor,    &command,       &trace, &doctor, &characterize, &models,  &sim};
  return all;
}

const Command* find_command(std::string_view name) {
  const auto found = std::ranges::find(all_commands(), name, &Command::name);
  return found != all_commands().end() ? *found : nullptr;
}

} // namespace blactl::cli
