#include "needless.hpp"

#include <algorithm>
#include <array>

namespace blactl::campaign {
namespace {

struct Reason {
  std::string_view kind, text;
};

constexpr std::string_view unsaved =
    "A restart takes what RAM alone held: nobody but the user can say it again.";
constexpr std::string_view by_other =
    "What the other node changed in the middle is not known to be wished.";

constexpr std::array reasons{
    Reason{"armed", "The vehicle is armed: refused, as it must be."},
    Reason{"driven", "Another node drives the servo: refused, as it must be."},
    Reason{"bursts", "100 ms of disturbance twice a second drive the adapter to bus-off."},
    Reason{"loss", "Of ten or twenty frames one is lost: a response to GetNodeInfo has eleven, and "
                   "`--retries` is the user's."},
    Reason{"bit_flips",
           "A bit of one frame in a hundred is another one: of GetNodeInfo's responses "
           "with their eleven frames one in ten is not taken, now and then three in "
           "a row."},
    Reason{"late_answers",
           "1.5 s late is later than three requests wait; `--timeout` is the user's."},
    Reason{"bus_off", "The adapter is off until the command is run again."},
    Reason{"cut", "The cable is off for up to 0.9 s, longer than three requests."},
    Reason{"mute", "The servo answers nothing."},
    Reason{"lose_responses",
           "Up to three responses in a row are lost: as many as there are requests."},
    Reason{"lose_opcode_answers", "Whether SAVE was carried out is not told, and is looked at."},
    Reason{"ignore_opcodes", "The servo confirms SAVE and does nothing."},
    Reason{"refuse_opcodes", "The servo refuses SAVE."},
    Reason{"deny_opcodes", "The servo says no to SAVE, and does it."},
    Reason{"rom_write_fails", "ROM does not take what RAM holds."},
    Reason{"stays", "The servo confirms SAVE or RestartNode and does not restart."},
    Reason{"never_returns", "The servo does not come back."},
    Reason{"return_delay", "8 s is more than the 5 s that `--wait` gives."},
    Reason{"rom_unread",
           "The servo runs on initial values, its node ID among them: it asks for one, "
           "and SAVE would make them permanent."},
    Reason{"no_actuator_status", "Without actuator.Status it is not known to be a servo: `-n ID` "
                                 "names it."},
    Reason{"no_node_status", "Without NodeStatus it is not known to be there."},
    Reason{"dip", unsaved},
    Reason{"power", unsaved},
    Reason{"plug", "The servo is away in the middle."},
    Reason{"unplug", "The servo is away from the middle on."},
    Reason{"power_loss_in_save", "Power fails while ROM is written: what it holds then is told."},
    Reason{"ram_unlike_rom", unsaved},
    Reason{"restart_after_answer", unsaved},
    Reason{"restart_instead_of_answer", unsaved},
    Reason{"upset", "The servo stops, or loses its ROM, in the middle."},
    Reason{"other_erases", by_other},
    Reason{"other_saves", by_other},
    Reason{"other_restarts", by_other},
    Reason{"other_initializes", by_other},
    Reason{"other_writes", by_other},
    Reason{"other_repeats", by_other},
    Reason{"own_id_taken", "A frame that the command before left in the adapter passes for one of "
                           "another node on its second ID."},
    Reason{"allocator", "Another allocator gives IDs meanwhile."},
};

} // namespace

std::string_view why_not_0(std::string_view kind_of_fault) {
  const auto* const found = std::ranges::find(reasons, kind_of_fault, &Reason::kind);
  return found != reasons.end() ? found->text : std::string_view();
}

} // namespace blactl::campaign
