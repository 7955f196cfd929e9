#include "blactl/base/error.hpp"

#include <array>
#include <utility>

namespace blactl {
namespace {

struct Entry {
  Code code;
  std::string_view name;
  int exit_status;
};

// Contract, section 3, in the order of the enumeration.
constexpr std::array entries{
    Entry{Code::io, "io", 1},
    Entry{Code::state, "state", 1},
    Entry{Code::internal, "internal", 1},
    Entry{Code::usage, "usage", 2},
    Entry{Code::bad_file, "bad_file", 2},
    Entry{Code::unknown_parameter, "unknown_parameter", 2},
    Entry{Code::out_of_range, "out_of_range", 2},
    Entry{Code::read_only, "read_only", 2},
    Entry{Code::unsupported, "unsupported", 2},
    Entry{Code::cross_check, "cross_check", 2},
    Entry{Code::interface, "interface", 3},
    Entry{Code::permission, "permission", 3},
    Entry{Code::bus_off, "bus_off", 3},
    Entry{Code::no_acknowledge, "no_acknowledge", 3},
    Entry{Code::timeout, "timeout", 4},
    Entry{Code::not_found, "not_found", 4},
    Entry{Code::not_back, "not_back", 4},
    Entry{Code::not_recorded, "not_recorded", 4},
    Entry{Code::refused, "refused", 5},
    Entry{Code::mismatch, "mismatch", 5},
    Entry{Code::not_confirmed, "not_confirmed", 7},
    Entry{Code::faults, "faults", 8},
    Entry{Code::duplicate_node_id, "duplicate_node_id", 9},
    Entry{Code::duplicate_servo_id, "duplicate_servo_id", 9},
    Entry{Code::duplicate_unique_id, "duplicate_unique_id", 9},
    Entry{Code::other_allocator, "other_allocator", 9},
    Entry{Code::armed, "armed", 9},
    Entry{Code::driven, "driven", 9},
    Entry{Code::busy, "busy", 9},
    Entry{Code::no_local_node_id, "no_local_node_id", 9},
    Entry{Code::no_profile, "no_profile", 9},
    Entry{Code::model_mismatch, "model_mismatch", 9},
    Entry{Code::rom_unread, "rom_unread", 9},
    Entry{Code::stale_plan, "stale_plan", 9},
    Entry{Code::table_full, "table_full", 9},
    Entry{Code::label_mismatch, "label_mismatch", 9},
    Entry{Code::firmware_too_old, "firmware_too_old", 9},
    Entry{Code::several_servos, "several_servos", 9},
    Entry{Code::counter_end, "counter_end", 9},
    Entry{Code::attempts, "attempts", 9},
    Entry{Code::interrupted, "interrupted", 130},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (std::to_underlying(entries[i].code) != i) {
      return false;
    }
  }
  return entries.size() == std::to_underlying(Code::interrupted) + 1U;
}

static_assert(in_order(), "entries must list every code in the order of the enumeration");

} // namespace

std::string_view name(Code code) {
  return entries[std::to_underlying(code)].name;
}

int exit_status(Code code) {
  return entries[std::to_underlying(code)].exit_status;
}

} // namespace blactl
