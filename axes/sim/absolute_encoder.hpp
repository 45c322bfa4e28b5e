#pragma once
// An absolute encoder on the motor's shaft: it knows the place within a turn by itself, counts turns as long as its battery lasts, and
// begins anew after 2^bits of them. Counts of the drive, machine coordinates. Source: SV33-E 3.1.4 (16 bit of turns), TSVM 7.2.1.

#include <cmath>
#include <cstdint>

namespace taktwerk::axes::sim {

class AbsoluteEncoder {
public:
    /// `zero`: a place where the single turn reads 0; turns are 0 there too at first. `turn_bits` 0: it never begins anew.
    AbsoluteEncoder(double counts_per_revolution, double zero, unsigned turn_bits) noexcept
        : turn_(counts_per_revolution),
          base_(zero),
          range_(turn_bits > 0 ? std::ldexp(counts_per_revolution, static_cast<int>(turn_bits)) : 0) {}

    /// What it reads at `position`: turns * counts per revolution + place within the turn, turns signed (SV33-E 3.1.4).
    [[nodiscard]] double reading(double position) const noexcept {
        const double way = position - base_;
        return range_ > 0 ? way - range_ * std::floor(way / range_ + 0.5) : way;
    }
    /// More turns than the counter holds.
    [[nodiscard]] bool overflowed(double position) const noexcept { return range_ > 0 && std::abs(position - base_) >= range_ / 2; }
    /// The drive counts `factor` times as many counts for the same way.
    void rescale(double factor) noexcept { turn_ *= factor, base_ *= factor, range_ *= factor; }
    /// Battery empty, or asked to: the turns are 0, the place within the turn stays.
    void forget_turns(double position) noexcept { base_ += turn_ * std::floor((position - base_) / turn_); }

private:
    double turn_, base_, range_;
};

}  // namespace taktwerk::axes::sim
