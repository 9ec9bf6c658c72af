#include "core/ascii.hpp"

#include <gtest/gtest.h>

namespace rejoin {
namespace {

TEST(Ascii, LettersLoseTheirAccentsAndTheRestBecomesAQuestionMark) {
  EXPECT_EQ(ascii("Sch\u00e4rbe_1 (2).ply"), "Scharbe_1 (2).ply");
  EXPECT_EQ(ascii("Gr\u00f6\u00dfe"), "Grosse");
  EXPECT_EQ(ascii("o\u0308"), "o");        // an accent that is a character of its own
  EXPECT_EQ(ascii("\u00c0\u017f"), "As");  // the table's ends
  EXPECT_EQ(ascii("\u0416\u20ac"), "??");
  EXPECT_EQ(ascii("a\xc3"), "a?");  // cut within a character
}

}  // namespace
}  // namespace rejoin
