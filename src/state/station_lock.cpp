#include "blactl/state/station_lock.hpp"

#include "blactl/base/sha256.hpp"

#include "state/texts.hpp"

#include <cstddef>

namespace blactl::state {

/// A name may be any text: the name of the file is its digest.
Result<StationLock> StationLock::acquire(const std::string& folder, const std::string& station) {
  constexpr std::size_t enough = 16;
  const LockPlace place{.interface =
                            "station-" + sha256(folder + '\n' + station).substr(0, enough)};
  const std::string locks = LockFile::folder(place);
  if (locks.empty()) {
    return StationLock(std::nullopt);
  }
  auto locked = LockFile::take(locks, place, "lock");
  return locked ? Result<StationLock>(StationLock(std::move(*locked)))
                : fail(Code::busy, say<texts::station_held>(printable(station)),
                       say<texts::station_held_hint>());
}

} // namespace blactl::state
