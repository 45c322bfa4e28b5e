#include "apps/doctor/report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

Tone tone_of(Severity severity) {
    switch (severity) {
        case Severity::good: return Tone::good;
        case Severity::note: return Tone::plain;
        case Severity::warning: return Tone::warning;
        case Severity::unfit: return Tone::bad;
    }
    return Tone::plain;
}

const char* mark(Severity severity) { return severity == Severity::unfit ? "!!" : severity == Severity::warning ? "! " : "  "; }

std::string figures(const char* what, const MicrosecondHistogram& h) {
    return fmt::format("{} p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f}, max {:.0f} us", what, h.percentile_us(50), h.percentile_us(99),
                       h.percentile_us(99.9), h.max_us());
}

void put_measured(std::string& text, const Examination& seen) {
    const auto& m = *seen.measured;
    text += fmt::format("Measured {} each {}: {}\n", time_text(m.plan.lasts), time_text(m.plan.interval),
                        figures("woken late", m.lateness.woken));
    if (m.trips && m.trips->answered > 0)
        text += fmt::format("         {} frames to {} slaves and back: {}\n", m.trips->answered, m.trips->slaves,
                            figures("round trip", m.trips->took));
    if (!m.no_trips.empty()) text += fmt::format("         no round trips: {}\n", m.no_trips);
    for (const auto& item : m.lateness.granted.items)
        if (!item.granted && item.what != "PREEMPT_RT kernel")
            text += fmt::format("         without {}: a machine would have to do without it as well\n", item.what);
    text += seen.verdict.shortest_cycle ? fmt::format("         by these figures alone {} is the shortest cycle that fits\n",
                                                      time_text(*seen.verdict.shortest_cycle))
                                        : "         by these figures alone no usual cycle fits\n";
}

void put_lines(std::string& text, const char* title, const std::string& lines) {
    std::size_t at = 0;
    for (bool first = true; at < lines.size(); first = false) {
        const auto end = std::min(lines.find('\n', at), lines.size());
        text += fmt::format("            {:<6}{}\n", first ? title : "", lines.substr(at, end - at));
        at = end + 1;
    }
}

Json histogram(const MicrosecondHistogram& h) {
    auto bins = Json::array();
    for (std::size_t us = 0; us < h.all().size(); ++us)
        if (h.all()[us] > 0) bins.push_back({us, h.all()[us]});
    return {{"count", h.count()},   {"p50_us", h.percentile_us(50)}, {"p99_us", h.percentile_us(99)}, {"p999_us", h.percentile_us(99.9)},
            {"max_us", h.max_us()}, {"bins", std::move(bins)}};
}

}  // namespace

std::string report_text(const Examination& seen, Colours colours, std::size_t width, Sources sources) {
    std::string text = toned(seen.verdict.words, tone_of(seen.verdict.fitness), colours) + "\n";
    if (seen.measured) put_measured(text, seen);
    text += "\n";
    std::vector<std::string> healthy, applies;
    for (const auto& finding : seen.findings) {
        if (finding.severity == Severity::good) {
            healthy.push_back(finding.found);
            continue;
        }
        const auto cost = finding.cost_us >= 0.5 ? fmt::format("{:.0f} us", finding.cost_us) : std::string{};
        text += fmt::format("{} {:>8} {}\n", toned(mark(finding.severity), tone_of(finding.severity), colours), cost,
                            toned(finding.found, Tone::strong, colours));
        put_lines(text, "costs",
                  wrapped(finding.costs + (sources == Sources::shown && !finding.source.empty() ? " [" + finding.source + "]" : ""), 0,
                          width < 40 ? 40 : width - 18));
        put_lines(text, "mend", finding.remedy);
        if (!finding.changes.empty()) applies.push_back(finding.code);
    }
    if (!healthy.empty()) text += "As it should be: " + wrapped(fmt::format("{}", fmt::join(healthy, "; ")), 17, width) + "\n";
    if (!applies.empty())
        text += "`--apply` mends, and `--revert` takes back: " + wrapped(fmt::format("{}", fmt::join(applies, ", ")), 44, width) + "\n";
    return text;
}

Json report_json(const Examination& seen) {
    Json json{{"fit", word(seen.verdict.fitness)},
              {"verdict", seen.verdict.words},
              {"cycle_us", to_seconds(seen.wanted.cycle) * 1e6},
              {"computing_us", to_seconds(seen.wanted.computing) * 1e6}};
    if (seen.wanted.cpu >= 0) json["cpu"] = seen.wanted.cpu;
    if (!seen.interface.empty()) json["interface"] = seen.interface;
    auto& findings = json["findings"] = Json::array();
    for (const auto& f : seen.findings)
        findings.push_back({{"code", f.code},
                            {"severity", word(f.severity)},
                            {"cost_us", f.cost_us},
                            {"found", f.found},
                            {"costs", f.costs},
                            {"source", f.source},
                            {"remedy", f.remedy},
                            {"applicable", !f.changes.empty()}});
    if (!seen.measured) return json;
    const auto& m = *seen.measured;
    json["lateness"] = histogram(m.lateness.woken);
    json["lateness"]["interval_us"] = to_seconds(m.plan.interval) * 1e6;
    auto& granted = json["lateness"]["granted"] = Json::array();
    for (const auto& item : m.lateness.granted.items)
        granted.push_back({{"what", item.what}, {"granted", item.granted}, {"reason", item.reason}});
    if (m.trips) {
        json["round_trips"] = histogram(m.trips->took);
        json["round_trips"]["sent"] = m.trips->sent;
        json["round_trips"]["answered"] = m.trips->answered;
        json["round_trips"]["slaves"] = m.trips->slaves;
    }
    if (!m.no_trips.empty()) json["no_round_trips"] = m.no_trips;
    json["clocks"] = {
        {"steps", m.clocks.steps}, {"largest_step_us", to_seconds(m.clocks.largest_step) * 1e6}, {"steered_ppm", m.clocks.steered_ppm}};
    if (seen.verdict.shortest_cycle) json["shortest_cycle_us"] = to_seconds(*seen.verdict.shortest_cycle) * 1e6;
    return json;
}

}  // namespace taktwerk::apps
