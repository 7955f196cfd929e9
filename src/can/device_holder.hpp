#pragma once
// Which process has a device open.

#include <sys/types.h>

#include <optional>
#include <string>

namespace blactl::can {

struct DeviceHolder {
  pid_t pid;
  std::string name; ///< fit for a terminal
};

/// Another process that has the character device `device` open, as far as this user may see it
/// (/proc/PID/fd).
[[nodiscard]] std::optional<DeviceHolder> device_holder(dev_t device);

} // namespace blactl::can
