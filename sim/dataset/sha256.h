// SHA-256 as text: 64 lower-case hex digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace shimmer::dataset {

std::string Sha256Hex(std::span<const uint8_t> bytes);

// Of a file's bytes, read piece by piece. Throws std::runtime_error if it can't be read (a folder can't).
std::string Sha256HexOfFile(const std::filesystem::path& path);

// The same piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void Add(std::span<const uint8_t> bytes);
  std::string Hex();  // of all that was added; once

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shimmer::dataset
