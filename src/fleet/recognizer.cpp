#include "fleet/recognizer.hpp"

namespace blactl::fleet {

using dronecan::GetNodeInfo;
using dronecan::Outcome;

/// One question. A unit that restarts while it is asked is asked again by a job of its own.
class Recognizer::AskJob final : public dronecan::Job {
 public:
  AskJob(Member& member, Patience patience) : member_(member), patience_(patience) {}

  [[nodiscard]] dronecan::Step next(const Outcome& outcome) override {
    if (outcome.kind == Outcome::Kind::start) {
      return ask(member_.id, GetNodeInfo::type, GetNodeInfo::Request{}.encode(), patience_);
    }
    auto info = outcome.answered() ? GetNodeInfo::Response::decode(outcome.payload) : std::nullopt;
    if (info) {
      member_.info = std::move(*info);
      member_.info_boot = member_.boots;
    }
    return std::nullopt;
  }

  /// Those who wait for a unit to come back may not be left half done.
  [[nodiscard]] bool must_finish() const override { return true; }

 private:
  Member& member_;
  Patience patience_;
};

Recognizer::Recognizer(Session& session, Patience patience)
    : session_(session), patience_(patience) {
  session_.roster().on_new_unit(
      [this](Member& member) { session_.start(jobs_.emplace_back(member, patience_)); });
}

Recognizer::~Recognizer() {
  session_.roster().on_new_unit({});
}

} // namespace blactl::fleet
