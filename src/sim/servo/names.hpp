#pragma once
// Names from other floors used by the simulated servo.

#include "blactl/bla/address.hpp"
#include "blactl/bla/fault_bits.hpp"

namespace blactl::sim {

namespace address = bla::address;
namespace fault = bla::fault;
using bla::Address;

} // namespace blactl::sim
