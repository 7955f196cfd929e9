#pragma once
// Services of a node that run beside its jobs, for as long as it lives.

#include "blactl/base/time.hpp"
#include "blactl/dronecan/transfer.hpp"

namespace blactl::dronecan {

/// A state machine that hears every transfer and acts on time.
class Service {
 public:
  virtual ~Service() = default;
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  virtual void receive(const Transfer& transfer) = 0;

  /// When advance() is due; `never`: nothing is pending.
  [[nodiscard]] virtual Time next_deadline() const = 0;
  virtual void advance(Time now) = 0;

 protected:
  Service() = default;
};

} // namespace blactl::dronecan
