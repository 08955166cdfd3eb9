#include "sim/dataset/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

#include "sim/dataset/files.h"

namespace shimmer::dataset {
namespace {

void Check(bool fine) {
  if (!fine) throw std::runtime_error("SHA-256: libcrypto refused");
}

}  // namespace

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  Check(state_->context && EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr));
}

Sha256::~Sha256() = default;

void Sha256::Add(std::span<const uint8_t> bytes) {
  Check(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()));
}

std::string Sha256::Hex() {
  std::array<uint8_t, EVP_MAX_MD_SIZE> digest;
  unsigned size_bytes = 0;
  Check(EVP_DigestFinal_ex(state_->context, digest.data(), &size_bytes));
  std::string hex;
  for (unsigned i = 0; i < size_bytes; ++i) {
    hex += "0123456789abcdef"[digest[i] >> 4];
    hex += "0123456789abcdef"[digest[i] & 15];
  }
  return hex;
}

std::string Sha256Hex(std::span<const uint8_t> bytes) {
  Sha256 hash;
  hash.Add(bytes);
  return hash.Hex();
}

std::string Sha256HexOfFile(const std::filesystem::path& path) {
  Sha256 hash;
  ReadPieces(path, [&](std::span<const uint8_t> piece) { hash.Add(piece); });
  return hash.Hex();
}

}  // namespace shimmer::dataset
