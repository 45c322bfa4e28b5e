#pragma once
// The sub-commands of `taktwerk bus`, one file each; what they share is in bus_session.hpp. Their texts are made by pure
// functions, so that tests read them.

#include <span>
#include <string>
#include <vector>

#include "apps/bus/session.hpp"
#include "apps/taktwerk.hpp"
#include "ecat/diagnosis/clock_report.hpp"
#include "ecat/diagnosis/dictionary.hpp"
#include "ecat/diagnosis/pdo_report.hpp"
#include "ecat/diagnosis/phy_report.hpp"
#include "ecat/diagnosis/port_errors.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "ecat/diagnosis/why_not_op.hpp"
#include "ecat/esi/esi_folder.hpp"
#include "ecat/recording/bus_traffic.hpp"

namespace taktwerk::apps {

void add_bus_scan(CLI::App& bus, Action& action);
void add_bus_state(CLI::App& bus, Action& action);
void add_bus_pdo(CLI::App& bus, Action& action);
void add_bus_sdo(CLI::App& bus, Action& action);
void add_bus_clocks(CLI::App& bus, Action& action);
void add_bus_counters(CLI::App& bus, Action& action);
void add_bus_why(CLI::App& bus, Action& action);
void add_bus_capture(CLI::App& bus, Action& action);
void add_bus_init(CLI::App& bus, Action& action);
void add_bus_eeprom(CLI::App& bus, Action& action);
void add_bus_mii(CLI::App& bus, Action& action);
void add_bus_file(CLI::App& bus, Action& action);
void add_bus_firmware(CLI::App& bus, Action& action);
void add_bus_eoe(CLI::App& bus, Action& action);

/// The options that every sub-command has.
[[nodiscard]] std::shared_ptr<BusOptions> add_bus_options(CLI::App& sub);
/// --operational, --yes: for what is worth looking at in OP, too.
void add_operational(CLI::App& sub, BusOptions& options);

/// `vendors`: files that say who a slave is; nullptr: none.
[[nodiscard]] std::string scan_text(const std::string& where, const ecat::Survey& survey, Colours colours,
                                    const ecat::esi::EsiFolder* vendors = nullptr);
[[nodiscard]] Json scan_json(const ecat::Survey& survey, const ecat::esi::EsiFolder* vendors = nullptr);
[[nodiscard]] std::string state_text(const std::string& where, const ecat::Survey& survey, Colours colours);
[[nodiscard]] std::string pdo_text(const ecat::PdoReport& report, Colours colours);
[[nodiscard]] Json pdo_json(const ecat::PdoReport& report);
[[nodiscard]] std::string clocks_text(const ecat::Survey& survey, const std::vector<ecat::ClockReport>& clocks, Colours colours);
[[nodiscard]] std::string counters_text(const ecat::Survey& survey, Colours colours);
[[nodiscard]] std::string mii_text(const std::string& subject, const std::vector<ecat::PhyReport>& reports, Colours colours);
[[nodiscard]] std::string dictionary_text(const ecat::Dictionary& dictionary, Colours colours);
[[nodiscard]] std::string why_text(const std::string& where, const ecat::WhyReport& report, Colours colours);
[[nodiscard]] Json why_json(const ecat::WhyReport& report);

[[nodiscard]] std::string traffic_text(const std::string& where, const ecat::BusTraffic& traffic, std::uint64_t missed, Colours colours);
[[nodiscard]] Json traffic_json(const ecat::BusTraffic& traffic, std::uint64_t missed);

/// The state as it is shown everywhere: green in OP, red with an error.
[[nodiscard]] Cell state_cell(ecat::AlState state, bool error);
/// One paragraph each, with the remedy.
[[nodiscard]] std::string errors_text(std::span<const Error> errors, Tone tone, Colours colours);
/// What is wrong with the bus as a whole and with single slaves, one paragraph each; empty: nothing.
[[nodiscard]] std::string remarks_text(const ecat::Survey& survey, Colours colours);
[[nodiscard]] bool has_problems(const ecat::Survey& survey);

}  // namespace taktwerk::apps
