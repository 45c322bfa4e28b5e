#pragma once
// A machine of which everything that `state` can carry is there, with drawn values: not a number and infinities among them, texts with quotes and in Chinese.

#include <limits>
#include <random>
#include <string_view>

#include "axes/axis/axis_alarm.hpp"
#include "axes/axis/parameters.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi::test {

inline double block_of_rich_machine = 0;

/// Another snapshot, a cycle later.
inline void draw(FakeMachine& machine, std::uint64_t seed) {
    std::mt19937_64 random{seed};
    const auto below = [&](std::uint64_t n) { return random() % n; };
    const auto some = [&] { return below(2) == 1; };
    const auto number = [&]() -> double {
        switch (below(8)) {
            case 0: return std::numeric_limits<double>::quiet_NaN();
            case 1: return std::numeric_limits<double>::infinity();
            case 2: return -std::numeric_limits<double>::infinity();
            case 3: return -0.0;
            default: return static_cast<double>(static_cast<std::int64_t>(random())) / 3e9;
        }
    };
    auto& s = machine.snapshot;
    ++s.cycle;
    s.at += machine.its_layout.cycle;
    s.phase = static_cast<runtime::MachinePhase>(below(5));
    s.mode = static_cast<runtime::Mode>(below(3));
    s.emergency_stop = some();
    s.input_values = {{number(), true}, {number(), some()}};
    s.inputs = {static_cast<std::int64_t>(random()), static_cast<std::int64_t>(below(2))};
    s.output_values = {number()};
    for (auto& value : s.variables) value = number();
    for (auto& value : s.parameters) value = number();
    s.statistics = {
        .cycles = s.cycle, .overruns = below(9), .missed_ticks = below(9), .lateness = Duration{below(99)}, .commands_refused = below(9)};
    s.bus = {};
    s.bus.frames_sent = random() >> 1;
    s.bus.dc_offset_ns = -static_cast<std::int64_t>(below(1'000'000));
    s.bus.dc_lock = static_cast<ecat::DcLock>(below(5));
    s.bus.ring.opened = below(9);
    s.slaves[1].age = static_cast<std::uint32_t>(random());
    s.slaves[0].fresh = some();
    s.tasks[0].releases = below(1000);
    s.following_peaks = {{number(), number()}, {}, {number(), 1}};
    for (auto& axis : s.axes) {
        axis.state = static_cast<axes::AxisState>(below(8));
        axis.owner = static_cast<axes::Owner>(below(4));
        axis.presence = static_cast<axes::Presence>(below(4));
        axis.brake = static_cast<axes::BrakeState>(below(5));
        axis.limiter = static_cast<axes::VelocityLimiter>(below(7));
        axis.active = some() ? 1 : 0;
        axis.active_kind = static_cast<axes::CommandKind>(below(4));
        axis.holder = some() ? &block_of_rich_machine : nullptr;
        axis.lock = some() ? 1 : 0;
        axis.error = some() ? id(axes::AxisAlarm::following_error) : static_cast<std::uint16_t>(random());
        axis.turns = static_cast<std::int64_t>(random());
        axis.digital_inputs = static_cast<std::uint32_t>(random());
        axis.status_word = static_cast<std::uint16_t>(random());
        axis.master = {static_cast<std::uint16_t>(below(5))};
        for (auto* flag : {&axis.powered, &axis.enable, &axis.enable_negative, &axis.homed, &axis.online, &axis.warning, &axis.home_switch})
            *flag = some();
        for (auto* value : {&axis.set_position, &axis.set_velocity, &axis.set_acceleration, &axis.set_jerk, &axis.actual_position,
                            &axis.actual_velocity, &axis.actual_torque, &axis.following_error, &axis.following_window, &axis.skew,
                            &axis.load_difference, &axis.target_position, &axis.manual_slow, &axis.manual_fast, &axis.torque_limit_positive,
                            &axis.operators_override, &axis.superimposed_covered, &axis.phase_shift, &axis.override_factors.velocity})
            *value = number();
        for (auto& value : axis.parameters) value = number();
    }
    for (auto& group : s.groups) {
        group.state = static_cast<axes::GroupState>(below(6));
        group.error = some() ? id(axes::AxisAlarm::following_error) : static_cast<std::uint16_t>(below(60));
        for (auto* flag :
             {&group.interrupted, &group.held, &group.resetting, &group.powered, &group.online, &group.in_position, &group.tool.known})
            *flag = some();
        group.members = {};
        for (std::size_t place = 0; place < 4; ++place) {
            if (some()) group.members[place] = {static_cast<std::uint16_t>(below(5))};
            group.use[place] = {static_cast<float>(number()), 0.5F, static_cast<float>(number())};
        }
        for (std::size_t i = 0; i < 6; ++i) group.tool.set[i] = number(), group.tool.actual[i] = number();
        for (auto* value : {&group.tool.speed, &group.tool.actual_speed, &group.along.velocity, &group.along.acceleration,
                            &group.along.to_go, &group.along.progress, &group.override_factor, &group.operators_override,
                            &group.along.tool_limit, &group.path_deviation, &group.track.lag})
            *value = number();
        group.track.kind = static_cast<axes::FrameTrack::Kind>(below(3));
        group.track.axis = some() ? axes::AxisRef{static_cast<std::uint16_t>(below(5))} : axes::AxisRef{};
        group.track.in_sync = some();
        for (auto& place : group.frames.machine) place = some() ? number() : 0;
        for (std::size_t i = 0; i < group.frames.product.size(); ++i) {
            group.frames.product[i] = {};
            if (some()) group.frames.product[i][below(6)] = number();
            group.frames.leader[i] = some() ? axes::AxisRef{static_cast<std::uint16_t>(below(5))} : axes::AxisRef{};
        }
        group.along.limiter = static_cast<axes::PathLimiter>(below(5));
        group.along.limiting_place = static_cast<std::uint8_t>(below(6));
        group.along.remaining = Duration{below(1'000'000'000)};
        group.active_kind = static_cast<axes::GroupCommandKind>(below(13));
        group.active = some() ? static_cast<std::uint32_t>(random()) : 0;
        group.block = some() ? &block_of_rich_machine : nullptr;
        group.queued = static_cast<std::uint8_t>(below(17));
        group.along.members = static_cast<std::uint16_t>(below(8));
        auto& refusal = group.refusal;
        refusal.number = static_cast<std::uint32_t>(below(9));
        refusal.kind = static_cast<axes::GroupCommandKind>(below(13));
        refusal.block = some() ? &block_of_rich_machine : nullptr;
        refusal.why.error = some() ? axes::ErrorId::outside_workspace : axes::ErrorId::none;
        refusal.why.line = static_cast<std::uint32_t>(below(3));
        auto& where = refusal.why.at;
        for (bool* flag : {&where.on_path, &where.in_space, &where.limit_known}) *flag = some();
        where.room = static_cast<std::uint8_t>(below(4));
        where.place = static_cast<std::uint8_t>(below(6));
        for (auto* value : {&where.part, &where.length, &where.position, &where.limit, &where.point[0], &where.point[1], &where.point[2]})
            *value = number();
    }
    s.alarms.resize(3);
    s.alarm_count = below(4);
    for (std::size_t i = 0; i < s.alarms.size(); ++i) {
        auto& alarm = s.alarms[i];
        alarm.fact.id = static_cast<AlarmId>(5 + i);
        alarm.fact.source = static_cast<AlarmSource>(below(8));
        alarm.count = static_cast<std::uint32_t>(random());
        alarm.standing = some();
        alarm.reaction = static_cast<Reaction>(below(5));
        alarm.since = s.at - Duration{below(1'000'000)};
    }
    s.event_count = below(3);
    for (std::size_t i = 0; i < 2; ++i) {
        auto& event = s.events[i];
        event.number = i + 1;
        event.at = s.at;
        event.axis = static_cast<std::uint16_t>(i * 3);
        event.given = {axes::CommandKind::move_absolute, axes::Owner::program, 0, &block_of_rich_machine};
        event.held = some();
        event.group = some() ? 0 : runtime::no_group;
        event.times = static_cast<std::uint32_t>(below(100));
    }
    s.events_dropped = below(3);
    s.force_count = below(3);
    s.forces[0] = {runtime::IoDirection::input, 1, 3, number()};
    s.forces[1] = {runtime::IoDirection::output, 0, 4, number()};
    s.measure.run = static_cast<std::uint32_t>(below(2));
    s.measure.axis = 1;
    s.measure.elapsed = number();
}
inline std::string_view name_of_rich_client(std::uint32_t client) { return client == 3 ? "anna \"at the panel\"" : "张三"; }

/// Names and units of everything, and a first snapshot.
inline void make_rich(FakeMachine& machine) {
    auto& layout = machine.its_layout;
    layout.input_units = {"", "bar"};
    layout.output_units = {"%"};
    layout.groups[0].rooms = {{"cell", false}, {"the \"post\"", true}};
    layout.axes[1].group = "feeder \"left\"";
    layout.blocks = {{"cell.pick", reinterpret_cast<const std::byte*>(&block_of_rich_machine), sizeof block_of_rich_machine}};
    machine.recorded = 5;
    draw(machine, 1);
}

}  // namespace taktwerk::hmi::test
