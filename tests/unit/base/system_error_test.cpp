#include "blactl/base/system_error.hpp"
#include "blactl/base/text.hpp"

#include "catch.hpp"

#include <cerrno>
#include <cstring>
#include <string>

using namespace blactl;

TEST_CASE("what the system means is said in the language of the session") {
  CHECK(system_reason(ENOSPC) == "No space left on device");
  set_language(Language::japanese);
  const std::string said = system_reason(ENOSPC);
  const std::string rare = system_reason(EXDEV);
  set_language(Language::english);
  CHECK(said == "空き容量がありません");
  CHECK(rare == "エラー " + std::to_string(EXDEV) + " (Invalid cross-device link)");
}

TEST_CASE("in English an error is called as everywhere else") {
  for (const int error :
       {EACCES, EBUSY, EISDIR, EMFILE, ENETDOWN, ENODEV, ENOENT, ENOTDIR, ENOTSUP, EPERM, EROFS}) {
    CHECK(system_reason(error) == std::strerror(error));
  }
}

TEST_CASE("an error that is rarely met is told with its number") {
  CHECK(system_reason(EXDEV) == "Invalid cross-device link (error " + std::to_string(EXDEV) + ')');
}
