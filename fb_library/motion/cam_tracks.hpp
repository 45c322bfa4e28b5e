#pragma once
// Cam switches over an axis' position: which tracks are on. Pure, plain data, no allocation; the work is linear in the number of switches.
// Real-time safe.
//
//   * A position switch is on from First to Last, both included, in positive sense; on a circle First > Last goes over the zero. Whoever
//     enters its stretch from either end switches it on: it is a level, so it is on at once when the axis stands inside.
//   * A time switch goes on when the axis passes First, for Duration. Passing is motion: it begins off. Passing again begins anew.
//   * Compensation moves the switching points by velocity times time along the motion: On the point at which it goes on, Off the one
//     at which it goes off; of a time switch Off moves the end in time.
//   * Hysteresis: a switching point that has just switched does not switch again before the axis has been farther than that from it.
//     The direction of motion turns once the axis has come back by more than that.
//   * Resolution is a scan: a stretch shorter than the way of one scan may be passed unseen.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "axes/tables/motion_tables.hpp"
#include "core/time.hpp"

namespace taktwerk::fb {

class CamTracks {
public:
    static constexpr std::size_t most_switches = 64;
    static constexpr std::size_t tracks = axes::MotionTables::tracks;

    struct Sample {
        double position = 0, velocity = 0;  ///< u, u/s
        double modulo = 0;                  ///< u; 0 = linear
        double longest_step = 0;  ///< u per scan; a longer one is a change of coordinates, no motion; 0 = whatever comes is motion
        Instant now{};
        Duration period{};
    };

    /// Whether all of it can be used: tracks 1 to 32, finite positions, First <= Last on a linear axis, no negative Duration or hysteresis,
    /// at most 64 switches.
    [[nodiscard]] static bool usable(std::span<const axes::CamSwitch> switches, std::span<const axes::TrackOptions> options,
                                     double modulo) noexcept {
        if (switches.size() > most_switches) return false;
        for (const auto& s : switches) {
            if (s.track < 1 || s.track > tracks || !std::isfinite(s.first)) return false;
            if (s.mode == axes::CamSwitchMode::time ? s.duration < Duration::zero() : !std::isfinite(s.last)) return false;
            if (s.mode == axes::CamSwitchMode::position && modulo <= 0 && s.first > s.last) return false;
        }
        for (const auto& o : options)
            if (!(o.hysteresis >= 0) || std::isinf(o.hysteresis)) return false;
        return true;
    }

    /// Bit n - 1 of the answer: track n is on. Tracks outside `enabled` are off and forget. The tables must be usable().
    std::uint32_t step(const Sample& now, std::span<const axes::CamSwitch> switches, std::span<const axes::TrackOptions> options,
                       std::uint32_t enabled) noexcept {
        moved_ = known_ ? distance(before_.position, now.position, now.modulo) : 0;
        if (now.longest_step > 0 && std::abs(moved_) > now.longest_step) {
            known_ = false;
            moved_ = 0;
        }
        for (std::size_t t = 0; t < tracks; ++t) turn(senses_[t], option(options, t).hysteresis);
        std::uint32_t on = 0;
        for (std::size_t i = 0; i < switches.size(); ++i) {
            const auto bit = 1u << (switches[i].track - 1u);
            if ((enabled & bit) == 0) states_[i] = {};
            else if (run(states_[i], now, switches[i], option(options, switches[i].track - 1u))) on |= bit;
        }
        before_ = now;
        known_ = true;
        return on;
    }

    /// Begins anew: nothing has been passed.
    void reset() noexcept { *this = {}; }

private:
    enum class Held : std::uint8_t { none, first, last };
    struct State {
        Instant until{};  // time switch
        bool on = false;
        bool begun = false;  // a level has been taken
        Held held = Held::none;
    };
    struct Sense {
        double back = 0;        // u that the axis has come back from its farthest place
        std::int8_t sense = 0;  // 0: it has not moved yet
    };
    struct Stretch {
        double first = 0, last = 0, length = 0;
    };

    [[nodiscard]] static axes::TrackOptions option(std::span<const axes::TrackOptions> options, std::size_t track) noexcept {
        return track < options.size() ? options[track] : axes::TrackOptions{};
    }
    /// From a to b, on a circle the shorter way.
    [[nodiscard]] static double distance(double a, double b, double modulo) noexcept {
        return modulo > 0 ? std::remainder(b - a, modulo) : b - a;
    }
    [[nodiscard]] static double along(double way, double modulo) noexcept {
        if (modulo <= 0) return way;
        const double rest = std::fmod(way, modulo);
        return rest < 0 ? rest + modulo : rest;
    }

    void turn(Sense& s, double hysteresis) const noexcept {
        if (s.sense == 0) {
            s.back += moved_;
            if (std::abs(s.back) <= hysteresis) return;
            s = {0, static_cast<std::int8_t>(s.back > 0 ? 1 : -1)};
            return;
        }
        s.back = std::fmax(0, s.back - s.sense * moved_);
        if (s.back > hysteresis) s = {0, static_cast<std::int8_t>(-s.sense)};
    }

    [[nodiscard]] bool allowed(const axes::CamSwitch& s) const noexcept {
        const auto sense = senses_[s.track - 1u].sense;
        switch (s.direction) {
            case axes::CamSwitchDirection::both: return true;
            case axes::CamSwitchDirection::positive: return sense > 0;
            case axes::CamSwitchDirection::negative: return sense < 0;
        }
        return false;
    }

    [[nodiscard]] bool run(State& state, const Sample& now, const axes::CamSwitch& s, const axes::TrackOptions& o) const noexcept {
        return s.mode == axes::CamSwitchMode::time ? run_time(state, now, s, o) : run_position(state, now, s, o);
    }

    /// Where the switch is, with its points moved along the motion.
    [[nodiscard]] Stretch stretch(const Sample& now, const axes::CamSwitch& s, const axes::TrackOptions& o) const noexcept {
        const bool backwards = now.velocity < 0 || (now.velocity == 0 && senses_[s.track - 1u].sense < 0);
        const double on = now.velocity * to_seconds(o.on_compensation), off = now.velocity * to_seconds(o.off_compensation);
        const double at_first = backwards ? off : on, at_last = backwards ? on : off;
        const double whole = s.last - s.first;
        const double length = now.modulo > 0 && whole < now.modulo ? along(whole, now.modulo) : whole;
        return {s.first + at_first, s.last + at_last, length + (at_last - at_first)};
    }

    [[nodiscard]] bool run_position(State& state, const Sample& now, const axes::CamSwitch& s, const axes::TrackOptions& o) const noexcept {
        const auto where = stretch(now, s, o);
        const double from_first = std::abs(distance(where.first, now.position, now.modulo));
        const double from_last = std::abs(distance(where.last, now.position, now.modulo));
        if (state.held != Held::none && (state.held == Held::first ? from_first : from_last) > o.hysteresis) state.held = Held::none;

        const double inside = along(now.position - where.first, now.modulo);
        const bool everywhere = now.modulo > 0 && where.length >= now.modulo;
        const bool level = allowed(s) && where.length >= 0 && (everywhere || (inside >= 0 && inside <= where.length));
        if (!state.begun) {
            state.begun = true;
            state.on = level;
        } else if (level != state.on) {
            const auto point = from_first <= from_last ? Held::first : Held::last;
            if (point != state.held) {
                state.on = level;
                state.held = o.hysteresis > 0 ? point : Held::none;
            }
        }
        return state.on;
    }

    /// The part of the last scan's way after which the axis was at the (moved) point; below 0: it did not pass it.
    [[nodiscard]] double passed(const Sample& now, const axes::CamSwitch& s, const axes::TrackOptions& o) const noexcept {
        const double compensation = to_seconds(o.on_compensation);
        const double from = before_.position - before_.velocity * compensation, to = now.position - now.velocity * compensation;
        const double way = distance(from, to, now.modulo);
        const double to_point = now.modulo > 0 && way < 0 ? -along(from - s.first, now.modulo) : along(s.first - from, now.modulo);
        const bool between = way > 0 ? to_point > 0 && to_point <= way : way < 0 && to_point < 0 && to_point >= way;
        return between ? to_point / way : -1;
    }

    [[nodiscard]] bool run_time(State& state, const Sample& now, const axes::CamSwitch& s, const axes::TrackOptions& o) const noexcept {
        const double point = s.first + now.velocity * to_seconds(o.on_compensation);
        if (state.held != Held::none && std::abs(distance(point, now.position, now.modulo)) > o.hysteresis) state.held = Held::none;
        const double part = known_ ? passed(now, s, o) : -1;
        if (part >= 0 && state.held == Held::none && allowed(s)) {
            const auto since = from_seconds((1 - part) * to_seconds(now.period));
            state.until = now.now - since - o.on_compensation + s.duration + o.off_compensation;
            state.on = true;
            state.held = o.hysteresis > 0 ? Held::first : Held::none;
        }
        if (now.now >= state.until) state.on = false;
        return state.on;
    }

    std::array<State, most_switches> states_{};
    std::array<Sense, tracks> senses_{};
    Sample before_{};
    double moved_ = 0;  // u in this scan
    bool known_ = false;
};

}  // namespace taktwerk::fb
