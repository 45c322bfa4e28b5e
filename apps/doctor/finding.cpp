#include "apps/doctor/finding.hpp"

#include <algorithm>
#include <tuple>

namespace taktwerk::apps {

const char* word(Severity severity) noexcept {
    switch (severity) {
        case Severity::good: return "good";
        case Severity::note: return "note";
        case Severity::warning: return "warning";
        case Severity::unfit: return "unfit";
    }
    return "";
}

Severity severity_of(double cost_us, Duration cycle) noexcept {
    const double cycle_us = to_seconds(cycle) * 1e6;
    return cost_us >= cycle_us / 2 ? Severity::unfit : cost_us >= cycle_us / 20 ? Severity::warning : Severity::note;
}

void sort_by_cost(std::vector<Finding>& findings) {
    std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
        return std::tuple{-static_cast<int>(a.severity), -a.cost_us, a.code} <
               std::tuple{-static_cast<int>(b.severity), -b.cost_us, b.code};
    });
}

}  // namespace taktwerk::apps
