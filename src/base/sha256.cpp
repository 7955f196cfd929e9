#include "blactl/base/sha256.hpp"

#include "blactl/base/hex.hpp"

#include <sha2.h>

#include <array>
#include <cstdint>

namespace blactl {

std::string sha256(std::string_view bytes) {
  SHA2_CTX context;
  SHA256Init(&context);
  SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA256Final(digest.data(), &context);
  return hex(digest);
}

} // namespace blactl
