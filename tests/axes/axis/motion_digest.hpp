#pragma once
// What a rig's axes showed and told their drives, in every cycle and to the last bit, as one number. With TAKTWERK_DIGEST=1 each rig prints its own:
// two builds that print the same lines behave the same in all that the tests and walks do.

#include <gtest/gtest.h>

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <type_traits>

#include "axes/axis/axis_view.hpp"
#include "axes/port/drive_port.hpp"

namespace taktwerk::axes::test {

class MotionDigest {
public:
    MotionDigest() = default;
    MotionDigest(const MotionDigest&) = delete;
    MotionDigest& operator=(const MotionDigest&) = delete;
    ~MotionDigest() {
        if (!wanted() || cycles_ == 0) return;
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        std::printf("digest %s.%s %ld %016llx\n", test ? test->test_suite_name() : "", test ? test->name() : "", cycles_,
                    static_cast<unsigned long long>(hash_));
    }

    /// For a test that compares two: also where nobody asked for the lines.
    void ask() { asked_ = true; }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

    void observe(const AxisView& v, const DriveCommand& c) {
        if (!wanted() && !asked_) return;
        ++cycles_;
        // Field by field: padding has no value, and `holder` is an address.
        add(v.state, v.owner, v.powered, v.homed, v.simulated, v.online, v.in_position, v.warning, v.error, v.drive_error, v.resetting,
            v.reset_error, v.set_position, v.set_velocity, v.set_acceleration, v.set_jerk, v.actual_position, v.actual_velocity,
            v.actual_torque, v.following_error, v.target_position, v.limiter, v.manual_slow, v.manual_fast, v.drive_state, v.drive_mode,
            v.status_word, v.negative_limit_switch, v.positive_limit_switch, v.home_switch, v.modulo, v.turns, v.override_factors.velocity,
            v.override_factors.acceleration, v.override_factors.jerk, v.digital_inputs, v.digital_outputs, v.superimposed_covered,
            v.phase_shift, v.phase_covered, v.master.index, v.selected_cam.value, v.selected_as.periodic, v.sync_started, v.cam_ends,
            v.homing_procedure, v.active_kind, v.holder != nullptr, v.lock, v.phasing_queued, v.active, v.active_in_target, v.queued_count,
            v.ledger_next, v.last_id);
        for (const double value : v.parameters) add(value);
        for (const double value : v.probe_position) add(value);
        for (const auto id : v.probe_latched) add(id);
        for (const auto id : v.side) add(id);
        for (const auto id : v.queued) add(id);
        for (const auto& entry : v.ledger) add(entry.id, entry.outcome, entry.error);

        add(c.power, c.reset_fault, c.mode, c.position, c.velocity, c.torque, c.acceleration, c.deceleration, c.torque_limit_positive,
            c.torque_limit_negative, c.start_homing, c.halt, c.digital_outputs, c.digital_output_mask, c.velocity_limit, c.torque_slope,
            c.homing.method, c.homing.search_velocity, c.homing.latch_velocity, c.homing.acceleration, c.profile.sequence,
            c.profile.relative, c.profile.immediately);
        for (const auto& probe : c.probes) add(probe.armed, probe.continuous, probe.index_pulse, probe.edge);
    }

private:
    [[nodiscard]] static bool wanted() {
        static const bool asked = std::getenv("TAKTWERK_DIGEST") != nullptr;
        return asked;
    }
    template <class... Values>
    void add(Values... values) {
        (mix(bits(values)), ...);
    }
    template <class Value>
    [[nodiscard]] static std::uint64_t bits(Value value) {
        if constexpr (std::same_as<Value, double>) return std::bit_cast<std::uint64_t>(value);
        else return static_cast<std::uint64_t>(value);
    }
    void mix(std::uint64_t value) {
        hash_ = (hash_ ^ value) * 0x9E3779B97F4A7C15u;
        hash_ ^= hash_ >> 29;
    }

    std::uint64_t hash_ = 0xCBF29CE484222325u;
    long cycles_ = 0;
    bool asked_ = false;
};

}  // namespace taktwerk::axes::test
