#include "apps/esi/names.hpp"

#include <chrono>

#include <fmt/format.h>

namespace taktwerk::apps {

const char* esi_use_name(ecat::SmUse use) {
    switch (use) {
        case ecat::SmUse::mailbox_out: return "mailbox out";
        case ecat::SmUse::mailbox_in: return "mailbox in";
        case ecat::SmUse::outputs: return "outputs";
        case ecat::SmUse::inputs: return "inputs";
    }
    return "";
}

const char* esi_access_name(ecat::Access access) {
    switch (access) {
        case ecat::Access::ro: return "ro";
        case ecat::Access::rw: return "rw";
        case ecat::Access::wo: return "wo";
    }
    return "";
}

const char* esi_mappable_name(ecat::Mappable mappable) {
    switch (mappable) {
        case ecat::Mappable::no: return "";
        case ecat::Mappable::rx: return "rx";
        case ecat::Mappable::tx: return "tx";
        case ecat::Mappable::both: return "rx tx";
    }
    return "";
}

std::string esi_ports_text(const std::string& physics) {
    std::string out;
    for (const char letter : physics) {  // ETG.2000: Y cable (100BASE-TX or FX), H fast hot connect, K E-bus
        out += out.empty() ? "ports: " : ", ";
        if (letter == 'Y') out += "cable";
        else if (letter == 'H') out += "cable (fast hot connect)";
        else if (letter == 'K') out += "E-bus";
        else if (letter == ' ') out += "none";
        else out += std::string("'") + letter + "'";
    }
    return out;
}

std::string esi_sync_text(const ecat::esi::EsiOpMode& mode, unsigned signal) {
    constexpr unsigned sync0_bit = 0x0200, sync1_bit = 0x0400;  // of 0981h, in the high byte of AssignActivate
    if ((mode.assign_activate & (signal == 0 ? sync0_bit : sync1_bit)) == 0) return "off";
    const auto cycle = signal == 0 ? mode.sync0_cycle : mode.sync1_cycle, shift = signal == 0 ? mode.sync0_shift : mode.sync1_shift;
    const auto factor = signal == 0 ? mode.sync0_factor : mode.sync1_factor;
    const auto us = [](Duration time) { return static_cast<double>(time.count()) / 1000.0; };
    std::string out = cycle != Duration::zero() ? fmt::format("{} us", us(cycle))
                      : factor > 1              ? fmt::format("{} bus cycles", factor)
                      : factor < -1             ? fmt::format("bus cycle / {}", -factor)
                                                : std::string("bus cycle");
    if (shift != Duration::zero()) out += fmt::format(", shift {} us", us(shift));
    return out;
}

}  // namespace taktwerk::apps
