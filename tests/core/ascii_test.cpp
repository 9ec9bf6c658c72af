#include "core/ascii.hpp"

#include <gtest/gtest.h>

namespace rejoin {
namespace {

TEST(Ascii, LettersLoseTheirAccents) {
  EXPECT_EQ(ascii("Sch\u00e4rbe_1 (2).ply"), "Scharbe_1 (2).ply");
  EXPECT_EQ(ascii("Gr\u00f6\u00dfe"), "Grosse");
  EXPECT_EQ(ascii("o\u0308"), "o");        // an accent that is a character of its own
  EXPECT_EQ(ascii("\u00c0\u017f"), "As");  // the table's ends
  EXPECT_EQ(ascii("a\xc3"), "a?");         // cut within a character
}

TEST(Ascii, NamesInOtherScriptsStayDifferent) {
  EXPECT_EQ(ascii("\u0391\u03b3\u03b3\u03b5\u03af\u03bf \u03b1\u0384.ply"), "Aggeio a[384].ply");
  EXPECT_EQ(ascii("\u0386\u03ce"), "Aw");  // the table's ends
  EXPECT_EQ(ascii("\u0427\u0435\u0440\u0435\u043f\u043e\u043a 3"), "Cherepok 3");
  EXPECT_EQ(ascii("\u0400\u045f"), "Edzh");
  EXPECT_EQ(ascii("\u7897\u20ac\U0001F3FA"), "[7897][20ac][1f3fa]");
}

}  // namespace
}  // namespace rejoin
