#include "batch/table.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string>

#include "core/files.hpp"

namespace rejoin::batch {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

const char* stage_of(const store::Pair& pair) {
  if (pair.stage == store::Stage::Sweep) return "sweep";
  return pair.stage == store::Stage::Match ? "match" : "failed";
}

}  // namespace

void write_table(const store::Run& run, const std::filesystem::path& file) {
  std::string text = "a,b,score,verdict,stage,evidence,error\n";
  for (const store::Pair& pair : run.pairs()) {
    fmt::format_to(std::back_inserter(text), "{},{},{:.6f},{},{},{:.3f},{}\n", quoted(pair.name_a),
                   quoted(pair.name_b), pair.score, pair.verdict, stage_of(pair), pair.evidence,
                   quoted(pair.error));
  }
  write_file(file, text);
}

}  // namespace rejoin::batch
