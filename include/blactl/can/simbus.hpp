#pragma once
// The simulated bus of a running `blactl sim`, over its Unix socket.

#include "blactl/can/bus.hpp"
#include "blactl/can/sim_wire.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace blactl::can {

/// `$XDG_RUNTIME_DIR/blactl/sim` if that folder is usable and the path fits a socket address, else
/// `/tmp/blactl-<uid>/sim`.
[[nodiscard]] std::filesystem::path default_socket_path();

/// Whether `folder` is a real folder (no symbolic link) that belongs to this user and that nobody
/// else can write to, so that a socket at a default path in it is this user's.
[[nodiscard]] bool is_own_folder(const std::filesystem::path& folder);

/// On the virtual clock, time stands still while this process works; see sim_wire.hpp.
class SimBus final : public Bus {
 public:
  /// `name`: as the user gave it, "sim:". Waits at most 2 s for the simulator's greeting.
  /// Errors: interface, with a hint to start the simulator.
  [[nodiscard]] static Result<std::unique_ptr<SimBus>> open(const std::filesystem::path& socket,
                                                            std::string name);

  /// As open(), but null if nobody listens there: no simulator was started, or its process is gone.
  [[nodiscard]] static Result<std::unique_ptr<SimBus>>
  open_if_served(const std::filesystem::path& socket, std::string name);

  /// A simulator listens there.
  [[nodiscard]] static bool is_served(const std::filesystem::path& socket);

  SimBus(const SimBus&) = delete;
  SimBus& operator=(const SimBus&) = delete;
  ~SimBus() override;

  [[nodiscard]] std::string_view name() const override { return name_; }

  /// False while ten frames wait for their echo, the default queue length of a CAN interface.
  [[nodiscard]] Result<bool> send(const Frame& frame) override;
  [[nodiscard]] std::optional<BusEvent> receive() override;
  [[nodiscard]] Result<void> filter(std::span<const Filter> filters) override;

  [[nodiscard]] bool echoes() const override { return true; }

  [[nodiscard]] std::string bus_off_hint() const override;

  /// Whether its time is that of the simulation, and ends with it.
  [[nodiscard]] bool has_virtual_clock() const { return virtual_clock_; }

  [[nodiscard]] int descriptor() const override { return socket_; }

  [[nodiscard]] Time now() const override;
  [[nodiscard]] WallTime wall() const override;
  [[nodiscard]] Time idle_until(Time deadline) override;

 private:
  static Result<std::unique_ptr<SimBus>> open(const std::filesystem::path& socket, std::string name,
                                              int& nobody);

  SimBus(int socket, std::filesystem::path path, std::string name)
      : socket_(socket), path_(std::move(path)), name_(std::move(name)) {}

  [[nodiscard]] Result<void> greet();
  [[nodiscard]] Result<void> post(const sim_wire::Message& message);
  [[nodiscard]] std::optional<BusEvent> event(const sim_wire::Message& message);
  [[nodiscard]] Error gone() const;

  int socket_;
  std::filesystem::path path_;
  std::string name_;
  bool virtual_clock_ = false;
  Time now_{};            ///< virtual clock only
  WallTime wall_epoch_{}; ///< virtual clock only: wall time at bus time 0
  std::uint64_t messages_read_ = 0;
  std::optional<sim_wire::Message> waiting_; ///< the last `wait`, unless something was read since
  std::size_t unechoed_ = 0;
  bool gone_ = false;
};

} // namespace blactl::can
