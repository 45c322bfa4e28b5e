#include "runtime/machine/row_layout.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "axes/axis/axis_view.hpp"
#include "axes/axis/command_kinds.hpp"
#include "axes/group/group_words.hpp"

namespace taktwerk::runtime {

namespace {

using Kind = SignalKind;
using Coding = SignalCell::Coding;
using States = std::vector<std::pair<int, std::string>>;

constexpr std::array<std::string_view, 7> limiters{"none",           "command", "axis_limit", "manual_speed", "override_factor",
                                                   "software_limit", "stopping"};
constexpr std::array<std::string_view, 5> brakes{"not_controlled", "closed", "opening", "open", "closing"};
constexpr std::array<std::string_view, 3> modes{"manual", "setup", "automatic"};
constexpr std::array<std::string_view, 5> phases{"starting", "running", "stopping", "stopped", "failed"};

template <std::size_t Count>
States states_of(const std::array<std::string_view, Count>& names) {
    States out;
    for (std::size_t i = 0; i < Count; ++i) out.emplace_back(static_cast<int>(i), std::string(names[i]));
    return out;
}
/// Of an enumeration that counts from 0 and has a name() for each.
template <class Enum>
States states_of(Enum last) {
    States out;
    for (int i = 0; i <= static_cast<int>(last); ++i) out.emplace_back(i, std::string(name(static_cast<Enum>(i))));
    return out;
}
States axis_states() { return states_of(axes::AxisState::ErrorStop); }
States drive_states() { return states_of(axes::PowerState::fault); }
States drive_modes() { return states_of(axes::DriveMode::cyclic_torque); }
States owners() { return states_of(axes::Owner::commissioning); }
States presences() { return states_of(axes::Presence::present); }
States commands() { return states_of(axes::CommandKind::set_torque_limit); }
States limiter_words() { return states_of(limiters); }
States brake_words() { return states_of(brakes); }

constexpr SignalCell real(std::uint16_t word) { return {word, 0, 64, Coding::real, 1}; }
constexpr SignalCell field(std::uint16_t word, std::uint8_t first_bit, std::uint8_t bits) {
    return {word, first_bit, bits, Coding::natural, 1};
}
constexpr SignalCell microseconds(std::uint16_t word, std::uint8_t first_bit) { return {word, first_bit, 32, Coding::integer, 1e3}; }

enum class Shown : std::uint8_t { in_trace, in_scope };
constexpr const char* no_unit = nullptr;

/// What is recorded of each axis; places count from the axis' first word.
struct AxisSignal {
    const char* name;
    Kind kind;
    const char* per;  ///< behind the axis' unit; no_unit: the value has none
    SignalCell cell;
    Shown shown;
    const char* english;
    const char* chinese;
    States (*states)() = nullptr;
};
constexpr std::uint16_t axis_words = 12;
constexpr AxisSignal axis_signals[] = {
    {"state", Kind::state, no_unit, field(9, 0, 8), Shown::in_trace, "state", "轴状态", axis_states},
    {"set_position", Kind::real, "", real(0), Shown::in_trace, "set position", "设定位置"},
    {"set_velocity", Kind::real, "/s", real(1), Shown::in_trace, "set velocity", "设定速度"},
    {"set_acceleration", Kind::real, "/s2", real(2), Shown::in_trace, "set acceleration", "设定加速度"},
    {"set_jerk", Kind::real, "/s3", real(3), Shown::in_trace, "set jerk", "设定加加速度"},
    {"actual_position", Kind::real, "", real(4), Shown::in_trace, "actual position", "实际位置"},
    {"actual_velocity", Kind::real, "/s", real(5), Shown::in_trace, "actual velocity", "实际速度"},
    {"actual_torque", Kind::real, no_unit, real(6), Shown::in_trace, "actual torque (1 = rated)", "实际转矩（1 = 额定）"},
    {"following_error", Kind::real, "", real(7), Shown::in_trace, "following error", "跟随误差"},
    {"target_position", Kind::real, "", real(8), Shown::in_trace, "target position", "目标位置"},
    {"active", Kind::whole, no_unit, field(10, 0, 32), Shown::in_trace, "number of the command in control", "当前指令编号"},
    {"drive_state", Kind::state, no_unit, field(9, 8, 8), Shown::in_trace, "drive state", "驱动器状态", drive_states},
    {"homed", Kind::bit, no_unit, field(9, 48, 1), Shown::in_trace, "homed", "已回零"},
    {"error", Kind::whole, no_unit, field(10, 32, 16), Shown::in_trace, "error number", "错误号"},
    {"owner", Kind::state, no_unit, field(9, 16, 8), Shown::in_trace, "who commands it", "控制方", owners},
    {"velocity_limiter", Kind::state, no_unit, field(9, 24, 8), Shown::in_trace, "what limits the velocity", "速度限制原因", limiter_words},
    {"held_by_stop", Kind::bit, no_unit, field(9, 49, 1), Shown::in_trace, "held by MC_Stop", "被 MC_Stop 锁定"},
    {"command", Kind::state, no_unit, field(9, 32, 8), Shown::in_trace, "command", "指令", commands},
    {"powered", Kind::bit, no_unit, field(9, 50, 1), Shown::in_scope, "powered", "已上电"},
    {"online", Kind::bit, no_unit, field(9, 51, 1), Shown::in_scope, "feedback is fresh", "反馈有效"},
    {"in_position", Kind::bit, no_unit, field(9, 52, 1), Shown::in_scope, "in position", "到位"},
    {"warning", Kind::bit, no_unit, field(9, 53, 1), Shown::in_scope, "drive warning", "驱动器警告"},
    {"negative_limit", Kind::bit, no_unit, field(9, 54, 1), Shown::in_scope, "negative limit switch", "负限位开关"},
    {"positive_limit", Kind::bit, no_unit, field(9, 55, 1), Shown::in_scope, "positive limit switch", "正限位开关"},
    {"home_switch", Kind::bit, no_unit, field(9, 56, 1), Shown::in_scope, "home switch", "原点开关"},
    {"resetting", Kind::bit, no_unit, field(9, 57, 1), Shown::in_scope, "a reset is under way", "正在复位"},
    {"brake", Kind::state, no_unit, field(9, 58, 3), Shown::in_scope, "holding brake", "抱闸", brake_words},
    {"presence", Kind::state, no_unit, field(9, 61, 2), Shown::in_scope, "presence of its group", "所在组是否在线", presences},
    {"drive_mode", Kind::state, no_unit, field(9, 40, 8), Shown::in_scope, "mode of the drive", "驱动器模式", drive_modes},
    {"status_word", Kind::word, no_unit, field(10, 48, 16), Shown::in_scope, "status word (6041h)", "状态字 (6041h)"},
    {"drive_error", Kind::whole, no_unit, field(11, 32, 16), Shown::in_scope, "error code of the drive (603Fh)", "驱动器错误码 (603Fh)"},
    {"drive_inputs", Kind::word, no_unit, field(11, 0, 32), Shown::in_scope, "inputs of the drive (60FDh)", "驱动器输入 (60FDh)"},
    {"queued", Kind::whole, no_unit, field(11, 48, 8), Shown::in_scope, "commands that wait", "排队指令数"},
};

/// What is recorded of each group of axes; places count from the group's first word. Those of the tool stand first, and only where there is an arm.
struct GroupSignal {
    const char* name;
    Kind kind;
    const char* unit;  ///< "u": the group's, with what stands behind it
    SignalCell cell;
    const char* english;
    const char* chinese;
    States (*states)() = nullptr;
};
constexpr std::uint16_t tool_words = 14, group_words = 8;
constexpr GroupSignal tool_signals[] = {
    {"tool_x", Kind::real, "u", real(0), "set position of the tool, X (MCS)", "工具设定位置 X（MCS）"},
    {"tool_y", Kind::real, "u", real(1), "set position of the tool, Y (MCS)", "工具设定位置 Y（MCS）"},
    {"tool_z", Kind::real, "u", real(2), "set position of the tool, Z (MCS)", "工具设定位置 Z（MCS）"},
    {"tool_rx", Kind::real, "deg", real(3), "set orientation of the tool, RX (MCS)", "工具设定姿态 RX（MCS）"},
    {"tool_ry", Kind::real, "deg", real(4), "set orientation of the tool, RY (MCS)", "工具设定姿态 RY（MCS）"},
    {"tool_rz", Kind::real, "deg", real(5), "set orientation of the tool, RZ (MCS)", "工具设定姿态 RZ（MCS）"},
    {"tool_actual_x", Kind::real, "u", real(6), "actual position of the tool, X (MCS)", "工具实际位置 X（MCS）"},
    {"tool_actual_y", Kind::real, "u", real(7), "actual position of the tool, Y (MCS)", "工具实际位置 Y（MCS）"},
    {"tool_actual_z", Kind::real, "u", real(8), "actual position of the tool, Z (MCS)", "工具实际位置 Z（MCS）"},
    {"tool_actual_rx", Kind::real, "deg", real(9), "actual orientation of the tool, RX (MCS)", "工具实际姿态 RX（MCS）"},
    {"tool_actual_ry", Kind::real, "deg", real(10), "actual orientation of the tool, RY (MCS)", "工具实际姿态 RY（MCS）"},
    {"tool_actual_rz", Kind::real, "deg", real(11), "actual orientation of the tool, RZ (MCS)", "工具实际姿态 RZ（MCS）"},
    {"tool_speed", Kind::real, "u/s", real(12), "set speed of the tool", "工具设定速度"},
    {"tool_actual_speed", Kind::real, "u/s", real(13), "actual speed of the tool", "工具实际速度"},
};
States group_states() { return states_of(axes::GroupState::GroupErrorStop); }
States path_limiters() { return states_of(axes::PathLimiter::setup_velocity); }
States group_tracks() { return states_of(axes::FrameTrack::Kind::table); }
States group_commands() { return states_of(axes::GroupCommandKind::disable); }
constexpr GroupSignal group_signals[] = {
    {"state", Kind::state, "", field(6, 0, 8), "state of the group", "轴组状态", group_states},
    {"path_velocity", Kind::real, "u/s", real(0), "velocity along the path", "路径速度"},
    {"path_acceleration", Kind::real, "u/s2", real(1), "acceleration along the path", "路径加速度"},
    {"distance_to_go", Kind::real, "u", real(2), "path left of the active command", "当前指令剩余路径"},
    {"progress", Kind::real, "%", real(3), "part of the active command's path that is done", "当前指令路径完成比例"},
    {"path_deviation", Kind::real, "u", real(4), "tool off its path", "工具偏离路径"},
    {"track", Kind::state, "", field(6, 49, 2), "what the frame moves with", "跟踪坐标系", group_tracks},
    {"track_in_sync", Kind::bit, "", field(6, 51, 1), "in step with the frame", "已同步"},
    {"track_lag", Kind::real, "u", real(5), "tool behind the frame", "跟踪滞后"},
    {"limiter", Kind::state, "", field(6, 8, 8), "what limits the velocity along the path", "路径速度限制原因", path_limiters},
    {"command", Kind::state, "", field(6, 32, 8), "command", "指令", group_commands},
    {"active", Kind::whole, "", field(7, 0, 32), "number of the command in control", "当前指令编号"},
    {"error", Kind::whole, "", field(7, 32, 16), "error number", "错误号"},
    {"queued", Kind::whole, "", field(6, 40, 8), "commands that wait", "排队指令数"},
    {"interrupted", Kind::bit, "", field(6, 48, 1), "interrupted", "已中断"},
};
constexpr std::uint16_t limiting_axis_bit = 16;  ///< of word 6: 0 = none, else the axis' number in the machine + 1
constexpr double parts_of_a_percent = 100;

std::string unit_of(const GroupSignal& signal, const std::string& group) {
    const std::string_view unit = signal.unit;
    return unit.starts_with('u') ? group + std::string(unit.substr(1)) : std::string(unit);
}

}  // namespace

void RowLayout::add_machine() {
    const auto add = [this](const char* name, const char* unit, Kind kind, SignalGroup group, SignalCell cell, const char* english,
                            const char* chinese, Shown shown, States states = {}) {
        signals_.push_back({name, unit, kind, group, "", english, chinese, cell, shown == Shown::in_trace, std::move(states)});
    };
    using enum SignalGroup;
    add("time_s", "s", Kind::real, machine, {0, 0, 64, Coding::integer, 1e9}, "machine time", "机器时间", Shown::in_trace);
    add("emergency_stop", "", Kind::bit, machine, field(1, 0, 1), "emergency stop", "急停", Shown::in_trace);
    add("alarms", "", Kind::whole, machine, field(1, 8, 16), "alarms in the list", "报警数", Shown::in_trace);
    add("mode", "", Kind::state, machine, field(1, 1, 3), "mode", "模式", Shown::in_scope, states_of(modes));
    add("phase", "", Kind::state, machine, field(1, 4, 4), "phase of the machine", "机器阶段", Shown::in_scope, states_of(phases));
    add("lateness", "us", Kind::real, machine, microseconds(2, 0), "lateness of the cycle", "周期唤醒延迟", Shown::in_scope);
    add("compute_time", "us", Kind::real, machine, microseconds(2, 32), "computing of the cycle before", "上一周期计算时间",
        Shown::in_scope);
    add("dc_phase_error", "us", Kind::real, bus, microseconds(3, 0), "DC phase error", "分布时钟相位误差", Shown::in_scope);
    add("frames_lost", "", Kind::whole, bus, field(3, 32, 32), "frames lost so far", "累计丢帧", Shown::in_scope);
    words_ += 4;
}

void RowLayout::add_tasks(const MachineLayout& layout) {
    for (std::size_t i = 0; i < layout.tasks.size(); ++i)
        signals_.push_back({"task." + layout.tasks[i], "us", Kind::real, SignalGroup::task, layout.tasks[i], "run time", "任务运行时间",
                            microseconds(static_cast<std::uint16_t>(words_ + i / 2), i % 2 == 0 ? 0 : 32)});
    words_ += (layout.tasks.size() + 1) / 2;
}

void RowLayout::add_axes(const MachineLayout& layout) {
    for (const auto& axis : layout.axes) {
        for (const auto& s : axis_signals) {
            auto cell = s.cell;
            cell.word = static_cast<std::uint16_t>(cell.word + words_);
            signals_.push_back({axis.name + "." + s.name, s.per ? axis.unit + s.per : std::string{}, s.kind, SignalGroup::axis, axis.name,
                                s.english, s.chinese, cell, s.shown == Shown::in_trace, s.states ? s.states() : States{}});
        }
        words_ += axis_words;
    }
}

void RowLayout::add_groups(const MachineLayout& layout) {
    for (const auto& group : layout.groups) {
        const auto add = [&](const std::string& name, Kind kind, std::string unit, SignalCell cell, const char* english,
                             const char* chinese, States states) {
            cell.word = static_cast<std::uint16_t>(cell.word + words_);
            signals_.push_back({"group." + group.name + "." + name, std::move(unit), kind, SignalGroup::group, group.name, english, chinese,
                                cell, true, std::move(states)});
        };
        const auto add_all = [&](std::span<const GroupSignal> signals) {
            for (const auto& s : signals)
                add(s.name, s.kind, unit_of(s, group.unit), s.cell, s.english, s.chinese, s.states ? s.states() : States{});
        };
        if (group.arm) {
            add_all(tool_signals);
            words_ += tool_words;
        }
        add_all(group_signals);
        States axes{{0, "none"}};
        for (std::size_t i = 0; i < layout.axes.size(); ++i) axes.emplace_back(static_cast<int>(i) + 1, layout.axes[i].name);
        add("limiting_axis", Kind::state, "", field(6, limiting_axis_bit, 16), "axis whose limit holds the path back", "限制路径速度的轴",
            std::move(axes));
        words_ += group_words;
        for (const auto member : group.members) {
            const auto& axis = layout.axes[member].name;
            const auto part = [](std::uint8_t first_bit) { return SignalCell{0, first_bit, 16, Coding::natural, parts_of_a_percent}; };
            add(axis + "_velocity_use", Kind::real, "%", part(0), "part of its velocity limit that the axis uses", "该轴速度限值的使用比例",
                {});
            add(axis + "_acceleration_use", Kind::real, "%", part(16), "part of its acceleration limit that the axis uses",
                "该轴加速度限值的使用比例", {});
            add(axis + "_jerk_use", Kind::real, "%", part(32), "part of its jerk limit that the axis uses", "该轴加加速度限值的使用比例",
                {});
            ++words_;
        }
    }
}

void RowLayout::add_points(SignalGroup group, const std::vector<std::string>& names, const std::vector<std::string>& units,
                           const std::vector<std::uint16_t>& bits) {
    const bool input = group == SignalGroup::input;
    const auto first_word = words_ + (bits.size() + 63) / 64;
    std::size_t bit = 0, word = 0;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_bit = bit < bits.size() && bits[bit] == i;
        const auto cell = is_bit ? field(static_cast<std::uint16_t>(words_ + bit / 64), static_cast<std::uint8_t>(bit % 64), 1)
                                 : real(static_cast<std::uint16_t>(first_word + word));
        ++(is_bit ? bit : word);
        const auto kind = is_bit ? Kind::bit : units[i].empty() ? Kind::whole : Kind::real;
        signals_.push_back({(input ? "in." : "out.") + names[i], units[i], kind, group, names[i], input ? "input" : "output",
                            input ? "输入" : "输出", cell, true});
    }
    words_ = first_word + word;
}

void RowLayout::add_variables(const MachineLayout& layout) {
    for (const auto& v : layout.variables) {
        const auto kind = v.type == VariableType::boolean                                    ? Kind::bit
                          : v.type == VariableType::real || v.type == VariableType::duration ? Kind::real
                                                                                             : Kind::whole;
        signals_.push_back({v.program + "." + v.name, v.unit, kind, SignalGroup::variable, v.program, v.doc, v.doc,
                            real(static_cast<std::uint16_t>(words_++)), true});
    }
}

std::size_t rows_of(const RecordingConfig& recording, Duration cycle) {
    return static_cast<std::size_t>(std::max<std::int64_t>(recording.depth / cycle, 1));
}

}  // namespace taktwerk::runtime
