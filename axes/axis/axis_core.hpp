#pragma once
// The parts of an axis, joined. Each reads the body and the parts that its constructor names, and none that stands further down; README.md
// (Rooms) says who reads whom. The order of a cycle is in axis.cpp.

#include <cstdint>
#include <memory>

#include "axes/axis/admission.hpp"
#include "axes/axis/aim.hpp"
#include "axes/axis/axis.hpp"
#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_coupling.hpp"
#include "axes/axis/axis_homing.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/axis_parameters.hpp"
#include "axes/axis/axis_power.hpp"
#include "axes/axis/axis_probes.hpp"
#include "axes/axis/axis_reset.hpp"
#include "axes/axis/axis_settings.hpp"
#include "axes/axis/base_motion.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/continuous_update.hpp"
#include "axes/axis/coupling_links.hpp"
#include "axes/axis/coupling_start.hpp"
#include "axes/axis/drive_modes.hpp"
#include "axes/axis/drive_output.hpp"
#include "axes/axis/drive_profiles.hpp"
#include "axes/axis/feedback_intake.hpp"
#include "axes/axis/following_watch.hpp"
#include "axes/axis/gantry_watch.hpp"
#include "axes/axis/given_motion.hpp"
#include "axes/axis/homing_reference.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/homing_steps.hpp"
#include "axes/axis/jog_lease.hpp"
#include "axes/axis/limit_guard.hpp"
#include "axes/axis/load_encoder.hpp"
#include "axes/axis/master_side.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/mode_state.hpp"
#include "axes/axis/motor_lead.hpp"
#include "axes/axis/passive_homing.hpp"
#include "axes/axis/phasing.hpp"
#include "axes/axis/plain_cycle.hpp"
#include "axes/axis/retained_coordinates.hpp"
#include "axes/axis/search_motion.hpp"
#include "axes/axis/software_limits.hpp"
#include "axes/axis/succession.hpp"
#include "axes/axis/superimposed_motion.hpp"
#include "axes/axis/targets.hpp"
#include "axes/axis/torque_bounds.hpp"
#include "axes/axis/view_writer.hpp"

namespace taktwerk::axes {

/// How the set-point moves.
struct MotionParts {
    MotionParts(AxisBody& body, const Measured& measured)
        : now(body),
          targets(body, measured, now),
          given(body, now),
          addition(body, now, given),
          limits(body, now, addition),
          aim(body, measured, now),
          base(body, measured, now, given, addition, limits, targets) {}

    AxisMotion now;
    Targets targets;
    GivenMotion given;
    SuperimposedMotion addition;
    SoftwareLimits limits;
    Aim aim;
    BaseMotion base;
};

/// How the axis finds its coordinates.
struct HomingParts {
    HomingParts(AxisBody& body, const Measured& measured, MotionParts& motion, HomingRuns& runs, const ModeState& modes,
                const AxisProbes& probes, Conduct& conduct, LimitGuard& guard)
        : reference(body, measured, runs, probes),
          search(body, measured, motion.now, motion.aim, runs, reference),
          steps(body, measured, motion.now, motion.aim, runs, reference, search),
          home(body, measured, motion.now, motion.aim, runs, modes, reference, search, steps, conduct, guard),
          passive(body, measured, motion.aim, runs, reference, steps) {}

    HomingReference reference;
    SearchMotion search;
    HomingSteps steps;
    AxisHoming home;
    PassiveHoming passive;
};

/// What the drive does in modes of its own.
struct ModeParts {
    ModeParts(AxisBody& body, const Measured& measured, MotionParts& motion, ModeState& modes, Conduct& conduct, LimitGuard& guard,
              const DriveOutput& output)
        : lead(body, measured, motion.now, modes),
          profiles(body, measured, motion.now, motion.addition, motion.aim, motion.targets, modes, lead, conduct, guard),
          switching(body, measured, motion.now, motion.addition, motion.aim, motion.targets, modes, lead, conduct, guard, profiles,
                    output) {}

    MotorLead lead;
    DriveProfiles profiles;
    DriveModes switching;
};

/// How it follows others, and is followed.
struct CouplingParts {
    CouplingParts(AxisBody& body, const Measured& measured, MotionParts& motion, const HomingRuns& runs, Conduct& conduct)
        : links(body),
          as_master(body, measured, motion.now, runs, links),
          start(body, motion.now, motion.addition, motion.aim, links, conduct),
          slave(body, motion.now, motion.aim, links, start, conduct, as_master),
          phasing(body, links, slave) {}

    CouplingLinks links;
    MasterSide as_master;
    CouplingStart start;
    AxisCoupling slave;
    Phasing phasing;
};

class AxisCore {
public:
    AxisCore(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index, AxisView* view);
    AxisCore(const AxisCore&) = delete;
    AxisCore& operator=(const AxisCore&) = delete;

    [[nodiscard]] static const MasterSide& side_of(const Axis& axis) noexcept { return axis.core_->coupling.as_master; }
    /// For tests: whether the next cycle may go straight, and how to keep it from that.
    [[nodiscard]] static PlainCycle& plain_cycle_of(Axis& axis) noexcept { return axis.core_->plain; }

    std::unique_ptr<AxisView> own_view;
    AxisBody body;
    Measured measured;
    PlainCycle plain;
    HomingRuns runs;
    ModeState modes;
    MotionParts motion;
    FollowingWatch following;
    Conduct conduct;
    GantryWatch gantry;
    LoadEncoder load;
    LimitGuard guard;
    RetainedCoordinates retained;
    FeedbackIntake intake;
    AxisPower supply;
    AxisReset reset;
    JogLease jog;
    AxisProbes probes;
    HomingParts homing;
    AxisParameters parameters;
    TorqueBounds bounds;
    DriveOutput output;
    ModeParts drive;
    CouplingParts coupling;
    Admission admission;
    AxisSettings settings;
    Succession succession;
    ContinuousUpdate updates;
    ViewWriter writer;
};

}  // namespace taktwerk::axes
