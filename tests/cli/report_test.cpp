#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planted_files.hpp"
#include "store/results.hpp"
#include "store/run.hpp"

namespace rejoin::cli::testing {
namespace {

using nlohmann::json;

/// The database of a run over the planted pair and a scan that is gone.
struct PlantedRun {
  PlantedRun() {
    std::filesystem::create_directories(folder);
    const std::string gone = files.folder / "gone.ply";
    store::Run run = store::Run::write(folder);
    run.begin({"0.1.0", R"({"search": "sweep", "resolution": 128, "chains": 8, "promising_only": true})", 7},
              {fragment("a.ply", files.a), fragment("b.ply", files.b), fragment("gone.ply", gone)});
    store::Pair pair;
    const auto list = run.fragments();
    pair.a = list[0].id;
    pair.b = list[1].id;
    pair.stage = store::Stage::Match;
    pair.score = 0.75;
    pair.verdict = "join";
    pair.result = "{}";
    store::Candidate candidate;
    candidate.score = 0.75;
    candidate.pose = files.pair.truth;
    candidate.gap_median = 0.125;
    run.save(pair, {candidate});
  }

  static store::Fragment fragment(const std::string& name, const std::string& path) {
    store::Fragment made;
    made.name = name;
    made.path = path;
    made.hash = std::to_string(std::hash<std::string>()(name));
    return made;
  }

  void assemble(const std::string& text) const { write_file(folder + "/assembly.json", text); }

  const PlantedFiles files;
  const std::string folder = files.folder / "run";
  const std::string page = folder + "/report.html";
};

json data_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"report\">";
  const std::size_t begin = html.find(open) + open.size();
  return json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST(Report, ShowsWhatTheAssemblyPlacedAndWhyNotTheRest) {
  const PlantedRun run;
  const json one = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const json assembly = {{"schema", "rejoin.assembly/1"},
                         {"fragments",
                          {{"a.ply", {{"pose", one}, {"group", 0}, {"confidence", 0.5}}},
                           {"b.ply", {{"pose", one}, {"group", 0}, {"confidence", 0.25}}},
                           {"gone.ply", {{"pose", nullptr}, {"group", -1}}}}},
                         {"joins", {{{"a", "b.ply"}, {"b", "a.ply"}, {"score", 0.75}}}},
                         {"unplaced", {"gone.ply"}}};
  run.assemble(assembly.dump());
  const Finished finished = testing::run({"report", run.folder, "--pictures", "1"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_NE(finished.err.find("gone.ply"), std::string::npos) << "a scan that is gone is told";
  const json data = data_of(read_file(run.page));
  ASSERT_EQ(data["fragments"].size(), 3U);
  EXPECT_EQ(data["fragments"][1]["confidence"], 0.25);
  EXPECT_FALSE(data["fragments"][0]["mesh"].is_null());
  EXPECT_TRUE(data["fragments"][2]["mesh"].is_null());
  EXPECT_EQ(data["fragments"][2]["reason"], "none of its 2 pairs is compared yet");
  EXPECT_EQ(data["missing"], 2);
  ASSERT_EQ(data["warnings"].size(), 2U);
  EXPECT_EQ(data["warnings"][0], "2 of 3 pairs are not compared yet; rejoin batch goes on with them");
  ASSERT_EQ(data["pairs"].size(), 1U);
  EXPECT_EQ(data["pairs"][0]["used"], true);
  EXPECT_EQ(data["pairs"][0]["figures"][0], json({"median gap", 0.125}));
  EXPECT_GE(data["pairs"][0]["pictures"].size(), 4U);
}

TEST(Report, ShowsAJoinFoundByContactAsTheAssemblyHasIt) {
  const PlantedRun run;
  const json one = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const json moved = {{1, 0, 0, 0.1}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  json join = {{"a", "a.ply"},   {"b", "b.ply"},         {"score", 0.998},
               {"contact", 2.5}, {"gap_median", 0.0625}, {"found_by", "contact"}};
  json assembly = {{"schema", "rejoin.assembly/1"},
                   {"fragments",
                    {{"a.ply", {{"pose", one}, {"group", 0}, {"confidence", 0.5}}},
                     {"b.ply", {{"pose", moved}, {"group", 0}, {"confidence", 0.25}}},
                     {"gone.ply", {{"pose", nullptr}, {"group", -1}}}}},
                   {"joins", {join}}};
  const auto pair_shown = [&] {
    run.assemble(assembly.dump());
    const Finished finished = testing::run({"report", run.folder, "--pictures", "1"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return data_of(read_file(run.page))["pairs"].at(0);
  };
  const json shown = pair_shown();
  EXPECT_EQ(shown["score"], 0.998);
  EXPECT_EQ(shown["verdict"], "found by contact");
  EXPECT_EQ(shown["figures"], json::parse(R"([["median gap", 0.0625], ["contact area", 2.5]])"));
  EXPECT_NE(shown["note"].get<std::string>().find("The best pose of that search: join, score 0.75"),
            std::string::npos)
      << shown["note"];
  EXPECT_GE(shown["pictures"].size(), 4U);
  // Where the search's own best pose is used, it says all that is known of it.
  assembly["joins"][0]["found_by"] = "match";
  assembly["joins"][0]["score"] = 0.75;
  const json own = pair_shown();
  EXPECT_EQ(own["note"], "");
  EXPECT_EQ(own["verdict"], "join");
  EXPECT_EQ(own["figures"][0], json({"median gap", 0.125}));
  EXPECT_EQ(own["pictures"], shown["pictures"]) << "drawn at the assembly's pose either way";
}

TEST(Report, CountsAPairThatFailedAsFailedAndGivesItNoScore) {
  const PlantedRun run;
  {
    store::Run database = store::Run::write(run.folder);
    const auto list = database.fragments();
    store::Pair failed;
    failed.a = list[0].id;
    failed.b = list[2].id;
    failed.error = "gone.ply: is no mesh";
    failed.result = "{}";
    database.save(failed, {});
    store::Fragment gone = list[2];
    gone.state = store::FragmentState::Bad;
    gone.error = "scans/gone.ply: is no mesh; give a mesh";
    database.save(gone);
  }
  const Finished finished = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json data = data_of(read_file(run.page));
  EXPECT_EQ(data["compared"], 1);
  EXPECT_EQ(data["failed"], 1);
  EXPECT_EQ(data["missing"], 1);
  EXPECT_EQ(data["pairs"][1]["failed"], true);
  EXPECT_EQ(data["warnings"][1], "scans/gone.ply: is no mesh; give a mesh") << "the path once";
}

TEST(Report, WithoutAnAssemblySaysSo) {
  const PlantedRun run;
  const Finished finished =
      testing::run({"report", run.folder, "--pictures", "0", "--out", run.files.folder / "page.html"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json data = data_of(read_file(run.files.folder / "page.html"));
  EXPECT_TRUE(data["fragments"][0]["pose"].is_null());
  EXPECT_NE(data["fragments"][0]["reason"].get<std::string>().find("rejoin assemble"), std::string::npos);
}

TEST(Report, NamesParametersAsTheOptionsDo) {
  const PlantedRun run;
  ASSERT_EQ(testing::run({"report", run.folder, "--pictures", "0"}).exit_code, 0);
  const json expected = json::parse(R"([["matched by", "rejoin 0.1.0"], ["--seed", "7"], ["search", "sweep"],
                                        ["--resolution", "128"], ["--thorough", "no, but no pair ended early"]])");
  const json parameters = data_of(read_file(run.page))["parameters"];
  EXPECT_EQ(json(parameters.begin() + 1, parameters.end()), expected);
}

TEST(Report, GoesToStdoutAloneAndToDevices) {
  const PlantedRun run;
  const Finished page = testing::run({"report", run.folder, "--pictures", "0", "--out", "-"});
  ASSERT_EQ(page.exit_code, 0) << page.err;
  EXPECT_EQ(page.out.find("<!doctype html>"), 0U);
  EXPECT_NE(page.out.rfind("</html>\n"), std::string::npos);
  EXPECT_EQ(page.out.find("wrote "), std::string::npos);
  const Finished nothing = testing::run({"report", run.folder, "--pictures", "0", "--out", "/dev/null"});
  EXPECT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_EQ(nothing.out, "wrote /dev/null\n");
}

TEST(Report, TellsThatTheAssemblyIsOlderThanThePairsAndTakesBackItsReasons) {
  const PlantedRun run;
  const json left_out = {
      {"pose", nullptr}, {"group", -1}, {"reason", "3 of its 3 pairs are not compared yet"}};
  json assembly = {{"schema", "rejoin.assembly/1"},
                   {"fragments", {{"a.ply", left_out}, {"b.ply", left_out}, {"gone.ply", left_out}}},
                   {"pairs_missing", 3}};
  run.assemble(assembly.dump());
  const Finished stale = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(stale.exit_code, 0) << stale.err;
  EXPECT_NE(stale.err.find("the assembly is older than 1 of the pairs"), std::string::npos) << stale.err;
  const std::string reason = data_of(read_file(run.page))["fragments"][0]["reason"];
  EXPECT_EQ(reason.find("the assembly is older than 1 of the pairs"), 0U) << reason;
  assembly["pairs_missing"] = 2;  // as now
  run.assemble(assembly.dump());
  const Finished fresh = testing::run({"report", run.folder, "--pictures", "0"});
  EXPECT_EQ(fresh.err.find("older"), std::string::npos) << fresh.err;
  EXPECT_EQ(data_of(read_file(run.page))["fragments"][0]["reason"], left_out["reason"]);
  assembly["fragments"]["a.ply"]["scan"] = "the content of an older scan";
  run.assemble(assembly.dump());
  const Finished replaced = testing::run({"report", run.folder, "--pictures", "0"});
  EXPECT_NE(replaced.err.find("made with another scan of a.ply"), std::string::npos) << replaced.err;
}

TEST(Report, TellsThatPairsWereMatchedAnewSinceTheAssembly) {
  const PlantedRun run;
  const json left_out = {{"pose", nullptr}, {"group", -1}, {"reason", "nothing fits it"}};
  run.assemble(json{{"schema", "rejoin.assembly/1"},
                    {"fragments", {{"a.ply", left_out}, {"b.ply", left_out}, {"gone.ply", left_out}}},
                    {"results", store::results_hash(store::Run::open(run.folder))}}
                   .dump());
  const Finished fresh = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(fresh.exit_code, 0) << fresh.err;
  EXPECT_EQ(fresh.err.find("matched anew"), std::string::npos) << fresh.err;
  {
    store::Run again = store::Run::write(run.folder);
    store::Pair pair = again.pairs().at(0);
    pair.score = 0.03;
    pair.verdict = "no join";
    again.save(pair, {});
  }
  const Finished stale = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(stale.exit_code, 0) << stale.err;
  EXPECT_NE(stale.err.find("the assembly was made before pairs were matched anew"), std::string::npos)
      << stale.err;
}

TEST(Report, ShowsNoScanAtThePlaceOfTheOneBeforeIt) {
  const PlantedRun run;
  const json one = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const json placed = {{"pose", one}, {"group", 0}, {"confidence", 0.5}};
  json replaced = placed;
  replaced["scan"] = "0123";
  const json assembly = {{"schema", "rejoin.assembly/1"},
                         {"fragments", {{"a.ply", replaced}, {"b.ply", placed}, {"gone.ply", placed}}},
                         {"joins",
                          {{{"a", "a.ply"}, {"b", "b.ply"}, {"score", 0.75}},
                           {{"a", "b.ply"}, {"b", "gone.ply"}, {"score", 0.75}}}}};
  run.assemble(assembly.dump());
  ASSERT_EQ(testing::run({"report", run.folder, "--pictures", "0"}).exit_code, 0);
  const json data = data_of(read_file(run.page));
  EXPECT_TRUE(data["fragments"][0]["pose"].is_null());
  EXPECT_EQ(data["fragments"][0]["reason"], "the assembly has another scan of it (rejoin assemble)");
  EXPECT_FALSE(data["fragments"][1]["pose"].is_null());
  ASSERT_EQ(data["pairs"].size(), 2U);
  EXPECT_EQ(data["pairs"][0]["used"], false) << "a.ply and b.ply";
  EXPECT_EQ(data["pairs"][1]["used"], true);
}

TEST(Report, TellsThatScansCameOrWentSinceTheAssembly) {
  const PlantedRun run;
  const json one = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  const json placed = {{"pose", one}, {"group", 0}};
  json assembly = {{"schema", "rejoin.assembly/1"},
                   {"fragments", {{"a.ply", placed}, {"gone.ply", placed}}},
                   {"joins", {{{"a", "a.ply"}, {"b", "gone.ply"}, {"score", 0.75}}}}};
  run.assemble(assembly.dump());
  const Finished came = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(came.exit_code, 0) << came.err;
  EXPECT_NE(came.err.find("the assembly was made without b.ply"), std::string::npos) << came.err;
  const std::string reason = data_of(read_file(run.page))["fragments"][1]["reason"];
  EXPECT_EQ(reason.find("the assembly was made without b.ply"), 0U) << reason;
  assembly["fragments"]["old.ply"] = placed;
  assembly["joins"].push_back({{"a", "old.ply"}, {"b", "a.ply"}, {"score", 0.75}});
  run.assemble(assembly.dump());
  const Finished went = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(went.exit_code, 0) << went.err;
  EXPECT_NE(went.err.find("the assembly was made with old.ply, which the run no longer has"),
            std::string::npos)
      << went.err;
  EXPECT_FALSE(data_of(read_file(run.page))["fragments"][0]["pose"].is_null());
}

TEST(Report, ShowsWhatTheUserAskedForAndWhatCouldNotBeKept) {
  const PlantedRun run;
  const std::string problem = "a.ply and gone.ply must join, but at none of their poses they fit";
  const std::string doubt = "a.ply and b.ply are put into two objects";
  const json assembly = {{"schema", "rejoin.assembly/1"},
                         {"fragments", json::object()},
                         {"doubts", {doubt}},
                         {"constraints",
                          {{"must_join", json::array({{"a.ply", "gone.ply"}, {"a.ply", "b.ply"}})},
                           {"must_not_join", json::array({{"b.ply", "a.ply"}})},
                           {"poses", {{"b.ply", {{0, -1, 0, 5}, {1, 0, 0, 6}, {0, 0, 1, 7}, {0, 0, 0, 1}}}}},
                           {"problems", {problem}}}}};
  run.assemble(assembly.dump());
  const Finished finished = testing::run({"report", run.folder, "--pictures", "0"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const json data = data_of(read_file(run.page));
  const json& parameters = data["parameters"];
  const auto has = [&](const json& row) {
    return std::find(parameters.begin(), parameters.end(), row) != parameters.end();
  };
  EXPECT_TRUE(has({"must join", "a.ply + gone.ply, a.ply + b.ply"})) << parameters;
  EXPECT_TRUE(has({"pose given", "b.ply"})) << parameters;
  const json& kept = data["constraints"];  // of which the page makes the file for the next assembly
  EXPECT_EQ(kept["must_join"], json::parse("[[0, 2], [0, 1]]"));
  EXPECT_EQ(kept["must_not_join"], json::parse("[[1, 0]]"));
  EXPECT_EQ(kept["poses"], json::parse("[[1, [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]]]"));
  EXPECT_EQ(data["warnings"][0], problem);
  EXPECT_EQ(data["warnings"][1], doubt);
}

TEST(Report, RefusesAnAssemblyThatIsNoneOfThisRun) {
  const PlantedRun run;
  for (const char* text :
       {"{", "[]", R"({"schema": 5})", R"({"schema": "rejoin.assembly/1"})",
        R"({"schema": "rejoin.assembly/1", "fragments": {"a.ply": {"group": "x"}}})",
        R"({"schema": "rejoin.assembly/1", "fragments": {"a.ply": {"group": 0, "pose": [[1]]}}})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "joins": [{"a": 1, "b": 2}]})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "joins": [{"a": "a.ply", "b": "a.ply"}]})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "pairs_missing": -5})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "pairs_missing": 0.5})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "constraints": [5]})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "constraints": {"must_join": 5}})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "constraints": {"poses": ["a.ply"]}})",
        R"({"schema": "rejoin.assembly/1", "fragments": {}, "constraints": {"poses": {"a.ply": [[1]]}}})"}) {
    run.assemble(text);
    const Finished finished = testing::run({"report", run.folder});
    EXPECT_EQ(finished.exit_code, 1) << text;
    EXPECT_NE(finished.err.find("assembly.json"), std::string::npos) << finished.err;
    EXPECT_EQ(finished.err.find("internal error"), std::string::npos) << finished.err;
    EXPECT_FALSE(std::filesystem::exists(run.page));
  }
}

TEST(Report, OfAFolderThatIsNoRunNamesIt) {
  const TemporaryFolder folder;
  const Finished finished = testing::run({"report", folder / "nothing"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.err.find("nothing: is not there; give the folder that rejoin batch wrote"),
            std::string::npos)
      << finished.err;
  EXPECT_TRUE(is_one_line(finished.err)) << finished.err;
}

}  // namespace
}  // namespace rejoin::cli::testing
