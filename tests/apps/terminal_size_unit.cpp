// A picture on a terminal stays inside it, however narrow, and colours take no columns.
#include "apps/terminal/terminal_size.hpp"

#include <gtest/gtest.h>

#include "apps/terminal/text_table.hpp"

namespace taktwerk::apps {
namespace {

TEST(FittedText, WhatFitsStaysAsItIs) {
    EXPECT_EQ(fitted("abc\nde\n", {3, 3}), "abc\nde\n");
    EXPECT_EQ(fitted("", {3, 3}), "");
    EXPECT_EQ(fitted("abc", {3, 3}), "abc\n");
}

TEST(FittedText, ALongerLineIsCutAndSaysSo) {
    EXPECT_EQ(fitted("abcd\nabc\n", {3, 3}), "ab…\nabc\n");
    EXPECT_EQ(fitted("轴轴轴\n", {5, 2}), "轴轴…\n") << "two columns each";
}

TEST(FittedText, ColoursTakeNoColumnsAndNoneIsLeftOpen) {
    const auto red = toned("abcd", Tone::bad, Colours::on);
    EXPECT_EQ(fitted(red + "\n", {4, 2}), red + "\n");
    EXPECT_EQ(fitted(red + " e\n", {3, 2}), "\033[1;31mab\033[0m…\n");
    EXPECT_EQ(fitted(toned("ab", Tone::bad, Colours::on) + "cdef\n", {4, 2}), "\033[1;31mab\033[0mc…\n");
}

TEST(FittedText, LinesBeyondTheLastRowAreMissingAndThatIsSaid) {
    EXPECT_EQ(fitted("1\n2\n3\n", {80, 4}), "1\n2\n3\n");
    EXPECT_EQ(fitted("1\n2\n3\n", {80, 3}), "1\n… the terminal is too small for the rest\n");
    EXPECT_EQ(fitted("1\n2\n", {6, 1}), "… the…\n");
}

}  // namespace
}  // namespace taktwerk::apps
