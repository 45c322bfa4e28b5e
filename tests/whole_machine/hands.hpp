#pragma once
// An operator who does anything, on all of his buttons.

#include <random>

#include "tests/whole_machine/rig.hpp"

namespace taktwerk::whole {

class Hands {
public:
    Hands(Rig& rig, std::mt19937& random) : rig_(rig), random_(random) {}

    void do_anything();
    void force_anything();
    /// A person who brings the machine back: gives stop, acknowledges, resets.
    void reset_all();

private:
    [[nodiscard]] std::uint32_t below(std::size_t most) { return static_cast<std::uint32_t>(random_() % most); }
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * below(10'001) / 10'000.0; }
    void move(std::uint16_t axis);
    void set_something();

    Rig& rig_;
    std::mt19937& random_;
};

}  // namespace taktwerk::whole
