#include "axes/axis/axis_config.hpp"

#include <cmath>
#include <string_view>
#include <utility>

#include "axes/axis/command_details.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/rational.hpp"

namespace taktwerk::axes {

namespace {

class Problems {
public:
    explicit Problems(const std::string& axis) : prefix_("axes." + (axis.empty() ? std::string("?") : axis) + ".") {}

    void add(std::string_view field, std::string what, std::string remedy) {
        found.push_back({"axis.invalid_config", prefix_ + std::string(field), std::move(what), std::move(remedy)});
    }
    void positive(std::string_view field, double value, std::string_view unit) {
        if (!(value > 0) || std::isinf(value)) add(field, "must be a finite number above 0", "Give a value in " + std::string(unit));
    }
    void not_negative(std::string_view field, double value, std::string_view meaning_of_zero) {
        if (!(value >= 0)) add(field, "must not be negative", "Give a value above 0, or 0 for " + std::string(meaning_of_zero));
    }
    std::vector<Error> found;

private:
    std::string prefix_;
};

void check_gearing(Problems& problems, const Gearing& gearing) {
    const auto count = [&](std::string_view field, std::int64_t value) {
        constexpr std::int64_t most = 1LL << 31;  // products of two stay inside 64 bit
        if (value < 1 || value > most)
            problems.add(field, "must be a whole number from 1 to 2147483648", "Give the number from the data sheet");
    };
    count("gearing.counts_per_revolution", gearing.counts_per_revolution);
    count("gearing.motor_revolutions", gearing.motor_revolutions);
    count("gearing.load_revolutions", gearing.load_revolutions);
    if (!(gearing.feed > 0) || std::isinf(gearing.feed))
        problems.add("gearing.feed", "must be a finite number above 0",
                     "Give the way per load revolution; use `inverted` to change the sense");
}

void check_direction(Problems& problems, const std::string& here, const DirectionLimits& own, const AxisLimits& both) {
    const auto at_most = [&](const char* what, double value, double most) {
        if (!(value >= 0) || (most > 0 && value > most))  // one that is none is said elsewhere
            problems.add(here + what, "must be above 0 and no more than limits." + std::string(what),
                         "Give less than holds in both directions, or leave it out; what is more in one direction belongs into limits." +
                             std::string(what));
    };
    at_most("velocity", own.velocity, both.velocity);
    at_most("acceleration", own.acceleration, both.acceleration);
    at_most("deceleration", own.deceleration, both.deceleration);
    at_most("torque", own.torque, both.torque);
}

void check_limits(Problems& problems, const AxisLimits& limits) {
    problems.positive("limits.velocity", limits.velocity, "u/s");
    problems.positive("limits.acceleration", limits.acceleration, "u/s2");
    problems.positive("limits.deceleration", limits.deceleration, "u/s2");
    if (!(limits.jerk > 0)) problems.add("limits.jerk", "must be above 0", "Give a value in u/s3, or infinity for none");
    problems.not_negative("limits.stop_deceleration", limits.stop_deceleration, "the same as deceleration");
    problems.not_negative("limits.stop_jerk", limits.stop_jerk, "the same as jerk");
    if (std::isinf(limits.stop_deceleration)) problems.add("limits.stop_deceleration", "must be finite", "Give a value in u/s2");
    check_direction(problems, "limits.positive.", limits.positive, limits);
    check_direction(problems, "limits.negative.", limits.negative, limits);
    if (!(limits.torque >= TorqueLimitDetails::least))
        problems.add("limits.torque", "must be 0.001 or more",
                     "Give a fraction of the rated torque, such as 1.5, or leave it out for what the drive has");
    if (!(limits.position_min < limits.position_max))
        problems.add("limits.position_min", "must be below limits.position_max", "Exchange the two, or leave both out");
}

void check_modulo(Problems& problems, const AxisConfig& config) {
    if (config.modulo == 0) return;
    if (!(config.modulo > 0) || std::isinf(config.modulo)) {
        problems.add("modulo", "must be a finite number above 0", "Give the range of positions in u, or leave it out for a linear axis");
        return;
    }
    if (config.gearing.feed > 0 && !rational_of(config.modulo / config.gearing.feed))
        problems.add("modulo", "is no simple ratio of gearing.feed, so turns would drift",
                     "Write both as exact as the mechanics are, such as feed 360 deg and modulo 360 deg");
    if (!std::isinf(config.limits.position_min) || !std::isinf(config.limits.position_max))
        problems.add("modulo", "excludes software limits: the axis has no ends", "Leave the software limits out (`limits: position`)");
}

/// Homing by the drive knows nothing of the axis' limits: what it is told has to be inside them.
void check_homing_speeds(Problems& problems, const HomingConfig& homing, const AxisLimits& limits) {
    const char* const remedy =
        "Homing may not be faster than the axis: give a smaller value, or raise the limit where the mechanics bear it";
    const auto above = [](double value, double limit) { return limit > 0 && value > limit; };  // a limit that is none is said elsewhere
    // It searches both ways.
    const double velocity = slowest(limits);
    const auto ramps = gentlest({velocity, limits.acceleration, limits.deceleration, limits.jerk}, limits);
    if (above(homing.search_velocity, velocity)) problems.add("homing.search_velocity", "is above limits.velocity", remedy);
    if (above(homing.latch_velocity, velocity)) problems.add("homing.latch_velocity", "is above limits.velocity", remedy);
    if (above(homing.acceleration, std::min(ramps.acceleration, ramps.deceleration)))
        problems.add("homing.acceleration", "is above limits.acceleration or limits.deceleration", remedy);
}

void check_homing(Problems& problems, const HomingConfig& homing, const AxisLimits& limits) {
    const auto& marks = homing.marks;
    if ((marks.spacing != 0 || marks.step != 0) && !marks.valid())
        problems.add("homing.marks", "cannot be those of a distance-coded scale",
                     "spacing is an even multiple of step, four steps or more: see the data sheet of the scale");
    const auto kind = homing.kind;
    if (kind == HomingKind::none || kind == HomingKind::set_here || kind == HomingKind::absolute) return;
    if (homing.timeout <= Duration::zero())
        problems.add("homing.timeout", "must be above 0", "Give the longest time homing may take, such as 60 s");
    check_homing_speeds(problems, homing, limits);
    if (kind == HomingKind::drive) return;
    problems.positive("homing.search_velocity", homing.search_velocity, "u/s, above 0 either way; the sense is `direction`");
    problems.positive("homing.latch_velocity", homing.latch_velocity, "u/s");
    problems.positive("homing.acceleration", homing.acceleration, "u/s2");
    if (homing.latch_velocity > homing.search_velocity)
        problems.add("homing.latch_velocity", "is above homing.search_velocity", "The edge is taken slowly: give a smaller value");
    if (kind != HomingKind::block) return;
    problems.positive("homing.torque", homing.torque, "fractions of the rated torque");
    problems.positive("homing.block_velocity", homing.block_velocity, "u/s");
    if (homing.block_time < Duration::zero()) problems.add("homing.block_time", "must not be negative", "Leave it out for 50 ms");
}

void check_integral(Problems& problems, const ControlConfig& control, const AxisLimits& limits) {
    const auto& integral = control.integral;
    if (integral.time != Duration::zero() && integral.time < PositionIntegral::least_time)
        problems.add("control.integral.time", "must be 1 ms or more", "Leave it out for none, or begin with ten times 1 / control.kv");
    if (integral.used() && !(control.kv > 0))
        problems.add("control.integral.time", "needs a position loop of the axis' own, with a control.kv",
                     "Set control.mode to velocity and control.kv; in mode position the drive's loop has its own I part");
    if (!(integral.limit >= 0) || (limits.velocity > 0 && integral.limit > limits.velocity))
        problems.add("control.integral.limit", "must be from 0 to limits.velocity", "Leave it out for a tenth of the velocity limit");
    if (!(integral.dead_band >= 0) || std::isinf(integral.dead_band))
        problems.add("control.integral.dead_band", "must be a finite distance, not negative", "Give some counts of the encoder, in u");
}

void check_load(Problems& problems, const LoadTorque& load, const AxisLimits& limits) {
    const auto share = [&](std::string_view field, double value, double least, double most) {
        if (!(value >= least && value <= most))
            problems.add(field, least < 0 ? "must be from -3 to 3" : "must make from 0 to 3 rated torques, also at the velocity limit",
                         "Give fractions of the rated torque: 0.05 is 5 % of it (6077h at a steady velocity shows it)");
    };
    share("control.load.gravity", load.gravity, -LoadTorque::most, LoadTorque::most);
    share("control.load.coulomb_friction", load.coulomb_friction, 0, LoadTorque::most);
    share("control.load.viscous_friction", load.viscous_friction * std::max(limits.velocity, 0.0), 0, LoadTorque::most);
    if (!(load.friction_velocity >= 0) || (limits.velocity > 0 && load.friction_velocity > limits.velocity))
        problems.add("control.load.friction_velocity", "must be from 0 to limits.velocity",
                     "Leave it out for a hundredth of the velocity limit");
}

void check_control(Problems& problems, const ControlConfig& control) {
    if (control.mode == ControlMode::velocity && !(control.kv > 0 && std::isfinite(control.kv)))
        problems.add("control.kv", "must be above 0 where control.mode is velocity",
                     "Give the position gain in 1/s, such as 20; below a tenth of the cycle rate");
    if (!(control.feed_forward >= 0 && control.feed_forward <= 2))
        problems.add("control.feed_forward", "must be from 0 to 2", "Leave it out for 1");
    if (!(control.torque_feed_forward >= 0 && control.torque_feed_forward <= 2))
        problems.add("control.torque_feed_forward", "must be from 0 to 2", "Leave it out for 0, or give 1");
    if (!(control.rated_acceleration >= 0) || std::isinf(control.rated_acceleration))
        problems.add("control.rated_acceleration", "must be a finite number, not negative", "Give a value in u/s2, or leave it out");
    if (control.torque_feed_forward > 0 && control.rated_acceleration == 0)
        problems.add("control.torque_feed_forward", "needs control.rated_acceleration",
                     "Give the acceleration that rated torque gives the axis: rated torque / inertia, in u/s2");
    problems.not_negative("control.output_limit", control.output_limit, "1.2 times the velocity limit");
}

void check_following(Problems& problems, const FollowingErrorWatch& following) {
    if (!(following.window > 0)) problems.add("following.window", "must be above 0", "Give the largest permitted following error in u");
    if (following.time < Duration::zero()) problems.add("following.time", "must not be negative", "Give a time such as 10 ms");
    if (following.per_velocity < Duration::zero() || following.per_velocity > FollowingErrorWatch::most_per_velocity)
        problems.add(
            "following.per_velocity", "must be from 0 to 10 s",
            "Give the time that the motor is behind at a steady velocity, and a half more, such as 15 ms; leave it out for a fixed window");
    else if (following.per_velocity > Duration::zero() && std::isinf(following.window))
        problems.add("following.per_velocity", "widens a window that is none",
                     "Give following.window a distance, or leave per_velocity out");
}

void check_compensation(Problems& problems, const CompensationConfig& compensation) {
    if (!(compensation.backlash >= 0) || std::isinf(compensation.backlash))
        problems.add("compensation.backlash", "must be a finite distance, not negative", "Give the motor's way between the flanks in u");
    problems.positive("compensation.velocity", compensation.velocity, "u/s");
    const auto& pitch = compensation.pitch;
    for (std::size_t i = 0; i < pitch.size(); ++i) {
        if (!std::isfinite(pitch[i].position) || !std::isfinite(pitch[i].correction)) {
            problems.add("compensation.pitch", "holds a number that is not finite", "Correct the table");
            return;
        }
        if (i == 0) continue;
        const double before = pitch[i - 1].position, here = pitch[i].position;
        if (!(here > before)) {
            problems.add("compensation.pitch", "has positions that do not rise", "Sort the table by position; each position once");
            return;
        }
        if (!(here + pitch[i].correction > before + pitch[i - 1].correction)) {
            problems.add("compensation.pitch", "turns the motion round: corrected positions do not rise",
                         "Corrections must differ by less than the distance of their points; check the unit");
            return;
        }
    }
}

void check_gantry(Problems& problems, const AxisConfig& config) {
    const auto& gantry = config.gantry;
    if (!gantry.on) return;
    problems.positive("gantry.max_skew.error", gantry.error, "u: what the portal bears without harm");
    if (!(gantry.warning >= 0) || (gantry.warning > 0 && gantry.warning >= gantry.error))
        problems.add("gantry.max_skew.warning", "must be below the error, and not negative",
                     "Give for instance half of it, or leave it out");
    const auto kind = config.homing.kind;
    if (kind == HomingKind::drive || kind == HomingKind::reference_pulse)
        problems.add(
            "homing.kind", "of a gantry may not be one that a single drive carries out or latches",
            "Choose `set_here`, `home_switch`, `limit_switch` or `absolute`: both sides move together, and the leader's switch counts");
    if (!(gantry.square_velocity >= 0) || std::isinf(gantry.square_velocity))
        problems.add("gantry.square.velocity", "must be above 0",
                     "Give the velocity at which one side may be led alone, for instance 2 u/s");
    if (gantry.square_velocity > 0 && kind != HomingKind::home_switch)
        problems.add("gantry.square", "needs homing by `home_switch`: each side's own switch tells where it is",
                     "Choose `homing.kind: home_switch`, or remove `square`");
    if (config.control.mode != ControlMode::position)
        problems.add("control.mode", "of a gantry must be `position`: each drive closes its own position loop", "Leave it out");
    if (config.encoder) problems.add("encoder", "excludes `gantry`: there is nothing that moves", "Remove one of the two");
    for (const auto alarm : one_sided_alarms)
        if (config.reactions.of(alarm) < ErrorReaction::ramp_then_off)
            problems.add("reactions." + std::string(find_alarm(axis_alarms, id(alarm))->name),
                         "of a gantry must end without power: one side may not hold the portal alone",
                         "Choose `ramp_then_off`, `quick_stop` or `power_off`, or leave it out for `ramp_then_off`");
}

void check_load_encoder(Problems& problems, const LoadEncoderConfig& load) {
    if (!load.on) return;
    problems.positive("load_encoder.counts_per_unit", load.counts_per_unit, "counts per u, above 0 either way; the sense is `inverted`");
    problems.positive("load_encoder.tolerance", load.tolerance,
                      "u: what coupling and backlash leave between motor and load, and the way of some cycles");
    if (load.bits < 8 || load.bits > 64) problems.add("load_encoder.bits", "must be from 8 to 64", "Leave it out for 32");
    if (load.time < Duration::zero()) problems.add("load_encoder.time", "must not be negative", "Leave it out for 10 ms");
}

void check_brake(Problems& problems, const BrakeConfig& brake) {
    using namespace std::chrono_literals;
    constexpr Duration longest = 5s;  // whoever needs more has another trouble
    for (const auto& [field, time] : {std::pair{"brake.release", brake.release}, std::pair{"brake.engage", brake.engage}})
        if (time < Duration::zero() || time > longest)
            problems.add(field, "must be from 0 to 5 s", "Give the time from the brake's data sheet");
    if (brake.by == BrakeBy::drive && (brake.release > Duration::zero() || brake.engage > Duration::zero() || brake.release_without_power))
        problems.add("brake.by", "is `drive`: the drive works the brake with times of its own",
                     "Choose `object` or `output` where the controller works it; else set the times in the drive and remove this section");
}

void check_reactions(Problems& problems, const ErrorReactions& reactions) {
    for (const auto& info : axis_alarms) {
        const auto alarm = static_cast<AxisAlarm>(info.id);
        const auto chosen = reactions.chosen(alarm);
        if (chosen == ErrorReaction::by_table) continue;
        const auto field = "reactions." + std::string(info.name);
        const auto* bound = bound_of(alarm);
        if (!bound) {
            problems.add(field, "is not chosen at an axis: it is the whole machine's, or comes before the axis does anything", "Remove it");
        } else if (chosen < bound->mildest) {
            std::string permitted;
            for (const auto& word : reaction_words)
                if (word.reaction >= bound->mildest) permitted += (permitted.empty() ? "`" : ", `") + std::string(word.name) + "`";
            problems.add(
                field,
                "may not be answered by `" + std::string(word_of(chosen).name) + "`: " + std::string(bound->because) +
                    " (something harder than the table's is always permitted, something milder is not)",
                "Choose one of " + permitted + ", or leave it out for `" + std::string(word_of(reaction_by_table(alarm)).name) + "`");
        }
    }
}

}  // namespace

void choose_for_gantry(ErrorReactions& reactions) noexcept {
    for (const auto alarm : one_sided_alarms)
        if (reactions.chosen(alarm) == ErrorReaction::by_table) reactions.choose(alarm, ErrorReaction::ramp_then_off);
}

std::vector<Error> check(const AxisConfig& config) {
    Problems problems(config.name);
    if (config.name.empty()) problems.add("name", "is empty", "Give the axis a name");
    check_gearing(problems, config.gearing);
    check_modulo(problems, config);
    check_limits(problems, config.limits);
    check_homing(problems, config.homing, config.limits);
    check_control(problems, config.control);
    check_integral(problems, config.control, config.limits);
    check_load(problems, config.control.load, config.limits);
    check_compensation(problems, config.compensation);
    check_brake(problems, config.brake);
    check_gantry(problems, config);
    check_load_encoder(problems, config.load_encoder);
    check_reactions(problems, config.reactions);
    problems.not_negative("defaults.acceleration", config.defaults.acceleration, "the limit");
    problems.not_negative("defaults.deceleration", config.defaults.deceleration, "the limit");
    problems.not_negative("defaults.jerk", config.defaults.jerk, "the limit");
    check_following(problems, config.following);
    if (!(config.windows.in_position > 0)) problems.add("windows.in_position", "must be above 0", "Give the window in u");
    problems.not_negative("windows.standstill_velocity", config.windows.standstill_velocity, "exact standstill");
    if (config.memory.range < 0)
        problems.add("position_memory.range", "must not be negative", "Leave it out for that of the drive's position");
    problems.not_negative("position_memory.moved_while_off", config.memory.moved_while_off, "not a count");
    problems.not_negative("manual.slow", config.manual.slow, "5 % of the velocity limit");
    problems.not_negative("manual.fast", config.manual.fast, "25 % of the velocity limit");
    problems.not_negative("manual.setup_velocity", config.manual.setup_velocity, "manual.slow");
    if (config.queue_depth < 1 || config.queue_depth > 8) problems.add("queue_depth", "must be from 1 to 8", "Leave it out for 4");
    if (config.patience.feedback < 1) problems.add("stale_limit", "must be at least 1 cycle", "Leave it out for 3");
    if (config.patience.jog_lease <= Duration::zero()) problems.add("jog_lease", "must be above 0", "Leave it out for 200 ms");
    if (config.patience.enable <= Duration::zero()) problems.add("enable_timeout", "must be above 0", "Leave it out for 3 s");
    return std::move(problems.found);
}

}  // namespace taktwerk::axes
