#include "blactl/base/rfc3339.hpp"

#include "catch.hpp"

#include <string>

using namespace blactl;

TEST_CASE("a time of RFC 3339 is known from what is none") {
  for (const char* text : {"2026-11-21T08:15:00Z", "2026-11-21t08:15:00.25z",
                           "2024-02-29T23:59:60+09:00", "0001-01-01T00:00:00-12:30"}) {
    INFO(text);
    CHECK(parse_rfc3339(text));
  }
  for (const char* text :
       {"", "yesterday", "2026-11-21", "2026-11-21T08:15Z", "2026-11-21T08:15:00",
        "2026-11-21 08:15:00Z", "2025-02-29T00:00:00Z", "2026-13-01T00:00:00Z",
        "2026-11-21T24:00:00Z", "2026-11-21T08:60:00Z", "2026-11-21T08:15:61Z",
        "2026-11-21T08:15:00.Z", "2026-11-21T08:15:00+9:00", "2026-11-21T08:15:00Z ",
        "+026-11-21T08:15:00Z"}) {
    INFO(text);
    CHECK_FALSE(parse_rfc3339(text));
  }
}

TEST_CASE("a time is read in any time zone, to the second") {
  const auto read = [](const char* text) { return rfc3339(parse_rfc3339(text).value()); };
  CHECK(read("2026-11-21T08:15:00Z") == "2026-11-21T08:15:00Z");
  CHECK(read("2026-11-21T08:15:07.75Z") == "2026-11-21T08:15:07Z");
  CHECK(read("2026-11-21T08:15:00+09:00") == "2026-11-20T23:15:00Z");
  CHECK(read("2026-11-21T08:15:00-03:30") == "2026-11-21T11:45:00Z");
  CHECK(read("2024-02-29T23:59:60Z") == "2024-03-01T00:00:00Z");
}
