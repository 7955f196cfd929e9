// The final verdict on the servo: losses, changes by other nodes meanwhile, and unmet goals.

#include "blactl/base/hex.hpp"
#include "blactl/fleet/bus/conflict_texts.hpp"
#include "blactl/fleet/bus/texts.hpp"
#include "blactl/fleet/bus/unreachable.hpp"
#include "blactl/fleet/change/change_job.hpp"

#include "fleet/change/last_look.hpp"
#include "fleet/change/texts.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace blactl::fleet {

/// A register written by another node was neither refused nor changed by the servo.
void ChangeJob::blame_other_writer(RegisterChange& change) const {
  const auto writer = roster_.writer_to(servo_.id, known_since(), change.parameter->address);
  if (writer && change.error && change.after) {
    const std::uint8_t id = servo_.id.value();
    change.error = Error{Code::state, say<texts::other_writer>(id, writer->value()),
                         say<texts::other_writer_hint>(), id};
  }
}

/// Differing values that another node wrote are not the fault of the servo or its ROM.
void ChangeJob::blame_other_writer() {
  const bool differs =
      result_.error && (result_.error->code == Code::mismatch ||
                        (stage_ == Stage::look && result_.error->code == Code::state));
  for (const dronecan::NodeId id : {servo_.id, result_.returned.value_or(servo_.id)}) {
    if (const auto writer = roster_.writer_to(id, known_since()); differs && writer) {
      result_.error = Error{Code::state, say<texts::other_writer>(id.value(), writer->value()),
                            say<texts::other_writer_hint>(), id.value()};
    }
  }
}

/// Lists what has been sent. A second unit that shows up may have received it, too.
void ChangeJob::tell_reach() {
  const bool has_sent = result_.was_sent = (erase_ && erase_->is_sent()) ||
                                           (write_ && write_->has_written()) ||
                                           (restart_ && restart_->is_sent());
  result_.may_have_changed = was_erased_ || (write_ && write_->may_have_changed()) ||
                             (restart_ && restart_->may_have_happened());
  const auto tell = [&](std::optional<Error>& error) {
    const bool is_doubled = error && error->code == Code::duplicate_node_id;
    const bool is_unsaved =
        is_doubled && restart_ && !restart_->is_sent() && !roster_.is_doubled(servo_.id);
    if (has_sent && is_doubled && !is_unsaved) {
      error->hint = say<texts::doubled_meanwhile_hint>();
    }
    if (has_sent && error &&
        (error->code == Code::armed || error->code == Code::driven || is_unsaved)) {
      error->message = say<texts::stopped_halfway>(servo_.id.value(), error->message);
    }
  };
  tell(result_.error);
  for (RegisterChange& change : result_.changes) {
    tell(change.error);
  }
}

/// Reports the present values of the changed registers, after a failed SAVE.
void ChangeJob::tell_saved(const Snapshot& now) {
  result_.doubt();
  for (RegisterChange& change : result_.changes) {
    if (const auto raw = now.raw(change.parameter->address)) {
      const RegisterChange* planned = plan_.change_of(change.parameter->address);
      const bool was_sent = planned == nullptr || planned->is_planned();
      change.after = raw;
      change.status = *raw != change.requested ? ChangeStatus::mismatch
                      : was_sent               ? ChangeStatus::written
                                               : ChangeStatus::unchanged;
    }
  }
}

/// The earliest request for anything reported about the servo.
Time ChangeJob::known_since() const {
  return std::min(begin_, plan_.before.servo.since);
}

/// Another node that wrote, as far as heard, to registers that this job has changed, checked or
/// shows, or by which the changes were judged.
std::optional<dronecan::NodeId> ChangeJob::other_writer() const {
  const dronecan::NodeId id = plan_.before.servo.id;
  if (plan_.erase) {
    return roster_.writer_to(id, known_since());
  }
  std::vector<bla::Address> concerned = plan_.shown;
  for (const RegisterChange& change : result_.changes) {
    concerned.push_back(change.parameter->address);
  }
  for (const WriteJob::Premise& premise : premises()) {
    concerned.push_back(premise.parameter->address);
  }
  for (const bla::Address address : concerned) {
    const bool is_command =
        std::ranges::find(bla::command_registers, address) != bla::command_registers.end();
    const auto writer = is_command ? roster_.commander_of(plan_.before.servo, known_since())
                                   : roster_.writer_to(id, known_since(), address);
    if (writer) {
      return writer;
    }
  }
  return std::nullopt;
}

std::optional<Servo> ChangeJob::in_ram_only() const {
  const bool is_changed = plan_.erase || !result_.changes.empty();
  const bool is_in_ram = !plan_.restart && is_changed && result_.is_done();
  return is_in_ram ? std::optional(servo_) : std::nullopt;
}

bool ChangeJob::is_proven() const {
  return result_.is_done() && result_.returned && result_.rom && !result_.rom->values.empty();
}

std::optional<Servo> ChangeJob::back_before(Time time) const {
  const bool is_back = result_.is_done() && result_.returned && read_;
  if (!is_back || read_->began() >= time) {
    return std::nullopt;
  }
  Servo servo = read_->snapshot().servo;
  servo.unique_id = servo_.unique_id; // also where its shown values could not be read
  return servo;
}

bool ChangeJob::has_restarted_since() const {
  return is_proven() &&
         may_have_restarted(roster_, *result_.returned, read_->snapshot().servo.boot, health_);
}

void ChangeJob::read_again() {
  unproven_ = unproven_since(roster_, *result_.returned, read_->snapshot().servo.boot);
  stage_ = Stage::begin;
  reads_again_ = result_.is_read_again = true;
  result_.rom.reset();
}

void ChangeJob::look_back(std::optional<Error> lost) {
  const dronecan::NodeId id = result_.node_id_after.value_or(servo_.id);
  const auto is_saved_by_other = [&](dronecan::NodeId under) {
    return roster_.saver_of(under, known_since()).has_value();
  };
  if (result_.was_sent && (is_saved_by_other(id) || is_saved_by_other(plan_.before.servo.id))) {
    result_.may_have_saved = true; // by that node: undo is to put ROM back, too
  }
  if (!result_.is_done()) {
    const bool has_stayed = !restart_ || !restart_->is_sent() || restart_->has_run_on();
    const bool is_silent = result_.error && result_.error->code == Code::timeout;
    if (has_stayed && (is_silent || roster_.member(id).boots != servo_.boot || other_writer())) {
      result_.doubt();
    }
    return;
  }
  const bool is_in_ram_only = in_ram_only().has_value();
  const bool is_rom_told = result_.saved || plan_.proves_rom;
  const auto saver = is_in_ram_only ? roster_.saver_of(id, known_since()) : std::nullopt;
  if (roster_.is_doubled(id)) {
    result_.error = doubled(roster_, id);
  } else if (saver) {
    result_.error = Error{Code::state, say<texts::saved_by_other>(id.value(), saver->value()),
                          say<texts::run_again_hint>(), id.value()};
  } else if (is_in_ram_only && roster_.member(id).boots != servo_.boot) {
    result_.error = Error{Code::state, say<texts::lost_since>(id.value()),
                          say<texts::run_again_hint>(), id.value()};
  } else if (const auto writer = is_in_ram_only ? other_writer() : std::nullopt; writer) {
    result_.error = Error{Code::state, say<texts::written_by_other>(id.value(), writer->value()),
                          say<texts::other_writer_hint>(), id.value()};
  } else if (const auto later =
                 is_rom_told ? roster_.setter_of(id, restart_->sent_at()) : std::nullopt;
             later) {
    result_.error = Error{Code::state, say<texts::written_by_other>(id.value(), later->value()),
                          say<texts::other_writer_hint>(), id.value()};
  } else if (lost) {
    result_.error = std::move(lost);
  } else {
    return;
  }
  result_.is_verified = result_.saved = false;
  result_.doubt();
}

/// Explains unmet goals if the stage itself cannot.
void ChangeJob::explain_interruption(Stage at) {
  const std::uint8_t id = servo_.id.value();
  const std::string uid = servo_.unique_id ? hex(*servo_.unique_id) : std::string();
  const bool is_unsaved =
      at == Stage::write || at == Stage::look || (at == Stage::restart && !restart_->is_sent());
  const auto interrupted = [&](std::string message) {
    result_.error =
        Error{Code::interrupted, std::move(message), say<texts::what_it_holds_hint>(uid), id};
  };
  if (at == Stage::read_back && plan_.restart == RestartKind::save) {
    interrupted(say<texts::saved_not_verified>(id, result_.returned.value_or(servo_.id).value()));
  } else if ((at == Stage::erase && erase_->is_sent()) || at == Stage::read_erased) {
    interrupted(say<texts::erased_not_verified>(id));
  } else if (plan_.erase && is_unsaved) {
    interrupted(say<texts::erased_not_saved>(id));
  } else if (at == Stage::write) {
    for (RegisterChange& change : result_.changes) { // what the servo refused stays said
      if (change.error && change.error->code == Code::interrupted) {
        change.error.reset();
      }
    }
    interrupted(write_->has_written() ? say<texts::write_broken_off>(id)
                                      : say<texts::before_next_write>(id));
  } else if (is_unsaved && at != Stage::write && !plan_.changes.empty()) {
    interrupted(say<texts::not_saved>(id));
  }
}

} // namespace blactl::fleet
