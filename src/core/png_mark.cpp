#include "core/png_mark.hpp"

#include <cstdint>
#include <fstream>

namespace rejoin {
namespace {

constexpr std::size_t kAfterHeader = 33;  // the signature, then the header's chunk of 13 bytes
constexpr std::string_view kKindAndText("tEXtSoftware\0rejoin", 19);

/// The four bytes of a number, highest first.
std::string four_bytes(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFFU);
  return bytes;
}

/// The checksum of a chunk's kind and content, as PNG has it (CRC-32).
std::uint32_t checksum(std::string_view bytes) {
  std::uint32_t sum = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum & 1U) != 0 ? 0xEDB88320U ^ sum >> 1U : sum >> 1U;
  }
  return ~sum;
}

}  // namespace

std::string marked_png(std::string_view png) {
  constexpr std::uint32_t kKindSize = 4;
  std::string marked(png.substr(0, kAfterHeader));
  marked += four_bytes(static_cast<std::uint32_t>(kKindAndText.size()) - kKindSize);
  marked += kKindAndText;
  marked += four_bytes(checksum(kKindAndText));
  return marked += png.substr(kAfterHeader);
}

bool is_marked_png(std::string_view bytes) {
  constexpr std::size_t kLength = 4;
  return bytes.starts_with("\x89PNG") && bytes.size() > kAfterHeader + kLength &&
         bytes.substr(kAfterHeader + kLength).starts_with(kKindAndText);
}

bool is_marked_png_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string start(kAfterHeader + 8 + kKindAndText.size(), '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return is_marked_png(start);
}

}  // namespace rejoin
