// taktwerk bus state [init|preop|op]: in which state each slave is; or asks for one.

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/machine/stop_signal.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/slave_setup.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::apps {

namespace {

using ecat::AlState;
using ecat::Survey;

struct StateOptions {
    std::shared_ptr<BusOptions> bus;
    std::string request, slave;
    double hold_s = 0;
};

Json state_json(const Survey& survey) {
    Json list = Json::array();
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        list.push_back(Json{{"position", i},
                            {"name", slave.name},
                            {"device", slave.device_name},
                            {"state", ecat::name(slave.state)},
                            {"error", slave.al_error},
                            {"al_status_code", slave.al_code},
                            {"al_status_text", slave.al_code != 0 ? ecat::al_status_info(slave.al_code).text : ""}});
    }
    return Json{{"slaves", std::move(list)}};
}

void show_states(BusSession& session, const Survey& survey, const BusOptions& options) {
    if (options.json) print_json(state_json(survey));
    else fmt::print("{}", state_text(session.where(), survey, colours_of_output()));
    std::fflush(stdout);
}

/// PREOP from wherever the slave is; from INIT with its mailbox set up.
ecat::Script<Result<void>> to_preop(ecat::Bus& bus, ecat::BusSlave& slave) {
    const Result<std::uint16_t> status = co_await ecat::read_al_status(bus, slave);
    if (!status) co_return status.error();
    const AlState state = ecat::al_state(*status);
    if (state > AlState::preop && state != AlState::boot) co_return co_await ecat::set_state(bus, slave, AlState::preop);
    if (state == AlState::boot) {
        const Result<void> down = co_await ecat::set_state(bus, slave, AlState::init);
        if (!down) co_return down;
    }
    co_return co_await ecat::enter_preop(bus, slave);
}

ecat::Script<Result<void>> to_init(ecat::Bus& bus, ecat::BusSlave& slave) { return ecat::set_state(bus, slave, AlState::init); }

/// Another master may have left the EEPROMs with the slaves' processors: without them nobody knows who a slave is.
ecat::Script<Result<void>> take_eeproms(ecat::DatagramPort& port) {
    co_await port.bwr(ecat::reg::eeprom_configuration, std::uint8_t{2});
    co_await port.bwr(ecat::reg::eeprom_configuration, std::uint8_t{0});
    co_return Result<void>{};
}

bool some_unread(const Survey& survey) {
    return std::any_of(survey.slaves.begin(), survey.slaves.end(), [](const auto& slave) { return slave.found.error.has_value(); });
}

/// Down to PREOP or INIT, or up to PREOP: no process data, so nobody is asked.
int request_low(BusSession& session, Survey survey, const StateOptions& options) {
    if (auto allowed = session.may_write(survey, "changing states"); !allowed) return fail(*options.bus, allowed.error());
    std::optional<std::size_t> only;
    if (!options.slave.empty()) {
        const Result<std::size_t> position = find_slave(survey, options.slave);
        if (!position) return fail(*options.bus, position.error());
        only = *position;
    }
    if (some_unread(survey)) {
        if (auto taken = session.probe().run(take_eeproms(session.probe().port())); !taken) return fail(*options.bus, taken.error());
        Result<Survey> again = session.look();
        if (!again) return fail(*options.bus, again.error());
        survey = std::move(*again);
    }
    session.adopt(survey);
    std::optional<Error> refused;
    // Whom the survey could not read was not asked for the state either.
    for (const auto& slave : survey.slaves)
        if (slave.found.error && (!only || slave.found.position == *only) && !refused) refused = slave.found.error;
    for (auto& slave : session.bus().slaves) {
        if (only && slave->found.position != *only) continue;
        const Result<void> done = options.request == "init" ? session.probe().run(to_init(session.bus(), *slave))
                                                            : session.probe().run(to_preop(session.bus(), *slave));
        if (!done && !refused) refused = done.error();
    }
    const Result<Survey> after = session.look();
    if (after) show_states(session, *after, *options.bus);
    if (refused) return fail(*options.bus, *refused);
    return after ? static_cast<int>(exit_ok) : fail(*options.bus, after.error());
}

/// OP lasts as long as somebody sends process data: as long as this command lives.
int request_op(BusSession& session, const Survey& survey, const StateOptions& options) {
    if (auto up = session.bring_up(survey); !up) {
        Error error = up.error();
        if (error.code != "bus.not_confirmed" && error.code != "bus.foreign_master") error.remedy += "; `taktwerk bus why` shows more";
        return fail(*options.bus, error);
    }
    const Result<Survey> reached = session.look();
    if (!reached) return fail(*options.bus, reached.error());
    show_states(session, *reached, *options.bus);
    const bool until_stopped = options.hold_s <= 0 && !session.simulated();
    if (until_stopped && !options.bus->json) fmt::print("\nOP, with outputs 0, until Ctrl-C.\n");
    std::fflush(stdout);
    while (until_stopped && session.probe().run_for(std::chrono::milliseconds{100})) {}
    if (options.hold_s > 0) (void)session.probe().run_for(from_seconds(options.hold_s)).ok();
    const auto& seen = session.probe().master().statistics();
    if (!options.bus->json)
        fmt::print("{} frames sent, {} lost, {} with a wrong working counter\n", seen.frames_sent, seen.frames_lost,
                   seen.working_counter_errors);
    return exit_ok;
}

int show_or_request(BusSession& session, const StateOptions& options) {
    const Result<Survey> found = session.look();
    if (!found) return fail(*options.bus, found.error());
    if (options.request == "op") {
        if (!options.slave.empty())
            return fail(*options.bus,
                        Error{"bus.no_such_slave", "", "one slave alone cannot be brought to OP: process data needs the whole bus",
                              "leave --slave away"});
        return request_op(session, *found, options);
    }
    if (!options.request.empty()) return request_low(session, *found, options);
    show_states(session, *found, *options.bus);
    return has_problems(*found) ? exit_bus : exit_ok;
}

}  // namespace

std::string state_text(const std::string& where, const Survey& survey, Colours colours) {
    using Side = TextTable::Column::Side;
    TextTable table{{{"slave", Side::left, 26}, {"device", Side::left, 28}, {"state"}, {"code"}}};
    std::string errors;
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        const bool code = slave.al_error || slave.al_code != 0;
        table.add({survey.subject(i), slave.device_name, state_cell(slave.state, slave.al_error),
                   code ? Cell{fmt::format("{:04X}h", slave.al_code), slave.al_error ? Tone::bad : Tone::plain} : Cell{""}});
        if (!slave.al_error) continue;
        const auto& info = ecat::al_status_info(slave.al_code);
        errors += "\n" + toned(survey.subject(i), Tone::bad, colours) + fmt::format(": {:04X}h {}\n", slave.al_code, info.text);
        if (!info.remedy.empty()) errors += "  -> " + wrapped(info.remedy, 5) + "\n";
    }
    return toned(where, Tone::strong, colours) + ": " + count_text(survey.slaves.size(), "slave") + "\n\n" + table.text(colours) + errors +
           remarks_text(survey, colours);
}

void add_bus_state(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("state", "the state of each slave, or ask for one: init, preop, op");
    auto options = std::make_shared<StateOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_option("STATE", options->request, "init, preop, or op (with outputs 0, as long as this command runs)")
        ->check(CLI::IsMember({"init", "preop", "op"}));
    sub->add_option("--slave", options->slave, "only this one, by position or name (init and preop)");
    sub->add_flag("--yes", options->bus->yes, "do not ask before outputs are driven");
    add_duration(*sub, "--for", options->hold_s, "stay in OP for so long; default: until Ctrl-C");
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return show_or_request(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
