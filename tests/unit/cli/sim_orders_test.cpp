#include "catch.hpp"
#include "cli/sim/orders.hpp"

#include <string>
#include <variant>

using namespace blactl;
using namespace blactl::cli;

namespace {

/// The hint of the error that must come.
std::string hint(std::string_view line) {
  const auto order = parse_sim_order(line);
  REQUIRE_FALSE(order);
  CHECK(order.error().code == Code::usage);
  return order.error().hint;
}

} // namespace

TEST_CASE("a serial number with words changes the world, one thing each") {
  const auto order = parse_sim_order("  240900001 voltage=5.5V\thand=-45.0deg \r");
  REQUIRE(order);
  const auto* change = std::get_if<ChangeWorld>(&*order);
  REQUIRE(change != nullptr);
  CHECK(change->serial_number == 240900001);
  sim::World world;
  for (const sim::WorldChange& one : change->changes) {
    one(world);
  }
  CHECK(world.supply_decivolt == 55);
  CHECK(world.hand_decideg == -450);
}

TEST_CASE("clients, hold and dump") {
  const auto cut = parse_sim_order("clients cut");
  REQUIRE(cut);
  CHECK(std::get<LinkClients>(*cut).link == sim::ClientLink::cut);
  const auto hold = parse_sim_order("hold 3");
  REQUIRE(hold);
  CHECK(std::get<HoldClock>(*hold).clients == 3);
  CHECK(std::holds_alternative<DumpState>(*parse_sim_order(" dump ")));
}

TEST_CASE("what is no order is told what would be one") {
  for (const char* line :
       {"", "foo", "dump it", "hold", "hold -1", "hold 65", "hold 3 4", "clients", "clients gone",
        "clients cut now", "240900001", "0x1 a=b", "99999999999999999999 voltage=5V", "\x1b[2J"}) {
    CHECK(hint(line).find("SERIAL voltage=5V") != std::string::npos);
  }
  CHECK(parse_sim_order("\x1b[2J").error().message.find('\x1b') == std::string::npos);
}

TEST_CASE("a world that is none is told what there is") {
  CHECK(hint("1 volts=5V").find("voltage, temperature") != std::string::npos);
  CHECK(hint("1 voltage").find("V") != std::string::npos);
  CHECK(hint("1 stuck=yes").find("on, off") != std::string::npos);
  const auto beyond = parse_sim_order("1 voltage=99V");
  REQUIRE_FALSE(beyond);
  CHECK(beyond.error().code == Code::out_of_range);
}
