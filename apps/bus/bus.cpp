// taktwerk bus: looking at an EtherCAT bus and at its slaves, with or without a machine file.

#include "apps/bus/bus.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::apps {

std::shared_ptr<BusOptions> add_bus_options(CLI::App& sub) {
    auto options = std::make_shared<BusOptions>();
    sub.add_option("--nic", options->nic, "network interface, e.g. eth1")->type_name("IF");
    sub.add_option("--machine", options->machine, "machine file: names, expected devices, and its interface")->type_name("FILE");
    sub.add_flag("--simulate", options->simulate, "the simulated slaves of the machine file, in virtual time");
    sub.add_option("--pcap", options->pcap, "write all frames to this file, for Wireshark and tshark")->type_name("FILE");
    sub.add_flag("--json", options->json, "the answer as one JSON object");
    sub.add_flag("--force", options->force, "write also while another master is on the cable (never to bring the bus up beside it)");
    return options;
}

void add_operational(CLI::App& sub, BusOptions& options) {
    sub.add_flag("--operational", options.operational, "bring the bus to OP first, with outputs 0, and down again afterwards");
    sub.add_flag("--yes", options.yes, "do not ask before outputs are driven");
}

Cell state_cell(ecat::AlState state, bool error) {
    std::string text{ecat::name(state)};
    if (error) return Cell{text + " + error", Tone::bad};
    return Cell{text, state == ecat::AlState::op ? Tone::good : Tone::plain};
}

bool has_problems(const ecat::Survey& survey) {
    return !survey.remarks.empty() || std::any_of(survey.slaves.begin(), survey.slaves.end(), [](const ecat::SurveyedSlave& slave) {
        return slave.found.error || slave.mismatch || slave.al_error;
    });
}

namespace {

std::string remark_paragraph(const std::string& subject, const std::string& what, Tone tone, Colours colours) {
    const std::string text = wrapped(subject + ": " + what, 2);
    return "\n" + toned(text.substr(0, subject.size()), tone, colours) + text.substr(subject.size()) + "\n";
}

}  // namespace

std::string errors_text(std::span<const Error> errors, Tone tone, Colours colours) {
    std::string out;
    for (const auto& error : errors) {
        out += remark_paragraph(error.subject.empty() ? "bus" : error.subject, error.what, tone, colours);
        if (!error.remedy.empty()) out += "  -> " + wrapped(error.remedy, 5) + "\n";
    }
    return out;
}

std::string remarks_text(const ecat::Survey& survey, Colours colours) {
    std::string out = errors_text(survey.remarks, Tone::warning, colours);
    for (const auto& slave : survey.slaves) {
        if (slave.found.error) {
            Error error = *slave.found.error;
            error.subject = survey.subject(slave.found.position);
            out += errors_text({&error, 1}, Tone::bad, colours);
        }
        if (slave.mismatch) out += errors_text({&*slave.mismatch, 1}, Tone::bad, colours);
    }
    for (const auto& finding : ecat::port_findings(survey)) out += remark_paragraph("cable", finding.text, Tone::warning, colours);
    return out;
}

void add_bus(CLI::App& app, Action& action) {
    auto* bus = app.add_subcommand("bus", "look at an EtherCAT bus: who is there, in which state, and why it does not reach OP");
    bus->require_subcommand(1);
    add_bus_scan(*bus, action);
    add_bus_state(*bus, action);
    add_bus_pdo(*bus, action);
    add_bus_sdo(*bus, action);
    add_bus_clocks(*bus, action);
    add_bus_counters(*bus, action);
    add_bus_why(*bus, action);
    add_bus_capture(*bus, action);
    add_bus_init(*bus, action);
    add_bus_eeprom(*bus, action);
    add_bus_mii(*bus, action);
    add_bus_file(*bus, action);
    add_bus_firmware(*bus, action);
    add_bus_eoe(*bus, action);
}

}  // namespace taktwerk::apps
