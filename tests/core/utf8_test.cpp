#include "core/utf8.hpp"

#include <gtest/gtest.h>

namespace rejoin {
namespace {

TEST(Utf8, CharactersOfAllLengthsAreValid) {
  for (const char* text :
       {"", "a", "Sch\u00e4rbe", "\u20ac", "\U0001F3FA", "\uFFFD", "\U0010FFFF", "\uD7FF\uE000"})
    EXPECT_TRUE(is_utf8(text)) << text;
  EXPECT_EQ(utf8_length("\U0001F3FA b"), 4U);
}

TEST(Utf8, AByteOrderMarkIsNoText) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF"
                                    "1 2"),
            "1 2");
  EXPECT_EQ(without_byte_order_mark("1 2"), "1 2");
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB"), "\xEF\xBB");
}

TEST(Utf8, WhatNoParserTakesIsInvalid) {
  EXPECT_FALSE(is_utf8("Gef\xe4\xdf"));  // Latin-1
  EXPECT_FALSE(is_utf8("a\xc3"));        // cut within a character
  EXPECT_FALSE(is_utf8("\x80"));         // begins within one
  EXPECT_FALSE(is_utf8("\xc0\xaf"));     // longer than it need be
  EXPECT_FALSE(is_utf8("\xe0\x80\xaf"));
  EXPECT_FALSE(is_utf8("\xed\xa0\x80"));      // half of a pair
  EXPECT_FALSE(is_utf8("\xf4\x90\x80\x80"));  // beyond the last
}

TEST(Utf8, BytesOfNoCharacterAreReplacedAndTheRestStays) {
  EXPECT_EQ(valid_utf8("Gef\xe4\xdf \u20ac"), "Gef\uFFFD\uFFFD \u20ac");
  EXPECT_EQ(valid_utf8("a\xc3"), "a\uFFFD");
}

}  // namespace
}  // namespace rejoin
