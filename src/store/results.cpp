#include "store/results.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace rejoin::store {
namespace {

/// FNV-1a.
std::uint64_t with(std::uint64_t hash, const std::string& text) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * kPrime;
  return hash;
}

}  // namespace

std::string results_hash(const Run& run) {
  std::uint64_t hash = 0xcbf29ce484222325;
  run.each_pair([&hash](const Pair& pair) {
    hash = with(hash, fmt::format("{}/{}/{}/{}/{}/{}\n", pair.name_a, pair.name_b, name_of(pair.stage),
                                  pair.score, pair.evidence, pair.verdict));
  });
  return fmt::format("{:016x}", hash);
}

}  // namespace rejoin::store
