#include "ecat/diagnosis/port_errors.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

constexpr unsigned lost_link_weight = 1000;  // a wiggling plug before any number of bit errors

std::string plural(unsigned count, const char* what) {
    return fmt::format("{}{} {}{}", count, count == 255 ? " or more" : "", what, count == 1 ? "" : "s");
}

void add(std::string& list, const std::string& item) { list += (list.empty() ? "" : ", ") + item; }

Script<void> refresh_one(DatagramPort& port, SurveyedSlave& slave) { co_await read_counters(port, slave); }

}  // namespace

std::string neighbour(const Survey& survey, std::size_t position, unsigned port) {
    if (!survey.topology || position >= survey.topology->slaves.size()) return {};
    const auto& place = survey.topology->slaves[position];
    if (port == place.entry_port) return place.parent ? survey.subject(*place.parent) : std::string{"the master"};
    if (survey.topology->ring_end == RingEnd{position, port}) return "the second interface";
    return place.child[port] ? survey.subject(*place.child[port]) : std::string{};
}

std::vector<PortFinding> port_findings(const Survey& survey) {
    std::vector<PortFinding> findings;
    for (std::size_t position = 0; position < survey.slaves.size(); ++position) {
        for (unsigned port = 0; port < ports_per_slave; ++port) {
            const auto& counters = survey.slaves[position].ports[port].counters;
            if (counters.clean()) continue;
            std::string list;
            if (counters.lost_links != 0) add(list, plural(counters.lost_links, "lost link"));
            if (counters.rx_errors != 0) add(list, plural(counters.rx_errors, "RX error"));
            if (counters.invalid_frames != 0) add(list, plural(counters.invalid_frames, "invalid frame"));
            if (counters.forwarded_errors != 0) add(list, plural(counters.forwarded_errors, "forwarded error"));
            const std::string other = neighbour(survey, position, port);
            const bool own = counters.lost_links != 0 || counters.own_errors() != 0;
            std::string cause;
            if (!own) cause = "they came from further up the cable; look at the slaves before";
            else if (other.empty()) cause = "the plug at this port, or what was plugged in there";
            else cause = fmt::format("the cable between {} and {}, or its plugs", survey.subject(position), other);
            findings.push_back({position, port,
                                counters.lost_links * lost_link_weight + counters.rx_errors + counters.invalid_frames +
                                    (own ? counters.forwarded_errors : 0u),
                                fmt::format("port {} of {}: {}: {}", port, survey.subject(position), list, cause)});
        }
    }
    std::stable_sort(findings.begin(), findings.end(), [](const PortFinding& a, const PortFinding& b) { return a.weight > b.weight; });
    return findings;
}

Script<Result<void>> refresh_counters(DatagramPort& port, Survey& survey) {
    std::vector<Script<void>> scripts;
    for (auto& slave : survey.slaves)
        if (!slave.found.error) scripts.push_back(refresh_one(port, slave));
    co_await all(std::move(scripts), DatagramPort::slaves_at_once);
    co_return Result<void>{};
}

Script<Result<void>> clear_counters(DatagramPort& port, std::size_t slaves) {
    // Writing anything clears the block; a controller without a counter does not count this datagram.
    const Reply errors = co_await port.clear_all(reg::rx_errors, 8);
    co_await port.clear_all(reg::forwarded_rx_errors, 4);
    co_await port.bwr(reg::processing_unit_errors, std::uint8_t{0});
    co_await port.bwr(reg::pdi_errors, std::uint8_t{0});
    co_await port.clear_all(reg::lost_links, 4);
    co_await port.bwr(reg::sm_watchdog_count, std::uint8_t{0});
    if (errors.lost) co_return unanswered("bus", "clearing the error counters (0300h)", errors);
    if (errors.wkc != slaves)
        co_return Error{"bus.working_counter", "bus", fmt::format("{} of {} slaves cleared their error counters", errors.wkc, slaves),
                        "a slave has left the bus, or its controller write-protects them: scan again"};
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
