#include "blactl/can/serial_adapters.hpp"

#include "can/slcan_texts.hpp"

#include <algorithm>
#include <set>
#include <system_error>

namespace blactl::can {
namespace {

namespace fs = std::filesystem;

/// The entries of a folder, sorted; none if it cannot be read.
std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    found.push_back(it->path());
  }
  std::ranges::sort(found);
  return found;
}

fs::path target(const fs::path& path) {
  std::error_code error;
  auto canonical = fs::canonical(path, error);
  return error ? path : canonical;
}

} // namespace

std::vector<fs::path> serial_adapters(const fs::path& devices) {
  std::vector<fs::path> found = entries(devices / "serial" / "by-id");
  std::set<fs::path> named;
  for (const fs::path& path : found) {
    named.insert(target(path));
  }
  for (const fs::path& path : entries(devices)) {
    const std::string name = path.filename().string();
    if ((name.starts_with("ttyUSB") || name.starts_with("ttyACM")) &&
        !named.contains(target(path))) {
      found.push_back(path);
    }
  }
  return found;
}

std::string describe(const std::vector<fs::path>& adapters) {
  if (adapters.empty()) {
    return {};
  }
  std::string list;
  for (const fs::path& path : adapters) {
    list += list.empty() ? "slcan:" : ", slcan:";
    list += printable(path.string());
  }
  return say<texts::serial_adapters_here>(list);
}

} // namespace blactl::can
