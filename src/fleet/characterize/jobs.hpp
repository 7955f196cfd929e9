#pragma once
// Jobs for one request to a servo, or a few at the right moment.

#include "blactl/bla/values.hpp"
#include "blactl/dronecan/node.hpp"
#include "blactl/fleet/bus/register_access.hpp"

#include "fleet/characterize/test_bench.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace blactl::fleet {

class Question final : public dronecan::Job {
 public:
  /// `must_finish`: it goes on after a first signal, too.
  Question(dronecan::Request request, bool must_finish)
      : request_(std::move(request)), must_finish_(must_finish) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override {
    if (outcome.kind == dronecan::Outcome::Kind::start) {
      return request_;
    }
    reply_ = {.kind = outcome.kind,
              .payload = {outcome.payload.begin(), outcome.payload.end()},
              .asked = outcome.asked,
              .at = outcome.at};
    return std::nullopt;
  }

  [[nodiscard]] bool must_finish() const override { return must_finish_; }

  [[nodiscard]] const Reply& reply() const { return reply_; }

 private:
  dronecan::Request request_;
  bool must_finish_;
  Reply reply_;
};

/// Runs another job, which goes on after a first signal.
class Stubborn final : public dronecan::Job {
 public:
  explicit Stubborn(dronecan::Job& job) : job_(job) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override {
    return job_.next(outcome);
  }

  [[nodiscard]] bool must_finish() const override { return true; }

 private:
  dronecan::Job& job_;
};

/// Reads registers of a servo as soon as it is back; one try each is enough.
class EarlyReads final : public dronecan::Job {
 public:
  EarlyReads(dronecan::NodeId id, std::vector<const bla::Parameter*> registers,
             std::function<bool()> is_there, Duration timeout)
      : id_(id), registers_(std::move(registers)), is_there_(std::move(is_there)),
        timeout_(timeout) {}

  [[nodiscard]] dronecan::Step next(const dronecan::Outcome& outcome) override {
    if (outcome.kind == dronecan::Outcome::Kind::start) {
      return dronecan::Pause{.until = never, .ready = is_there_};
    }
    if (outcome.kind == dronecan::Outcome::Kind::cancelled) {
      return std::nullopt;
    }
    if (outcome.answered()) {
      const bla::Parameter& asked = *registers_[next_ - 1];
      if (const auto raw = register_value(outcome, id_, asked.address, asked.width)) {
        values_[asked.address] = *raw;
      }
    }
    if (next_ == registers_.size()) {
      return std::nullopt;
    }
    return read_register(id_, registers_[next_++]->address, {timeout_, 0});
  }

  [[nodiscard]] const bla::Values& values() const { return values_; }

 private:
  dronecan::NodeId id_;
  std::vector<const bla::Parameter*> registers_;
  std::function<bool()> is_there_;
  Duration timeout_;
  std::size_t next_ = 0;
  bla::Values values_;
};

} // namespace blactl::fleet
