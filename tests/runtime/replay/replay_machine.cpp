// A recording drives its machine again: the same comes of it, byte by byte; where something was changed it is named, at its cycle.

#include <algorithm>
#include <random>

#include "core/bytes.hpp"
#include "runtime/recording/inbox_reader.hpp"
#include "tests/runtime/serial/line_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// What a test records, whatever the switch of all tests says.
struct RecordedMachine {
    explicit RecordedMachine(const MachineConfig& config) : m(config) {
        m.replayed.leave_out();
        recorded.watch(*m.machine, m.runner.get(), m.clock.now());
    }
    [[nodiscard]] Replayed replayed() { return replay_all(recorded.config(), recorded.recording()); }

    RecordedInMemory recorded;
    TestMachine m;
};

/// The lamp goes on in the scan `on_in`.
template <std::int64_t on_in>
class Lamp final : public Program {
public:
    Output<bool> lamp;
    std::int64_t scans = 0;
    void declare(Declaration& d) override {
        lamp = d.output("lamp");
        d.monitor("scans", scans);
        d.task<&Lamp::scan>("main");
    }
    void scan(TaskContext& ctx) { ctx.set(lamp, ++scans >= on_in); }
};

/// How many records of a channel there are.
std::size_t count(const Recording& recording, RecordChannel channel) {
    return static_cast<std::size_t>(std::ranges::count(recording.frames, channel, &Recording::Frame::channel));
}

/// The n-th record of a channel, counted from 0.
std::size_t place_of(const Recording& recording, RecordChannel channel, std::size_t n) {
    for (std::size_t i = 0; i < recording.size(); ++i)
        if (recording.frames[i].channel == channel && n-- == 0) return i;
    ADD_FAILURE() << "there are not so many records of channel " << channel;
    return 0;
}

std::span<std::byte> bytes_of(Recording& recording, std::size_t place) {
    return std::span{recording.bytes}.subspan(recording.frames[place].offset, recording.frames[place].length);
}

// --- the same again -------------------------------------------------------------------------------------------------------------------

TEST(Replay, AnOperatorAFaultAndAStopComeAgainByteByByte) {
    auto config = machine_config(2);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    RecordedMachine r{config};
    ASSERT_TRUE(r.m.up());
    r.m.enable(0);
    r.m.home(0);
    ASSERT_EQ(r.m.command(OperatorAction::move_absolute, 0, false, 300, 200).answer, Answer::accepted);
    r.m.run(500ms);
    r.m.world.happen({.kind = SimulationEvent::Kind::drive_fault, .target = "x", .value = 0x7121});
    ASSERT_TRUE(r.m.until([&] { return r.m.axis(0).state == axes::AxisState::ErrorStop; }, 1s));
    r.m.machine->request_stop(1);
    r.m.run(300ms);
    const auto cycles = r.m.state().statistics.cycles;

    const auto replayed = r.replayed();

    EXPECT_TRUE(replayed.identical()) << replayed.text();
    EXPECT_EQ(replayed.cycles, cycles);
    EXPECT_GT(count(r.recorded.recording(), setpoints_channel), 400u) << "it moved for half a second";
    EXPECT_EQ(count(r.recorded.recording(), level_channel), 1u);
    EXPECT_EQ(r.recorded.recording().lost, 0u);
}

TEST(Replay, AProgramASlowTaskAndTheEndOfTheRunComeAgain) {
    auto config = with_program(1, &entry_of<RunsX>);
    add_program(config, "slow", &entry_of<Idle>, 5);
    RecordedMachine r{config};
    ASSERT_TRUE(r.m.up());
    r.m.run(1s);
    r.m.runner->shut_down();

    const auto replayed = r.replayed();

    EXPECT_TRUE(replayed.identical()) << replayed.text();
    EXPECT_GT(replayed.cycles, 1000u);
}

TEST(Replay, ADriveOnALineSaysWhatItSaid) {
    RecordedMachine r{with_line(machine_config(1))};
    ASSERT_TRUE(r.m.up());
    r.m.run(2s);
    r.m.enable(u);
    ASSERT_EQ(r.m.command(OperatorAction::home, u).answer, Answer::accepted);
    r.m.run(100ms);
    ASSERT_EQ(r.m.command(OperatorAction::move_absolute, u, false, 30, 20).answer, Answer::accepted);
    r.m.run(1s);
    ASSERT_TRUE(r.m.axis(u).powered) << r.m.alarms();

    const auto replayed = r.replayed();

    EXPECT_TRUE(replayed.identical()) << replayed.text();
    EXPECT_GT(count(r.recorded.recording(), sample_channel), 50u);
    EXPECT_GT(count(r.recorded.recording(), wish_channel), 3u) << "it was powered and moved";
}

TEST(Replay, LostFramesAndALinkThatGoesDownComeAgain) {
    RecordedMachine r{machine_config(1)};
    ASSERT_TRUE(r.m.up());
    r.m.world.transport().faults.drop_answers = 3;
    r.m.run(50ms);
    r.m.world.transport().faults.link_down = true;
    r.m.run(50ms);
    r.m.world.transport().faults.link_down = false;
    r.m.run(2s);

    const auto replayed = r.replayed();

    EXPECT_TRUE(replayed.identical()) << replayed.text();
    EXPECT_EQ(count(r.recorded.recording(), link_channel), 2u) << "down and up";
    EXPECT_GE(count(r.recorded.recording(), refused_channel), 49u) << "frames of 50 cycles that the link did not take";
}

// --- something else ---------------------------------------------------------------------------------------------------------------------

TEST(ReplayDiffers, AProgramThatIsOneBitAnotherIsNamedAtItsFirstCycle) {
    RecordedMachine r{with_program(1, &entry_of<Lamp<100>>)};
    std::uint64_t first_on = 0;
    r.m.on_cycle = [&] {
        if (first_on == 0 && r.m.state().outputs[0] != 0) first_on = r.m.state().statistics.cycles;
    };
    ASSERT_TRUE(r.m.up());
    r.m.run(300ms);
    ASSERT_GT(first_on, 99u);

    auto config = r.recorded.config();
    config.programs[0].entry = &entry_of<Lamp<101>>;
    const auto replayed = replay_all(config, r.recorded.recording());

    ASSERT_TRUE(replayed.difference) << replayed.text();
    EXPECT_EQ(replayed.difference->cycle, first_on);
    EXPECT_EQ(replayed.difference->signal, "output lamp");
    EXPECT_EQ(replayed.difference->recorded, "1");
    EXPECT_EQ(replayed.difference->replayed, "0");
    EXPECT_TRUE(r.replayed().identical()) << "the program that was recorded does the same";
}

TEST(ReplayDiffers, AnAxisWithAnotherLimitIsNamedWithItsSetPoint) {
    auto config = machine_config(1);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    RecordedMachine r{config};
    ASSERT_TRUE(r.m.up());
    r.m.enable(0);
    r.m.home(0);
    ASSERT_EQ(r.m.command(OperatorAction::move_absolute, 0, false, 300, 200).answer, Answer::accepted);
    r.m.run(200ms);

    config.axes[0].axis.limits.acceleration /= 2;
    const auto replayed = replay_all(config, r.recorded.recording());

    ASSERT_TRUE(replayed.difference) << replayed.text();
    EXPECT_EQ(replayed.difference->signal.rfind("axis x: set ", 0), 0u) << replayed.difference->signal;
    EXPECT_GT(replayed.difference->cycle, 0u);
}

TEST(ReplayDiffers, AnotherInputComesToAnotherOutcome) {
    auto config = machine_config(1);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    RecordedMachine r{config};
    ASSERT_TRUE(r.m.up());
    r.m.enable(0);
    r.m.home(0);
    ASSERT_EQ(r.m.command(OperatorAction::move_absolute, 0, false, 300, 200).answer, Answer::accepted);
    r.m.run(200ms);
    auto& recording = r.recorded.recording();
    const auto place = place_of(recording, command_channel, count(recording, command_channel) - 1);
    ASSERT_EQ(read_command(recording.record(place).bytes)->value2, 200.0);
    constexpr std::size_t value2_at = 16;  // inbox_record.hpp: u8 x 4, u16 x 2, f64
    store_le(bytes_of(recording, place), value2_at, std::bit_cast<std::uint64_t>(100.0));

    const auto replayed = r.replayed();

    ASSERT_TRUE(replayed.difference) << replayed.text();
    EXPECT_EQ(replayed.difference->signal.rfind("axis x: set ", 0), 0u) << replayed.difference->signal;
    EXPECT_GE(replayed.difference->at, recording.record(place).time);
}

TEST(ReplayDiffers, ASetPointThatWasRecordedOtherwiseIsNamedWithBothValues) {
    auto config = machine_config(1);
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    RecordedMachine r{config};
    ASSERT_TRUE(r.m.up());
    r.m.enable(0);
    r.m.home(0);
    ASSERT_EQ(r.m.command(OperatorAction::move_absolute, 0, false, 300, 200).answer, Answer::accepted);
    r.m.run(200ms);
    auto& recording = r.recorded.recording();
    const auto place = place_of(recording, setpoints_channel, count(recording, setpoints_channel) - 10);
    const auto was = read_setpoint(bytes_of(recording, place), 0);
    store_le(bytes_of(recording, place), 0, std::bit_cast<std::uint64_t>(was.position + 1));

    const auto replayed = r.replayed();

    ASSERT_TRUE(replayed.difference) << replayed.text();
    EXPECT_EQ(replayed.difference->signal, "axis x: set position");
    EXPECT_DOUBLE_EQ(std::stod(replayed.difference->recorded), was.position + 1);
    EXPECT_DOUBLE_EQ(std::stod(replayed.difference->replayed), was.position);
    EXPECT_EQ(replayed.difference->at, recording.record(place).time);
}

// --- what cannot be replayed --------------------------------------------------------------------------------------------------------------

struct Unfit : ::testing::Test {
    Unfit() : r(machine_config(1)) { up = r.m.up(); }
    void expect(const std::string& code, const Recording& recording, const MachineConfig& config) {
        const auto replayed = replay_all(config, recording);
        ASSERT_EQ(replayed.errors.size(), 1u) << replayed.text();
        EXPECT_EQ(replayed.errors[0].rfind(code + ": ", 0), 0u) << replayed.errors[0];
    }
    RecordedMachine r;
    bool up = false;
};

TEST_F(Unfit, AnotherMachineAnotherCycleAnotherKindOfFile) {
    ASSERT_TRUE(up);
    auto recording = r.recorded.recording();
    auto config = r.recorded.config();
    config.name = "press";
    expect("replay.other_machine", recording, config);
    config = r.recorded.config();
    config.cycle = 2ms;
    expect("replay.other_machine", recording, config);
    recording.info.channels.back() = "cable";
    expect("replay.channels", recording, r.recorded.config());
    recording.info.facts.clear();
    expect("replay.not_of_a_machine", recording, r.recorded.config());
}

TEST_F(Unfit, Losses) {
    ASSERT_TRUE(up);
    auto recording = r.recorded.recording();
    recording.lost = 1;
    expect("replay.lost", recording, r.recorded.config());
}

TEST_F(Unfit, RecordsThatNoMachineWrites) {
    ASSERT_TRUE(up);
    // Too short, for each kind that a replay reads.
    for (const auto channel : {tick_channel, call_channel, departure_channel, wire_channel}) {
        auto recording = r.recorded.recording();
        recording.frames[place_of(recording, channel, 0)].length -= 1;
        expect("replay.malformed", recording, r.recorded.config());
    }
    // An enumerator that there is not.
    auto recording = r.recorded.recording();
    bytes_of(recording, place_of(recording, call_channel, 0))[0] = std::byte{0xFF};
    expect("replay.malformed", recording, r.recorded.config());
    // A slow task that this machine does not have.
    recording = r.recorded.recording();
    bytes_of(recording, place_of(recording, call_channel, 1))[0] = std::byte{static_cast<std::uint8_t>(Call::slow_task)};
    expect("replay.malformed", recording, r.recorded.config());
}

TEST_F(Unfit, ARecordingThatWasCutOffIsReplayedUpToItsLastWholeCycle) {
    ASSERT_TRUE(up);
    r.m.run(50ms);
    const auto whole = r.recorded.recording();
    for (std::size_t cut = 1; cut < 15; ++cut) {
        auto recording = whole;
        recording.frames.resize(whole.size() - cut);
        recording.end = RecordingEnd::torn;
        const auto replayed = replay_all(r.recorded.config(), recording);
        EXPECT_TRUE(replayed.identical()) << cut << " records less: " << replayed.text();
        EXPECT_GT(replayed.cycles, 40u);
    }
}

// Whatever stands in a recording whose check sums are right: it is the same, or it is said what is not; nothing else happens.
TEST_F(Unfit, BytesThatWereAlteredAreSaidOrChangeNothing) {
    ASSERT_TRUE(up);
    r.m.enable(0);
    r.m.machine->request_stop(0);
    r.m.run(20ms);
    const auto whole = r.recorded.recording();
    std::minstd_rand random{20261126};
    const auto below = [&random](std::size_t end) { return static_cast<std::size_t>(random()) % end; };
    std::size_t said = 0;
    for (int round = 0; round < 60; ++round) {
        auto recording = whole;
        for (int i = 0; i < 3; ++i) {
            const auto place = below(recording.size());
            auto& frame = recording.frames[place];
            if (below(4) == 0) frame.channel = static_cast<RecordChannel>(below(recording.info.channels.size()));
            else if (below(4) == 0) frame.length = below(frame.length + 1);
            else if (frame.length > 0) bytes_of(recording, place)[below(frame.length)] ^= static_cast<std::byte>(1u << below(8));
        }
        said += replay_all(r.recorded.config(), recording).identical() ? 0 : 1;
    }
    EXPECT_GT(said, 30u);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
