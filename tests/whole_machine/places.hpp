#pragma once
// Where axes are, exactly: what an axis at rest shows is what its drive counts, and the difference of the two is the same, to the hundredth of a count, from
// one reference to the next, whatever happens between. After a homing on a switch the mechanics themselves are where the axis says, as near as the latch allows.
//
// A motor without an encoder is where its drive says as long as nothing has stopped its field or its rotor: held, or without set-points for some milliseconds
// while it turns, it loses whole periods of the field, and nobody knows (SE-808X 2.4; tests/drives/se_808x_open_loop_unit.cpp). So its mechanics are compared
// when its homing ends, and later only if nothing of that kind has happened since.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/runtime/test_machine.hpp"

namespace taktwerk::whole {

class Places {
public:
    /// After each cycle. What is wrong, or nothing.
    std::string look(runtime::testing::TestMachine& m) {
        const auto* snapshot = m.machine->latest();
        const auto& bindings = m.machine->config().axes;
        if (snapshot == nullptr || snapshot->bus_phase != ecat::Master::Phase::operational) return {};
        axes_.resize(bindings.size());
        std::string wrong;
        for (std::size_t i = 0; i < bindings.size(); ++i) wrong += look(m, i, bindings[i], snapshot->axes[i], axes_[i]);
        return wrong;
    }
    /// Something happens that may cost a motor without an encoder steps, or lasts.
    void shaken() {
        for (auto& one : axes_) one.sure = false;
    }
    /// Its mechanics are where it shows: what counts its steps has lost none since its homing.
    [[nodiscard]] bool sure(std::size_t axis) const { return axis >= axes_.size() || axes_[axis].sure; }
    /// Somebody has asked for a new reference: set where it stands, that takes a cycle and shows no Homing.
    void asked_for_reference(std::size_t axis) {
        if (axis >= axes_.size()) return;
        axes_[axis].known = false;
        axes_[axis].asked = true;
        axes_[axis].resting = -50;
    }
    /// Times that an axis at rest was compared, and with its mechanics behind a homing: the positive control.
    [[nodiscard]] long compared() const { return compared_; }
    [[nodiscard]] long references() const { return references_; }

private:
    struct One {
        double offset = 0;  ///< u: shown minus counted
        bool known = false, asked = false;
        bool homing = false;  ///< in the cycle before
        bool sure = false;    ///< since its homing it has lost no steps
        std::int64_t raw = 0;
        int resting = 0;
    };

    std::string look(runtime::testing::TestMachine& m, std::size_t i, const runtime::AxisBinding& binding, const axes::AxisView& view,
                     One& one) {
        auto* drive = m.world.drive(binding.axis.name);
        if (drive == nullptr || !binding.profile || binding.encoder || !binding.follower.slave.empty() || !binding.load_input.empty())
            return {};
        const auto raw = m.told(i).actual_position;
        const bool same = view.answered && raw == one.raw;
        one.raw = raw;
        const bool homing = view.state == axes::AxisState::Homing;
        const bool ended = one.homing && !homing;
        one.homing = homing;
        if (homing) one.sure = true;
        // A new reference, or none: what was known before counts no more.
        if (!view.homed || homing || !view.online) {
            one.known = one.asked = false;
            one.resting = 0;
            return {};
        }
        const double counts = binding.axis.gearing.counts_per_unit();
        const bool trusted = binding.profile->encoder.present || one.sure;
        if (ended && same && trusted) return compare_with_mechanics(binding, view, *drive, counts);
        const bool rests = same && std::abs(drive->plant().velocity()) < 1e-3;
        one.resting = rests || one.resting < 0 ? one.resting + 1 : 0;
        if (one.resting < 20) return {};
        ++compared_;
        const double offset = folded(view.actual_position - static_cast<double>(raw) / counts, view.modulo);
        std::string wrong;
        if (one.known && std::abs(folded(offset - one.offset, view.modulo)) * std::abs(counts) > 0.01)
            wrong += fmt::format("axis {} shows {} u at {} counts, off by {} counts from where it was; ", binding.axis.name,
                                 view.actual_position, raw, folded(offset - one.offset, view.modulo) * counts);
        if (!one.known && !one.asked && trusted) wrong += compare_with_mechanics(binding, view, *drive, counts);
        one.known = true;
        one.asked = false;
        one.offset = offset;
        return wrong;
    }
    /// The edge of the switch is where `home_from`..`home_to` begins or ends; the axis has found one of both at its latch velocity, within some cycles.
    std::string compare_with_mechanics(const runtime::AxisBinding& binding, const axes::AxisView& view, const axes::sim::Cia402Axis& drive,
                                       double counts) {
        const auto& homing = binding.axis.homing;
        const auto& simulation = binding.simulation;
        if (!simulation.home_from || !simulation.home_to || homing.kind == axes::HomingKind::set_here || view.modulo > 0) return {};
        ++references_;
        const double off = view.actual_position - drive.plant().position() / counts - homing.offset;
        const double near = std::min(std::abs(off + *simulation.home_from), std::abs(off + *simulation.home_to));
        const double most = 0.05 + 0.01 * homing.latch_velocity;
        if (near <= most) return {};
        return fmt::format("axis {} stands {} u from the edge of its home switch where it says 0 (at most {}); ", binding.axis.name, near,
                           most);
    }
    static double folded(double way, double modulo) { return modulo > 0 ? way - modulo * std::round(way / modulo) : way; }

    std::vector<One> axes_;
    long compared_ = 0, references_ = 0;
};

}  // namespace taktwerk::whole
