// A run as a file, and again: the built command on machines of config/machines/ with their programs.

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/exit_code.hpp"
#include "hmi_bridge/socket/client.hpp"
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
    std::size_t parts_ = 0;
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
    const auto moved =
        (std::filesystem::path(machine).parent_path() / "moved.yaml").string();  // beside it: its drives are named from there
    std::filesystem::rename(machine, moved);
    EXPECT_THAT(command({"replay", path("run.twrec")}).text, HasSubstr("taktwerk replay RECORDING MACHINE.yaml"));
    EXPECT_EQ(command({"replay", path("run.twrec"), moved, "--quiet"}).code, exit_ok);
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
    const auto shown = nlohmann::json::parse(command({"replay", path("second.twrec"), "--show", "--json"}).text, nullptr, false);
    ASSERT_TRUE(shown.is_object());
    EXPECT_EQ(shown["end"], "whole");
    EXPECT_GT(shown["records"].get<int>(), 6000) << "one each cycle at least";
    EXPECT_TRUE(std::ranges::any_of(shown["channels"], [](const auto& channel) { return channel["name"] == "start_file"; }));
    EXPECT_THAT(command({"replay", path("first.twrec"), "--show"}).text, Not(HasSubstr("start_file")));
    EXPECT_FALSE(std::filesystem::exists(path("kept"))) << "a replay keeps nothing";
}

// A link to itself is a file that nobody can read. The machine says that its positions are lost; so does the replay, which has no such link.
TEST_F(ReplayCommand, WhatWasKeptAndCouldNotBeReadIsAnAlarmInTheReplayToo) {
    std::filesystem::create_directory(path("kept"));
    for (const char* name : {"retain.0", "retain.1"}) std::filesystem::create_symlink(name, path("kept") + "/" + name);
    const auto run = command({"run", shipped + "five-drives.yaml", "--virtual-time", "--duration", "2s", "--no-events", "--retain",
                              path("kept"), "--record", path("run.twrec")});
    ASSERT_TRUE(run.code == exit_ok || run.code == exit_alarm) << run.text;
    ASSERT_THAT(run.text, HasSubstr("home")) << "the control: it was an alarm";
    std::filesystem::remove_all(path("kept"));

    const auto replay = command({"replay", path("run.twrec"), "--until", "positions_lost"});
    EXPECT_THAT(replay.text, HasSubstr("[positions_lost]"));
    EXPECT_THAT(command({"replay", path("run.twrec"), "--quiet"}).text, HasSubstr("identical: "));
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

// --- in parts, bounded, and what is left of one that was interrupted ---------------------------------------------------------------------

// A second of this machine, which is a block, takes some 140 kB at most.
TEST_F(ReplayCommand, PartsAreReplayedAsOneAndTheDiskIsBounded) {
    const auto run = [&](const std::string& disk) {
        const auto ran = command({"run", shipped + "five-drives.yaml", "--virtual-time", "--duration", "12s", "--no-events", "--record",
                                  path("run.twrec"), "--record-size", "200kB", "--record-disk", disk, "--quiet"});
        std::uint64_t bytes = 0;
        parts_ = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            ++parts_;
            EXPECT_LE(entry.file_size(), 200'000u) << entry.path();
            bytes += entry.file_size();
        }
        EXPECT_LE(bytes, disk == "1GB" ? 1'000'000'000u : 500'000u);
        return ran;
    };
    const auto whole = run("1GB");
    EXPECT_EQ(whole.code, exit_ok) << whole.text;
    EXPECT_GT(parts_, 2u);
    const auto replay = command({"replay", path("run.twrec"), "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, HasSubstr("identical: "));
    EXPECT_THAT(replay.text, Not(HasSubstr("no end")));
    const auto second = command({"replay", path("run.2.twrec"), "--quiet"});
    EXPECT_EQ(second.code, exit_bad_file);
    EXPECT_THAT(second.text, HasSubstr("part 2"));

    for (const auto& entry : std::filesystem::directory_iterator(folder_)) std::filesystem::remove(entry.path());
    const auto bounded = run("500kB");
    EXPECT_EQ(bounded.code, exit_ok) << "it was told to end there";
    EXPECT_THAT(bounded.text, HasSubstr("used up its 500000 bytes"));
    const auto up_to_there = command({"replay", path("run.twrec"), "--quiet"});
    EXPECT_EQ(up_to_there.code, exit_ok) << up_to_there.text;
    EXPECT_THAT(up_to_there.text, AllOf(HasSubstr("identical: "), HasSubstr("--record-disk")));
}

// The disk is full: the machine runs to its end, says so, and what fitted can be replayed. A file system of its own, of half a megabyte.
TEST_F(ReplayCommand, AFullDiskEndsTheRecordingAndNotTheMachine) {
    if (::geteuid() != 0) GTEST_SKIP() << "mounting needs root";
    std::filesystem::create_directories(path("small"));
    Child child({"unshare", "-m", "sh", "-c",
                 "mount -t tmpfs -o size=512k none \"$1\" || exit 99; \"$2\" run \"$3\" --virtual-time --duration 30s --no-events --record "
                 "\"$1/run.twrec\" --quiet; echo \"code $?\"; cp \"$1/run.twrec\" \"$4\"",
                 "sh", path("small"), taktwerk, shipped + "five-drives.yaml", path("run.twrec")});
    const int code = child.wait(120s);
    if (code == 99) GTEST_SKIP() << "this system lets nobody mount: " << child.text();
    EXPECT_EQ(code, 0) << child.text();
    EXPECT_THAT(child.text(), AllOf(HasSubstr("cannot write the recording: No space left on device"),
                                    HasSubstr("code " + std::to_string(exit_bad_file))));
    const auto replay = command({"replay", path("run.twrec"), "--json", "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, AllOf(HasSubstr("\"identical\":true"), HasSubstr("\"complete\":false")));
    EXPECT_LE(std::filesystem::file_size(path("run.twrec")), 512u * 1024u);
    EXPECT_GT(std::filesystem::file_size(path("run.twrec")), 400'000u);
}

// One object a line on standard output, whatever goes wrong, and the exit code that it has without --json.
TEST_F(ReplayCommand, WithJsonAnErrorIsJsonToo) {
    record("demo.yaml", "2s");
    const auto of_standard_output = [&](const std::vector<std::string>& arguments, int code) {
        std::vector<std::string> all{"sh", "-c", "exec \"$@\" 2>/dev/null", "sh", taktwerk, "replay"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        Child child(all);
        EXPECT_EQ(child.wait(120s), code) << child.text();
        const auto json = nlohmann::json::parse(child.text(), nullptr, false);
        EXPECT_TRUE(json.is_object()) << child.text();
        if (!json.is_object()) return std::string{};
        EXPECT_EQ(json.at("ok"), false);
        const auto& error = json.at("errors").at(0);
        EXPECT_FALSE(error.at("what").get<std::string>().empty());
        EXPECT_TRUE(error.contains("subject") && error.contains("remedy"));
        return error.at("code").get<std::string>();
    };
    const auto recording = path("run.twrec");
    std::ofstream(path("no.yaml")) << "machine: [\n";
    EXPECT_EQ(of_standard_output({path("none.twrec"), "--json"}, exit_bad_file), "recording.read");
    EXPECT_EQ(of_standard_output({path("no.yaml"), "--json", "--show"}, exit_bad_file), "recording.not_a_recording");
    EXPECT_EQ(of_standard_output({recording, "--json", "--until", "no_alarm"}, exit_usage), "usage.until");
    EXPECT_EQ(of_standard_output({recording, "--json", "--program", "nobody=x.so"}, exit_usage), "usage.program");
    EXPECT_EQ(of_standard_output({recording, path("gone.yaml"), "--json"}, exit_bad_file), "config.no_file");
    EXPECT_NE(of_standard_output({recording, path("no.yaml"), "--json"}, exit_bad_file), "");
    EXPECT_EQ(of_standard_output({recording, "--json", "--trace", recording}, exit_usage), "usage.output");
    EXPECT_NE(of_standard_output({recording, "--json", "--trace", path("no/folder/x.csv")}, exit_bad_file), "");
}

TEST_F(ReplayCommand, KilledAtAnyInstantAllButTheLastSecondIsThere) {
    const auto file = altered("demo.yaml", "lcm: { enabled: true,", "socket: '" + path("socket") + "'\n  lcm: { enabled: false,");
    for (const auto after : {2600ms, 3100ms, 3450ms}) {
        Child run({taktwerk, "run", file, "--simulate", "--record", path("run.twrec"), "--quiet"});
        EXPECT_EQ(run.wait(after), -1) << run.text();
        run.signal(SIGKILL);
        EXPECT_EQ(run.wait(10s), 128 + SIGKILL);
        const auto replay = command({"replay", path("run.twrec"), "--quiet"});
        EXPECT_EQ(replay.code, exit_ok) << replay.text;
        EXPECT_THAT(replay.text, AllOf(HasSubstr("identical: "), HasSubstr("the recording has no end")));
        std::filesystem::remove(path("run.twrec"));
    }
}

// --- nobody was recording ------------------------------------------------------------------------------------------------------------------

/// The only file of this ending in a folder.
std::string only_file(const std::string& folder, const std::string& ending) {
    std::vector<std::string> found;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ending) found.push_back(entry.path());
    EXPECT_EQ(found.size(), 1u) << "files " << ending << " in " << folder;
    return found.empty() ? std::string{} : found.front();
}

TEST_F(ReplayCommand, BehindAnAlarmInVirtualTimeTheRunIsThere) {
    const auto run = command({"run", shipped + "demo.yaml", "--virtual-time", "--duration", "22s", "--recordings", path("kept")});
    ASSERT_TRUE(run.code == exit_ok || run.code == exit_alarm) << run.text;

    const auto file = only_file(path("kept"), ".twrec");

    EXPECT_THAT(run.text, HasSubstr("taktwerk replay " + file));
    const auto replay = command({"replay", file, "--until", "drive_fault", "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, AllOf(HasSubstr("identical: "), HasSubstr("alarm axis y: "), Not(HasSubstr("was not reached"))));
    EXPECT_EQ(command({"replay", file, "--quiet"}).code, exit_ok);
}

/// A machine in real time with folders of its own. Its emergency stop comes after 4 s.
class KeptRun : public ReplayCommand {
protected:
    [[nodiscard]] std::string machine(const std::string& recording) const {
        auto text = text_of(altered("demo.yaml", "lcm: { enabled: true,", "socket: '" + path("socket") + "'\n  lcm: { enabled: false,"));
        const std::string was = "at: 13 s, input: estop_ok";
        const auto at = text.find(was);
        EXPECT_NE(at, std::string::npos);
        if (at != std::string::npos) text.replace(at, was.size(), "at: 4 s, input: estop_ok");
        if (!recording.empty()) text += "recording: {" + recording + "}\n";
        std::ofstream(path("machines/demo.yaml")) << text;
        return path("machines/demo.yaml");
    }
    Outcome ask(std::vector<std::string> words) const {
        words.insert(words.end(), {"-s", path("socket")});
        return command(std::move(words));
    }
};

TEST_F(KeptRun, BehindAnAlarmInRealTimeItIsThereAndReplayedIdentically) {
    Child run({taktwerk, "run", machine(""), "--simulate", "--duration", "9s", "--recordings", path("kept")});
    ASSERT_TRUE(run.says("can be replayed", 20s)) << run.text();
    EXPECT_NE(run.wait(30s), -1) << run.text();

    const auto file = only_file(path("kept"), ".twrec");

    EXPECT_THAT(run.text(), HasSubstr("taktwerk replay " + file));
    const auto replay = command({"replay", file, "--until", "emergency_stop", "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, AllOf(HasSubstr("identical: "), Not(HasSubstr("was not reached"))));
    EXPECT_EQ(command({"replay", file, "--quiet"}).code, exit_ok);
}

// "It just happened again", and no alarm came: somebody asks for it. What people asked of drives and of the bus meanwhile is in it.
TEST_F(KeptRun, IsThereWhenSomebodyAsksWithWhatPeopleAskedOfDrivesAndBus) {
    Child run({taktwerk, "run", machine(""), "--simulate", "--no-events", "--recordings", path("kept")});
    ASSERT_TRUE(run.says("running, ", 30s)) << run.text();
    EXPECT_THAT(ask({"record", "status"}).text, HasSubstr("in memory"));
    const auto read = ask({"drive", "get", "x", "P05.13"});
    EXPECT_EQ(read.code, exit_ok) << read.text;
    EXPECT_EQ(ask({"mode", "manual"}).code, exit_ok);
    const auto written = ask({"drive", "set", "x", "P05.13=300"});
    EXPECT_EQ(written.code, exit_ok) << written.text;
    const auto again = ask({"drive", "get", "x", "P05.13"});
    EXPECT_THAT(again.text, HasSubstr("= 300"));
    {  // as the page asks for the tree of its slaves
        auto client = hmi::Client::connect(path("socket"));
        ASSERT_TRUE(client.ok()) << client.error().text();
        const auto bus = client->request({{"cmd", "bus"}});
        ASSERT_TRUE(bus.ok()) << bus.error().text();
        EXPECT_TRUE(bus->at("bus").at("tree_known").get<bool>());
    }

    const auto kept = ask({"record", "keep"});

    ASSERT_EQ(kept.code, exit_ok) << kept.text;
    const auto file = only_file(path("kept"), ".twrec");
    EXPECT_THAT(kept.text, HasSubstr("taktwerk replay " + file));
    EXPECT_THAT(command({"replay", file, "--show"}).text, HasSubstr("asked"));
    const auto replay = command({"replay", file, "--quiet"});
    EXPECT_EQ(replay.code, exit_ok) << replay.text;
    EXPECT_THAT(replay.text, AllOf(HasSubstr("identical: "), HasSubstr("kept while the machine ran on")));
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(30s), exit_ok) << run.text();
}

TEST_F(KeptRun, IsNotTakenWhereTheMachineFileSaysSo) {
    Child run({taktwerk, "run", machine("replay: false"), "--simulate", "--no-events", "--recordings", path("kept")});
    ASSERT_TRUE(run.says("running, ", 30s)) << run.text();
    const auto refused = ask({"record", "keep"});
    EXPECT_EQ(refused.code, exit_refused) << refused.text;
    EXPECT_THAT(refused.text, HasSubstr("this run is not recorded"));
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(30s), exit_ok) << run.text();
}

}  // namespace
}  // namespace taktwerk::apps
