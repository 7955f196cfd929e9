#pragma once
// Detects when a servo falls silent and when it is back.

#include "blactl/dronecan/service.hpp"
#include "blactl/dronecan/types.hpp"

#include <functional>
#include <map>
#include <optional>

namespace blactl::fleet {

/// The times of a restart, and the first data afterwards.
struct Start {
  Time asked{};                               ///< request to restart or save sent
  std::optional<Time> answered{};             ///< response received
  std::optional<Time> requested{};            ///< first allocation request
  std::optional<Time> first{};                ///< first frame under a node ID
  std::optional<Time> first_status{};         ///< first NodeStatus
  std::optional<dronecan::Mode> first_mode{}; ///< the mode in it
};

class StartWatch final : public dronecan::Service {
 public:
  explicit StartWatch(const dronecan::UniqueId& unique_id) : unique_id_(unique_id) {}

  void receive(const dronecan::Transfer& transfer) override;

  [[nodiscard]] Time next_deadline() const override { return never; }

  void advance(Time /*now*/) override {}

  /// Expects servo `id` to restart: frames belong to that start once `is_sent` holds.
  void expect(dronecan::NodeId id, std::function<bool()> is_sent);

  /// Whether the expected servo is back under its previous node ID.
  [[nodiscard]] bool is_back() const { return start_of(id_).first.has_value(); }

  /// The expected start, of the servo that is back as `id`.
  [[nodiscard]] Start start_of(dronecan::NodeId id) const;

  /// The newest actuator.Status of a node; empty: none was heard.
  [[nodiscard]] std::optional<dronecan::ActuatorStatus> status_of(dronecan::NodeId id) const;

 private:
  struct Sender {
    std::map<std::uint16_t, dronecan::TransferId> last_ids{}; ///< by data type
    std::optional<std::uint32_t> uptime_s{};                  ///< the latest
    Time status_at{};                                         ///< of `status`
    std::optional<dronecan::ActuatorStatus> status{};
    std::optional<Time> first{}, first_status{}; ///< of the expected start
    std::optional<dronecan::Mode> first_mode{};
  };

  [[nodiscard]] bool is_expected() const { return is_sent_ && is_sent_(); }

  [[nodiscard]] static bool has_started(Sender& sender, const dronecan::Transfer& transfer);
  void begin_start();
  void hear_message(const dronecan::Transfer& transfer);
  void hear_request(const dronecan::Transfer& transfer);

  dronecan::UniqueId unique_id_;
  dronecan::NodeId id_{};
  std::function<bool()> is_sent_; ///< empty: no start is expected
  std::optional<Time> answered_, requested_;
  std::map<dronecan::NodeId, Sender> senders_;
};

} // namespace blactl::fleet
