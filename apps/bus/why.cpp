// taktwerk bus why: brings the bus up as the machine would and explains, slave by slave, why it does not reach OP.

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/alarms.hpp"
#include "ecat/diagnosis/physical_remarks.hpp"
#include "runtime/machine/alarm_text.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Survey;
using ecat::WhyReport;

/// The same facts as numbers, for scripts.
Json facts_json(const ecat::Refusal& facts) {
    Json json{{"asked", ecat::name(facts.asked)}, {"reached", ecat::name(facts.reached)}, {"timed_out", facts.timed_out}};
    json["sync_managers"] = Json::array();
    for (const auto& sm : facts.sync_managers) {
        Json one{{"number", sm.number}};
        if (sm.planned) one["configured_bytes"] = sm.planned->length;
        if (sm.found) one["found_bytes"] = sm.found->length;
        if (sm.mapping_bytes) one["mapped_bytes"] = *sm.mapping_bytes;
        if (sm.sii_bytes) one["eeprom_bytes"] = *sm.sii_bytes;
        json["sync_managers"].push_back(std::move(one));
    }
    json["fmmus"] = Json::array();
    for (const auto& fmmu : facts.fmmus)
        json["fmmus"].push_back(
            Json{{"number", fmmu.number},
                 {"as_configured", fmmu.planned.has_value() && fmmu.found.has_value() && *fmmu.planned == *fmmu.found}});
    Json clock{{"configured", facts.clock.configured}, {"required", facts.clock.required}, {"started", facts.clock.started}};
    if (facts.clock.sync0_cycle) clock["sync0_cycle_ns"] = facts.clock.sync0_cycle->count();
    if (facts.clock.difference_ns) clock["difference_ns"] = *facts.clock.difference_ns;
    json["clock"] = std::move(clock);
    json["last_abort"] = facts.last_abort;
    json["lines"] = ecat::fact_lines(facts);
    return json;
}

/// What is wrong with the copper: a bus may reach OP with it, and fall later. The PHYs of a bus that somebody works with are not asked.
std::vector<Error> wrong_copper(BusSession& session, const Survey& found) {
    std::vector<Error> remarks;
    std::copy_if(found.remarks.begin(), found.remarks.end(), std::back_inserter(remarks),
                 [](const Error& remark) { return remark.code == "bus.ebus_overload" || remark.code == "transport.link_speed"; });
    if (!session.must_be_alone("asking the PHYs") || found.highest_state >= ecat::AlState::safeop) return remarks;
    const auto links = session.probe().run(ecat::wrong_links(session.probe().port(), found));
    if (links) remarks.insert(remarks.end(), links->begin(), links->end());
    return remarks;
}

/// What holds while the bus is in OP: a machine would show it as an alarm.
std::vector<Error> standing_alarms(const ecat::Master& master, const ecat::Bus& bus) {
    std::array<AlarmFact, 32> facts;
    std::vector<Error> remarks;
    for (const auto& fact : std::span{facts}.first(master.active_faults(facts))) {
        const auto& info = *find_alarm(ecat::bus_alarms, fact.id);
        std::string where = fact.source == AlarmSource::slave && fact.index < bus.slaves.size() ? bus.slaves[fact.index]->subject : "bus";
        if (const auto more = master.detail(fact); !more.empty()) where += ": " + more;
        remarks.push_back({std::string{info.name}, std::move(where),
                           fmt::format("{}: {}", runtime::fill_in(info.english, fact.a, fact.b), info.cause), std::string{info.remedy}});
    }
    return remarks;
}

Json errors_json(const std::vector<Error>& errors) {
    Json all = Json::array();
    for (const auto& error : errors) all.push_back(error_json(error));
    return all;
}

int explain_failure(BusSession& session, const Error& failure, const std::vector<Error>& copper, const BusOptions& options) {
    Result<WhyReport> report = session.probe().run(ecat::explain(session.bus(), failure));
    if (!report) return fail(options, report.error());
    if (options.json) {
        Json json = why_json(*report);
        json["remarks"] = errors_json(copper);
        print_json(json);
    } else {
        fmt::print("{}{}", why_text(session.where(), *report, colours_of_output()),
                   errors_text(copper, Tone::warning, colours_of_output()));
    }
    return exit_bus;
}

/// Slaves that did not stay in OP while the bus was watched, in words.
std::vector<std::string> fallen(const ecat::Bus& bus) {
    std::vector<std::string> fell;
    for (const auto& slave : bus.slaves) {
        if (slave->away()) continue;  // a group that comes and goes as it likes
        const std::uint32_t al = slave->link.al.load();
        const auto code = static_cast<std::uint16_t>(al >> 16);
        const bool out = al != static_cast<std::uint32_t>(ecat::AlState::op);
        const auto returned = slave->link.recoveries.load();
        if (ecat::al_state(static_cast<std::uint16_t>(al)) == ecat::AlState::unknown)
            fell.push_back(fmt::format("{} does not answer any more", slave->subject));
        else if (out)
            fell.push_back(fmt::format("{} is in {}{}", slave->subject, ecat::name(ecat::al_state(static_cast<std::uint16_t>(al))),
                                       code != 0 ? fmt::format(", AL status code {:04X}h {}", code, ecat::al_status_info(code).text) : ""));
        else if (returned > 0) fell.push_back(fmt::format("{} left OP and came back {} times", slave->subject, returned));
    }
    return fell;
}

/// The bus came up and did not stay up: that is what the person who asks has seen.
int explain_falls(BusSession& session, const std::vector<std::string>& fell, const BusOptions& options) {
    const auto& seen = session.probe().master().statistics();
    const auto notes = session.probe().master().notes();
    if (options.json) {
        print_json(Json{{"operational", false},
                        {"fell", fell},
                        {"frames_sent", seen.frames_sent},
                        {"frames_lost", seen.frames_lost},
                        {"working_counter_errors", seen.working_counter_errors},
                        {"notes", std::vector<std::string>(notes.begin(), notes.end())}});
        return exit_bus;
    }
    fmt::print("{}: the bus reaches OP but does not stay there\n\n", session.where());
    for (const auto& line : fell) fmt::print("{}\n", wrapped(line, 2));
    fmt::print("{} frames sent, {} lost, {} with a wrong working counter\n", seen.frames_sent, seen.frames_lost,
               seen.working_counter_errors);
    for (const auto& note : notes) fmt::print("{}\n", wrapped(note, 2));
    return exit_bus;
}

struct Attendants {
    std::size_t there = 0;
    std::vector<std::string> absent_groups;  ///< by name
};

Attendants attendants(const ecat::Bus& bus) {
    Attendants all;
    all.there =
        static_cast<std::size_t>(std::count_if(bus.slaves.begin(), bus.slaves.end(), [](const auto& slave) { return !slave->away(); }));
    for (const auto& group : bus.groups)
        if (bus.slaves[group.slaves.front()]->away()) all.absent_groups.push_back(group.name);
    return all;
}

int find_out_why(BusSession& session, const BusOptions& options) {
    const Result<Survey> found = session.look();
    if (!found) {
        // Not one slave: nothing to bring up, and the error says all there is.
        if (!options.json) fmt::print("{}: the bus does not reach OP\n\n", session.where());
        return fail(options, found.error());
    }
    std::vector<Error> copper = wrong_copper(session, *found);
    if (auto up = session.bring_up(*found); !up) {
        const Error& failure = up.error();
        if (failure.code == "bus.not_confirmed" || failure.code == "bus.foreign_master" || failure.code == "bus.interrupted")
            return fail(options, failure);
        return explain_failure(session, failure, copper, options);
    }
    constexpr Duration proof = std::chrono::seconds{1};
    if (auto ran = session.probe().run_for(proof); !ran) return fail(options, ran.error());
    const auto& seen = session.probe().master().statistics();
    const std::vector<std::string> fell = fallen(session.bus());
    if (!fell.empty()) return explain_falls(session, fell, options);
    for (auto& alarm : standing_alarms(session.probe().master(), session.bus())) copper.push_back(std::move(alarm));
    const auto [there, absent] = attendants(session.bus());
    if (options.json) {
        print_json(Json{{"operational", true},
                        {"slaves", there},
                        {"absent_groups", absent},
                        {"frames_sent", seen.frames_sent},
                        {"frames_lost", seen.frames_lost},
                        {"working_counter_errors", seen.working_counter_errors},
                        {"remarks", errors_json(copper)}});
    } else {
        fmt::print("{}: the bus reaches OP with {}{}\n", session.where(), count_text(there, "slave"),
                   copper.empty() ? "; there is nothing to explain." : ", but not all is well.");
        fmt::print("{} frames sent, {} lost, {} with a wrong working counter\n", seen.frames_sent, seen.frames_lost,
                   seen.working_counter_errors);
        for (const auto& group : absent) fmt::print("group '{}' is not plugged in\n", group);
        for (const auto& note : session.probe().master().notes()) fmt::print("{}\n", wrapped(note, 2));
        fmt::print("{}", errors_text(copper, Tone::warning, colours_of_output()));
    }
    return copper.empty() ? exit_ok : exit_bus;
}

}  // namespace

std::string why_text(const std::string& where, const WhyReport& report, Colours colours) {
    std::string out = toned(where, Tone::strong, colours) + ": " + toned("the bus does not reach OP", Tone::bad, colours) + "\n";
    bool explained = false;
    std::string waiting;
    for (const auto& slave : report.slaves) {
        if (!slave.failed) {
            waiting += fmt::format("{}{} {}", waiting.empty() ? "" : ", ", slave.subject,
                                   slave.answers ? fmt::format("in {}", ecat::name(slave.state)) : std::string{"(silent)"});
            continue;
        }
        explained = true;
        out += "\n" + toned(slave.subject, Tone::strong, colours) + "\n";
        const auto line = [&](const char* title, const std::string& text) {
            if (!text.empty()) out += fmt::format("  {:<12}{}\n", title, wrapped(text, 14));
        };
        if (!slave.answers) {
            line("state", "does not answer");
        } else if (slave.facts) {
            line("asked", fmt::format("{}, is in {}{}", ecat::name(slave.facts->asked), ecat::name(slave.state),
                                      slave.al_error ? " and shows an error" : ""));
        }
        if (slave.al_error || slave.al_code != 0)
            line("AL status", fmt::format("code {:04X}h {}", slave.al_code, ecat::al_status_info(slave.al_code).text));
        bool first = true;
        if (slave.facts)
            for (const auto& fact : ecat::fact_lines(*slave.facts)) {
                line(first ? "facts" : "", fact);
                first = false;
            }
        out += "  " + toned("cause", Tone::bad, colours) + "       " + wrapped(slave.cause, 14) + "\n";
        if (!slave.remedy.empty()) out += "  " + toned("remedy", Tone::good, colours) + "      " + wrapped(slave.remedy, 14) + "\n";
    }
    if (!explained) {
        out += "\n" + (report.failure.subject.empty() ? std::string{"bus"} : report.failure.subject) + ": " +
               wrapped(report.failure.what, 2) + "\n";
        if (!report.failure.remedy.empty()) out += "  -> " + wrapped(report.failure.remedy, 5) + "\n";
    }
    if (!waiting.empty()) out += "\n" + wrapped((explained ? "Waiting for it: " : "Slaves: ") + waiting, 2) + "\n";
    for (const auto& note : report.notes) out += wrapped(note, 2) + "\n";
    return out;
}

Json why_json(const WhyReport& report) {
    Json slaves = Json::array();
    for (const auto& slave : report.slaves) {
        Json one{{"subject", slave.subject},
                 {"position", slave.position},
                 {"failed", slave.failed},
                 {"answers", slave.answers},
                 {"state", ecat::name(slave.state)},
                 {"error", slave.al_error},
                 {"al_status_code", slave.al_code},
                 {"al_status_text", slave.al_code != 0 ? ecat::al_status_info(slave.al_code).text : ""},
                 {"cause", slave.cause},
                 {"remedy", slave.remedy}};
        if (slave.facts) one["facts"] = facts_json(*slave.facts);
        slaves.push_back(std::move(one));
    }
    return Json{{"operational", false}, {"failure", error_json(report.failure)}, {"slaves", std::move(slaves)}, {"notes", report.notes}};
}

void add_bus_why(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("why", "bring the bus up as the machine would, and explain why it does not reach OP");
    auto options = add_bus_options(*sub);
    sub->add_flag("--yes", options->yes, "do not ask before outputs are driven (with 0)");
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options, [&](BusSession& session) { return find_out_why(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
