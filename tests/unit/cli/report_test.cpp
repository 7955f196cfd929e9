#include "catch.hpp"
#include "cli/output/report.hpp"

#include <signal.h>

#include <vector>

using namespace blactl;
using cli::Report;

namespace {

int status_of(std::vector<int> statuses, const std::vector<Code>& codes = {}) {
  Report report;
  report.statuses = std::move(statuses);
  for (const Code code : codes) {
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
  CHECK(status_of({0, 0, 0}) == 0);
  CHECK(status_of({4}, {Code::timeout}) == 4);
  CHECK(status_of({5, 5}, {Code::refused, Code::mismatch}) == 5);
}

TEST_CASE("success and failure, or different failures, are mixed") {
  CHECK(status_of({0, 4}, {Code::timeout}) == 6);
  CHECK(status_of({4, 5}, {Code::timeout, Code::refused}) == 6);
  CHECK(status_of({8, 4}, {Code::timeout}) == 6);
}

TEST_CASE("some with and some without a finding are 8") {
  CHECK(status_of({8, 0}) == 8);
  CHECK(status_of({0, 8, 0}) == 8);
  CHECK(status_of({8, 8}, {Code::faults}) == 8);
}

TEST_CASE("a failure outranks a finding, in whatever order they are told") {
  CHECK(status_of({}, {Code::faults, Code::timeout}) == 4);
  CHECK(status_of({}, {Code::timeout, Code::faults}) == 4);
  CHECK(status_of({}, {Code::faults}) == 8);
}

TEST_CASE("the interface outranks all, but for a signal") {
  CHECK(status_of({}, {Code::timeout, Code::bus_off}) == 3);
  CHECK(status_of({0, 4}, {Code::timeout, Code::no_acknowledge}) == 3);
  CHECK(status_of({5, 3}) == 3);
  Report report;
  report.fail({Code::interface, "…"});
  report.signal = SIGTERM;
  CHECK(report.exit_status() == 143);
}

TEST_CASE("a signal is 128 and its number") {
  Report report;
  report.statuses = {0, 0};
  report.signal = SIGINT;
  CHECK(report.exit_status() == 130);
}

TEST_CASE("an error beside servos that all ended well is no success") {
  CHECK(status_of({0, 0}, {Code::io}) == 1);
  CHECK(status_of({0, 8}, {Code::io}) == 1);
}
