// What the cycle writes into the memory of the scope is what the snapshot of that cycle shows, to the last bit, for every signal.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "runtime/recording/signal_ring.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisView;

/// By the name behind the axis: what docs/recording.md promises of it.
const std::map<std::string, double (*)(const AxisView&)> of_an_axis{
    {"state", [](const AxisView& v) { return static_cast<double>(v.state); }},
    {"set_position", [](const AxisView& v) { return v.set_position; }},
    {"set_velocity", [](const AxisView& v) { return v.set_velocity; }},
    {"set_acceleration", [](const AxisView& v) { return v.set_acceleration; }},
    {"set_jerk", [](const AxisView& v) { return v.set_jerk; }},
    {"actual_position", [](const AxisView& v) { return v.actual_position; }},
    {"actual_velocity", [](const AxisView& v) { return v.actual_velocity; }},
    {"actual_torque", [](const AxisView& v) { return v.actual_torque; }},
    {"following_error", [](const AxisView& v) { return v.following_error; }},
    {"target_position", [](const AxisView& v) { return v.target_position; }},
    {"active", [](const AxisView& v) { return static_cast<double>(v.active); }},
    {"drive_state", [](const AxisView& v) { return static_cast<double>(v.drive_state); }},
    {"homed", [](const AxisView& v) { return v.homed ? 1.0 : 0.0; }},
    {"error", [](const AxisView& v) { return static_cast<double>(v.error); }},
    {"owner", [](const AxisView& v) { return static_cast<double>(v.owner); }},
    {"velocity_limiter", [](const AxisView& v) { return static_cast<double>(v.limiter); }},
    {"held_by_stop", [](const AxisView& v) { return v.lock != 0 ? 1.0 : 0.0; }},
    {"command", [](const AxisView& v) { return static_cast<double>(v.active_kind); }},
    {"powered", [](const AxisView& v) { return v.powered ? 1.0 : 0.0; }},
    {"online", [](const AxisView& v) { return v.online ? 1.0 : 0.0; }},
    {"in_position", [](const AxisView& v) { return v.in_position ? 1.0 : 0.0; }},
    {"warning", [](const AxisView& v) { return v.warning ? 1.0 : 0.0; }},
    {"negative_limit", [](const AxisView& v) { return v.negative_limit_switch ? 1.0 : 0.0; }},
    {"positive_limit", [](const AxisView& v) { return v.positive_limit_switch ? 1.0 : 0.0; }},
    {"home_switch", [](const AxisView& v) { return v.home_switch ? 1.0 : 0.0; }},
    {"resetting", [](const AxisView& v) { return v.resetting ? 1.0 : 0.0; }},
    {"brake", [](const AxisView& v) { return static_cast<double>(v.brake); }},
    {"presence", [](const AxisView& v) { return static_cast<double>(v.presence); }},
    {"drive_mode", [](const AxisView& v) { return static_cast<double>(v.drive_mode); }},
    {"status_word", [](const AxisView& v) { return static_cast<double>(v.status_word); }},
    {"drive_error", [](const AxisView& v) { return static_cast<double>(v.drive_error); }},
    {"drive_inputs", [](const AxisView& v) { return static_cast<double>(v.digital_inputs); }},
    {"queued", [](const AxisView& v) { return static_cast<double>(v.queued_count); }},
};

/// By the signal's name; what is no axis'.
double of_the_machine(const Snapshot& s, const MachineLayout& layout, const RecordedSignal& signal) {
    const auto place = [&](const std::vector<std::string>& names) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), signal.of) - names.begin());
    };
    if (signal.group == SignalGroup::input) return s.input_values[place(layout.inputs)].value;
    if (signal.group == SignalGroup::output) return s.output_values[place(layout.outputs)];
    if (signal.name == "time_s") return to_seconds(s.at.time_since_epoch());
    if (signal.name == "emergency_stop") return s.emergency_stop ? 1 : 0;
    if (signal.name == "alarms") return static_cast<double>(s.alarm_count);
    if (signal.name == "mode") return static_cast<double>(s.mode);
    if (signal.name == "phase") return static_cast<double>(s.phase);
    if (signal.name == "lateness") return static_cast<double>(s.statistics.lateness.count()) / 1e3;
    if (signal.name == "compute_time") return static_cast<double>(s.statistics.compute.count()) / 1e3;
    if (signal.name == "dc_phase_error") return static_cast<double>(s.bus.dc_phase_error_ns) / 1e3;
    if (signal.name == "frames_lost") return static_cast<double>(s.bus.frames_lost);
    ADD_FAILURE() << "nobody knows " << signal.name;
    return 0;
}

TEST(RecordedRow, HasEverySignalOfTheSnapshotToTheLastBit) {
    TestMachine m{machine_config(2)};
    ASSERT_TRUE(m.up());
    const auto& ring = m.machine->signals();
    std::vector<std::uint64_t> row(ring.words());
    std::set<std::string> seen, moved;
    std::map<std::string, double> before;
    std::size_t rows = 0;
    m.on_cycle = [&] {
        const auto& s = m.state();
        ASSERT_EQ(ring.span().last, s.cycle);
        ASSERT_TRUE(ring.read_row(s.cycle, row));
        ++rows;
        for (const auto& signal : ring.signals()) {
            const double shown = signal.cell.value_of(row[signal.cell.word]);
            double wanted = 0;
            if (signal.group == SignalGroup::axis) {
                const std::size_t axis = signal.of == "x" ? 0 : 1;
                wanted = of_an_axis.at(signal.name.substr(signal.of.size() + 1))(s.axes[axis]);
            } else wanted = of_the_machine(s, m.machine->layout(), signal);
            ASSERT_EQ(std::bit_cast<std::uint64_t>(shown), std::bit_cast<std::uint64_t>(wanted))
                << signal.name << " " << shown << " " << wanted;
            if (seen.insert(signal.name).second) before[signal.name] = shown;
            else if (before[signal.name] != shown) moved.insert(signal.name);
        }
    };
    m.enable(0);
    m.enable(1);
    m.home(0);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 40, 100).answer, Answer::accepted);
    m.run(400ms);
    m.world.drive("y")->raise(0x3130);
    m.run(200ms);

    EXPECT_GT(rows, 1000u);
    EXPECT_EQ(seen.size(), ring.signals().size()) << "each name once";
    for (const auto* name : {"x.set_position", "x.actual_torque", "x.status_word", "x.homed", "x.command", "x.drive_state", "x.home_switch",
                             "y.error", "y.drive_error", "alarms", "time_s"})
        EXPECT_EQ(moved.count(name), 1u) << name << " never changed: this has shown nothing of it";
}

// A row is what the depth of the memory is counted in, and `check` says how many bytes.
TEST(RecordedRow, TheMemoryIsAsDeepAsTheFileSays) {
    auto config = machine_config(1);
    config.recording.depth = 300ms;
    config.recording.files = 0;
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    m.run(1s);
    const auto& ring = m.machine->signals();
    EXPECT_EQ(ring.depth(), 300u);
    EXPECT_EQ(ring.span().last - ring.span().first + 1, 300u);
    EXPECT_EQ(ring.bytes(), ring.words() * 301 * 8);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
