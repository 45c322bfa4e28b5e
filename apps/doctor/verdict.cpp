#include "apps/doctor/verdict.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

constexpr std::array<Duration, 9> usual_cycles{125us, 250us, 500us, 1ms, 2ms, 4ms, 5ms, 10ms, 20ms};

Severity by_use(double used, double cycle_us) {
    return used > cycle_us ? Severity::unfit : used > cycle_us / 2 ? Severity::warning : Severity::good;
}

}  // namespace

std::string time_text(Duration time) {
    const double us = to_seconds(time) * 1e6;
    return us >= 1e6 ? fmt::format("{:g} s", us / 1e6) : us >= 1000 ? fmt::format("{:g} ms", us / 1000) : fmt::format("{:g} us", us);
}

double used_us(const Measured& measured, const Wanted& wanted) {
    return measured.lateness.woken.percentile_us(99.9) + to_seconds(wanted.computing) * 1e6 +
           (measured.trips ? measured.trips->took.percentile_us(99.9) : 0);  // 0 where nothing came back
}

std::vector<Finding> measured_findings(const Measured& measured, const Wanted& wanted) {
    std::vector<Finding> all;
    const double cycle_us = to_seconds(wanted.cycle) * 1e6, used = used_us(measured, wanted);
    const auto& woken = measured.lateness.woken;
    const auto parts = fmt::format("woken {:.0f} us late (p99.9) + computing {:.0f} us{} = {:.0f} us of {}", woken.percentile_us(99.9),
                                   to_seconds(wanted.computing) * 1e6,
                                   measured.trips && measured.trips->answered > 0
                                       ? fmt::format(" + round trip {:.0f} us (p99.9)", measured.trips->took.percentile_us(99.9))
                                       : "",
                                   used, time_text(wanted.cycle));
    const auto fits = by_use(used, cycle_us);
    all.push_back({fits == Severity::good ? "measured.fits" : "measured.cycle", fits, fits == Severity::good ? 0 : used, parts,
                   fits == Severity::good      ? ""
                   : fits == Severity::warning ? "outputs are at the drives after the middle of the cycle, where SYNC0 stands by default"
                                               : "outputs are not at the drives before the next cycle",
                   "measured just now",
                   fits == Severity::good ? "" : "see the causes below, or lengthen the cycle (`cycle:` in the machine file)"});
    if (const auto missed = woken.at_least(wanted.cycle); missed > 0)
        all.push_back({"measured.missed",
                       static_cast<double>(missed) * 1000 > static_cast<double>(woken.count()) ? Severity::unfit : Severity::warning,
                       woken.max_us(),
                       fmt::format("{} of {} wake-ups came a whole cycle late, the worst {:.0f} us", missed, woken.count(), woken.max_us()),
                       "each is a cycle without a frame: drives count it, and fault after a few in a row", "measured just now",
                       "see the causes below, the dearest first"});
    if (measured.trips && measured.trips->answered < measured.trips->sent) {
        const auto lost = measured.trips->sent - measured.trips->answered;
        if (measured.trips->answered == 0)
            all.push_back({"measured.no_answer", Severity::warning, 0, "no frame came back", "round trips are not known",
                           "measured just now", "switch the slaves on, look at the cable; `taktwerk bus scan --nic IF` says more"});
        else if (lost > 2)  // the last ones were not waited for
            all.push_back({"measured.lost", Severity::unfit, cycle_us,
                           fmt::format("{} of {} frames did not come back", lost, measured.trips->sent), "each is a cycle without data",
                           "measured just now", "`taktwerk bus counters --nic IF` says which cable"});
    }
    if (measured.clocks.steps > 0)
        all.push_back({"time.set", Severity::note, 0,
                       fmt::format("the calendar clock was set {} times meanwhile, by {:.1f} ms at most", measured.clocks.steps,
                                   to_seconds(measured.clocks.largest_step) * 1e3),
                       "nothing in a cycle (it runs on CLOCK_MONOTONIC); stamps of logs and recordings jump", "measured just now",
                       "one time service that steers instead of setting (chrony: makestep 1 3)"});
    else
        all.push_back({"time.steady", Severity::good, 0,
                       fmt::format("clocks run steadily ({:+.0f} ppm of steering)", measured.clocks.steered_ppm), "", "", ""});
    return all;
}

Verdict verdict(const std::vector<Finding>& findings, const Measured* measured, const Wanted& wanted) {
    Verdict v;
    std::size_t unfit = 0, warnings = 0;
    for (const auto& finding : findings) {
        unfit += finding.severity == Severity::unfit ? 1 : 0;
        warnings += finding.severity == Severity::warning ? 1 : 0;
    }
    const auto things = [](std::size_t n) { return n == 1 ? std::string("1 finding") : fmt::format("{} findings", n); };
    v.fitness = unfit > 0 ? Severity::unfit : warnings > 0 ? Severity::warning : Severity::good;
    const auto cycle = time_text(wanted.cycle);
    v.words = unfit > 0      ? fmt::format("NOT FIT for a cycle of {}: {} in the way", cycle, things(unfit))
              : warnings > 0 ? fmt::format("FIT for a cycle of {}, with {} to mend", cycle, things(warnings))
                             : fmt::format("FIT for a cycle of {}", cycle);
    if (measured != nullptr) {
        const double used = used_us(*measured, wanted);
        const auto fit = std::find_if(usual_cycles.begin(), usual_cycles.end(),
                                      [&](Duration c) { return by_use(used, to_seconds(c) * 1e6) == Severity::good; });
        if (fit != usual_cycles.end()) v.shortest_cycle = *fit;
    }
    return v;
}

}  // namespace taktwerk::apps
