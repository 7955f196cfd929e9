#pragma once
// Asks every unit that appears or restarts who it is.

#include "blactl/fleet/registers.hpp"
#include "blactl/fleet/session.hpp"

#include <list>

namespace blactl::fleet {

/// As long as it lives, a node that is heard for the first time or that restarted is asked
/// GetNodeInfo; the answer is in Member::info. Nodes that are known already are not asked.
class Recognizer {
 public:
  /// `session` outlives this, and its jobs end (run(), or the end of the session) before this does.
  Recognizer(Session& session, Patience patience);
  ~Recognizer();
  Recognizer(const Recognizer&) = delete;
  Recognizer& operator=(const Recognizer&) = delete;

 private:
  class AskJob;

  Session& session_;
  Patience patience_;
  std::list<AskJob> jobs_;
};

} // namespace blactl::fleet
