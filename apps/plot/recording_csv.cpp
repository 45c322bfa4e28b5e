#include "apps/plot/recording_csv.hpp"

#include <iterator>

#include <fmt/format.h>

namespace taktwerk::apps {

std::string recording_csv(const runtime::KeptRows& kept) {
    std::string out;
    const auto* time = kept.find(runtime::time_signal);
    for (const auto& signal : kept.signals()) {
        out += (out.empty() ? "" : ",") + signal.name;
        if (&signal != time && !signal.unit.empty()) out += "[" + signal.unit + "]";
    }
    out += '\n';
    const auto there = kept.span();
    const double start_s = time ? kept.value(*time, there.first) : 0;
    for (auto cycle = there.first; cycle <= there.last; ++cycle) {
        for (std::size_t i = 0; i < kept.signals().size(); ++i) {
            const auto& signal = kept.signals()[i];
            const double value = kept.value(signal, cycle) - (&signal == time ? start_s : 0);
            if (i > 0) out += ',';
            if (value > -1e15 && value < 1e15 && value == static_cast<double>(static_cast<long long>(value)))
                fmt::format_to(std::back_inserter(out), "{}", static_cast<long long>(value));
            else fmt::format_to(std::back_inserter(out), "{}", value);
        }
        out += '\n';
    }
    return out;
}

}  // namespace taktwerk::apps
