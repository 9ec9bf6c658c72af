#include "picture/image_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "core/files.hpp"

namespace rejoin::picture {
namespace {

constexpr double kCentimetresAnInch = 2.54;
constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);

/// A whole number of `count` bytes; the first byte is the highest if `big`.
std::optional<std::size_t> number_at(std::string_view bytes, std::size_t place, std::size_t count, bool big) {
  if (place > bytes.size() || bytes.size() - place < count) return std::nullopt;
  std::size_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto byte = static_cast<unsigned char>(bytes[place + (big ? i : count - 1 - i)]);
    value = value * 256 + byte;
  }
  return value;
}

/// Two whole numbers, one over the other.
double tiff_ratio(std::string_view bytes, std::size_t place, bool big) {
  const auto above = number_at(bytes, place, 4, big);
  const auto below = number_at(bytes, place + 4, 4, big);
  return above && below && *below > 0 ? static_cast<double>(*above) / static_cast<double>(*below) : 0.0;
}

/// One directory of a TIFF, which describes one picture.
struct TiffDirectory {
  ImageHeader header;
  bool is_page = true;  ///< not a small version or a mask of another
  int orientation = 1;
  std::size_t orientation_at = 0;  ///< place of its value, two bytes; 0: not told
  std::size_t next = 0;            ///< place of the next directory, 0: none
};

/// Tags: 254 kind (bit 0 small version, bit 2 mask), 256 width, 257 height, 258 bits, 274 orientation, 277 samples, 282 dots across a unit, 296 the unit (2 inch, 3 cm).
std::optional<TiffDirectory> tiff_directory(std::string_view bytes, std::size_t place, bool big) {
  const auto entries = number_at(bytes, place, 2, big);
  if (!entries) return std::nullopt;
  TiffDirectory directory;
  ImageHeader& header = directory.header;
  double to_inch = 1.0;
  for (std::size_t i = 0; i < *entries; ++i) {
    const std::size_t entry = place + 2 + 12 * i;
    const auto tag = number_at(bytes, entry, 2, big);
    const auto type = number_at(bytes, entry + 2, 2, big);
    const auto count = number_at(bytes, entry + 4, 4, big);
    const auto value = number_at(bytes, entry + 8, type == 3U ? 2 : 4, big);
    if (!tag || !value) return std::nullopt;
    if (*tag == 254) directory.is_page = (*value & 5U) == 0;
    if (*tag == 256) header.width = *value;
    if (*tag == 257) header.height = *value;
    if (*tag == 258) header.bits = *value;
    if (*tag == 258 && count > 2U) {  // so many stand elsewhere
      const auto there = number_at(bytes, entry + 8, 4, big);
      header.bits = there ? number_at(bytes, *there, 2, big).value_or(0) : 0;
    }
    if (*tag == 274) {
      directory.orientation = static_cast<int>(std::min<std::size_t>(*value, 9));
      directory.orientation_at = type == 3U ? entry + 8 : 0;
    }
    if (*tag == 277) header.samples = *value;
    if (*tag == 282) header.dots_per_inch = tiff_ratio(bytes, *value, big);
    if (*tag == 296) to_inch = *value == 3 ? kCentimetresAnInch : *value == 2 ? 1.0 : 0.0;
  }
  header.dots_per_inch *= to_inch;
  directory.next = number_at(bytes, place + 2 + 12 * *entries, 4, big).value_or(0);
  return directory;
}

/// The first directory of a file or part that begins as a TIFF, as the Exif of other pictures does.
std::optional<TiffDirectory> first_directory(std::string_view bytes) {
  const bool big = bytes.starts_with('M');
  const auto place = number_at(bytes, 4, 4, big);
  return place ? tiff_directory(bytes, *place, big) : std::nullopt;
}

/// What the first chunk of a kind holds; empty: there is none.
std::string_view png_chunk(std::string_view bytes, std::string_view kind) {
  std::size_t place = kPngStart.size();
  while (const auto length = number_at(bytes, place, 4, true)) {
    if (*length > bytes.size() || place + 8 > bytes.size()) break;
    if (bytes.substr(place + 4, 4) == kind) return bytes.substr(place + 8, *length);
    place += 12 + *length;
  }
  return {};
}

/// Whether its last chunk is there: libpng tells on stderr, past every stream, that it is not.
bool png_is_whole(std::string_view bytes) {
  std::size_t place = kPngStart.size();
  while (const auto length = number_at(bytes, place, 4, true)) {
    const std::size_t end = place + 12 + *length;
    if (end > bytes.size()) return false;
    if (bytes.substr(place + 4, 4) == "IEND") return true;
    place = end;
  }
  return false;
}

/// From the pHYs chunk: dots a metre.
double png_resolution(std::string_view bytes) {
  const std::string_view chunk = png_chunk(bytes, "pHYs");
  const auto across = number_at(chunk, 0, 4, true);
  const auto unit = number_at(chunk, 8, 1, true);
  return across && unit == 1U ? static_cast<double>(*across) * kCentimetresAnInch / 100.0 : 0.0;
}

std::optional<ImageHeader> png_header(std::string_view bytes) {
  const auto width = number_at(bytes, 16, 4, true);
  const auto height = number_at(bytes, 20, 4, true);
  if (!width || !height) return std::nullopt;
  ImageHeader header{*width, *height, png_resolution(bytes)};
  const auto exif = first_directory(png_chunk(bytes, "eXIf"));
  if (exif) header.orientation = exif->orientation;
  return header;
}

/// From the JFIF segment, which comes first where there is one: its unit (1 inch, 2 cm) and dots across.
double jpeg_resolution(std::string_view bytes) {
  if (bytes.substr(6, 5) != std::string_view("JFIF\0", 5)) return 0.0;
  const auto unit = number_at(bytes, 13, 1, true);
  const auto across = number_at(bytes, 14, 2, true);
  if (!unit || !across || *unit == 0 || *unit > 2) return 0.0;
  return static_cast<double>(*across) * (*unit == 2 ? kCentimetresAnInch : 1.0);
}

/// The resolution that an Exif segment (APP1) tells, which cameras and scanners write in the place of JFIF.
double exif_resolution(std::string_view segment) {
  constexpr std::string_view kStart("Exif\0\0", 6);
  if (!segment.starts_with(kStart)) return 0.0;
  const auto directory = first_directory(segment.substr(kStart.size()));
  return directory ? directory->header.dots_per_inch : 0.0;
}

/// Walks over the segments to the start of frame (SOF0 to SOF15 but DHT, JPG, DAC).
std::optional<ImageHeader> jpeg_header(std::string_view bytes) {
  std::size_t place = 2;
  double resolution = jpeg_resolution(bytes);
  while (const auto marker = number_at(bytes, place, 2, true)) {
    if (*marker == 0xFFFF) {  // a byte of filling
      ++place;
      continue;
    }
    const auto length = number_at(bytes, place + 2, 2, true);
    if (*marker < 0xFF00 || !length) return std::nullopt;
    if (*marker == 0xFFE1 && resolution == 0.0)
      resolution = exif_resolution(bytes.substr(std::min(place + 4, bytes.size())));
    const bool frame =
        *marker >= 0xFFC0 && *marker <= 0xFFCF && *marker != 0xFFC4 && *marker != 0xFFC8 && *marker != 0xFFCC;
    if (frame) {
      const auto height = number_at(bytes, place + 5, 2, true);
      const auto width = number_at(bytes, place + 7, 2, true);
      if (!width || !height) return std::nullopt;
      return ImageHeader{*width, *height, resolution};
    }
    place += 2 + std::max<std::size_t>(*length, 2);
  }
  return std::nullopt;
}

/// Whether a JPEG ends with the marker of its end.  libjpeg paints grey what is missing, which looks like a piece.
bool jpeg_is_whole(std::string_view bytes) {
  std::size_t place = 2;
  while (const auto marker = number_at(bytes, place, 2, true)) {
    if (*marker == 0xFFDA) return bytes.find("\xFF\xD9", place) != std::string_view::npos;
    if (*marker <= 0xFF00 || *marker == 0xFFFF) {  // bytes that libjpeg passes over
      ++place;
      continue;
    }
    // Over whole segments: a camera's small picture inside one has pixels and an end of its own.
    place += 2 + std::max<std::size_t>(number_at(bytes, place + 2, 2, true).value_or(2), 2);
  }
  return false;
}

/// Of the first directory, with the number of pages of all.
std::optional<ImageHeader> tiff_header(std::string_view bytes) {
  constexpr std::size_t kMostPages = 1000;  // a broken file may lead in a circle
  const bool big = bytes[0] == 'M';
  const auto first = first_directory(bytes);
  if (!first || first->header.width == 0 || first->header.height == 0) return std::nullopt;
  ImageHeader header = first->header;
  header.orientation = first->orientation_at > 0 ? first->orientation : 1;
  for (auto page = first; page && page->next != 0 && header.pages < kMostPages;) {
    page = tiff_directory(bytes, page->next, big);
    if (page && page->is_page) ++header.pages;
  }
  return header;
}

/// What OpenCV would drop, or cannot read and says so in its own words.
void require_usual_samples(const ImageHeader& header, const std::string& path) {
  constexpr std::array<std::size_t, 6> kReadBits = {1, 8, 10, 12, 14, 16};
  if (std::find(kReadBits.begin(), kReadBits.end(), header.bits) == kReadBits.end()) {
    throw InputError(path, fmt::format("has {} bits a channel", header.bits),
                     "save it with 8 or 16 bits a channel");
  }
  if (header.samples == 2)
    throw InputError(path, "is a grey TIFF with transparency, which would be lost", "save it as PNG");
}

/// A TIFF that says of itself that it is upright: OpenCV turns a picture as it is told, but of one in tiles each tile by itself, and
/// leaves the tiles where they are.
std::string without_orientation(std::string bytes) {
  const auto first = first_directory(bytes);
  if (!first || first->orientation_at == 0) return bytes;
  const bool big = bytes.starts_with('M');
  bytes[first->orientation_at] = big ? '\0' : '\1';
  bytes[first->orientation_at + 1] = big ? '\1' : '\0';
  return bytes;
}

/// OpenCV tells what it cannot decode on stderr; the user gets our own words.  On one thread at a time, as the stream is shared.
class SilentErrors {
 public:
  SilentErrors() : alone_(mutex()), before_(std::cerr.rdbuf(nullptr)) {}
  ~SilentErrors() { std::cerr.rdbuf(before_); }
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> alone_;
  std::streambuf* before_;
};

/// A picture turned as its orientation says: 1 is upright, 2 mirrored from left to right, 5 mirrored along its diagonal from
/// the upper left, 8 to be turned to the left by a quarter ...
cv::Mat upright(cv::Mat image, int orientation) {
  constexpr int kDown = 0;  // as cv::flip() calls them
  constexpr int kAcross = 1;
  constexpr int kBoth = -1;
  if (orientation >= 5 && orientation <= 8) cv::transpose(image, image);
  if (orientation == 2 || orientation == 6) cv::flip(image, image, kAcross);
  if (orientation == 3 || orientation == 7) cv::flip(image, image, kBoth);
  if (orientation == 4 || orientation == 8) cv::flip(image, image, kDown);
  return image;
}

/// Grey, colour, with and without alpha, 8 or 16 bits -> floats 0..1.
cv::Mat unify(const cv::Mat& image, const std::string& path) {
  double scale = 0.0;
  if (image.depth() == CV_8U) scale = 1.0 / 255.0;
  if (image.depth() == CV_16U) scale = 1.0 / 65535.0;
  if (scale == 0.0)
    throw InputError(path, "has floating-point samples", "save it with 8 or 16 bits a channel");
  cv::Mat result;
  image.convertTo(result, CV_32F, scale);
  if (result.channels() == 1) cv::cvtColor(result, result, cv::COLOR_GRAY2BGR);
  if (result.channels() != 3 && result.channels() != 4)
    throw InputError(path, fmt::format("has {} channels", result.channels()), "save it as grey or RGB");
  return result;
}

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xFF\xD8");
}

bool is_tiff(std::string_view bytes) {
  return bytes.starts_with(std::string_view("II*\0", 4)) || bytes.starts_with(std::string_view("MM\0*", 4));
}

bool starts_like_a_picture(std::string_view bytes) {
  return bytes.starts_with(kPngStart) || is_jpeg(bytes) || is_tiff(bytes);
}

}  // namespace

bool has_picture_name(const std::filesystem::path& path) {
  constexpr std::array<const char*, 7> kKinds = {".png", ".jpg", ".jpeg", ".jpe", ".jfif", ".tif", ".tiff"};
  return std::find(kKinds.begin(), kKinds.end(), extension_of(path)) != kKinds.end();
}

std::optional<ImageHeader> image_header(std::string_view bytes) {
  if (bytes.starts_with(kPngStart)) return png_header(bytes);
  if (is_jpeg(bytes)) return jpeg_header(bytes);
  if (is_tiff(bytes)) return tiff_header(bytes);
  return std::nullopt;
}

cv::Mat decode_image(const std::string& bytes, const std::string& name, std::size_t max_pixels,
                     std::vector<std::string>* notes) {
  if (bytes.empty()) throw InputError(name, "is empty", "save the picture again");
  const std::optional<ImageHeader> header = image_header(bytes);
  if (!header && starts_like_a_picture(bytes))
    throw InputError(name, "is cut short or damaged", "save the picture again");
  if (!header) throw InputError(name, "is no PNG, JPEG or TIFF picture", "convert it to PNG");
  const std::size_t width = std::max<std::size_t>(header->width, 1);
  if (header->height > max_pixels / width) {
    throw InputError(name,
                     fmt::format("its header claims {} x {} pixels; at most {} million are read",
                                 header->width, header->height, max_pixels / 1000000),
                     "scale the picture down or cut it into parts");
  }
  const bool whole =
      is_jpeg(bytes) ? jpeg_is_whole(bytes) : !bytes.starts_with(kPngStart) || png_is_whole(bytes);
  if (!whole) throw InputError(name, "is cut short: its end is missing", "save the picture again");
  require_usual_samples(*header, name);
  if (notes && header->pages > 1)
    notes->push_back(fmt::format("holds {} pages; the first is read", header->pages));
  cv::Mat image;
  try {
    const bool turned = is_tiff(bytes) && header->orientation != 1;
    const std::string other = turned ? without_orientation(bytes) : std::string();
    const std::string& decoded = turned ? other : bytes;
    const cv::Mat buffer(1, static_cast<int>(decoded.size()), CV_8U, const_cast<char*>(decoded.data()));
    const SilentErrors silent;
    // Unchanged keeps transparency, which a JPEG has none of, but does not turn it upright, nor a PNG.
    image = cv::imdecode(buffer,
                         is_jpeg(bytes) ? cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH : cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& problem) {
    throw InputError(name, "cannot be decoded (" + problem.err + ")", "save it as 8-bit PNG");
  }
  if (image.empty())
    throw InputError(name, "cannot be decoded; it may be cut short", "save the picture again");
  return upright(image, header->orientation);
}

cv::Mat load_image(const std::string& path, std::size_t max_pixels, std::vector<std::string>* notes) {
  return unify(decode_image(read_file(path), path, max_pixels, notes), path);
}

}  // namespace rejoin::picture
