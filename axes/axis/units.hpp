#pragma once
// Between the drive's counts and the axis' unit u, exactly.
//
// Three coordinates:  counts   what the drive has, int64
//                     local    u from the anchor, double: what the planner works in
//                     program  u as programs and people see it = shift + anchor * feed + local
// The anchor is a whole number of feeds (turns of the load), so its counts are known as an exact ratio, and moving it changes
// `local` by fmod, which does not round: an endless axis never drifts. The shift is what homing and MC_SetPosition change.
//
// On a modulo axis program coordinates repeat after every modulo. It is p/q feeds with whole p and q, so where the anchor lies in its modulo is a
// whole number of q-ths of a feed, known by integer arithmetic for any number of turns.

#include <cmath>
#include <cstdint>

#include "axes/axis/axis_config.hpp"
#include "axes/axis/nearest.hpp"
#include "axes/axis/rational.hpp"

namespace taktwerk::axes {

class AxisUnits {
public:
    /// `modulo` [u], 0 = linear; rational_of(modulo / feed) must exist.
    explicit AxisUnits(const Gearing& gearing, double modulo = 0) noexcept
        : feed_(gearing.feed),
          load_(gearing.load_revolutions),
          whole_((gearing.counts_per_revolution * gearing.motor_revolutions) / gearing.load_revolutions),
          rest_((gearing.counts_per_revolution * gearing.motor_revolutions) % gearing.load_revolutions),
          counts_per_u_(static_cast<double>(gearing.counts_per_revolution) * static_cast<double>(gearing.motor_revolutions) /
                        (static_cast<double>(gearing.load_revolutions) * gearing.feed)),
          counts_per_unit_(gearing.inverted ? -counts_per_u_ : counts_per_u_),
          inverted_(gearing.inverted),
          modulo_(modulo) {
        if (modulo > 0) per_modulo_ = rational_of(modulo / gearing.feed).value_or(Rational{});
    }

    /// counts per u, negative when inverted: for velocities and small differences.
    [[nodiscard]] double counts_per_unit() const noexcept { return counts_per_unit_; }

    /// Nearest count.
    [[nodiscard]] std::int64_t counts(double local) const noexcept {
        const std::int64_t forward = anchor_counts_ + nearest(anchor_fraction_ + local * counts_per_u_);
        return inverted_ ? -forward : forward;
    }
    [[nodiscard]] double local(std::int64_t counts) const noexcept {
        const std::int64_t forward = inverted_ ? -counts : counts;
        return (static_cast<double>(forward - anchor_counts_) - anchor_fraction_) / counts_per_u_;
    }
    /// On a modulo axis in [0, modulo).
    [[nodiscard]] double to_program(double local) const noexcept { return modulo_ > 0 ? in_modulo(local).position : anchor_at_ + local; }
    /// On a modulo axis: one of the places with this coordinate, less than one modulo from the anchor's.
    [[nodiscard]] double to_local(double program) const noexcept {
        return modulo_ > 0 ? (program - shift_) - anchor_in_modulo() : (program - shift_) - static_cast<double>(anchor_) * feed_;
    }
    /// u; 0 = linear.
    [[nodiscard]] double modulo() const noexcept { return modulo_; }
    /// Whole moduli since zero was set; 0 on a linear axis.
    [[nodiscard]] std::int64_t turns(double local) const noexcept { return modulo_ > 0 ? in_modulo(local).turns - zero_turns_ : 0; }

    /// Program coordinate without what MC_SetPosition has shifted since the axis was homed: where the mechanics are.
    [[nodiscard]] double machine(double local) const noexcept {
        const double position = to_program(local) - user_shift_;
        return modulo_ > 0 ? position - std::floor(position / modulo_) * modulo_ : position;
    }

    /// Program coordinates grow by `delta`; nothing moves.
    void shift_by(double delta) noexcept {
        shift_ += delta;
        user_shift_ += delta;
        place_anchor();
    }
    /// The place `at` [counts] gets the program coordinate `program`; nothing moves.
    void set_program(std::int64_t at, double program) noexcept {
        shift_ += program - to_program(local(at));
        user_shift_ = 0;
        place_anchor();
        if (modulo_ > 0) zero_turns_ = in_modulo(local(at)).turns;
    }

    /// Moves the anchor to the feed that `local` lies in. Returns what is left of `local`; every other local coordinate kept outside must
    /// be made anew.
    double reanchor(double local) noexcept {
        const double left = std::fmod(local, feed_);
        anchor_ += std::llround((local - left) / feed_);
        anchor_counts_ = anchor_ * whole_ + (anchor_ * rest_) / load_;
        anchor_fraction_ = static_cast<double>((anchor_ * rest_) % load_) / static_cast<double>(load_);
        place_anchor();
        return left;
    }
    /// Time for reanchor(). Nearer than this, `local` resolves some 1e-13 feeds.
    [[nodiscard]] bool far_from_anchor(double local) const noexcept { return std::abs(local) >= 1024 * feed_; }
    [[nodiscard]] double feed() const noexcept { return feed_; }
    /// Whole feeds: local 0 is there.
    [[nodiscard]] std::int64_t anchor() const noexcept { return anchor_; }
    /// u: the program coordinate of count 0; on a modulo axis with the whole moduli since zero was set.
    [[nodiscard]] double shift() const noexcept { return shift_ - static_cast<double>(zero_turns_) * modulo_; }

private:
    void place_anchor() noexcept { anchor_at_ = shift_ + static_cast<double>(anchor_) * feed_; }
    struct Wrapped {
        double position;
        std::int64_t turns;
    };
    /// Where the anchor lies in its modulo, u: (anchor * q mod p) / p of it.
    [[nodiscard]] double anchor_in_modulo() const noexcept {
        return static_cast<double>(anchor_rest()) * (modulo_ / static_cast<double>(per_modulo_.numerator));
    }
    [[nodiscard]] std::int64_t anchor_rest() const noexcept {
        const std::int64_t p = per_modulo_.numerator;
        const std::int64_t rest = ((anchor_ % p) * per_modulo_.denominator) % p;
        return rest < 0 ? rest + p : rest;
    }
    [[nodiscard]] Wrapped in_modulo(double local) const noexcept {
        const std::int64_t p = per_modulo_.numerator;
        const double raw = shift_ + anchor_in_modulo() + local;
        double turns = std::floor(raw / modulo_);
        double position = raw - turns * modulo_;
        // The last digits of a sum may put zero just below the modulo.
        constexpr double rounding = 1e-13;
        if (position < 0 || modulo_ - position <= rounding * (modulo_ + std::abs(local))) {
            if (position >= 0) ++turns;
            position = 0;
        }
        // anchor * q = whole * p + rest, without the product: it may not fit.
        const std::int64_t whole = (anchor_ / p) * per_modulo_.denominator + ((anchor_ % p) * per_modulo_.denominator - anchor_rest()) / p;
        return {position, whole + static_cast<std::int64_t>(turns)};
    }

    double feed_;
    std::int64_t load_;
    std::int64_t whole_, rest_;  // counts per feed = whole + rest / load
    double counts_per_u_;
    double counts_per_unit_;  // with the sense
    bool inverted_;
    double modulo_;        // u
    Rational per_modulo_;  // feeds
    std::int64_t zero_turns_ = 0;

    std::int64_t anchor_ = 0;  // feeds
    std::int64_t anchor_counts_ = 0;
    double anchor_fraction_ = 0;  // of a count
    double shift_ = 0;            // u
    double user_shift_ = 0;       // u, part of it
    double anchor_at_ = 0;        // u: program coordinate of the anchor on a linear axis
};

}  // namespace taktwerk::axes
