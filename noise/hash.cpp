#include "noise/hash.h"

#include <bit>

namespace shimmer::noise {
namespace {

struct SipState {
  uint64_t v0, v1, v2, v3;

  void Round() {
    v0 += v1, v1 = std::rotl(v1, 13) ^ v0, v0 = std::rotl(v0, 32);
    v2 += v3, v3 = std::rotl(v3, 16) ^ v2;
    v0 += v3, v3 = std::rotl(v3, 21) ^ v0;
    v2 += v1, v1 = std::rotl(v1, 17) ^ v2, v2 = std::rotl(v2, 32);
  }

  void Absorb(uint64_t word) {
    v3 ^= word;
    Round(), Round();
    v0 ^= word;
  }
};

// Up to eight bytes, first byte lowest, whatever the machine's byte order.
uint64_t LittleEndianWord(std::string_view bytes) {
  uint64_t word = 0;
  for (size_t i = 0; i < bytes.size(); ++i) word |= uint64_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return word;
}

}  // namespace

uint64_t HashPath(uint64_t seed, uint64_t clip, std::string_view path) {
  SipState sip{seed ^ 0x736f6d6570736575u, clip ^ 0x646f72616e646f6du, seed ^ 0x6c7967656e657261u,
               clip ^ 0x7465646279746573u};
  const uint64_t length_byte = uint64_t{path.size()} << 56;
  for (; path.size() >= 8; path.remove_prefix(8)) sip.Absorb(LittleEndianWord(path.substr(0, 8)));
  sip.Absorb(LittleEndianWord(path) | length_byte);
  sip.v2 ^= 0xff;
  for (int i = 0; i < 4; ++i) sip.Round();
  return sip.v0 ^ sip.v1 ^ sip.v2 ^ sip.v3;
}

}  // namespace shimmer::noise
