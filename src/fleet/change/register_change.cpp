#include "blactl/fleet/change/register_change.hpp"

namespace blactl::fleet {

std::string_view name(ChangeStatus status) {
  switch (status) {
  case ChangeStatus::planned: return "planned";
  case ChangeStatus::unchanged: return "unchanged";
  case ChangeStatus::written: return "written";
  case ChangeStatus::failed: return "failed";
  case ChangeStatus::mismatch: return "mismatch";
  }
  return {};
}

} // namespace blactl::fleet
