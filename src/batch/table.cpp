#include "batch/table.hpp"

#include <fmt/format.h>

#include <ostream>
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

}  // namespace

void write_table(const store::Run& run, const std::filesystem::path& file) {
  write_file(file, [&run](std::ostream& out) {
    out << "a,b,score,verdict,stage,evidence,error\n";
    run.each_pair([&out](const store::Pair& pair) {
      out << fmt::format("{},{},{:.6f},{},{},{:.3f},{}\n", quoted(pair.name_a), quoted(pair.name_b),
                         pair.score, pair.verdict, name_of(pair.stage), pair.evidence, quoted(pair.error));
    });
  });
}

}  // namespace rejoin::batch
