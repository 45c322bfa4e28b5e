#pragma once
// A machine of config/machines/ through hours of virtual time: it works, an operator does what operators do and more, troubles of all sources come one after
// the other, and after each the operator brings it back. Every cycle is looked at by the oracles of the rig; what is left at the end is a table.

#include <functional>
#include <string>
#include <vector>

#include "tests/whole_machine/hands.hpp"
#include "tests/whole_machine/rig.hpp"
#include "tests/whole_machine/troublemaker.hpp"

namespace taktwerk::whole {

class LongDay {
public:
    LongDay(std::string machine, std::uint32_t seed);

    struct Hour {
        Duration at{};
        std::size_t heap = 0;  ///< bytes in use
        long troubles = 0, commands = 0, alarms = 0, compared = 0, references = 0;
    };
    /// Until `time` of machine time has passed, or too much is wrong. `told`: after each `every`.
    void live(Duration time, Duration every, const std::function<void(const Hour&)>& told);
    /// The machine ends in order.
    void end();

    [[nodiscard]] Hour so_far() const;
    [[nodiscard]] const std::vector<std::string>& problems() const { return rig_.problems; }
    [[nodiscard]] const std::vector<Hour>& hours() const { return hours_; }
    /// Troubles and alarms by their names.
    [[nodiscard]] std::string table() const;
    [[nodiscard]] std::string story() const { return rig_.story(); }

private:
    [[nodiscard]] std::uint32_t below(std::size_t most) { return static_cast<std::uint32_t>(random_() % most); }
    [[nodiscard]] Duration between(Duration low, Duration high) {
        return low + std::chrono::milliseconds{random_() % static_cast<std::uint64_t>((high - low) / 1ms + 1)};
    }
    void one_cycle();
    void work(Duration time);
    void by_hand(Duration time);
    void bring_back();
    void automatic();

    std::mt19937 random_;
    Rig rig_;
    Troublemaker troubles_;
    Hands hands_;
    std::vector<Hour> hours_;
    long struck_ = 0;
};

}  // namespace taktwerk::whole
