#pragma once
// From error counters to the cable that is to blame. Pure, but for the scripts that read and clear the counters.
//
// An error is counted where it arrives: RX errors and invalid frames at port p come from the cable at port p (or from the
// neighbour's transmitter). Forwarded errors came from further away: some slave before has marked the frame already.
// Source: ETG.1000.4 (error counters), reference/ethercat-masters.md section 5 (0300h..0313h).

#include <string>
#include <vector>

#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::ecat {

struct PortFinding {
    std::size_t position = 0;
    unsigned port = 0;
    unsigned weight = 0;  ///< errors counted; lost links weigh most
    std::string text;     ///< "port 1 of slave 2 'y': 12 RX errors, 3 lost links: the cable to slave 3"
};

/// The worst first; empty: no cable has errors.
[[nodiscard]] std::vector<PortFinding> port_findings(const Survey& survey);

/// What is at the other end of a port: "the master", "slave 3 'z'", "" when nothing is or nobody knows.
[[nodiscard]] std::string neighbour(const Survey& survey, std::size_t position, unsigned port);

/// Counters of all slaves again, into the survey.
[[nodiscard]] Script<Result<void>> refresh_counters(DatagramPort& port, Survey& survey);
/// Sets them to zero on every slave.
[[nodiscard]] Script<Result<void>> clear_counters(DatagramPort& port, std::size_t slaves);

}  // namespace taktwerk::ecat
