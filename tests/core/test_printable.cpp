// What files and libraries say fits on one line and is UTF-8.
#include <gtest/gtest.h>

#include "core/printable.h"

namespace brisance {
namespace {

TEST(Printable, LettersOfAllLanguagesStay) {
    EXPECT_EQ(printable("density"), "density");
    EXPECT_EQ(printable("Größe 密度 🔥"), "Größe 密度 🔥");
}

TEST(Printable, NothingLeavesTheLineOrTurnsIt) {
    EXPECT_EQ(printable("a\nb\tc\r\x1b[31md"), "a b c  [31md");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a b");
    EXPECT_EQ(printable("a\x7f"
                        "b\xC2\x85"
                        "c"),
              "a b c");
    EXPECT_EQ(printable("a\u202e"
                        "b\u2028"
                        "c\u2066"
                        "d"),
              "a b c d");
    EXPECT_EQ(printable("end \n\n"), "end");
}

TEST(Printable, WhatIsNoUtf8BecomesTheSignForIt) {
    const std::string no = "\xEF\xBF\xBD";
    EXPECT_EQ(printable("\xff"
                        "a"),
              no + "a");
    EXPECT_EQ(printable("\xe9t\xe9"), no + "t" + no);             // Latin-1
    EXPECT_EQ(printable("\xc0\xaf"), no + no);                    // a slash in too many bytes
    EXPECT_EQ(printable("\xed\xa0\x80"), no + no + no);           // half a pair of UTF-16
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), no + no + no + no);  // beyond Unicode
    EXPECT_EQ(printable("a\xe5\xaf"), "a" + no + no);             // cut off
}

TEST(Printable, LongTextIsCutBetweenCharacters) {
    EXPECT_EQ(printable("abcdef", 6), "abcdef");
    EXPECT_EQ(printable("abcdefg", 6), "abcdef...");
    EXPECT_EQ(printable("éééé", 2), "éé...");
    EXPECT_EQ(printable(std::string(1000000, 'x')).size(), kLongestMessage + 3);
}

}  // namespace
}  // namespace brisance
