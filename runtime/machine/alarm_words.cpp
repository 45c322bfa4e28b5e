#include "runtime/machine/alarm_words.hpp"

#include <array>
#include <span>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/homing/index_doubt.hpp"
#include "axes/port/find_alarm.hpp"
#include "ecat/alarms.hpp"
#include "modbus/tcp/alarms.hpp"
#include "runtime/machine/alarm_ranges.hpp"
#include "runtime/machine/alarm_text.hpp"
#include "runtime/machine/drive_alarm_words.hpp"

namespace taktwerk::runtime {

namespace {

const AlarmInfo* row_of(AlarmId id) {
    for (const std::span<const AlarmInfo> table :
         {std::span<const AlarmInfo>(machine_alarms), std::span<const AlarmInfo>(axes::axis_alarms),
          std::span<const AlarmInfo>(ecat::bus_alarms), std::span<const AlarmInfo>(modbus::tcp::device_alarms)})
        if (const auto* info = find_alarm(table, id)) return info;
    return nullptr;
}

std::string program_alarm_name(AlarmId id) { return fmt::format("program_alarm_{}", alarm_range::programs.number(id)); }

/// The name of whatever stopped the axis: the number is in no list that a person has.
std::string name_of_cause(AlarmId cause) {
    if (const auto* row = row_of(cause)) return std::string(row->name);
    return alarm_range::programs.has(cause) ? program_alarm_name(cause) : fmt::format("alarm {:04X}h", cause);
}

void add(AlarmText& out, std::string_view english_and_chinese) {
    out.english += fmt::format(": {}", english_and_chinese);
    out.chinese += fmt::format(":{}", english_and_chinese);
}

/// The drive complains of what frames that stay away do to it: of frames or SYNC0 that did not come, or of a set-point that went on meanwhile.
/// By its manual's table, else by the groups of IEC 61800-7-201, 603Fh. Nobody's frames explain a mains phase that is lost.
bool of_missing_frames(const axes::DriveProfile& profile, const axes::ShownAlarm& alarm) {
    using axes::DriveAlarmKind;
    const auto found = axes::find_alarm(profile, alarm);
    if (found.row != nullptr || found.kind != DriveAlarmKind::other) switch (found.kind) {
            case DriveAlarmKind::communication:
            case DriveAlarmKind::sync_lost:
            case DriveAlarmKind::left_operational:
            case DriveAlarmKind::link_changed:
            case DriveAlarmKind::following_error:
            case DriveAlarmKind::setpoint_leap: return true;
            default: return false;
        }
    const unsigned group = alarm.code & 0xFF00u;
    // communication, communication, position controller, synchronisation
    return group == 0x7500 || group == 0x8100 || group == 0x8600 || group == 0x8700;
}

void tell_gap(AlarmText& out, std::uint32_t cycles, std::string_view otherwise) {
    if (cycles == 0) return;
    out.english += fmt::format("; right before, {} bus cycles in a row were not answered", cycles);
    out.chinese += fmt::format(";此前连续 {} 个总线周期无应答", cycles);
    out.cause = fmt::format(
        "Probably frames were lost, and not by the drive (this computer too late for the cycle, another master, a cable "
        "or connector){}{}",
        otherwise, out.cause);
}

}  // namespace

std::string AlarmWords::source(const AlarmFact& fact) const {
    const auto named = [&](const std::vector<std::string>& names, std::string_view kind) {
        return fmt::format("{} {}", kind, fact.index < names.size() ? names[fact.index] : "?");
    };
    if (ModbusDevices::is_alarm(fact.id)) return modbus_.source(fact);
    switch (fact.source) {
        case AlarmSource::axis: return fact.index < layout_.axes.size() ? "axis " + layout_.axes[fact.index].name : "axis ?";
        case AlarmSource::slave:
            return fact.index < layout_.slaves.size() ? fmt::format("slave '{}'", layout_.slaves[fact.index]) : "slave ?";
        case AlarmSource::program: return named(layout_.programs, "program");
        case AlarmSource::task: return named(layout_.tasks, "task");
        case AlarmSource::bus: return "bus";
        case AlarmSource::io: return named(layout_.inputs, "input");
        case AlarmSource::machine:
        case AlarmSource::hmi: break;
    }
    return "machine";
}

bool AlarmWords::tell_declared(AlarmText& out, const AlarmFact& fact) const {
    const auto& programs = programs_.host().programs();
    const bool declared = fact.source == AlarmSource::program && alarm_range::programs.has(fact.id) && fact.index < programs.size();
    if (!declared) return false;
    const auto& words = programs[fact.index].alarm_texts[alarm_range::programs.number(fact.id)];
    out.name = program_alarm_name(fact.id);
    out.english = words.english;
    out.chinese = words.chinese;
    out.remedy = words.remedy;
    out.reaction = text_of(words.reaction);
    out.reset = text_of(ResetRule::self_clearing);
    return true;
}

void AlarmWords::tell_row(AlarmText& out, const AlarmFact& fact, const AlarmInfo& info) const {
    const bool of_an_axis = fact.source == AlarmSource::axis && fact.index < body_.config.axes.size();
    const auto filled = [&](std::string_view text) {
        return fill_in(of_an_axis ? in_units_of(text, body_.config.axes[fact.index].axis.unit) : std::string(text), fact.a, fact.b);
    };
    out.name = info.name;
    out.english = filled(info.english);
    out.chinese = filled(info.chinese);
    out.cause = filled(info.cause);
    out.remedy = filled(info.remedy);
    out.reaction = text_of(info.reaction);
    out.reset = text_of(info.reset);
}

AlarmText AlarmWords::describe(const AlarmFact& fact) const {
    AlarmText out;
    out.source = source(fact);
    if (tell_declared(out, fact)) return out;
    const auto* row = row_of(fact.id);
    if (!row) {
        out.name = fmt::format("alarm_{:04x}", fact.id);
        return out;
    }
    tell_row(out, fact, *row);
    tell_more_of_bus(out, fact);
    tell_more_of_machine(out, fact);
    tell_more_of_modbus(out, fact);
    tell_more_of_input(out, fact);
    tell_more_of_programs(out, fact);
    tell_more_of_axis(out, fact);
    tell_more_of_drive(out, fact);
    return out;
}

void AlarmWords::tell_more_of_bus(AlarmText& out, const AlarmFact& fact) const {
    if (const auto more = body_.bus.detail(fact); alarm_range::bus.has(fact.id) && !more.empty()) add(out, more);
}

void AlarmWords::tell_more_of_input(AlarmText& out, const AlarmFact& fact) const {
    if (fact.source != AlarmSource::io || fact.index >= layout_.inputs.size()) return;
    const auto& point = body_.io.point(IoDirection::input, fact.index);
    if (fact.id == id(MachineAlarm::input_faulty) && fact.a == input_no_number) {
        out.english = "What comes for this input is no number (NaN or infinite): it is not good";
        out.chinese = "该输入收到的不是有效数值(NaN 或无穷大):其数值无效";
        out.cause = "The device has no measured value (sensor off or broken), or the type or word order of the channel is wrong";
        out.remedy = "Look at the sensor; compare type and word order with the device's manual";
    } else if (fact.id == id(MachineAlarm::input_faulty) && fact.a != input_error) {
        const bool under = fact.a == input_underrange;
        out.english = fmt::format("The signal of this input is {} what its terminal measures: its value cannot be believed",
                                  under ? "below" : "above");
        out.chinese = fmt::format("该输入信号{}端子测量范围:其数值不可信", under ? "低于" : "高于");
        out.cause = under ? "A broken wire, a sensor without supply, or a signal beyond the range"
                          : "A short circuit, or a signal beyond the range";
    }
    if (fact.id == id(MachineAlarm::input_out_of_limits) && !point.unit.empty()) {
        out.english = fmt::format("The input is at {} {}, beyond its limit of {} {}", number_text(fact.a), point.unit, number_text(fact.b),
                                  point.unit);
        out.chinese = fmt::format("输入值为 {} {},超出限值 {} {}", number_text(fact.a), point.unit, number_text(fact.b), point.unit);
    }
    if (point.beside) out.remedy += fmt::format(" (Modbus device '{}')", point.slave);
    else out.remedy += fmt::format(" (slave '{}', {:04X}h:{:02X})", point.slave, point.index, point.sub);
}

void AlarmWords::tell_more_of_machine(AlarmText& out, const AlarmFact& fact) const {
    if (fact.id == id(MachineAlarm::emergency_stop) && fact.a == emergency_stop_unread) {
        out.english =
            "Emergency stop: its input could not be read, which counts as pressed; the axes stop along their ramps, then power goes off";
        out.chinese = "急停:未能读取急停输入,按已按下处理;各轴沿减速斜坡停止,随后断开动力";
        out.cause = "The slave with the input was not exchanged: see the alarm of the bus";
        out.remedy = "Mend the bus, acknowledge, then enable again";
    }
    if (fact.id == id(MachineAlarm::drive_silent) || fact.id == id(MachineAlarm::drive_not_ready_on_line)) {
        constexpr std::string_view somewhere = " of its serial line";
        const auto line = drives_.serial().line_of(fact.index);
        if (const auto at = out.english.find(somewhere); at != std::string::npos) out.english.replace(at, somewhere.size(), line);
        out.chinese += line;
    }
    if (fact.id == id(MachineAlarm::group_pulled)) {
        const auto group = groups_.group_of(fact.index);
        const auto more = fact.b > 1 ? fmt::format(" ({} of its axes)", number_text(fact.b)) : std::string{};
        out.english = fmt::format("Group '{}' was taken away while this axis had power{}", group, more);
        out.chinese =
            fmt::format("组 '{}' 在该轴通电时被断开{}", group, fact.b > 1 ? fmt::format("（共 {} 个轴）", number_text(fact.b)) : "");
    }
    // Not the host, another process or its power saving: a task of the machine's own.
    if (fact.id == id(MachineAlarm::cycle_overrun) && fact.source == AlarmSource::task) {
        const auto& task = *find_alarm(machine_alarms, id(MachineAlarm::base_task_overrun));
        out.cause = task.cause;
        out.remedy = task.remedy;
    }
}

void AlarmWords::tell_more_of_modbus(AlarmText& out, const AlarmFact& fact) const {
    if (!ModbusDevices::is_alarm(fact.id)) return;
    const auto where = modbus_.detail(fact);
    out.english += where;
    out.chinese += where;
    if (fact.id != modbus::tcp::id(modbus::tcp::DeviceAlarm::exception)) return;
    if (const auto why = ModbusDevices::words_of_exception(fact.a); !why.empty()) out.cause = why;
}

void AlarmWords::tell_more_of_programs(AlarmText& out, const AlarmFact& fact) const {
    if (fact.id == id(MachineAlarm::program_fault) && fact.index < programs_.programs().size())
        if (const auto why = programs_.fault(fact.index); !why.empty()) add(out, why);
    if (fact.id == id(MachineAlarm::undeclared_use) && fact.b != 0) {
        out.english = fmt::format("The program raises alarm {}, which its declare() never named: nobody sees it", number_text(fact.a));
        out.chinese = fmt::format("程序触发了 declare() 中未声明的报警 {}:无人可见", number_text(fact.a));
        out.cause = "An alarm needs a number of 0 to 63 and a text";
        out.remedy = "Declare it with d.alarm(number, reaction, text, ...), then build and start it again";
    }
    if (fact.id == id(MachineAlarm::axis_of_two_programs)) {
        const auto program = [&](double index) {
            const auto i = static_cast<std::size_t>(index);
            return i < layout_.programs.size() ? fmt::format("'{}'", layout_.programs[i]) : std::string("?");
        };
        out.english = fmt::format("Two programs command this axis: {} has it, {} lost it", program(fact.a), program(fact.b));
        out.chinese = fmt::format("两个程序同时控制该轴:{} 占有该轴,{} 失去控制", program(fact.a), program(fact.b));
    }
}

void AlarmWords::tell_more_of_axis(AlarmText& out, const AlarmFact& fact) const {
    if (fact.id == axes::id(axes::AxisAlarm::stopped_by_machine)) {
        const auto name = name_of_cause(static_cast<AlarmId>(fact.a));
        out.english = fmt::format("Stopped because of another part of the machine ({})", name);
        out.chinese = fmt::format("因机器其他部分而停止({})", name);
    }
    // Its drive itself is out of operation: that counts before the limit of missing values is reached.
    if (fact.id == axes::id(axes::AxisAlarm::axis_feedback_lost) && fact.a <= fact.b) {
        out.english = "The drive is not in operation on its bus any more";
        out.chinese = "驱动器已退出总线运行状态";
    }
    // There is no slave: whoever searches the bus searches in vain.
    if (const auto line = drives_.serial().line_of(fact.index); fact.id == axes::id(axes::AxisAlarm::axis_feedback_lost) && !line.empty()) {
        out.english = "No answer any more, or too seldom, from the drive" + line;
        out.chinese = "驱动器不再应答,或应答过于稀少" + line;
        out.cause =
            "The cable of the line is cut, off or disturbed; the drive has no mains, from which its port lives too; or its answers come "
            "late";
        out.remedy =
            "Check line, supply and panel of the drive; when it answers again, reset, then home. Where it answers late: `stale_limit`";
    }
    if (fact.id == axes::id(axes::AxisAlarm::homing_failed))
        if (const auto* doubt = axes::find_index_doubt(fact.a)) {
            out.english = doubt->english;
            out.chinese = doubt->chinese;
            out.cause = doubt->cause;
            out.remedy = doubt->remedy;
        }
    if (fact.index >= body_.config.axes.size()) return;
    if (fact.source == AlarmSource::axis) tell_chosen_reaction(out, fact);
    if (fact.id == axes::id(axes::AxisAlarm::drive_setup_refused))
        for (const auto& problem : drives_.port(fact.index).setup_problems()) add(out, problem);
    // The set-point went on without its drive: with relaxed supervision for longer than any drive follows.
    if (fact.id == axes::id(axes::AxisAlarm::following_error))
        if (const auto gap = supervisor_.before_fault().gap(fact.index); gap >= body_.config.bus.lost_frames_limit)
            tell_gap(out, gap, "; else: ");
}

// The machine file may have chosen another than the table's. One that stops needs a reset, whatever the alarm by itself would.
void AlarmWords::tell_chosen_reaction(AlarmText& out, const AlarmFact& fact) const {
    const auto alarm = static_cast<axes::AxisAlarm>(fact.id);
    if (axes::bound_of(alarm) == nullptr) return;
    const auto& reactions = body_.config.axes[fact.index].axis.reactions;
    const auto chosen = reactions.chosen(alarm);
    if (chosen == axes::ErrorReaction::by_table) return;
    const bool with_all = reactions.of_machine(alarm) == Reaction::power_off;
    out.reaction =
        fmt::format("{}{}, as `reactions` of the axis says", axes::word_of(chosen).text, with_all ? "; all axes stop, power goes off" : "");
    if (chosen >= axes::ErrorReaction::ramp_stop) out.reset = text_of(ResetRule::reset);
    else if (axes::reaction_by_table(alarm) != chosen) out.reset = text_of(ResetRule::self_clearing);
}

// A drive's own alarm has its words in the profile.
void AlarmWords::tell_more_of_drive(AlarmText& out, const AlarmFact& fact) const {
    const bool fault = fact.id == axes::id(axes::AxisAlarm::drive_fault), warning = fact.id == axes::id(axes::AxisAlarm::drive_warning);
    if (!(fault || warning) || fact.index >= body_.config.axes.size()) return;
    const auto& binding = body_.config.axes[fact.index];
    axes::ShownAlarm shown{static_cast<std::uint16_t>(fact.a), std::nullopt,
                           fault ? axes::ShownAlarm::As::fault : axes::ShownAlarm::As::warning};
    if (fact.b != 0) shown.detail = static_cast<std::uint32_t>(fact.b);  // 0: not read yet, or none
    tell_drive_alarm(out, binding, shown);
    if (binding.axis.gantry.on) add(out, drives_.gantry_side(fact.index));
    if (!fault || !binding.profile || !of_missing_frames(*binding.profile, shown)) return;
    const auto& before = supervisor_.before_fault();
    if (const auto stall = before.stall(fact.index); stall > 0) {
        const double milliseconds = static_cast<double>(stall) * 1e-6;
        out.english += fmt::format("; right before, this computer sent nothing for {:.4g} ms", milliseconds);
        out.chinese += fmt::format(";此前本控制器 {:.4g} ms 未发送报文", milliseconds);
        out.cause = "Probably this computer was late, not the drive (see late_wakeups); what the drive says of it: " + out.cause;
    } else {
        tell_gap(out, before.gap(fact.index), "; what the drive says of it: ");
    }
}

}  // namespace taktwerk::runtime
