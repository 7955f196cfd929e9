// The life cycle of a servo: start, node ID, messages, save, restart.

#include "blactl/sim/servo/servo.hpp"

#include "sim/servo/names.hpp"

#include <algorithm>
#include <chrono>

namespace blactl::sim {

using namespace std::chrono_literals;

namespace {

// Section 2.2.
constexpr Duration node_status_period = 1s;
constexpr Duration servo_status_period = 100ms;
constexpr dronecan::Priority status_priority = 16;
constexpr dronecan::Priority allocation_priority = 24;

/// unproven: the time from power to the first frame; it varies from start to start.
constexpr Duration min_boot_time = 50ms;
constexpr Duration max_boot_time = 150ms;

} // namespace

Servo::Servo(const ServoSetup& setup, std::uint64_t seed, Time power_on)
    : setup_(setup), random_(seed), registers_(setup), motion_(setup, registers_, power_on),
      endpoint_({dronecan::Allocation::type.id, dronecan::ArrayCommand::type.id},
                [this](const dronecan::Transfer& transfer) { handle(transfer); }),
      counter_(setup.faults.restart_after_answer), wake_(power_on + boot_time()), now_(power_on),
      started_(power_on) {
  if (!world().powers()) {
    wake_ = never;
  }
  load_rom(power_on);
}

Duration Servo::boot_time() {
  const Duration usual = random_.between(min_boot_time, max_boot_time);
  return setup_.behaviour.boot_time.value_or(usual);
}

void Servo::receive(const can::Frame& frame, Time at) {
  now_ = at;
  if (phase_ == Phase::run) {
    endpoint_.receive(frame, at);
  }
}

Time Servo::next_deadline() const {
  if (phase_ != Phase::run) {
    return wake_;
  }
  if (allocatee_) {
    return allocatee_->next_deadline();
  }
  const Time next =
      std::min({next_node_status_, next_status_, departure_ ? departure_->at : never});
  return answers_.empty() ? next : std::min(next, answers_.front().due);
}

void Servo::advance(Time now) {
  now_ = now;
  if (phase_ != Phase::run && wake_ <= now) {
    wake(now);
  }
  if (phase_ != Phase::run) {
    return;
  }
  if (allocatee_) {
    if (const auto request = allocatee_->advance(now)) {
      send_message(dronecan::Allocation::type, allocation_priority, request->encode());
    }
    return;
  }
  send_answers(now);
  if (departure_ && departure_->at <= now) {
    depart(now);
  } else {
    broadcast(now);
  }
}

void Servo::broadcast(Time now) {
  if (next_node_status_ <= now) {
    next_node_status_ += node_status_period;
    send_message(dronecan::NodeStatus::type, status_priority, node_status(now).encode());
    assigned_now_ = false;
  }
  if (next_status_ <= now) {
    next_status_ += servo_status_period;
    send_message(dronecan::ActuatorStatus::type, status_priority, actuator_status(now).encode());
  }
}

void Servo::wake(Time now) {
  if (phase_ == Phase::rom_write) {
    end_rom_write(now);
  } else {
    start(now);
  }
}

void Servo::start(Time now) {
  phase_ = Phase::run;
  started_ = now;
  motion_.start(now);
  const dronecan::NodeId id(
      static_cast<std::uint8_t>(registers_.value(bla::address::static_node_id)));
  if (id.is_unicast()) {
    operate(id, now);
  } else {
    allocatee_.emplace(setup_.unique_id, random_.next(), now);
  }
}

void Servo::operate(dronecan::NodeId id, Time now) {
  endpoint_.set_node_id(id);
  assigned_now_ = allocatee_.has_value();
  if (allocatee_) {
    allocatee_.reset();
    tell(ServoEvent::Kind::allocated);
  }
  next_node_status_ =
      setup_.faults.no_node_status ? never : now + setup_.behaviour.first_node_status;
  next_status_ = setup_.faults.no_actuator_status ? never : now;
}

/// `answered`: the response comes first (requirement 57), after the usual delay.
void Servo::obey(Order order, bool answered) {
  if (order == Order::erase) {
    motion_.initialize(now_);
    tell(ServoEvent::Kind::erase);
    return;
  }
  departure_ = {.at = answered ? now_ + setup_.behaviour.answer_delay : now_,
                .kind = order == Order::save ? Departure::Kind::save : Departure::Kind::restart};
}

/// Frames already in the transmit queue still leave; the response is among them.
void Servo::depart(Time now) {
  const Departure::Kind kind = departure_->kind;
  departure_.reset();
  if (kind == Departure::Kind::save) {
    phase_ = Phase::rom_write;
    motion_.stop(now);
    wake_ = now + std::min(setup_.behaviour.rom_write_time,
                           setup_.faults.power_loss_in_save.value_or(Duration::max()));
    answers_.clear();
  } else if (kind == Departure::Kind::fault || !setup_.faults.stays) {
    restart(now);
  }
}

void Servo::end_rom_write(Time now) {
  const bool lost_power = setup_.faults.power_loss_in_save.has_value();
  setup_.faults.power_loss_in_save.reset();
  if (lost_power) {
    rom_is_torn_ = true;
  } else if (!setup_.faults.rom_write_fails) {
    registers_.save();
    rom_is_torn_ = false;
    setup_.faults.rom_unread_starts = 0;
  }
  ++rom_writes_;
  tell(ServoEvent::Kind::rom_write);
  if (lost_power || !setup_.faults.stays) {
    restart(now, lost_power);
    return;
  }
  phase_ = Phase::run;
  motion_.start(now);
  next_node_status_ = std::max(next_node_status_, now);
  next_status_ = std::max(next_status_, now);
}

void Servo::restart(Time now, bool without_supply) {
  tell(ServoEvent::Kind::restart);
  motion_.stop(now, without_supply);
  registers_.restart();
  load_rom(now);
  endpoint_.restart();
  departure_.reset();
  allocatee_.reset();
  answers_.clear();
  phase_ = Phase::boot;
  const Duration absence = boot_time() + setup_.faults.return_delay;
  wake_ = setup_.faults.never_returns ? never : now + absence;
}

/// Requirement 65.
void Servo::load_rom(Time now) {
  if (rom_is_torn_ || setup_.faults.rom_unread_starts > 0) {
    if (setup_.faults.rom_unread_starts > 0) {
      --setup_.faults.rom_unread_starts;
    }
    registers_.initialize();
    show_until_restart(fault::rom_unreadable, 0, now);
  }
}

/// Bits of 0x1A and 0x1B that show the cause of the restart.
void Servo::show_until_restart(std::int64_t warnings, std::int64_t failures, Time now) {
  World around = world();
  around.warnings |= warnings;
  around.failures |= failures;
  motion_.surround(around, now);
}

void Servo::surround(const World& world, Time now) {
  now_ = now;
  const bool ran = this->world().powers();
  motion_.surround(world, now);
  if (ran && !world.powers()) {
    lose_power(now);
  } else if (!ran && world.powers() && !setup_.faults.never_returns) {
    wake_ = now + boot_time();
  }
}

void Servo::lose_power(Time now) {
  rom_is_torn_ = rom_is_torn_ || phase_ == Phase::rom_write;
  restart(now, true);
  wake_ = never;
}

void Servo::upset(Upset cause, Time now) {
  now_ = now;
  if (phase_ != Phase::run) {
    return;
  }
  restart(now);
  show_until_restart(0,
                     cause == Upset::clock      ? fault::clock
                     : cause == Upset::watchdog ? fault::watchdog
                                                : fault::memory,
                     now);
}

void Servo::miss_rom(Time now) {
  now_ = now;
  if (phase_ == Phase::run) {
    ++setup_.faults.rom_unread_starts;
    restart(now);
  }
}

void Servo::suffer(Mishap mishap, Time now) {
  World around = world();
  switch (mishap) {
  case Mishap::power_off:
  case Mishap::power_on:
    around.plugged = mishap == Mishap::power_on;
    surround(around, now);
    break;
  case Mishap::clock_error: upset(Upset::clock, now); break;
  case Mishap::watchdog_error: upset(Upset::watchdog, now); break;
  case Mishap::ram_error: upset(Upset::memory, now); break;
  case Mishap::rom_error: miss_rom(now); break;
  }
}

void Servo::tell(ServoEvent::Kind kind) const {
  if (tell_) {
    tell_({.kind = kind,
           .at = now_,
           .unique_id = setup_.unique_id,
           .serial_number = setup_.serial_number,
           .node_id = node_id(),
           .rom_writes = rom_writes_});
  }
}

} // namespace blactl::sim
