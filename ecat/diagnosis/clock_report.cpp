#include "ecat/diagnosis/clock_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

Script<void> read_one(DatagramPort& port, const SurveyedSlave& slave, ClockReport& report) {
    const std::string subject = fmt::format("slave {}", slave.found.position);
    const Reply times = co_await port.fprd(slave.found.station, reg::dc_system_time, 8);
    const Reply settings = co_await port.fprd(slave.found.station, reg::dc_system_offset, 16);  // 0920h, 0928h, 092Ch
    const Reply activation = co_await port.fprd(slave.found.station, reg::dc_activation, 1);
    const Reply start = co_await port.fprd(slave.found.station, reg::dc_start_time, 8);
    const Reply cycles = co_await port.fprd(slave.found.station, reg::dc_sync0_cycle, 8);
    const std::array<const Reply*, 5> replies{&times, &settings, &activation, &start, &cycles};
    for (const Reply* reply : replies)
        if (!reply->ok()) {
            report.error = unanswered(subject, "its clock (0910h..09A7h)", *reply);
            co_return;
        }
    report.system_time = times.u64();
    report.offset = settings.u64();
    report.delay = settings.u32(8);
    report.difference = dc_difference_ns(settings.u32(12));
    const auto active = static_cast<std::uint8_t>(activation.data[0]);
    report.cyclic = (active & dc_activate::cyclic) != 0;
    report.sync0 = report.cyclic && (active & dc_activate::sync0) != 0;
    report.sync1 = report.cyclic && (active & dc_activate::sync1) != 0;
    report.start = start.u64();
    report.sync0_cycle = Duration{cycles.u32()};
    report.sync1_cycle = Duration{cycles.u32(4)};
}

}  // namespace

Script<Result<std::vector<ClockReport>>> read_clocks(DatagramPort& port, const Survey& survey) {
    std::vector<ClockReport> clocks;
    for (const auto& slave : survey.slaves) {
        if (slave.found.error || !slave.dc()) continue;
        ClockReport report;
        report.position = slave.found.position;
        report.reference = clocks.empty();
        report.clock_64bit = (slave.found.features & feature::dc_64bit) != 0;
        clocks.push_back(report);
    }
    std::vector<Script<void>> scripts;
    for (auto& report : clocks) scripts.push_back(read_one(port, survey.slaves[report.position], report));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    co_return clocks;
}

std::vector<std::string> clock_findings(const Survey& survey, const std::vector<ClockReport>& clocks, Duration limit) {
    std::vector<std::string> findings;
    const bool set_up = std::any_of(clocks.begin(), clocks.end(), [](const ClockReport& c) { return c.offset != 0 || c.delay != 0; });
    if (!clocks.empty() && !set_up) {
        findings.emplace_back("the clocks run free: no master has set them up since power-on (they are set up on the way to SAFEOP)");
        return findings;
    }
    for (const auto& clock : clocks) {
        const std::string subject = survey.subject(clock.position);
        if (clock.error) {
            findings.push_back(clock.error->text());
            continue;
        }
        if (!clock.reference && std::abs(static_cast<std::int64_t>(clock.difference)) > limit.count())
            findings.push_back(
                fmt::format("{}: its clock is {} ns off the reference (limit {} ns): frames with the reference time are "
                            "missing, or its quartz is defective",
                            subject, clock.difference, limit.count()));
        if (clock.sync0 && clock.sync0_cycle == Duration{})
            findings.push_back(fmt::format("{}: SYNC0 is on with a cycle of 0: it fires once only", subject));
        if (clock.sync0 && clock.start > clock.system_time + static_cast<std::uint64_t>(Duration{std::chrono::seconds{10}}.count()))
            findings.push_back(fmt::format("{}: SYNC0 starts only in {:.0f} s: its start was computed from another clock", subject,
                                           static_cast<double>(clock.start - clock.system_time) * 1e-9));
    }
    return findings;
}

}  // namespace taktwerk::ecat
