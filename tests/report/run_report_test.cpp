#include "report/run_report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <tuple>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "planted_report.hpp"

namespace rejoin::report {
namespace {

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("rejoin-" + std::to_string(getpid()) + "-" + name);
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::string written(const RunReport& report, const RunReportOptions& options = {}) {
  const std::filesystem::path path = scratch("page.html");
  EXPECT_TRUE(write_run_report(report, path, Context(), options));
  std::string text = text_of(path);
  std::filesystem::remove(path);
  return text;
}

nlohmann::json data_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"report\">";
  const std::size_t begin = html.find(open) + open.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The page of the planted report, written once.
const std::string& hostile_page() {
  static const std::string kPage = written(planted_report());
  return kPage;
}

TEST(RunReport, HostileTextsNeverBecomeMarkup) {
  const std::string& html = hostile_page();
  EXPECT_EQ(count_of(html, "<script"), 2U);  // the data and the viewer
  EXPECT_EQ(count_of(html, "</script"), 2U);
  EXPECT_EQ(count_of(html, "<img"), 0U);
  EXPECT_EQ(count_of(html, "<!--"), 0U);
  EXPECT_EQ(count_of(html, "</title>"), 1U);
  EXPECT_EQ(data_of(html)["fragments"][0]["name"],
            "</script><script>window.hacked = 2</script><img src=x onerror=window.hacked=3>.ply");
}

TEST(RunReport, NamesNothingOutsideTheFile) {
  const std::string& html = hostile_page();
  EXPECT_EQ(count_of(html, " src=\"http"), 0U);
  EXPECT_EQ(count_of(html, "@import"), 0U);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(html.find("script-src 'sha256-"), std::string::npos);
}

TEST(RunReport, ListsPairsBestFirstWithPicturesOfThoseThatHaveAPose) {
  const nlohmann::json data = data_of(hostile_page());
  ASSERT_EQ(data["pairs"].size(), 3U);
  EXPECT_EQ(data["pairs"][0]["score"], 0.97);
  EXPECT_EQ(data["pairs"][0]["pictures"].size(), 7U);
  EXPECT_EQ(data["pairs"][1]["pictures"].size(), 0U);
  EXPECT_TRUE(data["pairs"][0]["figures"][1][1].is_null()) << "infinity is not measured";
  EXPECT_TRUE(data["fragments"][3]["pose"].is_null());
}

TEST(RunReport, KeepsItsBudgets) {
  RunReportOptions options;
  options.geometry_bytes = 40000;
  options.picture_bytes = 200000;
  const std::string html = written(long_row(4, 60), options);
  const nlohmann::json data = data_of(html);
  std::size_t geometry = 0;
  for (const auto& fragment : data["fragments"]) {
    geometry += fragment["mesh"]["vertex"].get<std::string>().size() +
                fragment["mesh"]["index"].get<std::string>().size();
    EXPECT_GT(fragment["mesh"]["faces"], 100);
  }
  EXPECT_LE(geometry, 40000U + 6 * 8);  // base64 fills up to four letters
  std::size_t pictures = 0;
  for (const auto& pair : data["pairs"]) {
    for (const auto& picture : pair["pictures"]) pictures += picture["jpeg"].get<std::string>().size();
  }
  EXPECT_LE(pictures, 200000U);
  EXPECT_GT(pictures, 50000U);
}

TEST(RunReport, ListsTheBestPairOfEveryFragment) {
  RunReport report = long_row(4, 20);
  report.pairs = {{0, 1, 0.9, "join", true, {}, {}, {}},
                  {0, 2, 0.4, "unsure", false, {}, {}, {}},
                  {1, 2, 0.3, "no join", false, {}, {}, {}},
                  {2, 3, 0.2, "no join", false, {}, {}, {}}};
  RunReportOptions options;
  options.listed_pairs = 0;
  const nlohmann::json data = data_of(written(report, options));
  ASSERT_EQ(data["pairs"].size(), 3U);  // all but 1 + 2
  EXPECT_EQ(data["pairs"][1]["score"], 0.4);
  EXPECT_EQ(data["pairs"][2]["score"], 0.2);
}

TEST(RunReport, ShowsPicturesOfPairsThatTheUserHasToJudge) {
  RunReport report = long_row(6, 20);
  ReportPair doubtful = report.pairs[0];
  std::tie(doubtful.a, doubtful.b, doubtful.score, doubtful.verdict, doubtful.used) =
      std::tuple(0U, 5U, 0.5, "unsure", false);
  report.pairs.push_back(doubtful);
  RunReportOptions options;
  options.pictured_joins = 3;
  const nlohmann::json data = data_of(written(report, options));
  std::vector<bool> shown;
  for (const auto& pair : data["pairs"]) shown.push_back(!pair["pictures"].empty());
  EXPECT_EQ(shown, std::vector<bool>({true, true, false, false, false, true}));
}

TEST(RunReport, IsTheSameForAnyNumberOfThreads) {
  const ThreadLimit limit(1);
  EXPECT_TRUE(written(planted_report()) == hostile_page());
}

TEST(RunReport, WithoutFragmentsIsStillAPage) {
  RunReport report;
  report.title = "empty";
  EXPECT_EQ(data_of(written(report))["fragments"].size(), 0U);
}

TEST(RunReport, WritesNothingWhenCancelled) {
  Context context;
  context.cancel();
  const std::filesystem::path path = scratch("cancelled.html");
  EXPECT_FALSE(write_run_report(planted_report(), path, context));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(RunReport, RefusesPairsOfFragmentsThatAreNotThere) {
  RunReport report;
  report.title = "run";
  report.fragments.resize(2);
  report.pairs.push_back({0, 7, 0.5, "join", false, std::nullopt, {}, {}});
  EXPECT_THROW(write_run_report(report, scratch("never.html"), Context()), InputError);
}

}  // namespace
}  // namespace rejoin::report
