#pragma once
// Between the drive's counts and the axis' unit u, exactly.
//
// Three coordinates:  counts   what the drive has, int64
//                     local    u from the anchor, double: what the planner works in
//                     program  u as programs and people see it = shift + anchor * feed + local
// The anchor is a whole number of feeds (turns of the load), so its counts are known as an exact ratio, and moving it changes
// `local` by fmod, which does not round: an endless axis never drifts. The shift is what homing and MC_SetPosition change.

#include <cmath>
#include <cstdint>

#include "axes/axis/axis_config.hpp"

namespace taktwerk::axes {

class AxisUnits {
public:
    explicit AxisUnits(const Gearing& gearing) noexcept
        : feed_(gearing.feed),
          load_(gearing.load_revolutions),
          whole_((gearing.counts_per_revolution * gearing.motor_revolutions) / gearing.load_revolutions),
          rest_((gearing.counts_per_revolution * gearing.motor_revolutions) % gearing.load_revolutions),
          counts_per_u_(static_cast<double>(gearing.counts_per_revolution) * static_cast<double>(gearing.motor_revolutions) /
                        (static_cast<double>(gearing.load_revolutions) * gearing.feed)),
          inverted_(gearing.inverted) {}

    /// counts per u, negative when inverted: for velocities and small differences.
    [[nodiscard]] double counts_per_unit() const noexcept { return inverted_ ? -counts_per_u_ : counts_per_u_; }

    /// Nearest count.
    [[nodiscard]] std::int64_t counts(double local) const noexcept {
        const std::int64_t forward = anchor_counts_ + std::llround(anchor_fraction_ + local * counts_per_u_);
        return inverted_ ? -forward : forward;
    }
    [[nodiscard]] double local(std::int64_t counts) const noexcept {
        const std::int64_t forward = inverted_ ? -counts : counts;
        return (static_cast<double>(forward - anchor_counts_) - anchor_fraction_) / counts_per_u_;
    }
    [[nodiscard]] double to_program(double local) const noexcept { return shift_ + static_cast<double>(anchor_) * feed_ + local; }
    [[nodiscard]] double to_local(double program) const noexcept { return (program - shift_) - static_cast<double>(anchor_) * feed_; }

    /// Program coordinates grow by `delta`; nothing moves.
    void shift_by(double delta) noexcept { shift_ += delta; }
    /// The place `at` [counts] gets the program coordinate `program`; nothing moves.
    void set_program(std::int64_t at, double program) noexcept { shift_ += program - to_program(local(at)); }

    /// Moves the anchor to the feed that `local` lies in. Returns what is left of `local`; every other local coordinate kept outside must
    /// be made anew.
    double reanchor(double local) noexcept {
        const double left = std::fmod(local, feed_);
        anchor_ += std::llround((local - left) / feed_);
        anchor_counts_ = anchor_ * whole_ + (anchor_ * rest_) / load_;
        anchor_fraction_ = static_cast<double>((anchor_ * rest_) % load_) / static_cast<double>(load_);
        return left;
    }
    [[nodiscard]] double feed() const noexcept { return feed_; }

private:
    double feed_;
    std::int64_t load_;
    std::int64_t whole_, rest_;  // counts per feed = whole + rest / load
    double counts_per_u_;
    bool inverted_;

    std::int64_t anchor_ = 0;  // feeds
    std::int64_t anchor_counts_ = 0;
    double anchor_fraction_ = 0;  // of a count
    double shift_ = 0;            // u
};

}  // namespace taktwerk::axes
