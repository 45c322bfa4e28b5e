// Bytes into lines and words: RS274/NGC as NISTIR 6556 has it (chapter 3.3), and where this reader refuses what it would guess.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fb_library/gcode/read_program.hpp"

namespace taktwerk::gcode {
namespace {

double x_of(const std::string& words) {
    const auto program = read_blocks("G0 " + words);
    EXPECT_EQ(program.wrong(), "") << words;
    return program.position[0];
}
std::string wrong(const std::string& blocks) { return read_blocks(blocks).wrong(); }

TEST(GcodeNumbers, HaveASignAPointAndDigitsAsTheyLike) {
    EXPECT_EQ(x_of("X5"), 5);
    EXPECT_EQ(x_of("X5."), 5);
    EXPECT_EQ(x_of("X.5"), 0.5);
    EXPECT_EQ(x_of("X-.5"), -0.5);
    EXPECT_EQ(x_of("X+05.50"), 5.5);
    EXPECT_EQ(x_of("x 7"), 7) << "a blank between letter and number, and small letters";
    EXPECT_EQ(x_of("\tX\t7"), 7);
    EXPECT_EQ(x_of("X1000000"), 1e6);
    EXPECT_EQ(x_of("X0.1"), 0.1) << "the nearest double";
    EXPECT_EQ(x_of("X12345.678"), 12345.678);
    EXPECT_EQ(x_of("X0.1000000000000000055511151231257827"), 0.1) << "34 digits";
    EXPECT_EQ(x_of("X74.797785325233453"), 74.797785325233453) << "17 digits";
    EXPECT_EQ(x_of("X40.551058552328595"), 40.551058552328595) << "17 digits";
    EXPECT_EQ(x_of("X93.420029502170442"), 93.420029502170442) << "17 digits";
    EXPECT_EQ(x_of("X00000000000000000000000000000000001.5"), 1.5);
}

TEST(GcodeNumbers, WhatIsNoneIsRefusedWithItsPlace) {
    EXPECT_EQ(wrong("G0 X"), "1:4 gcode.no_number");
    EXPECT_EQ(wrong("G0 X Y1"), "1:4 gcode.no_number");
    EXPECT_EQ(wrong("G0 X."), "1:4 gcode.number_form");
    EXPECT_EQ(wrong("G0 X-"), "1:4 gcode.number_form");
    EXPECT_EQ(wrong("G0 X--1"), "1:4 gcode.number_form");
    EXPECT_EQ(wrong("G0 X1.2.3"), "1:4 gcode.number_form");
    EXPECT_EQ(wrong("G0 X1-2"), "1:4 gcode.number_form");
    EXPECT_EQ(wrong("G0 X1,5"), "1:4 gcode.comma") << "decimal comma";
    EXPECT_EQ(wrong("G0 X1e5"), "1:6 gcode.unknown_letter") << "no exponents";
    EXPECT_EQ(wrong("G0 XNAN"), "1:4 gcode.no_number");
    EXPECT_EQ(wrong("G0 X1000000.1"), "1:4 gcode.too_large");
    EXPECT_EQ(wrong("G0 X-1000001"), "1:4 gcode.too_large");
    EXPECT_EQ(wrong("G0 X" + std::string(200, '9')), "1:4 gcode.too_large");
    EXPECT_EQ(wrong("(c) 5"), "1:5 gcode.no_letter");
}

// RS274 would read X1 5 as X15 and X1 . 5 as X1.5.
TEST(GcodeNumbers, ABlankInsideIsRefused) {
    EXPECT_EQ(wrong("G0 X1 5"), "1:4 gcode.blank_in_number");
    EXPECT_EQ(wrong("G0 X1 . 5"), "1:4 gcode.blank_in_number");
    EXPECT_EQ(wrong("G0 X- 5"), "1:4 gcode.blank_in_number");
    EXPECT_EQ(wrong("G0 X1. 5"), "1:4 gcode.blank_in_number");
    EXPECT_EQ(wrong("G0 5"), "1:1 gcode.blank_in_number");
}

TEST(GcodeLines, NumbersCommentsAndEndsOfLines) {
    const auto program = read_program("N10 G0 X1 (first) Y2 ; rest X9\r\nN20X3\n\n  \n(only)\n;only\nM2");
    EXPECT_EQ(program.wrong(), "");
    ASSERT_EQ(program.moves().size(), 2u);
    EXPECT_EQ(program.position, (AxisValues{3, 2, 0, 0, 0, 0}));
    EXPECT_EQ(program.items[0].number, 10u);
    EXPECT_EQ(program.items[1].number, 20u);
    EXPECT_EQ(program.items[1].line, 2u);
    EXPECT_EQ(program.counts.blocks, 3u);
    EXPECT_EQ(program.counts.lines, 7u);
}

TEST(GcodeLines, WhatIsNoCharacterOfABlock) {
    EXPECT_EQ(wrong("G0 X1 @"), "1:7 gcode.bad_character");
    EXPECT_EQ(wrong(std::string("G0 X1 \0", 7)), "1:7 gcode.not_plain_text");
    EXPECT_EQ(wrong(std::string("\xFF\xFEG\0000\0", 6)), "1:1 gcode.not_plain_text") << "UTF-16, as some editors save";
    EXPECT_EQ(wrong(std::string("\0G\0000", 4)), "1:1 gcode.not_plain_text") << "the other way round";
    EXPECT_EQ(wrong("G0 X1\rX2"), "1:6 gcode.bad_character") << "a CR alone ends no line";
    EXPECT_EQ(wrong("G0 X1 \xC2\xA0Y1"), "1:7 gcode.bad_character") << "a blank of another kind";
    EXPECT_EQ(wrong("(\xC3\xA4) G0 X1"), "") << "comments may have any bytes";
    EXPECT_EQ(wrong("(a (b) c)"), "1:4 gcode.nested_comment");
    EXPECT_EQ(wrong("G0 X1 (open"), "1:7 gcode.open_comment");
    EXPECT_EQ(wrong("G0 X1 )"), "1:7 gcode.bad_character");
    EXPECT_EQ(wrong("G0 X1 N5"), "1:7 gcode.n_not_first");
    EXPECT_EQ(wrong("N1.5 G0"), "1:1 gcode.not_whole");
    EXPECT_EQ(wrong("N-1 G0"), "1:1 gcode.negative");
    EXPECT_EQ(wrong("N5 N6"), "1:4 gcode.n_not_first");
    EXPECT_EQ(wrong("G0 / X1"), "1:4 gcode.slash_not_first");
    EXPECT_EQ(wrong("/2 G0 X1"), "1:2 gcode.no_letter") << "only one kind of block delete";
    EXPECT_EQ(wrong("#1=5"), "1:1 gcode.expression");
    EXPECT_EQ(wrong("G0 X#1"), "1:5 gcode.expression");
    EXPECT_EQ(wrong("G0 X[1+2]"), "1:5 gcode.expression");
    EXPECT_EQ(wrong("o100 sub"), "1:1 gcode.o_word");
    EXPECT_EQ(wrong("G0 U1"), "1:4 gcode.unknown_letter");
    EXPECT_EQ(wrong("G0 X1 X2"), "1:7 gcode.word_twice");
}

TEST(GcodeLines, MessagesComeOutAndWhatOthersActUponIsRefused) {
    const auto program = read_blocks("G0 X1 (msg, turn the part)\n( Msg ,again)");
    EXPECT_EQ(program.wrong(), "");
    EXPECT_THAT(program.messages, testing::ElementsAre("turn the part", "again"));
    EXPECT_EQ(program.items.front().kind, ProgramItem::Kind::message) << "before the motion of its block";
    EXPECT_EQ(wrong("(DEBUG, x)"), "1:2 gcode.active_comment");
    EXPECT_EQ(wrong("(probeopen, file)"), "1:2 gcode.active_comment");
    EXPECT_EQ(wrong("(LOGCLOSE)"), "1:2 gcode.active_comment");
    EXPECT_EQ(wrong("(print this, please)"), "") << "a comment with a comma";
}

TEST(GcodeLines, AreAtMost256BytesLong) {
    const std::string head = "G0 X1 (";
    const std::string fits = head + std::string(256 - head.size() - 1, 'c') + ")";
    EXPECT_EQ(read_program(fits + "\r\nM2").wrong(), "");
    for (const std::size_t piece : {1, 256, 257, 258}) EXPECT_EQ(read_program(fits + "\r\nM2", {}, piece).wrong(), "") << piece;
    EXPECT_EQ(read_program(fits + " \nM2").wrong(), "1:257 gcode.line_too_long");
    EXPECT_EQ(read_program("M2 ;" + std::string(300, 'c')).wrong(), "1:257 gcode.line_too_long") << "the last line";
    EXPECT_EQ(read_program("\n;" + std::string(100'000, 'c') + "\nM2").wrong(), "2:257 gcode.line_too_long") << "longer than any buffer";
}

TEST(GcodeTape, PercentOpensAndCloses) {
    EXPECT_EQ(read_program("%\nG0 X1\n%\n").wrong(), "");
    EXPECT_EQ(read_program("%\nG0 X1\n%\n").handshakes().back().kind, Handshake::Kind::end);
    EXPECT_EQ(read_program("\xEF\xBB\xBF%\r\n G0 X1\r\n % \r\n \n\n").wrong(), "") << "a byte order mark, blanks";
    EXPECT_EQ(read_program("G0 X1\n%\n").wrong(), "2:1 gcode.percent_unopened");
    EXPECT_EQ(read_program("%\nG0 X1\n%\nG0 X2\n").wrong(), "4:1 gcode.text_behind_percent");
    EXPECT_EQ(read_program("%\nG0 X1 %\n%\n").wrong(), "2:7 gcode.percent_inside");
    EXPECT_EQ(read_program("%\nG0 X1\nM30\n").wrong(), "") << "M30 is an end, too";
}

// A file that was cut off on its way must not look like a shorter program.
TEST(GcodeTape, AProgramHasAnEnd) {
    EXPECT_EQ(read_program("G0 X1\n").wrong(), "1:0 gcode.no_end");
    EXPECT_EQ(read_program("%\nG0 X1\n").wrong(), "2:0 gcode.no_end");
    EXPECT_EQ(read_program("").wrong(), "0:0 gcode.no_end");
    TextInMemory text("M30\n\nG0 X1\nG0 X2\n");
    Interpreter program(text, {});
    ProgramItem item;
    while (program.next(item) == Interpreter::Step::item) {}
    const auto rest = program.rest();
    EXPECT_EQ(rest.first_line, 3u);
    EXPECT_EQ(rest.lines, 2u) << "what is never carried out can be told";
}

TEST(GcodeTape, TheSameInPiecesOfAnySize) {
    const std::string text = "%\r\nN1 G21 G90 F100\r\nG1 X10 (a) Y-3.5\r\nG2 X0 Y0 R20\r\n%\r\n";
    const auto whole = read_program(text);
    ASSERT_EQ(whole.wrong(), "");
    for (std::size_t piece = 1; piece < 20; ++piece) {
        const auto pieces = read_program(text, {}, piece);
        ASSERT_EQ(pieces.items.size(), whole.items.size()) << piece;
        EXPECT_EQ(pieces.position, whole.position);
        EXPECT_EQ(pieces.wrong(), "");
    }
}

/// Nothing, then a byte, then nothing, ...; fails at the end.
class SlowText final : public TextSource {
public:
    explicit SlowText(std::string_view text) : text_(text) {}
    TextPiece read(std::span<char> into) noexcept override {
        if ((asked_++ & 1) == 0) return {TextState::none_yet, 0};
        if (text_.empty()) return {TextState::failed, 0};
        into[0] = text_.front();
        text_.remove_prefix(1);
        return {TextState::some, 1};
    }

private:
    std::string_view text_;
    int asked_ = 0;
};

TEST(GcodeTape, ASourceWithoutTextNowIsAskedAgainAndOneThatFailsIsTold) {
    SlowText text("G0 X1\nX2\nX3");
    Interpreter program(text, {});
    ProgramItem item;
    std::size_t items = 0, waits = 0;
    auto step = program.next(item);
    for (; step == Interpreter::Step::item || step == Interpreter::Step::need_text; step = program.next(item))
        ++(step == Interpreter::Step::item ? items : waits);
    EXPECT_EQ(items, 2u) << "the third line has no end";
    EXPECT_EQ(waits, 12u) << "one before each byte, and before the failure";
    EXPECT_EQ(step, Interpreter::Step::fault);
    EXPECT_EQ(program.fault().kind, FaultKind::read_failed);
    EXPECT_EQ(program.next(item), Interpreter::Step::fault) << "and stays so";
}

TEST(GcodeFaults, EveryKindHasACodeASentenceAndARemedy) {
    for (const auto& row : fault_words()) {
        EXPECT_TRUE(row.code.starts_with("gcode.")) << row.code;
        EXPECT_GT(row.what.size(), 10u) << row.code;
        EXPECT_GT(row.remedy.size(), 5u) << row.code;
        EXPECT_NE(row.what.back(), '.') << row.code;
        EXPECT_EQ(row.remedy.back(), '.') << row.code;
    }
    EXPECT_EQ(fault_words().size() + 1, fault_kinds);
}

TEST(GcodeFaults, SayFileLineColumnAndTheWord) {
    const auto error = fault_error(read_blocks("G0 X1\nG41 D3").fault, "part.ngc");
    EXPECT_EQ(error.code, "gcode.refused_code");
    EXPECT_EQ(error.subject, "part.ngc:2:1");
    EXPECT_THAT(error.what, testing::HasSubstr("G41 is not offered: cutter compensation"));
    const auto escape = fault_error(read_blocks("G0 \x1b[31m").fault, "part.ngc");
    EXPECT_THAT(escape.what, testing::HasSubstr("byte 1Bh")) << "nothing of a file reaches a terminal as it is";
}

}  // namespace
}  // namespace taktwerk::gcode
