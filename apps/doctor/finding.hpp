#pragma once
// What a fact means for a cycle: what it costs, where that is from, how to mend it. The table of all kinds is findings.cpp and port_findings.cpp.

#include <string>
#include <vector>

#include "apps/doctor/ethernet_port.hpp"
#include "core/time.hpp"

namespace taktwerk::apps {

/// One thing that `--apply` writes, and `--revert` takes back.
struct HostChange {
    enum class Kind : std::uint8_t {
        file,      ///< `target` is a path, `value` its whole text: what is kept over a restart of the computer
        knob,      ///< `target` is a file of /proc or /sys: holds until that restart
        ethernet,  ///< `target` is an interface, `knob` its setting: likewise
    };
    Kind kind = Kind::file;
    std::string target, value;
    EthernetKnob knob{};
};

enum class Severity : std::uint8_t {
    good,     ///< as it should be
    note,     ///< costs next to nothing at this cycle
    warning,  ///< costs a twentieth of the cycle or more
    unfit,    ///< costs half the cycle or more, or nothing works with it
};
[[nodiscard]] const char* word(Severity severity) noexcept;

struct Finding {
    std::string code;  ///< stable: "cpu.governor"
    Severity severity = Severity::good;
    double cost_us = 0;                 ///< worst that it adds to a cycle, us; what findings are sorted by
    std::string found;                  ///< one line: what there is
    std::string costs;                  ///< one line; empty when it is good
    std::string source;                 ///< of that figure
    std::string remedy;                 ///< lines to copy into a shell or a file; empty: there is nothing to do
    std::vector<HostChange> changes{};  ///< what `--apply` does; empty: a person has to
    std::string then{};                 ///< command with which these take effect at once, where they would wait for a restart
};

/// What the findings are judged by.
struct Wanted {
    Duration cycle = std::chrono::milliseconds{1};
    Duration computing = std::chrono::microseconds{100};  ///< of a cycle
    int cpu = -1;                                         ///< of the cycle's thread; -1: any
    bool of_others = false;  ///< the rights of this process, which are root's, say nothing of who runs the machine
};

/// By the share of the cycle that it costs.
[[nodiscard]] Severity severity_of(double cost_us, Duration cycle) noexcept;
/// Dearest first, then by code; what is good last.
void sort_by_cost(std::vector<Finding>& findings);

}  // namespace taktwerk::apps
