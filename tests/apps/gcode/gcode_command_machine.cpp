// `taktwerk gcode` as its user meets it: the built command on files.

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string taktwerk = TAKTWERK_BINARY_DIR "/taktwerk";

class GcodeCommand : public ::testing::Test {
protected:
    GcodeCommand() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-gcode-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~GcodeCommand() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string file(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
        return path(name);
    }

    std::filesystem::path folder_;
};

// 30 mm at 600 mm/min are 3 s; a quarter of a circle of 10 mm is 15.708 mm, 1.5708 s; and the pause.
constexpr const char* part =
    "%\nG21 G90 F600\nT1 M6\nG0 X10 Z5\nG43 H1 (MSG, ready)\nG1 X40\n/X40 Y1\nG1 X10\nG3 X0 Y10 I-10\nM1\nG4 P1\nM30\n%\n";

TEST_F(GcodeCommand, CheckAddsUp) {
    Child check({taktwerk, "gcode", "check", file("part.ngc", part), "--tool", "1=40.5", "--block-delete"});
    EXPECT_EQ(check.wait(20s), exit_ok) << check.text();
    for (const char* words : {"12 lines", "ends with M30", "X         0 to 40 mm", "Y         0 to 10 mm", "Z         0 to 5 mm",
                              "1 rapid (11.1803 mm)", "2 lines (60 mm)", "1 arc (15.708 mm)", "600 mm/min", "tools     1", "1 pause, 1 s",
                              "1 x M6", "1 block by block delete", "1 x M1 (optional stop is off)", "at least 8.57 s", "message   ready"})
        EXPECT_THAT(check.text(), HasSubstr(words));
}

// All that the path stands for until its program has answered: spindle and coolant, too. The end switches off what still turns.
TEST_F(GcodeCommand, CheckCountsAllThatHasToBeAcknowledged) {
    const auto all = file("waits.ngc", "G21 G90\nM3 S100\nG1 X1 F600\nM7\nM8\nM9\nM4\nM5\nM100 P1 Q2\nM0\nM1\nM6 T1\nS200\nM3\nM30\n");
    Child check({taktwerk, "gcode", "check", all, "--tool", "1=3"});
    EXPECT_EQ(check.wait(20s), exit_ok) << check.text();
    EXPECT_THAT(check.text(), HasSubstr("1 x M0, 1 x M6, 2 x M3, 1 x M4, 2 x M5, 1 x M7, 1 x M8, 1 x M9, 1 x M100 to M199"));
    Child scripts({taktwerk, "gcode", "check", "--json", all, "--tool", "1=3"});
    EXPECT_EQ(scripts.wait(20s), exit_ok);
    const auto said = nlohmann::json::parse(scripts.text()).at("acknowledged");
    EXPECT_EQ(said.at("spindle"), 5);
    EXPECT_EQ(said.at("coolant"), 3);
    EXPECT_EQ(said.at("tool_changes"), 1);
}

// The machine's own check reads its paths through, by their tables: nobody waits for a workpiece to learn of a comma.
TEST_F(GcodeCommand, TheCheckOfAMachineReadsItsPaths) {
    const auto machine = [&](const std::string& text) {
        file("part.ngc", text);
        return file("portal.yaml",
                    "version: 1\nname: portal\ncycle: 1 ms\nbus: { interface: simulated, slaves: [{ name: d, profile: sv33-e }] }\n"
                    "axes: { x: { slave: d, unit: mm, gearing: { counts_per_revolution: 131072, feed: 20 mm }, "
                    "limits: { velocity: 100 mm/s, acceleration: 1000 mm/s2, jerk: 20000 mm/s3 } } }\n"
                    "paths: { part: { file: part.ngc } }\n");
    };
    Child good({taktwerk, "check", machine("G21 G90\nG0 X1\nM2\n")});
    EXPECT_EQ(good.wait(20s), exit_ok) << good.text();
    EXPECT_THAT(good.text(), Not(HasSubstr("part.ngc:")));
    Child bad({taktwerk, "check", machine("G21 G90\nG0 X1\nG41\nM2\n")});
    EXPECT_EQ(bad.wait(20s), exit_ok) << bad.text();
    EXPECT_THAT(bad.text(), HasSubstr("part.ngc:3:1: G41 is not offered"));
    EXPECT_THAT(bad.text(), HasSubstr("path part: MC_PathSelect refuses it"));
    EXPECT_THAT(bad.text(), AllOf(HasSubstr("to look at"), Not(HasSubstr("no problem found"))));
}

TEST_F(GcodeCommand, CheckSaysWhereWhatAndWhatToDoAndLooksBehindTheFirstError) {
    Child check({taktwerk, "gcode", "check", file("bad.ngc", "G0 X1\nG1 X2\nG0 X1,5\nG41\nM30\nG42\n")});
    EXPECT_EQ(check.wait(20s), exit_bad_file);
    EXPECT_THAT(check.text(), HasSubstr("bad.ngc:2:1: G1 has no feed"));
    EXPECT_THAT(check.text(), HasSubstr("-> Give F in this block or before it."));
    EXPECT_THAT(check.text(), HasSubstr("bad.ngc:3:4: X1 is followed by a comma"));
    EXPECT_THAT(check.text(), HasSubstr("bad.ngc:4:1: G41 is not offered"));
    EXPECT_THAT(check.text(), Not(HasSubstr("G42"))) << "behind the end";
}

TEST_F(GcodeCommand, CheckForScripts) {
    Child good({taktwerk, "gcode", "check", "--json", file("part.ngc", part), "--tool", "1=40.5", "--block-delete"});
    EXPECT_EQ(good.wait(20s), exit_ok);
    const auto said = nlohmann::json::parse(good.text());
    EXPECT_TRUE(said.at("ok").get<bool>());
    EXPECT_EQ(said.at("end"), "M30");
    EXPECT_EQ(said.at("extents").at("X").at("most"), 40);
    EXPECT_FALSE(said.at("extents").contains("A"));
    EXPECT_EQ(said.at("lines_with_feed").at("length_mm"), 60);
    EXPECT_EQ(said.at("tools"), nlohmann::json::array({1}));
    EXPECT_NEAR(said.at("least_seconds").get<double>(), 6 + 1.570796 + 1, 1e-6);

    Child bad({taktwerk, "gcode", "check", "--json", file("bad\xff.ngc", "G0 X1\nG1 X2\nG41\n")});
    EXPECT_EQ(bad.wait(20s), exit_bad_file);
    const auto errors = nlohmann::json::parse(bad.text()).at("errors");
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[0].at("code"), "gcode.no_feed");
    EXPECT_EQ(errors[1].at("code"), "gcode.refused_code");
}

TEST_F(GcodeCommand, WhatIsNoErrorAndWorthALookIsSaid) {
    Child check({taktwerk, "gcode", "check", file("odd.ngc", "G64\nG0 X1\nG4 P500\nM100\nX2\nM2\nX5\n"), "--from-line", "5"});
    EXPECT_EQ(check.wait(20s), exit_ok) << check.text();
    for (const char* words : {"odd.ngc:7: 1 line behind the program's end is never carried out", "G64 without P",
                              "from      line 5: X 1 Y 0 Z 0", "1 x M100 to M199 before the start line is left out"})
        EXPECT_THAT(check.text(), HasSubstr(words));
    EXPECT_THAT(check.text(), Not(HasSubstr("pause"))) << "it lies before the start";
}

TEST_F(GcodeCommand, WrongArgumentsAndFilesThatAreNone) {
    const auto code_of = [](std::vector<std::string> words) { return Child(std::move(words)).wait(20s); };
    const auto good = file("good.ngc", "G0 X1\nM2\n");
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", good}), exit_ok);
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", path("nothing")}), exit_bad_file);
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", folder_.string()}), exit_bad_file);
    EXPECT_EQ(code_of({taktwerk, "gcode", "check"}), exit_usage);
    for (const char* tool : {"1", "1=", "0=5", "1=x", "1=1,2", "1=1,2,3,4", "1=nan", "1=1e9", "x=1"})
        EXPECT_EQ(code_of({taktwerk, "gcode", "check", good, "--tool", tool}), exit_usage) << tool;
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", good, "--tool", "1=5", "--tool", "1=6"}), exit_usage) << "twice";
    for (const char* offset : {"G54", "G53=1,2,3", "G54=1,2", "G54=1,2,x"})
        EXPECT_EQ(code_of({taktwerk, "gcode", "check", good, "--offset", offset}), exit_usage) << offset;
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", good, "--from-line", "0"}), exit_usage);
    EXPECT_EQ(code_of({taktwerk, "gcode", "check", good, "--from-line", "9"}), exit_bad_file);
}

TEST_F(GcodeCommand, PlotDrawsAndOverwritesNoProgram) {
    const auto program = file("part.ngc", part);
    Child plot({taktwerk, "gcode", "plot", program, "--block-delete", "--tool", "1=0"});
    EXPECT_EQ(plot.wait(30s), exit_ok) << plot.text();
    std::ifstream picture(path("part.svg"));
    const std::string text{std::istreambuf_iterator<char>(picture), {}};
    EXPECT_THAT(text, HasSubstr("</svg>"));
    EXPECT_THAT(text, HasSubstr("part.ngc"));
    EXPECT_EQ(Child({taktwerk, "gcode", "plot", program, "--block-delete", "--tool", "1=0", "-o", program}).wait(20s), exit_bad_file);
    EXPECT_EQ(std::filesystem::file_size(program), std::string(part).size());
    EXPECT_EQ(Child({taktwerk, "gcode", "plot", file("empty.ngc", "M2\n")}).wait(20s), exit_bad_file);
    EXPECT_FALSE(std::filesystem::exists(path("empty.svg")));
}

// gnuplot carries out what stands in backticks of its double-quoted strings: the control shows that it would here, too.
TEST_F(GcodeCommand, PlotCarriesOutNothingThatStandsInAProgramOrItsName) {
    Child control({"gnuplot", "-e", "x = \"`touch " + path("control") + "`\""});
    ASSERT_EQ(control.wait(10s), 0) << control.text();
    ASSERT_TRUE(std::filesystem::exists(path("control")));

    std::filesystem::create_directory(path("in"));
    std::filesystem::current_path(path("in"));
    std::ofstream("|touch name' `touch name2`.ngc") << "(MSG, `touch message`)\n(' `touch comment`)\nG1 F1 X1\nM2\n";
    Child plot({taktwerk, "gcode", "plot", "|touch name' `touch name2`.ngc", "--title", "' `touch title`"});
    EXPECT_EQ(plot.wait(20s), exit_ok) << plot.text();
    EXPECT_TRUE(std::filesystem::exists("|touch name' `touch name2`.svg")) << "it is drawn all the same";
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(".")) ++files;
    EXPECT_EQ(files, 2u) << "the program and its picture";
    std::filesystem::current_path(TAKTWERK_SOURCE_DIR);
}

// A pipe is read once: opened again it would wait for ever.
TEST_F(GcodeCommand, APipeIsAProgramToo) {
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    Child check({"bash", "-c", "printf 'G1 X1\\nM2\\n' > \"$1\" & exec \"$0\" gcode check \"$1\"", taktwerk, path("pipe")});
    EXPECT_EQ(check.wait(20s), exit_bad_file);
    EXPECT_THAT(check.text(), HasSubstr("pipe:1:1: G1 has no feed"));
    EXPECT_THAT(check.text(), Not(HasSubstr("behind line"))) << "nothing was looked at";
    Child plot({"bash", "-c", "printf 'G0 X1\\nM2\\n' > \"$1\" & exec \"$0\" gcode plot \"$1\"", taktwerk, path("pipe")});
    EXPECT_EQ(plot.wait(20s), exit_bad_file);
    EXPECT_THAT(plot.text(), HasSubstr("can be read once only"));
}

TEST_F(GcodeCommand, RunSaysUnitsAndWhoAsks) {
    const std::string machine = TAKTWERK_SOURCE_DIR "/config/machines/engraver.yaml";
    Child run({taktwerk, "gcode", "run", machine, file("run.ngc", "G53 G0 X10\nT1\nM6\nM2\n")});
    EXPECT_EQ(run.wait(60s), exit_ok) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("10.000 mm of path, at most "));
    EXPECT_THAT(run.text(), HasSubstr(" mm/s\n"));
    EXPECT_THAT(run.text(), HasSubstr("line 2      T1"));
    EXPECT_THAT(run.text(), HasSubstr("line 3      M6, tool 1"));
    // Its X ends at 305.
    const auto beyond = file("beyond.ngc", "G53 G0 X10\nG53 G0 X400 Y20\nM2\n");
    Child refused({taktwerk, "gcode", "run", machine, beyond});
    EXPECT_EQ(refused.wait(60s), exit_bad_file) << refused.text();
    EXPECT_THAT(refused.text(), HasSubstr("beyond.ngc:2"));
    EXPECT_THAT(refused.text(),
                HasSubstr("axis x comes to its limit of 305.000 mm; at X 305.000 Y 15.128 Z 0.000 mm (MCS); after 295.388 of 390.512 mm"));
    Child rotary({taktwerk, "gcode", "run", machine, file("rotary.ngc", "G0 A5\nM2\n"), "--rotary"});
    EXPECT_EQ(rotary.wait(60s), exit_usage);
    EXPECT_THAT(rotary.text(), HasSubstr("--rotary: on a machine a stored path moves X, Y and Z"));
}

TEST_F(GcodeCommand, RunGivenTheOtherWayRoundSaysWhichComesFirst) {
    const auto part = file("part.ngc", "G21 G0 X1\nM2\n"), machine = file("machine.yaml", "machine: {name: m}\n");
    Child swapped({taktwerk, "gcode", "run", part, machine});
    EXPECT_EQ(swapped.wait(20s), exit_usage);
    EXPECT_THAT(swapped.text(), HasSubstr("gcode run " + machine + " " + part));
}

TEST_F(GcodeCommand, NothingOfAFileReachesTheTerminalAsItIs) {
    Child check({taktwerk, "gcode", "check", file("esc.ngc", "(MSG, \x1b[31mred\x1b[0m)\nG0 X1\nM2\n")});
    EXPECT_EQ(check.wait(20s), exit_ok);
    EXPECT_THAT(check.text(), HasSubstr("message"));
    EXPECT_EQ(check.text().find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace taktwerk::apps
