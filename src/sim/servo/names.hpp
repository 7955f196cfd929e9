#pragma once
// What the simulated servo calls by the names that all floors share.

#include "blactl/bla/address.hpp"
#include "blactl/bla/fault_bits.hpp"

namespace blactl::sim {

namespace address = bla::address;
namespace fault = bla::fault;
using bla::Address;

} // namespace blactl::sim
