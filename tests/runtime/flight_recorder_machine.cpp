// Around each stopping alarm the seconds before and after are kept, to the last bit as the cycle had them; nothing that a disk does stops more
// than a file.
#include "runtime/flight/flight_recorder.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <map>

#include "runtime/recording/cycle_at.hpp"
#include "runtime/recording/row_cursor.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::machine_config;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::TestMachine;
namespace fs = std::filesystem;

class Flight : public ::testing::Test {
protected:
    Flight() {
        auto pattern = (fs::temp_directory_path() / "taktwerk-flight-XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~Flight() override {
        std::error_code ignored;
        fs::permissions(folder, fs::perms::owner_all, ignored);
        fs::remove_all(folder, ignored);
    }
    static MachineConfig short_one() {
        auto config = machine_config(2);
        config.recording.depth = 5s;
        config.recording.before = 1s;
        config.recording.after = 500ms;
        return config;
    }
    void start(MachineConfig config = short_one()) {
        machine = std::make_unique<TestMachine>(std::move(config));
        rows.clear();
        traced = 0;
        open();
        trace = std::make_unique<RowCursor>(machine->machine->signals());
        machine->on_cycle = [this] {
            for (auto row = trace->next(); !row.empty(); row = trace->next()) rows[++traced].assign(row.begin(), row.end());
        };
        ASSERT_TRUE(machine->up());
        machine->enable(0);
        machine->enable(1);
    }
    void open() {
        auto opened = FlightRecorder::open(*machine->machine, (folder / "recordings").string(), epoch);
        ASSERT_TRUE(opened) << opened.error().text();
        recorder = std::move(*opened);
    }
    /// Service side and writer each 10 ms.
    void run(Duration time) {
        for (Duration t{}; t < time; t += 10ms) {
            machine->run(10ms);
            recorder->look(machine->state());
            take(recorder->work());
        }
    }
    void take(const Result<FlightRecorder::File>& file) {
        if (!file) errors.push_back(file.error());
        else if (!file->path.empty()) files.push_back(*file);
    }
    void fault(const char* axis) { machine->world.drive(axis)->raise(0x3130); }
    void clear(std::uint16_t axis) {
        EXPECT_TRUE(machine->until([&] { return machine->axis(axis).state == axes::AxisState::ErrorStop; }, 2s));
        (void)machine->command(OperatorAction::reset, axis);
        EXPECT_TRUE(machine->until([&] { return machine->axis(axis).state != axes::AxisState::ErrorStop; }, 2s)) << machine->alarms();
    }
    [[nodiscard]] std::vector<std::string> names() const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder / "recordings")) all.push_back(entry.path().filename().string());
        std::sort(all.begin(), all.end());
        return all;
    }
    /// Each row of the recording is the trace's of that cycle.
    void expect_as_traced(const KeptRows& kept) {
        std::vector<std::uint16_t> words(kept.words());
        for (std::size_t w = 0; w < words.size(); ++w) words[w] = static_cast<std::uint16_t>(w);
        std::vector<std::uint64_t> row(kept.words());
        for (auto c = kept.span().first; c <= kept.span().last; ++c) {
            ASSERT_EQ(kept.read(c, c + 1, words, row), c);
            ASSERT_EQ(row, rows.at(c)) << "cycle " << c;
        }
    }

    static constexpr Duration epoch = std::chrono::hours{24 * 365};  // 1971-01-01
    fs::path folder;
    std::unique_ptr<TestMachine> machine;
    std::unique_ptr<RowCursor> trace;
    std::map<std::uint64_t, std::vector<std::uint64_t>> rows;  // by cycle
    std::uint64_t traced = 0;
    std::unique_ptr<FlightRecorder> recorder;
    std::vector<FlightRecorder::File> files;
    std::vector<Error> errors;
};

TEST_F(Flight, AStoppingAlarmLeavesExactlyTheRowsOfTheTraceAroundIt) {
    start();
    run(2s);
    EXPECT_THAT(files, IsEmpty()) << "nothing has happened";
    fault("y");
    run(300ms);
    ASSERT_THAT(recorder->kept(), SizeIs(1));
    EXPECT_FALSE(recorder->kept()[0].complete) << "its last seconds are still to come";
    EXPECT_THAT(files, IsEmpty());
    const auto& alarm = machine->state().alarms[0];
    const auto name = recorder->recording_of(alarm.fact, alarm.since);
    EXPECT_EQ(name, recorder->kept()[0].name);
    EXPECT_EQ(recorder->rows(name)->error().code, "recording.not_yet");
    const auto standing = alarm;  // the snapshot goes on
    run(1s);

    ASSERT_THAT(files, SizeIs(1)) << machine->alarms();
    EXPECT_THAT(errors, IsEmpty());
    const auto kept = read_scope_file(files[0].path);
    ASSERT_TRUE(kept.ok()) << kept.error().text();
    const auto& head = kept->head();
    EXPECT_EQ(fs::path(files[0].path).stem().string(), name);
    EXPECT_THAT(name, StartsWith("test-19710101T0000")) << "calendar time of the alarm";
    EXPECT_EQ(head.alarms[0].name, machine->machine->describe(standing.fact).name);
    EXPECT_EQ(head.alarms[0].source, "axis y");
    // The cycle in which it was raised, by its time; a second before, half a second behind.
    const auto alarm_cycle = head.alarms[0].cycle;
    EXPECT_EQ(rows.at(alarm_cycle)[0], static_cast<std::uint64_t>(standing.since.time_since_epoch().count()));
    EXPECT_EQ(kept->span().first, alarm_cycle - 1000);
    EXPECT_EQ(kept->span().last, head.alarms.back().cycle + 500 - 1);
    EXPECT_FALSE(head.cut);
    EXPECT_EQ(kept->signals(), machine->machine->signals().signals());
    expect_as_traced(*kept);
    // And the alarm is in it: the drive's error comes at that cycle.
    const auto* error = kept->find("y.drive_error");
    EXPECT_EQ(kept->value(*error, alarm_cycle - 1), 0);
    EXPECT_EQ(kept->value(*error, alarm_cycle), 0x3130);
    const auto listed = recorder->kept()[0];
    EXPECT_TRUE(listed.complete);
    EXPECT_EQ(listed.alarm_cycle, alarm_cycle);
    EXPECT_EQ(listed.from, alarm_cycle - 1000);
    EXPECT_EQ(listed.bytes, fs::file_size(files[0].path));
}

// An alarm while the recording of another is being finished: each has all of its seconds.
TEST_F(Flight, AnAlarmBehindAnotherHasARecordingOfItsOwnAndOnesTogetherShareIt) {
    auto config = short_one();
    config.recording.after = 1s;
    start(std::move(config));
    run(1500ms);
    fault("x");
    run(700ms);  // more than `together`, less than `after`
    fault("y");
    run(1500ms);
    ASSERT_THAT(files, SizeIs(2)) << machine->alarms();
    const auto first = read_scope_file(files[0].path), second = read_scope_file(files[1].path);
    ASSERT_TRUE(first.ok() && second.ok());
    EXPECT_EQ(first->head().alarms[0].source, "axis x");
    EXPECT_EQ(second->head().alarms[0].source, "axis y");
    EXPECT_FALSE(first->head().cut || second->head().cut);
    EXPECT_GT(first->span().last, second->span().first) << "they overlap";
    expect_as_traced(*first);
    expect_as_traced(*second);

    clear(0);
    clear(1);
    run(1s);
    fault("x");
    run(100ms);
    fault("y");
    run(1500ms);
    ASSERT_THAT(files, SizeIs(3));
    const auto both = read_scope_file(files[2].path);
    ASSERT_TRUE(both.ok());
    std::vector<std::string> sources;
    for (const auto& alarm : both->head().alarms) sources.push_back(alarm.source);
    EXPECT_THAT(sources, ::testing::Contains("axis x"));
    EXPECT_THAT(sources, ::testing::Contains("axis y"));
    EXPECT_GE(both->span().last + 1, both->head().alarms.back().cycle + 1000) << "the last one has its second too";
}

TEST_F(Flight, AnAlarmAtTheBeginningHasWhatThereWas) {
    start();
    fault("x");
    run(1s);
    ASSERT_THAT(files, SizeIs(1));
    const auto kept = read_scope_file(files[0].path);
    ASSERT_TRUE(kept.ok());
    EXPECT_EQ(kept->span().first, 1u);
    EXPECT_FALSE(kept->head().cut) << "there was no more";
}

TEST_F(Flight, OnlyTheNewestAreKeptAndOtherFilesAreLeftAlone) {
    auto config = short_one();
    config.recording.files = 2;
    fs::create_directories(folder / "recordings");
    std::ofstream(folder / "recordings" / "notes.twscope") << "mine";
    std::ofstream(folder / "recordings" / "test-19700101T000000.000-old.twscope.part") << "of a process that was killed";
    start(std::move(config));
    EXPECT_THAT(names(), ::testing::ElementsAre("notes.twscope"));
    for (int i = 0; i < 3; ++i) {
        fault("x");
        run(1s);
        clear(0);
    }
    ASSERT_THAT(files, SizeIs(3));
    EXPECT_THAT(names(), SizeIs(3)) << "notes, and two";
    EXPECT_FALSE(fs::exists(files[0].path));
    EXPECT_THAT(recorder->kept(), SizeIs(2));
    EXPECT_GT(recorder->kept()[0].alarm_cycle, recorder->kept()[1].alarm_cycle) << "newest first";

    // After a restart they are still there.
    const auto before = recorder->kept();
    open();
    const auto again = recorder->kept();
    ASSERT_THAT(again, SizeIs(2));
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(again[i].name, before[i].name);
        EXPECT_EQ(again[i].from, before[i].from);
        EXPECT_EQ(again[i].to, before[i].to);
        EXPECT_EQ(again[i].alarm_cycle, before[i].alarm_cycle);
        EXPECT_EQ(again[i].utime, before[i].utime);
        EXPECT_TRUE(again[i].complete);
    }
}

// A computer whose clock has lost its battery: what it keeps now is newer than what bears a later date.
TEST_F(Flight, AClockThatWasSetBackLosesNoNewRecording) {
    auto config = short_one();
    config.recording.files = 2;
    fs::create_directories(folder / "recordings");
    for (const auto* kept :
         {"test-20260101T000000.000-a.twscope", "test-20260101T000000.001-b.twscope", "test-19700201T000000.000-c.twscope"})
        std::ofstream(folder / "recordings" / kept) << "of another time";
    start(std::move(config));
    fault("x");
    run(1s);
    ASSERT_THAT(files, SizeIs(1));
    EXPECT_THAT(names(), ::testing::ElementsAre("test-19700201T000000.000-c.twscope", fs::path(files[0].path).filename().string()))
        << "those of the future are the oldest";
    EXPECT_THAT(recorder->kept(), SizeIs(1));
    clear(0);
    fault("x");
    run(1s);
    ASSERT_THAT(files, SizeIs(2));
    EXPECT_TRUE(fs::exists(files[0].path) && fs::exists(files[1].path));
    EXPECT_THAT(names(), SizeIs(2));
}

TEST_F(Flight, ALoadedOneIsTheFileAndANameIsNoPath) {
    start();
    run(1500ms);
    fault("x");
    run(1s);
    ASSERT_THAT(files, SizeIs(1));
    const auto name = recorder->kept()[0].name;
    EXPECT_FALSE(recorder->rows(name).has_value()) << "it is read beside";
    take(recorder->work());
    const auto loaded = recorder->rows(name);
    ASSERT_TRUE(loaded.has_value() && loaded->ok());
    expect_as_traced(***loaded);

    for (const auto* unknown : {"", "notes", "../recordings/x", "/etc/passwd", "test-19710101T000000.000-none"})
        EXPECT_EQ(recorder->rows(unknown)->error().code, "recording.unknown") << unknown;
    // Deleted by somebody, damaged by something: said, and everything goes on.
    std::ofstream(files[0].path) << "rubbish";
    open();
    EXPECT_THAT(recorder->kept(), IsEmpty());
}

TEST_F(Flight, AFolderThatIsGoneCostsThatRecordingAndNoMore) {
    start();
    run(1s);
    fs::remove_all(folder / "recordings");
    fault("x");
    run(1s);
    ASSERT_THAT(errors, SizeIs(1));
    EXPECT_EQ(errors[0].code, "recording.write");
    const auto& alarm = machine->state().alarms[0];
    EXPECT_EQ(recorder->recording_of(alarm.fact, alarm.since), "") << "nobody is sent to what there is not";
    fs::create_directories(folder / "recordings");
    clear(0);
    fault("x");
    run(1s);
    EXPECT_THAT(files, SizeIs(1));
    EXPECT_THAT(errors, SizeIs(1));
}

TEST_F(Flight, ADiskThatComesTooLateHasLostIt) {
    start();
    run(1s);
    fault("x");
    machine->run(20ms);
    recorder->look(machine->state());
    machine->run(20s);  // nobody writes
    take(recorder->work());
    ASSERT_THAT(errors, SizeIs(1));
    EXPECT_EQ(errors[0].code, "recording.too_late");
    EXPECT_THAT(recorder->kept(), IsEmpty());
}

TEST_F(Flight, WhatIsNotFinishedAtTheEndIsWrittenAsFarAsItCame) {
    start();
    run(1500ms);
    fault("x");
    run(100ms);
    take(recorder->finish());
    ASSERT_THAT(files, SizeIs(1));
    const auto kept = read_scope_file(files[0].path);
    ASSERT_TRUE(kept.ok());
    EXPECT_TRUE(kept->head().cut);
    EXPECT_EQ(kept->span().last, machine->state().cycle);
    EXPECT_FALSE(recorder->kept()[0].complete);
    EXPECT_EQ(recorder->finish()->path, "") << "once";
}

// Nobody looked between the alarm and the end: the last words of a machine are those that are wanted most. What comes behind is meant to stop.
TEST_F(Flight, AnAlarmJustBeforeTheEndIsRecordedAndOneBehindItIsNot) {
    start();
    run(1500ms);
    fault("x");
    ASSERT_TRUE(machine->until([&] { return machine->axis(0).state == axes::AxisState::ErrorStop; }, 1s));
    machine->machine->request_shutdown();
    machine->run(2ms);
    fault("y");
    machine->run(20ms);
    ASSERT_NE(machine->state().phase, MachinePhase::running);
    ASSERT_THAT(machine->alarms(), HasSubstr("axis y")) << "it is there";
    recorder->look(machine->state());
    take(recorder->finish());
    ASSERT_THAT(files, SizeIs(1));
    for (const auto& alarm : files[0].alarms) EXPECT_EQ(alarm.source, "axis x") << alarm.name;
    EXPECT_EQ(recorder->finish()->path, "");
}

// The same run again gives the same recording, but for what this computer took to compute it.
TEST_F(Flight, TwoEqualRunsLeaveEqualRecordings) {
    const auto once = [&] {
        start();
        run(1500ms);
        fault("x");
        run(1s);
        EXPECT_THAT(files, SizeIs(1));
        auto kept = read_scope_file(files.back().path);
        files.clear();
        fs::remove_all(folder / "recordings");
        return kept;
    };
    const auto first = once(), again = once();
    ASSERT_TRUE(first.ok() && again.ok());
    EXPECT_EQ(first->head(), again->head());
    ASSERT_EQ(first->depth(), again->depth());
    for (const auto& signal : first->signals()) {
        if (signal.name == "compute_time" || signal.group == SignalGroup::task) continue;
        for (auto c = first->span().first; c <= first->span().last; ++c)
            ASSERT_EQ(std::bit_cast<std::uint64_t>(first->value(signal, c)), std::bit_cast<std::uint64_t>(again->value(signal, c)))
                << signal.name << " in cycle " << c;
    }
}

TEST_F(Flight, AFolderThatCannotBeIsRefused) {
    machine = std::make_unique<TestMachine>(short_one());
    std::ofstream(folder / "file") << "";
    const auto opened = FlightRecorder::open(*machine->machine, (folder / "file" / "below").string(), epoch);
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().code, "recording.directory");
}

}  // namespace
}  // namespace taktwerk::runtime
