#pragma once
// Is this machine well? For a person, a script, a monitoring of the plant. Taken from what the socket says, so from outside the runtime.

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace taktwerk::apps {

struct Health {
    std::string machine, version, phase, mode, bus;
    bool simulated = false, emergency_stop = false;
    long long process = 0;
    double uptime_s = 0;
    std::size_t axes = 0, powered = 0, homed = 0;
    std::uint64_t cycles = 0, missed = 0, frames_lost = 0, page_faults = 0;
    double lateness_max_us = 0, compute_max_us = 0;
    struct Listed {
        std::string source, name, text, reaction;
        bool standing = false;
    };
    std::vector<Listed> alarms;                                 ///< those that stop something
    std::vector<std::pair<std::string, std::string>> programs;  ///< name, state
    struct Task {
        std::string name;  ///< with its program's
        std::uint64_t runs = 0, overruns = 0;
        double run_us = 0, run_max_us = 0;
    };
    std::vector<Task> tasks;
    std::vector<std::string> held;    ///< groups that a person has interrupted: no program moves them
    std::vector<std::string> unwell;  ///< why it is not; empty: it is well

    [[nodiscard]] bool well() const noexcept { return unwell.empty(); }
};

/// From the answers to `hello` and `state`; `state` null: it does not cycle yet. What is missing in them counts as unwell; what is of another type throws
/// nlohmann's exception (remote.hpp's understood() is for that).
[[nodiscard]] Health health_of(const nlohmann::ordered_json& hello, const nlohmann::ordered_json& state);

[[nodiscard]] std::string health_text(const Health& health);
[[nodiscard]] nlohmann::ordered_json health_json(const Health& health);

}  // namespace taktwerk::apps
