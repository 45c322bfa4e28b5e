// taktwerk bus counters: error counters of every port, and which cable they speak of.

#include <cstdio>

#include <fmt/format.h>

#include "apps/bus/bus.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"

namespace taktwerk::apps {

namespace {

using ecat::Survey;

struct CounterOptions {
    std::shared_ptr<BusOptions> bus;
    bool watch = false, reset = false;
    double duration_s = 0;
};

constexpr Duration watch_period = std::chrono::seconds{1};
constexpr double simulated_watch_s = 10;  ///< virtual time does not wait for a Ctrl-C

Cell number(unsigned count, Tone tone) { return count == 0 ? Cell{"0", Tone::faint} : Cell{std::to_string(count), tone}; }

Json counters_json(const Survey& survey) {
    Json json = scan_json(survey);
    Json findings = Json::array();
    for (const auto& finding : ecat::port_findings(survey))
        findings.push_back(Json{{"position", finding.position}, {"port", finding.port}, {"text", finding.text}});
    json["findings"] = std::move(findings);
    return json;
}

int show_counters(BusSession& session, const Survey& survey, const BusOptions& options) {
    if (options.json) print_json(counters_json(survey));
    else fmt::print("{}", counters_text(survey, colours_of_output()));
    std::fflush(stdout);
    (void)session;
    return exit_ok;
}

int read_counters(BusSession& session, const CounterOptions& options) {
    Result<Survey> found = session.look();
    if (!found) return fail(*options.bus, found.error());
    if (options.reset) {
        if (auto cleared = session.probe().run(ecat::clear_counters(session.probe().port(), found->slaves.size())); !cleared)
            return fail(*options.bus, cleared.error());
        if (auto read = session.probe().run(ecat::refresh_counters(session.probe().port(), *found)); !read)
            return fail(*options.bus, read.error());
    }
    show_counters(session, *found, *options.bus);
    if (!options.watch) return exit_ok;
    const double seconds = options.duration_s > 0 ? options.duration_s : session.simulated() ? simulated_watch_s : 0;
    const auto rounds = static_cast<std::uint64_t>(std::llround(seconds / to_seconds(watch_period)));
    for (std::uint64_t round = 0; rounds == 0 || round < rounds; ++round) {
        if (!session.probe().run_for(watch_period)) return exit_ok;  // Ctrl-C
        const Survey before = *found;
        if (auto read = session.probe().run(ecat::refresh_counters(session.probe().port(), *found)); !read) return exit_ok;
        for (std::size_t i = 0; i < found->slaves.size(); ++i)
            if (found->slaves[i].ports != before.slaves[i].ports) {
                if (!options.bus->json) fmt::print("\nafter {} s:\n", round + 1);
                show_counters(session, *found, *options.bus);
                break;
            }
    }
    return exit_ok;
}

}  // namespace

std::string counters_text(const Survey& survey, Colours colours) {
    using Side = TextTable::Column::Side;
    TextTable table{{{"slave", Side::left, 28},
                     {"port"},
                     {"at the other end", Side::left, 24},
                     {"lost", Side::right},
                     {"RX err", Side::right},
                     {"invalid", Side::right},
                     {"forwarded", Side::right}}};
    std::string watchdogs;
    for (std::size_t i = 0; i < survey.slaves.size(); ++i) {
        const auto& slave = survey.slaves[i];
        bool first = true;
        for (unsigned p = 0; p < ecat::ports_per_slave; ++p) {
            const auto& port = slave.ports[p];
            if (!port.link && port.counters.clean()) continue;
            const auto& c = port.counters;
            table.add({first ? survey.subject(i) : std::string{}, std::to_string(p), port.link ? ecat::neighbour(survey, i, p) : "no link",
                       number(c.lost_links, Tone::bad), number(c.rx_errors, Tone::bad), number(c.invalid_frames, Tone::warning),
                       number(c.forwarded_errors, Tone::plain)});
            first = false;
        }
        if (slave.sm_watchdogs != 0)
            watchdogs +=
                fmt::format("{}: its outputs stayed away {} (SM watchdog)\n", survey.subject(i), count_text(slave.sm_watchdogs, "time"));
        if (slave.processing_unit_errors != 0 || slave.pdi_errors != 0)
            watchdogs += fmt::format("{}: {} errors in its processing unit, {} at its application's interface\n", survey.subject(i),
                                     slave.processing_unit_errors, slave.pdi_errors);
    }
    std::string out = table.text(colours);
    if (!watchdogs.empty()) out += "\n" + watchdogs;
    const auto findings = ecat::port_findings(survey);
    if (findings.empty()) return out + "\nNo port has counted an error since power-on or the last --reset.\n";
    out += "\n";
    for (const auto& finding : findings) out += wrapped(finding.text, 2) + "\n";
    return out + "Counters stop at 255 and stay until --reset: reset them, wait, and look what rises.\n";
}

void add_bus_counters(CLI::App& bus, Action& action) {
    auto* sub = bus.add_subcommand("counters", "error counters of every port, and which cable they speak of");
    auto options = std::make_shared<CounterOptions>();
    options->bus = add_bus_options(*sub);
    sub->add_flag("--watch", options->watch, "again each second, when one has risen, until Ctrl-C");
    add_duration(*sub, "--for", options->duration_s, "how long to watch");
    sub->add_flag("--reset", options->reset, "set them to 0 first");
    sub->callback([&action, options] {
        action = [options] { return with_bus(*options->bus, [&](BusSession& session) { return read_counters(session, *options); }); };
    });
}

}  // namespace taktwerk::apps
