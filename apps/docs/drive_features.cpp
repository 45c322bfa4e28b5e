// The features of a drive as Markdown.

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/docs/drive_pages.hpp"
#include "axes/drives/cia402/words.hpp"
#include "axes/port/drive_scale.hpp"
#include "axes/port/quirk.hpp"

namespace taktwerk::apps {
namespace {

using axes::DriveMode;
using axes::DriveProfile;
using axes::DriveStop;
using ecat::DeviceDescription;

class Features {
public:
    void row(std::string_view what, const std::string& value) {
        if (!value.empty()) fmt::format_to(std::back_inserter(rows_), "| {} | {} |\n", what, value);
    }
    void list(std::string_view title, const std::vector<std::string>& sentences) {
        if (sentences.empty()) return;
        fmt::format_to(std::back_inserter(rest_), "\n### {}\n\n", title);
        for (const auto& sentence : sentences) fmt::format_to(std::back_inserter(rest_), "* {}\n", sentence);
    }
    void part(const std::string& text) { rest_ += text; }
    [[nodiscard]] std::string text() const { return "| feature | |\n|---|---|\n" + rows_ + rest_; }

private:
    std::string rows_, rest_;
};

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, ", ")); }

std::string time_text(Duration time) {
    const double us = to_seconds(time) * 1e6;
    return us >= 1000 ? fmt::format("{:g} ms", us / 1000) : fmt::format("{:g} us", us);
}
/// Nothing for a time that nobody stated.
std::string stated(Duration time) { return time > Duration::zero() ? time_text(time) : std::string{}; }

std::string_view words(DriveStop stop) {
    switch (stop) {
        case DriveStop::coast: return "power off at once, the motor runs out";
        case DriveStop::ramp: return "decelerates, then power off";
    }
    return "";
}

std::string_view words(axes::ParameterStorage storage) {
    switch (storage) {
        case axes::ParameterStorage::not_stated: return "not stated";
        case axes::ParameterStorage::each_write: return "every write goes into the EEPROM and wears it";
        case axes::ParameterStorage::on_request: return "in RAM until they are saved by command";
        case axes::ParameterStorage::never: return "lost at power off; the maker's own tool stores";
    }
    return "";
}

std::string object_text(std::uint16_t index, std::uint8_t sub) {
    return sub == 0 ? fmt::format("{:04X}h", index) : fmt::format("{:04X}h:{:02X}", index, sub);
}

std::string entry_text(const ecat::PdoEntry& entry) {
    return entry.index == 0 ? fmt::format("gap of {} bits", entry.bits) : object_text(entry.index, entry.sub);
}

std::string pdo_text(const ecat::PdoDescription& pdo) {
    std::vector<std::string> entries;
    for (const auto& entry : pdo.entries) entries.push_back(entry_text(entry));
    return fmt::format("{:04X}h ({})", pdo.index, joined(entries));
}

std::string pdos_text(const std::vector<ecat::PdoDescription>& pdos) {
    std::vector<std::string> all;
    unsigned bits = 0;
    for (const auto& pdo : pdos) {
        all.push_back(pdo_text(pdo));
        for (const auto& entry : pdo.entries) bits += entry.bits;
    }
    return all.empty() ? std::string{} : fmt::format("{}: {} bytes", joined(all), (bits + 7) / 8);
}

std::vector<ecat::PdoDescription> assigned(const std::vector<ecat::PdoDescription>& available, const std::vector<std::uint16_t>& indices) {
    std::vector<ecat::PdoDescription> out;
    for (const auto index : indices)
        for (const auto& pdo : available)
            if (pdo.index == index) out.push_back(pdo);
    return out;
}

std::string rules_text(const ecat::PdoRules& rules, const std::vector<ecat::PdoDescription>& available) {
    const auto fixed = std::count_if(available.begin(), available.end(), [](const auto& pdo) { return pdo.fixed; });
    return fmt::format("{} PDOs, {} of them fixed; at most {} assigned, {} objects in one, {} bytes", available.size(), fixed,
                       rules.max_assigned, rules.max_entries, rules.max_bytes);
}

void bus_rows(Features& out, const config::LoadedDrive& drive) {
    const auto& device = *drive.device;
    out.row("Identity", fmt::format("vendor {:08X}h, product {:08X}h, revision {:08X}h", device.identity.vendor, device.identity.product,
                                    device.identity.revision));
    std::vector<std::string> also;
    for (const auto& identity : device.also_accepted)
        also.push_back(fmt::format("vendor {:08X}h, product {:08X}h", identity.vendor, identity.product));
    out.row("Also accepted", joined(also));
    if (device.mailbox)
        out.row("CoE", fmt::format("complete access: {}; list of objects: {}; messages it buffers: {}",
                                   device.mailbox->complete_access ? "yes" : "no", device.mailbox->sdo_info ? "yes" : "no",
                                   device.mailbox->max_pending));
    out.row("Clock", device.dc.required ? "SYNC0 must run" : device.dc.supported ? "SYNC0 is possible" : "none");
    out.row("Least SYNC0 cycle", stated(device.dc.minimum_cycle));
    out.row("SYNC0 cycle is a multiple of", stated(device.dc.cycle_multiple));
    out.row("RxPDOs", rules_text(device.rx_rules, device.rx_pdos));
    out.row("TxPDOs", rules_text(device.tx_rules, device.tx_pdos));
    out.row("Factory sends it", pdos_text(assigned(device.rx_pdos, device.rx_assigned)));
    out.row("Factory reads from it", pdos_text(assigned(device.tx_pdos, device.tx_assigned)));
    out.row("Taktwerk sends it", pdos_text(drive.rx.assigned));
    out.row("Taktwerk reads from it", pdos_text(drive.tx.assigned));
    std::vector<std::string> startup;
    for (const auto& sdo : drive.startup) startup.push_back(fmt::format("{} = {}", object_text(sdo.index, sdo.sub), sdo.value));
    out.row("Written at every start", joined(startup));
}

/// Modes, homing and what they need of objects; a drive on a line of its own (`on_bus` null) has no 6060h, no 60FDh, no SYNC0.
void motion_rows(Features& out, const DriveProfile& profile, const DeviceDescription* on_bus) {
    std::vector<std::string> modes;
    for (const auto mode : profile.modes)
        modes.push_back(on_bus ? fmt::format("{} ({})", name(mode), int{axes::cia402::mode_code(mode)}) : std::string(name(mode)));
    out.row(on_bus ? "Modes of operation (6060h)" : "Modes of operation", joined(modes));
    std::vector<std::string> methods;
    for (const auto method : profile.homing_methods) methods.push_back(std::to_string(method));
    out.row(on_bus ? "Homing methods (6098h)" : "Homing methods", methods.empty() ? "none: the runtime homes" : joined(methods));
    if (profile.homing_timeout.index != 0)
        out.row("Homing ends with an error after",
                fmt::format("{} x {}", object_text(profile.homing_timeout.index, profile.homing_timeout.sub),
                            time_text(profile.homing_timeout_unit)));
    if (profile.encoder.turn_bits != 0) out.row("Turns of an absolute encoder", fmt::format("{} bits", profile.encoder.turn_bits));
    if (profile.encoder.clear_turns.index != 0)
        out.row("The encoder forgets its turns by",
                fmt::format("{} = {}", object_text(profile.encoder.clear_turns.index, profile.encoder.clear_turns.sub),
                            profile.encoder.clear_turns_value));
    else if (profile.encoder.clear_turns_control != 0)
        out.row("The encoder forgets its turns by", fmt::format("control word {:04X}h", profile.encoder.clear_turns_control));
    out.row("Touch probes", profile.probes == 0 ? "none" : std::to_string(profile.probes));
    if (profile.axes > 1)
        out.row("Axes",
                fmt::format("{}; objects {:04X}h apart, PDOs {:02X}h apart", profile.axes, profile.object_offset, profile.pdo_offset));
    out.row("Actual position", profile.encoder.present ? "measured" : "the commanded one, unless the motor has an encoder");
    if (const auto words = axes::scale_words(profile); !words.empty())
        out.row("Counts of a motor turn", fmt::format("{}: compared with `gearing` before the axis is enabled{}{}", words,
                                                      profile.scale.doubt.empty() ? "" : "; ", profile.scale.doubt));
    else if (!profile.scale.doubt.empty()) out.row("Counts of a motor turn", profile.scale.doubt);
    out.row("Width of a position", fmt::format("{} bits, unwrapped to 64", profile.position_bits));
    out.row("Unit of velocity", profile.velocity_counts_per_unit == 1.0
                                    ? "counts/s"
                                    : fmt::format("1 raw = {:g} counts/s", 1.0 / profile.velocity_counts_per_unit));
    out.row("Unit of torque", fmt::format("{:g} = rated torque", profile.torque_rated_raw));
    // A drive without 60FDh has no switches that the bus could see (TSVM-D6).
    const bool shows_inputs =
        on_bus && std::any_of(on_bus->objects.begin(), on_bus->objects.end(), [](const auto& o) { return o.index == 0x60FD; });
    if (on_bus && !shows_inputs) out.row("Limit and home switches", "none on the bus");
    if (shows_inputs)
        out.row("Limit and home switches",
                fmt::format("60FDh bits {} (negative), {} (positive), {} (home)", profile.input_bit_negative_limit,
                            profile.input_bit_positive_limit, profile.input_bit_home));
    out.row("Least cycle, cyclic position", stated(profile.minimum_cycle_csp));
    out.row("Least cycle, cyclic velocity", stated(profile.minimum_cycle_csv));
    out.row("Least cycle, cyclic torque", stated(profile.minimum_cycle_cst));
    if (on_bus) out.row("A cyclic target is reached", profile.csp_interpolates ? "one cycle after the SYNC0 that brought it" : "at once");
    if (profile.enable_status_bits != 0) out.row("Enabled only with", fmt::format("statusword bits {:04X}h", profile.enable_status_bits));
    out.row("Motion waits after enabling", stated(profile.enable_delay));
    out.row("Enabling has failed after", stated(profile.enable_timeout));
    out.row("Brake opens after", stated(profile.brake.release));
    out.row("Brake closes after", stated(profile.brake.hold));
    out.row("Set-points wait after a change of mode", stated(profile.mode_rules.change_delay));
    out.row("Between two changes of mode", stated(profile.mode_rules.change_interval));
    out.row("6061h means nothing after a change for", stated(profile.mode_rules.indeterminate));
    if (profile.mode_rules.change_at_standstill) out.row("Modes change", "at standstill only");
    out.row("Power taken in motion", std::string(words(profile.stops.off)));
    out.row("At a fault", std::string(words(profile.stops.fault)));
    out.row("After a quick stop", profile.stops.quick_stop_leaves ? "Switch On Disabled by itself" : "stays in Quick Stop Active");
    if (profile.alarm_detail_index != 0)
        out.row("Alarms that share a code", "told apart by " + object_text(profile.alarm_detail_index, profile.alarm_detail_sub));
}

void count_rows(Features& out, const DriveProfile& profile) {
    const auto count = [&](auto says) { return std::count_if(profile.alarms.begin(), profile.alarms.end(), says); };
    if (!profile.alarms.empty())
        out.row("Alarms", fmt::format("{}, {} of them warnings; {} need a power cycle: [all of them](../reference/drives/{}-alarms.md)",
                                      profile.alarms.size(), count([](const auto& a) { return a.warning; }),
                                      count([](const auto& a) { return !a.warning && !a.resettable; }), profile.name));
    if (!profile.parameters.empty())
        out.row("Parameters",
                fmt::format("{}: [all of them](../reference/drives/{}-parameters.md)", profile.parameters.size(), profile.name));
    out.row("How parameters are stored", std::string(words(profile.storage.way)));
    if (profile.storage.switched_by.index != 0)
        out.row("Not stored while", object_text(profile.storage.switched_by.index, profile.storage.switched_by.sub) + " = 0");
}

}  // namespace

std::string drive_features_markdown(const config::LoadedDrive& drive) {
    const auto& profile = *drive.profile;
    Features out;
    if (drive.device) bus_rows(out, drive);
    motion_rows(out, profile, drive.device.get());
    count_rows(out, profile);

    if (!profile.quirks.empty()) {
        std::string quirks = "\n### Deviations from CiA 402\n\n| quirk | |\n|---|---|\n";
        for (const auto quirk : profile.quirks) {
            const auto* info = axes::find_quirk(quirk);
            fmt::format_to(std::back_inserter(quirks), "| `{}` | {} |\n", info ? info->name : "?",
                           info ? info->doc : "no line in axes/port/quirk.hpp says what it is");
        }
        out.part(quirks);
    }
    if (!profile.hazards.empty()) {
        std::string hazards =
            "\n### Hazards\n\n`taktwerk check` warns of those that a machine does not take care of.\n\n| what happens | what to do | "
            "section "
            "|\n|---|---|---|\n";
        for (const auto& hazard : profile.hazards)
            fmt::format_to(std::back_inserter(hazards), "| {} | {} | {} |\n", hazard.text, hazard.remedy, hazard.section);
        out.part(hazards);
    }
    out.list("Assumed where the manual is silent or contradicts itself", profile.assumed);
    out.list("Questions for the maker", profile.questions);
    return out.text();
}

}  // namespace taktwerk::apps
