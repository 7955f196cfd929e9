#pragma once
// A serial port of this process alone: raw bytes, 8N1, no handshake.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace blactl::can {

/// Whether Linux has a name for this rate (termios, up to 4,000,000).
[[nodiscard]] bool is_baud_rate(unsigned baud);

/// Nothing here waits.
class SerialPort {
 public:
  /// What arrived before is discarded. `baud` is a baud rate.
  /// Errors: interface (no such device, not a serial port, in use: by whom, if that can be seen),
  /// permission (with the group that may).
  [[nodiscard]] static Result<std::unique_ptr<SerialPort>> open(const std::filesystem::path& device,
                                                                unsigned baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// How many bytes came; 0: none for now. Errors: interface, once the device is gone.
  [[nodiscard]] Result<std::size_t> read(std::span<char> bytes);

  /// How many bytes were taken. Errors: interface, once the device is gone.
  [[nodiscard]] Result<std::size_t> write(std::string_view bytes);

 private:
  SerialPort(std::filesystem::path device, int descriptor)
      : device_(std::move(device)), descriptor_(descriptor) {}

  [[nodiscard]] Result<void> claim();
  [[nodiscard]] Result<void> configure(unsigned baud);
  [[nodiscard]] std::unexpected<Error> gone(int error) const;

  std::filesystem::path device_;
  int descriptor_;
  bool exclusive_ = false;
};

} // namespace blactl::can
