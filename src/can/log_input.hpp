#pragma once
// The bytes of a log: as they stand in a file or come through a pipe, or unpacked where gzip has
// packed them.

#include "can/gunzip.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace blactl::can {

/// Whether it is packed, its first bytes decide, not its name. Never waits.
class LogInput {
 public:
  enum class Fault : std::uint8_t {
    none,
    unreadable, ///< errno says why
    cut_off,    ///< it ends in the middle of what gzip has packed
    damaged,    ///< it is not what gzip has packed
  };

  /// Takes over the descriptor.
  explicit LogInput(int descriptor) : descriptor_(descriptor) {}

  ~LogInput();
  LogInput(const LogInput&) = delete;
  LogInput& operator=(const LogInput&) = delete;

  /// How many bytes were put into `room`, which is not empty. 0: it has ended, or a pipe has
  /// nothing for now.
  [[nodiscard]] std::size_t read(std::span<char> room);

  /// Nothing more comes, because of fault() if there is one.
  [[nodiscard]] bool ended() const { return ended_; }

  [[nodiscard]] Fault fault() const { return fault_; }

  /// Of an unreadable one.
  [[nodiscard]] int error_number() const { return error_number_; }

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  /// What comes behind the first bytes.
  struct Packed {
    Gunzip gunzip{};
    std::vector<char> buffer{};
  };

  [[nodiscard]] std::size_t read_file(std::span<char> room);
  [[nodiscard]] std::size_t read_plain(std::span<char> room);
  [[nodiscard]] std::size_t read_packed(std::span<char> room);
  [[nodiscard]] bool knows_format();
  void end(Fault fault);

  int descriptor_;
  std::array<char, Gunzip::magic.size()> head_{}; ///< its first bytes
  std::size_t head_size_ = 0, head_given_ = 0;
  bool knows_format_ = false;
  bool file_ended_ = false;
  bool ended_ = false;
  Fault fault_ = Fault::none;
  int error_number_ = 0;
  std::unique_ptr<Packed> packed_; ///< null: plain
};

} // namespace blactl::can
