#include "core/one_line.hpp"

#include <gtest/gtest.h>

namespace taktwerk {
namespace {

using namespace std::string_view_literals;

TEST(OneLine, KeepsWordsOfAnyLanguage) {
    EXPECT_EQ(on_one_line("Drehgeber für X 编码器 \xF0\x9F\x94\xA7"), "Drehgeber für X 编码器 \xF0\x9F\x94\xA7");
}

TEST(OneLine, WhatMovesACursorOrEndsALineIsABlank) {
    EXPECT_EQ(on_one_line("a\0b\x1B[2Jc\rd\ne\x7F"sv), "a b [2Jc d e ");
    EXPECT_EQ(on_one_line("a\xC2\x9B"
                          "2Jb"),
              "a 2Jb");  // C1: CSI in one character
    EXPECT_EQ(on_one_line("a\xE2\x80\xA8"
                          "b\xEF\xBB\xBF"
                          "c"),
              "a b c");  // line separator, byte order mark
}

TEST(OneLine, BytesThatAreNoCharacterAreLeftOut) {
    EXPECT_EQ(on_one_line("f\xFCr"), "fr");  // ISO-8859-1
    EXPECT_EQ(on_one_line("a\xC0\xAF"
                          "b"),
              "ab");  // longer than need be
    EXPECT_EQ(on_one_line("a\xED\xA0\x80"
                          "b"),
              "ab");                           // a surrogate
    EXPECT_EQ(on_one_line("a\xE7\xBC"), "a");  // cut
}

}  // namespace
}  // namespace taktwerk
