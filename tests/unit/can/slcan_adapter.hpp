#pragma once
// An slcan adapter on a pseudo terminal, in the dialect that a test asks for; it works in a thread
// of its own, and may have a bus behind it.
//
//     test::SlcanAdapter adapter(test::lawicel(), std::make_unique<sim::PrivateBus>(…));
//     Slcan::open(adapter.path(), …)

#include "blactl/can/bus.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace blactl::can::test {

/// What an adapter answers; an empty text: nothing.
struct Dialect {
  std::string greeting = {}; ///< sent when the first command comes
  std::string to_empty = "\r";
  std::string to_close = "\r";
  std::string to_rate = "\r";
  std::string to_open = "\r";
  std::string to_frame = "Z\r";
  std::string to_version = "\a";
  std::string to_serial_number = "\a";
  std::string to_status = "\a"; ///< while it is open
  bool needs_rate = false;      ///< opens at another bit rate without S8: nothing is heard then
  bool lower_case = false;
  std::string trailer = {}; ///< behind the data of every frame
};

/// As Lawicel documents it; zubax is alike.
inline Dialect lawicel() {
  return {.to_close = "\a",
          .to_version = "V1013\r",
          .to_serial_number = "NA123\r",
          .to_status = "F00\r",
          .needs_rate = true};
}

/// Old firmware of CANable: answers nothing at all.
inline Dialect canable() {
  return {.to_empty = "",
          .to_close = "",
          .to_rate = "",
          .to_open = "",
          .to_frame = "",
          .needs_rate = true,
          .lower_case = true};
}

/// A flight controller: takes everything, gives each frame a time, does not answer an empty line.
inline Dialect ardupilot() {
  return {.to_empty = "",
          .to_version = "V1010\r",
          .to_serial_number = "N0123456789ABCDEF0123456789ABCDEF\r",
          .to_status = "F00\r",
          .trailer = "EA61"};
}

/// unproven: what the starter kit's adapter answers. Here it knows O, C and T, and answers nothing.
inline Dialect starter_kit() {
  return {.to_empty = "", .to_close = "", .to_rate = "", .to_open = "", .to_frame = ""};
}

/// Has one bit rate and says so.
inline Dialect fixed_rate() {
  return {.to_rate = "\a"};
}

/// Refuses the bit rate and to open.
inline Dialect stubborn() {
  return {.to_rate = "\a", .to_open = "\a"};
}

/// Streams what is no slcan until it is opened.
inline Dialect noisy() {
  return {.greeting = std::string("\xFD\x09\x00\x00\x15TT12\x01\x01\xFF\x00T1401", 19) +
                      std::string(5000, 'x') + "\r\a\r"};
}

/// Another baud rate, as it is read: framing errors, and bytes that mean nothing.
inline std::string framing_garbage(std::size_t size) {
  static constexpr std::array<char, 8> pattern{'\x00', '\xF8', '\xE0', '\x98',
                                               '\x06', 'f',    '\x7F', '\x80'};
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) {
    bytes += pattern[i % pattern.size()];
  }
  return bytes;
}

/// Streams at another baud rate, whatever it is told.
inline Dialect wrong_baud() {
  Dialect dialect = starter_kit();
  dialect.greeting = framing_garbage(2000);
  return dialect;
}

/// Answers at another baud rate.
inline Dialect garbled() {
  const std::string some = framing_garbage(3);
  return {.to_empty = some, .to_close = some, .to_rate = some, .to_open = some, .to_frame = some};
}

/// A satellite receiver: text, and no interest in what it is told.
inline Dialect satellite_receiver() {
  Dialect dialect = starter_kit();
  for (int i = 0; i < 20; ++i) {
    dialect.greeting += "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
  }
  return dialect;
}

/// The telemetry port of an autopilot: heartbeats, begun in the middle of one.
inline Dialect telemetry() {
  const std::string heartbeat("\xFD\x09\0\0\x2A\x01\x01\0\0\0\0\0\0\0\x02\x03\x51\x03\x03\x12\x34",
                              21);
  Dialect dialect = starter_kit();
  dialect.greeting = heartbeat.substr(7);
  for (int i = 0; i < 10; ++i) {
    dialect.greeting += heartbeat;
  }
  return dialect;
}

/// Takes the bit rate and then does not open.
inline Dialect closed() {
  return {.to_open = "\a", .to_frame = "\a"};
}

/// Opens, and takes no frame.
inline Dialect listening() {
  return {.to_frame = "\a"};
}

class SlcanAdapter {
 public:
  explicit SlcanAdapter(Dialect dialect, std::unique_ptr<Bus> bus = nullptr)
      : dialect_(std::move(dialect)), bus_(std::move(bus)),
        master_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK)) {
    std::array<char, 64> name{};
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
        ptsname_r(master_, name.data(), name.size()) != 0) {
      throw std::runtime_error("no pseudo terminal");
    }
    path_ = name.data();
    termios mode{};
    tcgetattr(master_, &mode);
    cfmakeraw(&mode);
    tcsetattr(master_, TCSANOW, &mode);
    thread_ = std::thread([this] { work(); });
  }

  ~SlcanAdapter() { unplug(); }

  SlcanAdapter(const SlcanAdapter&) = delete;
  SlcanAdapter& operator=(const SlcanAdapter&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }

  /// The lines that came, without CR, from the first one on.
  [[nodiscard]] std::vector<std::string> lines() {
    const std::scoped_lock lock(mutex_);
    return lines_;
  }

  /// Waits until `is_so` of the lines.
  void wait_for(const std::function<bool(const std::vector<std::string>&)>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!is_so(lines())) {
      if (std::chrono::steady_clock::now() > end) {
        throw std::runtime_error("the adapter waited in vain");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  /// Sends bytes as they are.
  void say(const std::string& bytes) {
    const std::scoped_lock lock(mutex_);
    out_ += bytes;
  }

  /// The adapter leaves with its port.
  void unplug() {
    leaves_ = true;
    if (thread_.joinable()) {
      thread_.join();
      close(master_);
    }
  }

 private:
  void work() {
    while (!leaves_) {
      pollfd readable{master_, POLLIN, 0};
      poll(&readable, 1, 1);
      if ((readable.revents & POLLHUP) != 0) { // nobody has the port open
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      const std::scoped_lock lock(mutex_);
      read_commands();
      relay();
      if (!out_.empty()) {
        const auto size = write(master_, out_.data(), out_.size());
        out_.erase(0, size > 0 ? static_cast<std::size_t>(size) : 0);
      }
    }
  }

  void read_commands() {
    std::array<char, 4096> bytes{};
    const auto size = read(master_, bytes.data(), bytes.size());
    for (ssize_t i = 0; i < size; ++i) {
      const char byte = bytes[static_cast<std::size_t>(i)];
      if (byte != '\r') {
        line_ += byte;
        continue;
      }
      if (lines_.empty()) {
        out_ += dialect_.greeting;
      }
      obey(line_);
      lines_.push_back(std::exchange(line_, {}));
    }
  }

  void obey(const std::string& line) {
    if (line.empty()) {
      out_ += dialect_.to_empty;
    } else if (line == "C") {
      open_ = false;
      out_ += dialect_.to_close;
    } else if (line == "S8") {
      rate_set_ = true;
      out_ += dialect_.to_rate;
    } else if (line == "O") {
      open_ = dialect_.to_open != "\a";
      out_ += dialect_.to_open;
    } else if (line == "V") {
      out_ += dialect_.to_version;
    } else if (line == "N") {
      out_ += dialect_.to_serial_number;
    } else if (line == "F" && open_) {
      out_ += dialect_.to_status;
    } else if (line[0] == 'T') {
      out_ += dialect_.to_frame;
      transmit(line);
    } else {
      out_ += '\a';
    }
  }

  [[nodiscard]] bool on_bus() const { return open_ && bus_ && (rate_set_ || !dialect_.needs_rate); }

  void transmit(const std::string& line) {
    Frame frame{.id = static_cast<std::uint32_t>(std::stoul(line.substr(1, 8), nullptr, 16)),
                .size = static_cast<std::uint8_t>(line[9] - '0')};
    for (std::size_t i = 0; i < frame.size; ++i) {
      frame.data[i] =
          static_cast<std::uint8_t>(std::stoul(line.substr(10 + 2 * i, 2), nullptr, 16));
    }
    if (on_bus()) {
      queue_.push_back(frame);
    }
  }

  /// Gives the frames to the bus, and what is on it to the port.
  void relay() {
    if (!bus_) {
      return;
    }
    while (!queue_.empty() && bus_->send(queue_.front()).value_or(false)) {
      queue_.pop_front();
    }
    while (const auto event = bus_->receive()) {
      const auto* received = std::get_if<Received>(&*event);
      if (received == nullptr || !on_bus()) {
        continue;
      }
      std::string line = fmt::format("T{:08X}{}", received->frame.id, received->frame.size);
      for (const std::uint8_t byte : received->frame.payload()) {
        line += dialect_.lower_case ? fmt::format("{:02x}", byte) : fmt::format("{:02X}", byte);
      }
      out_ += line + dialect_.trailer + '\r';
    }
  }

  Dialect dialect_;
  std::unique_ptr<Bus> bus_;
  int master_;
  std::string path_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::string line_;
  std::string out_;
  std::deque<Frame> queue_;
  bool open_ = false;
  bool rate_set_ = false;
  std::atomic<bool> leaves_ = false;
  std::thread thread_;
};

} // namespace blactl::can::test
