#pragma once
// Names of the LCM channels of one machine: TAKTWERK_<MACHINE>_AXIS_STATE and its like, at most 63 characters.

#include <string>
#include <string_view>

namespace taktwerk::hmi {

class Channels {
public:
    /// Letters and digits of the name stay, in capitals; anything else becomes '_' (LCM subscriptions are regular expressions).
    explicit Channels(std::string_view machine) : prefix_("TAKTWERK_") {
        for (const char c : machine.substr(0, longest_machine)) {
            if (c >= 'a' && c <= 'z') prefix_ += static_cast<char>(c - 'a' + 'A');
            else prefix_ += (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
        }
        prefix_ += '_';
    }
    [[nodiscard]] std::string machine_state() const { return prefix_ + "MACHINE_STATE"; }
    [[nodiscard]] std::string whole_state() const { return prefix_ + "WHOLE_STATE"; }
    [[nodiscard]] std::string axis_state() const { return prefix_ + "AXIS_STATE"; }
    [[nodiscard]] std::string axis_holder() const { return prefix_ + "AXIS_HOLDER"; }
    [[nodiscard]] std::string command_event() const { return prefix_ + "COMMAND_EVENT"; }
    [[nodiscard]] std::string cycle_statistics() const { return prefix_ + "CYCLE_STATISTICS"; }
    [[nodiscard]] std::string alarm_list() const { return prefix_ + "ALARM_LIST"; }
    [[nodiscard]] std::string io_state() const { return prefix_ + "IO_STATE"; }
    [[nodiscard]] std::string program_values() const { return prefix_ + "PROGRAM_VALUES"; }
    [[nodiscard]] std::string heartbeat() const { return prefix_ + "HEARTBEAT"; }
    [[nodiscard]] std::string command() const { return prefix_ + "COMMAND"; }
    [[nodiscard]] std::string acknowledge() const { return prefix_ + "ACKNOWLEDGE"; }

private:
    static constexpr std::size_t longest_machine = 63 - 9 - 1 - 16;  ///< "TAKTWERK_", "_", "CYCLE_STATISTICS"
    std::string prefix_;
};

}  // namespace taktwerk::hmi
