#include "can/kernel_frame.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>

#include <algorithm>

namespace blactl::can {
namespace {

static_assert(fault_classes == (CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_ACK |
                                CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED));

can_filter to_kernel(const Filter& filter) {
  // Only extended data frames: both flags count, the first has to be set, the second clear.
  return {(filter.id & CAN_EFF_MASK) | CAN_EFF_FLAG,
          (filter.mask & CAN_EFF_MASK) | CAN_EFF_FLAG | CAN_RTR_FLAG};
}

/// The worst error state of a CAN_ERR_CRTL frame; drivers set warning and passive together.
std::optional<FaultKind> controller_state(std::uint8_t bits) {
  if ((bits & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    return FaultKind::error_passive;
  }
  if ((bits & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    return FaultKind::error_warning;
  }
  if ((bits & CAN_ERR_CRTL_ACTIVE) != 0) {
    return FaultKind::error_active;
  }
  return std::nullopt;
}

/// A protocol violation by its place: drivers without CAN_ERR_ACK report a missing acknowledgement
/// as an error in the acknowledge slot, and some the return to error-active as a "violation".
FaultKind violation(const can_frame& error) {
  if (error.data[3] == CAN_ERR_PROT_LOC_ACK) {
    return FaultKind::no_acknowledge;
  }
  return error.data[2] == CAN_ERR_PROT_ACTIVE ? FaultKind::error_active : FaultKind::protocol;
}

} // namespace

can_frame to_kernel(const Frame& frame) {
  can_frame raw{};
  raw.can_id = frame.extended ? (frame.id & CAN_EFF_MASK) | CAN_EFF_FLAG : frame.id & CAN_SFF_MASK;
  if (frame.remote) {
    raw.can_id |= CAN_RTR_FLAG;
  }
  raw.len = std::min<std::uint8_t>(frame.size, CAN_MAX_DLEN);
  std::ranges::copy(frame.data, raw.data);
  return raw;
}

Frame from_kernel(const can_frame& raw) {
  Frame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = std::min<std::uint8_t>(raw.len, CAN_MAX_DLEN);
  std::copy_n(raw.data, frame.remote ? 0 : frame.size, frame.data.begin());
  return frame;
}

std::vector<can_filter> kernel_filters(std::span<const Filter> filters,
                                       const std::optional<Filter>& echoes) {
  if (filters.empty() || filters.size() + 1 > CAN_RAW_FILTER_MAX) {
    return {{0, 0}};
  }
  std::vector<can_filter> raw;
  raw.reserve(filters.size() + 1);
  for (const Filter& filter : filters) {
    raw.push_back(to_kernel(filter));
  }
  if (echoes) {
    raw.push_back(to_kernel(*echoes));
  }
  return raw;
}

bool widen(std::optional<Filter>& filter, std::uint32_t id) {
  if (!filter) {
    filter = Filter{id, extended_id_mask};
    return true;
  }
  const std::uint32_t differing = (filter->id ^ id) & filter->mask;
  filter->mask &= ~differing;
  return differing != 0;
}

std::vector<FaultKind> faults(const can_frame& error) {
  std::vector<FaultKind> found;
  const auto has = [&](std::uint32_t error_class) { return (error.can_id & error_class) != 0; };
  const auto tell_if = [&](bool is_so, FaultKind kind) {
    if (is_so && std::ranges::find(found, kind) == found.end()) {
      found.push_back(kind);
    }
  };
  const auto state = controller_state(error.data[1]);
  tell_if(has(CAN_ERR_BUSOFF), FaultKind::bus_off);
  tell_if(has(CAN_ERR_TX_TIMEOUT), FaultKind::transmit_timeout);
  tell_if(has(CAN_ERR_ACK), FaultKind::no_acknowledge);
  tell_if(has(CAN_ERR_CRTL) && (error.data[1] & CAN_ERR_CRTL_RX_OVERFLOW) != 0,
          FaultKind::receive_overflow);
  tell_if(has(CAN_ERR_CRTL) && state, state.value_or(FaultKind::error_active));
  tell_if(has(CAN_ERR_PROT), violation(error));
  tell_if(has(CAN_ERR_BUSERROR) && !has(CAN_ERR_PROT), FaultKind::protocol);
  tell_if(has(CAN_ERR_RESTARTED), FaultKind::restarted);
  return found;
}

Time bus_time(WallTime stamp, Time now, WallTime wall, Time previous) {
  return std::max(previous, std::min(now, now - (wall - stamp)));
}

} // namespace blactl::can
