#pragma once
// Reads "faults" and "sending" of a scenario's servo.

#include "blactl/base/json_reader.hpp"
#include "blactl/sim/node/delayed_device.hpp"
#include "blactl/sim/servo/servo_faults.hpp"

namespace blactl::sim {

/// Both set the members named by the object; the others stay unchanged.
void read_servo_faults(json::Object object, ServoFaults& into, json::Faults& faults);
void read_sending(json::Object object, SendingFaults& into, json::Faults& faults);

} // namespace blactl::sim
