#include "catch.hpp"
#include "cli/output/report.hpp"

#include <signal.h>

#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using cli::Report;
using cli::Target;

namespace {

using Codes = std::vector<Code>;

/// A target that ended with these errors.
Target failed(const Codes& codes) {
  Target target;
  for (const Code code : codes) {
    target.errors.push_back({code, "…"});
  }
  return target;
}

const Target well{};
const Target found{.errors = {}, .has_found = true};

int status_of(std::vector<Target> targets, const Codes& of_command = {}) {
  Report report;
  report.targets = std::move(targets);
  for (const Code code : of_command) {
    report.fail({code, "…"});
  }
  return report.exit_status();
}

} // namespace

TEST_CASE("a command without errors and servos is done") {
  CHECK(status_of({}) == 0);
}

TEST_CASE("a command that failed as a whole has the status of its error") {
  CHECK(status_of({}, {Code::usage}) == 2);
  CHECK(status_of({}, {Code::not_found}) == 4);
  CHECK(status_of({}, {Code::duplicate_node_id}) == 9);
  CHECK(status_of({}, {Code::interrupted}) == 130);
}

TEST_CASE("of several errors of a command the first one counts") {
  CHECK(status_of({}, {Code::duplicate_node_id, Code::timeout}) == 9);
  CHECK(status_of({}, {Code::timeout, Code::duplicate_node_id}) == 4);
}

TEST_CASE("servos that all ended alike give that status") {
  CHECK(status_of({well, well, well}) == 0);
  CHECK(status_of({failed({Code::timeout})}) == 4);
  CHECK(status_of({failed({Code::refused}), failed({Code::mismatch})}) == 5);
}

TEST_CASE("of several errors of one servo the first one counts") {
  CHECK(status_of({failed({Code::refused, Code::timeout})}) == 5);
  CHECK(status_of({failed({Code::timeout, Code::refused})}) == 4);
}

TEST_CASE("success and failure, or different failures, are mixed") {
  CHECK(status_of({well, failed({Code::timeout})}) == 6);
  CHECK(status_of({failed({Code::timeout}), well}) == 6);
  CHECK(status_of({failed({Code::timeout}), failed({Code::refused})}) == 6);
  CHECK(status_of({found, failed({Code::timeout})}) == 6);
}

TEST_CASE("some with and some without a finding are 8") {
  CHECK(status_of({found, well}) == 8);
  CHECK(status_of({well, found, well}) == 8);
  CHECK(status_of({failed({Code::faults}), failed({Code::faults})}) == 8);
}

TEST_CASE("a failed servo that has found something as well has failed") {
  Target both = failed({Code::timeout});
  both.has_found = true;
  CHECK(status_of({both}) == 4);
}

TEST_CASE("a failure outranks a finding, in whatever order they are told") {
  CHECK(status_of({}, {Code::faults, Code::timeout}) == 4);
  CHECK(status_of({}, {Code::timeout, Code::faults}) == 4);
  CHECK(status_of({}, {Code::faults}) == 8);
  CHECK(status_of({well}, {Code::faults}) == 8);
  CHECK(status_of({failed({Code::timeout})}, {Code::faults}) == 4);
}

TEST_CASE("the interface outranks all, but for a signal") {
  CHECK(status_of({}, {Code::timeout, Code::bus_off}) == 3);
  CHECK(status_of({well, failed({Code::timeout})}, {Code::no_acknowledge}) == 3);
  CHECK(status_of({failed({Code::refused}), failed({Code::no_acknowledge})}) == 3);
  CHECK(status_of({failed({Code::refused, Code::no_acknowledge})}) == 3);
  Report report;
  report.fail({Code::interface, "…"});
  report.signal = SIGTERM;
  CHECK(report.exit_status() == 143);
}

TEST_CASE("a signal is 128 and its number") {
  Report report;
  report.targets = {well, well};
  report.signal = SIGINT;
  CHECK(report.exit_status() == 130);
}

TEST_CASE("an error beside servos that all ended well is no success") {
  CHECK(status_of({well, well}, {Code::io}) == 1);
  CHECK(status_of({well, found}, {Code::io}) == 1);
}

TEST_CASE("what the command as a whole failed with outranks how its servos ended") {
  CHECK(status_of({failed({Code::timeout}), failed({Code::refused})}, {Code::io}) == 1);
}

TEST_CASE("errors of the command are told first, then those of each servo") {
  Report report;
  report.fail_target({Code::timeout, "servo 11"});
  report.targets.push_back(well);
  report.fail_target({Code::refused, "servo 12"});
  report.fail({Code::io, "command"});
  std::string told;
  for (const Error& error : report.all_errors()) {
    told += error.message + "; ";
  }
  CHECK(told == "command; servo 11; servo 12; ");
}
