// taktwerk bus dc: the distributed clocks as the slaves have them.

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {

namespace {

using ecat::ClockReport;
using ecat::Survey;

constexpr Duration limit = std::chrono::microseconds{3};  // SV33-E manual, P0A.32

std::string microseconds(Duration time) { return fmt::format("{:g} us", static_cast<double>(time.count()) * 1e-3); }

Json clocks_json(const Survey& survey, const std::vector<ClockReport>& clocks) {
    Json list = Json::array();
    for (const auto& clock : clocks) {
        Json json{{"position", clock.position},
                  {"name", survey.slaves[clock.position].name},
                  {"reference", clock.reference},
                  {"clock_64bit", clock.clock_64bit},
                  {"system_time_ns", clock.system_time},
                  {"delay_ns", clock.delay},
                  {"offset_ns", clock.offset},
                  {"difference_ns", clock.difference},
                  {"sync0", clock.sync0},
                  {"sync0_cycle_ns", clock.sync0_cycle.count()},
                  {"sync1", clock.sync1},
                  {"sync1_cycle_ns", clock.sync1_cycle.count()},
                  {"start_ns", clock.start}};
        if (clock.error) json["unreadable"] = error_json(*clock.error);
        list.push_back(std::move(json));
    }
    return Json{{"clocks", std::move(list)}, {"findings", ecat::clock_findings(survey, clocks, limit)}};
}

}  // namespace

std::string clocks_text(const Survey& survey, const std::vector<ClockReport>& clocks, Colours colours) {
    if (clocks.empty()) return "No slave on this bus has a distributed clock.\n";
    using Side = TextTable::Column::Side;
    TextTable table{{{"slave", Side::left, 26},
                     {"clock"},
                     {"delay", Side::right},
                     {"092Ch", Side::right},
                     {"SYNC0", Side::right},
                     {"SYNC1", Side::right}}};
    for (const auto& clock : clocks) {
        if (clock.error) {
            table.add({survey.subject(clock.position), Cell{"no answer", Tone::bad}});
            continue;
        }
        const bool off = std::abs(static_cast<std::int64_t>(clock.difference)) > limit.count();
        table.add({survey.subject(clock.position),
                   fmt::format("{} bit{}", clock.clock_64bit ? 64 : 32, clock.reference ? ", reference" : ""),
                   fmt::format("{} ns", clock.delay),
                   clock.reference ? Cell{"-", Tone::faint} : Cell{fmt::format("{} ns", clock.difference), off ? Tone::bad : Tone::plain},
                   clock.sync0 ? Cell{microseconds(clock.sync0_cycle)} : Cell{"off", Tone::faint},
                   clock.sync1 ? Cell{microseconds(clock.sync1_cycle)} : Cell{"off", Tone::faint}});
    }
    std::string out = table.text(colours);
    for (const auto& finding : ecat::clock_findings(survey, clocks, limit)) out += "\n" + wrapped(finding, 2) + "\n";
    return out;
}

void add_bus_clocks(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("dc", "distributed clocks: reference, delays, difference, SYNC0 and SYNC1");
    auto options = add_bus_options(*sub);
    add_operational(*sub, *options);
    sub->callback([&action, options] {
        action = [options] {
            return with_bus(*options, [&](BusSession& session) {
                const Result<Survey> found = session.look();
                if (!found) return fail(*options, found.error());
                if (options->operational)
                    if (auto up = session.bring_up(*found); !up) return fail(*options, up.error());
                const auto clocks = session.probe().run(ecat::read_clocks(session.probe().port(), *found));
                if (!clocks) return fail(*options, clocks.error());
                if (options->json) print_json(clocks_json(*found, *clocks));
                else fmt::print("{}", clocks_text(*found, *clocks, colours_of_output()));
                return static_cast<int>(exit_ok);
            });
        };
    });
}

}  // namespace taktwerk::apps
