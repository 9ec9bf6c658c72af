/// Files of pictures: what is refused, and how what is read lies.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/extract.hpp"
#include "outline/polygon.hpp"
#include "soft_disc.hpp"

namespace rejoin::outline {
namespace {

using testing::disc;
using testing::Folder;
using testing::kCentre;
using testing::painted;
using testing::with_alpha;

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Sets a number of 16 bits in the first directory of a TIFF that OpenCV wrote (lowest byte first).
void set_tiff_tag(const std::string& path, int tag, char value) {
  std::string bytes = read_bytes(path);
  const auto number = [&](std::size_t at, std::size_t count) {
    std::size_t result = 0;
    for (std::size_t i = count; i-- > 0;) result = 256 * result + static_cast<unsigned char>(bytes[at + i]);
    return result;
  };
  const std::size_t directory = number(4, 4);
  for (std::size_t i = 0; i < number(directory, 2); ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (number(entry, 2) == static_cast<std::size_t>(tag)) bytes[entry + 8] = value;
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

void expect_refusal(const std::string& path, const std::string& reason, const ExtractOptions& options = {}) {
  try {
    extract(path, options);
    FAIL() << path;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}

TEST(ExtractFiles, PicturesWithoutAPieceSaySo) {
  const Folder folder;
  cv::Mat plain(60, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  cv::imwrite(folder.file("plain.png"), plain);
  expect_refusal(folder.file("plain.png"), "no piece stands out");
  cv::imwrite(folder.file("glass.png"), cv::Mat(60, 80, CV_8UC4, cv::Scalar(9, 9, 9, 0)));
  expect_refusal(folder.file("glass.png"), "transparent");
}

TEST(ExtractFiles, BrokenFilesAreNamed) {
  const Folder folder;
  std::ofstream(folder.file("empty.png")).close();
  expect_refusal(folder.file("empty.png"), "is empty");
  std::ofstream(folder.file("text.png")) << "no picture at all";
  expect_refusal(folder.file("text.png"), "is no PNG, JPEG or TIFF");
  EXPECT_THROW(extract(folder.file("missing.png")), IoError);
  cv::imwrite(folder.file("disc.png"), with_alpha(disc({128, 120})));
  std::filesystem::resize_file(folder.file("disc.png"), 40);
  expect_refusal(folder.file("disc.png"), "is cut short");
}

TEST(ExtractFiles, PicturesThatAreCutShortAreRefused) {
  const Folder folder;
  for (const std::string name : {"disc.jpg", "disc.tif", "disc.png"}) {
    cv::imwrite(folder.file(name), painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3));
    const auto size = std::filesystem::file_size(folder.file(name));
    for (const auto kept : {size - 2, size * 4 / 5, size / 2, std::uintmax_t{12}}) {
      std::filesystem::resize_file(folder.file(name), kept);
      expect_refusal(folder.file(name), "cut short");
    }
  }
}

TEST(ExtractFiles, SmallPictureInsideDoesNotEndAJpeg) {
  const Folder folder;
  const cv::Mat picture = painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3);
  std::vector<unsigned char> whole;
  std::vector<unsigned char> small;
  cv::imencode(".jpg", picture, whole);
  cv::Mat tenth;
  cv::resize(picture, tenth, {}, 0.1, 0.1);
  cv::imencode(".jpg", tenth, small);
  const std::size_t length = small.size() + 2;
  std::vector<unsigned char> camera(whole.begin(), whole.begin() + 2);
  camera.insert(camera.end(), {0xFF, 0xE1, static_cast<unsigned char>(length / 256),
                               static_cast<unsigned char>(length % 256)});
  camera.insert(camera.end(), small.begin(), small.end());
  camera.insert(camera.end(), whole.begin() + 2, whole.end());
  const auto write = [&](std::size_t kept) {
    std::ofstream(folder.file("camera.jpg"), std::ios::binary)
        .write(reinterpret_cast<const char*>(camera.data()), static_cast<std::streamsize>(kept));
  };
  write(camera.size());
  EXPECT_NO_THROW(extract(folder.file("camera.jpg")));
  write(camera.size() - whole.size() / 2);
  expect_refusal(folder.file("camera.jpg"), "cut short");
}

// The standard lets any number of bytes 0xFF stand before a marker.
TEST(ExtractFiles, FillingBeforeTheMarkersOfAJpegIsPassedOver) {
  const Folder folder;
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3), bytes);
  const std::size_t second = 4 + 256U * bytes[4] + bytes[5];  // marker, behind the first segment
  ASSERT_EQ(bytes[second], 0xFF);
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(second), 3, 0xFF);
  std::ofstream(folder.file("filled.jpg"), std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  EXPECT_NO_THROW(extract(folder.file("filled.jpg")));
}

TEST(ExtractFiles, HugeClaimIsRefusedBeforeDecoding) {
  const Folder folder;
  cv::imwrite(folder.file("disc.png"), with_alpha(disc({128, 120})));
  std::fstream file(folder.file("disc.png"), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(16);
  file.write("\x00\x01\x00\x00\x00\x01\x00\x00", 8);  // 65536 x 65536
  file.close();
  expect_refusal(folder.file("disc.png"), "65536 x 65536");
  ExtractOptions options;
  options.max_pixels = 1000;
  cv::imwrite(folder.file("disc.tif"), with_alpha(disc({128, 120})));
  expect_refusal(folder.file("disc.tif"), "128 x 120", options);
  cv::imwrite(folder.file("disc.jpg"), painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3));
  expect_refusal(folder.file("disc.jpg"), "128 x 120", options);
}

TEST(ExtractFiles, AJpegIsTurnedUprightAsItsExifSays) {
  const Folder folder;
  const std::string path = folder.file("disc.jpg");
  cv::imwrite(path, painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3));
  std::string bytes = read_bytes(path);
  // One entry: tag 0x112, a number of 16 bits, 6: a quarter turn to the right.
  const std::string exif(
      "\xFF\xE1\0\x22"
      "Exif\0\0"
      "II*\0\x8\0\0\0"
      "\1\0"
      "\x12\1\3\0\1\0\0\0\6\0\0\0"
      "\0\0\0\0",
      36);
  bytes.insert(20, exif);  // behind the JFIF segment
  std::ofstream(path, std::ios::binary) << bytes;
  const Extraction found = extract(path);
  ASSERT_EQ(found.pieces.size(), 1U);
  glm::dvec2 middle(0.0);
  for (const glm::dvec2& p : found.pieces[0].points)
    middle += p / static_cast<double>(found.pieces[0].points.size());
  EXPECT_NEAR(middle.x, 119.0 - kCentre.y, 0.5);
  EXPECT_NEAR(middle.y, kCentre.x, 0.5);
}

std::uint32_t png_checksum(const std::string& bytes) {
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? 0xEDB88320 : 0);
  }
  return ~sum;
}

std::string of_four_bytes(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(number >> shift & 0xFFU);
  return bytes;
}

/// Where the centre of a stored picture of 128 x 120 pixels is seen, by the orientation 1 to 8.
std::array<glm::dvec2, 8> seen_by_orientation() {
  const glm::dvec2 c = kCentre;
  return {{c,
           {127 - c.x, c.y},
           {127 - c.x, 119 - c.y},
           {c.x, 119 - c.y},
           {c.y, c.x},
           {119 - c.y, c.x},
           {119 - c.y, 127 - c.x},
           {c.y, 127 - c.x}}};
}

/// Of the only piece's points.
glm::dvec2 middle_of(const Extraction& found) {
  EXPECT_EQ(found.pieces.size(), 1U);
  glm::dvec2 middle(0.0);
  for (const glm::dvec2& p : found.pieces.at(0).points)
    middle += p / static_cast<double>(found.pieces[0].points.size());
  return middle;
}

TEST(ExtractFiles, APngIsTurnedUprightAsItsExifSays) {
  const Folder folder;
  const std::string path = folder.file("disc.png");
  cv::imwrite(path, with_alpha(disc({128, 120})));
  const std::string plain = read_bytes(path);
  const auto middle_with = [&](char orientation, std::size_t place) {
    std::string exif(
        "eXIf"
        "MM\0*\0\0\0\x8"
        "\0\1"
        "\x1\x12\0\3\0\0\0\1\0\6\0\0"
        "\0\0\0\0",
        30);
    exif[23] = orientation;
    std::string bytes = plain;
    bytes.insert(place, of_four_bytes(26) + exif + of_four_bytes(png_checksum(exif)));
    std::ofstream(path, std::ios::binary) << bytes;
    return middle_of(extract(path));
  };
  const std::size_t behind_header = 33;
  const std::size_t at_the_end = plain.size() - 12;
  const std::array<glm::dvec2, 8> seen = seen_by_orientation();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    for (const std::size_t place : {behind_header, at_the_end}) {
      const glm::dvec2 middle = middle_with(static_cast<char>(k + 1), place);
      EXPECT_LT(glm::distance(middle, seen[k]), 0.5) << k + 1;
    }
  }
}

TEST(ExtractFiles, FurtherPagesOfATiffAreTold) {
  const Folder folder;
  const cv::Mat page = painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3);
  cv::imwritemulti(folder.file("pages.tif"), std::vector<cv::Mat>{page, page, page});
  const Extraction found = extract(folder.file("pages.tif"));
  EXPECT_EQ(found.pieces.size(), 1U);
  EXPECT_EQ(found.notes, std::vector<std::string>{"holds 3 pages; the first is read"});
}

/// A whole number, lowest byte first.
std::string number_of(std::size_t value, std::size_t bytes) {
  std::string result;
  for (std::size_t i = 0; i < bytes; ++i) result += static_cast<char>(value >> (8 * i));
  return result;
}

/// A TIFF of red, green, blue and alpha in tiles, as which OpenCV writes none.
std::string tiled_tiff(const cv::Mat& bgra, int orientation) {
  constexpr int kSide = 64;
  constexpr std::size_t kStart = 8;
  std::string pixels;
  std::vector<std::size_t> places;
  for (int top = 0; top < bgra.rows; top += kSide) {
    for (int left = 0; left < bgra.cols; left += kSide) {
      places.push_back(kStart + pixels.size());
      for (int k = 0; k < kSide * kSide; ++k) {
        const cv::Point at(left + k % kSide, top + k / kSide);
        const bool inside = at.x < bgra.cols && at.y < bgra.rows;
        const cv::Vec4b pixel = inside ? bgra.at<cv::Vec4b>(at) : cv::Vec4b(0, 0, 0, 0);
        for (const int channel : {2, 1, 0, 3}) pixels += static_cast<char>(pixel[channel]);
      }
    }
  }
  struct Entry {
    std::size_t tag;
    std::size_t bytes;  // of a value
    std::vector<std::size_t> values;
  };
  const std::vector<std::size_t> sizes(places.size(), std::size_t{4} * kSide * kSide);
  const std::vector<Entry> entries{{256, 2, {static_cast<std::size_t>(bgra.cols)}},
                                   {257, 2, {static_cast<std::size_t>(bgra.rows)}},
                                   {258, 2, {8, 8, 8, 8}},
                                   {259, 2, {1}},
                                   {262, 2, {2}},
                                   {274, 2, {static_cast<std::size_t>(orientation)}},
                                   {277, 2, {4}},
                                   {284, 2, {1}},
                                   {322, 2, {kSide}},
                                   {323, 2, {kSide}},
                                   {324, 4, places},
                                   {325, 4, sizes},
                                   {338, 2, {2}}};
  const std::size_t directory = kStart + pixels.size();
  std::string listed = number_of(entries.size(), 2);
  std::string behind;
  for (const Entry& entry : entries) {
    std::string values;
    for (const std::size_t value : entry.values) values += number_of(value, entry.bytes);
    listed += number_of(entry.tag, 2) + number_of(entry.bytes == 2 ? 3 : 4, 2);
    listed += number_of(entry.values.size(), 4);
    const std::size_t there = directory + 2 + 12 * entries.size() + 4 + behind.size();
    if (values.size() > 4) behind += values;
    values.resize(4, '\0');
    listed += entry.values.size() * entry.bytes > 4 ? number_of(there, 4) : values;
  }
  return std::string("II*\0", 4) + number_of(directory, 4) + pixels + listed + number_of(0, 4) + behind;
}

TEST(ExtractFiles, ATiffInTilesIsTurnedUprightAsAWhole) {
  const Folder folder;
  const std::string path = folder.file("tiles.tif");
  cv::Mat stored;
  with_alpha(disc({128, 120})).copyTo(stored);
  const std::array<glm::dvec2, 8> seen = seen_by_orientation();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    std::ofstream(path, std::ios::binary) << tiled_tiff(stored, static_cast<int>(k + 1));
    EXPECT_LT(glm::distance(middle_of(extract(path)), seen[k]), 0.5) << k + 1;
  }
}

TEST(ExtractFiles, TiffsThatWouldLoseSomethingAreRefusedInOurOwnWords) {
  const Folder folder;
  const std::string path = folder.file("disc.tif");
  const auto write = [&](int tag, char value) {
    cv::imwrite(path, cv::Mat(120, 128, CV_8U, cv::Scalar(9)));
    set_tiff_tag(path, tag, value);
  };
  ::testing::internal::CaptureStderr();
  write(258, 4);
  expect_refusal(path, "has 4 bits a channel");
  write(277, 2);
  expect_refusal(path, "is a grey TIFF with transparency");
  write(262, 77);  // how numbers are colours: no such way
  expect_refusal(path, "cannot be decoded");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace rejoin::outline
