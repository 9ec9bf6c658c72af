#include "store/results.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <string>

namespace rejoin::store {

std::string results_hash(const Run& run) {
  XXH64_hash_t hash = 0;
  run.each_pair([&hash](const Pair& pair) {
    const std::string text = fmt::format("{}/{}/{}/{}/{}/{}\n", pair.name_a, pair.name_b, name_of(pair.stage),
                                         pair.score, pair.evidence, pair.verdict);
    hash = XXH3_64bits_withSeed(text.data(), text.size(), hash);  // of all before, too
  });
  return fmt::format("{:016x}", hash);
}

}  // namespace rejoin::store
