#include "blactl/can/link_setup.hpp"

#include "can/rtnl.hpp"
#include "can/texts.hpp"

#include <netlink/route/link/can.h>

#include <net/if.h>

namespace blactl::can {
namespace {

/// Changes one interface over rtnetlink.
class LinkEditor {
 public:
  explicit LinkEditor(const LinkSetup& setup) : setup_(setup) {}

  [[nodiscard]] Result<void> open() {
    int error = socket_ ? nl_connect(socket_.get(), NETLINK_ROUTE) : -NLE_NOMEM;
    rtnl_link* found = nullptr;
    if (error == 0) {
      error = rtnl_link_get_kernel(socket_.get(), 0, setup_.name.c_str(), &found);
    }
    link_ = NlLink(found, &rtnl_link_put);
    return told(error);
  }

  /// Requests the change that `describe` writes into an empty one.
  template <class Describe> [[nodiscard]] Result<void> change(Describe describe) {
    const NlLink change(rtnl_link_alloc(), &rtnl_link_put);
    if (!change) {
      return told(-NLE_NOMEM);
    }
    describe(change.get());
    return told(rtnl_link_change(socket_.get(), link_.get(), change.get(), 0));
  }

  [[nodiscard]] Result<void> set_up_or_down(bool up) {
    return change([up](rtnl_link* change) {
      up ? rtnl_link_set_flags(change, IFF_UP) : rtnl_link_unset_flags(change, IFF_UP);
    });
  }

  [[nodiscard]] Result<void> set_values();

 private:
  [[nodiscard]] Result<void> told(int error) const {
    const std::string name = printable(setup_.name);
    if (error >= 0) {
      return {};
    }
    if (error == -NLE_PERM) {
      return fail(Code::permission, say<texts::link_setup_not_permitted>(name),
                  say<texts::link_setup_not_permitted_hint>(command(setup_)));
    }
    return fail(Code::interface, say<texts::link_setup_failed>(name, nl_geterror(error)),
                say<texts::link_setup_failed_hint>(command(setup_)));
  }

  const LinkSetup& setup_;
  NlSocket socket_{nl_socket_alloc(), &nl_socket_free};
  NlLink link_{nullptr, &rtnl_link_put};
};

Result<void> LinkEditor::set_values() {
  Result<void> done;
  if (setup_.sets_timing) {
    done = change([](rtnl_link* change) {
      rtnl_link_set_type(change, "can");
      rtnl_link_can_set_bitrate(change, servo_bit_rate);
      rtnl_link_can_set_sample_point(change, servo_sample_point);
    });
  }
  if (done && setup_.sets_restart) {
    // A change by itself, because some drivers lack it, which must not prevent the bit timing.
    done = change([](rtnl_link* change) {
      rtnl_link_set_type(change, "can");
      rtnl_link_can_set_restart_ms(change, static_cast<std::uint32_t>(usual_restart.count()));
    });
  }
  if (done && setup_.sets_queue) {
    done = change([](rtnl_link* change) { rtnl_link_set_txqlen(change, usual_queue_length); });
  }
  return done;
}

} // namespace

std::string command(const LinkSetup& setup) {
  const std::string set = "sudo ip link set " + printable(setup.name);
  std::string settings = setup.goes_up ? " up" : "";
  if (setup.sets_queue) {
    settings += fmt::format(" txqueuelen {}", usual_queue_length);
  }
  if (setup.sets_timing || setup.sets_restart) {
    settings += " type can";
  }
  if (setup.sets_timing) {
    settings += fmt::format(" bitrate {} sample-point 0.{}", servo_bit_rate, servo_sample_point);
  }
  if (setup.sets_restart) {
    settings += fmt::format(" restart-ms {}", usual_restart.count());
  }
  return (setup.goes_down ? set + " down; " : std::string()) + set + settings;
}

std::string up_command(const Link& link) {
  return command({.name = link.name, .sets_timing = link.kind == "can", .goes_up = true});
}

Result<void> may_set_up(const LinkSetup& setup) {
  LinkEditor editor(setup);
  auto done = editor.open();
  return done ? editor.change([](rtnl_link*) {}) : done;
}

Result<void> set_up(const LinkSetup& setup) {
  LinkEditor editor(setup);
  auto done = editor.open();
  if (done && setup.goes_down) {
    done = editor.set_up_or_down(false);
  }
  if (!done) {
    return done;
  }
  done = editor.set_values();
  auto up = setup.goes_up ? editor.set_up_or_down(true) : Result<void>();
  return done ? up : done;
}

} // namespace blactl::can
