// What words mean, by hand from RS274/NGC (NISTIR 6556, chapter 3) and LinuxCNC's reference of G and M codes where that goes further.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fb_library/gcode/read_program.hpp"

namespace taktwerk::gcode {
namespace {

using Kind = Handshake::Kind;

std::string fault_of(const std::string& blocks, const InterpreterOptions& options = {}) { return read_blocks(blocks, options).wrong(); }
AxisValues end_of(const std::string& blocks, const InterpreterOptions& options = {}) {
    const auto program = read_blocks(blocks, options);
    EXPECT_EQ(program.wrong(), "") << blocks;
    return program.position;
}
std::vector<Kind> kinds_of(const ReadProgram& program) {
    std::vector<Kind> kinds;
    for (const auto& handshake : program.handshakes()) kinds.push_back(handshake.kind);
    return kinds;
}
AxisValues at(double x, double y, double z = 0) { return {x, y, z, 0, 0, 0}; }

TEST(GcodeMotion, IsInheritedUntilAnotherOneOrG80) {
    const auto program = read_blocks("G1 F600 X10\nY5\nG0 Z1\nX0");
    ASSERT_EQ(program.wrong(), "");
    const auto moves = program.moves();
    ASSERT_EQ(moves.size(), 4u);
    EXPECT_EQ(moves[1].from, at(10, 0));
    EXPECT_EQ(moves[1].to, at(10, 5));
    EXPECT_EQ(moves[1].feed.kind, Feed::Kind::mm_per_s);
    EXPECT_DOUBLE_EQ(moves[1].feed.value, 10) << "600 mm/min";
    EXPECT_EQ(moves[2].feed.kind, Feed::Kind::rapid);
    EXPECT_EQ(moves[3].feed.kind, Feed::Kind::rapid);
    EXPECT_EQ(fault_of("X10"), "1:1 gcode.no_motion_mode") << "nothing is assumed at the beginning";
    EXPECT_EQ(fault_of("G0 X1\nG80\nN5 X10"), "3:4 gcode.no_motion_mode");
    EXPECT_EQ(fault_of("G0\nX1"), "") << "a mode without axis words is set";
}

TEST(GcodeMotion, OneWordOfAModalGroup) {
    EXPECT_EQ(fault_of("G0 G1 X1"), "1:4 gcode.same_group");
    EXPECT_EQ(fault_of("G90 G91"), "1:5 gcode.same_group");
    EXPECT_EQ(fault_of("G17 G18"), "1:5 gcode.same_group");
    EXPECT_EQ(fault_of("G54 G59.3"), "1:5 gcode.same_group");
    EXPECT_EQ(fault_of("M3 M4 S1"), "1:4 gcode.same_group");
    EXPECT_EQ(fault_of("M7 M8"), "1:4 gcode.same_group");
    EXPECT_EQ(fault_of("G4 P1 G53 G0 X1"), "1:7 gcode.same_group") << "both not modal";
    EXPECT_EQ(fault_of("G1 G1 X1 F1"), "1:4 gcode.word_twice");
    EXPECT_EQ(fault_of("G0 X1 G28 Y1"), "1:7 gcode.axis_words_twice");
    EXPECT_EQ(fault_of("G92 G1 X1 F1"), "1:1 gcode.axis_words_twice");
}

TEST(GcodeMotion, AWordThatNoCodeWantsIsAnError) {
    EXPECT_EQ(fault_of("G0 X1 I2"), "1:7 gcode.unused_word");
    EXPECT_EQ(fault_of("G1 F1 X1 R2"), "1:10 gcode.unused_word");
    EXPECT_EQ(fault_of("G0 X1 P2"), "1:7 gcode.unused_word");
    EXPECT_EQ(fault_of("H1"), "1:1 gcode.unused_word");
    EXPECT_EQ(fault_of("G49 H1"), "1:5 gcode.unused_word");
    EXPECT_EQ(fault_of("D5"), "1:1 gcode.unknown_letter") << "belongs to cutter compensation alone";
    EXPECT_EQ(fault_of("G4 P1 G64 P0.1"), "1:11 gcode.word_twice");
    EXPECT_EQ(fault_of("G4 P1 G64"), "1:4 gcode.word_for_two") << "whose P?";
    EXPECT_EQ(fault_of("G4 P1 M100"), "1:4 gcode.word_for_two");
}

TEST(GcodeMotion, WhatIsNotOfferedSaysWhy) {
    for (const char* word : {"G5",  "G7",  "G33", "G38.2", "G41", "G42.1", "G43.1", "G52", "G60", "G68", "G70", "G71", "G73", "G74", "G76",
                             "G81", "G89", "G95", "G96",   "G98", "G28.1", "M19",   "M48", "M60", "M61", "M62", "M66", "M98", "M99"}) {
        const auto program = read_blocks(word);
        EXPECT_EQ(program.wrong(), "1:1 gcode.refused_code") << word;
        EXPECT_GT(program.fault.reason.size(), 10u) << word;
    }
    for (const char* word : {"G6", "G1.5", "G999", "G-1", "G1.55", "G100", "M10", "M200", "M3.5", "M-1"})
        EXPECT_EQ(fault_of(word), "1:1 gcode.unknown_code") << word;
}

TEST(GcodeDistance, RelativeAddsAndAbsoluteSets) {
    EXPECT_EQ(end_of("G0 X10\nG91 X5 Y-1\nX5\nG90 Y2"), at(20, 2));
    EXPECT_EQ(fault_of("G91 G0 X1000000\nX1"), "2:1 gcode.out_of_range");
}

// G20 counts for the block it stands in: units come before motion.
TEST(GcodeUnits, NumbersAreReadInThoseInForceAndOffsetsKeepTheirMillimetres) {
    EXPECT_EQ(end_of("G20 G0 X1"), at(25.4, 0));
    EXPECT_EQ(end_of("G0 X10\nG20\nG91 X1\nG21 X1"), at(36.4, 0)) << "10 + 25.4 + 1";
    InterpreterOptions options;
    options.offsets[0] = at(100, 0);
    EXPECT_EQ(end_of("G20 G0 X1", options), at(125.4, 0)) << "the table is in mm whatever the program's units";
    options.units = InterpreterOptions::Units::inch;
    EXPECT_EQ(end_of("G0 X1", options), at(125.4, 0));
}

TEST(GcodeUnits, AFeedKeepsTheUnitsItWasGivenIn) {
    const auto program = read_blocks("G20\nF60\nG1 X1\nG21\nX50");
    ASSERT_EQ(program.wrong(), "");
    EXPECT_DOUBLE_EQ(program.moves()[0].feed.value, 25.4) << "60 inch/min";
    EXPECT_DOUBLE_EQ(program.moves()[1].feed.value, 25.4) << "not 60 mm/min";
    EXPECT_EQ(fault_of("G20 G1 X1 F10"), "1:11 gcode.feed_with_units") << "inch or mm per minute?";
    EXPECT_EQ(fault_of("G21 G1 X1 F10"), "") << "no change, no question";
}

TEST(GcodeFeed, HasToBeThere) {
    EXPECT_EQ(fault_of("G1 X1"), "1:1 gcode.no_feed");
    EXPECT_EQ(fault_of("F0\nG1 X1"), "2:1 gcode.no_feed");
    EXPECT_EQ(fault_of("G1 X1 F-5"), "1:7 gcode.negative");
    EXPECT_EQ(fault_of("G2 X1 R1"), "1:1 gcode.no_feed");
    EXPECT_EQ(fault_of("G0 X1"), "");
}

// N-05: 1/minutes, for one move; and no feed is left behind it.
TEST(GcodeFeed, InverseTimeBelongsToOneMove) {
    const auto program = read_blocks("G93 G1 X10 F2\nX30 F6\nG0 X0\nG94 F60\nG1 X1");
    ASSERT_EQ(program.wrong(), "");
    const auto moves = program.moves();
    EXPECT_EQ(moves[0].feed.kind, Feed::Kind::seconds);
    EXPECT_DOUBLE_EQ(moves[0].feed.value, 30);
    EXPECT_DOUBLE_EQ(moves[1].feed.value, 10);
    EXPECT_DOUBLE_EQ(moves[3].feed.value, 1);
    EXPECT_EQ(fault_of("G93 G1 X10 F2\nX30"), "2:1 gcode.no_inverse_time");
    EXPECT_EQ(fault_of("G93\nG1 X10 F0"), "2:1 gcode.no_inverse_time");
    EXPECT_EQ(fault_of("G93 F2"), "1:5 gcode.unused_word");
    EXPECT_EQ(fault_of("G93 G0 X1 F2"), "1:11 gcode.unused_word");
    EXPECT_EQ(fault_of("F100\nG93\nG1 X10 F2\nG94 X0"), "4:5 gcode.no_feed") << "the feed of before is gone";
    EXPECT_EQ(fault_of("F100\nG93\nG94\nG1 X0"), "4:1 gcode.no_feed");
}

TEST(GcodeFeed, OfMovesThatOnlyTurnIsInDegrees) {
    InterpreterOptions options;
    EXPECT_EQ(fault_of("G0 A90", options), "1:4 gcode.rotary_word");
    options.rotary = InterpreterOptions::Rotary::offered;
    const auto program = read_blocks("G20\nF60\nG1 A90\nX1 A0", options);
    ASSERT_EQ(program.wrong(), "");
    EXPECT_EQ(program.moves()[0].to[3], 90) << "degrees under G20, too";
    EXPECT_EQ(program.moves()[0].feed.kind, Feed::Kind::deg_per_s);
    EXPECT_DOUBLE_EQ(program.moves()[0].feed.value, 1);
    EXPECT_EQ(program.moves()[1].feed.kind, Feed::Kind::mm_per_s);
    EXPECT_DOUBLE_EQ(program.moves()[1].feed.value, 25.4);
}

// Whatever the order of the words. F, S, T, M6, M3, M8, user, G4, then the motion, then the stop.
TEST(GcodeOrder, InABlockIsFixed) {
    const auto program = read_blocks("M0 X10 M8 M3 G1 M6 T4 M101 P7 S1000 F60 (MSG, hello)");
    ASSERT_EQ(program.wrong(), "");
    EXPECT_EQ(program.items[0].kind, ProgramItem::Kind::message);
    EXPECT_THAT(kinds_of(program), testing::ElementsAre(Kind::tool_prepare, Kind::tool_change, Kind::spindle_clockwise, Kind::flood,
                                                        Kind::user, Kind::program_stop, Kind::spindle_off, Kind::coolant_off, Kind::end));
    EXPECT_EQ(program.items[6].kind, ProgramItem::Kind::move);
    EXPECT_EQ(program.handshakes()[0].number, 4u);
    EXPECT_EQ(program.handshakes()[2].value, 1000);
    EXPECT_EQ(program.handshakes()[4].number, 101u);
    EXPECT_EQ(program.handshakes()[4].value, 7);
    EXPECT_TRUE(std::isnan(program.handshakes()[4].second));
    const auto dwell = read_blocks("G1 X1 F60 G4 P0.5");
    ASSERT_EQ(dwell.wrong(), "");
    EXPECT_EQ(dwell.items[0].kind, ProgramItem::Kind::dwell);
    EXPECT_EQ(dwell.items[0].seconds, 0.5);
}

// A person reads it.
TEST(GcodeMachine, WhatIsMissingIsSaidInWords) {
    const auto said = [](std::string_view text) { return fault_error(read_blocks(std::string(text)).fault, "part.ngc").text(); };
    EXPECT_THAT(said("G4 X1"), testing::HasSubstr("part.ngc:1:1: G4 lacks P, the time in seconds"));
    EXPECT_THAT(said("G10 L2 X1"), testing::HasSubstr("G10 lacks P, the number of the coordinate system"));
    EXPECT_THAT(said("G0 X20 Y5\nG90.1 G3 X10 Y15 I10 F1"),
                testing::HasSubstr("G3 lacks a word of the centre: under G90.1 both are needed"));
    for (const auto& row : fault_words()) EXPECT_EQ(std::string(row.what).find(",,"), std::string::npos) << row.code;
}

TEST(GcodeMachine, SpindleToolAndDwell) {
    EXPECT_EQ(fault_of("M3"), "1:1 gcode.no_speed");
    EXPECT_EQ(fault_of("M6"), "1:1 gcode.no_tool");
    EXPECT_EQ(fault_of("S-1"), "1:1 gcode.negative");
    EXPECT_EQ(fault_of("T1.5"), "1:1 gcode.not_whole");
    EXPECT_EQ(fault_of("G4"), "1:1 gcode.missing_word");
    EXPECT_EQ(fault_of("G4 X1"), "1:1 gcode.missing_word") << "Fanuc's form";
    EXPECT_EQ(fault_of("G4 P-1"), "1:4 gcode.negative");
    EXPECT_THAT(kinds_of(read_blocks("S100\nM4\nS200\nS300 M3\nM5\nS9")),
                testing::ElementsAre(Kind::spindle_counter, Kind::spindle_speed, Kind::spindle_clockwise, Kind::spindle_off, Kind::end));
    EXPECT_EQ(waits_of(Kind::tool_change), Waits::at_rest);
    EXPECT_EQ(waits_of(Kind::spindle_speed), Waits::no);
}

TEST(GcodeFrames, G54ToG59AndG10AndG53) {
    InterpreterOptions options;
    options.offsets[0] = at(100, 0), options.offsets[1] = at(0, 200), options.offsets[8] = at(-5, 0);
    EXPECT_EQ(end_of("G0 X1", options), at(101, 0)) << "G54 at the start";
    EXPECT_EQ(end_of("G55 G0 X1 Y1", options), at(1, 201));
    EXPECT_EQ(end_of("G59.3 G0 X1", options), at(-4, 0));
    EXPECT_EQ(end_of("G0 X1\nG55\nY0", options), at(101, 200)) << "what has no word stays where the machine is";
    EXPECT_EQ(end_of("G53 G0 X1", options), at(1, 0));
    EXPECT_EQ(end_of("G53 G0 X1\nX1", options), at(101, 0)) << "not modal";
    EXPECT_EQ(end_of("G10 L2 P1 X7\nG0 X1", options), at(8, 0));
    EXPECT_EQ(end_of("G0 X10\nG10 L20 P0 X1\nX0", options), at(109, 0)) << "110 is called 1";
    EXPECT_EQ(end_of("G20\nG10 L2 P2 Y1\nG55 G0 Y0", options), at(0, 25.4));
    EXPECT_EQ(fault_of("G53 X1"), "1:1 gcode.g53_motion");
    EXPECT_EQ(fault_of("G53 G0"), "1:1 gcode.g53_motion");
    EXPECT_EQ(fault_of("G53 G2 X1 R1 F1"), "1:1 gcode.g53_motion");
    EXPECT_EQ(fault_of("G91 G53 G0 X1"), "1:5 gcode.g53_relative");
    EXPECT_EQ(fault_of("G10 L1 P1 X1"), "1:5 gcode.g10_kind");
    EXPECT_EQ(fault_of("G10 L2 P10 X1"), "1:8 gcode.g10_system");
    EXPECT_EQ(fault_of("G10 L2 P1"), "1:1 gcode.missing_word");
    EXPECT_EQ(fault_of("G10 L2 P1 X0 R30"), "1:14 gcode.unused_word") << "no rotated systems";
}

TEST(GcodeFrames, G92ShiftsAllSystemsAndComesAndGoes) {
    InterpreterOptions options;
    options.offsets[1] = at(50, 0);
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nX5"), at(15, 0)) << "10 is called 0";
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nG55 X0", options), at(60, 0));
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nG92.1 X5"), at(5, 0)) << "gone before the motion of its block";
}

TEST(GcodeFrames, G92Family) {
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nG92.1\nX5"), at(5, 0));
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nG92.2\nX5\nG92.3\nX5"), at(15, 0)) << "put aside and brought back";
    EXPECT_EQ(end_of("G0 X10\nG92 X0\nG92.1\nG92.3\nX5"), at(5, 0)) << "forgotten";
    EXPECT_EQ(fault_of("G92"), "1:1 gcode.missing_word");
    EXPECT_EQ(end_of("G0 X10\nG91 G92 X0\nG90 X5"), at(15, 0)) << "whatever the distance mode";
    EXPECT_EQ(end_of("G0 X25.4\nG20 G92 X1\nX0"), at(0, 0));
}

TEST(GcodeFrames, ToolLengthsMoveNothingByThemselves) {
    InterpreterOptions options;
    options.tools = {{1, at(0, 0, 100)}, {2, at(0, 0, 50)}};
    EXPECT_EQ(end_of("G0 Z10\nG43 H1", options), at(0, 0, 10));
    EXPECT_EQ(end_of("G0 Z10\nG43 H1\nZ10", options), at(0, 0, 110));
    EXPECT_EQ(end_of("G43 H1 G0 Z10\nG43 H2 Z10", options), at(0, 0, 60)) << "the later one instead of the earlier, not upon it";
    EXPECT_EQ(end_of("G43 H1 G0 Z10\nG49 Z10", options), at(0, 0, 10));
    EXPECT_EQ(end_of("T2 M6\nG43 G0 Z10", options), at(0, 0, 60)) << "of the tool in the spindle";
    EXPECT_EQ(end_of("G43 H1 G0 Z0\nG43 H0 Z0", options), at(0, 0, 0));
    EXPECT_EQ(end_of("G43 H1 G0 X1\nZ0", options), at(1, 0, 100)) << "an axis without a word does not move";
    EXPECT_EQ(end_of("G43 H1\nG53 G0 Z0", options), at(0, 0, 0)) << "G53: the machine's place";
    EXPECT_EQ(fault_of("G43 H3", options), "1:5 gcode.unknown_tool");
    EXPECT_EQ(fault_of("G43", options), "1:1 gcode.no_tool");
}

TEST(GcodeFrames, WhereTheMachineStandsIsCalledAsSaidWhateverElseIsInForce) {
    InterpreterOptions options;
    options.tools = {{1, at(0, 0, 100)}}, options.offsets[0] = at(0, 0, 7);
    EXPECT_EQ(end_of("G43 H1 G0 Z0\nG92 Z50\nZ51", options), at(0, 0, 108)) << "107 is called 50";
    EXPECT_EQ(end_of("G43 H1 G0 Z0\nG92 Z50\nG10 L20 P1 Z3\nZ4", options), at(0, 0, 108)) << "107 is called 3";
}

TEST(GcodeReference, G28GoesByThePointGivenInTheDistanceModeInForce) {
    InterpreterOptions options;
    options.reference = at(1, 2, 3), options.second_reference = at(7, 8, 9);
    const auto all = read_blocks("G0 X50 Y50 Z50\nG28", options);
    ASSERT_EQ(all.moves().size(), 2u);
    EXPECT_EQ(all.moves()[1].to, at(1, 2, 3)) << "all at once";
    const auto some = read_blocks("G0 X50 Y50 Z50\nG91 G28 Z5", options);
    ASSERT_EQ(some.moves().size(), 3u);
    EXPECT_EQ(some.moves()[1].to, at(50, 50, 55));
    EXPECT_EQ(some.moves()[2].to, at(50, 50, 3)) << "only that axis";
    EXPECT_EQ(some.moves()[2].feed.kind, Feed::Kind::rapid);
    const auto trap = read_blocks("G0 X50 Y50 Z50\nG90 G28 Z0", options);
    EXPECT_EQ(trap.moves()[1].to, at(50, 50, 0)) << "under G90 Z0 is a place: down to the work first";
    EXPECT_EQ(end_of("G0 X50\nG30", options), at(7, 8, 9));
    EXPECT_EQ(end_of("G1 F1 X50\nG28\nY0", options), at(1, 0, 3)) << "G1 goes on behind it";
}

TEST(GcodePathMode, G61AndG64) {
    const auto program = read_blocks("G0 X1\nG64 P0.1\nX2\nG20 G64 P0.1 Q0\nX3\nG64\nX4\nG61.1\nX5\nG61\nX6");
    ASSERT_EQ(program.wrong(), "");
    const auto moves = program.moves();
    EXPECT_EQ(moves[0].path.kind, PathMode::Kind::exact_path) << "the path, as long as nothing else is said";
    EXPECT_EQ(moves[1].path.kind, PathMode::Kind::blend) << "rapids, too";
    EXPECT_DOUBLE_EQ(moves[1].path.deviation_mm, 0.1);
    EXPECT_DOUBLE_EQ(moves[1].path.merge_mm, 0.1) << "Q is P where it is not given";
    EXPECT_DOUBLE_EQ(moves[2].path.deviation_mm, 2.54);
    EXPECT_EQ(moves[2].path.merge_mm, 0);
    EXPECT_TRUE(std::isinf(moves[3].path.deviation_mm)) << "any deviation";
    EXPECT_EQ(moves[4].path.kind, PathMode::Kind::exact_stop);
    EXPECT_EQ(moves[5].path.kind, PathMode::Kind::exact_path);
    EXPECT_EQ(fault_of("G64 P0"), "1:5 gcode.g64_zero");
    EXPECT_EQ(fault_of("G64 P-1"), "1:5 gcode.negative");
    EXPECT_EQ(fault_of("G64 Q1"), "1:5 gcode.missing_word");
}

TEST(GcodeRun, BlockDeleteOptionalStopAndSingleBlock) {
    InterpreterOptions options;
    const std::string text = "G0 X1\n/ N5 Y1\n /Z1 (any thing that is @ wrong\nM1";
    EXPECT_EQ(read_blocks(text).wrong(), "3:6 gcode.open_comment") << "carried out, so it has to be right";
    options.block_delete = true;
    const auto left_out = read_blocks(text, options);
    EXPECT_EQ(left_out.wrong(), "");
    EXPECT_EQ(left_out.position, at(1, 0));
    EXPECT_EQ(left_out.counts.left_out, 2u);
    EXPECT_EQ(left_out.counts.optional_stops, 1u);
    EXPECT_THAT(kinds_of(left_out), testing::ElementsAre(Kind::end));
    options.optional_stop = true;
    EXPECT_THAT(kinds_of(read_blocks(text, options)), testing::ElementsAre(Kind::optional_stop, Kind::end));
    options.single_block = true;
    EXPECT_THAT(kinds_of(read_blocks("G0 X1\n(nothing)\nG90\nG91 G28 X1\nX0", options)),
                testing::ElementsAre(Kind::block_stop, Kind::block_stop, Kind::end))
        << "behind what did something, once a block; X0 led nowhere";
}

TEST(GcodeRun, FromALineWithTheStateOfThoseBefore) {
    InterpreterOptions options;
    options.start_line = 5, options.tools = {{3, at(0, 0, 10)}};
    TextInMemory text("G20 G0 X1 (MSG, not said)\nT3 M6 S500 M3\nM8 M101\nG43 H3 G91 F60\nG1 Z1\nM2\n");
    Interpreter program(text, options);
    ProgramItem item;
    ASSERT_EQ(program.next(item), Interpreter::Step::item);
    EXPECT_EQ(item.kind, ProgramItem::Kind::resume);
    EXPECT_EQ(item.line, 5u);
    EXPECT_EQ(item.move.to, at(25.4, 0)) << "where the machine has to be brought";
    const auto& with = program.resume_state();
    EXPECT_EQ(with.tool, 3u);
    EXPECT_EQ(with.spindle, ProgramOutputs::Spindle::clockwise);
    EXPECT_EQ(with.speed, 500);
    EXPECT_TRUE(with.flood);
    EXPECT_FALSE(with.mist);
    EXPECT_EQ(with.user_codes_left_out, 1u) << "what M101 did is not known";
    ASSERT_EQ(program.next(item), Interpreter::Step::item);
    EXPECT_EQ(item.kind, ProgramItem::Kind::move);
    EXPECT_EQ(item.move.from, at(25.4, 0));
    EXPECT_EQ(item.move.to, at(25.4, 0, 25.4));
    EXPECT_DOUBLE_EQ(item.move.feed.value, 25.4);

    options.start_line = 7;
    EXPECT_EQ(read_program("G0 X1\nM2\n", options).wrong(), "0:0 gcode.start_beyond_end");
    EXPECT_EQ(read_program("%\nG0 X1\n%\n", options).wrong(), "0:0 gcode.start_beyond_end");
    EXPECT_EQ(read_program("G0 X1\nG1 X2\n", options).wrong(), "2:1 gcode.no_feed") << "what is left out has to be right as well";
    options.start_line = 2;
    EXPECT_EQ(read_program("G0 X1\n\n\nX2\nM2\n", options).items.front().kind, ProgramItem::Kind::resume);
}

TEST(GcodeRun, AFaultLeavesNothingOfItsBlock) {
    const auto program = read_blocks("G0 X1\nT5 M6 G1 X2");
    EXPECT_EQ(program.wrong(), "2:7 gcode.no_feed");
    EXPECT_EQ(program.items.size(), 1u) << "no tool change either";
    TextInMemory text("G0 X1\nT5 M6 G1 X2\nM2\n");
    Interpreter asked_again(text, {});
    ProgramItem item;
    EXPECT_EQ(asked_again.next(item), Interpreter::Step::item);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(asked_again.next(item), Interpreter::Step::fault) << "for ever";
}

TEST(GcodeRun, MovesThatLeadNowhereAreCounted) {
    const auto program = read_blocks("G0 X1\nX1\nG1 F1 Y0");
    EXPECT_EQ(program.moves().size(), 1u);
    EXPECT_EQ(program.counts.standing, 2u);
}

}  // namespace
}  // namespace taktwerk::gcode
