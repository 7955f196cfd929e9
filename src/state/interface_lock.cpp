#include "blactl/state/interface_lock.hpp"

#include "blactl/base/system_error.hpp"

#include "state/texts.hpp"

#include <utility>

namespace blactl::state {

Result<InterfaceLock> InterfaceLock::acquire(const LockPlace& place, Right right) {
  const std::string folder = LockFile::folder(place);
  if (folder.empty()) {
    return InterfaceLock(std::nullopt);
  }
  auto locked = LockFile::take(folder, place, right == Right::write ? "write" : "alloc");
  if (locked) {
    return InterfaceLock(std::move(*locked));
  }
  const LockRefusal& refusal = locked.error();
  if (refusal.error != 0) {
    return fail(Code::busy,
                say<texts::lock_failed>(printable(refusal.path), system_reason(refusal.error)),
                say<texts::lock_failed_hint>(printable(refusal.path)));
  }
  const std::string interface = printable(place.interface);
  const std::string holder =
      refusal.pid ? std::to_string(*refusal.pid) : say<texts::unknown_process>();
  return fail(Code::busy,
              right == Right::write ? say<texts::writing_held>(interface, holder)
                                    : say<texts::allocating_held>(interface, holder),
              say<texts::lock_held_hint>());
}

} // namespace blactl::state
