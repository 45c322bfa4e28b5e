#include "hmi_bridge/lcm/publisher.hpp"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "axes/axis/error_table.hpp"
#include "axes/group/group_words.hpp"
#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/lcm/whole_publisher.hpp"
#include "hmi_bridge/message_count.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "hmi_bridge/words/words.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "taktwerk_lcm/axis_holder_v1_t.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_event_v1_t.hpp"
#include "taktwerk_lcm/cycle_statistics_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"
#include "taktwerk_lcm/io_state_v1_t.hpp"
#include "taktwerk_lcm/machine_state_v1_t.hpp"
#include "taktwerk_lcm/program_values_v1_t.hpp"

namespace taktwerk::hmi {

using namespace taktwerk_lcm;

namespace {

constexpr Duration statistics_period = std::chrono::milliseconds{200};
constexpr Duration alarm_period = std::chrono::milliseconds{500};
constexpr Duration holder_period = std::chrono::milliseconds{500};
constexpr Duration heartbeat_period = std::chrono::milliseconds{100};

template <class E>
constexpr std::int32_t number(E value) {
    return static_cast<std::int32_t>(value);
}
std::int32_t size32(std::size_t n) { return static_cast<std::int32_t>(n); }

/// The messages carry the enumerators' numbers: those must be the constants of the types.
static_assert(number(runtime::MachinePhase::failed) == machine_state_v1_t::PHASE_FAILED);
static_assert(number(runtime::ProgramState::fault) == machine_state_v1_t::PROGRAM_FAULT);
static_assert(number(ecat::Master::Phase::operational) == machine_state_v1_t::BUS_OPERATIONAL);
static_assert(number(ecat::Master::Phase::stopped) == machine_state_v1_t::BUS_STOPPED);
static_assert(number(axes::AxisState::ErrorStop) == axis_state_v1_t::STATE_ERROR_STOP);
static_assert(number(axes::AxisState::Homing) == axis_state_v1_t::STATE_HOMING);
static_assert(number(axes::Owner::commissioning) == axis_state_v1_t::OWNER_COMMISSIONING);
static_assert(number(axes::VelocityLimiter::stopping) == axis_state_v1_t::LIMITER_STOPPING);
static_assert(number(axes::PowerState::fault) == axis_state_v1_t::DRIVE_FAULT);
static_assert(number(axes::DriveMode::cyclic_torque) == axis_state_v1_t::MODE_CYCLIC_TORQUE);
static_assert(number(AlarmSource::hmi) == alarm_v1_t::SOURCE_HMI);
static_assert(number(Reaction::power_off) == alarm_v1_t::REACTION_POWER_OFF);
static_assert(number(VariableType::duration) == program_values_v1_t::TYPE_DURATION);

/// A grid of due times that skips what it missed.
struct Due {
    Duration period{};
    Instant next{};
    bool operator()(Instant now) {
        if (now < next) return false;
        next += period;
        if (next <= now) next = now + period;
        return true;
    }
};

/// Equal when nobody who reads the list would see a difference.
struct AlarmMark {
    AlarmId id = 0;
    AlarmSource source = AlarmSource::machine;
    std::uint16_t index = 0;
    std::uint32_t count = 0;
    bool standing = false, acknowledged = false;
    double number = 0, detail = 0;  // of an axis: what makes the text of a drive's alarm complete; others change each cycle
    friend bool operator==(const AlarmMark&, const AlarmMark&) = default;
};

/// Equal when nobody who reads who holds an axis would see a difference.
struct HolderMark {
    axes::Owner owner = axes::Owner::none;
    axes::CommandKind kind = axes::CommandKind::none;
    const void* holder = nullptr;
    bool held = false;
    axes::VelocityLimiter limiter = axes::VelocityLimiter::none;
    friend bool operator==(const HolderMark&, const HolderMark&) = default;
};

}  // namespace

struct Publisher::Impl {
    MessageBus& bus;
    const MachineLink& machine;
    Channels channels;
    bool commands_taken;
    std::function<std::int64_t()> wall_utime;
    Due state, statistics{statistics_period}, alarms{alarm_period}, heartbeat{heartbeat_period}, holders{holder_period};
    std::int64_t sequence = 0, alarm_revision = 0;
    std::uint64_t failed = 0;
    std::vector<AlarmMark> shown_alarms{}, present_alarms{};
    std::vector<HolderMark> shown_holders{};
    struct ShownEvent {
        std::uint64_t number = 0;
        std::uint32_t times = 0;
    };
    std::vector<ShownEvent> shown_events{};
    std::uint64_t last_event = 0;
    std::vector<std::byte> buffer = std::vector<std::byte>(4 * message_size_aim);

    // Kept from one message to the next: their strings and arrays have their memory already.
    machine_state_v1_t machine_message{};
    axis_state_v1_t axis_message{};
    cycle_statistics_v1_t statistics_message{};
    io_state_v1_t io_message{};
    program_values_v1_t values_message{};
    std::optional<WholePublisher> whole{};

    template <class Message>
    void send(const std::string& channel, Message& message) {
        message.utime = wall_utime();
        message.seq = ++sequence;
        message.protocol_version = protocol_version;
        const auto size = static_cast<std::size_t>(message.getEncodedSize());
        if (buffer.size() < size) buffer.resize(size);
        const bool ok = message.encode(buffer.data(), 0, static_cast<int>(size)) == static_cast<int>(size) &&
                        bus.publish(channel, std::span(buffer).first(size));
        if (!ok) ++failed;
    }

    void send_machine(const runtime::Snapshot& s);
    void send_axes(const runtime::Snapshot& s);
    void send_holders(const runtime::Snapshot& s, bool all);
    void send_events(const runtime::Snapshot& s, bool repeated);
    void send_statistics(const runtime::Snapshot& s);
    void send_io(const runtime::Snapshot& s);
    void send_values(const runtime::Snapshot& s);
    bool alarms_changed(const runtime::Snapshot& s);
    void send_alarms(const runtime::Snapshot& s);
    void send_heartbeat(const runtime::Snapshot* s);
};

Publisher::Publisher(MessageBus& bus, const MachineLink& machine, double rate_hz, bool commands_taken,
                     std::function<std::int64_t()> wall_utime)
    : impl_(new Impl{bus, machine, Channels(machine.layout().machine), commands_taken, std::move(wall_utime),
                     Due{from_seconds(1 / rate_hz)}}) {}

Publisher::~Publisher() = default;

std::uint64_t Publisher::failed() const noexcept { return impl_->failed; }

void Publisher::publish_whole_states(std::int64_t run, NameOfClient who) {
    impl_->whole.emplace(impl_->bus, impl_->machine, impl_->state.period, run, std::move(who));
}

void Publisher::step(const runtime::Snapshot* snapshot, Instant now) {
    auto& p = *impl_;
    if (p.heartbeat(now)) p.send_heartbeat(snapshot);
    if (!snapshot) return;
    if (p.state(now)) {
        p.send_machine(*snapshot);
        p.send_axes(*snapshot);
        p.send_io(*snapshot);
        p.send_values(*snapshot);
    }
    if (p.whole && p.whole->due(now) && !p.whole->publish(*snapshot, ++p.sequence, p.wall_utime())) ++p.failed;
    if (p.statistics(now)) p.send_statistics(*snapshot);
    const bool all_holders = p.holders(now);
    p.send_holders(*snapshot, all_holders);
    p.send_events(*snapshot, all_holders);
    const bool due = p.alarms(now);
    if (p.alarms_changed(*snapshot) || due) p.send_alarms(*snapshot);
}

void Publisher::Impl::send_machine(const runtime::Snapshot& s) {
    const auto& layout = machine.layout();
    auto& m = machine_message;
    m.cycle_time_ns = count(s.at);
    m.cycle_count = count(s.cycle);
    m.cycle_period_ns = count(layout.cycle);
    m.machine = layout.machine;
    m.phase = number(s.phase);
    m.mode = number(s.mode);
    m.emergency_stop = s.emergency_stop;
    m.simulated = s.simulated;
    m.bus_phase = number(s.bus_phase);
    m.alarm_count = size32(s.alarm_count);
    auto strongest = Reaction::none;
    for (std::size_t i = 0; i < s.alarm_count && i < s.alarms.size(); ++i)
        if (s.alarms[i].standing) strongest = std::max(strongest, s.alarms[i].reaction);
    m.strongest_reaction = number(strongest);
    m.axis_count = size32(s.axes.size());
    const auto programs = std::min(s.programs.size(), layout.programs.size());
    m.program_count = size32(programs);
    m.program_name.assign(layout.programs.begin(), layout.programs.begin() + static_cast<std::ptrdiff_t>(programs));
    m.program_state.resize(programs);
    for (std::size_t i = 0; i < programs; ++i) m.program_state[i] = number(s.programs[i]);
    const auto slaves = std::min(s.slaves.size(), layout.slaves.size());
    m.slave_count = size32(slaves);
    m.slave_name.assign(layout.slaves.begin(), layout.slaves.begin() + static_cast<std::ptrdiff_t>(slaves));
    m.slave_al_state.resize(slaves);
    m.slave_al_status_code.resize(slaves);
    m.slave_age.resize(slaves);
    for (std::size_t i = 0; i < slaves; ++i) {
        m.slave_al_state[i] = number(s.slaves[i].al_state);
        m.slave_al_status_code[i] = s.slaves[i].al_status_code;
        m.slave_age[i] = static_cast<std::int32_t>(std::min<std::uint32_t>(s.slaves[i].age, INT32_MAX));
    }
    send(channels.machine_state(), m);
}

void Publisher::Impl::send_axes(const runtime::Snapshot& s) {
    const auto& layout = machine.layout();
    const auto channel = channels.axis_state();
    auto& m = axis_message;
    for (std::size_t i = 0; i < s.axes.size() && i < layout.axes.size(); ++i) {
        const auto& axis = s.axes[i];
        m.cycle_time_ns = count(s.at);
        m.cycle_count = count(s.cycle);
        m.axis_index = size32(i);
        m.axis_count = size32(s.axes.size());
        m.name = layout.axes[i].name;
        m.unit = layout.axes[i].unit;
        m.state = number(axis.state);
        m.owner = number(axis.owner);
        m.error = axis.error;
        m.drive_error = axis.drive_error;
        m.actual_position = axis.actual_position;
        m.actual_velocity = axis.actual_velocity;
        m.actual_torque = axis.actual_torque;
        m.set_position = axis.set_position;
        m.set_velocity = axis.set_velocity;
        m.set_acceleration = axis.set_acceleration;
        m.set_jerk = axis.set_jerk;
        m.target_position = axis.target_position;
        m.distance_to_go = axis.active != 0 ? axis.target_position - axis.set_position : 0;
        m.following_error = axis.following_error;
        const auto peak = i < s.following_peaks.size() ? s.following_peaks[i] : runtime::FollowingPeak{};
        m.following_error_min = peak.minimum;
        m.following_error_max = peak.maximum;
        m.manual_slow = axis.manual_slow;
        m.manual_fast = axis.manual_fast;
        m.velocity_limiter = number(axis.limiter);
        m.disabled = layout.axes[i].disabled;
        m.simulated = axis.simulated;
        m.online = axis.online;
        m.powered = axis.powered;
        m.homed = axis.homed;
        m.in_position = axis.in_position;
        m.not_moving = axis.set_velocity == 0;
        m.positive_direction = axis.set_velocity > 0;
        m.negative_direction = axis.set_velocity < 0;
        m.constant_velocity = axis.set_velocity != 0 && axis.set_acceleration == 0;
        m.has_job = axis.active != 0;
        m.queued = axis.queued_count;
        m.homing_busy = axis.state == axes::AxisState::Homing;
        m.resetting = axis.resetting;
        m.warning = axis.warning;
        m.negative_limit_switch = axis.negative_limit_switch;
        m.positive_limit_switch = axis.positive_limit_switch;
        m.home_switch = axis.home_switch;
        m.drive_state = number(axis.drive_state);
        m.drive_mode = number(axis.drive_mode);
        m.status_word = axis.status_word;
        send(channel, m);
    }
}

void Publisher::Impl::send_holders(const runtime::Snapshot& s, bool all) {
    const auto& layout = machine.layout();
    const auto count_axes = std::min(s.axes.size(), layout.axes.size());
    shown_holders.resize(count_axes);
    for (std::size_t i = 0; i < count_axes; ++i) {
        const auto& axis = s.axes[i];
        const HolderMark mark{axis.owner, axis.active_kind, axis.holder, axis.lock != 0, axis.limiter};
        if (!all && mark == shown_holders[i]) continue;
        shown_holders[i] = mark;
        axis_holder_v1_t m{};
        m.cycle_time_ns = count(s.at);
        m.axis_index = size32(i);
        m.name = layout.axes[i].name;
        m.owner = axes::name(axis.owner);
        m.command = word(axis.active_kind);
        m.block = layout.block_at(axis.holder);
        m.held_by_stop = mark.held;
        m.velocity_limiter = word(axis.limiter);
        send(channels.axis_holder(), m);
    }
}

void Publisher::Impl::send_events(const runtime::Snapshot& s, bool repeated) {
    const auto& layout = machine.layout();
    const auto program = [&](const runtime::CommandGiver& giver) {
        return giver.program < layout.programs.size() ? layout.programs[giver.program] : std::string{};
    };
    const auto block = [&](const runtime::CommandGiver& giver) {
        return giver.block ? std::string(layout.block_at(giver.block)) : std::string{};
    };
    for (std::size_t i = 0; i < s.event_count && i < s.events.size(); ++i) {
        const auto& event = s.events[i];
        auto known = std::find_if(shown_events.begin(), shown_events.end(), [&](const ShownEvent& e) { return e.number == event.number; });
        const bool is_new = event.number > last_event;
        if (!is_new && !(repeated && known != shown_events.end() && known->times != event.times)) continue;
        if (known == shown_events.end()) known = shown_events.insert(shown_events.end(), {event.number, 0});
        known->times = event.times;
        const auto words = describe(event, layout);
        const auto* error = axes::find_error(event.error);
        command_event_v1_t m{};
        m.number = count(event.number);
        m.time_ns = count(event.at);
        m.times = static_cast<std::int32_t>(std::min<std::uint32_t>(event.times, INT32_MAX));
        m.event = word(event.what);
        const bool of_group = event.group < layout.groups.size();
        m.axis = of_group                          ? layout.groups[event.group].name
                 : event.axis < layout.axes.size() ? layout.axes[event.axis].name
                                                   : std::string{};
        m.command = of_group ? name(event.given.group_kind) : word(event.given.kind);
        m.program = program(event.given);
        m.block = block(event.given);
        m.by_command = of_group ? name(event.by.group_kind) : word(event.by.kind);
        m.by_program = program(event.by);
        m.by_block = block(event.by);
        m.held_by_stop = event.held;
        m.error = error && event.error != axes::ErrorId::none ? error->name : std::string_view{};
        m.english = of_group ? fmt::format("{}: {}", event_subject(event, layout), words.what) : words.what;
        m.remedy = words.remedy;
        send(channels.command_event(), m);
        last_event = std::max(last_event, event.number);
    }
    if (s.event_count > 0) std::erase_if(shown_events, [&](const ShownEvent& e) { return e.number < s.events[0].number; });
}

void Publisher::Impl::send_statistics(const runtime::Snapshot& s) {
    auto& m = statistics_message;
    m.cycle_time_ns = count(s.at);
    m.cycle_count = count(s.statistics.cycles);
    m.overruns = count(s.statistics.overruns);
    m.missed_ticks = count(s.statistics.missed_ticks);
    m.lateness_ns = count(s.statistics.lateness);
    m.lateness_max_ns = count(s.statistics.lateness_max);
    m.compute_ns = count(s.statistics.compute);
    m.compute_max_ns = count(s.statistics.compute_max);
    m.snapshots_dropped = count(s.statistics.snapshots_dropped);
    m.commands_refused = count(s.statistics.commands_refused);
    m.frames_sent = count(s.bus.frames_sent);
    m.frames_received = count(s.bus.frames_received);
    m.frames_lost = count(s.bus.frames_lost);
    m.frames_late = count(s.bus.frames_late);
    m.frames_rejected = count(s.bus.frames_rejected);
    m.send_errors = count(s.bus.send_errors);
    m.working_counter_errors = count(s.bus.working_counter_errors);
    m.lost_in_a_row = s.bus.lost_in_a_row;
    m.dc_difference_ns = s.bus.dc_difference_ns;
    m.round_trip_ns = count(s.bus.round_trip);
    const auto& names = machine.layout().tasks;
    const auto tasks = std::min(s.tasks.size(), names.size());
    m.task_count = size32(tasks);
    m.task_name.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(tasks));
    m.task_releases.resize(tasks);
    m.task_overruns.resize(tasks);
    m.task_run_ns.resize(tasks);
    m.task_run_max_ns.resize(tasks);
    for (std::size_t i = 0; i < tasks; ++i) {
        m.task_releases[i] = count(s.tasks[i].releases);
        m.task_overruns[i] = count(s.tasks[i].overruns);
        m.task_run_ns[i] = count(s.tasks[i].run);
        m.task_run_max_ns[i] = count(s.tasks[i].run_max);
    }
    send(channels.cycle_statistics(), m);
}

void Publisher::Impl::send_io(const runtime::Snapshot& s) {
    const auto& layout = machine.layout();
    const auto inputs = std::min(s.inputs.size(), layout.inputs.size());
    const auto total = inputs + std::min(s.outputs.size(), layout.outputs.size());
    auto& m = io_message;
    for (std::size_t first = 0; first < total; first += points_per_message) {
        const auto points = std::min(points_per_message, total - first);
        m.cycle_time_ns = count(s.at);
        m.cycle_count = count(s.cycle);
        m.total = size32(total);
        m.first = size32(first);
        m.point_count = size32(points);
        m.name.resize(points);
        m.output.resize(points);
        m.value.resize(points);
        for (std::size_t i = 0; i < points; ++i) {
            const bool output = first + i >= inputs;
            const auto point = output ? first + i - inputs : first + i;
            m.name[i] = output ? layout.outputs[point] : layout.inputs[point];
            m.output[i] = output;
            m.value[i] = output ? s.outputs[point] : s.inputs[point];
        }
        send(channels.io_state(), m);
    }
}

void Publisher::Impl::send_values(const runtime::Snapshot& s) {
    const auto& layout = machine.layout();
    const auto variables = std::min(s.variables.size(), layout.variables.size());
    const auto total = variables + std::min(s.parameters.size(), layout.parameters.size());
    auto& m = values_message;
    for (std::size_t first = 0; first < total; first += values_per_message) {
        const auto values = std::min(values_per_message, total - first);
        m.cycle_time_ns = count(s.at);
        m.cycle_count = count(s.cycle);
        m.total = size32(total);
        m.first = size32(first);
        m.value_count = size32(values);
        m.program.resize(values);
        m.name.resize(values);
        m.unit.resize(values);
        m.parameter.resize(values);
        m.type.resize(values);
        m.value.resize(values);
        m.minimum.resize(values);
        m.maximum.resize(values);
        for (std::size_t i = 0; i < values; ++i) {
            if (first + i < variables) {
                const auto& info = layout.variables[first + i];
                m.program[i] = info.program;
                m.name[i] = info.name;
                m.unit[i] = info.unit;
                m.parameter[i] = false;
                m.type[i] = number(info.type);
                m.value[i] = s.variables[first + i];
                m.minimum[i] = m.maximum[i] = 0;
            } else {
                const auto& info = layout.parameters[first + i - variables];
                m.program[i] = info.program;
                m.name[i] = info.name;
                m.unit[i] = info.unit;
                m.parameter[i] = true;
                m.type[i] = program_values_v1_t::TYPE_REAL;
                m.value[i] = s.parameters[first + i - variables];
                m.minimum[i] = info.minimum;
                m.maximum[i] = info.maximum;
            }
        }
        send(channels.program_values(), m);
    }
}

bool Publisher::Impl::alarms_changed(const runtime::Snapshot& s) {
    present_alarms.clear();
    for (std::size_t i = 0; i < s.alarm_count && i < s.alarms.size(); ++i) {
        const auto& a = s.alarms[i];
        const bool of_axis = a.fact.source == AlarmSource::axis;
        present_alarms.push_back(
            {a.fact.id, a.fact.source, a.fact.index, a.count, a.standing, a.acknowledged, of_axis ? a.fact.a : 0, of_axis ? a.fact.b : 0});
    }
    if (present_alarms == shown_alarms) return false;
    shown_alarms = present_alarms;
    return true;
}

void Publisher::Impl::send_alarms(const runtime::Snapshot& s) {
    const auto total = std::min(s.alarm_count, s.alarms.size());
    alarm_list_v1_t m{};
    m.cycle_time_ns = count(s.at);
    m.revision = ++alarm_revision;
    m.total = size32(total);
    const auto channel = channels.alarm_list();
    const auto publish = [&](std::size_t next) {
        m.alarm_count = size32(m.alarm.size());
        send(channel, m);
        m.alarm.clear();
        m.first = size32(next);
    };
    for (std::size_t i = 0; i < total; ++i) {
        const auto& alarm = s.alarms[i];
        const auto words = machine.describe(alarm.fact);
        alarm_v1_t entry{};
        entry.id = alarm.fact.id;
        entry.name = words.name;
        entry.source = number(alarm.fact.source);
        entry.source_index = alarm.fact.index;
        entry.source_text = words.source;
        entry.since_ns = count(alarm.since);
        entry.count = alarm.count;
        entry.standing = alarm.standing;
        entry.acknowledged = alarm.acknowledged;
        entry.reaction = number(alarm.reaction);
        entry.english = words.english;
        entry.chinese = words.chinese;
        entry.cause = words.cause;
        entry.remedy = words.remedy;
        entry.reset = words.reset;
        m.alarm_count = size32(m.alarm.size());
        const auto with_it = static_cast<std::size_t>(m.getEncodedSize()) + static_cast<std::size_t>(entry._getEncodedSizeNoHash());
        if (!m.alarm.empty() && with_it > message_size_aim) publish(i);
        m.alarm.push_back(std::move(entry));
    }
    publish(total);  // an empty list is news too
}

void Publisher::Impl::send_heartbeat(const runtime::Snapshot* s) {
    heartbeat_v1_t m{};
    m.pid = ::getpid();
    m.cycle_count = s ? count(s->cycle) : 0;
    m.phase = s ? number(s->phase) : number(runtime::MachinePhase::starting);
    m.cycling = s != nullptr;
    m.commands_taken = commands_taken;
    send(channels.heartbeat(), m);
}

}  // namespace taktwerk::hmi
