#include "core/json_depth.hpp"

#include <gtest/gtest.h>

namespace rejoin {
namespace {

TEST(JsonDepth, CountsBracketsInOneAnother) {
  EXPECT_EQ(json_depth("3"), 0);
  EXPECT_EQ(json_depth("[]"), 1);
  EXPECT_EQ(json_depth(R"({"a": [1, {"b": 2}], "c": [[[0]]]})"), 4);
  EXPECT_EQ(json_depth("[[], [], []]"), 2);
}

TEST(JsonDepth, CountsNoneInStrings) {
  EXPECT_EQ(json_depth(R"({"[[[": "{{{"})"), 1);
  EXPECT_EQ(json_depth(R"(["\"[[[", "\\", [1]])"), 2);
}

}  // namespace
}  // namespace rejoin
