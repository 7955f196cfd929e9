#include "blactl/sim/bus/private_bus.hpp"

#include "blactl/can/simbus_texts.hpp"

#include "sim/bus/client.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace blactl::sim {

using namespace std::chrono_literals;

namespace {

constexpr std::size_t own_queue_capacity = 10;

/// Virtual time passes in steps, so that the loop notices signals even if the filter lets nothing
/// through.
constexpr Duration longest_step = 100ms;

} // namespace

/// Frames and events of the bus that were not fetched yet.
class PrivateBus::Inbox final : public Medium::Listener {
 public:
  explicit Inbox(const PrivateBus& bus) : bus_(bus) {}

  void heard(const can::Frame& frame, Time at) override {
    if (passes(filters, frame)) {
      push(can::Received{frame, at, bus_.wall_at(at)});
    }
  }

  void sent(const can::Frame& frame, Time at) override {
    push(can::Sent{frame, at, bus_.wall_at(at)});
  }

  void bus_off(Time at) override { push(can::BusFault{can::FaultKind::bus_off, at}); }

  std::optional<can::BusEvent> pop() {
    if (std::exchange(overflow_, false)) {
      return can::Overflow{lost_};
    }
    if (events_.empty()) {
      return std::nullopt;
    }
    can::BusEvent event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

  [[nodiscard]] bool empty() const { return events_.empty() && !overflow_; }

  std::vector<can::Filter> filters;

 private:
  void push(can::BusEvent event) {
    if (events_.size() < backlog_capacity) {
      events_.push_back(std::move(event));
    } else {
      ++lost_;
      overflow_ = true;
    }
  }

  const PrivateBus& bus_;
  std::deque<can::BusEvent> events_;
  std::uint64_t lost_ = 0;
  bool overflow_ = false;
};

PrivateBus::PrivateBus(std::string name, const Scenario& scenario)
    : name_(std::move(name)), clock_(scenario.clock),
      simulator_(std::make_shared<Simulator>(
          scenario, scenario.clock == Clock::simulated ? Time{} : Bus::now())),
      inbox_(std::make_unique<Inbox>(*this)),
      port_(simulator_->attach(*inbox_, own_queue_capacity)) {}

PrivateBus::PrivateBus(std::string name, std::shared_ptr<Simulator> simulator)
    : name_(std::move(name)), clock_(Clock::simulated), simulator_(std::move(simulator)),
      inbox_(std::make_unique<Inbox>(*this)),
      port_(simulator_->attach(*inbox_, own_queue_capacity)) {}

PrivateBus::~PrivateBus() {
  simulator_->detach(port_);
}

Time PrivateBus::now() const {
  return clock_ == Clock::real ? Bus::now() : simulator_->now();
}

WallTime PrivateBus::wall() const {
  return clock_ == Clock::real ? Bus::wall() : virtual_epoch + now().time_since_epoch();
}

Result<bool> PrivateBus::send(const can::Frame& frame) {
  simulator_->advance_to(now());
  return simulator_->send(port_, frame);
}

std::optional<can::BusEvent> PrivateBus::receive() {
  simulator_->advance_to(now());
  return inbox_->pop();
}

std::string PrivateBus::bus_off_hint() const {
  return say<texts::simbus_off_hint>();
}

Result<void> PrivateBus::filter(std::span<const can::Filter> filters) {
  inbox_->filters.assign(filters.begin(), filters.end());
  return {};
}

Time PrivateBus::idle_until(Time deadline) {
  if (clock_ == Clock::real) {
    return std::min(deadline, simulator_->next_event());
  }
  const Time longest = simulator_->now() + longest_step;
  const Time end = std::min(deadline, longest);
  while (inbox_->empty() && simulator_->now() < end) {
    simulator_->advance_to(std::min(end, simulator_->next_event()));
  }
  return simulator_->now();
}

} // namespace blactl::sim
