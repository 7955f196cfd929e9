#pragma once
// "faults" and "sending" of a scenario's servo.

#include "blactl/base/json_reader.hpp"
#include "blactl/sim/node/delayed_device.hpp"
#include "blactl/sim/servo/servo_faults.hpp"

namespace blactl::sim {

/// Both change what the object says; what it leaves out stays as it is.
void read_servo_faults(json::Object object, ServoFaults& into, json::Faults& faults);
void read_sending(json::Object object, SendingFaults& into, json::Faults& faults);

} // namespace blactl::sim
