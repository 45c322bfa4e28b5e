#pragma once
// Who did what, one line each, for the machine's log: "process 812 (taktwerk) of user 1000: enable axis x". A jog is its begin and its end, not
// its heartbeats. Bounded per client: who does a great many things fills neither the log nor the place of what others do; the next line
// says how many were left out. One thread, not real-time.

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace taktwerk::hmi {

class DeedLog {
public:
    static constexpr double burst = 20;             ///< lines at once
    static constexpr double each_second = 2;        ///< lines, in the long run
    static constexpr std::size_t remembered = 128;  ///< clients; the one that was quiet for longest is forgotten

    /// `log` may be empty.
    explicit DeedLog(std::function<void(std::string_view)> log) : log_(std::move(log)) {}

    void say(const std::string& who, std::string_view what, Instant now);

private:
    struct Allowance {
        double lines = burst;
        Instant since{};
        std::uint64_t left_out = 0;
    };
    std::function<void(std::string_view)> log_;
    std::map<std::string, Allowance> allowances_;
};

}  // namespace taktwerk::hmi
