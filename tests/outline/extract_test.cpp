#include "outline/extract.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.hpp"
#include "outline/polygon.hpp"

namespace rejoin::outline {
namespace {

/// A folder for one test, taken away after it.
class Folder {
 public:
  Folder() {
    path_ =
        std::filesystem::temp_directory_path() /
        ("rejoin-extract-" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
         "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

constexpr double kRadius = 40.0;
const glm::dvec2 kCentre(63.3, 58.7);

/// A disc with soft edges: how much of each pixel it covers, about.
cv::Mat disc(const cv::Size& size) {
  cv::Mat cover(size, CV_32F);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double distance = kRadius - glm::distance(glm::dvec2(x, y), kCentre);
      cover.at<float>(y, x) = static_cast<float>(std::clamp(distance + 0.5, 0.0, 1.0));
    }
  }
  return cover;
}

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

/// The disc in colour on a plain background.
cv::Mat painted(const cv::Mat& cover, const cv::Vec3d& piece, const cv::Vec3d& background, double scale,
                int type) {
  cv::Mat image(cover.size(), type);
  for (int y = 0; y < cover.rows; ++y) {
    for (int x = 0; x < cover.cols; ++x) {
      const double share = cover.at<float>(y, x);
      const cv::Vec3d colour = (piece * share + background * (1.0 - share)) * scale;
      if (type == CV_8UC3) image.at<cv::Vec3b>(y, x) = cv::Vec3b(colour);
      if (type == CV_16UC3) image.at<cv::Vec3w>(y, x) = cv::Vec3w(colour);
    }
  }
  return image;
}

cv::Mat with_alpha(const cv::Mat& cover) {
  cv::Mat alpha;
  cover.convertTo(alpha, CV_8U, 255.0);
  const std::vector<cv::Mat> channels{cv::Mat(cover.size(), CV_8U, cv::Scalar(51)),
                                      cv::Mat(cover.size(), CV_8U, cv::Scalar(102)),
                                      cv::Mat(cover.size(), CV_8U, cv::Scalar(204)), alpha};
  cv::Mat image;
  cv::merge(channels, image);
  return image;
}

void expect_disc(const Outline& outline, double tolerance) {
  for (const glm::dvec2& p : outline.points) EXPECT_NEAR(glm::distance(p, kCentre), kRadius, tolerance);
  EXPECT_NEAR(signed_area(outline.points), M_PI * kRadius * kRadius, 2.0 * M_PI * kRadius * tolerance);
}

TEST(Extract, ContourOfASoftDiscIsExactToATenthOfAPixel) {
  const Folder folder;
  cv::imwrite(folder.file("disc.png"), with_alpha(disc({128, 120})));
  const Extraction found = extract(folder.file("disc.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 0.1);
  EXPECT_FALSE(find_crossing(found.pieces[0].points));
  ASSERT_EQ(found.pieces[0].colour.size(), found.pieces[0].points.size());
  for (const glm::dvec3& c : found.pieces[0].colour)
    EXPECT_LT(glm::distance(c, glm::dvec3(0.8, 0.4, 0.2)), 1e-3);
}

// 8 and 16 bits, PNG and TIFF, light on dark and dark on light: the threshold lies half-way between piece and background.
TEST(Extract, PlainBackgroundNeedsNoAlpha) {
  const Folder folder;
  const cv::Mat cover = disc({128, 120});
  const cv::Vec3d stone(0.5, 0.6, 0.7);
  cv::imwrite(folder.file("dark.png"), painted(cover, stone, {0.05, 0.05, 0.05}, 255, CV_8UC3));
  cv::imwrite(folder.file("white.tif"), painted(cover, stone, {1, 1, 1}, 65535, CV_16UC3));
  cv::imwrite(folder.file("blue.png"), painted(cover, stone, {0.9, 0.2, 0.1}, 65535, CV_16UC3));
  for (const char* name : {"dark.png", "white.tif", "blue.png"}) {
    const Extraction found = extract(folder.file(name));
    ASSERT_EQ(found.pieces.size(), 1U) << name;
    expect_disc(found.pieces[0],
                0.25);  // Otsu's threshold lies between the colours, not just at their middle
  }
}

/// The picture under light that falls off over it, and differently in each colour.
cv::Mat in_uneven_light(cv::Mat image) {
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double fall = 0.5 * x / image.cols + 0.2 * y / image.rows;
      auto& pixel = image.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<uchar>(pixel[c] * (1.0 - fall * (0.8 + 0.1 * c)));
    }
  }
  return image;
}

// The disc is 30 % darker than the background, which is 60 % darker at one corner than at the other.
TEST(Extract, UnevenLightIsEvenedOutWithANote) {
  const Folder folder;
  cv::imwrite(folder.file("lamp.png"),
              in_uneven_light(painted(disc({150, 130}), {0.65, 0.6, 0.55}, {0.9, 0.9, 0.9}, 255, CV_8UC3)));
  const Extraction found = extract(folder.file("lamp.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 0.3);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("evened out"), std::string::npos) << found.notes[0];
}

TEST(Extract, BackgroundThatChangesItsHueAloneIsNotCalledDarker) {
  const Folder folder;
  cv::Mat image = painted(disc({150, 130}), {0.1, 0.1, 0.1}, {0.6, 0.6, 0.6}, 255, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      auto& pixel = image.at<cv::Vec3b>(y, x);
      const int shift = 60 * x / image.cols - 30;
      pixel = {cv::saturate_cast<uchar>(pixel[0] - shift), pixel[1],
               cv::saturate_cast<uchar>(pixel[2] + shift)};
    }
  }
  cv::imwrite(folder.file("hue.png"), image);
  const Extraction found = extract(folder.file("hue.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_EQ(found.notes[0], "the background's colour changes over the picture, which is evened out");
}

// Stripes of ink run out of the disc every 12 pixels, nearer to the background than to the paper, or farther.  They may be bitten
// by some pixels, not cut off.
TEST(Extract, PrintAtTheBorderIsPartOfThePiece) {
  struct Page {
    cv::Vec3d background;
    cv::Vec3d ink;
    int stripe;  // pixels
  };
  const Folder folder;
  const cv::Mat cover = disc({128, 120});
  for (const Page& page :
       {Page{{0.12, 0.12, 0.12}, {0.0, 0.0, 0.0}, 4}, Page{{0.8, 0.8, 0.8}, {0.1, 0.1, 0.1}, 2}}) {
    cv::Mat image = painted(cover, {0.95, 0.95, 0.92}, page.background, 255, CV_8UC3);
    const cv::Mat printed = painted(cover, page.ink, page.background, 255, CV_8UC3);
    for (int y = 0; y < image.rows; ++y)
      if (y % 12 < page.stripe && std::abs(y - kCentre.y) < 25.0) printed.row(y).copyTo(image.row(y));
    cv::imwrite(folder.file("page.png"), image);
    const Extraction found = extract(folder.file("page.png"));
    ASSERT_EQ(found.pieces.size(), 1U);
    expect_disc(found.pieces[0], 3.5);
    EXPECT_TRUE(found.notes.empty()) << found.notes[0];
  }
}

// The shadow, 30 % at its darkest, reaches 14 pixels beyond the disc on one side.
TEST(Extract, ShadowIsNoPartOfThePiece) {
  const Folder folder;
  const cv::Mat cover = disc({150, 130});
  cv::Mat shadow;
  cv::warpAffine(cover, shadow, cv::Matx23d(1, 0, 6, 0, 1, 4), cover.size());
  cv::GaussianBlur(shadow, shadow, cv::Size(), 5.0);
  cv::Mat image = painted(cover, {0.5, 0.4, 0.3}, {0.9, 0.9, 0.9}, 255, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double light = 1.0 - 0.3 * shadow.at<float>(y, x) * (1.0 - cover.at<float>(y, x));
      image.at<cv::Vec3b>(y, x) *= light;
    }
  }
  cv::imwrite(folder.file("shadow.png"), image);
  const Extraction found = extract(folder.file("shadow.png"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.0);
}

TEST(Extract, BedOfAScannerInADarkFrameIsToldAsARectangle) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(20, 20, 20));
  cv::rectangle(image, {8, 8}, {291, 191}, cv::Scalar(230, 230, 230), cv::FILLED);
  cv::circle(image, {140, 90}, 50, cv::Scalar(60, 90, 140), cv::FILLED);
  cv::imwrite(folder.file("bed.png"), image);
  const Extraction found = extract(folder.file("bed.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("scanner's bed"), std::string::npos) << found.notes[0];
}

TEST(Extract, OutlineOfAGlowIsToldAsBlurred) {
  const Folder folder;
  cv::Mat image(200, 200, CV_8UC3, cv::Scalar(60, 60, 60));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double glow = std::max(0.0, 1.0 - glm::distance(glm::dvec2(x, y), glm::dvec2(100, 100)) / 90.0);
      image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<uchar>(60 + 180 * glow));
    }
  }
  cv::imwrite(folder.file("glow.png"), image);
  const Extraction found = extract(folder.file("glow.png"));
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_NE(found.notes[0].find("blurred"), std::string::npos) << found.notes[0];
}

TEST(Extract, JpegIsReadToAPixel) {
  const Folder folder;
  cv::imwrite(folder.file("disc.jpg"),
              painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0.02, 0.02, 0.02}, 255, CV_8UC3));
  const Extraction found = extract(folder.file("disc.jpg"));
  ASSERT_EQ(found.pieces.size(), 1U);
  expect_disc(found.pieces[0], 1.0);
}

TEST(Extract, HolesAreKeptAndDustIsNot) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {20, 20}, {119, 179}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::rectangle(image, {50, 60}, {89, 99}, cv::Scalar(250, 250, 250), cv::FILLED);
  cv::rectangle(image, {180, 40}, {239, 99}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::circle(image, {270, 150}, 3, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("two.png"), image);
  const Extraction found = extract(folder.file("two.png"));
  ASSERT_EQ(found.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(found.pieces[0].points), 100.0 * 160.0, 20.0);
  ASSERT_EQ(found.pieces[0].holes.size(), 1U);
  EXPECT_NEAR(signed_area(found.pieces[0].holes[0]), -40.0 * 40.0, 10.0);
  EXPECT_NEAR(signed_area(found.pieces[1].points), 60.0 * 60.0, 10.0);
  EXPECT_TRUE(found.pieces[1].holes.empty());
}

TEST(Extract, SmallPieceIsToldAndTakenIfAskedFor) {
  const Folder folder;
  cv::Mat image(200, 300, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {20, 20}, {219, 179}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::rectangle(image, {250, 40}, {273, 63}, cv::Scalar(40, 60, 90),
                cv::FILLED);  // 1.8 % of the other's area
  cv::circle(image, {270, 150}, 3, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("two.png"), image);
  const Extraction usual = extract(folder.file("two.png"));
  EXPECT_EQ(usual.pieces.size(), 1U);
  ASSERT_EQ(usual.notes.size(), 1U);
  EXPECT_NE(
      usual.notes[0].find("1 piece with less than 2 % of the largest's area is taken for dust, the largest "
                          "24 x 24 pixels at x 250, y 40"),
      std::string::npos)
      << usual.notes[0];
  ExtractOptions options;
  options.dust = 1.0;
  const Extraction asked = extract(folder.file("two.png"), options);
  ASSERT_EQ(asked.pieces.size(), 2U);
  EXPECT_NEAR(signed_area(asked.pieces[1].points), 24.0 * 24.0, 5.0);
  EXPECT_TRUE(asked.notes.empty());
}

TEST(Extract, PieceAtTheBorderIsTakenWithANoteOrLeftOut) {
  const Folder folder;
  cv::Mat image(100, 200, CV_8UC3, cv::Scalar(250, 250, 250));
  cv::rectangle(image, {0, 20}, {59, 79}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("one.png"), image);
  const Extraction one = extract(folder.file("one.png"));
  ASSERT_EQ(one.pieces.size(), 1U);
  EXPECT_EQ(one.notes.size(), 1U);
  EXPECT_NEAR(signed_area(one.pieces[0].points), 60.0 * 60.0, 5.0);
  cv::rectangle(image, {120, 30}, {159, 69}, cv::Scalar(40, 60, 90), cv::FILLED);
  cv::imwrite(folder.file("both.png"), image);
  const Extraction both = extract(folder.file("both.png"));
  ASSERT_EQ(both.pieces.size(), 1U);
  EXPECT_EQ(both.notes.size(), 1U);
  EXPECT_NEAR(signed_area(both.pieces[0].points), 40.0 * 40.0, 5.0);
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

TEST(Extract, PicturesWithoutAPieceSaySo) {
  const Folder folder;
  cv::Mat plain(60, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  cv::imwrite(folder.file("plain.png"), plain);
  expect_refusal(folder.file("plain.png"), "no piece stands out");
  cv::imwrite(folder.file("glass.png"), cv::Mat(60, 80, CV_8UC4, cv::Scalar(9, 9, 9, 0)));
  expect_refusal(folder.file("glass.png"), "transparent");
}

TEST(Extract, BrokenFilesAreNamed) {
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

TEST(Extract, PicturesThatAreCutShortAreRefused) {
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

TEST(Extract, SmallPictureInsideDoesNotEndAJpeg) {
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

TEST(Extract, HugeClaimIsRefusedBeforeDecoding) {
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

TEST(Extract, AJpegIsTurnedUprightAsItsExifSays) {
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

TEST(Extract, APngIsTurnedUprightAsItsExifSays) {
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
    const Extraction found = extract(path);
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& p : found.pieces.at(0).points)
      middle += p / static_cast<double>(found.pieces[0].points.size());
    return middle;
  };
  const std::size_t behind_header = 33;
  const std::size_t at_the_end = plain.size() - 12;
  const glm::dvec2 c = kCentre;
  // Where the stored picture's place c is seen, by the orientation 1 to 8.
  const std::array<glm::dvec2, 8> seen{{c,
                                        {127 - c.x, c.y},
                                        {127 - c.x, 119 - c.y},
                                        {c.x, 119 - c.y},
                                        {c.y, c.x},
                                        {119 - c.y, c.x},
                                        {119 - c.y, 127 - c.x},
                                        {c.y, 127 - c.x}}};
  for (std::size_t k = 0; k < seen.size(); ++k) {
    for (const std::size_t place : {behind_header, at_the_end}) {
      const glm::dvec2 middle = middle_with(static_cast<char>(k + 1), place);
      EXPECT_LT(glm::distance(middle, seen[k]), 0.5) << k + 1;
    }
  }
}

TEST(Extract, FurtherPagesOfATiffAreTold) {
  const Folder folder;
  const cv::Mat page = painted(disc({128, 120}), {0.5, 0.6, 0.7}, {0, 0, 0}, 255, CV_8UC3);
  cv::imwritemulti(folder.file("pages.tif"), std::vector<cv::Mat>{page, page, page});
  const Extraction found = extract(folder.file("pages.tif"));
  EXPECT_EQ(found.pieces.size(), 1U);
  EXPECT_EQ(found.notes, std::vector<std::string>{"holds 3 pages; the first is read"});
}

TEST(Extract, TiffsThatWouldLoseSomethingAreRefusedInOurOwnWords) {
  const Folder folder;
  const std::string path = folder.file("disc.tif");
  const auto write = [&](int tag, char value) {
    cv::imwrite(path, cv::Mat(120, 128, CV_8U, cv::Scalar(9)));
    set_tiff_tag(path, tag, value);
  };
  testing::internal::CaptureStderr();
  write(258, 4);
  expect_refusal(path, "has 4 bits a channel");
  write(277, 2);
  expect_refusal(path, "is a grey TIFF with transparency");
  write(262, 77);  // how numbers are colours: no such way
  expect_refusal(path, "cannot be decoded");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace rejoin::outline
