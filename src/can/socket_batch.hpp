#pragma once
// Messages of a socket, many at a time, with the ancillary data of each.

#include "blactl/can/arrivals.hpp"

#include <sys/socket.h>

#include <array>
#include <cstddef>

namespace blactl::can {

template <class T> bool set_option(int descriptor, int level, int option, const T& value) {
  return setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

/// Asks for receive time stamps, the count of dropped messages, and a buffer for 3 s of a full bus.
/// False: the kernel refuses one of the first two; errno has the reason.
[[nodiscard]] bool prepare_to_receive(int descriptor);

/// The ancillary data of a message, if asked for (prepare_to_receive()).
[[nodiscard]] Aside aside(const msghdr& header);

/// The messages of one recvmmsg() call, each with a `Content` and the sender's `Address`.
template <class Content, class Address> class SocketBatch {
 public:
  struct Message {
    Content content;
    Address from;
    std::size_t size; ///< Bytes read: at most sizeof(Content).
    int flags;        ///< MSG_TRUNC: it was longer; MSG_CONFIRM: sent by this socket (CAN).
    Aside aside;
  };

  /// Returns the number of messages read; -1: see errno.
  int take(int descriptor) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      Slot& slot = slots_[i];
      slot.part = {&slot.content, sizeof(Content)};
      msghdr& header = messages_[i].msg_hdr;
      header = {};
      header.msg_name = &slot.from;
      header.msg_namelen = sizeof slot.from;
      header.msg_iov = &slot.part;
      header.msg_iovlen = 1;
      header.msg_control = slot.control.data();
      header.msg_controllen = slot.control.size();
    }
    return recvmmsg(descriptor, messages_.data(), at_once, 0, nullptr);
  }

  [[nodiscard]] Message message(int index) const {
    const auto at = static_cast<std::size_t>(index);
    const msghdr& header = messages_[at].msg_hdr;
    return {slots_[at].content, slots_[at].from, messages_[at].msg_len, header.msg_flags,
            can::aside(header)};
  }

 private:
  struct Slot {
    Content content;
    Address from;
    alignas(cmsghdr) std::array<std::byte, 64> control;
    iovec part;
  };

  static constexpr unsigned at_once = 16;

  std::array<Slot, at_once> slots_{};
  std::array<mmsghdr, at_once> messages_{};
};

} // namespace blactl::can
