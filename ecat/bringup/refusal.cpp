#include "ecat/bringup/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace taktwerk::ecat {

namespace {

/// A drive that supervises its clock gives up at a few microseconds (SV33-E P0A.32: 3000 ns).
constexpr std::int64_t suspicious_difference_ns = 3000;

bool one_of(std::uint16_t code, std::initializer_list<std::uint16_t> codes) {
    return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// Start, length, control and enable; status and repeat bits are the slave's business.
bool holds(const SyncManager& planned, const SyncManager& found) {
    return planned.start == found.start && planned.length == found.length && planned.control == found.control &&
           planned.enabled() == found.enabled();
}

bool outputs_of(const RefusedSyncManager& sm) { return sm.planned && sm.planned->is_written_by_master(); }

std::string sync_manager_line(const RefusedSyncManager& sm) {
    std::string line = fmt::format("SM{} is {} bytes at {:04X}h", sm.number, sm.planned->length, sm.planned->start);
    if (sm.mapping_bytes) line += fmt::format(", the slave maps {}", *sm.mapping_bytes);
    if (sm.sii_bytes && *sm.sii_bytes != 0 && *sm.sii_bytes != sm.planned->length)
        line += fmt::format(", its EEPROM says {}", *sm.sii_bytes);
    if (sm.found && !holds(*sm.planned, *sm.found))
        line += fmt::format(", the controller holds {} bytes at {:04X}h control {:02X}h{}", sm.found->length, sm.found->start,
                            sm.found->control, sm.found->enabled() ? "" : ", disabled");
    return line;
}

bool differs(const RefusedFmmu& fmmu) { return fmmu.planned && fmmu.found && !(*fmmu.planned == *fmmu.found); }

std::string fmmu_line(const RefusedFmmu& fmmu) {
    std::string line = fmt::format("FMMU{} maps {} bytes of {:08X}h to {:04X}h", fmmu.number, fmmu.planned->length,
                                   fmmu.planned->logical_start, fmmu.planned->physical_start);
    if (differs(fmmu))
        line += fmt::format(", the controller holds {} bytes of {:08X}h to {:04X}h", fmmu.found->length, fmmu.found->logical_start,
                            fmmu.found->physical_start);
    return line;
}

/// Clock, watchdog, last abort.
void add_other_lines(const Refusal& r, std::vector<std::string>& lines) {
    if (r.asked >= AlState::safeop && (r.clock.configured || r.clock.supported)) {
        std::string line = !r.clock.configured ? std::string{"SYNC0 not used"}
                           : r.clock.started   ? fmt::format("SYNC0 every {:.6g} ms", to_seconds(r.clock.bus_cycle) * 1e3)
                                               : std::string{"SYNC0 not started"};
        if (r.clock.configured && r.clock.activation) line += fmt::format(", 0981h = {:02X}h", *r.clock.activation);
        if (r.clock.configured && r.clock.difference_ns) line += fmt::format(", clock {} ns from the reference", *r.clock.difference_ns);
        lines.push_back(std::move(line));
    }
    if (r.asked == AlState::op && r.sm_watchdog_ticks) lines.push_back(fmt::format("SM watchdog {} ticks", *r.sm_watchdog_ticks));
    if (!r.last_abort.empty()) lines.push_back("last SDO abort: " + r.last_abort);
}

bool judge_sync_managers(Refusal& r) {
    for (const auto& sm : r.sync_managers) {
        if (sm.planned && sm.found && !holds(*sm.planned, *sm.found)) {
            r.cause = fmt::format("SM{} does not hold what was written to it", sm.number);
            r.remedy = "the slave's firmware changes or protects its sync managers: compare its profile with its EEPROM (`bus scan`)";
            return true;
        }
        if (sm.planned && sm.mapping_bytes && sm.planned->length != *sm.mapping_bytes) {
            r.cause =
                fmt::format("SM{} is {} bytes, the PDOs that the slave reports need {}", sm.number, sm.planned->length, *sm.mapping_bytes);
            r.remedy = fmt::format("the slave kept another assignment: set `pdo.{}` to a PDO that it offers, or check its firmware",
                                   outputs_of(sm) ? "rx" : "tx");
            return true;
        }
        const bool mailbox = sm.planned && sm.planned->is_mailbox();
        if (mailbox && sm.sii_bytes && *sm.sii_bytes != 0 && *sm.sii_bytes != sm.planned->length &&
            one_of(r.code, {0x0015, 0x0016, 0x0017})) {
            r.cause =
                fmt::format("the mailbox in SM{} was set to {} bytes, its EEPROM says {}", sm.number, sm.planned->length, *sm.sii_bytes);
            r.remedy = "take the mailbox sizes of the EEPROM into the slave's profile";
            return true;
        }
    }
    for (const auto& fmmu : r.fmmus)
        if (differs(fmmu)) {
            r.cause = fmt::format("FMMU{} does not hold what was written to it", fmmu.number);
            r.remedy = "the controller has fewer or other FMMUs than it says: check its profile";
            return true;
        }
    return false;
}

bool judge_clock(Refusal& r) {
    const auto& clock = r.clock;
    const bool about_sync = one_of(r.code, {0x001A, 0x0027, 0x0028, 0x002C, 0x002D, 0x0030, 0x0032, 0x0033, 0x0034, 0x0035, 0x0036});
    if (r.asked < AlState::safeop) return false;  // SYNC0 is nothing that INIT or PREOP waits for
    if (!about_sync && !r.timed_out) return false;
    if (!clock.configured && (clock.required || one_of(r.code, {0x0027, 0x002D}))) {
        r.cause = "the slave wants SYNC0, and the configuration runs it without";
        r.remedy = "set `dc: true` for this slave";
        return true;
    }
    if (!clock.configured) return false;
    if (!clock.started || (clock.activation && (*clock.activation & dc_activate::sync0) == 0)) {
        r.cause = clock.started ? "SYNC0 was started, but the controller does not run it (0981h)" : "SYNC0 was not started yet";
        r.remedy = "start SYNC0 in the other state: `sync_start: before_safeop` or `sync_start: in_safeop`";
        return true;
    }
    if (clock.difference_ns && *clock.difference_ns > suspicious_difference_ns) {
        r.cause = fmt::format("its clock is {} ns away from the reference", *clock.difference_ns);
        r.remedy = "check cables and the slaves between it and the reference clock; a slave with an unsteady quartz shows in `bus dc`";
        return true;
    }
    if (one_of(r.code, {0x0035, 0x0036}) && clock.sync0_cycle) {
        r.cause = fmt::format("the slave does not accept a SYNC0 cycle of {:.6g} us", to_seconds(*clock.sync0_cycle) * 1e6);
        r.remedy = "choose a bus cycle that its manual lists";
        return true;
    }
    return false;
}

bool judge_outputs(Refusal& r) {
    if (r.asked != AlState::op || r.valid_outputs) return false;
    if (!one_of(r.code, {0x0000, 0x0019, 0x001B, 0x002B})) return false;
    r.cause = "no valid outputs reach it: the cycle does not send, or its answers are not complete";
    r.remedy = "check that the machine's cycle runs and that no working counter is wrong (`bus counters`)";
    return true;
}

}  // namespace

void judge(Refusal& r) {
    const auto& info = al_status_info(r.code);
    if (judge_sync_managers(r) || judge_clock(r) || judge_outputs(r)) return;
    if (!r.last_abort.empty() && one_of(r.code, {0x0001, 0x0017, 0x001D, 0x001E, 0x0024, 0x0025, 0x0026, 0x0043})) {
        r.cause = "an SDO of its configuration was refused before: " + r.last_abort;
        r.remedy = "correct that entry of the start-up list or of the PDO selection";
        return;
    }
    if (r.timed_out) {
        r.cause = "the slave neither takes the state nor says why";
        r.remedy = r.asked == AlState::op ? "it may be waiting for valid outputs or for SYNC0: check that the cycle runs"
                                          : "power-cycle the slave; if it stays, check its firmware";
        return;
    }
    r.cause = std::string{info.text};
    r.remedy = info.remedy.empty() ? std::string{"look the code up in the slave's manual"} : std::string{info.remedy};
}

std::string headline(const Refusal& r) {
    const auto text = al_status_info(r.code).text;
    if (r.timed_out)
        return fmt::format("did not reach {} within {} s: it stays in {} without an error (AL status {:04X}h, code {:04X}h {})",
                           name(r.asked), to_seconds(r.waited), name(r.reached), r.status, r.code, text);
    return fmt::format("refused {}: {:04X}h {} (it is in {})", name(r.asked), r.code, text, name(r.reached));
}

std::vector<std::string> fact_lines(const Refusal& r) {
    std::vector<std::string> lines;
    for (const auto& sm : r.sync_managers)
        if (sm.planned) lines.push_back(sync_manager_line(sm));
    for (const auto& fmmu : r.fmmus)
        if (fmmu.planned) lines.push_back(fmmu_line(fmmu));
    add_other_lines(r, lines);
    return lines;
}

Error refusal_error(const Refusal& r) {
    std::vector<std::string> lines;
    for (const auto& sm : r.sync_managers)
        if (sm.planned) lines.push_back(sync_manager_line(sm));
    for (const auto& fmmu : r.fmmus)
        if (differs(fmmu)) lines.push_back(fmmu_line(fmmu));  // those that are as planned would only make it longer
    add_other_lines(r, lines);
    std::string what = headline(r);
    for (const auto& line : lines) what += "; " + line;
    if (!r.cause.empty() && r.cause != al_status_info(r.code).text) what += "; likely cause: " + r.cause;
    return Error{r.timed_out ? "bus.state_timeout" : "bus.refused_state", r.subject, std::move(what), r.remedy};
}

}  // namespace taktwerk::ecat
