#pragma once
// Brings trouble over a rig's machine, and takes its cause away when its time is over.

#include <random>
#include <string>

#include "tests/whole_machine/rig.hpp"

namespace taktwerk::whole {

/// How hard it strikes, where that was drawn.
struct Blow {
    Duration length{};  ///< 0: it has none
    Duration delay{};   ///< of each answer
};

class Troublemaker {
public:
    Troublemaker(Rig& rig, std::mt19937& random) : rig_(rig), random_(random) {}

    /// This machine has what it takes.
    [[nodiscard]] bool possible(Trouble trouble) const;
    /// Begins, for a time drawn from the seed. A stall happens whole in here.
    Blow strike(Trouble trouble);
    /// Once a cycle.
    void step();
    [[nodiscard]] bool over() const { return under_way_.empty(); }
    /// All causes go at once.
    void heal();

private:
    struct UnderWay {
        Trouble trouble;
        std::string at;
        Instant until{};
        std::size_t happening = 0;
    };
    [[nodiscard]] std::uint32_t below(std::size_t most) { return static_cast<std::uint32_t>(random_() % most); }
    [[nodiscard]] Duration between(Duration low, Duration high) {
        return low + std::chrono::microseconds{random_() % static_cast<std::uint64_t>((high - low) / std::chrono::microseconds{1} + 1)};
    }
    /// What it is done to, and for how long. Does it.
    [[nodiscard]] std::string choose_place(Trouble trouble);
    Duration begin(Trouble trouble, const std::string& at);
    Duration begin_on_bus(Trouble trouble, const std::string& at);
    Duration begin_beside(Trouble trouble, const std::string& at);
    void end(const UnderWay& one);
    void by_hand(Trouble trouble);
    void stall(Duration length);
    void send_to_other_state(std::size_t slave);
    [[nodiscard]] std::string input_of_emergency_stop() const { return rig_.m.machine->config().emergency_stop.input; }

    Rig& rig_;
    std::mt19937& random_;
    std::vector<UnderWay> under_way_;
};

}  // namespace taktwerk::whole
