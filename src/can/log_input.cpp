#include "can/log_input.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace blactl::can {
namespace {

/// The size of one read of a packed file.
constexpr std::size_t packed_size = 64 << 10;

} // namespace

LogInput::~LogInput() {
  close(descriptor_);
}

std::size_t LogInput::read(std::span<char> room) {
  if (ended_ || !knows_format()) {
    return 0;
  }
  return packed_ ? read_packed(room) : read_plain(room);
}

void LogInput::end(Fault fault) {
  ended_ = true;
  fault_ = fault_ == Fault::none ? fault : fault_;
}

/// Reads as many bytes as the file has for now.
std::size_t LogInput::read_file(std::span<char> room) {
  // Whoever gave us a pipe may read from it too, so its mode is not ours to change: poll first.
  pollfd readable{descriptor_, POLLIN, 0};
  if (file_ended_ || poll(&readable, 1, 0) <= 0) {
    return 0;
  }
  const auto size = ::read(descriptor_, room.data(), room.size());
  if (size < 0 && (errno == EINTR || errno == EAGAIN)) {
    return 0;
  }
  if (size < 0) {
    error_number_ = errno;
    fault_ = Fault::unreadable;
  }
  file_ended_ = size <= 0;
  return static_cast<std::size_t>(std::max<ssize_t>(size, 0));
}

/// Whether its first bytes have been read; empty and very short files are plain.
bool LogInput::knows_format() {
  const auto may_be_packed = [&] {
    return std::equal(head_.data(), head_.data() + head_size_, Gunzip::magic.data());
  };
  while (!knows_format_ && !file_ended_ && head_size_ < head_.size() && may_be_packed()) {
    const auto size = read_file(std::span(head_).subspan(head_size_));
    head_size_ += size;
    if (size == 0 && !file_ended_) {
      return false;
    }
  }
  if (!std::exchange(knows_format_, true) && head_size_ == head_.size() && may_be_packed()) {
    packed_ = std::make_unique<Packed>();
    packed_->buffer.resize(packed_size);
    packed_->gunzip.take(head_);
  }
  return true;
}

std::size_t LogInput::read_plain(std::span<char> room) {
  if (head_given_ < head_size_) {
    const auto left = std::span(head_).first(head_size_).subspan(head_given_);
    const auto size = std::min(left.size(), room.size());
    std::ranges::copy(left.first(size), room.begin());
    head_given_ += size;
    return size;
  }
  const auto size = read_file(room);
  if (file_ended_) {
    end(Fault::none);
  }
  return size;
}

std::size_t LogInput::read_packed(std::span<char> room) {
  for (;;) {
    if (const auto size = packed_->gunzip.unpack(room); size > 0) {
      return size;
    }
    if (packed_->gunzip.is_damaged()) {
      end(Fault::damaged);
      return 0;
    }
    const auto size = read_file(packed_->buffer);
    if (file_ended_) {
      end(packed_->gunzip.is_whole() ? Fault::none : Fault::cut_off);
    }
    if (size == 0) {
      return 0;
    }
    packed_->gunzip.take(std::span(packed_->buffer).first(size));
  }
}

} // namespace blactl::can
