#include "apps/docs/reference_pages.hpp"

#include <iterator>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_reaction.hpp"
#include "axes/axis/error_table.hpp"
#include "axes/axis/parameters.hpp"
#include "ecat/alarms.hpp"
#include "modbus/tcp/alarms.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::apps {
namespace {

std::string_view words(Reaction reaction) {
    switch (reaction) {
        case Reaction::none: return "nothing; information only";
        case Reaction::warn: return "shown, nothing stops";
        case Reaction::stop_axis: return "the axis stops along its deceleration (ErrorStop)";
        case Reaction::stop_machine: return "every axis stops along its deceleration; programs are told";
        case Reaction::power_off: return "every axis stops, then power goes off";
    }
    return "";
}

std::string_view words(ResetRule reset) {
    switch (reset) {
        case ResetRule::self_clearing: return "goes away with its cause";
        case ResetRule::acknowledge: return "`taktwerk ack`, once the cause is gone";
        case ResetRule::reset: return "`taktwerk reset` or MC_Reset, once the cause is gone";
        case ResetRule::restart: return "power cycle of the device, or restart of the runtime";
    }
    return "";
}

std::string range_of(const axes::ParameterInfo& parameter) {
    const auto upper = [&] { return parameter.at_most != 0 ? fmt::format(", at most parameter {}", parameter.at_most) : std::string{}; };
    switch (parameter.range) {
        case axes::ParameterRange::read_only: return "read only";
        case axes::ParameterRange::finite: return "any finite value" + upper();
        case axes::ParameterRange::not_negative: return "0 or more" + upper();
        case axes::ParameterRange::positive: return "above 0" + upper();
        case axes::ParameterRange::boolean: return "FALSE, TRUE";
    }
    return "";
}

/// How far the machine file may choose the reaction to an alarm of an axis.
void append_choice(std::string& page, const AlarmInfo& alarm) {
    const auto* bound = axes::bound_of(static_cast<axes::AxisAlarm>(alarm.id));
    if (bound == nullptr) return;
    std::string words;
    for (const auto& word : axes::reaction_words)
        if (word.reaction >= bound->mildest) words += fmt::format("{}`{}`", words.empty() ? "" : ", ", word.name);
    fmt::format_to(std::back_inserter(page), "* `reactions: {{ {}: ... }}` of the axis: {}{}\n", alarm.name, words,
                   bound->because.empty() ? "" : fmt::format("; nothing milder, for {}", bound->because));
}

void append_table(std::string& page, std::string_view title, std::string_view numbers, std::span<const AlarmInfo> table) {
    auto out = std::back_inserter(page);
    fmt::format_to(out, "\n## {}\n\n{}\n", title, numbers);
    for (const auto& alarm : table) {
        fmt::format_to(out, "\n### {:04X}h {}\n\n", alarm.id, alarm.name);
        fmt::format_to(out, "{}\n\n{}\n\n", alarm.english, alarm.chinese);
        fmt::format_to(out, "* Cause: {}\n* Remedy: {}\n* Reset: {}\n* Reaction, master alive: {}\n", alarm.cause, alarm.remedy,
                       words(alarm.reset), words(alarm.reaction));
        if (!alarm.master_gone.empty()) fmt::format_to(out, "* Reaction, master gone: {}\n", alarm.master_gone);
        append_choice(page, alarm);
    }
}

void append_error(std::string& page, const axes::ErrorText& error) {
    auto out = std::back_inserter(page);
    fmt::format_to(out, "\n## {:04X}h {}\n\n", static_cast<unsigned>(error.id), error.name);
    fmt::format_to(out, "{}\n\n* Cause: {}\n* Remedy: {}\n\n", error.english.text, error.english.cause, error.english.remedy);
    fmt::format_to(out, "{}\n\n* 原因：{}\n* 措施：{}\n", error.chinese.text, error.chinese.cause, error.chinese.remedy);
}

}  // namespace

std::string alarm_reference_markdown() {
    std::string page =
        "# Alarms\n\n"
        "Generated from the alarm tables (`taktwerk docs alarms`). {a} and {b} stand for the numbers of the occasion ({a:ns}: a time, "
        "{a:mode}: a mode of operation). A "
        "drive's own\n"
        "alarms come with its profile and are shown with `drive_fault` and `drive_warning`; a program's alarms are declared by the "
        "program. What an axis does about its own alarms may be chosen in the machine file (`reactions`), from mild to hard: `warn`,\n"
        "`ramp_stop` (to ErrorStop, power stays), `stop_machine` (every other axis with it), `ramp_then_off`, `quick_stop` (by the drive, "
        "605Ah,\n"
        "then power off), `power_off` (at once: the motor coasts, or its brake holds it).\n";
    append_table(page, "Bus", "EtherCAT, 1xxxh.", ecat::bus_alarms);
    append_table(page, "Modbus devices", "Modbus TCP, 2xxxh.", modbus::tcp::device_alarms);
    append_table(page, "Axes", "3xxxh; also the error of an axis in ErrorStop (MC_ReadAxisError).", axes::axis_alarms);
    append_table(page, "Machine", "6xxxh.", runtime::machine_alarms);
    return page;
}

std::string error_reference_markdown() {
    std::string page =
        "# Errors of function blocks\n\n"
        "Generated from the error table (`taktwerk docs errors`). These are answers to a command: unless the cause says otherwise the "
        "axis\n"
        "itself is untouched. Numbers from 3000h on are the axis' own errors and stand in alarms.md.\n";
    for (const auto& error : axes::error_texts) append_error(page, error);
    return page;
}

std::string parameter_reference_markdown() {
    std::string page =
        "# Parameters of an axis\n\n"
        "Generated from the parameter table (`taktwerk docs parameters`). Read and written by number: MC_ReadParameter,\n"
        "MC_ReadBoolParameter, MC_WriteParameter, MC_WriteBoolParameter. 1 to 17 are PLCopen's (Part 1, table 5), 1000 and above\n"
        "Taktwerk's own. What is written holds at once, or in its turn behind the commands that wait (`mcQueued`), and until the\n"
        "runtime starts again: the machine file is the memory. u is the axis' configured unit. BOOL parameters read as 0 or 1 through\n"
        "the REAL blocks.\n\n"
        "| no. | name | type | unit | may be written with | |\n|---|---|---|---|---|---|\n";
    for (const auto& parameter : axes::parameter_table)
        fmt::format_to(std::back_inserter(page), "| {} | {} | {} | {} | {} | {} |\n", parameter.number, parameter.name,
                       parameter.type == axes::ParameterType::boolean ? "BOOL" : "REAL", parameter.unit, range_of(parameter),
                       parameter.doc);
    return page;
}

}  // namespace taktwerk::apps
