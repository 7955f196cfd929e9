#include "blactl/can/link_setup.hpp"

#include "catch.hpp"

using namespace blactl;
using namespace blactl::can;

TEST_CASE("a controller is brought up with the bit timing of the servos, the others as they are") {
  CHECK(up_command({.name = "can1", .kind = "can"}) ==
        "sudo ip link set can1 up type can bitrate 1000000 sample-point 0.875");
  CHECK(up_command({.name = "vcan0", .kind = "vcan"}) == "sudo ip link set vcan0 up");
}

TEST_CASE("whatever is set, the command is one that iproute2 takes") {
  CHECK(command({.name = "can0",
                 .goes_down = true,
                 .sets_timing = true,
                 .sets_restart = true,
                 .sets_queue = true,
                 .goes_up = true}) ==
        "sudo ip link set can0 down; sudo ip link set can0 up txqueuelen 100 type can bitrate "
        "1000000 sample-point 0.875 restart-ms 100");
  CHECK(command({.name = "can0", .goes_down = true, .goes_up = true}) ==
        "sudo ip link set can0 down; sudo ip link set can0 up");
  CHECK(command({.name = "can0", .sets_queue = true}) == "sudo ip link set can0 txqueuelen 100");
}

TEST_CASE("an interface that is not there cannot be set up") {
  const LinkSetup setup{.name = "nocan7", .goes_up = true};
  const auto may = may_set_up(setup);
  REQUIRE_FALSE(may);
  CHECK(may.error().code == Code::interface);
  CHECK(may.error().message.find("nocan7") != std::string::npos);
  CHECK_FALSE(set_up(setup));
}
