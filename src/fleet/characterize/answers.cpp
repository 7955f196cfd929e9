// Measurements of a servo's responses and messages: nothing is changed.

#include "fleet/characterize/findings.hpp"
#include "fleet/characterize/test_bench.hpp"
#include "fleet/characterize/texts.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace blactl::fleet {

namespace at = bla::address;
using bla::Address;
using dronecan::GetNodeInfo;
using dronecan::GetSet;

namespace {

using namespace std::chrono_literals;

/// The response to a read of a missing register.
struct MissingAnswer {
  enum class Kind : std::uint8_t { silent, fails, zero, other };

  Kind kind = Kind::silent;
  std::int64_t value = 0;
};

Result<MissingAnswer> read_missing(TestBench& bench, Notes& notes, Address address) {
  constexpr int most_tries = 3;
  for (int tries = 0; tries < most_tries; ++tries) {
    const auto reply = bench.read_once(address);
    if (!reply) {
      return std::unexpected(reply.error());
    }
    const auto answer = reply->answered() ? GetSet::Response::decode(reply->payload) : std::nullopt;
    if (!answer) {
      notes.lose_answer();
      continue;
    }
    if (const auto* value = std::get_if<std::int64_t>(&answer->value)) {
      return MissingAnswer{*value == 0 ? MissingAnswer::Kind::zero : MissingAnswer::Kind::other,
                           *value};
    }
    notes.found("failure_with_name", !answer->name.empty());
    return MissingAnswer{MissingAnswer::Kind::fails};
  }
  return MissingAnswer{};
}

std::string words(const MissingAnswer& answer) {
  switch (answer.kind) {
  case MissingAnswer::Kind::silent: return say<texts::bench_no_answer>();
  case MissingAnswer::Kind::fails: return "fail";
  case MissingAnswer::Kind::zero: return "zero";
  case MissingAnswer::Kind::other: break;
  }
  return say<texts::bench_read_value>(answer.value);
}

void conclude_missing(Notes& notes, std::string_view setting, const MissingAnswer& answer) {
  if (answer.kind == MissingAnswer::Kind::fails || answer.kind == MissingAnswer::Kind::zero) {
    notes.found(setting, words(answer));
  } else {
    notes.leave(setting, words(answer));
  }
}

Result<void> measure_status_fields(TestBench& bench, Notes& notes) {
  constexpr Duration some_status = 1100ms;
  constexpr std::uint8_t unknown_rating = 127; // 1011.Status.uavcan
  if (auto heard = bench.pause(some_status); !heard) {
    return heard;
  }
  const auto status = bench.start_watch().status_of(bench.servo().id);
  if (!status) {
    notes.leave("unused_fields", say<texts::bench_no_status>());
  } else if (std::isnan(status->force) && std::isnan(status->speed) &&
             status->power_rating_pct == unknown_rating) {
    notes.found("unused_fields", "unknown");
  } else if (status->force == 0 && status->speed == 0 && status->power_rating_pct == 0) {
    notes.found("unused_fields", "zero");
  } else {
    notes.leave("unused_fields", say<texts::bench_status_fields>(status->force, status->speed,
                                                                 status->power_rating_pct));
  }
  return {};
}

Result<void> describe_node(TestBench& bench, Notes& notes) {
  const auto reply = bench.ask(
      ask(bench.servo().id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), Patience{}));
  if (!reply) {
    return std::unexpected(reply.error());
  }
  const auto info =
      reply->answered() ? GetNodeInfo::Response::decode(reply->payload) : std::nullopt;
  if (!info) {
    return {};
  }
  notes.observe(say<texts::bench_seen_name>(), printable(info->name));
  notes.observe(say<texts::bench_seen_software>(),
                fmt::format("{}.{}", info->software_major, info->software_minor));
  notes.observe(say<texts::bench_seen_hardware>(),
                fmt::format("{}.{}", info->hardware_major, info->hardware_minor));
  notes.describe({.name = info->name,
                  .software_major = info->software_major,
                  .software_minor = info->software_minor,
                  .hardware_major = info->hardware_major,
                  .hardware_minor = info->hardware_minor});
  return {};
}

/// The delay from the end of the request on the wire to the start of the response: both frames are
/// seen at their ends, so their durations at 1 Mbit/s (67 bits and 8 for each byte of an extended
/// frame, and some stuffing) are subtracted.
Result<void> measure_answer_delay(TestBench& bench, Notes& notes) {
  constexpr int questions = 21;
  constexpr Duration frames = 260us;
  constexpr Duration::rep step = 10; // stuffing makes finer steps meaningless
  std::vector<Duration> delays;
  for (int i = 0; i < questions; ++i) {
    const auto reply = bench.read_once(at::current_voltage);
    if (!reply) {
      return std::unexpected(reply.error());
    }
    if (reply->answered()) {
      delays.push_back(reply->at - reply->asked);
    } else {
      notes.lose_answer();
    }
  }
  if (delays.size() <= questions / 2) {
    notes.leave("answer_delay", say<texts::bench_no_answer>());
    return {};
  }
  std::ranges::sort(delays);
  const auto delay = [=](Duration seen) {
    return std::max(Duration::rep{0}, (seen - frames).count()) / step * step;
  };
  notes.found("answer_delay", fmt::format("{}us", delay(delays[delays.size() / 2])));
  notes.observe(say<texts::bench_seen_answers>(),
                fmt::format("{}-{} us", delay(delays.front()), delay(delays.back())));
  return {};
}

/// Reads some addresses that no model has. Those used by the vendor's updater are left out.
Result<void> measure_reserved(TestBench& bench, Notes& notes) {
  constexpr std::array reserved{Address{0x03}, Address{0x0D}, Address{0x28}, Address{0x4A}};
  std::vector<MissingAnswer> answers;
  std::string all;
  for (const Address address : reserved) {
    const auto answer = read_missing(bench, notes, address);
    if (!answer) {
      return std::unexpected(answer.error());
    }
    all += (all.empty() ? "" : ", ") + address.name() + " " + words(*answer);
    answers.push_back(*answer);
  }
  const bool are_alike = std::ranges::all_of(answers, [&](const MissingAnswer& answer) {
    return answer.kind == answers.front().kind && answer.value == answers.front().value;
  });
  if (are_alike) {
    conclude_missing(notes, "reserved_reads", answers.front());
  } else {
    notes.leave("reserved_reads", say<texts::bench_reads_differ>(all));
  }
  return {};
}

Result<void> measure_gated(TestBench& bench, Notes& notes) {
  const bla::Profile& profile = *bench.servo().identity.profile();
  const auto gated = std::ranges::find_if(profile.parameters, [&](const bla::Parameter& each) {
    return each.readable() && !bench.servo().identity.has(each);
  });
  if (gated == profile.parameters.end()) {
    notes.leave("gated_reads", say<texts::bench_nothing_gated>());
    return {};
  }
  const auto answer = read_missing(bench, notes, gated->address);
  if (!answer) {
    return std::unexpected(answer.error());
  }
  conclude_missing(notes, "gated_reads", *answer);
  return {};
}

/// Reads above the last address, where no model has registers: this fails if anything does.
Result<void> measure_failure(TestBench& bench, Notes& notes) {
  constexpr Address beyond{0x60};
  const auto answer = read_missing(bench, notes, beyond);
  if (!answer) {
    return std::unexpected(answer.error());
  }
  if (!notes.value("failure_with_name")) {
    notes.leave("failure_with_name", say<texts::bench_no_failure>());
  }
  return {};
}

Result<void> measure_index(TestBench& bench, Notes& notes) {
  constexpr Address known = at::timeout_time;
  const auto held = bench.read(known);
  if (!held) {
    return std::unexpected(held.error());
  }
  GetSet::Request request;
  request.index = known.value();
  const auto reply = bench.ask(ask(bench.servo().id, GetSet::type, request.encode(), Patience{}));
  if (!reply) {
    return std::unexpected(reply.error());
  }
  const auto answer = reply->answered() ? GetSet::Response::decode(reply->payload) : std::nullopt;
  if (!answer) {
    notes.leave("index_only_access", say<texts::bench_no_answer>());
    return {};
  }
  const auto* value = std::get_if<std::int64_t>(&answer->value);
  if (value == nullptr) {
    notes.found("index_only_access", false);
  } else if (*value == *held && answer->name == known.name()) {
    notes.found("index_only_access", true);
  } else {
    notes.leave("index_only_access", say<texts::bench_read_value>(printable(answer->name) + "=" +
                                                                  std::to_string(*value)));
  }
  return {};
}

} // namespace

std::span<const Measurement> measurements_of_answers() {
  static constexpr std::array<Measurement, 7> all{
      describe_node, measure_status_fields, measure_answer_delay, measure_reserved,
      measure_gated, measure_failure,       measure_index};
  return all;
}

} // namespace blactl::fleet
