#include "runtime/machine/row_writer.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/check/mapped_objects.hpp"
#include "runtime/machine/row_layout.hpp"

namespace taktwerk::runtime {

namespace {

using axes::AxisView;
using Row = SignalRing::Row;

/// Small numbers side by side in one word, the first one lowest. Their places stand in row_layout.cpp.
class Packed {
public:
    template <class T>
    Packed& add(T value, unsigned bits) noexcept {
        word_ |= (static_cast<std::uint64_t>(value) & (~std::uint64_t{0} >> (64 - bits))) << at_;
        at_ += bits;
        return *this;
    }
    [[nodiscard]] std::uint64_t word() const noexcept { return word_; }

private:
    std::uint64_t word_ = 0;
    unsigned at_ = 0;
};

/// What does not fit is as large as what does.
std::int32_t short_time(std::int64_t ns) noexcept {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(ns, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()));
}

void put_axis(Row& row, const AxisView& v) noexcept {
    row.put(v.set_position);
    row.put(v.set_velocity);
    row.put(v.set_acceleration);
    row.put(v.set_jerk);
    row.put(v.actual_position);
    row.put(v.actual_velocity);
    row.put(v.actual_torque);
    row.put(v.following_error);
    row.put(v.target_position);
    row.put(Packed{}
                .add(v.state, 8)
                .add(v.drive_state, 8)
                .add(v.owner, 8)
                .add(v.limiter, 8)
                .add(v.active_kind, 8)
                .add(v.drive_mode, 8)
                .add(v.homed, 1)
                .add(v.lock != 0, 1)
                .add(v.powered, 1)
                .add(v.online, 1)
                .add(v.in_position, 1)
                .add(v.warning, 1)
                .add(v.negative_limit_switch, 1)
                .add(v.positive_limit_switch, 1)
                .add(v.home_switch, 1)
                .add(v.resetting, 1)
                .add(v.brake, 3)
                .add(v.presence, 2)
                .word());
    row.put(Packed{}.add(v.active, 32).add(v.error, 16).add(v.status_word, 16).word());
    row.put(Packed{}.add(v.digital_inputs, 32).add(v.drive_error, 16).add(v.queued_count, 8).word());
}

/// In hundredths of a percent.
std::uint16_t short_part(float part) noexcept {
    constexpr float scale = 10'000, most = 65'535;
    return static_cast<std::uint16_t>(std::min(part * scale + 0.5F, most));
}

void put_group(Row& row, const SeenGroup& g, const MachineLayout::GroupInfo& info) noexcept {
    if (info.arm) {
        constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
        for (const auto& pose : {g.tool.set, g.tool.actual})
            for (const double value : pose) row.put(g.tool.known ? value : nowhere);
        row.put(g.tool.known ? g.tool.speed : nowhere);
        row.put(g.tool.known ? g.tool.actual_speed : nowhere);
    }
    row.put(g.along.velocity);
    row.put(g.along.acceleration);
    row.put(g.along.to_go);
    row.put(100 * g.along.progress);
    row.put(g.path_deviation);
    row.put(g.track.lag);
    const bool by_axis = g.along.limiter == axes::PathLimiter::axis && g.along.limiting_place < g.members.size() &&
                         g.members[g.along.limiting_place].valid();
    row.put(Packed{}
                .add(g.state, 8)
                .add(g.along.limiter, 8)
                .add(by_axis ? g.members[g.along.limiting_place].index + 1 : 0, 16)
                .add(g.active_kind, 8)
                .add(g.queued, 8)
                .add(g.interrupted, 1)
                .add(g.track.kind, 2)
                .add(g.track.in_sync, 1)
                .word());
    row.put(Packed{}.add(g.active, 32).add(g.error, 16).word());
    for (std::size_t i = 0; i < info.members.size(); ++i) {
        const bool there = g.members[i].index == info.members[i];  // else a program has put another one there
        const auto use = there ? g.use[i] : SeenGroup::Use{};
        row.put(Packed{}.add(short_part(use.velocity), 16).add(short_part(use.acceleration), 16).add(short_part(use.jerk), 16).word());
    }
}

/// 64 of them a word.
template <class ValueOf>
void put_bits(Row& row, const std::vector<std::uint16_t>& points, const ValueOf& value_of) noexcept {
    std::uint64_t word = 0;
    unsigned at = 0;
    for (const auto point : points) {
        word |= static_cast<std::uint64_t>(value_of(point) != 0) << at;
        if (++at < 64) continue;
        row.put(word);
        word = at = 0;
    }
    if (at > 0) row.put(word);
}

}  // namespace

RowWriter::Points RowWriter::split(const MachineConfig& config, const std::vector<std::string>& names,
                                   const std::vector<std::string>& units, IoDirection direction) {
    Points out;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool bit = units[i].empty() && bits_of_point(config, names[i], direction) == 1;
        (bit ? out.bits : out.words).push_back(static_cast<std::uint16_t>(i));
    }
    return out;
}

RowWriter::Plan RowWriter::plan(const MachineBody& body, const MachineLayout& layout) {
    Plan out;
    out.inputs = split(body.config, layout.inputs, layout.input_units, IoDirection::input);
    out.outputs = split(body.config, layout.outputs, layout.output_units, IoDirection::output);
    RowLayout row;
    row.add_machine();
    row.add_tasks(layout);
    row.add_axes(layout);
    row.add_groups(layout);
    row.add_points(SignalGroup::input, layout.inputs, layout.input_units, out.inputs.bits);
    row.add_points(SignalGroup::output, layout.outputs, layout.output_units, out.outputs.bits);
    row.add_variables(layout);
    out.groups = layout.groups;
    out.words = row.words();
    out.signals = row.take_signals();
    return out;
}

RowWriter::RowWriter(const MachineBody& body, const GroupDesk& groups, const ProgramRunner& programs, const MachineLayout& layout)
    : RowWriter(body, groups, programs, plan(body, layout)) {}

RowWriter::RowWriter(const MachineBody& body, const GroupDesk& groups, const ProgramRunner& programs, Plan plan)
    : body_(body),
      groups_(groups),
      programs_(programs),
      group_places_(std::move(plan.groups)),
      inputs_(std::move(plan.inputs)),
      outputs_(std::move(plan.outputs)),
      ring_(std::move(plan.signals), plan.words, rows_of(body.config.recording, body.config.cycle), body.config.cycle) {}

void RowWriter::step() noexcept {
    auto row = ring_.begin(body_.cycles);
    const auto& statistics = body_.statistics;
    row.put(body_.now.time_since_epoch());
    row.put(Packed{}
                .add(body_.emergency, 1)
                .add(body_.mode, 3)
                .add(body_.phase.load(std::memory_order_relaxed), 4)
                .add(body_.log.alarms().size(), 16)
                .word());
    row.put(Packed{}.add(short_time(statistics.lateness.count()), 32).add(short_time(statistics.compute.count()), 32).word());
    const auto& bus = body_.bus.statistics();
    row.put(Packed{}.add(short_time(bus.dc_phase_error_ns), 32).add(bus.frames_lost, 32).word());
    const auto& tasks = programs_.times().statistics();
    for (std::size_t i = 0; i < tasks.size(); i += 2)
        row.put(Packed{}
                    .add(short_time(tasks[i].run.count()), 32)
                    .add(i + 1 < tasks.size() ? short_time(tasks[i + 1].run.count()) : 0, 32)
                    .word());
    for (const auto& axis : body_.axes) put_axis(row, axis.view());
    const auto groups = groups_.seen();
    for (std::size_t i = 0; i < groups.size(); ++i) put_group(row, groups[i], group_places_[i]);
    const auto input = [&](std::uint16_t i) { return body_.io.input_values()[i].value; };
    const auto output = [&](std::uint16_t i) { return body_.io.output_value(i); };
    put_bits(row, inputs_.bits, input);
    for (const auto i : inputs_.words) row.put(input(i));
    put_bits(row, outputs_.bits, output);
    for (const auto i : outputs_.words) row.put(output(i));
    for (const auto value : programs_.variables()) row.put(value);
    ring_.commit();
}

}  // namespace taktwerk::runtime
