// Words for alarms, made outside the cycle.

#include <cctype>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/homing/index_doubt.hpp"
#include "axes/port/find_alarm.hpp"
#include "ecat/alarms.hpp"
#include "runtime/machine/drive_alarm_words.hpp"
#include "runtime/machine/machine_impl.hpp"

namespace taktwerk::runtime {

namespace {

std::string number(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return fmt::format("{}", static_cast<std::int64_t>(value));
    if (std::abs(value) >= 1e4 && std::abs(value) < 1e15) return fmt::format("{:.0f}", value);  // nobody reads 1.99901e+06
    return fmt::format("{:.4g}", value);
}

/// Nanoseconds in the unit that a person reads.
std::string time_text(double nanoseconds) {
    const double size = std::abs(nanoseconds);
    if (size >= 1e9) return fmt::format("{:.3g} s", nanoseconds * 1e-9);
    if (size >= 1e6) return fmt::format("{:.3g} ms", nanoseconds * 1e-6);
    if (size >= 1e3) return fmt::format("{:.3g} us", nanoseconds * 1e-3);
    return fmt::format("{:.0f} ns", nanoseconds);
}

/// {a:ns}: a time. {a}, {b} and, in so many hexadecimal digits as codes of that kind are written, {a:x2}, {b:x4}, ... in a text of an alarm table.
std::string fill(std::string_view text, double a, double b) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        const auto rest = text.substr(i);
        const auto end = rest.find('}');
        const auto place = rest.substr(0, end == std::string_view::npos ? 0 : end + 1);
        const bool known = place.starts_with("{a") || place.starts_with("{b");
        const double value = known && place[1] == 'a' ? a : b;
        if (known && place.size() == 3) {
            out += number(value);
            i += place.size();
        } else if (known && place.substr(2) == ":ns}") {
            out += time_text(value);
            i += place.size();
        } else if (known && place.size() == 6 && place.substr(2, 2) == ":x") {
            out += fmt::format("{:0{}X}", static_cast<std::uint32_t>(value), place[4] - '0');
            i += place.size();
        } else {
            out += text[i++];
        }
    }
    return out;
}

/// The tables say `u` for the unit of the axis whose alarm it is: {a} u, {b} u/s.
std::string in_units_of(std::string_view text, const std::string& unit) {
    std::string out(text);
    for (const std::string_view place : {"{a} u", "{b} u"})
        for (auto at = out.find(place); at != std::string::npos; at = out.find(place, at + 1)) {
            const auto unit_at = at + place.size() - 1, behind = unit_at + 1;
            if (behind == out.size() || std::isalpha(static_cast<unsigned char>(out[behind])) == 0) out.replace(unit_at, 1, unit);
        }
    return out;
}

std::string_view text(Reaction reaction) {
    switch (reaction) {
        case Reaction::none: return "none";
        case Reaction::warn: return "warning";
        case Reaction::stop_axis: return "the axis stops";
        case Reaction::stop_machine: return "all axes stop";
        case Reaction::power_off: return "all axes stop, power goes off";
    }
    return "";
}

std::string_view text(ResetRule rule) {
    switch (rule) {
        case ResetRule::self_clearing: return "goes with its cause";
        case ResetRule::acknowledge: return "acknowledge";
        case ResetRule::reset: return "reset";
        case ResetRule::restart: return "power cycle or restart";
    }
    return "";
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

AlarmText Machine::describe(const AlarmFact& fact) const {
    const auto& m = *impl_;
    AlarmText out;
    switch (fact.source) {
        case AlarmSource::axis: out.source = fact.index < m.layout.axes.size() ? "axis " + m.layout.axes[fact.index].name : "axis ?"; break;
        case AlarmSource::slave:
            out.source = fact.index < m.layout.slaves.size() ? fmt::format("slave '{}'", m.layout.slaves[fact.index]) : "slave ?";
            break;
        case AlarmSource::program:
            out.source = fact.index < m.layout.programs.size() ? "program " + m.layout.programs[fact.index] : "program ?";
            break;
        case AlarmSource::task: out.source = fact.index < m.layout.tasks.size() ? "task " + m.layout.tasks[fact.index] : "task ?"; break;
        case AlarmSource::bus: out.source = "bus"; break;
        case AlarmSource::machine:
        case AlarmSource::io:
        case AlarmSource::hmi: out.source = "machine"; break;
    }

    if (fact.source == AlarmSource::program && fact.id >= 0x5000 && fact.id < 0x5040 && fact.index < m.host->programs().size()) {
        const auto& declared = m.host->programs()[fact.index].alarm_texts[fact.id - 0x5000u];
        out.name = fmt::format("program_alarm_{}", fact.id - 0x5000);
        out.english = declared.english;
        out.chinese = declared.chinese;
        out.remedy = declared.remedy;
        out.reaction = text(declared.reaction);
        out.reset = text(ResetRule::self_clearing);
        return out;
    }
    const AlarmInfo* info = nullptr;
    for (const std::span<const AlarmInfo> table :
         {std::span<const AlarmInfo>(machine_alarms), std::span<const AlarmInfo>(axes::axis_alarms),
          std::span<const AlarmInfo>(ecat::bus_alarms)})
        if (!info) info = find_alarm(table, fact.id);
    if (!info) {
        out.name = fmt::format("alarm_{:04x}", fact.id);
        return out;
    }
    out.name = info->name;
    const bool of_an_axis = fact.source == AlarmSource::axis && fact.index < m.config.axes.size();
    const auto filled = [&](std::string_view text) {
        return fill(of_an_axis ? in_units_of(text, m.config.axes[fact.index].axis.unit) : std::string(text), fact.a, fact.b);
    };
    out.english = filled(info->english);
    out.chinese = filled(info->chinese);
    out.cause = filled(info->cause);
    out.remedy = filled(info->remedy);
    out.reaction = text(info->reaction);
    out.reset = text(info->reset);

    if (const auto more = m.bus.detail(fact); info->id >= 0x1000 && info->id < 0x2000 && !more.empty()) {
        out.english += ": " + more;
        out.chinese += ":" + more;
    }

    if (fact.id == id(MachineAlarm::emergency_stop) && fact.a == emergency_stop_unread) {
        out.english =
            "Emergency stop: its input could not be read, which counts as pressed; the axes stop along their ramps, then power goes off";
        out.chinese = "急停:未能读取急停输入,按已按下处理;各轴沿减速斜坡停止,随后断开动力";
        out.cause = "The slave with the input was not exchanged: see the alarm of the bus";
        out.remedy = "Mend the bus, acknowledge, then enable again";
    }

    if (fact.id == id(MachineAlarm::program_fault) && fact.index < m.host->programs().size()) {
        const std::lock_guard lock{m.fault_words};
        if (const auto& why = m.host->programs()[fact.index].fault; !why.empty()) {
            out.english += ": " + why;
            out.chinese += ":" + why;
        }
    }

    // The alarm that stops the others by its name: the number is in no list that a person has.
    if (fact.id == axes::id(axes::AxisAlarm::stopped_by_machine)) {
        const auto cause = static_cast<AlarmId>(fact.a);
        const AlarmInfo* by = find_alarm(machine_alarms, cause);
        if (!by) by = find_alarm(axes::axis_alarms, cause);
        if (!by) by = find_alarm(ecat::bus_alarms, cause);
        const auto name = by                                  ? std::string(by->name)
                          : cause >= 0x5000 && cause < 0x5040 ? fmt::format("program_alarm_{}", cause - 0x5000)
                                                              : fmt::format("alarm {:04X}h", cause);
        out.english = fmt::format("Stopped because of another part of the machine ({})", name);
        out.chinese = fmt::format("因机器其他部分而停止({})", name);
    }

    // Its drive itself is out of operation: that counts before the limit of missing values is reached.
    if (fact.id == axes::id(axes::AxisAlarm::axis_feedback_lost) && fact.a <= fact.b) {
        out.english = "The drive is not in operation on its bus any more";
        out.chinese = "驱动器已退出总线运行状态";
    }

    if (fact.id == id(MachineAlarm::drive_silent) || fact.id == id(MachineAlarm::drive_not_ready_on_line)) {
        constexpr std::string_view somewhere = " of its serial line";
        if (const auto at = out.english.find(somewhere); at != std::string::npos)
            out.english.replace(at, somewhere.size(), m.line_of(fact.index));
        out.chinese += m.line_of(fact.index);
    }

    // Not the host, another process or its power saving: a task of the machine's own.
    if (fact.id == id(MachineAlarm::cycle_overrun) && fact.source == AlarmSource::task) {
        const auto& task = *find_alarm(machine_alarms, id(MachineAlarm::base_task_overrun));
        out.cause = task.cause;
        out.remedy = task.remedy;
    }

    if (fact.id == id(MachineAlarm::undeclared_use) && fact.b != 0) {
        out.english = fmt::format("The program raises alarm {}, which its declare() never named: nobody sees it", number(fact.a));
        out.chinese = fmt::format("程序触发了 declare() 中未声明的报警 {}:无人可见", number(fact.a));
        out.cause = "An alarm needs a number of 0 to 63 and a text";
        out.remedy = "Declare it with d.alarm(number, reaction, text, ...), then build and start it again";
    }

    if (fact.id == id(MachineAlarm::axis_of_two_programs)) {
        const auto program = [&](double index) {
            const auto i = static_cast<std::size_t>(index);
            return i < m.layout.programs.size() ? fmt::format("'{}'", m.layout.programs[i]) : std::string("?");
        };
        out.english = fmt::format("Two programs command this axis: {} has it, {} lost it", program(fact.a), program(fact.b));
        out.chinese = fmt::format("两个程序同时控制该轴:{} 占有该轴,{} 失去控制", program(fact.a), program(fact.b));
    }

    if (fact.id == axes::id(axes::AxisAlarm::homing_failed))
        if (const auto* doubt = axes::find_index_doubt(fact.a)) {
            out.english = doubt->english;
            out.chinese = doubt->chinese;
            out.cause = doubt->cause;
            out.remedy = doubt->remedy;
        }

    if (fact.id == axes::id(axes::AxisAlarm::drive_setup_refused) && fact.index < m.ports.size())
        for (const auto& problem : m.ports[fact.index]->setup_problems()) {
            out.english += ": " + problem;
            out.chinese += ":" + problem;
        }

    // The set-point went on without its drive: with relaxed supervision for longer than any drive follows.
    if (fact.id == axes::id(axes::AxisAlarm::following_error) && fact.index < m.config.axes.size())
        if (const auto gap = m.gap_before_fault[fact.index].load(std::memory_order_relaxed); gap >= m.config.bus.lost_frames_limit)
            tell_gap(out, gap, "; else: ");

    // A drive's own alarm has its words in the profile.
    const bool fault = fact.id == axes::id(axes::AxisAlarm::drive_fault), warning = fact.id == axes::id(axes::AxisAlarm::drive_warning);
    if ((fault || warning) && fact.index < m.config.axes.size()) {
        axes::ShownAlarm shown{static_cast<std::uint16_t>(fact.a), std::nullopt,
                               fault ? axes::ShownAlarm::As::fault : axes::ShownAlarm::As::warning};
        if (fact.b != 0) shown.detail = static_cast<std::uint32_t>(fact.b);  // 0: not read yet, or none
        tell_drive_alarm(out, m.config.axes[fact.index], shown);
        const auto* profile = m.config.axes[fact.index].profile.get();
        const bool of_frames = fault && profile != nullptr && of_missing_frames(*profile, shown);
        const std::int64_t stall = of_frames ? m.stall_before_fault[fact.index].load(std::memory_order_relaxed) : 0;
        if (stall > 0) {
            const double milliseconds = static_cast<double>(stall) * 1e-6;
            out.english += fmt::format("; right before, this computer sent nothing for {:.4g} ms", milliseconds);
            out.chinese += fmt::format(";此前本控制器 {:.4g} ms 未发送报文", milliseconds);
            out.cause = "Probably this computer was late, not the drive (see late_wakeups); what the drive says of it: " + out.cause;
        } else if (of_frames) {
            tell_gap(out, m.gap_before_fault[fact.index].load(std::memory_order_relaxed), "; what the drive says of it: ");
        }
    }
    return out;
}

}  // namespace taktwerk::runtime
