#pragma once
// A serial port opened exclusively: raw bytes, 8N1, no handshake.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace blactl::can {

/// Whether Linux has a name for this rate (termios, up to 4,000,000).
[[nodiscard]] bool is_baud_rate(unsigned baud);

/// No call waits.
class SerialPort {
 public:
  /// Discards what arrived before. `baud` is a baud rate. Errors: interface (no such device, not a
  /// serial port, in use: by whom, if that can be seen), permission (naming the group that has it).
  [[nodiscard]] static Result<std::unique_ptr<SerialPort>> open(const std::filesystem::path& device,
                                                                unsigned baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }

  /// The number of bytes read; 0: none for now. Errors: interface, once the device is gone.
  [[nodiscard]] Result<std::size_t> read(std::span<char> bytes);

  /// The number of bytes accepted. Errors: interface, once the device is gone.
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
