// A counter or encoder terminal as an axis, over real frames and with the shipped device files: what something turns is counted, followed,
// latched, and told when it does not hold. The terminals' widths and bits are those of their sources (config/devices/*.yaml).

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "axes/axis/alarms.hpp"
#include "config/device_file/device_loader.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/check/machine_check.hpp"
#include "runtime/check/machine_remarks.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A measuring wheel of 100 mm, 4096 counts a turn, at an EL5101, and a servo. `wheel`: further keys of the axis.
std::string wheel_text(const std::string& wheel) {
    return "version: 1\nname: wheel\ncycle: 1 ms\nstart_mode: automatic\nbus:\n  interface: simulated\n  slaves:\n"
           "    - { name: coupler, device: ek1100 }\n    - { name: enc, device: el5101 }\n    - { name: both, device: el5102 }\n"
           "    - { name: biss, device: el5042 }\n    - { name: ai, device: el3102 }\n    - { name: saw_drive, profile: sv33-e }\n"
           "axes:\n  wheel:\n    unit: mm\n    encoder: true\n    gearing: { counts_per_revolution: 4096, feed: 100 mm }\n"
           "    limits: { velocity: 2000 mm/s, acceleration: 10000 mm/s2, jerk: 100000 mm/s3 }\n" +
           wheel +
           "  saw:\n    slave: saw_drive\n    unit: mm\n    gearing: { counts_per_revolution: 131072, feed: 10 mm }\n"
           "    limits: { velocity: 1500 mm/s, acceleration: 20000 mm/s2, jerk: 1000000 mm/s3 }\n    following_error: { window: 50 mm }\n"
           "    require_homed: false\n";
}

std::variant<config::LoadedMachine, std::vector<Error>> load_wheel(const std::string& wheel) {
    config::LoadOptions options;
    return config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/wheel.yaml", wheel_text(wheel), options);
}

MachineConfig wheel_machine(const std::string& wheel) {
    auto loaded = load_wheel(wheel);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return machine_config(1);
    }
    return std::get<config::LoadedMachine>(std::move(loaded)).machine;
}

const std::string turning = "    slave: enc\n    simulation: { velocity: 800 mm/s }\n";

std::string wheel_problem(const std::string& wheel) {
    auto loaded = load_wheel(wheel);
    const auto* errors = std::get_if<std::vector<Error>>(&loaded);
    if (errors == nullptr) return "none";
    return errors->size() == 1 ? errors->front().code + ": " + errors->front().what + ". " + errors->front().remedy
                               : std::to_string(errors->size()) + " errors, first: " + errors->front().text();
}

/// The saw, axis 1, is enabled and goes 300 mm on. Where the wheel and it stood before.
std::pair<double, double> saw_runs_300(TestMachine& m) {
    m.enable(1);
    const double wheel = m.axis(0).actual_position, saw = m.axis(1).actual_position;
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 1, false, saw + 300, 200).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return std::abs(m.axis(1).actual_position - saw - 300) < 0.05 && m.axis(1).in_position; }, 10s))
        << m.alarms();
    return {wheel, saw};
}

// 800 mm/s are 32768 counts/s: the 16 bits of the counter begin anew each two seconds.
TEST(EncoderAxis, CountsOnWhereTheCounterBeginsAnew) {
    auto config = wheel_machine(turning);
    config.start_mode = Mode::manual;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    m.run(100ms);
    const double before = m.axis(0).actual_position;
    m.run(10s);
    EXPECT_NEAR(m.axis(0).actual_position - before, 8000, 0.05) << "two counts";
    EXPECT_NEAR(m.axis(0).actual_velocity, 800, 30) << "a count a cycle is 24 mm/s";
    EXPECT_TRUE(m.axis(0).online);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Disabled);
    EXPECT_EQ(m.alarms(), "");
    (void)m.command(OperatorAction::power, 0, true);
    m.run(100ms);
    EXPECT_FALSE(m.axis(0).powered);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Disabled);
}

// It counts in fewer bits than its object has: 26 of the 64 of an EL5042, here one turn of 8192 counts.
TEST(EncoderAxis, CountsInAsManyBitsAsItSays) {
    auto config = wheel_machine(
        "    slave: biss\n    axis: 2\n    counter_bits: 13\n    position_memory: { absolute: true }\n    simulation: { velocity: -800 "
        "mm/s, start: 50 "
        "mm }\n");
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    m.run(100ms);
    const double before = m.axis(0).actual_position;
    m.run(2s);
    EXPECT_NEAR(m.axis(0).actual_position - before, -1600, 0.05);
}

TEST(EncoderAxis, MayBeTurnedByAnotherAxis) {
    auto config = wheel_machine("    slave: both\n    axis: 1\n    simulation: { turned_by: saw }\n");
    config.start_mode = Mode::manual;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    const auto [wheel, saw] = saw_runs_300(m);
    EXPECT_NEAR(m.axis(0).actual_position - wheel, 300, 0.06);
}

// Any object that counts, also of a drive that moves another axis: here its own position, as 13107.2 counts a mm and read as 40.96.
TEST(EncoderAxis, MayBeAnObjectOfADriveThatMovesAnother) {
    auto config = wheel_machine("    slave: saw_drive\n    object: 6064h\n");
    config.start_mode = Mode::manual;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    const auto [wheel, saw] = saw_runs_300(m);
    EXPECT_NEAR(m.axis(0).actual_position - wheel, 320 * (m.axis(1).actual_position - saw), 0.05);
}

// The saw follows the wheel; a broken wire stops it, and the wheel's axis shows the last place that held.
class Follows final : public Program {
public:
    AxisRef wheel, saw;
    fb::MC_Power power;
    fb::MC_GearIn gear;
    double in_gear = 0;
    void declare(Declaration& d) override {
        wheel = d.axis("wheel");
        saw = d.axis("saw");
        d.monitor("in_gear", in_gear);
        d.task<&Follows::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = gear.Slave = saw;
        power.Enable = true;
        power(ctx);
        gear.Master = wheel;
        gear.MasterValueSource = axes::mcActualValue;
        gear.Execute = power.Status;
        gear(ctx);
        in_gear = gear.InGear ? 1 : 0;
    }
};

TEST(EncoderAxis, IsFollowedAndAnErrorOfItsTerminalIsToldAndStopsTheFollower) {
    auto config = wheel_machine(turning);
    add_program(config, "p", &entry_of<Follows>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return variable(m, "in_gear") != 0; }, 5s)) << m.alarms();
    m.run(500ms);
    const double apart = m.axis(0).actual_position - m.axis(1).set_position;
    m.run(3s);
    EXPECT_NEAR(m.axis(0).actual_position - m.axis(1).set_position, apart, 0.5);
    EXPECT_NEAR(m.axis(1).set_velocity, 800, 10);

    SimulationEvent broken;
    broken.kind = SimulationEvent::Kind::drive_fault;
    broken.target = "wheel";
    broken.value = 1;
    m.world.happen(broken);
    ASSERT_TRUE(m.until([&] { return m.axis(1).state == axes::AxisState::ErrorStop; }, 100ms)) << m.alarms();
    m.run(5ms);
    EXPECT_TRUE(m.has_alarm(id(axes::AxisAlarm::encoder_invalid))) << m.alarms();
    EXPECT_TRUE(m.has_alarm(id(axes::AxisAlarm::master_lost))) << m.alarms();
    const double held = m.axis(0).actual_position;
    m.run(200ms);
    EXPECT_FALSE(m.axis(0).online);
    EXPECT_EQ(m.axis(0).actual_position, held);
    EXPECT_EQ(m.axis(0).state, axes::AxisState::Disabled);

    broken.value = 0;
    m.world.happen(broken);
    ASSERT_TRUE(m.until([&] { return m.axis(0).online; }, 100ms));
    m.run(10ms);
    EXPECT_FALSE(m.has_alarm(id(axes::AxisAlarm::encoder_invalid))) << m.alarms();
    EXPECT_NEAR(m.axis(0).actual_velocity, 800, 30);
}

/// Records where the index passes, and the edges of marks, one after the other.
template <bool Index, bool Falling>
class Probes final : public Program {
public:
    AxisRef wheel;
    fb::MC_TouchProbe probe;
    double recorded = 0;
    std::int64_t events = 0, errors = 0;
    void declare(Declaration& d) override {
        wheel = d.axis("wheel");
        d.monitor("recorded", recorded);
        d.monitor("events", events);
        d.monitor("errors", errors);
        d.task<&Probes::scan>("main");
    }
    void scan(TaskContext& ctx) {
        probe.Axis = wheel;
        probe.TriggerInput = {.source = Index ? axes::TriggerSource::index_pulse : axes::TriggerSource::probe1, .falling = Falling};
        probe.Execute = !probe.Done && !probe.Error;
        probe(ctx);
        if (probe.Done) ++events, recorded = probe.RecordedPosition;
        if (probe.Error) ++errors;
    }
};

/// mm: how far what was recorded lies from the nearest of `at`, `at` + 100, ...
template <bool Index, bool Falling>
void expect_recorded(double at) {
    auto config = wheel_machine(
        "    slave: enc\n    simulation: { velocity: 730 mm/s, index_pulse: 30 mm, marks: { first: 60 mm, every: 100 mm, length: 5 mm } "
        "}\n");
    add_program(config, "p", &entry_of<Probes<Index, Falling>>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    std::int64_t seen = 0;
    m.on_cycle = [&] {
        const auto events = static_cast<std::int64_t>(variable(m, "events"));
        if (events == seen) return;
        seen = events;
        const double off = std::remainder(variable(m, "recorded") - at, 100.0);
        EXPECT_LE(std::abs(off), 0.025) << "a count is 0.0244 mm: event " << events << " at " << variable(m, "recorded");
    };
    m.run(5s);
    m.on_cycle = {};
    EXPECT_GE(seen, 30) << "36 of them pass; each is armed anew";
    EXPECT_EQ(variable(m, "errors"), 0);
}

TEST(EncoderAxis, ItsLatchIsATouchProbeForTheIndex) { expect_recorded<true, false>(30); }
TEST(EncoderAxis, ItsLatchIsATouchProbeForARisingEdge) { expect_recorded<false, false>(60); }
TEST(EncoderAxis, ItsLatchIsATouchProbeForAFallingEdge) { expect_recorded<false, true>(65); }

/// Sets the position, then homes in passing at the index.
class Refers final : public Program {
public:
    AxisRef wheel;
    fb::MC_SetPosition set;
    fb::MC_StepReferenceFlyingRefPulse reference;
    double was_set = 0;
    std::int64_t errors = 0;
    void declare(Declaration& d) override {
        wheel = d.axis("wheel");
        d.monitor("was_set", was_set);
        d.monitor("errors", errors);
        d.task<&Refers::scan>("main");
    }
    void scan(TaskContext& ctx) {
        set.Axis = reference.Axis = wheel;
        set.Position = 5000;
        set.Execute = ctx.view(wheel)->online;
        set(ctx);
        if (set.Done && was_set == 0) was_set = ctx.view(wheel)->actual_position;
        reference.SetPosition = 1000;
        reference.Execute = set.Done;
        reference(ctx);
        errors += set.Error || reference.Error ? 1 : 0;
    }
};

TEST(EncoderAxis, ItsPositionIsSetAndReferredToTheIndexInPassing) {
    auto config = wheel_machine("    slave: enc\n    simulation: { velocity: 730 mm/s, index_pulse: 30 mm }\n");
    add_program(config, "p", &entry_of<Refers>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).homed; }, 2s)) << variable(m, "errors");
    EXPECT_NEAR(variable(m, "was_set"), 5000, 2) << "at most two cycles of 0.73 mm on";
    // From here on the index is at 1000, 1100, ...; at 30, 130, ... of what turns it.
    const double u = 730 * to_seconds(m.clock.now() - (Instant{} + 1s));
    EXPECT_LE(std::abs(std::remainder(m.axis(0).actual_position - (u - 30), 100.0)), 3) << "two cycles old";
    EXPECT_EQ(variable(m, "errors"), 0);

    // Its terminal loses its supply: a counter begins with 0, and its reference is gone.
    m.world.set_slave_power("enc", false);
    ASSERT_TRUE(m.until([&] { return !m.axis(0).homed; }, 1s));
    m.world.set_slave_power("enc", true);
    ASSERT_TRUE(m.until([&] { return m.axis(0).online; }, 20s)) << m.machine->bus_progress();
    EXPECT_FALSE(m.axis(0).homed);
}

TEST(EncoderAxis, WhatDoesNotFitIsSaid) {
    EXPECT_EQ(wheel_problem(turning), "none");
    EXPECT_EQ(wheel_problem("    slave: ai\n"),
              "config.no_encoder: the file of slave 'ai' names no encoder. name the input that counts by `channel` (there is: ai1, ai2)");
    EXPECT_EQ(wheel_problem("    slave: ai\n    channel: ai2\n"), "none");
    EXPECT_EQ(wheel_problem("    slave: ai\n    channel: ai3\n"), "config.no_channel: slave 'ai' has no input 'ai3'. name one of ai1, ai2");
    EXPECT_EQ(wheel_problem("    slave: both\n"),
              "axis.drive_axis_missing: slave 'both' has 2 encoders: which one is meant?. add `axis:`, 1 to 2");
    EXPECT_EQ(wheel_problem("    slave: both\n    axis: 3\n"),
              "axis.drive_axis: slave 'both' has 2 encoders, there is no 3. choose 1 to 2");
    EXPECT_THAT(
        wheel_problem("    slave: saw_drive\n    channel: ai1\n"),
        HasSubstr("`channel`, `object` and `counter_bits` are of an axis that only measures, at a terminal. write `encoder: true`, and "
                  "the terminal that counts as its `slave`"));
    EXPECT_THAT(wheel_problem("    slave: saw_drive\n    object: 60E4h:01\n"), HasSubstr("object 60E4h:01 (60E4h:01) is not in the TxPDO"));
    EXPECT_THAT(wheel_problem(turning + "    counter_bits: 24\n"),
                HasSubstr("'position1' has 16 bits. write `counter_bits: 16`, or fewer"));
    EXPECT_THAT(wheel_problem(turning + "    homing: { kind: set_here }\n"), HasSubstr("an axis that only measures moves to no reference"));
    EXPECT_THAT(wheel_problem("    slave: enc\n    simulation: { turned_by: sow }\n"), HasSubstr("did you mean 'saw'?"));
    EXPECT_THAT(wheel_problem("    slave: enc\n    simulation: { turned_by: saw, velocity: 5 mm/s }\n"),
                HasSubstr("axis saw turns it (`turned_by`), not a velocity"));
    EXPECT_THAT(wheel_problem(turning + "    position_memory: { absolute: true }\n"),
                HasSubstr("'position1' of slave 'enc' is an incremental counter: it begins at 0 with each supply"));
    EXPECT_EQ(wheel_problem("    slave: biss\n    axis: 2\n    position_memory: { absolute: true }\n"), "none");
    // 8 bits: 128 counts of 4096 to 100 mm in 1 ms are 3125 mm/s.
    const std::string narrow = "    slave: enc\n    counter_bits: 8\n";
    EXPECT_EQ(wheel_problem(narrow + "    simulation: { velocity: -3100 mm/s }\n"), "none");
    EXPECT_THAT(
        wheel_problem(narrow + "    simulation: { velocity: -3200 mm/s }\n"),
        HasSubstr("at 3200 mm/s it counts 131 from one exchange to the next (1 ms), and beyond half of its 8 bits (128) nobody knows"));
    auto fast = wheel_machine(narrow);
    fast.axes[0].axis.limits.velocity = 3200;
    const auto errors = check(fast);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].subject, "axes.wheel.limits.velocity");
}

// While a machine is put together: the cable goes past the terminal, and what follows the wheel can be tried.
TEST(EncoderAxis, WhoseTerminalIsNotThereYetStandsAtZero) {
    auto config = wheel_machine(turning + "    simulated: true\n");
    config.start_mode = Mode::manual;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    const auto [wheel, saw] = saw_runs_300(m);
    EXPECT_EQ(wheel, 0);
    EXPECT_EQ(m.axis(0).actual_position, 0);
    EXPECT_TRUE(m.axis(0).simulated);
    EXPECT_EQ(m.alarms(), "");
}

// One of two encoders of a terminal cannot be left out alone: it would be the real one, and called simulated.
TEST(EncoderAxis, OneOfTwoAtATerminalIsNotSimulatedAlone) {
    auto text = wheel_text("    slave: both\n    axis: 1\n    simulated: true\n");
    const std::string second =
        "  belt:\n    unit: mm\n    encoder: true\n    slave: both\n    axis: 2\n    gearing: { counts_per_revolution: 4096, feed: 100 mm "
        "}\n"
        "    limits: { velocity: 2000 mm/s, acceleration: 10000 mm/s2, jerk: 100000 mm/s3 }\n";
    const auto load = [&](const std::string& more) {
        return config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/wheel.yaml", text + second + more, {});
    };
    const auto alone = load("");
    const auto* errors = std::get_if<std::vector<Error>>(&alone);
    ASSERT_TRUE(errors != nullptr && errors->size() == 1);
    EXPECT_THAT(errors->front().text(), HasSubstr("axis belt is on slave 'both', too, and is not simulated"));
    EXPECT_EQ(load("    simulated: true\n").index(), 0u);
}

// The axis arms the latches of its encoder; an output on the same bit would latch in between.
TEST(EncoderAxis, ItsLatchIsItsOwn) {
    for (const char* latch : {"latch_index1", "latch_rising1", "latch_falling1"}) {
        auto text = wheel_text(turning);
        text.replace(text.find("axes:"), 0, std::string("io:\n  outputs:\n    l: { slave: enc, channel: ") + latch + " }\n");
        const auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/wheel.yaml", text, {});
        const auto* errors = std::get_if<std::vector<Error>>(&loaded);
        ASSERT_TRUE(errors != nullptr && errors->size() == 1) << latch;
        EXPECT_THAT(errors->front().text(), AllOf(HasSubstr("wheel.yaml:16:5"), HasSubstr("axis wheel works this latch of its encoder")));
    }
}

// What does nothing on an axis that only measures is asked about: the file of one whose motor is left alone for a while may have it.
TEST(EncoderAxis, WhatItIsToldInVainIsRemarked) {
    const auto remarked = [](const std::string& wheel) {
        std::string out;
        for (const auto& remark : remarks(wheel_machine(wheel), {}, 0))
            if (remark.subject.find("wheel") != std::string::npos) out += remark.code + " " + remark.subject + "\n";
        return out;
    };
    EXPECT_EQ(remarked(turning), "");
    EXPECT_EQ(remarked(turning + "    control: { mode: velocity, kv: 20 }\n"), "remark.encoder_in_vain axes.wheel.control\n");
    EXPECT_EQ(remarked(turning + "    following_error: { window: 5 mm }\n"), "remark.encoder_in_vain axes.wheel.following_error\n");
    auto limited = wheel_machine(turning);
    limited.axes[0].axis.limits.position_max = 100;
    const auto found = remarks(limited, {}, 0);
    EXPECT_TRUE(std::ranges::any_of(found, [](const Error& one) { return one.subject == "axes.wheel.limits.position"; }));
}

TEST(EncoderAxis, EachShippedTerminalWithEncodersIsOne) {
    const std::string folder = std::string(TAKTWERK_SOURCE_DIR) + "/config/devices";
    int encoders = 0;
    for (const auto& name : {"el1502", "el1512", "el5002", "el5032", "el5042", "el5101", "el5102", "el5151"}) {
        const auto loaded = config::load_device(folder + "/" + name + ".yaml");
        ASSERT_TRUE(std::holds_alternative<config::LoadedDevice>(loaded)) << name;
        const auto count = std::get<config::LoadedDevice>(loaded).encoders.size();
        encoders += static_cast<int>(count);
        for (std::size_t n = 0; n < count; ++n) {
            SCOPED_TRACE(std::string(name) + " " + std::to_string(n + 1));
            auto text = wheel_text("    slave: enc\n    axis: " + std::to_string(n + 1) + "\n    simulation: { velocity: 100 mm/s }\n");
            text.replace(text.find("device: el5101"), 14, std::string("device: ") + name);
            auto machine = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/wheel.yaml", text, {});
            ASSERT_TRUE(std::holds_alternative<config::LoadedMachine>(machine)) << std::get<std::vector<Error>>(machine).front().text();
            TestMachine m{std::get<config::LoadedMachine>(std::move(machine)).machine};
            ASSERT_TRUE(m.up());
            const double before = m.axis(0).actual_position;
            m.run(1s);
            EXPECT_TRUE(m.axis(0).online) << m.alarms();
            EXPECT_NEAR(m.axis(0).actual_position - before, 100, 0.2);
        }
    }
    EXPECT_EQ(encoders, 13) << "one of EL1502, EL5101 and EL5151, two of each other";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
