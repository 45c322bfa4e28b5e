// Behind an alarm that stops something the run is there as a file, and drives its machine again; whatever it costs is bounded.
#include "runtime/run_memory/run_memory.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include <gmock/gmock.h>

#include "runtime/recording/inbox_record.hpp"
#include "runtime/replay/recording_head.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using testing::machine_config;
using testing::TestMachine;
namespace fs = std::filesystem;

class RunOfAMachine : public ::testing::Test {
protected:
    RunOfAMachine() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-run-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~RunOfAMachine() override {
        std::error_code ignored;
        fs::permissions(folder, fs::perms::owner_all, ignored);
        fs::remove_all(folder, ignored);
    }

    /// A machine whose run is in memory, up and with power.
    void start(RunMemory::Room room, Duration epoch = 1'000'000s) {
        machine = std::make_unique<TestMachine>(machine_config(2));
        auto& m = *machine->machine;
        machine->replayed.leave_out();
        const auto began = machine->clock.now();
        auto opened =
            RunMemory::open(recording_info(m.config(), began, RecordedThreads::one), {m.config().name, folder, began, epoch, 500ms}, room);
        ASSERT_TRUE(opened.ok()) << opened.error().text();
        memory = std::move(*opened);
        packer = RecordPacker{tick_channel};
        newest = began;
        recorder = std::make_unique<Recorder>(std::size_t{16} << 20, Recorder::Policy::drop_newest);
        m.record(*recorder, RecordedThreads::one);
        machine->runner->drain = [this] { drain(); };
        ASSERT_TRUE(machine->up());
        machine->enable(0);
        machine->enable(1);
    }
    /// As apps/machine/machine_recording.cpp does it, with blocks of 100 ms.
    void drain() {
        recorder->drain([this](const RecordView& record) {
            if (packer.records() == 0) block_began = record.time;
            packer.add(record);
            newest = std::max(newest, record.time);
            if (record.time - block_began >= 100ms) take();
        });
        if (const auto* snapshot = machine->machine->latest(); snapshot != nullptr)
            memory->look(*snapshot, [this](const AlarmFact& fact) { return machine->machine->describe(fact).name; });
        note(memory->work());
        most_memory = std::max(most_memory, memory->state().memory);
    }
    void take() {
        const auto records = packer.records();
        if (records > 0) memory->take({packer.take(), records}, newest, recorder->dropped());
    }
    void finish() {
        take();
        note(memory->work());
        note(memory->finish());
    }
    void note(const Result<RunMemory::Kept>& came) {
        if (!came) errors.push_back(came.error());
        else if (!came->path.empty()) kept.push_back(*came);
    }
    void drive_fault(const char* axis) {
        machine->world.happen({.kind = SimulationEvent::Kind::drive_fault, .target = axis, .value = 0x7121});
    }
    void expect_identical(const std::string& path, std::uint64_t at_least) const {
        auto reader = RecordingReader::open(path);
        ASSERT_TRUE(reader.ok()) << reader.error().text();
        EXPECT_EQ((*reader)->end(), RecordingEnd::kept);
        auto made = Replay::make(machine_config(2), **reader);
        ASSERT_TRUE(std::holds_alternative<std::unique_ptr<Replay>>(made)) << std::get<1>(made).front().text();
        auto& replay = *std::get<0>(made);
        auto step = Replay::Step::more;
        while (step == Replay::Step::more) step = replay.step();
        EXPECT_EQ(step, Replay::Step::ended) << (replay.difference() ? replay.difference()->text(replay.start()) : replay.error()->text());
        EXPECT_GE(replay.cycles(), at_least);
    }
    [[nodiscard]] std::set<std::string> files() const {
        std::set<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder)) all.insert(entry.path().filename().string());
        return all;
    }
    [[nodiscard]] std::uint64_t bytes_there() const {
        std::uint64_t all = 0;
        for (const auto& entry : fs::directory_iterator(folder)) all += entry.file_size();
        return all;
    }

    static constexpr RunMemory::Room plenty{10'000'000, 100'000'000, 20};
    std::string folder;
    std::unique_ptr<Recorder> recorder;
    std::unique_ptr<RunMemory> memory;
    RecordPacker packer{tick_channel};
    Instant block_began{}, newest{};
    std::vector<RunMemory::Kept> kept;
    std::vector<Error> errors;
    std::uint64_t most_memory = 0;
    std::unique_ptr<TestMachine> machine;
};

TEST_F(RunOfAMachine, BehindAStoppingAlarmItIsAFileThatIsReplayedIdentically) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(1s);
    EXPECT_TRUE(files().empty()) << "nothing stopped anything yet";
    drive_fault("x");
    machine->run(400ms);
    EXPECT_TRUE(kept.empty()) << "what is behind the alarm is still to come";
    machine->run(400ms);

    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept[0].why, "drive_fault");
    EXPECT_THAT(kept[0].path, HasSubstr("drive_fault.twrec"));
    const auto cycles = machine->state().statistics.cycles;
    expect_identical(kept[0].path, cycles - 300);

    // The same run, another alarm: the same file, and longer.
    const auto bytes = fs::file_size(kept[0].path);
    drive_fault("y");
    machine->run(1s);
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[1].path, kept[0].path);
    EXPECT_GT(fs::file_size(kept[0].path), bytes);
    expect_identical(kept[0].path, cycles + 500);
    EXPECT_EQ(files().size(), 1u);
    EXPECT_TRUE(errors.empty());
}

TEST_F(RunOfAMachine, WithoutAnAlarmNothingIsLeftAndOnDemandThereIs) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(500ms);
    finish();
    EXPECT_TRUE(files().empty());

    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(500ms);
    const auto path = memory->keep(machine->clock.now());
    ASSERT_TRUE(path.ok());
    EXPECT_TRUE(memory->state().waits);
    machine->run(200ms);
    EXPECT_FALSE(memory->state().waits);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept[0].path, *path);
    expect_identical(*path, 400);
}

// The memory stays as small as it was told; the run is whole all the same.
TEST_F(RunOfAMachine, WhatTheMemoryDoesNotHoldIsOnTheDiskAndGoesIfNobodyWantsIt) {
    constexpr RunMemory::Room small{2'000, 100'000'000, 20};
    ASSERT_NO_FATAL_FAILURE(start(small));
    machine->run(5s);
    EXPECT_LT(most_memory, 2'000u + 20'000u) << "the limit and a block";
    ASSERT_EQ(files().size(), 1u);
    EXPECT_THAT(*files().begin(), HasSubstr(".twrec.part"));
    drive_fault("x");
    machine->run(1s);
    ASSERT_EQ(kept.size(), 1u);
    expect_identical(kept[0].path, 5'500);

    ASSERT_NO_FATAL_FAILURE(start(small));
    machine->run(3s);
    EXPECT_EQ(files().size(), 2u);
    finish();
    EXPECT_EQ(files().size(), 1u) << "of the first run";
}

TEST_F(RunOfAMachine, ARunLongerThanItsRoomIsSaidOnceAndKeepsWhatItHas) {
    constexpr RunMemory::Room room{1'000, 30'000, 20};
    ASSERT_NO_FATAL_FAILURE(start(room));
    drive_fault("x");
    machine->run(1s);
    ASSERT_EQ(kept.size(), 1u);
    machine->run(60s);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].code, "recording.limit");
    EXPECT_LE(bytes_there(), 30'000u);
    EXPECT_EQ(memory->state().memory, 0u);
    EXPECT_EQ(memory->keep(machine->clock.now()).error().code, "recording.ended");
    // An alarm that comes now: it is said that it cannot be replayed.
    drive_fault("y");
    machine->run(1s);
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[1].code, "recording.ended");
    EXPECT_EQ(errors[1].subject, "drive_fault");
    EXPECT_EQ((*RecordingReader::open(kept[0].path))->end(), RecordingEnd::limit);
}

TEST_F(RunOfAMachine, OfEarlierRunsTheOldestGo) {
    constexpr RunMemory::Room two{10'000'000, 100'000'000, 2};
    for (int run = 1; run <= 3; ++run) {
        ASSERT_NO_FATAL_FAILURE(start(two, run * 1'000'000s));
        drive_fault("x");
        machine->run(1s);
    }
    ASSERT_EQ(kept.size(), 3u);
    EXPECT_EQ(files(), (std::set<std::string>{fs::path(kept[1].path).filename(), fs::path(kept[2].path).filename()}));
    // The same by their bytes.
    const RunMemory::Room one_and_a_half{10'000'000, bytes_there() * 3 / 4, 20};
    ASSERT_NO_FATAL_FAILURE(start(one_and_a_half, 4'000'000s));
    drive_fault("x");
    machine->run(1s);
    ASSERT_EQ(kept.size(), 4u);
    EXPECT_EQ(files(), (std::set<std::string>{fs::path(kept[3].path).filename()}));
}

TEST_F(RunOfAMachine, AFolderThatIsGoneCostsTheReplayAndNoMore) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    fs::remove_all(folder);
    drive_fault("x");
    machine->run(2s);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].code, "recording.write");
    EXPECT_EQ(machine->state().phase, MachinePhase::running);
    EXPECT_EQ(memory->state().memory, 0u);
}

// What came before a loss is whole; what comes behind it is not.
TEST_F(RunOfAMachine, LostRecordsAreSaidAndWhatCameBeforeThemIsKeptForWhoAsks) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(400ms);
    memory->take({}, newest, 3);
    machine->run(200ms);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].code, "recording.lost");
    EXPECT_TRUE(kept.empty());
    EXPECT_TRUE(files().empty()) << "nobody has asked";

    const auto answer = memory->keep(machine->clock.now());
    ASSERT_FALSE(answer.ok());
    EXPECT_EQ(answer.error().code, "recording.ended");
    machine->run(100ms);
    ASSERT_EQ(files().size(), 1u);
    const auto path = folder + "/" + *files().begin();
    EXPECT_THAT(answer.error().remedy, HasSubstr(path));
    ASSERT_EQ(errors.size(), 2u);
    EXPECT_EQ(errors[1].code, "recording.ended") << "that moment is not in it";
    EXPECT_THAT(errors[1].remedy, HasSubstr(path));
    expect_identical(path, 300);

    drive_fault("x");
    machine->run(1s);
    EXPECT_EQ(errors.size(), 3u);
    EXPECT_EQ(files().size(), 1u) << "nothing more comes of it";
}

TEST_F(RunOfAMachine, AnAlarmBeforeALossCanBeReplayed) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(200ms);
    drive_fault("x");
    machine->run(300ms);
    ASSERT_TRUE(kept.empty()) << "the half second behind it is not over";
    memory->take({}, newest, 3);
    machine->run(10ms);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept[0].why, "drive_fault");
    expect_identical(kept[0].path, 300);
}

// What is asked for is there at once, also while what comes behind an alarm is awaited.
TEST_F(RunOfAMachine, WhoAsksDoesNotWaitForWhatComesBehindAnAlarm) {
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    machine->run(200ms);
    drive_fault("x");
    machine->run(50ms);
    EXPECT_FALSE(memory->state().asked_waits);
    ASSERT_TRUE(memory->keep(machine->clock.now()).ok());
    EXPECT_TRUE(memory->state().asked_waits);
    machine->run(150ms);
    ASSERT_EQ(kept.size(), 1u);
    EXPECT_EQ(kept[0].why, "") << "asked for";
    EXPECT_FALSE(memory->state().asked_waits);
    EXPECT_TRUE(memory->state().waits) << "what comes behind the alarm";
    machine->run(500ms);
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[1].why, "drive_fault");
    EXPECT_EQ(kept[1].path, kept[0].path);
    EXPECT_GE(kept[1].covered - kept[0].covered, 300ms);
}

TEST_F(RunOfAMachine, WhatAKilledRunLeftUnfinishedGoesAndOtherFilesStay) {
    const std::set<std::string> others{"notes.part", "other-20261126T101010.100-run.twrec.part"};
    for (const auto& name : others) std::ofstream(folder + "/" + name) << "x";
    const auto mine = machine_config(2).name + "-20261126T101010.100-run.twrec.part";
    std::ofstream(folder + "/" + mine) << "x";
    ASSERT_NO_FATAL_FAILURE(start(plenty));
    EXPECT_EQ(files(), others);
}

}  // namespace
}  // namespace taktwerk::runtime
