// A run as a file, and again: the built command on machines of config/machines/ with their programs.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string shipped = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/";

class ReplayCommand : public ::testing::Test {
protected:
    ReplayCommand() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
    }
    ~ReplayCommand() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    static std::string text_of(const std::string& name) {
        std::ifstream in(name, std::ios::binary);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    }
    struct Outcome {
        int code;
        std::string text;
    };
    static Outcome command(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), taktwerk);
        Child child(arguments);
        const int code = child.wait(120s);
        return {code, child.text()};
    }
    /// A recording of a machine of config/machines/.
    void record(const std::string& machine, const std::string& duration) const {
        const auto run = command({"run", shipped + machine, "--virtual-time", "--duration", duration, "--record", path("run.twrec"),
                                  "--trace", path("run.csv"), "--quiet"});
        ASSERT_TRUE(run.code == exit_ok || run.code == exit_alarm) << run.text;
    }
    /// The same file elsewhere, with something replaced.
    std::string altered(const std::string& machine, const std::string& from, const std::string& to) const {
        auto text = text_of(shipped + machine);
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        if (at != std::string::npos) text.replace(at, from.size(), to);
        std::filesystem::create_directories(folder_ + "/machines");
        for (const char* data : {"drives", "devices"})
            if (!std::filesystem::exists(path(data)))
                std::filesystem::create_directory_symlink(std::filesystem::path(shipped) / ".." / data, path(data));
        for (const auto& beside : std::filesystem::directory_iterator(shipped))
            if (beside.path().extension() == ".svg")
                std::filesystem::copy_file(beside.path(), folder_ + "/machines/" + beside.path().filename().string(),
                                           std::filesystem::copy_options::overwrite_existing);
        std::ofstream(path("machines/" + machine)) << text;
        return path("machines/" + machine);
    }

    std::string folder_;
};

TEST_F(ReplayCommand, FiveDrivesOnABusAndALineWithProgramAndEventsAreIdentical) {
    record("five-drives.yaml", "20s");

    const auto replay = command({"replay", path("run.twrec"), "--trace", path("again.csv"), "--quiet"});

    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr("identical: "));
    // But for what was measured on this computer: times of tasks and steps are no signals of a trace.
    EXPECT_EQ(text_of(path("again.csv")), text_of(path("run.csv")));
    EXPECT_GT(text_of(path("run.csv")).size(), 1'000'000u);
}

TEST_F(ReplayCommand, AnotherMachineFileIsSaidAndTheFirstSignalNamed) {
    record("demo.yaml", "5s");
    ASSERT_EQ(command({"replay", path("run.twrec"), "--quiet"}).code, exit_ok);

    const auto replay =
        command({"replay", path("run.twrec"), altered("demo.yaml", "acceleration: 5000 mm/s2", "acceleration: 4000 mm/s2"), "--quiet"});

    EXPECT_EQ(replay.code, exit_differs) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr("file of the machine is another one: crc32 "));
    EXPECT_THAT(replay.text, HasSubstr("first difference: cycle "));
    EXPECT_THAT(replay.text, HasSubstr("axis "));
}

// z_down of pick_and_place.cpp is 90 mm, and stands once in the library: the lowest bit of its mantissa is turned over.
TEST_F(ReplayCommand, AProgramThatIsOneBitAnotherIsNamedAtItsFirstCycle) {
    record("demo.yaml", "12s");
    auto library = text_of(TAKTWERK_BINARY_DIR "/programs/pick_and_place.so");
    constexpr double z_down = 90;
    const std::string constant(reinterpret_cast<const char*>(&z_down), sizeof z_down);
    const auto at = library.find(constant);
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(library.find(constant, at + 1), std::string::npos) << "it stands in more than one place";
    library[at] = static_cast<char>(library[at] ^ 1);
    std::ofstream(path("other.so"), std::ios::binary) << library;

    const auto open_loop = command({"replay", path("run.twrec"), "--program", path("other.so"), "--quiet"});
    EXPECT_EQ(open_loop.code, exit_ok) << open_loop.text;
    EXPECT_THAT(open_loop.text, AllOf(HasSubstr("open loop"), HasSubstr("axis z: set ")));

    const auto other = altered("demo.yaml", "library: pick_and_place.so", "library: " + path("other.so"));
    const auto replay = command({"replay", path("run.twrec"), other, "--quiet"});
    EXPECT_EQ(replay.code, exit_differs) << replay.text;
    EXPECT_THAT(replay.text, AllOf(HasSubstr("program 'pick_and_place' is another one: crc32 "), HasSubstr("first difference: cycle "),
                                   HasSubstr("axis z: set ")));

    const auto same = command({"replay", path("run.twrec"), "--program", TAKTWERK_BINARY_DIR "/programs/pick_and_place.so", "--quiet"});
    EXPECT_THAT(same.text, HasSubstr("identical: "));
}

TEST_F(ReplayCommand, UntilATimeShowsTheMachineAsItStoodThen) {
    record("demo.yaml", "5s");

    const auto replay = command({"replay", path("run.twrec"), "--until", "3s", "--quiet"});

    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr(", 3.000"));
    EXPECT_THAT(replay.text, HasSubstr("following error"));
    EXPECT_THAT(command({"replay", path("run.twrec"), "--until", "drive_fault", "--quiet"}).text, HasSubstr("was not reached"));
    EXPECT_THAT(command({"replay", path("run.twrec"), "--until", "drive_fault", "--quiet", "--json"}).text, HasSubstr("\"reached\":false"));
    EXPECT_THAT(command({"replay", path("run.twrec"), "--until", "2s", "--quiet", "--json"}).text, HasSubstr("\"reached\":true"));
    for (const char* wrong : {"-1s", "1 s", "1s2", "nan", "drive_faul", "drive fault"}) {
        const auto refused = command({"replay", path("run.twrec"), "--until", wrong, "--quiet"});
        EXPECT_EQ(refused.code, exit_usage) << wrong;
        EXPECT_THAT(refused.text, HasSubstr("is no time such as 12.5s, and no alarm has this name")) << wrong;
    }
    EXPECT_THAT(command({"replay", path("run.twrec"), "--until", "drive_faul"}).text, HasSubstr("did you mean 'drive_fault'?"));
}

// What came once is not written over by a slip of the hand.
TEST_F(ReplayCommand, NothingThatIsReadIsWrittenOver) {
    record("demo.yaml", "2s");
    const auto before = text_of(path("run.twrec"));
    std::filesystem::create_symlink("run.twrec", path("the same"));
    for (const char* name : {"run.twrec", "the same"}) {
        const auto refused = command({"replay", path("run.twrec"), "--trace", path(name)});
        EXPECT_EQ(refused.code, exit_usage) << name;
        EXPECT_THAT(refused.text, HasSubstr("what is to be read")) << name;
    }
    EXPECT_EQ(text_of(path("run.twrec")), before);

    const auto machine = altered("demo.yaml", "cycle: 1 ms", "cycle: 1 ms");
    const auto text = text_of(machine);
    for (const char* option : {"--record", "--trace", "--pcap"})
        EXPECT_EQ(command({"run", machine, "--virtual-time", "--duration", "2s", option, machine}).code, exit_usage) << option;
    EXPECT_EQ(text_of(machine), text);
    const auto twice = command({"run", machine, "--virtual-time", "--duration", "2s", "--trace", path("out"), "--record", path("./out")});
    EXPECT_EQ(twice.code, exit_usage);
    EXPECT_THAT(twice.text, HasSubstr("is the file of --trace already"));
}

TEST_F(ReplayCommand, AMachineFileThatIsGoneIsAskedFor) {
    const auto machine = altered("demo.yaml", "cycle: 1 ms", "cycle: 1 ms");
    (void)command({"run", machine, "--virtual-time", "--duration", "2s", "--quiet", "--record", path("run.twrec")});
    ASSERT_TRUE(std::filesystem::exists(path("run.twrec")));
    std::filesystem::rename(machine, path("moved.yaml"));
    EXPECT_THAT(command({"replay", path("run.twrec")}).text, HasSubstr("taktwerk replay RECORDING MACHINE.yaml"));
    EXPECT_EQ(command({"replay", path("run.twrec"), path("moved.yaml"), "--quiet"}).code, exit_ok);
}

TEST_F(ReplayCommand, WhatIsNoRecordingSaysWhatIsWrong) {
    record("demo.yaml", "3s");
    const auto whole = text_of(path("run.twrec"));
    const auto expect = [&](const std::string& bytes, const std::string& words) {
        std::ofstream(path("bad.twrec"), std::ios::binary) << bytes;
        const auto replay = command({"replay", path("bad.twrec"), "--quiet"});
        EXPECT_EQ(replay.code, exit_bad_file) << replay.text;
        EXPECT_THAT(replay.text, HasSubstr(words));
    };
    expect("time_s,x\n0,1\n", "this is not a recording");
    auto bytes = whole;
    bytes[6] = static_cast<char>(bytes[6] + 1);  // version u16 behind "TWREC" 00h
    expect(bytes, "format");
    bytes = whole;
    bytes[whole.size() / 2] = static_cast<char>(bytes[whole.size() / 2] ^ 0x10);
    expect(bytes, "at byte ");
    expect(whole.substr(0, 30), "the head is cut off");

    // What a killed process leaves is replayed as far as it goes.
    std::ofstream(path("cut.twrec"), std::ios::binary) << whole.substr(0, whole.size() / 2);
    const auto replay = command({"replay", path("cut.twrec"), "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr("the recording has no end"));
}

TEST_F(ReplayCommand, WithWhatWasKeptTheRunBeginsAsItDid) {
    // The second run finds what the first one kept.
    for (const char* name : {"first.twrec", "second.twrec"}) {
        const auto run = command({"run", shipped + "five-drives.yaml", "--virtual-time", "--duration", "6s", "--no-events", "--retain",
                                  path("kept"), "--record", path(name), "--quiet"});
        ASSERT_TRUE(run.code == exit_ok || run.code == exit_alarm) << run.text;
    }
    std::filesystem::remove_all(path("kept"));

    for (const char* name : {"first.twrec", "second.twrec"}) {
        const auto replay = command({"replay", path(name), "--quiet"});
        EXPECT_EQ(replay.code, exit_ok) << name << ": " << replay.text;
        EXPECT_THAT(replay.text, HasSubstr("identical: "));
    }
    EXPECT_THAT(command({"replay", path("second.twrec"), "--show"}).text, HasSubstr("start_file"));
    EXPECT_THAT(command({"replay", path("first.twrec"), "--show"}).text, Not(HasSubstr("start_file")));
    EXPECT_FALSE(std::filesystem::exists(path("kept"))) << "a replay keeps nothing";
}

// Threads, a wake-up that is late, a clock that is nobody's: and yet the same again.
TEST_F(ReplayCommand, ARunInRealTimeIsReplayedInVirtualTime) {
    const auto file = altered("demo.yaml", "lcm: { enabled: true,", "socket: '" + path("socket") + "'\n  lcm: { enabled: false,");
    const auto run = command({"run", file, "--simulate", "--duration", "5s", "--record", path("run.twrec"), "--quiet"});
    ASSERT_TRUE(run.code == exit_ok || run.code == exit_alarm) << run.text;

    const auto replay = command({"replay", path("run.twrec"), "--quiet"});

    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr("identical: "));
    EXPECT_THAT(command({"replay", path("run.twrec"), "--show"}).text, HasSubstr("hook"));
}

}  // namespace
}  // namespace taktwerk::apps
