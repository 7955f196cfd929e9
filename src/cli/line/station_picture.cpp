#include "cli/line/station_picture.hpp"

#include "blactl/fleet/line/line_record.hpp"

#include <algorithm>
#include <utility>

namespace blactl::cli {

using fleet::StationStage;
using state::LedgerRecord;

void StationPicture::enter(StationStage stage, std::optional<std::int64_t> serial_number) {
  switch (stage) {
  case StationStage::waiting: // one that left before it was known has no record
    deed = deed == LineDeed::bring_back ? deed : LineDeed::connect;
    return;
  case StationStage::recognised: // an error is to be seen while the next one is asked who it is
    deed = LineDeed::leave;
    if (!std::exchange(has_successor, false)) {
      last.reset();
    }
    joined.reset();
    return;
  case StationStage::working:
    deed = LineDeed::hands_off;
    last.reset();
    return;
  case StationStage::gone:
    deed = LineDeed::bring_back;
    last.reset();
    gone = serial_number;
    return;
  case StationStage::ended: return; // its record comes
  case StationStage::left:          // an error needs the full time without a frame
    has_successor = false;
    deed = are_several() || (last && last->verdict == fleet::verdict::error && !is_repeating)
               ? LineDeed::leave
               : LineDeed::connect;
    return;
  case StationStage::other:
    if (joined) {
      last = std::exchange(joined, std::nullopt);
      reason = joined_reason;
    }
    deed = are_several() ? LineDeed::take_off : LineDeed::leave;
    return;
  case StationStage::take_off: break;
  }
  deed = is_repeating ? deed : LineDeed::take_off; // of one that is gone: as its record came
}

bool StationPicture::are_several() const {
  return joined || (last && last->code == name(Code::several_servos));
}

void StationPicture::join(const LedgerRecord& record, const std::optional<Error>& why) {
  totals.add(record);
  joined = record;
  joined_reason = why;
}

void StationPicture::take(const LedgerRecord& record, const std::optional<Error>& why,
                          bool is_again, bool is_occupied) {
  totals.add(record);
  last = record;
  reason = why;
  is_repeating = is_again;
  has_successor = is_again && is_occupied;
  deed = !is_again     ? LineDeed::take_off
         : is_occupied ? LineDeed::leave // it is asked next
                       : LineDeed::connect;
}

bool StationPicture::is_busy() const {
  return deed == LineDeed::leave || deed == LineDeed::hands_off;
}

bool StationPicture::tick() {
  ++beat;
  return is_busy();
}

int StationPicture::bells() const {
  const auto& told = joined ? joined : last;
  return !told                                    ? 0
         : told->verdict == fleet::verdict::fail  ? 3
         : told->verdict == fleet::verdict::error ? 2
                                                  : 1;
}

} // namespace blactl::cli
