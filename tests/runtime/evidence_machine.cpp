// What is written around an alarm, against what an own tap saw on the same wire.

#include "runtime/evidence/evidence.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "ecat/alarms.hpp"
#include "runtime/alarms.hpp"
#include "tests/ecat/wire/captures.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::machine_config;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::TestMachine;
namespace fs = std::filesystem;

struct Evident : ::testing::Test {
    Evident() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-test-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~Evident() override {
        std::error_code ignored;
        fs::permissions(folder, fs::perms::owner_all, ignored);
        fs::remove_all(folder, ignored);
    }
    void start(MachineConfig config = machine_config(2)) {
        config.evidence.directory = (folder / "evidence").string();
        machine = std::make_unique<TestMachine>(std::move(config));
        auto opened = Evidence::open(*machine->machine, epoch);
        ASSERT_TRUE(opened) << opened.error().text();
        evidence = std::move(*opened);
        machine->machine->bus().set_tap(&Evident::tap, this);
        ASSERT_TRUE(machine->up());
    }
    static void tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept {
        auto& self = *static_cast<Evident*>(context);
        self.seen.push_back({at, {frame.begin(), frame.end()}});
        ecat::FrameMemory::tap(&self.evidence->frames(), frame, at, outgoing);
    }
    void run(Duration time) {
        for (Duration t{}; t < time; t += 10ms) {
            machine->run(10ms);
            evidence->look(machine->state());
            const auto file = evidence->write_due(machine->clock.now());
            if (!file) errors.push_back(file.error());
            else if (!file->path.empty()) files.push_back(*file);
        }
    }
    void power_slave(std::size_t position, bool on) { machine->world.network().set_power(position, on); }
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder / "evidence")) all.push_back(entry.path().filename().string());
        std::sort(all.begin(), all.end());
        return all;
    }
    static std::string text_of(const std::string& path) {
        const auto bytes = ecat::test::read_file(path);
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
    static std::size_t times(const std::string& text, const std::string& part) {
        std::size_t count = 0;
        for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
        return count;
    }

    struct Seen {
        Instant at;
        std::vector<std::byte> bytes;
    };
    static constexpr Duration epoch = std::chrono::hours{24 * 365};  // 1971-01-01
    fs::path folder;
    std::unique_ptr<TestMachine> machine;
    std::unique_ptr<Evidence> evidence;
    std::vector<Seen> seen;
    std::vector<Evidence::File> files;
    std::vector<Error> errors;
};

TEST_F(Evident, ALostSlaveLeavesTheFramesAroundItWithTheAlarmAtItsFrame) {
    start();
    run(2s);
    EXPECT_THAT(files, IsEmpty()) << "nothing has happened";
    const auto cut = machine->clock.now();
    power_slave(0, false);
    run(3s);
    ASSERT_THAT(files, SizeIs(1)) << machine->alarms();
    EXPECT_THAT(errors, IsEmpty());
    const auto& file = files[0];
    EXPECT_THAT(names(), ElementsAre(fs::path(file.path).filename().string()));
    EXPECT_THAT(names()[0], StartsWith("test-19710101T0000")) << "calendar time of the first alarm";

    // Exactly what was on the wire, from then until a second after.
    const auto packets = ecat::test::read_pcapng(file.path);
    ASSERT_EQ(packets.size(), file.frames);
    const auto first = std::search(seen.begin(), seen.end(), packets.begin(), packets.end(),
                                   [](const Seen& s, const std::vector<std::byte>& packet) { return s.bytes == packet; });
    ASSERT_NE(first, seen.end());
    const auto last = first + static_cast<std::ptrdiff_t>(packets.size()) - 1;
    EXPECT_LE(first->at, cut - 1s) << "what was before";
    EXPECT_GE(last->at, cut + Evidence::after);
    EXPECT_EQ(file.covered, last->at - first->at);

    // In the head and once at a frame, with what it means.
    const auto text = text_of(file.path);
    const auto head = text.substr(28, text.find("taktwerk") - 28);
    EXPECT_THAT(head, StartsWith("machine 'test': "));
    EXPECT_THAT(head, HasSubstr("frames_lost")) << "the first slave is the way to all of them";
    EXPECT_THAT(head, HasSubstr("\nwhy: "));
    EXPECT_THAT(head, HasSubstr("\n-> "));
    EXPECT_GE(file.alarms, 1u);
    EXPECT_EQ(times(text, "ALARM "), file.alarms) << "each at its frame";
}

TEST_F(Evident, TroubleAgainAndAgainFillsNoDisk) {
    auto config = machine_config(1);
    config.evidence.files = 2;
    start(std::move(config));
    fs::create_directories(folder / "evidence");
    std::ofstream(folder / "evidence" / "test-notes.pcapng") << "mine";
    std::ofstream(folder / "evidence" / "test-19700101T000000.000-other.pcapng") << "an old one";
    run(1s);
    for (int i = 0; i < 12; ++i) {
        power_slave(0, false);
        run(2s);
        power_slave(0, true);
        run(3s);
        (void)machine->command(OperatorAction::reset);
    }
    // 60 s, a trouble each 5 s, a file each 10 s at most.
    EXPECT_GE(files.size(), 4u);
    EXPECT_LE(files.size(), 7u);
    for (std::size_t i = 1; i < files.size(); ++i) EXPECT_GE(files[i].alarms, 2u) << "what came meanwhile stands in the next";
    const auto kept = names();
    ASSERT_THAT(kept, SizeIs(3));
    EXPECT_EQ(kept[0], fs::path(files[files.size() - 2].path).filename().string());
    EXPECT_EQ(kept[1], fs::path(files.back().path).filename().string());
    EXPECT_EQ(kept[2], "test-notes.pcapng") << "what it did not write it does not remove";
}

TEST_F(Evident, AStopThatSomebodyPressedLeavesNone) {
    start();
    run(1s);
    auto snapshot = machine->state();
    snapshot.alarm_count = 1;
    auto& alarm = snapshot.alarms[0];
    alarm = {{id(MachineAlarm::emergency_stop), AlarmSource::machine, 0, 0, 0}, machine->clock.now(), 1, true, false, Reaction::power_off};
    evidence->look(snapshot);
    alarm.fact = {id(MachineAlarm::late_wakeups), AlarmSource::machine, 0, 0, 0};
    alarm.reaction = Reaction::warn;
    evidence->look(snapshot);
    const auto none = evidence->finish();
    ASSERT_TRUE(none);
    EXPECT_EQ(none->path, "");
    alarm.fact = {id(MachineAlarm::emergency_stop), AlarmSource::machine, 0, emergency_stop_unread, 0};
    alarm.reaction = Reaction::power_off;
    evidence->look(snapshot);
    const auto unread = evidence->finish();
    ASSERT_TRUE(unread) << unread.error().text();
    EXPECT_THAT(unread->path, HasSubstr("emergency_stop")) << "nobody pressed that one";
}

// The end of a run is not waited for.
TEST_F(Evident, WhatWasNotWrittenYetIsWrittenAtTheEnd) {
    start();
    run(1s);
    power_slave(0, false);
    run(100ms);
    EXPECT_THAT(files, IsEmpty());
    const auto last = evidence->finish();
    ASSERT_TRUE(last) << last.error().text();
    EXPECT_GT(last->frames, 100u);
    EXPECT_THAT(names(), SizeIs(1));
    EXPECT_EQ(evidence->finish()->path, "") << "once";
}

TEST_F(Evident, AFolderThatIsGoneCostsThatFileAndNoMore) {
    start();
    run(1s);
    fs::remove_all(folder / "evidence");
    power_slave(0, false);
    run(2s);
    ASSERT_THAT(errors, SizeIs(1));
    EXPECT_EQ(errors[0].code, "capture.write");
    EXPECT_THAT(errors[0].text(), HasSubstr("evidence"));
    fs::create_directories(folder / "evidence");
    power_slave(0, true);
    run(5s);
    (void)machine->command(OperatorAction::reset);
    run(5s);
    power_slave(0, false);
    run(3s);
    EXPECT_THAT(errors, SizeIs(1));
    EXPECT_THAT(files, SizeIs(1));
}

TEST_F(Evident, AFolderThatCannotBeIsRefusedBeforeAnythingMoves) {
    auto config = machine_config(1);
    std::ofstream(folder / "file") << "no folder";
    config.evidence.directory = (folder / "file").string();
    const TestMachine m{config};
    const auto opened = Evidence::open(*m.machine, {});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, "evidence.directory");
    EXPECT_THAT(opened.error().text(), HasSubstr("file"));
}

}  // namespace
}  // namespace taktwerk::runtime
